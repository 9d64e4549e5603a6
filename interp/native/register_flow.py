"""What is known of the steps of a routine before they run: where they lead, what registers hold.

Classical data-flow analyses, over single steps: each goes on until nothing changes any more.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from interp.native.register_code import CALLS, ENDS, Step, roles_of

__all__ = ["INTERPRETED", "RegisterFlow"]

#: Steps that are left to the interpreter.
INTERPRETED = ("PYTHON", "END_ACTION", "CHECK_CALL", "FAIL")


class RegisterFlow:
    """The steps at the places of ``body``, out of all ``steps`` of a program."""

    def __init__(self, steps: Sequence[Step], body: range) -> None:
        self._steps = steps
        self._body = body
        jumps = [(place, steps[place].d) for place in body if steps[place].is_jump]
        self._targets = {target for _, target in jumps}
        #: Where loops begin.
        self.loops = sorted({target for place, target in jumps if target <= place})

    def after(self, place: int) -> list[int]:
        """The places that may come next, within the routine."""
        step = self._steps[place]
        jump = [step.d] if step.is_jump else []
        return jump if step.name in ENDS else [*jump, place + 1]

    def live(self, stack: Collection[int]) -> dict[int, frozenset[int]]:
        """Liveness: by place, which of the stack of operands is read before it is written."""
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
            if step.name == "PYTHON":
                live = frozenset(one for one in whole if one < step.a)
            elif roles is None and step.name not in (*ENDS, "AT"):
                live = whole
            else:
                read, written = map(step.named, roles or ("", ""))
                later = frozenset[int]().union(*(found[one] for one in self.after(place)))
                live = (later - written) | whole.intersection(read)
            if live != found[place]:
                found[place] = live
                todo += before[place]
        return found

    def assigned(self) -> dict[int, frozenset[int]]:
        """Definite assignment: by place, the registers with a value on every way there."""
        start = self._body[0]
        found: dict[int, frozenset[int]] = {start: frozenset()}
        todo = [start]
        while todo:
            place = todo.pop()
            step, known = self._steps[place], found[place]
            if step.name in CALLS:
                known = frozenset(one for one in known if one < step.a)
            else:
                read, written = map(step.named, roles_of(step.name) or ("", ""))
                can_be_none = step.name == "PASS" or (step.name == "SET_K" and step.tag == 0)
                known |= read
                known = known - written if can_be_none else known | written
            for other in self.after(place):
                met = known & found.get(other, known)
                if met != found.get(other):
                    found[other] = met
                    todo.append(other)
        return found

    def blocks(self) -> tuple[dict[int, int], dict[int, int]]:
        """Basic blocks: statements that count together, as nothing but a fault can come between.

        How many a block has, by the first step of its first statement; and how many of its block
        have not begun yet, by step.
        """
        counted: dict[int, int] = {}
        begun: dict[int, tuple[int, int]] = {}
        leader = -1
        for place in self._body:
            step = self._steps[place]
            if place in self._targets:
                leader = -1
            if step.line >= 0:
                leader = place if leader < 0 else leader
                counted[leader] = counted.get(leader, 0) + 1
            if leader >= 0:
                begun[place] = leader, counted[leader]
            if step.is_jump or step.name in (*CALLS, *ENDS, *INTERPRETED):
                leader = -1
        return counted, {place: counted[first] - count for place, (first, count) in begun.items()}
