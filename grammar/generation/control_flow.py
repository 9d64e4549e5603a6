"""Blocks of statements: branches, loops, jumps, returns.

Every loop is bounded, by its limits or by its own counter. As in `statements`, a rule writes into a
`RoutineWriter` and returns whether it could.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Final

from grammar.generation.expressions import count, expression, operand, read, text, truth
from grammar.generation.routine_writer import RoutineWriter
from grammar.generation.scope import Variable
from grammar.generation.statements import assignment
from grammar.generation.types import COLOUR, MODE
from grammar.semantics.types import CHAR, INT, Array, Enumeration, Type

#: The least remaining budget with which a block gets another statement.
_RESERVE: Final = 12
_SELECTORS: Final[tuple[Type, ...]] = (INT, CHAR, COLOUR, MODE, INT)
#: Greatest depth of blocks in which a loop begins.
_DEEPEST: Final = 5


def statement(code: RoutineWriter) -> None:
    """Write a statement; an assignment if the drawn rule finds nothing to use."""
    if not code.choices.weighted(code.style.statements)(code):
        assignment(code)


def statements(code: RoutineWriter, most: int | None = None) -> None:
    """Write the statements of a block, at most ``most``."""
    choices = code.choices
    for _ in range(choices.between(1, most or code.size.statements)):
        if code.left() < _RESERVE:
            break
        if choices.chance(4):
            _forward_jump(code)
        else:
            statement(code)


# ------------------------------------------------------------------------- branches


def branch(code: RoutineWriter) -> bool:
    """Write an IF."""
    code.spend()
    code.line(f"IF {truth(code, code.choices.between(1, 2))} THEN")
    with code.indented():
        statements(code, 3)
    if code.choices.chance(50):
        code.line("ELSE")
        with code.indented():
            statements(code, 3)
    return code.line("ENDIF")


def switch(code: RoutineWriter) -> bool:
    """Write a SWITCH over INT, CHAR or an enumeration [CTL-03, CTL-04]."""
    choices = code.choices
    type_ = choices.pick(_SELECTORS)
    labels, most = _labels(type_), 3
    if is_long := type_ == INT and choices.chance(40):  # so long that a machine may use a table
        labels, most = [str(number) for number in range(-2, 28)], 30
    if type_ == INT:
        selector: str | None = f"({expression(code, INT, 1)}) B_AND 3"
    else:
        selector = read(code, type_)
    if selector is None:
        return False
    names = [
        one.variable.name for one in code.scope.places(type_).all if _is_constant(one.variable)
    ]
    code.spend()
    code.line(f"SWITCH {selector}")
    left = list(labels)
    while left and (len(left) == len(labels) or choices.chance(65)):
        count_ = choices.between(min(len(left), 12 if is_long else 1), min(len(left), most))
        given, left = left[:count_], left[count_:]
        if names and choices.chance(20):
            given.append(choices.pick(names))
        code.line(f"CASE {', '.join(given)}")
        with code.indented():
            statements(code, 2)
    if choices.chance(60):
        code.line("DEFAULT")
        with code.indented():
            statements(code, 2)
    return code.line("ENDSWITCH")


def _labels(type_: Type) -> Sequence[str]:
    if isinstance(type_, Enumeration):
        return [f"#{name}" for name in type_.constants]
    if type_ == CHAR:
        return ['"A"', '"Z"', '"a"', '" "', '"x"', '"0"']
    return ["0", "1", "-1", "2", "3", "'HF'", "100"]


def _is_constant(variable: Variable) -> bool:
    return not variable.is_writable and not isinstance(variable.type, Array)


# ------------------------------------------------------------------------- loops


def _times(code: RoutineWriter) -> int:
    """Return how often a loop is to run; 0 if the budget has no room for one."""
    room = code.left() // 12
    if code.loops >= 3 or code.level > _DEEPEST or room < 1:
        return 0
    return code.choices.between(1, min(5, room))


def loop_for(code: RoutineWriter) -> bool:
    """Write a FOR, upwards or downwards, with or without constant limits [CTL-05]."""
    choices = code.choices
    times, spare = _times(code), code.spare()
    if not times or not spare:
        return False
    name = choices.pick(spare)
    begin, end, step, low, high, times = _limits(code, times)
    written = "" if step == 1 and choices.chance(60) else f" STEP {step}"
    code.spend(2)
    with (
        code.block(f"FOR {name}={begin} TO {end}{written}", "ENDFOR"),
        code.repeated(times + 1),
    ):
        code.spend()
        count(code, name, low, high)
        statements(code, 3)
        _leave(code)
    return True


def _limits(code: RoutineWriter, times: int) -> tuple[str, str, int, int, int, int]:
    """Return first and last value, step, least and greatest value, and number of passes."""
    choices = code.choices
    first, step = choices.pick((1, 1, 1, 0, -2)), choices.pick((1, 1, 1, 2, -1, -3))
    final = first + step * (times - 1)
    last = final + choices.between(0, abs(step) - 1) * (1 if step > 0 else -1)
    low, high = min(first, final), max(first, final)
    begin, end = str(first), str(last)
    way = choices.below(10)
    if way == 0:
        end = f"{last}+0*({expression(code, INT, 1)} B_AND 1)"
    elif way == 1:
        begin = f"({operand(code, INT, 1)} B_AND 0)+({first})"
    elif way == 2 and step == 1:
        end, low, high = f"({operand(code, INT, 1)} B_AND {3 if times >= 3 else 1})", first, 3
        times = max(3 - first + 1, 1)
    return begin, end, step, low, high, times


def _counted(code: RoutineWriter) -> tuple[str, int] | None:
    """Set an unused counter to zero; return its name and the number of passes."""
    times, spare = _times(code), code.spare()
    if not times or not spare:
        return None
    name = code.choices.pick(spare)
    code.spend()
    code.set(name, "0")
    return name, times


def _with_counter(
    write: Callable[[RoutineWriter, str, int], bool],
) -> Callable[[RoutineWriter], bool]:
    """Return a function that writes nothing if there is no counter; see `_counted`."""

    @wraps(write)
    def written(code: RoutineWriter) -> bool:
        found = _counted(code)
        return found is not None and write(code, *found)

    return written


@_with_counter
def loop_while(code: RoutineWriter, name: str, times: int) -> bool:
    """Write a WHILE [CTL-01]."""
    with code.repeated(times + 1):
        code.spend()
        condition = _both(code, code.choices.pick((f"{name}<{times}", f"{name}<>{times}")), "AND")
        with code.block(f"WHILE {condition}", "ENDWHILE"):
            _count(code, name, times)
            statements(code, 3)
            _leave(code)
    return True


@_with_counter
def loop_repeat(code: RoutineWriter, name: str, times: int) -> bool:
    """Write a REPEAT [CTL-01]."""
    code.line("REPEAT")
    with code.repeated(times):
        with code.indented():
            code.spend(2)
            _count(code, name, times)
            statements(code, 3)
            _leave(code)
        condition = _both(code, f"{name}>={times}", "OR")
    return code.line(f"UNTIL {condition}")


@_with_counter
def loop(code: RoutineWriter, name: str, times: int) -> bool:
    """Write a LOOP that is left by EXIT [CTL-01, CTL-02]."""
    with code.block("LOOP", "ENDLOOP"), code.repeated(times):
        code.spend(4)
        _count(code, name, times)
        statements(code, 3)
        code.guarded(f"{name}>={times}", "EXIT")
    return True


def _both(code: RoutineWriter, bound: str, word: str) -> str:
    """Return the condition of a loop: its bound, sometimes joined with a random condition."""
    return f"({bound}) {word} ({truth(code, 1)})" if code.choices.chance(40) else bound


def _count(code: RoutineWriter, name: str, times: int, low: int = 1) -> None:
    count(code, name, low, times)
    code.spend()
    code.set(name, f"{name}+1")


def _leave(code: RoutineWriter) -> None:
    """Write an EXIT sometimes."""
    if code.choices.chance(12):
        code.spend(2)
        code.guarded(truth(code, 1), "EXIT")


# ------------------------------------------------------------------------- jumps


def _forward_jump(code: RoutineWriter) -> None:
    """Write a GOTO to a later label, in the same block or out of blocks [CTL-07]."""
    label = code.names.new("L")
    code.spend(2)
    way = code.choices.below(3)
    found = _counted(code) if way == 2 else None
    if way == 1:
        code.guarded(truth(code), f"GOTO {label}")
    elif found is None:
        code.line(f"GOTO {label}")
    else:
        name, times = found
        with code.block("LOOP", "ENDLOOP"), code.repeated(times):
            code.spend(3)
            _count(code, name, times)
            code.guarded(f"({name}>={times}) OR ({truth(code, 1)})", f"GOTO {label}")
            statements(code, 2)
    if code.left() >= 12:
        statements(code, 2)
    code.line(f"{label}:")


@_with_counter
def backward_jump(code: RoutineWriter, name: str, times: int) -> bool:
    """Write a GOTO to an earlier label, bounded by a counter."""
    label = code.names.new("L")
    code.line(f"{label}:")
    with code.repeated(times, is_loop=False):
        code.spend(3)
        _count(code, name, times, low=0)
        statements(code, 3)
        return code.guarded(f"{name}<{times}", f"GOTO {label}")


def conditional_return(code: RoutineWriter) -> bool:
    """Write a conditional RETURN [CTL-09]."""
    if code.loops and code.choices.chance(50):
        return False
    code.spend(2)
    with code.block(f"IF {truth(code)} THEN", "ENDIF"):
        returned(code)
    return True


def returned(code: RoutineWriter) -> bool:
    """Write a RETURN, with a value in functions."""
    result = code.part.result
    if result is None:
        return code.line("RETURN")
    if isinstance(result, Array):
        return code.line(f"RETURN {text(code)}")
    value = expression(code, result, 2)
    if result == INT:
        value = f"({value}) B_AND 1023"
    return code.line(f"RETURN {value}")
