"""The style of closed programs: all of the language, in small programs that run to their end."""

from __future__ import annotations

from typing import Final

from grammar.generation.choices import Choices, Weighted
from grammar.generation.closed.formatted_texts import format_text, scan_text
from grammar.generation.closed.types import COLOUR, MODE, POINT, RECORD
from grammar.generation.closed.values import assigned_value
from grammar.generation.code import Code, Spelling, StatementRule, Style
from grammar.generation.control_flow import (
    backward_jump,
    branch,
    give_back,
    loop,
    loop_for,
    loop_repeat,
    loop_while,
    switch,
)
from grammar.generation.expressions import (
    atom,
    bits,
    chain,
    constant,
    constant_comparison,
    expression,
    joined,
    letter,
    mixed_comparison,
    near_comparison,
    negated,
    pose,
    product,
    quotient,
    relation,
    scaled,
    signed,
    sum_of,
    truth_comparison,
    value_comparison,
)
from grammar.generation.functions import CASES, CONTROLLER_VALUES, VAR_STATE, VAR_TYPE
from grammar.generation.literals import AXIS_TYPES, POSES, TEXT, Literals, predefined
from grammar.generation.motions import (
    brake,
    emily_motion,
    interrupt,
    motion,
    spline_block,
    spline_motion,
    trigger,
)
from grammar.generation.scope import Parameter
from grammar.generation.statements import (
    advance_setting,
    assign_text,
    assign_whole,
    assignment,
    call,
    cyclic_flag,
    cyclic_signal,
    fixed_setting,
    frame_setting,
    halt,
    invoke,
    proceed,
    pulse,
    set_variable,
    value_setting,
    wait,
)
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

__all__ = ["CLOSED", "PLAIN", "RESULTS"]

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
        "7.0E1",
    ),
    letters="AZaz09 +.x",
    texts=("", "A", "abc", "KRL", "a b", "12", "-7", "3.5", "xyz12", "TRUE", "Hello World"),
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
_ENUMERATIONS: Final = Weighted[Type](
    (4, COLOUR),
    (2, MODE),
    (2, VAR_STATE),
    (2, VAR_TYPE),
    (1, predefined("ORI_TYPE")),
    (1, predefined("MODE_OP")),
    (1, CASES),
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
    return type_ if type_ in CONTROLLER_VALUES or code.scope.places(type_).holders else VAR_STATE


def _goal(code: Code, kind: str) -> str:
    """A position: written out, a variable, frames composed, what a function gives."""
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


_RISKY: Final = Weighted[StatementRule](
    (6, assignment),
    (2, set_variable),
    (2, call),
    (2, branch),
    (1, assign_whole),
    (1, motion),
    (1, switch),
)

CLOSED: Final = Style(
    is_closed=True,
    spelling=Spelling(),
    literals=_LITERALS,
    expressions={
        INT: Weighted(
            (3, lambda code, _depth: atom(code, INT)),
            (3, chain(INT)),
            (3, sum_of(INT)),
            (2, scaled(INT)),
            (2, quotient(INT)),
            (4, bits),
            (1, negated("B_NOT", INT)),
            (2, signed(INT)),
        ),
        REAL: Weighted(
            (3, lambda code, _depth: atom(code, REAL)),
            (2, chain(REAL)),
            (5, sum_of(REAL)),
            (3, scaled(REAL)),
            (2, product(REAL)),
            (3, quotient(REAL)),
            (2, signed(REAL)),
        ),
        BOOL: Weighted(
            (2, lambda code, _depth: atom(code, BOOL)),
            (9, relation),
            (7, joined),
            (2, negated("NOT", BOOL)),
        ),
        CHAR: Weighted((1, letter)),
        **{type_: Weighted((1, pose(type_))) for type_ in POSES},
    },
    functions=CONTROLLER_VALUES,
    relations=Weighted(
        (4, near_comparison),
        (2, value_comparison),
        (1, mixed_comparison),
        (1, truth_comparison),
        (2, constant_comparison),
    ),
    statements=Weighted(
        (20, assignment),
        (6, assign_whole),
        (5, assign_text),
        (6, call),
        (7, branch),
        (4, switch),
        (5, loop_for),
        (3, loop_while),
        (3, loop_repeat),
        (3, loop),
        (2, backward_jump),
        (1, give_back),
        (4, proceed),
        (5, set_variable),
        (1, cyclic_flag),
        (2, pulse),
        (2, wait),
        (2, halt),
        (1, invoke),
        (2, cyclic_signal),
        (3, format_text),
        (2, scan_text),
        (5, motion),
        (2, spline_motion),
        (1, emily_motion),
        (2, spline_block),
        (2, trigger),
        (4, interrupt),
        (2, brake),
    ),
    moving=Weighted((1, motion)),
    risky=_RISKY,
    settings=Weighted(
        (
            4,
            value_setting(BOOL, "$OUT[?]", "$OUT[?]", "$FLAG[?]", "$TIMER_STOP[?]", "$STOPNOAPROX"),
        ),
        (
            2,
            value_setting(
                REAL, "$VEL.CP", "$VEL.ORI1", "$ACC.CP", "$APO.CDIS", "$APO.CORI", "$ANOUT[?]"
            ),
        ),
        (2, value_setting(INT, "$TIMER[?]", "$OV_PRO", "$APO.CPTP")),
        (
            1,
            fixed_setting(
                ("$ORI_TYPE", "#VAR"),
                ("$ORI_TYPE", "#CONSTANT"),
                ("$CIRC_TYPE", "#BASE"),
                ("$IPO_MODE", "#TCP"),
            ),
        ),
        (2, frame_setting),
        (1, advance_setting),
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
