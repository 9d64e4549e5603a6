"""What programs choose from: all of the language, in small programs that terminate."""

from __future__ import annotations

from typing import Final

from grammar.generation import control_flow, motions, statements
from grammar.generation.choices import Weighted
from grammar.generation.expressions import (
    chain,
    constant,
    constant_comparison,
    letter,
    letter_comparison,
    near_comparison,
    pose,
)
from grammar.generation.formatted_texts import format_text, scan_text
from grammar.generation.functions import CONTROLLER_VALUES
from grammar.generation.patterns import line, patterns
from grammar.generation.routine_writer import RoutineWriter, StatementRule, Style
from grammar.generation.types import POSES
from grammar.generation.unstated_effects import (
    count_beyond_range,
    order_of_evaluation,
    own_text,
)
from grammar.semantics.types import BOOL, CHAR, INT, REAL

_SWITCHED: Final = line("<$FLAG|$OUT>[<1-16>]=<BOOL>")


def _course(code: RoutineWriter) -> bool:
    """Write a sequence of motions as real programs have it: tool, base, a full PTP, then more.

    Most rules about motions only apply to such a sequence.
    """
    choices = code.choices
    code.spend(4)
    for name in ("TOOL", "BASE"):
        code.line(f"${name}=$NULLFRAME")
    code.line(f"PTP {{{motions.AXES_OF_ROBOT.format(90.0)}}}")
    for name in choices.pick((("VEL.CP",), ("APO.CDIS",), ("APO.CPTP", "VEL.CP"), ())):
        code.line(f"${name}={constant(code, REAL)}")
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
    (7, line("<$OUT|$OUT|$FLAG|$TIMER_STOP>[<1-16>]=<BOOL>", "$STOPNOAPROX=<BOOL>")),
    (3, line("<$VEL.CP|$VEL.ORI1|$ACC.CP|$APO.CDIS|$APO.CORI|$ANOUT[1]>=<REAL>")),
    (3, line("<$TIMER[1]|$TIMER[2]|$OV_PRO|$APO.CPTP>=(<INT>) B_AND 63")),
    (2, line("$ORI_TYPE=<#VAR|#CONSTANT>", "$CIRC_TYPE=#BASE", "$IPO_MODE=#TCP")),
    (1, line("$OUT_C[<1-16>]=<BOOL>", "$CP_VEL_TYPE=#CONSTANT", "$TARGET_STATUS=#SOURCE")),
    (3, statements.set_base),
    (2, statements.set_advance),
)

STYLE: Final = Style(
    expressions={
        INT: patterns(
            (12, "<atom INT>"),
            (12, chain(INT)),
            (12, "<operand INT> <+|-> <beside INT>"),
            (8, "<operand INT> * <factor INT>"),
            (8, "<operand INT> / <divisor INT>"),
            (13, "<operand INT> <B_AND|B_OR|B_EXOR|B_AND> <operand INT>"),
            (3, "<operand INT> <B_AND|B_OR|B_EXOR|B_AND> <operand CHAR>"),
            (4, "B_NOT <operand INT>"),
            (8, "<-|+><operand INT>"),
        ),
        REAL: patterns(
            (3, "<atom REAL>"),
            (2, chain(REAL)),
            (5, "<operand REAL> <+|-> <beside REAL>"),
            (3, "<operand REAL> * <factor REAL>"),
            (2, "<beside REAL> * <operand REAL>"),
            (3, "<operand REAL> / <divisor REAL>"),
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
        (9, "<operand INT> <order> <operand INT>"),
        (3, "<operand REAL> <order> <operand REAL>"),
        (5, "<operand REAL> <order> <operand INT>"),
        (3, letter_comparison),
        (2, "<operand CHAR> <order> <operand INT>"),
        (2, "<operand INT> <order> <operand CHAR>"),
        (6, "<operand BOOL> <equal> <operand BOOL>"),
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
        (4, control_flow.conditional_return),
        (16, statements.proceed),
        (6, statements.assign_missing),
        *_SETTINGS,
        (4, line("$CYCFLAG[<1-8>]=<lasting> <AND|OR|EXOR> $FLAG[4]")),
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
)
