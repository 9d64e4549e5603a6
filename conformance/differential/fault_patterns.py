"""Ways for an instruction to be wrong: how a right maker of operations becomes a wrong one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.vm.context import Rule, Site
from interp.bytecode.vm.state import Operation, State
from interp.values.faults import Fault

#: The makers of all instructions, those for the trace included.
Rules = Mapping[Op, Rule]
#: Makes the wrong maker from the right ones and the state of the machine.
Change = Callable[[Rules, State], Rule]

#: How much of the stack an instruction takes that a fault is taken from, of arrays one index.
_TAKES: Final = {
    Op.LOAD_LOCAL: 0, Op.LOAD_DATA: 0, Op.LOAD: 1, Op.ELEMENT_LOCAL: 1, Op.ELEMENT_DATA: 1,
    Op.DIV_INT: 2, Op.DIV_REAL: 2, Op.INT_TO_CHAR: 1, Op.REAL_TO_INT: 1, Op.INDEX_LOCAL: 1,
    Op.INDEX_DATA: 1,
}  # fmt: skip


def around(act: Callable[[State, Operation], Operation | None], op: Op) -> Change:
    """The right operation is done by something that does more or less beside it."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Site, *operands: int) -> Operation:
            right = rules[op](here, *operands)
            return lambda: act(state, right)

        return made

    return change


def before(act: Callable[[list[Any]], object], op: Op) -> Change:
    """Something is done to the stack first."""

    def first(state: State, right: Operation) -> Operation | None:
        act(state.stack)
        return right()

    return around(first, op)


def behind(act: Callable[[list[Any]], object], op: Op) -> Change:
    """Something is done to the stack afterwards, where the program goes on with the next."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Site, *operands: int) -> Operation:
            def after() -> Operation:
                act(state.stack)
                return here.after

            return rules[op](Site(here.code, here.place, here.body, after), *operands)

        return made

    return change


def with_operands(alter: Callable[..., tuple[int, ...]], op: Op) -> Change:
    """The instruction is read with other operands."""

    def change(rules: Rules, _state: State) -> Rule:
        return lambda here, *operands: rules[op](here, *alter(*operands))

    return change


def doing(other: Op) -> Change:
    """It does what another instruction does."""
    return lambda rules, _state: rules[other]


def instead(act: Callable[[State, Site, tuple[int, ...]], Operation]) -> Change:
    """It does something else altogether."""

    def change(_rules: Rules, state: State) -> Rule:
        return lambda here, *operands: act(state, here, operands)

    return change


def computing(compute: Callable[..., Any], count: int = 2) -> Change:
    """It computes something else from its operands."""

    def act(state: State, here: Site, _operands: tuple[int, ...]) -> Operation:
        stack, after = state.stack, here.after

        def operation() -> Operation:
            given = stack[-count:]
            del stack[-count:]
            stack.append(compute(*given))
            return after

        return operation

    return instead(act)


def pushing(raw: int) -> Change:
    """It pushes this."""

    def act(state: State, here: Site, _operands: tuple[int, ...]) -> Operation:
        def operation() -> Operation:
            state.stack.append(raw)
            return here.after

        return operation

    return instead(act)


def taking(count: int, *, goes: bool) -> Change:
    """It takes so much from the stack, and always or never goes to its last operand."""

    def act(state: State, here: Site, operands: tuple[int, ...]) -> Operation:
        def operation() -> Operation:
            if count:
                del state.stack[-count:]
            return here.body[operands[-1]] if goes else here.after

        return operation

    return instead(act)


def quiet(op: Op, *slugs: str) -> Change:
    """A fault of these is not raised: what would be the result is 0."""

    def change(rules: Rules, state: State) -> Rule:
        def made(here: Site, *operands: int) -> Operation:
            right = rules[op](here, *operands)
            takes = _TAKES[op]

            def operation() -> Operation | None:
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


def exchange(stack: list[Any]) -> None:
    """Exchange the two values on top."""
    stack[-1], stack[-2] = stack[-2], stack[-1]


def change_top(stack: list[Any]) -> None:
    """Put another value in place of the one on top."""
    stack[-1] = other_value(stack[-1])


def other_value(value: Any) -> Any:
    """Another value of the same type, as near as can be."""
    match value:
        case bool():
            return not value
        case float():
            return -1.5 if value == 0 else value * 1.0000002
        case int():
            return value + 1 if value < 2_147_483_647 else 0
    return value


def wrapped(value: int) -> int:
    """A number that went round at 32 bits."""
    return (value + 2**31) % 2**32 - 2**31


def twice(op: Op) -> Change:
    """It is done twice."""

    def change(rules: Rules, _state: State) -> Rule:
        def made(here: Site, *operands: int) -> Operation:
            again = rules[op](here, *operands)
            return rules[op](Site(here.code, here.place, here.body, again), *operands)

        return made

    return change
