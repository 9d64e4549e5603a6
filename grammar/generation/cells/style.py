"""The style of cells: programs as people and panels write them, made for one dialect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.forms import Forms
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import axis_position, frame, position
from grammar.generation.cells.statements import (
    ask,
    careful,
    fold,
    message,
    remark,
    set_output,
    stop,
)
from grammar.generation.choices import Choices, Weighted
from grammar.generation.code import Code, ExpressionRule, StatementRule, Style
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
    comparison,
    constant,
    constant_comparison,
    expression,
    joined,
    negated,
    pose,
    product,
    quotient,
    read,
    relation,
    scaled,
    signed,
    sum_of,
)
from grammar.generation.functions import (
    add,
    clear,
    compare,
    controller_variable,
    direction,
    find,
    length,
    root,
    sine,
    tangent,
)
from grammar.generation.literals import TEXT, Literals, predefined, structure
from grammar.generation.scope import Parameter
from grammar.generation.statements import (
    assign_text,
    assign_whole,
    assignment,
    call,
    cyclic_flag,
    fixed_setting,
    frame_setting,
    pulse,
    set_variable,
    value_setting,
    wait,
)
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

__all__ = ["E6AXIS", "E6POS", "FRAME", "LOCALS", "RESULTS", "style_of"]

FRAME, E6POS, E6AXIS = structure("FRAME"), structure("E6POS"), structure("E6AXIS")
_MODE_OP: Final = predefined("MODE_OP")
RESULTS: Final = Weighted[Type]((4, INT), (4, REAL), (4, BOOL), (1, E6POS), (1, FRAME))
LOCALS: Final = Weighted[Type](
    (40, INT), (30, REAL), (30, BOOL), (12, E6POS), (10, FRAME), (3, CHAR)
)
_REALS: Final = (
    "0.0 0.1 0.2 0.25 0.5 0.75 1.0 1.5 2.0 2.5 3.0 4.5 5.0 7.5 8.0 10.0 12.5 15.0 18.0 20.0 25.0"
    " 30.0 35.5 40.0 45.0 50.0 60.0 75.0 80.0 90.0 99.9 100.0 120.0 150.0 180.0 200.0 250.0 300.0"
    " 360.0 400.0 500.0 750.0 1000.0 1.0E-3 2.5E+2 1.2E3"
)
_BITS: Final = ("'B1'", "'B10'", "'B0110'", "'B1000'", "'HF'", "'H0F'", "'HFF'")
_CONTENTS: Final = ("none", " ", "A 100", "type 7; left", "0815", "blank", "left", "right", "-")
_PARAMETERS: Final = Weighted[Type]((5, INT), (4, REAL), (3, BOOL), (1, TEXT), (1, E6POS))
_ASSIGNED: Final = Weighted[Type | None]((32, INT), (22, REAL), (20, BOOL), (8, None), (1, CHAR))
_SELECTORS: Final = Weighted[Type | None]((60, INT), (35, None), (5, CHAR))


def _literals(dialect: Dialect) -> Literals:
    """What constants a cell has."""
    return Literals(
        integers=(*(str(number % 100) for number in range(180)), "250", "999", *_BITS),
        reals=tuple(_REALS.split()),
        texts=_CONTENTS,
        letters="ABCXYZ019-;",
        negative_integers=3,
        named=5,
        comma=dialect.comma,
        makers={"FRAME": frame, "E6POS": position, "E6AXIS": axis_position},
    )


def _any_enumeration(code: Code, type_: Type | None, otherwise: Type) -> Type:
    """The type, or in place of ``None`` one of the enumerations that have variables here."""
    if type_ is not None:
        return type_
    found = code.scope.enumerations()
    return code.choices.pick(found) if found else otherwise


def _parameter(choices: Choices, _has_arrays: bool) -> Parameter:
    type_ = choices.weighted(_PARAMETERS)
    return Parameter("", type_, is_out=type_ != TEXT and choices.chance(10))


def _number_comparison(code: Code, _depth: int) -> str:
    """A number compared with a constant."""
    type_ = code.choices.pick((INT, INT, REAL))
    sign = code.choices.pick(("==", "==", "<>", "<", ">", ">=", "<=", "=>", "=<"))
    if type_ == REAL and sign in ("==", "<>"):
        sign = "<"
    return code.spelling.binary(read(code, type_) or "$TIMER[1]", sign, constant(code, type_))


def _value(code: Code, place: str, type_: Type) -> str:
    """What a place is given: often one more, often a constant."""
    choices = code.choices
    if type_ == INT and choices.chance(30):
        return code.spelling.binary(place, "+", "1")
    if type_ == BOOL and choices.chance(60):
        return constant(code, BOOL)
    return expression(code, type_, choices.between(1, 2))


def _truth_comparison(code: Code, _depth: int) -> str:
    """A truth value compared with one of the constants, as many people write it."""
    value = code.choices.pick(("TRUE", "TRUE", "FALSE"))
    return code.spelling.binary(atom(code, BOOL), "==", value)


def _numbers(type_: Type) -> Sequence[tuple[int, ExpressionRule]]:
    return (
        (40, sum_of(type_)),
        (8, scaled(type_)),
        (7, product(type_)),
        (4, quotient(type_)),
        (3, chain(type_)),
        (3, signed(type_)),
    )


_EXPRESSIONS: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: Weighted(*_numbers(INT), (5, bits), (1, negated("B_NOT", INT))),
    REAL: Weighted(*_numbers(REAL)),
    BOOL: Weighted((60, relation), (26, joined), (10, negated("NOT", BOOL))),
    **{type_: Weighted((1, pose(type_))) for type_ in (FRAME, E6POS)},
}
_FUNCTIONS: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: Weighted((4, length), (2, find), (1, add)),
    REAL: Weighted((5, sine), (3, root), (1, tangent), (1, direction)),
    BOOL: Weighted((3, compare), (1, clear)),
    _MODE_OP: Weighted((1, controller_variable("$MODE_OP"))),
    FRAME: Weighted(
        (3, controller_variable("BASE_DATA[?]")), (1, controller_variable("$NULLFRAME"))
    ),
    E6POS: Weighted((1, controller_variable("$POS_ACT"))),
}
_ATOMS: Final[Mapping[Type, tuple[int, Weighted[ExpressionRule]]]] = {
    INT: (3, Weighted((1, controller_variable("$TIMER[?]")))),
    REAL: (
        8,
        Weighted(
            (3, controller_variable("$VEL.CP", "$POS_ACT.Z", "$POS_ACT.X", "$AXIS_ACT.A1")),
            (2, controller_variable("$ANIN[?]", numbers=8)),
        ),
    ),
    BOOL: (
        35,
        Weighted(
            (20, controller_variable("$IN[?]", numbers=512)),
            (6, controller_variable("$FLAG[?]", numbers=999)),
            (2, controller_variable("$TIMER_FLAG[?]")),
        ),
    ),
}
_SETTINGS: Final = Weighted(
    (
        10,
        fixed_setting(
            *(("$VEL.CP", f"0.{tenth}") for tenth in range(1, 9)),
            *(("$ACC.CP", f"{number}.0") for number in range(1, 6)),
            *(("$APO.CDIS", f"{number}0.0") for number in range(1, 9)),
            *(("$APO.CPTP", "50"), ("$OV_PRO", "100"), ("$VEL_AXIS[1]", "50.0")),
            *(("$TIMER[?]", "0"), ("$TIMER_STOP[?]", "FALSE"), ("$TIMER_STOP[?]", "TRUE")),
            *(("$ORI_TYPE", "#VAR"), ("$ORI_TYPE", "#CONSTANT"), ("$CIRC_TYPE", "#BASE")),
            *(("$TOOL", "TOOL_DATA[?]"), ("$BASE", "BASE_DATA[?]"), ("$CIRC_TYPE", "#PATH")),
        ),
    ),
    (1, frame_setting),
    (1, value_setting(REAL, "$ANOUT[?]")),
    (4, value_setting(BOOL, "$FLAG[?]")),
)
_STATEMENTS: Final = Weighted[StatementRule](
    (110, set_output),
    (60, set_variable),
    (10, cyclic_flag),
    (400, assignment),
    (30, assign_whole),
    (35, assign_text),
    (100, call),
    (40, message),
    (6, ask),
    (110, wait),
    (7, pulse),
    (14, stop),
    (10, careful),
    (170, remark),
    (137, branch),
    (23, loop_for),
    (3, loop_while),
    (4, loop_repeat),
    (3, loop),
    (17, switch),
    (22, fold),
    (6, give_back),
    (5, backward_jump),
)


def style_of(dialect: Dialect, names: Names, forms: Forms) -> Style:
    """The style of a cell; motions go to the points of the forms."""

    def remark_behind(choices: Choices) -> str:
        return f" ;{names.remark()}" if choices.chance(6) else ""

    return Style(
        is_closed=False,
        spelling=dialect,
        literals=_literals(dialect),
        expressions=_EXPRESSIONS,
        functions=_FUNCTIONS,
        relations=Weighted(
            (45, _number_comparison),
            (8, lambda code, depth: comparison(code, depth, (INT, INT))),
            (10, lambda code, depth: comparison(code, depth, (REAL, REAL))),
            (18, _truth_comparison),
            (20, constant_comparison),
        ),
        statements=_STATEMENTS,
        moving=forms.rules,
        risky=Weighted((1, assignment)),
        settings=_SETTINGS,
        assigned=lambda code: _any_enumeration(code, code.choices.weighted(_ASSIGNED), INT),
        value=_value,
        parameter=_parameter,
        selectors=lambda code: _any_enumeration(code, code.choices.weighted(_SELECTORS), INT),
        compared=lambda code: _any_enumeration(code, None, _MODE_OP),
        goal=forms.goal,
        blend=forms.blend,
        motions=Weighted(
            *((240, "PTP"), (580, "LIN"), (8, "CIRC")),
            *((24, "LIN_REL"), (5, "PTP_REL"), (1, "CIRC_REL")),
        ),
        atoms=_ATOMS,
        remark=remark_behind,
        atom_share=40,
        operator_share=88,
        call_share=7,
        variable_share=75,
        truth_share=100,
        whole_share=75,
        any_place_share=0,
        omitted_share=0,
        wait_for_share=75,
        else_share=36,
        exit_share=5,
        case_share=80,
        case_labels=2,
        short_declaration_share=28,
        group_share=50,
        bare_share=3,
        bare_local_share=0,
        deepest=5,
        reserve=3,
        has_splines=dialect.generation.is_krc4,
    )
