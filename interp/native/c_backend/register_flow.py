"""Data-flow analysis of a routine's steps: successors, and the contents of registers.

The classical analyses, over single steps: each iterates until nothing changes.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Container, Mapping, Sequence

from interp.native.c_backend.register_code import CALLS, ENDS, Step, roles_of

#: Steps that the interpreter executes.
INTERPRETED = ("PYTHON", "END_ACTION", "CHECK_CALL", "FAIL")
#: NEG_REAL is not among them, because it does not check its result.
_FINDS_INFINITE = re.compile("(ADD|SUB|MUL)_REAL(_K)?")


def _finds_infinite(taker: Step, operand: int) -> bool:
    """Return whether a step that reads this operand raises an overflow if it is not finite."""
    return bool(_FINDS_INFINITE.fullmatch(taker.name)) or (
        taker.name in ("DIV_REAL", "DIV_REAL_K")
        and (taker.name == "DIV_REAL_K" or taker.c != operand)
    )


class RegisterFlow:
    """The flow between the steps of ``body``, a range of all ``steps`` of a program."""

    def __init__(self, steps: Sequence[Step], body: range) -> None:
        self._steps = steps
        self._body = body
        jumps = [(place, steps[place].d) for place in body if steps[place].is_jump]
        #: Jump targets.
        self.targets = {target for _, target in jumps}
        #: Loop heads.
        self.loops = sorted({target for place, target in jumps if target <= place})

    def after(self, place: int) -> list[int]:
        """Return the steps that can come next in the routine."""
        step = self._steps[place]
        jump = [step.d] if step.is_jump else []
        is_end = step.name in ENDS or place + 1 not in self._body  # a routine that only fails
        return jump if is_end else [*jump, place + 1]

    def is_next_case(self, place: int) -> bool:
        """Whether a step compares the same register as the one before, and follows only that."""
        step, before = self._steps[place], self._steps[place - 1]
        is_case = step.name == before.name == "CASE" and step.b == before.b
        return is_case and place not in self.targets

    def live(self, stack: Collection[int]) -> dict[int, frozenset[int]]:
        """Liveness: return by step the stack registers that are read before they are written."""
        whole = frozenset(stack)
        found: dict[int, frozenset[int]] = dict.fromkeys(self._body, frozenset())
        before: dict[int, list[int]] = {place: [] for place in self._body}
        for place in self._body:
            for other in self.after(place):
                before[other].append(place)
        todo = list(self._body)
        while todo:
            place = todo.pop()
            step = self._steps[place]
            roles = roles_of(step.name)
            later = frozenset[int]().union(*(found[one] for one in self.after(place)))
            if step.name in ("PYTHON", "STOP"):
                live = frozenset(one for one in whole if one < step.a)
            elif roles is None and step.name not in (*ENDS, "AT"):  # from `a` on
                live = frozenset(one for one in whole if one >= step.a or one in later)
            else:
                read, written = map(step.named, roles or ("", ""))
                live = (later - written) | whole.intersection(read)
            if live != found[place]:
                found[place] = live
                todo += before[place]
        return found

    def restarts(self, live: Mapping[int, Collection[int]], stack: Collection[int]) -> list[int]:
        """Return for each step an earlier step at which execution can restart after a fault.

        From there on, nothing has changed except registers of the ``stack`` that were not ``live``
        there, and no statement has begun.
        """
        found: list[int] = []
        only_operands = False
        for place in self._body:
            step = self._steps[place]
            starts = place in self.targets or step.line >= 0 or not only_operands
            found.append(place if starts else found[-1])
            written = step.named((roles_of(step.name) or ("", ""))[1])
            is_pure = written.issubset(stack) and written.isdisjoint(live[found[-1]])
            only_operands = is_pure and (
                bool(written) or (step.is_jump and not step.name.startswith(("FOR_", "TEXT")))
            )
        return found

    def deferred(self, restarts: Sequence[int], live: Mapping[int, Collection[int]]) -> set[int]:
        """Return the sums and products whose overflow is detected by the step that uses them.

        A value that is not finite stays so in sums, products and numerators. The step that raises
        the fault is restarted before the overflow. No jump may lie between, as it could lead past
        that step.
        """
        found = set()
        for place in self._body:
            result = self._steps[place].a
            if not _FINDS_INFINITE.fullmatch(self._steps[place].name):
                continue
            for other in range(place + 1, self._body.stop):
                taker = self._steps[other]
                if restarts[other - self._body.start] > place or taker.is_jump:
                    break
                if self._reads(other, result):
                    if _finds_infinite(taker, result) and (
                        taker.a == result or result not in live[other + 1]
                    ):
                        found.add(place)
                    break
                if taker.a == result:  # it has not been read yet
                    break
        return found

    def _reads(self, place: int, register: int) -> bool:
        step = self._steps[place]
        roles = roles_of(step.name)
        return roles is None or register in step.named(roles[0])

    def assigned(
        self, given: Collection[int] = (), aliased: Container[int] = (), giving: Container[int] = ()
    ) -> dict[int, frozenset[int]]:
        """Definite assignment: return for each step the registers with a value on every path.

        ``given`` have a value from the beginning; ``giving`` are the routines with a result.
        ``aliased`` registers can lose their value through their address.
        """
        start = self._body[0]
        found: dict[int, frozenset[int]] = {start: frozenset(given)}
        todo = [start]
        while todo:
            place = todo.pop()
            step, known = self._steps[place], found[place]
            if step.name in CALLS:
                known = frozenset(one for one in known if one < step.a)
                known |= {step.a} if step.b in giving else set()
            else:
                read, written = map(step.named, roles_of(step.name) or ("", ""))
                if step.name == "PASS":
                    has_value = step.b in known and step.b not in aliased
                else:
                    has_value = step.name != "SET_K" or step.tag != 0
                    known |= read
                known = known | written if has_value else known - written
            for other in self.after(place):
                met = known & found.get(other, known)
                if met != found.get(other):
                    found[other] = met
                    todo.append(other)
        return found

    def blocks(self) -> tuple[dict[int, int], dict[int, int]]:
        """Basic blocks: statements that are counted together, since only a fault can come between.

        Return the number of statements of each block, by the first step of its first statement; and
        for each step the number of statements of its block that have not begun yet.
        """
        counted: dict[int, int] = {}
        begun: dict[int, tuple[int, int]] = {}
        leader = -1
        for place in self._body:
            step = self._steps[place]
            if place in self.targets:
                leader = -1
            if step.line >= 0:
                leader = place if leader < 0 else leader
                counted[leader] = counted.get(leader, 0) + 1
            if leader >= 0:
                begun[place] = leader, counted[leader]
            if step.is_jump or step.name in ("STOP", *CALLS, *ENDS, *INTERPRETED):
                leader = -1
        return counted, {place: counted[first] - count for place, (first, count) in begun.items()}
