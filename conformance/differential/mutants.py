"""Faults planted into the instructions of the machine in Python, by table.

A mutant replaces the maker of one instruction's operations by a wrong one (`interp.bytecode.kit`).
What can be wrong follows from the row of the instruction set: instructions with two operands take
them the wrong way round, those with a constant take its neighbour, jumps go the wrong way. What
would change nothing (the operands of a sum exchanged) is left out.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.isa import Shape, instructions
from interp.bytecode.kit import Here, Rule
from interp.bytecode.state import Operation, State
from interp.faults import fault

__all__ = ["Mutant", "Rules", "mutants"]

#: The makers of all instructions, those for the trace included.
Rules = Mapping[Op, Rule]
#: Makes the wrong maker from the right ones and the state of the machine.
Change = Callable[[Rules, State], Rule]

#: A mutant that never comes to an end is stopped.
_ENDLESS: Final = 100_000


@dataclass(frozen=True, slots=True)
class Mutant:
    """A planted fault: the instruction, and in words what it does wrong."""

    op: Op
    fault: str
    change: Change

    @property
    def name(self) -> str:
        """Both in one."""
        return f"{self.op.name}: {self.fault}"

    def rule(self, rules: Rules, state: State) -> Rule:
        """The wrong maker; its operations give up when they are called without end."""
        wrong = self.change(rules, state)
        left = [_ENDLESS]

        def made(here: Here, *operands: int) -> Operation:
            operation = wrong(here, *operands)

            def counted() -> Operation | None:
                left[0] -= 1
                if left[0] < 0:
                    raise AssertionError("this never ends")
                return operation()

            return counted

        return made


def mutants() -> tuple[Mutant, ...]:
    """All of them, in the order of the instruction set."""
    return tuple(
        Mutant(Op[row.name], words, change)
        for row in instructions()
        for words, change in (*_by_shape(row), *_OF_ITS_OWN.get(row.name, ()))
    )


# --------------------------------------------------------------------------------- ways to be wrong


def _before(act: Callable[[list[Any]], object], op: Op) -> Change:
    """Something is done to the stack first."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            right = rules[op](here, *operands)

            def operation() -> Operation | None:
                act(state.stack)
                return right()

            return operation

        return made

    return change


def _behind(act: Callable[[list[Any]], object], op: Op) -> Change:
    """Something is done to the stack afterwards, where the program goes on with the next."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            def after() -> Operation:
                act(state.stack)
                return here.after

            return rules[op](Here(here.code, here.place, here.body, after), *operands)

        return made

    return change


def _operands(alter: Callable[..., tuple[int, ...]], op: Op) -> Change:
    """The instruction is read with other operands."""

    def change(rules: Rules, _state: State) -> Rule:
        return lambda here, *operands: rules[op](here, *alter(*operands))

    return change


def _as(other: Op) -> Change:
    """It does what another instruction does."""
    return lambda rules, _state: rules[other]


def _instead(act: Callable[[State, Here, tuple[int, ...]], Operation]) -> Change:
    """It does something else altogether."""

    def change(_rules: Rules, state: State) -> Rule:
        return lambda here, *operands: act(state, here, operands)

    return change


def _computing(compute: Callable[..., Any], count: int = 2) -> Change:
    """It computes something else from its operands."""

    def act(state: State, here: Here, _operands: tuple[int, ...]) -> Operation:
        stack, after = state.stack, here.after

        def operation() -> Operation:
            given = stack[-count:]
            del stack[-count:]
            stack.append(compute(*given))
            return after

        return operation

    return _instead(act)


def _pushing(raw: int) -> Change:
    def act(state: State, here: Here, _operands: tuple[int, ...]) -> Operation:
        def operation() -> Operation:
            state.stack.append(raw)
            return here.after

        return operation

    return _instead(act)


def _taking(count: int, *, goes: bool) -> Change:
    """It takes so much from the stack, and always or never goes to its last operand."""

    def act(state: State, here: Here, operands: tuple[int, ...]) -> Operation:
        def operation() -> Operation:
            if count:
                del state.stack[-count:]
            return here.body[operands[-1]] if goes else here.after

        return operation

    return _instead(act)


def _quiet(op: Op, *slugs: str) -> Change:
    """A fault of these is not raised: what would be the result is 0."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            right = rules[op](here, *operands)
            takes = _TAKES[op]

            def operation() -> Operation | None:
                from interp.faults import Fault

                stack = state.stack
                height = len(stack)
                try:
                    return right()
                except Fault as error:
                    if error.slug not in slugs:
                        raise
                    del stack[height - takes :]
                    stack.append(0)
                    return here.after

            return operation

        return made

    return change


# --------------------------------------------------------------------------------- on the stack


def _exchange(stack: list[Any]) -> None:
    stack[-1], stack[-2] = stack[-2], stack[-1]


def _other_value(stack: list[Any]) -> None:
    stack[-1] = _other(stack[-1])


def _other(value: Any) -> Any:
    """Another value of the same type, as near as can be."""
    match value:
        case bool():
            return not value
        case float():
            return -1.5 if value == 0 else value * 1.0000002
        case int():
            return value + 1 if value < 2_147_483_647 else 0
    return value


def _nothing(_stack: list[Any]) -> None:
    return


def _wrapped(value: int) -> int:
    return (value + 2**31) % 2**32 - 2**31


# --------------------------------------------------------------------------------- by the row

_SYMMETRIC: Final = frozenset({"ADD", "MUL", "EQ", "NE", "AND", "OR", "EXOR"})
_PARTNERS: Final = {
    "ADD": "SUB", "SUB": "ADD", "MUL": "ADD", "DIV": "MUL", "EQ": "NE", "NE": "EQ", "LT": "LE",
    "LE": "LT", "GT": "GE", "GE": "GT", "AND": "OR", "OR": "EXOR", "EXOR": "OR",
}  # fmt: skip
_CONSTANTS: Final = frozenset({"PUSH_INT", "PUSH_CHAR", "PUSH_BOOL", "ADD_CONSTANT"})
_NEIGHBOURS: Final = frozenset(
    "LOAD_LOCAL LOAD_DATA STORE_LOCAL STORE_DATA REF_LOCAL REF_DATA MEMBER INDEX_LOCAL INDEX_DATA"
    " ELEMENT_LOCAL ELEMENT_DATA FOR_DATA".split()
)
_RESULTS: Final = frozenset(
    "LOAD_LOCAL LOAD_DATA LOAD ELEMENT_LOCAL ELEMENT_DATA PUSH_REAL PUSH_ENUM INT_TO_REAL"
    " REAL_TO_INT CHAR_TO_INT INT_TO_CHAR NEG_INT NEG_REAL NOT_BITS NOT_BOOL".split()
)
_READS: Final = frozenset({"LOAD_LOCAL", "LOAD_DATA", "LOAD", "ELEMENT_LOCAL", "ELEMENT_DATA"})
#: How much of the stack an instruction takes that a fault is taken from, of arrays one index.
_TAKES: Final = {
    Op.LOAD_LOCAL: 0, Op.LOAD_DATA: 0, Op.LOAD: 1, Op.ELEMENT_LOCAL: 1, Op.ELEMENT_DATA: 1,
    Op.DIV_INT: 2, Op.DIV_REAL: 2, Op.INT_TO_CHAR: 1, Op.REAL_TO_INT: 1, Op.INDEX_LOCAL: 1,
    Op.INDEX_DATA: 1,
}  # fmt: skip


def _by_shape(row: Shape) -> Iterator[tuple[str, Change]]:
    """What can be wrong with any instruction of this kind."""
    op = Op[row.name]
    family, _, kind = row.name.rpartition("_")
    is_binary = len(row.effect_text.partition("--")[0].split()) == 2 and family in _PARTNERS
    if is_binary:
        if family not in _SYMMETRIC:
            yield "the operands are exchanged", _before(_exchange, op)
        yield "the first operand is the result", _computing(lambda left, _right: left)
        yield "the result is a little off", _behind(_other_value, op)
        partner = Op.__members__.get(f"{_PARTNERS[family]}_{kind}")
        if partner is not None:
            yield f"does what {partner.name} does", _as(partner)
    if row.name.startswith("UNLESS_"):
        yield from _unless(row, op)
    if row.name in _CONSTANTS:
        yield (
            "the constant is one more",
            _operands(lambda n: (n ^ 1 if n in (0, 1) else n + 1,), op),
        )
    if row.name in _NEIGHBOURS:
        yield "means the next cell", _operands(lambda place, *rest: (place + 1, *rest), op)
    if row.name in _RESULTS:
        yield "the value is a little off", _behind(_other_value, op)
    if row.name in _READS:
        yield "no value is 0", _quiet(op, "uninitialised")
    if row.name.startswith("TELL"):
        yield "tells nothing", _instead(lambda _state, here, _operands: here.after)
        yield "tells twice", _twice(op)


def _unless(row: Shape, op: Op) -> Iterator[tuple[str, Change]]:
    _, relation, kind = row.name.split("_")
    partner = Op.__members__.get(f"UNLESS_{_PARTNERS[relation]}_{kind}")
    yield "never goes elsewhere", _taking(2, goes=False)
    yield "always goes elsewhere", _taking(2, goes=True)
    if partner is not None:
        yield f"does what {partner.name} does", _as(partner)
    if relation not in _SYMMETRIC:
        yield "the operands are exchanged", _before(_exchange, op)


def _twice(op: Op) -> Change:
    def change(rules: Rules, _state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            again = rules[op](here, *operands)
            return rules[op](Here(here.code, here.place, here.body, again), *operands)

        return made

    return change


# --------------------------------------------------------------------------------- of its own


def _floor(left: int, right: int) -> int:
    if right == 0:
        raise fault("division_by_zero")
    return left // right


def _truncated(number: float) -> int:
    return int(number)


def _half_to_even(number: float) -> int:
    if not -0x80000000 <= round(number) <= 0x7FFFFFFF:
        raise fault("overflow")
    return round(number)


def _wrapping(compute: Callable[[int, int], int]) -> list[tuple[str, Change]]:
    return [("an overflow goes round", _computing(lambda a, b: _wrapped(compute(a, b))))]


def _double(compute: Callable[[float, float], float]) -> list[tuple[str, Change]]:
    return [("the result is not rounded to single", _computing(compute))]


def _stored_not(op: Op) -> list[tuple[str, Change]]:
    takes = 2 if op is Op.STORE else 1
    return [("stores nothing", _taking(takes, goes=False))]


def _blocks(op: Op, takes: int) -> list[tuple[str, Change]]:
    """Instructions that write several cells."""

    def short(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            def after() -> Operation:
                state.cells[:] = state.cells
                state.cells[state.last] = None
                return here.after

            return rules[op](Here(here.code, here.place, here.body, after), *operands)

        return made

    found: list[tuple[str, Change]] = [("writes nothing", _taking(takes, goes=False))]
    if op is not Op.CLEAR:
        found.append(("the first cell gets no value", short))
    return found


def _clamped(op: Op) -> list[tuple[str, Change]]:
    return [
        ("counts from 0", _before(_other_value, op)),
        ("an index outside is 0", _quiet(op, "index")),
    ]


def _guard(_state: State, here: Here, _operands: tuple[int, ...]) -> Operation:
    return here.after


def _into_first_cell(state: State, here: Here, _operands: tuple[int, ...]) -> Operation:
    def operation() -> Operation:
        state.cells[state.fp] = state.stack.pop()
        return here.after

    return operation


def _indices_exchanged(op: Op) -> tuple[str, Change]:
    """With two indices and more the last two are exchanged."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            right = rules[op](here, *operands)

            def operation() -> Operation | None:
                stack = state.stack
                if len(stack) - state.base >= 2 and type(stack[-2]) is int:
                    _exchange(stack)
                return right()

            return operation

        return made

    return "the last two indices are exchanged", change


def _line(_rules: Rules, state: State) -> Rule:
    """Statements are neither counted nor told."""

    def made(here: Here, *_operands: int) -> Operation:
        def operation() -> Operation:
            state.statement = here.place
            return here.after

        return operation

    return made


def _line_not_counted(rules: Rules, state: State) -> Rule:
    def made(here: Here, *operands: int) -> Operation:
        right = rules[Op.LINE](here, *operands)

        def operation() -> Operation | None:
            if state.left > 1:
                state.left += 1
            return right()

        return operation

    return made


def _line_place_kept(rules: Rules, state: State) -> Rule:
    """The place of the statement stays that of the one before."""

    def made(here: Here, *operands: int) -> Operation:
        before: list[int] = []

        def after() -> Operation:
            state.statement = before[0] if before[0] >= 0 else here.place
            return here.after

        right = rules[Op.LINE](Here(here.code, here.place, here.body, after), *operands)

        def operation() -> Operation | None:
            before[:] = [state.statement]
            return right()

        return operation

    return made


def _case_always(_rules: Rules, state: State) -> Rule:
    def made(here: Here, _constant: int, target: int) -> Operation:
        def operation() -> Operation:
            state.stack.pop()
            return here.body[target]

        return operation

    return made


def _call_mixed(rules: Rules, state: State) -> Rule:
    """The frame is one cell too far on."""

    def made(here: Here, *operands: int) -> Operation:
        right = rules[Op.CALL](here, *operands)

        def operation() -> Operation | None:
            found = right()
            state.fp += 1
            state.cells.append(None)
            return found

        return operation

    return made


def _call_keeps_base(rules: Rules, state: State) -> Rule:
    """The statement that the routine began with counts as that of the caller."""

    def made(here: Here, *operands: int) -> Operation:
        right = rules[Op.CALL](here, *operands)

        def operation() -> Operation | None:
            statement = state.statement
            found = right()
            state.statement = statement
            return found

        return operation

    return made


def _call_keeps_cells(rules: Rules, state: State) -> Rule:
    """Local data has a value from the beginning."""

    def made(here: Here, *operands: int) -> Operation:
        right = rules[Op.CALL](here, *operands)

        def operation() -> Operation | None:
            found = right()
            cells = state.cells
            for place in range(state.fp, len(cells)):
                if cells[place] is None:
                    cells[place] = 0
            return found

        return operation

    return made


def _return_elsewhere(op: Op) -> Change:
    """The frame of the caller is not restored."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            right = rules[op](here, *operands)

            def operation() -> Operation | None:
                before = state.statement
                found = right()
                state.statement = before
                return found

            return operation

        return made

    return change


def _asked_for_more(op: Op) -> list[tuple[str, Change]]:
    return [
        ("the last input is a little off", _before(_change_top, op)),
        ("the result is a little off", _behind(_change_top, op)),
        ("is done twice", _again(op)),
    ]


def _change_top(stack: list[Any]) -> None:
    if stack:
        stack[-1] = _other(stack[-1])


def _again(op: Op) -> Change:
    """What it took is put back, and it is done again."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Here, *operands: int) -> Operation:
            def after() -> Operation | None:
                state.stack[:] = kept
                return again()

            kept: list[Any] = []
            again = rules[op](here, *operands)
            first = rules[op](Here(here.code, here.place, here.body, after), *operands)

            def operation() -> Operation | None:
                kept[:] = state.stack
                return first()

            return operation

        return made

    return change


def _for(op: Op) -> list[tuple[str, Change]]:
    return [
        ("the step is one more", _operands(lambda a, b, step, to: (a, b, step + 1, to), op)),
        ("never goes on", _taking(0, goes=False)),
        ("goes on once too often", _for_beyond(op)),
    ]


def _for_beyond(op: Op) -> Change:
    def change(rules: Rules, _state: State) -> Rule:
        def made(here: Here, counter: int, limit: int, step: int, target: int) -> Operation:
            gone: list[bool] = []

            def after() -> Operation:
                gone.append(True)
                return here.body[target] if len(gone) % 2 else here.after

            return rules[op](
                Here(here.code, here.place, here.body, after), counter, limit, step, target
            )

        return made

    return change


_OF_ITS_OWN: Final[Mapping[str, list[tuple[str, Change]]]] = {
    "LINE": [
        ("neither counts nor tells", _line),
        ("does not count", _line_not_counted),
        ("keeps the place of the statement before", _line_place_kept),
    ],
    "AT": [("keeps the line", _instead(_guard))],
    "JUMP": [("falls through", _taking(0, goes=False))],
    "JUMP_IF": [
        ("goes where the value is FALSE", _as(Op.JUMP_UNLESS)),
        ("never goes elsewhere", _taking(1, goes=False)),
        ("always goes elsewhere", _taking(1, goes=True)),
    ],
    "JUMP_UNLESS": [
        ("goes where the value is TRUE", _as(Op.JUMP_IF)),
        ("never goes elsewhere", _taking(1, goes=False)),
        ("always goes elsewhere", _taking(1, goes=True)),
    ],
    "CASE": [
        ("the constant is one more", _operands(lambda n, to: (n + 1, to), Op.CASE)),
        ("always fits", _case_always),
        ("never fits", _taking(0, goes=False)),
    ],
    "CALL": [
        ("the frame is one cell too far on", _call_mixed),
        (
            "the last two arguments are exchanged",
            _before(lambda stack: _exchange(stack) if len(stack) > 1 else None, Op.CALL),
        ),
        ("keeps the statement of the caller", _call_keeps_base),
        ("local data begins with 0", _call_keeps_cells),
    ],
    "RETURN": [("keeps the statement of the routine", _return_elsewhere(Op.RETURN))],
    "RETURN_VALUE": [
        ("the result is a little off", _before(_other_value, Op.RETURN_VALUE)),
        ("keeps the statement of the routine", _return_elsewhere(Op.RETURN_VALUE)),
    ],
    "ASK": _asked_for_more(Op.ASK),
    "BUILTIN": _asked_for_more(Op.BUILTIN),
    "PROCEED": [("does nothing", _instead(_guard))],
    "FAIL": [
        ("does nothing", _instead(_guard)),
        ("another fault", _operands(lambda code: ((code + 1) % 12,), Op.FAIL)),
    ],
    "PUSH_NOTHING": [
        (
            "pushes 0",
            _pushing(0),
        )
    ],
    "PUSH_NO_VIEW": [
        (
            "the view leads to the first cell",
            _behind(
                lambda stack: [stack.__setitem__(n, 0) for n in range(-1, -3, -1)], Op.PUSH_NO_VIEW
            ),
        )
    ],
    # That it drops nothing or too much would not be seen: nothing lies below, and all goes later.
    "DROP": [("puts the value into the first cell", _instead(_into_first_cell))],
    "STORE_LOCAL": _stored_not(Op.STORE_LOCAL),
    "STORE_DATA": _stored_not(Op.STORE_DATA),
    "STORE": [*_stored_not(Op.STORE), ("stores another value", _before(_other_value, Op.STORE))],
    "LOAD_REF": [("means the next cell behind", _behind(_other_value, Op.LOAD_REF))],
    "INDEX": [_indices_exchanged(Op.INDEX), ("counts from 0", _before(_other_value, Op.INDEX))],
    "INDEX_LOCAL": [_indices_exchanged(Op.INDEX_LOCAL), *_clamped(Op.INDEX_LOCAL)],
    "INDEX_DATA": [_indices_exchanged(Op.INDEX_DATA), *_clamped(Op.INDEX_DATA)],
    "INDEX_VIEW": [
        _indices_exchanged(Op.INDEX_VIEW),
        ("counts from 0", _before(_other_value, Op.INDEX_VIEW)),
        ("the element behind", _behind(_other_value, Op.INDEX_VIEW)),
    ],
    "ELEMENT_LOCAL": [*_clamped(Op.ELEMENT_LOCAL)],
    "ELEMENT_DATA": [*_clamped(Op.ELEMENT_DATA)],
    "VIEW": [("the last size is one more", _behind(_other_value, Op.VIEW))],
    "LOAD_VIEW": [("the last size is one more", _behind(_other_value, Op.LOAD_VIEW))],
    "ROW": [
        ("the last size is one more", _behind(_other_value, Op.ROW)),
        ("counts from 0", _before(_other_value, Op.ROW)),
    ],
    "ROW_VIEW": [
        ("the last size is one more", _behind(_other_value, Op.ROW_VIEW)),
        ("counts from 0", _before(_other_value, Op.ROW_VIEW)),
    ],
    "COPY": [
        *_blocks(Op.COPY, 2),
        ("copies the other way", _before(_exchange, Op.COPY)),
        ("copies the target", _before(lambda stack: stack.__setitem__(-1, stack[-2]), Op.COPY)),
    ],
    "CLEAR": _blocks(Op.CLEAR, 1),
    "FILL_POSE": [
        *_blocks(Op.FILL_POSE, 2),
        ("the other way", _before(_exchange, Op.FILL_POSE)),
    ],
    "FILL_ARRAY": [("the first cell gets no value", _blocks(Op.FILL_ARRAY, 4)[1][1])],
    "SET_TEXT": [
        ("writes nothing", _taking(2, goes=False)),
        (
            "one letter less",
            _before(lambda stack: stack.__setitem__(-1, max(stack[-1] - 1, 0)), Op.SET_TEXT),
        ),
    ],
    "ADD_INT": _wrapping(operator.add),
    "SUB_INT": _wrapping(operator.sub),
    "MUL_INT": _wrapping(operator.mul),
    "DIV_INT": [
        ("rounds down", _computing(_floor)),
        ("a division by zero is 0", _quiet(Op.DIV_INT, "division_by_zero")),
    ],
    "NEG_INT": [("keeps the sign", _instead(_guard))],
    "ADD_REAL": _double(operator.add),
    "SUB_REAL": _double(operator.sub),
    "MUL_REAL": _double(operator.mul),
    "DIV_REAL": [("a division by zero is 0", _quiet(Op.DIV_REAL, "division_by_zero"))],
    "NEG_REAL": [("keeps the sign", _instead(_guard))],
    "NOT_BOOL": [("keeps the value", _instead(_guard))],
    "NOT_BITS": [("the sign only", _as(Op.NEG_INT))],
    "COMPOSE": [
        ("the poses are exchanged", _before(_exchange, Op.COMPOSE)),
        (
            "the first pose twice",
            _before(lambda stack: stack.__setitem__(-1, stack[-2]), Op.COMPOSE),
        ),
    ],
    "INT_TO_REAL": [
        ("stays an INT", _instead(_guard)),
        ("is not rounded to single", _computing(float, 1)),
    ],
    "REAL_TO_INT": [
        ("drops the fraction", _computing(_truncated, 1)),
        ("halves go to the even number", _computing(_half_to_even, 1)),
        ("stays a REAL", _instead(_guard)),
    ],
    "INT_TO_CHAR": [("a code outside is 0", _quiet(Op.INT_TO_CHAR, "inadmissible"))],
    "FOR_LOCAL": _for(Op.FOR_LOCAL),
    "FOR_DATA": _for(Op.FOR_DATA),
    "TELL_BRANCH": [("tells another way", _operands(lambda way: (way + 1,), Op.TELL_BRANCH))],
}
