"""Values from the controller: its functions and its variables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.code import Code, ExpressionRule
from grammar.generation.expressions import (
    array,
    constant,
    constant_or_place,
    expression,
    text,
)
from grammar.generation.literals import AXIS_TYPES, POSES, TEXT, predefined, structure
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

__all__ = [
    "CASES",
    "CONTROLLER_VALUES",
    "VAR_STATE",
    "VAR_TYPE",
    "add",
    "clear",
    "compare",
    "controller_variable",
    "direction",
    "find",
    "length",
    "root",
    "sine",
    "tangent",
]

CASES: Final = predefined("CASE_SENSE_T")
VAR_STATE: Final = predefined("VAR_STATE")
VAR_TYPE: Final = predefined("VAR_TYPE")


def controller_variable(*texts: str, numbers: int = 16) -> ExpressionRule:
    """A variable of the controller; ``?`` is a number from 1 to so many."""

    def rule(code: Code, _depth: int) -> str:
        return code.choices.pick(texts).replace("?", str(code.choices.between(1, numbers)))

    return rule


# ------------------------------------------------------------------------- numbers


def sine(code: Code, depth: int) -> str:
    """A sine, a cosine, an absolute value."""
    return f"{code.choices.pick(('SIN', 'COS', 'ABS'))}({expression(code, REAL, depth)})"


def root(code: Code, depth: int) -> str:
    """A square root, seldom of a negative number."""
    inner = expression(code, REAL, depth)
    if code.risks():
        return f"SQRT({code.choices.pick(('-1.0', inner, '0.5-1'))})"
    return f"SQRT(ABS({inner}))"


def _arc(code: Code, depth: int) -> str:
    inner = expression(code, REAL, depth)
    if code.risks():
        return code.choices.pick(("ACOS(1.5)", f"ACOS({inner})"))
    return f"ACOS(SIN({inner}))"


def tangent(code: Code, depth: int) -> str:
    """A tangent, seldom of a right angle."""
    if code.risks():
        return code.choices.pick(("TAN(90.0)", "TAN(-270)", "ATAN2(0.0,0.0)"))
    return f"TAN(0.3*SIN({expression(code, REAL, depth)}))"


def direction(code: Code, depth: int) -> str:
    """The angle of a direction."""
    one, other = expression(code, REAL, depth), expression(code, REAL, depth)
    return f"ATAN2({one}, 1.0+ABS({other}))"


def _random(code: Code, _depth: int) -> str:
    return f"FRAND({constant(code, REAL)}, {constant(code, REAL)})"


def _inverse(code: Code, depth: int) -> str:
    return f"INV_POS({expression(code, code.choices.pick(POSES), min(depth, 1))})"


# ------------------------------------------------------------------------- texts


def _letters(code: Code) -> str:
    """A text that can be changed."""
    return array(code, TEXT) or '"abc"'


def length(code: Code, _depth: int) -> str:
    """How long a text is."""
    return f"STRLEN({text(code)})"


def _declared_length(code: Code, _depth: int) -> str:
    return f"STRDECLLEN({_letters(code)})"


def add(code: Code, _depth: int) -> str:
    """A text is put behind another; its new length."""
    return f"STRADD({_letters(code)}, {text(code)})"


def find(code: Code, _depth: int) -> str:
    """Where a text is in another."""
    start = code.choices.pick(("1", "1", "2", "0", expression(code, INT, 1)))
    mode = constant(code, CASES)
    return f"STRFIND({start}, {text(code)}, {text(code)}, {mode})"


def compare(code: Code, _depth: int) -> str:
    """Whether two texts are equal."""
    return f"STRCOMP({text(code)}, {text(code)}, {constant(code, CASES)})"


def _copy(code: Code, _depth: int) -> str:
    return f"STRCOPY({_letters(code)}, {text(code)})"


def clear(code: Code, _depth: int) -> str:
    """A text is emptied; whether it was."""
    return f"STRCLEAR({_letters(code)})"


def _parse(code: Code, _depth: int) -> str:
    """STRTO…: some texts can be read, some cannot."""
    name, type_ = code.choices.pick(_READERS)
    if name == "STRTOSTRING":
        return f"STRTOSTRING({text(code)}, {_letters(code)})"
    given = code.choices.pick(_READABLE[type_]) if code.choices.chance(70) else text(code)
    return f"{name}({given}, {constant_or_place(code, type_)})"


# ------------------------------------------------------------------------- the rest


def _named(code: Code) -> str:
    """The name of a variable that is there, or of none, as a text."""
    names = [one.name for one in code.scope.variables()]
    return f'"{code.choices.pick([*names, "NOWHERE", "$VEL.CP"])}"'


def _state(code: Code, _depth: int) -> str:
    return f"VARSTATE({_named(code)})"


def _type(code: Code, _depth: int) -> str:
    return f"VARTYPE({_named(code)})"


def _forward(code: Code, _depth: int) -> str:
    return f"FORWARD({expression(code, AXIS_TYPES[2], 0)}, {constant_or_place(code, INT)})"


def _back(code: Code, _depth: int) -> str:
    end, start = expression(code, POSES[3], 0), expression(code, AXIS_TYPES[2], 0)
    return f"INVERSE({end}, {start}, {constant_or_place(code, INT)})"


def _asked(code: Code, _depth: int) -> str:
    """Functions that only the world can answer, with a truth value."""
    choices = code.choices
    match choices.below(5):
        case 0:
            handle = choices.pick(("", expression(code, INT, 1)))  # one may be left out
            return f"EXISTS_KRLDLG({handle}, {constant_or_place(code, INT)})"
        case 1:
            return f"IS_KEY_PRESSED({choices.below(9)})"
        case 2:
            return f"WSPACETAKE({choices.between(1, 8)}, {expression(code, INT, 1)})"
        case 3:
            name, number = text(code), constant_or_place(code, INT)
            return f"GETSYSSTATE({name}, {number}, {constant_or_place(code, REAL)})"
    return f"TIMER_LIMIT({expression(code, REAL, 1)})"


def _number_asked(code: Code, _depth: int) -> str:
    """Functions that only the world can answer, with a number."""
    return code.choices.pick(("GETVARSIZE(#FLAG)", "SYNC()", "CHECKPIDONRDC()"))


_READERS: Final[tuple[tuple[str, Type], ...]] = (
    ("STRTOINT", INT),
    ("STRTOREAL", REAL),
    ("STRTOBOOL", BOOL),
    ("STRTOSTRING", CHAR),
    *((f"STRTO{type_.name}", type_) for type_ in (*POSES, *AXIS_TYPES)),
)
_POSE_TEXTS: Final = (
    '"{X 1.5,Y -2,Z 3.0,A 10,B 0.0,C 90}"',
    '"{FRAME: X 1.0}"',
    '"{X 1.0,Y 2.0,Z 3.0,A 0,B 0,C 0,S 2,T 35}"',
    '"{Q 1}"',
)
_AXIS_TEXTS: Final = ('"{A1 1.0,A2 -90,A3 90.0,A4 0,A5 0.5,A6 0}"', '"{A1 1.0,E1 100.0}"', '"A1"')
_READABLE: Final[Mapping[Type, tuple[str, ...]]] = {
    INT: ('"12"', '"-7"', '" 5"', '"2147483648"', '"1.5"', "\"'HFF'\""),
    REAL: ('"1.5"', '"-2.5E2"', '"7"', '"1E99"', '"x"'),
    BOOL: ('"TRUE"', '"false"', '"1"'),
    **dict.fromkeys(POSES, _POSE_TEXTS),
    **dict.fromkeys(AXIS_TYPES, _AXIS_TEXTS),
}

CONTROLLER_VALUES: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: Weighted(
        (3, length),
        (4, _declared_length),
        (3, add),
        (3, find),
        (
            5,
            controller_variable(
                "$TIMER[?]", "$OV_PRO", "$ADVANCE", "$ERR.NUMBER", "$APO.CPTP", "$DATE.YEAR"
            ),
        ),
        (1, _number_asked),
    ),
    REAL: Weighted(
        (8, sine),
        (3, root),
        (3, _arc),
        (3, tangent),
        (3, direction),
        (3, _random),
        (
            5,
            controller_variable(
                "$VEL.CP", "$ACC.ORI1", "$APO.CDIS", "$ANIN[?]", "$ANOUT[?]", "$BASE.X"
            ),
        ),
        (
            2,
            controller_variable(
                "$TOOL.A", "$AXIS_ACT.A3", "$POS_ACT.Z", "$NULLFRAME.X", "$LOAD.CM.X"
            ),
        ),
    ),
    BOOL: Weighted(
        (4, compare),
        (3, _copy),
        (2, clear),
        (8, _parse),
        (
            8,
            controller_variable("$IN[?]", "$OUT[?]", "$FLAG[?]", "$CYCFLAG[?]", "$TIMER_FLAG[?]"),
        ),
        (4, _asked),
        (2, controller_variable("$TIMER_STOP[?]", "$STOPNOAPROX", "$ON_PATH")),
    ),
    VAR_STATE: Weighted((1, _state)),
    VAR_TYPE: Weighted((1, _type)),
    predefined("ORI_TYPE"): Weighted((1, controller_variable("$ORI_TYPE"))),
    predefined("MODE_OP"): Weighted((1, controller_variable("$MODE_OP"))),
    structure("FRAME"): Weighted(
        (3, controller_variable("$BASE", "$TOOL", "$NULLFRAME", "$WORLD")),
    ),
    structure("E6POS"): Weighted(
        (2, _inverse),
        (1, _forward),
        (1, controller_variable("$POS_ACT", "$POS_RET")),
    ),
    structure("E6AXIS"): Weighted((1, _back), (1, controller_variable("$AXIS_ACT", "$H_POS"))),
}
