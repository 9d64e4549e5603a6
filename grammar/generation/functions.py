"""Values from the controller, by type: predefined functions and system variables as patterns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.expressions import constant_or_place, expression, text
from grammar.generation.patterns import pattern, patterns
from grammar.generation.routine_writer import ExpressionRule, RoutineWriter
from grammar.generation.types import AXIS_TYPES, POSES, predefined, structure
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

_READERS: Final[tuple[tuple[str, Type], ...]] = (
    *(("STRTOINT", INT), ("STRTOREAL", REAL), ("STRTOBOOL", BOOL), ("STRTOSTRING", CHAR)),
    *((f"STRTO{type_.name}", type_) for type_ in (*POSES, *AXIS_TYPES)),
)
_POSE_TEXTS: Final = (
    *('"{X 1.5,Y -2,Z 3.0,A 10,B 0.0,C 90}"', '"{FRAME: X 1.0}"', '"{Q 1}"'),
    '"{X 1.0,Y 2.0,Z 3.0,A 0,B 0,C 0,S 2,T 35}"',
)
_AXIS_TEXTS: Final = ('"{A1 1.0,A2 -90,A3 90.0,A4 0,A5 0.5,A6 0}"', '"{A1 1.0,E1 100.0}"', '"A1"')
_READABLE: Final[Mapping[Type, tuple[str, ...]]] = {
    INT: ('"12"', '"-7"', '" 5"', '"2147483648"', '"1.5"', "\"'HFF'\""),
    REAL: ('"1.5"', '"-2.5E2"', '"7"', '"1E99"', '"x"'),
    BOOL: ('"TRUE"', '"false"', '"1"'),
    **dict.fromkeys(POSES, _POSE_TEXTS),
    **dict.fromkeys(AXIS_TYPES, _AXIS_TEXTS),
}


def _parse(code: RoutineWriter, depth: int) -> str:
    """Return a call of STRTO…; some of the texts can be converted, others cannot."""
    name, type_ = code.choices.pick(_READERS)
    if name == "STRTOSTRING":
        return pattern("STRTOSTRING(<text>, <letters>)")(code, depth)
    given = code.choices.pick(_READABLE[type_]) if code.choices.chance(70) else text(code)
    return f"{name}({given}, {constant_or_place(code, type_)})"


def _inverse(code: RoutineWriter, depth: int) -> str:
    return f"INV_POS({expression(code, code.choices.pick(POSES), min(depth - 1, 1))})"


def _risky(right: str, *wrong: str) -> ExpressionRule:
    """Return a rule for ``right``, or for one of ``wrong`` where a fault is to be provoked."""
    usual, others = pattern(right), [pattern(one) for one in wrong]

    def rule(code: RoutineWriter, depth: int) -> str:
        return (code.choices.pick(others) if code.risks() else usual)(code, depth)

    return rule


CONTROLLER_VALUES: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: patterns(
        (3, "STRLEN(<text>)"),
        (4, "STRDECLLEN(<letters>)"),
        (3, "STRADD(<letters>, <text>)"),
        (2, "STRFIND(<1|1|2|0>, <text>, <text>, <constant CASE_SENSE_T>)"),
        (1, "STRFIND(<atom INT>, <text>, <text>, <constant CASE_SENSE_T>)"),
        (1, "$TIMER[<1-16>]"),
        (4, "<$OV_PRO|$ADVANCE|$ERR.NUMBER|$APO.CPTP|$DATE.YEAR>"),
        (1, "<GETVARSIZE(#FLAG)|SYNC()|CHECKPIDONRDC()>"),
    ),
    REAL: patterns(
        (8, "<SIN|COS|ABS>(<REAL>)"),
        (3, _risky("SQRT(ABS(<REAL>))", "SQRT(-1.0)", "SQRT(<REAL>)", "SQRT(0.5-1)")),
        (3, _risky("ACOS(SIN(<REAL>))", "ACOS(1.5)", "ACOS(<REAL>)")),
        (3, _risky("TAN(0.3*SIN(<REAL>))", "TAN(90.0)", "TAN(-270)", "ATAN2(0.0,0.0)")),
        (3, "ATAN2(<REAL>, 1.0+ABS(<REAL>))"),
        (3, "FRAND(<constant REAL>, <constant REAL>)"),
        (3, "<$VEL.CP|$ACC.ORI1|$APO.CDIS|$BASE.X>"),
        (2, "<$ANIN|$ANOUT>[<1-16>]"),
        (2, "<$TOOL.A|$AXIS_ACT.A3|$POS_ACT.Z|$NULLFRAME.X|$LOAD.CM.X>"),
    ),
    BOOL: patterns(
        (4, "STRCOMP(<text>, <text>, <constant CASE_SENSE_T>)"),
        (3, "STRCOPY(<letters>, <text>)"),
        (2, "STRCLEAR(<letters>)"),
        (8, _parse),
        (8, "<$IN|$OUT|$FLAG|$CYCFLAG|$TIMER_FLAG>[<1-16>]"),
        (1, "EXISTS_KRLDLG(<atom INT>, <place INT>)"),
        (1, "EXISTS_KRLDLG(, <place INT>)"),  # an argument may be left out
        (1, "IS_KEY_PRESSED(<0-8>)"),
        (1, "WSPACETAKE(<1-8>, <INT>)"),
        (1, "GETSYSSTATE(<text>, <place INT>, <place REAL>)"),
        (1, "TIMER_LIMIT(<REAL>)"),
        (1, "$TIMER_STOP[<1-16>]"),
        (1, "<$STOPNOAPROX|$ON_PATH>"),
    ),
    predefined("VAR_STATE"): patterns((1, 'VARSTATE("<name>")')),
    predefined("VAR_TYPE"): patterns((1, 'VARTYPE("<name>")')),
    predefined("ORI_TYPE"): patterns((1, "$ORI_TYPE")),
    predefined("MODE_OP"): patterns((1, "$MODE_OP")),
    structure("FRAME"): patterns((1, "<$BASE|$TOOL|$NULLFRAME|$WORLD>")),
    structure("E6POS"): patterns(
        (2, _inverse), (1, "FORWARD(<atom E6AXIS>, <place INT>)"), (1, "<$POS_ACT|$POS_RET>")
    ),
    structure("E6AXIS"): patterns(
        (1, "INVERSE(<atom E6POS>, <atom E6AXIS>, <place INT>)"), (1, "<$AXIS_ACT|$H_POS>")
    ),
}
