"""The style of cells: programs as people and teach pendants write them, for one dialect."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from grammar.generation import control_flow, statements
from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.inline_forms import Forms
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import axis_position, frame, position
from grammar.generation.cells.statements import ask, careful, fold, message, remark, set_output
from grammar.generation.choices import Choices, Weighted
from grammar.generation.code import Code, ExpressionRule, StatementRule, Style
from grammar.generation.expressions import chain, constant, constant_comparison, expression, pose
from grammar.generation.literals import TEXT, Literals, predefined, structure
from grammar.generation.patterns import line, patterns
from grammar.generation.scope import Parameter
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

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
    """Return the constants that a cell uses."""
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
    """Return the type; instead of ``None``, a random enumeration that has variables here."""
    if type_ is not None:
        return type_
    found = code.scope.enumerations()
    return code.choices.pick(found) if found else otherwise


def _parameter(choices: Choices, _has_arrays: bool) -> Parameter:
    type_ = choices.weighted(_PARAMETERS)
    return Parameter("", type_, is_out=type_ != TEXT and choices.chance(10))


def _value(code: Code, place: str, type_: Type) -> str:
    """Return a value for a variable: often an increment, often a constant."""
    choices = code.choices
    if type_ == INT and choices.chance(30):
        return code.layout.binary(place, "+", "1")
    if type_ == BOOL and choices.chance(60):
        return constant(code, BOOL)
    return expression(code, type_, choices.between(1, 2))


_EXPRESSIONS: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: patterns(
        (40, "<operand INT>~<+|->~<operand INT>"),
        (8, "<operand INT>~*~<factor INT>"),
        (7, "<operand INT>~*~<operand INT>"),
        (4, "<operand INT>~/~<divisor INT>"),
        (3, chain(INT)),
        (3, "-<operand INT>"),
        (5, "<operand INT> <B_AND|B_OR|B_EXOR> <'B1'|'B0110'|'HF'|'HFF'>"),
        (1, "B_NOT <operand INT>"),
    ),
    REAL: patterns(
        (40, "<operand REAL>~<+|->~<operand REAL>"),
        (8, "<operand REAL>~*~<factor REAL>"),
        (7, "<operand REAL>~*~<operand REAL>"),
        (4, "<operand REAL>~/~<divisor REAL>"),
        (3, chain(REAL)),
        (3, "-<operand REAL>"),
    ),
    BOOL: patterns(
        (60, "<relation>"),
        (15, "<operand BOOL> <AND|OR> <operand BOOL>"),
        (10, "<operand BOOL> <AND|OR|EXOR> <operand BOOL> <AND|OR> <operand BOOL>"),
        (10, "NOT <operand BOOL>"),
    ),
    **{type_: patterns((1, pose(type_))) for type_ in (FRAME, E6POS)},
}
_FUNCTIONS: Final[Mapping[Type, Weighted[ExpressionRule]]] = {
    INT: patterns(
        (4, "STRLEN(<text>)"),
        (2, "STRFIND(1,<text>,<text>,<constant CASE_SENSE_T>)"),
        (1, "STRADD(<letters>,<text>)"),
    ),
    REAL: patterns(
        (5, "<SIN|COS|ABS>(<REAL>)"),
        (3, "SQRT(ABS(<REAL>))"),
        (1, "TAN(<atom REAL>)"),
        (1, "ATAN2(<REAL>,<REAL>)"),
    ),
    BOOL: patterns(
        (3, "STRCOMP(<text>,<text>,<constant CASE_SENSE_T>)"), (1, "STRCLEAR(<letters>)")
    ),
    _MODE_OP: patterns((1, "$MODE_OP")),
    FRAME: patterns((3, "BASE_DATA[<1-32>]"), (1, "$NULLFRAME")),
    E6POS: patterns((1, "$POS_ACT")),
}
_ATOMS: Final[Mapping[Type, tuple[int, Weighted[ExpressionRule]]]] = {
    INT: (3, patterns((1, "$TIMER[<1-16>]"))),
    REAL: (8, patterns((3, "<$VEL.CP|$POS_ACT.Z|$POS_ACT.X|$AXIS_ACT.A1>"), (2, "$ANIN[<1-8>]"))),
    BOOL: (35, patterns((20, "$IN[<1-512>]"), (6, "$FLAG[<1-999>]"), (2, "$TIMER_FLAG[<1-16>]"))),
}
_RELATIONS: Final = patterns(
    (20, "<atom INT>~<equal>~<constant INT>"),
    (10, "<atom INT>~<order>~<constant INT>"),
    (15, "<atom REAL>~<order>~<constant REAL>"),
    (8, "<atom INT>~<order>~<operand INT>"),
    (10, "<atom REAL>~<order>~<operand REAL>"),
    (18, "<atom BOOL>~==~<TRUE|TRUE|FALSE>"),
    (20, constant_comparison),
)
_STATEMENTS: Final = Weighted[StatementRule](
    (110, set_output),
    (
        45,
        line(
            *("$VEL.CP:=0.<1-9>", "$ACC.CP:=<1-5>.0", "$APO.CDIS:=<1-80>.0", "$APO.CPTP:=<5-100>"),
            *("$OV_PRO:=<10|30|50|100>", "$VEL_AXIS[<1-6>]:=<10-100>.0", "$TIMER[<1-16>]:=0"),
            *("$TIMER_STOP[<1-16>]:=<TRUE|FALSE>", "$ORI_TYPE:=<#VAR|#CONSTANT|#JOINT>"),
            *("$CIRC_TYPE:=<#BASE|#PATH>", "$TOOL:=TOOL_DATA[<1-16>]", "$BASE:=BASE_DATA[<1-32>]"),
        ),
    ),
    (18, line("$FLAG[<1-999>]:=<BOOL>")),
    (4, line("$ANOUT[<1-8>]:=<REAL>")),
    (4, statements.set_base),
    (10, line("$CYCFLAG[<1-32>]:=<lasting> <AND|OR|AND NOT> $IN[<1-512>]")),
    (400, statements.assignment),
    (30, statements.assign_whole),
    (35, statements.assign_text),
    (100, statements.call),
    (40, message),
    (6, ask),
    (85, line("WAIT FOR <BOOL>")),
    (30, line("WAIT SEC <0|0.1|0.2|0.25|0.5|1.0|2|0.012>")),
    (7, line("PULSE(<output>,<TRUE|TRUE|FALSE>,<0.1|0.2|0.5|1.0|3.0>)")),
    (14, line("HALT")),
    (10, careful),
    (170, remark),
    (137, control_flow.branch),
    (23, control_flow.loop_for),
    (3, control_flow.loop_while),
    (4, control_flow.loop_repeat),
    (3, control_flow.loop),
    (17, control_flow.switch),
    (22, fold),
    (6, control_flow.give_back),
    (5, control_flow.backward_jump),
)


def style_of(dialect: Dialect, names: Names, forms: Forms) -> Style:
    """Return the style of a cell; its motions go to the points of ``forms``."""

    def remark_behind(choices: Choices) -> str:
        return f" ;{names.remark()}" if choices.chance(6) else ""

    return Style(
        is_closed=False,
        layout=dialect,
        literals=_literals(dialect),
        expressions=_EXPRESSIONS,
        functions=_FUNCTIONS,
        relations=_RELATIONS,
        statements=_STATEMENTS,
        moving=forms.rules,
        risky=Weighted((1, statements.assignment)),
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
