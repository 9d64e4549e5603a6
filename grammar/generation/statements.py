"""Simple statements: assignments, calls, what acts on the world without moving the arm."""

from __future__ import annotations

from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.code import Code, SettingRule
from grammar.generation.expressions import (
    array,
    call_of,
    constant,
    expression,
    read,
    target,
    text,
    truth,
)
from grammar.generation.literals import AXIS_TYPES, POSES, TEXT, structure
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

__all__ = [
    "advance_setting",
    "assign_text",
    "assign_whole",
    "assignment",
    "call",
    "channel",
    "cyclic_flag",
    "cyclic_signal",
    "fixed_setting",
    "frame_setting",
    "halt",
    "invoke",
    "lasting_condition",
    "output",
    "proceed",
    "pulse",
    "set_variable",
    "value_setting",
    "wait",
]

_STATE: Final = structure("STATE_T")


# ------------------------------------------------------------------------- assignments, calls


def assignment(code: Code) -> bool:
    """A variable or a part of one is assigned."""
    code.spend()
    for _ in range(4):
        type_ = code.style.assigned(code)
        found = target(code, type_)
        if found is not None:
            return code.set(found, code.style.value(code, found, type_))
    return code.set("$FLAG[1]", "TRUE")


def assign_whole(code: Code) -> bool:
    """A structure or a whole array is assigned."""
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


def call(code: Code) -> bool:
    """A procedure is called, or a function for what it does; arguments may be left out."""
    result = code.choices.weighted(_CALLED) if code.style.is_closed else None
    found = code.scope.callable(result, code.left() - 2)
    if not found:
        return False
    code.spend()
    return code.line(call_of(code, code.choices.pick(found)))


_CALLED: Final = Weighted[Type | None]((6, None), (1, INT), (1, BOOL))


def proceed(code: Code) -> bool:
    """ON_ERROR_PROCEED, what may go wrong, and a look at $ERR [TYP-13]."""
    found = target(code, INT)
    if found is None:
        return False
    code.spend(3)
    before, code.risk = code.risk, 60 if code.style.is_closed else 0
    code.line("ON_ERROR_PROCEED")
    code.choices.weighted(code.style.risky)(code)
    code.risk = before
    return code.set(found, "$ERR.NUMBER")


# ------------------------------------------------------------------------- the controller


def set_variable(code: Code) -> bool:
    """A variable of the controller is assigned; ``?`` is a number in its name and its value."""
    found = code.choices.weighted(code.style.settings)(code)
    if found is not None:
        code.spend()
        number = str(code.choices.between(1, 16))
        code.set(*(text.replace("?", number) for text in found))
    return True


def fixed_setting(*settings: tuple[str, str]) -> SettingRule:
    """One of these."""
    return lambda code: code.choices.pick(settings)


def value_setting(type_: Type, *names: str) -> SettingRule:
    """One of these variables with a value of its type, of integers a small one."""

    def setting(code: Code) -> tuple[str, str]:
        if type_ == INT:
            return code.choices.pick(names), f"({expression(code, INT, 2)}) B_AND 63"
        return code.choices.pick(names), expression(code, type_, 2)

    return setting


def frame_setting(code: Code) -> tuple[str, str]:
    """The base or the tool, at times from a position with more components."""
    other = read(code, POSES[1]) if code.choices.chance(25) else None
    value = other or expression(code, POSES[0], 2)
    return code.choices.pick(("$BASE", "$TOOL")), value


def advance_setting(code: Code) -> tuple[str, str] | None:
    """How far the advance run goes; not within interrupts."""
    if code.part.is_action:
        return None
    return "$ADVANCE", str(code.choices.between(0, 5))


def output(code: Code) -> str:
    """An output that a program may set."""
    choices, style = code.choices, code.style
    if style.is_closed:
        return f"$OUT[{choices.between(1, 16)}]"
    names = code.scope.signals(is_output=True)
    return (
        choices.pick(names) if names and choices.chance(50) else f"$OUT[{choices.between(1, 512)}]"
    )


def lasting_condition(code: Code) -> str:
    """A condition without data of the routine and without functions [IOT-11]."""
    names = code.scope.signals(is_output=False) or [
        "$IN[1]",
        "$FLAG[2]",
        "$OUT[3]",
        "$TIMER[1]>100",
    ]
    left = code.choices.pick(names)
    sign = code.choices.pick(("AND", "OR", "EXOR"))
    return f"({left}) {sign} $FLAG[4]" if ">" in left else f"{left} {sign} $FLAG[4]"


def cyclic_flag(code: Code) -> bool:
    """A cyclical flag [IOT-11]."""
    condition = lasting_condition(code)
    code.spend()
    return code.set(f"$CYCFLAG[{code.choices.between(1, 8)}]", condition)


def pulse(code: Code) -> bool:
    """PULSE [IOT-07]."""
    name = output(code)
    code.spend()
    return code.call("PULSE", name, truth(code, 1), code.choices.pick(("0.1", "1", "0.5")))


def wait(code: Code) -> bool:
    """WAIT SEC, or WAIT FOR what comes to be true sooner or later."""
    choices = code.choices
    code.spend()
    if choices.chance(100 - code.style.wait_for_share):
        return code.line(f"WAIT SEC {choices.pick(('0', '0.5', '1', 'ABS(0.2)', '0.012'))}")
    if not code.style.is_closed:
        return code.line(f"WAIT FOR {truth(code, 1)}")
    number = choices.between(1, 16)
    condition = choices.pick(
        (
            f"$IN[{number}]",
            f"$IN[{number}] AND $IN[3]",
            f"($IN[{number}]) OR ({truth(code, 1)})",
            f"$IN[{number}]==TRUE",
            "TRUE",
        )
    )
    return code.line(f"WAIT FOR {condition}")


def halt(code: Code) -> bool:
    """HALT, CONFIRM and CONTINUE."""
    code.spend(2)
    confirm = f"CONFIRM {expression(code, INT, 1)}"
    return code.line(code.choices.weighted(Weighted((2, "HALT"), (2, confirm), (3, "CONTINUE"))))


def invoke(code: Code) -> bool:
    """A routine that only the world knows, for what it does."""
    choices = code.choices
    error = choices.pick(("ERR_CLEAR($ERR)", "ROB_STOP_RELEASE()", "DELETE_BACKWARD_BUFFER()"))
    code.spend()
    return code.line(choices.pick((error, f"WSPACEGIVE({choices.between(1, 4)})", "SYNC()")))


def channel(code: Code) -> bool:
    """A channel is opened, written to, closed [FCT-08]."""
    state, handle = target(code, _STATE), target(code, INT)
    if state is None or handle is None:
        return False
    code.spend(3)
    code.line(f"COPEN(:SER_1, {handle})")
    code.line(f'CWRITE({handle}, {state}, 1, "%d", {expression(code, INT, 1)})')
    return code.line(f"CCLOSE({handle}, {state})")


def cyclic_signal(code: Code) -> bool:
    """ANIN, ANOUT, DIGIN, on or off [IOT-04, IOT-05, IOT-09]."""
    choices, eq = code.choices, code.spelling.eq
    code.spend(2)
    way = choices.below(5)
    number = choices.between(1, 4)
    if way < 2:
        found = target(code, REAL, is_local=False)
        if found is None:
            return False
        factor = choices.pick(("1.0", "0.5", expression(code, REAL, 1)))
        source = "$DIGIN1" if way else f"$ANIN[{number}]"
        return code.line(f"{'DIGIN' if way else 'ANIN'} ON {found}{eq}{factor}*{source}+0.5")
    if way == 2:
        more = "".join(
            f" {word}{eq}{choices.pick(('0.0', '1', expression(code, REAL, 1)))}"
            for word in ("DELAY", "MINIMUM", "MAXIMUM")
            if choices.chance(50)
        )
        value = expression(code, REAL, 1)
        return code.line(f"ANOUT ON $ANOUT[{number}]{eq}{value}*0.5{more}")
    sources = (("ANIN", f"$ANIN[{number}]"), ("ANOUT", f"$ANOUT[{number}]"), ("DIGIN", "$DIGIN1"))
    word, source = choices.pick(sources)
    return code.line(f"{word} OFF {source}")


# ------------------------------------------------------------------------- texts


def assign_text(code: Code) -> bool:
    """A text is assigned as a whole [TYP-11]."""
    place = array(code, TEXT)
    if not place:
        return False
    code.spend()
    found = code.scope.callable(TEXT, code.left() - 1)
    if found and code.choices.chance(20):
        return code.set(place, call_of(code, code.choices.pick(found)))
    return code.set(place, text(code))
