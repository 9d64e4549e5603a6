"""Simple statements: assignments, calls, inputs and outputs.

A rule writes a statement with a `RoutineWriter` and returns ``True``. If the scope lacks what the
statement needs, it writes nothing and returns ``False``.
"""

from __future__ import annotations

from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.expressions import array, call_of, constant, expression, read, target, text
from grammar.generation.routine_writer import RoutineWriter
from grammar.generation.types import AXIS_TYPES, COLOUR, MODE, POINT, POSES, RECORD, STATE, TEXT
from grammar.generation.values import assigned_value
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

_ASSIGNED: Final = Weighted[Type](
    (8, INT), (6, REAL), (4, BOOL), (3, CHAR), (2, COLOUR), (1, MODE), (1, POINT), (1, RECORD)
)


# ------------------------------------------------------------------------- assignments, calls


def assignment(code: RoutineWriter) -> bool:
    """Write an assignment to a variable or a part of one."""
    code.spend()
    for _ in range(4):
        type_ = code.choices.weighted(_ASSIGNED)
        found = target(code, type_)
        if found is not None:
            return code.set(found, assigned_value(code, type_))
    return code.set("$FLAG[1]", "TRUE")


def assign_missing(code: RoutineWriter) -> bool:
    """Write an assignment with an index that is often invalid or a value that is often missing."""
    if not code.risk:
        return False
    before, code.risk = code.risk, 100
    type_ = code.choices.weighted(_ASSIGNED)
    drawn = [one for _ in range(8) if (one := target(code, type_)) and "[" in one]
    value = read(code, type_)
    code.risk = before
    if not drawn or value is None:
        return False
    code.spend()
    # A wrong index is the longer one: a sum, whose value the checker does not know.
    return code.set(max(drawn, key=len), value)


def assign_whole(code: RoutineWriter) -> bool:
    """Write an assignment of a structure or a whole array."""
    choices = code.choices
    if choices.chance(25):
        element = choices.pick((INT, REAL, CHAR, BOOL))
        rank = choices.weighted(_RANKS)
        type_ = Array(element, (None,) * rank)
        place, source = array(code, type_), array(code, type_)
        if place and source:
            code.spend()
            return code.set(place, source)
    kind = choices.pick((*POSES, *AXIS_TYPES))
    found = target(code, kind)
    if found is None:
        return False
    code.spend()
    if choices.chance(25):
        return code.set(found, constant(code, kind))
    family = POSES if kind in POSES else AXIS_TYPES
    other = read(code, choices.pick(family)) if choices.chance(40) else None
    return code.set(found, other or expression(code, kind, 2))


_RANKS: Final = Weighted((3, 1), (1, 2))


def call(code: RoutineWriter) -> bool:
    """Write a call of a procedure or, for its effect, of a function."""
    found = code.scope.callable(code.choices.weighted(_CALLED), code.left() - 2)
    if not found:
        return False
    code.spend()
    return code.line(call_of(code, code.choices.pick(found)))


_CALLED: Final = Weighted[Type | None]((6, None), (1, INT), (1, BOOL))


def proceed(code: RoutineWriter) -> bool:
    """Write ON_ERROR_PROCEED, a risky statement, and a read access to $ERR [TYP-13]."""
    found = target(code, INT)
    if found is None:
        return False
    code.spend(3)
    before, code.risk = code.risk, 60
    code.line("ON_ERROR_PROCEED")
    code.choices.weighted(code.style.risky)(code)
    code.risk = before
    return code.set(found, "$ERR.NUMBER")


# ------------------------------------------------------------------------- the controller


def set_base(code: RoutineWriter) -> bool:
    """Write an assignment to $BASE or $TOOL, sometimes from a type with more components."""
    other = read(code, POSES[1]) if code.choices.chance(25) else None
    value = other or expression(code, POSES[0], 2)
    code.spend()
    return code.set(code.choices.pick(("$BASE", "$TOOL")), value)


def set_advance(code: RoutineWriter) -> bool:
    """Write an assignment to $ADVANCE; not in interrupt routines."""
    if code.part.is_action:
        return False
    code.spend()
    return code.set("$ADVANCE", str(code.choices.between(0, 5)))


def channel(code: RoutineWriter) -> bool:
    """Write the opening, use and closing of a channel [FCT-08]."""
    state, handle = target(code, STATE), target(code, INT)
    if state is None or handle is None:
        return False
    code.spend(3)
    code.line(f"COPEN(:SER_1, {handle})")
    code.line(f'CWRITE({handle}, {state}, 1, "%d", {expression(code, INT, 1)})')
    return code.line(f"CCLOSE({handle}, {state})")


def input_signal(code: RoutineWriter) -> bool:
    """Write a cyclic ANIN or DIGIN into a global variable [IOT-04, IOT-09]."""
    found = target(code, REAL, is_local=False)
    if found is None:
        return False
    word, source = code.choices.pick((("ANIN", "$ANIN[1]"), ("DIGIN", "$DIGIN1")))
    factor = code.choices.pick(("1.0", "0.5", expression(code, REAL, 1)))
    code.spend(2)
    return code.line(f"{word} ON {found}={factor}*{source}+0.5")


# ------------------------------------------------------------------------- texts


def assign_text(code: RoutineWriter) -> bool:
    """Write an assignment of a whole text [TYP-11]."""
    place = array(code, TEXT)
    if not place:
        return False
    code.spend()
    found = code.scope.callable(TEXT, code.left() - 1)
    if found and code.choices.chance(20):
        return code.set(place, call_of(code, code.choices.pick(found)))
    return code.set(place, text(code))
