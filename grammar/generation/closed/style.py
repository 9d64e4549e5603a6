"""The style of closed programs: all of the language, in small programs that terminate."""

from __future__ import annotations

from typing import Final

from grammar.generation import control_flow, motions, statements
from grammar.generation.choices import Choices, Weighted
from grammar.generation.closed.formatted_texts import format_text, scan_text
from grammar.generation.closed.types import COLOUR, MODE, POINT, RECORD
from grammar.generation.closed.unstated_effects import (
    count_beyond_range,
    order_of_evaluation,
    own_text,
)
from grammar.generation.closed.values import assigned_value
from grammar.generation.code import Code, StatementRule, Style
from grammar.generation.expressions import (
    atom,
    chain,
    constant,
    constant_comparison,
    expression,
    letter,
    letter_comparison,
    near_comparison,
    pose,
)
from grammar.generation.functions import CONTROLLER_VALUES
from grammar.generation.layout import Layout
from grammar.generation.literals import AXIS_TYPES, POSES, TEXT, Literals, predefined
from grammar.generation.patterns import line, patterns
from grammar.generation.scope import Parameter
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

PLAIN: Final[tuple[Type, ...]] = (INT, INT, REAL, REAL, BOOL, CHAR, COLOUR)
RESULTS: Final = Weighted[Type](
    (5, INT),
    (4, REAL),
    (4, BOOL),
    (2, CHAR),
    (2, COLOUR),
    (2, POINT),
    (2, POSES[0]),
    (1, POSES[3]),
    (2, Array(CHAR, (8,))),
)
_LITERALS: Final = Literals(
    integers=(
        *("0", "1", "2", "3", "4", "5", "7", "8", "10", "12", "31", "64", "100", "255", "1000"),
        *("'B101'", "'HF'", "'H7F'", "'B0110'", "32767"),
    ),
    large=(
        *("2147483647", "16777217", "'HFFFFFFFF'", "'H80000000'", "65536", "1073741824"),
        "99999999",
    ),
    reals=(
        *("0.0", "0.5", "1.0", "1.5", "2.0", "0.1", "3.25", "10.0", "45.0", "90.0", "0.25"),
        *("100.0", "2.5", "3.5", "0.333333333", "1.0E-3", "2.5E+2", "12.3456789", "180.0"),
        *("7.0E1", "1.0E-45"),
    ),
    letters="AZaz09 +.x",
    texts=(
        *("", "A", "abc", "KRL", "a b", "12", "-7", "3.5", "xyz12", "TRUE", "Hello World"),
        *(" 7 ", "+1.E5", "1e400", "2147483648", "-2147483648", "0x1F", "tRuE", ".5e-3 9"),
    ),
    incomplete=1,
)
_ARRAYS: Final[tuple[Array, ...]] = (
    Array(INT, (None,)),
    TEXT,
    Array(INT, (None, None)),
    Array(REAL, (None,)),
    TEXT,
    Array(CHAR, (None, None)),
    Array(POINT, (None,)),
    Array(INT, (None, None, None)),
)
_ASSIGNED: Final = Weighted[Type](
    (8, INT), (6, REAL), (4, BOOL), (3, CHAR), (2, COLOUR), (1, MODE), (1, POINT), (1, RECORD)
)
_SELECTORS: Final[tuple[Type, ...]] = (INT, CHAR, COLOUR, MODE, INT)
_VAR_STATE: Final = predefined("VAR_STATE")
_ENUMERATIONS: Final = Weighted[Type](
    (4, COLOUR),
    (2, MODE),
    (2, _VAR_STATE),
    (2, predefined("VAR_TYPE")),
    (1, predefined("ORI_TYPE")),
    (1, predefined("MODE_OP")),
    (1, predefined("CASE_SENSE_T")),
)
_CRITERIA: Final = (
    *("", "", "", " C_PTP", " C_DIS", " C_ORI", " C_VEL", " C_PTP C_DIS", " C_DIS C_ORI"),
)
_AXES_OF_ROBOT: Final = "A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 {0},A6 0.0"


def _parameter(choices: Choices, has_arrays: bool) -> Parameter:
    if has_arrays and choices.chance(40):
        array = choices.pick(_ARRAYS)
        is_in = array == TEXT and choices.chance(50)  # no other array is [SCO-07]
        return Parameter("", array, is_out=not is_in)
    type_ = choices.pick((*PLAIN, POINT, POSES[0], POSES[3], AXIS_TYPES[2]))
    is_out = choices.chance(50)
    return Parameter("", type_, is_out, not is_out or choices.chance(60))


def _compared(code: Code) -> Type:
    type_ = code.choices.weighted(_ENUMERATIONS)
    return type_ if type_ in CONTROLLER_VALUES or code.scope.places(type_).holders else _VAR_STATE


def _goal(code: Code, kind: str) -> str:
    """Return a motion target: an aggregate, a variable, composed frames, or a function call."""
    choices = code.choices
    is_axis = "PTP" in kind
    if choices.chance(40):
        if is_axis and choices.chance(50):
            return "{" + _AXES_OF_ROBOT.format(constant(code, REAL)) + "}"
        more = choices.pick(("", ",S 2,T 35", ",S 6,T 27,E1 0.0"))
        return f"{{X {constant(code, REAL)},Y 0.0,Z 900.0,A 0.0,B 90.0,C 0.0{more}}}"
    if is_axis and choices.chance(30):
        return atom(code, choices.pick(AXIS_TYPES))
    found = expression(code, choices.pick(POSES), 2)
    return f"({found})" if choices.chance(10) else found


_SWITCHED: Final = line("<$FLAG|$OUT>[<1-16>]:=<BOOL>")


def _course(code: Code) -> bool:
    """Write a sequence of motions as real programs have it: tool, base, a full PTP, then more.

    Most rules about motions only apply to such a sequence.
    """
    choices, eq = code.choices, code.layout.eq
    code.spend(4)
    for name in ("TOOL", "BASE"):
        code.line(f"${name}{eq}$NULLFRAME")
    code.line(f"PTP {{{_AXES_OF_ROBOT.format(90.0)}}}")
    for name in choices.pick((("VEL.CP",), ("APO.CDIS",), ("APO.CPTP", "VEL.CP"), ())):
        code.line(f"${name}{eq}{constant(code, REAL)}")
    parts = (motions.motion, motions.motion, motions.trigger, motions.spline_motion)
    for _ in range(choices.between(2, 4)):
        choices.pick((*parts, motions.spline_block))(code)
        if choices.chance(30):
            _SWITCHED(code)
    return True


#: Conditions on variables that the controller computes.
_ASKED: Final = (
    *("<$VEL_ACT|$DISTANCE|$DIST_NEXT|$AXIS_ACT.A1|$POS_INT.X>>=0.0", "$ACT_ADVANCE<$NUM_AX"),
    *("$ROB_STOPPED", "$MODE_OP==#T1", "$PRO_MODE1==#GO", "$VEL_MA.CP>=$ACC_MA.CP"),
)
#: Assignments to system variables; an INT gets a small value, as it is a number, time or share.
_SETTINGS: Final = (
    (7, line("<$OUT|$OUT|$FLAG|$TIMER_STOP>[<1-16>]:=<BOOL>", "$STOPNOAPROX:=<BOOL>")),
    (3, line("<$VEL.CP|$VEL.ORI1|$ACC.CP|$APO.CDIS|$APO.CORI|$ANOUT[1]>:=<REAL>")),
    (3, line("<$TIMER[1]|$TIMER[2]|$OV_PRO|$APO.CPTP>:=(<INT>) B_AND 63")),
    (2, line("$ORI_TYPE:=<#VAR|#CONSTANT>", "$CIRC_TYPE:=#BASE", "$IPO_MODE:=#TCP")),
    (1, line("$OUT_C[<1-16>]:=<BOOL>", "$CP_VEL_TYPE:=#CONSTANT", "$TARGET_STATUS:=#SOURCE")),
    (3, statements.set_base),
    (2, statements.set_advance),
)

CLOSED: Final = Style(
    is_closed=True,
    layout=Layout(),
    literals=_LITERALS,
    expressions={
        INT: patterns(
            (12, "<atom INT>"),
            (12, chain(INT)),
            (12, "<operand INT>~<+|->~<beside INT>"),
            (8, "<operand INT>~*~<factor INT>"),
            (8, "<operand INT>~/~<divisor INT>"),
            (13, "<operand INT> <B_AND|B_OR|B_EXOR|B_AND> <operand INT>"),
            (3, "<operand INT> <B_AND|B_OR|B_EXOR|B_AND> <operand CHAR>"),
            (4, "B_NOT <operand INT>"),
            (8, "<-|+><operand INT>"),
        ),
        REAL: patterns(
            (3, "<atom REAL>"),
            (2, chain(REAL)),
            (5, "<operand REAL>~<+|->~<beside REAL>"),
            (3, "<operand REAL>~*~<factor REAL>"),
            (2, "<beside REAL>~*~<operand REAL>"),
            (3, "<operand REAL>~/~<divisor REAL>"),
            (2, "<-|+><operand REAL>"),
        ),
        BOOL: patterns(
            (4, "<atom BOOL>"),
            (18, "<relation>"),
            (7, "<operand BOOL> <AND|OR|EXOR> <operand BOOL>"),
            (7, "<operand BOOL> <AND|OR|EXOR> <operand BOOL> <AND|OR|EXOR> <operand BOOL>"),
            (4, "NOT <operand BOOL>"),
        ),
        CHAR: patterns((1, letter)),
        **{type_: patterns((1, pose(type_))) for type_ in POSES},
    },
    functions=CONTROLLER_VALUES,
    relations=patterns(
        (24, near_comparison),
        (9, "<operand INT>~<order>~<operand INT>"),
        (3, "<operand REAL>~<order>~<operand REAL>"),
        (5, "<operand REAL>~<order>~<operand INT>"),
        (3, letter_comparison),
        (2, "<operand CHAR>~<order>~<operand INT>"),
        (2, "<operand INT>~<order>~<operand CHAR>"),
        (6, "<operand BOOL>~<equal>~<operand BOOL>"),
        (12, constant_comparison),
    ),
    statements=Weighted(
        (80, statements.assignment),
        (24, statements.assign_whole),
        (20, statements.assign_text),
        (24, statements.call),
        (28, control_flow.branch),
        (16, control_flow.switch),
        (20, control_flow.loop_for),
        (12, control_flow.loop_while),
        (12, control_flow.loop_repeat),
        (12, control_flow.loop),
        (8, control_flow.backward_jump),
        (4, control_flow.give_back),
        (16, statements.proceed),
        (6, statements.assign_missing),
        *_SETTINGS,
        (4, line("$CYCFLAG[<1-8>]:=<lasting> <AND|OR|EXOR> $FLAG[4]")),
        (8, line("PULSE(<output>, <BOOL>, <0.1|1|0.5>)")),
        (4, line("WAIT SEC <0|0.5|1|ABS(0.2)|0.012>")),
        (
            4,
            line(
                *("WAIT FOR $IN[<1-16>]", "WAIT FOR $IN[<1-16>] AND $IN[3]", "WAIT FOR TRUE"),
                *("WAIT FOR ($IN[<1-16>]) OR (<BOOL>)", "WAIT FOR $IN[<1-16>]==TRUE"),
                *(f"WAIT FOR TRUE OR ({one})" for one in _ASKED),
            ),
        ),
        (2, line("HALT", cost=2)),
        (2, line("CONFIRM <INT>", cost=2)),
        (4, line("CONTINUE", cost=2)),
        (
            4,
            line(
                *("ERR_CLEAR($ERR)", "ROB_STOP_RELEASE()", "DELETE_BACKWARD_BUFFER()"),
                *("WSPACEGIVE(<1-4>)", "SYNC()"),
            ),
        ),
        (3, statements.input_signal),
        (2, line("ANOUT ON $ANOUT[<1-4>]=<REAL>*0.5 DELAY=<0.0|1> MAXIMUM=<REAL>", cost=2)),
        (1, line("ANOUT ON $ANOUT[<1-4>]=<REAL>*0.5 MINIMUM=<REAL>", cost=2)),
        (3, line("ANIN OFF $ANIN[<1-4>]", "ANOUT OFF $ANOUT[<1-4>]", "DIGIN OFF $DIGIN1")),
        (12, format_text),
        (8, scan_text),
        (6, own_text),
        (6, order_of_evaluation),
        (4, count_beyond_range),
        (20, motions.motion),
        (14, _course),
        (8, motions.spline_motion),
        (4, line('MOVE_EMI "<EMI1|A>" "START"', 'MOVE_EMI "<EMI1|A>" "START" FLT <REAL>')),
        (8, motions.spline_block),
        (8, motions.trigger),
        (16, motions.interrupt),
        (8, motions.brake),
    ),
    moving=Weighted((1, motions.motion)),
    risky=Weighted[StatementRule](
        (60, statements.assignment),
        (40, statements.assign_missing),
        *_SETTINGS,
        (20, statements.call),
        (20, control_flow.branch),
        (10, statements.assign_whole),
        (10, motions.motion),
        (10, control_flow.switch),
    ),
    assigned=lambda code: code.choices.weighted(_ASSIGNED),
    value=assigned_value,
    parameter=_parameter,
    selectors=lambda code: code.choices.pick(_SELECTORS),
    compared=_compared,
    goal=_goal,
    blend=lambda code, _kind: code.choices.pick(_CRITERIA),
    motions=Weighted(
        *((4, "PTP"), (4, "LIN"), (2, "CIRC"), (1, "PTP_REL"), (2, "LIN_REL"), (1, "CIRC_REL")),
        (1, "ASYPTP"),
    ),
    atoms={},
    jump_share=4,
)
