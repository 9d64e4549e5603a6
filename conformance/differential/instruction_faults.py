"""What can be wrong with single instructions, each in its own way."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any, Final

from conformance.differential.fault_patterns import (
    Change,
    Rules,
    around,
    before,
    behind,
    change_top,
    computing,
    doing,
    exchange,
    instead,
    other_value,
    pushing,
    quiet,
    taking,
    with_operands,
    wrapped,
)
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.vm.context import Rule, Site
from interp.bytecode.vm.state import Operation, State
from interp.values.faults import fault


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
    return [("an overflow goes round", computing(lambda a, b: wrapped(compute(a, b))))]


def _double(compute: Callable[[float, float], float]) -> list[tuple[str, Change]]:
    return [("the result is not rounded to single", computing(compute))]


def _stored_not(op: Op) -> list[tuple[str, Change]]:
    takes = 2 if op is Op.STORE else 1
    return [("stores nothing", taking(takes, goes=False))]


def _blocks(op: Op, takes: int) -> list[tuple[str, Change]]:
    """Instructions that write several cells."""
    nothing = ("writes nothing", taking(takes, goes=False))
    return [nothing] if op is Op.CLEAR else [nothing, _first_cell_empty(op)]


def _first_cell_empty(op: Op) -> tuple[str, Change]:
    def act(state: State, right: Operation) -> Operation | None:
        found = right()
        state.cells[state.last] = None
        return found

    return "the first cell gets no value", around(act, op)


def _clamped(op: Op) -> list[tuple[str, Change]]:
    return [
        ("counts from 0", before(change_top, op)),
        ("an index outside is 0", quiet(op, "index")),
    ]


def _guard(_state: State, here: Site, _operands: tuple[int, ...]) -> Operation:
    return here.after


def _into_first_cell(state: State, here: Site, _operands: tuple[int, ...]) -> Operation:
    def operation() -> Operation:
        state.cells[state.fp] = state.stack.pop()
        return here.after

    return operation


def _indices_exchanged(op: Op) -> tuple[str, Change]:
    """With two indices and more the last two are exchanged."""

    def act(state: State, right: Operation) -> Operation | None:
        stack = state.stack
        if len(stack) - state.base >= 2 and type(stack[-2]) is int:
            exchange(stack)
        return right()

    return "the last two indices are exchanged", around(act, op)


def _line_uncounted(state: State, here: Site, _operands: tuple[int, ...]) -> Operation:
    """Statements are neither counted nor reported."""

    def operation() -> Operation:
        state.statement = here.place
        return here.after

    return operation


def _line_not_counted(state: State, right: Operation) -> Operation | None:
    if state.left > 1:
        state.left += 1
    return right()


def _line_place_kept(state: State, right: Operation) -> Operation | None:
    """The place of the statement stays that of the one before."""
    before = state.statement
    found = right()
    if before >= 0:
        state.statement = before
    return found


def _case_always(state: State, here: Site, operands: tuple[int, ...]) -> Operation:
    def operation() -> Operation:
        state.stack.pop()
        return here.body[operands[1]]

    return operation


def _frame_moved(state: State, right: Operation) -> Operation | None:
    """The frame is one cell too far on."""
    found = right()
    state.fp += 1
    state.cells.append(None)
    return found


def _statement_kept(state: State, right: Operation) -> Operation | None:
    """The statement that the routine began with, or that of the caller, is not taken up."""
    statement = state.statement
    found = right()
    state.statement = statement
    return found


def _cells_zero(state: State, right: Operation) -> Operation | None:
    """Local data has a value from the beginning."""
    found = right()
    cells = state.cells
    for place in range(state.fp, len(cells)):
        if cells[place] is None:
            cells[place] = 0
    return found


def _asked_for_more(op: Op) -> list[tuple[str, Change]]:
    return [
        ("the last input is a little off", before(_change_top_if_any, op)),
        ("the result is a little off", behind(_change_top_if_any, op)),
        ("is done twice", _again(op)),
    ]


def _change_top_if_any(stack: list[Any]) -> None:
    if stack:
        stack[-1] = other_value(stack[-1])


def _again(op: Op) -> Change:
    """What it took is put back, and it is done again."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Site, *operands: int) -> Operation:
            def after() -> Operation | None:
                state.stack[:] = kept
                return again()

            kept: list[Any] = []
            again = rules[op](here, *operands)
            first = rules[op](Site(here.code, here.place, here.body, after), *operands)

            def operation() -> Operation | None:
                kept[:] = state.stack
                return first()

            return operation

        return made

    return change


def _for(op: Op) -> list[tuple[str, Change]]:
    return [
        ("the step is one more", with_operands(lambda a, b, step, to: (a, b, step + 1, to), op)),
        ("never goes on", taking(0, goes=False)),
        ("goes on once too often", _for_beyond(op)),
    ]


def _for_beyond(op: Op) -> Change:
    def change(rules: Rules, _state: State) -> Rule:
        def made(here: Site, counter: int, limit: int, step: int, target: int) -> Operation:
            gone: list[bool] = []

            def after() -> Operation:
                gone.append(True)
                return here.body[target] if len(gone) % 2 else here.after

            return rules[op](
                Site(here.code, here.place, here.body, after), counter, limit, step, target
            )

        return made

    return change


OF_ITS_OWN: Final[Mapping[str, list[tuple[str, Change]]]] = {
    "LINE": [
        ("neither counts nor reports", instead(_line_uncounted)),
        ("does not count", around(_line_not_counted, Op.LINE)),
        ("keeps the place of the statement before", around(_line_place_kept, Op.LINE)),
    ],
    "AT": [("keeps the line", instead(_guard))],
    "JUMP": [("falls through", taking(0, goes=False))],
    "JUMP_IF": [
        ("goes where the value is FALSE", doing(Op.JUMP_UNLESS)),
        ("never goes elsewhere", taking(1, goes=False)),
        ("always goes elsewhere", taking(1, goes=True)),
    ],
    "JUMP_UNLESS": [
        ("goes where the value is TRUE", doing(Op.JUMP_IF)),
        ("never goes elsewhere", taking(1, goes=False)),
        ("always goes elsewhere", taking(1, goes=True)),
    ],
    "CASE": [
        ("the constant is one more", with_operands(lambda n, to: (n + 1, to), Op.CASE)),
        ("always fits", instead(_case_always)),
        ("never fits", taking(0, goes=False)),
    ],
    "CALL": [
        ("the frame is one cell too far on", around(_frame_moved, Op.CALL)),
        (
            "the last two arguments are exchanged",
            before(lambda stack: exchange(stack) if len(stack) > 1 else None, Op.CALL),
        ),
        ("keeps the statement of the caller", around(_statement_kept, Op.CALL)),
        ("local data begins with 0", around(_cells_zero, Op.CALL)),
    ],
    "RETURN": [("keeps the statement of the routine", around(_statement_kept, Op.RETURN))],
    "RETURN_VALUE": [
        ("the result is a little off", before(change_top, Op.RETURN_VALUE)),
        ("keeps the statement of the routine", around(_statement_kept, Op.RETURN_VALUE)),
    ],
    "ASK": _asked_for_more(Op.ASK),
    "BUILTIN": _asked_for_more(Op.BUILTIN),
    "PROCEED": [("does nothing", instead(_guard))],
    "FAIL": [
        ("does nothing", instead(_guard)),
        ("another fault", with_operands(lambda code: ((code + 1) % 12,), Op.FAIL)),
    ],
    "PUSH_NOTHING": [("pushes 0", pushing(0))],
    "PUSH_NO_VIEW": [
        (
            "the view leads to the first cell",
            behind(
                lambda stack: [stack.__setitem__(n, 0) for n in range(-1, -3, -1)], Op.PUSH_NO_VIEW
            ),
        )
    ],
    # That it drops nothing or too much would not be seen: nothing lies below, and all goes later.
    "DROP": [("puts the value into the first cell", instead(_into_first_cell))],
    "STORE_LOCAL": _stored_not(Op.STORE_LOCAL),
    "STORE_DATA": _stored_not(Op.STORE_DATA),
    "STORE": [*_stored_not(Op.STORE), ("stores another value", before(change_top, Op.STORE))],
    "LOAD_REF": [("means the next cell behind", behind(change_top, Op.LOAD_REF))],
    "INDEX": [_indices_exchanged(Op.INDEX), ("counts from 0", before(change_top, Op.INDEX))],
    "INDEX_LOCAL": [_indices_exchanged(Op.INDEX_LOCAL), *_clamped(Op.INDEX_LOCAL)],
    "INDEX_DATA": [_indices_exchanged(Op.INDEX_DATA), *_clamped(Op.INDEX_DATA)],
    "INDEX_VIEW": [
        _indices_exchanged(Op.INDEX_VIEW),
        ("counts from 0", before(change_top, Op.INDEX_VIEW)),
        ("the element behind", behind(change_top, Op.INDEX_VIEW)),
    ],
    "ELEMENT_LOCAL": [*_clamped(Op.ELEMENT_LOCAL)],
    "ELEMENT_DATA": [*_clamped(Op.ELEMENT_DATA)],
    "VIEW": [("the last size is one more", behind(change_top, Op.VIEW))],
    "LOAD_VIEW": [("the last size is one more", behind(change_top, Op.LOAD_VIEW))],
    "PASS_VIEW": [
        ("the last size is one more", behind(change_top, Op.PASS_VIEW)),
        ("what was left out cannot be passed on", doing(Op.LOAD_VIEW)),
    ],
    "ROW": [
        ("the last size is one more", behind(change_top, Op.ROW)),
        ("counts from 0", before(change_top, Op.ROW)),
    ],
    "ROW_VIEW": [
        ("the last size is one more", behind(change_top, Op.ROW_VIEW)),
        ("counts from 0", before(change_top, Op.ROW_VIEW)),
    ],
    "COPY": [
        *_blocks(Op.COPY, 2),
        ("copies the other way", before(exchange, Op.COPY)),
        ("copies the target", before(lambda stack: stack.__setitem__(-1, stack[-2]), Op.COPY)),
    ],
    "CLEAR": _blocks(Op.CLEAR, 1),
    "FILL_POSE": [*_blocks(Op.FILL_POSE, 2), ("the other way", before(exchange, Op.FILL_POSE))],
    "FILL_ARRAY": [_first_cell_empty(Op.FILL_ARRAY)],
    "COPY_VIEW": [
        ("copies nothing", instead(_guard)),
        ("the last size is one more", behind(change_top, Op.COPY_VIEW)),
    ],
    "SET_TEXT": [
        ("writes nothing", taking(2, goes=False)),
        (
            "one letter less",
            before(lambda stack: stack.__setitem__(-1, max(stack[-1] - 1, 0)), Op.SET_TEXT),
        ),
    ],
    "ADD_INT": _wrapping(operator.add),
    "SUB_INT": _wrapping(operator.sub),
    "MUL_INT": _wrapping(operator.mul),
    "DIV_INT": [
        ("rounds down", computing(_floor)),
        ("a division by zero is 0", quiet(Op.DIV_INT, "division_by_zero")),
    ],
    "NEG_INT": [("keeps the sign", instead(_guard))],
    "ADD_REAL": _double(operator.add),
    "SUB_REAL": _double(operator.sub),
    "MUL_REAL": _double(operator.mul),
    "DIV_REAL": [("a division by zero is 0", quiet(Op.DIV_REAL, "division_by_zero"))],
    "NEG_REAL": [("keeps the sign", instead(_guard))],
    "NOT_BOOL": [("keeps the value", instead(_guard))],
    "NOT_BITS": [("the sign only", doing(Op.NEG_INT))],
    "COMPOSE": [
        ("the poses are exchanged", before(exchange, Op.COMPOSE)),
        (
            "the first pose twice",
            before(lambda stack: stack.__setitem__(-1, stack[-2]), Op.COMPOSE),
        ),
    ],
    "INT_TO_REAL": [
        ("stays an INT", instead(_guard)),
        ("is not rounded to single", computing(float, 1)),
    ],
    "REAL_TO_INT": [
        ("drops the fraction", computing(_truncated, 1)),
        ("halves go to the even number", computing(_half_to_even, 1)),
        ("stays a REAL", instead(_guard)),
    ],
    "INT_TO_CHAR": [("a code outside is 0", quiet(Op.INT_TO_CHAR, "inadmissible"))],
    "FOR_LOCAL": _for(Op.FOR_LOCAL),
    "FOR_DATA": _for(Op.FOR_DATA),
    "TELL_BRANCH": [("reports another way", with_operands(lambda way: (way + 1,), Op.TELL_BRANCH))],
}
