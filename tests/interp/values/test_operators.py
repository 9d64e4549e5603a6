"""Operators: every primitive, how operators choose them, and the geometric operator."""

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics import operations
from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    UNKNOWN,
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Structure,
    Text,
    Type,
)
from interp.values.faults import FAULTS, Fault
from interp.values.geometric_operator import inverted
from interp.values.json_form import from_json, to_json
from interp.values.operators import (
    BINARY,
    PRIMITIVES,
    UNARY,
    Kind,
    apply,
    apply_unary,
    kind_of,
    kind_of_value,
    select,
)
from interp.values.values import REAL_MAX, StructureValue, Value, constant, empty, single, zero

COLOUR = Enumeration("COLOUR", ("RED", "GREEN"))
RED, GREEN = constant(COLOUR, "RED"), constant(COLOUR, "GREEN")
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)
INTS = st.integers(INT_MIN, INT_MAX)
TENTH, FIFTH, THREE_TENTHS = single(0.1), single(0.2), single(0.3)


def _type(name: str) -> Structure:
    type_ = System.load().types[name]
    assert isinstance(type_, Structure)
    return type_


def _pose(name: str, *numbers: float, **others: float) -> StructureValue:
    value = from_json(_type(name), dict(zip("XYZABC", numbers, strict=False)) | others)
    assert isinstance(value, StructureValue)
    return value


# ---------------------------------------------------------------------------------- tables of cases

_INT = [
    ("+", 2, 3, 5),
    ("+", INT_MAX, INT_MIN, -1),
    ("-", 2, 3, -1),
    ("-", INT_MIN, INT_MIN, 0),
    ("*", -4, 3, -12),
    ("*", 46340, 46340, 2147395600),
    ("*", 65536, -32768, INT_MIN),
    ("/", 10, 3, 3),
    ("/", -7, 2, -3),
    ("/", 7, -2, -3),
    ("/", -7, -2, 3),
    ("/", 6, -2, -3),
    ("/", 1, 2, 0),
    ("/", -1, 2, 0),
    ("/", 0, -5, 0),
    ("/", 30000, 60000, 0),
    ("/", INT_MIN, 1, INT_MIN),
    ("/", INT_MIN, 2, -1073741824),
]
_REAL = [
    ("+", 1.5, 2.25, 3.75),
    ("+", TENTH, FIFTH, 0.30000001192092896),
    ("+", 16777216.0, 1.0, 16777216.0),
    ("+", single(1e-45), single(1e-45), single(3e-45)),
    ("-", 1.5, 2.25, -0.75),
    ("*", 3.0, TENTH, 0.30000001192092896),
    ("*", single(1e-30), single(1e-30), 0.0),
    ("/", 1.0, 3.0, 0.3333333432674408),
    ("/", -7.0, 2.0, -3.5),
    ("/", 0.0, 2.0, 0.0),
]
_MIXED = [
    ("+", 1, 0.5, 1.5),
    ("-", 0.5, 1, -0.5),
    ("*", 3, 0.5, 1.5),
    ("/", 1, 2.0, 0.5),
    ("/", 1.0, 2, 0.5),
    ("+", 16777217, 0.0, 16777216.0),
]
_RELATIONS = [
    *(("==", 1, 1, True), ("==", 1, 2, False), ("<>", 1, 2, True), ("<>", 1, 1, False)),
    *(("<", 1, 2, True), ("<", 2, 2, False), (">", 2, 1, True), (">", 2, 2, False)),
    *(("<=", 2, 2, True), ("<=", 3, 2, False), (">=", 2, 2, True), (">=", 1, 2, False)),
    *(("<", INT_MIN, INT_MAX, True), (">", INT_MIN, INT_MAX, False)),
    *(("==", 0.5, 0.5, True), ("==", 0.5, 0.25, False), ("<>", 0.5, 0.25, True)),
    *(("<", 0.25, 0.5, True), (">", 0.25, 0.5, False), ("<=", 0.5, 0.5, True)),
    *((">=", 0.25, 0.5, False), ("==", 0.0, -0.0, True), ("<>", 0.5, 0.5, False)),
    *((">", 0.5, 0.25, True), ("<", 0.5, 0.25, False), ("<=", 0.5, 0.25, False)),
    *((">=", 0.5, 0.5, True), ("<", 0.5, 0.5, False), (">", 0.5, 0.5, False)),
    *(("==", 1, 1.0, True), ("<", 1.0, 2, True), ("==", 16777217, 16777216.0, True)),
    *(("==", "A", "A", True), ("<", "A", "B", True), (">=", "a", "B", True)),
    *(("==", "A", 65, True), ("<", 64, "A", True), ("==", "A", 65.0, True), (">", "A", 64.5, True)),
    *(("==", True, True, True), ("==", True, False, False), ("<>", True, False, True)),
    *(("<>", False, False, False), ("==", RED, RED, True), ("==", RED, GREEN, False)),
    *(("<>", RED, GREEN, True), ("<>", GREEN, GREEN, False)),
]
_LOGIC = [
    *(("AND", False, False, False), ("AND", False, True, False), ("AND", True, False, False)),
    *(("AND", True, True, True), ("OR", False, False, False), ("OR", False, True, True)),
    *(("OR", True, False, True), ("OR", True, True, True), ("EXOR", False, False, False)),
    *(("EXOR", False, True, True), ("EXOR", True, False, True), ("EXOR", True, True, False)),
]
_BITS = [
    *(("B_AND", 12, 10, 8), ("B_OR", 12, 10, 14), ("B_EXOR", 12, 10, 6)),
    *(("B_AND", -1, 255, 255), ("B_AND", INT_MIN, -1, INT_MIN), ("B_OR", INT_MIN, INT_MAX, -1)),
    *(("B_EXOR", -1, INT_MAX, INT_MIN), ("B_EXOR", 5, 5, 0), ("B_AND", "a", 223, 65)),
]
_SIGNS = [
    *(("+", 5, 5), ("+", -2.5, -2.5), ("-", 5, -5), ("-", 2.5, -2.5), ("-", INT_MAX, -INT_MAX)),
    *(("NOT", True, False), ("NOT", False, True)),
    *(("B_NOT", 0, -1), ("B_NOT", 10, -11), ("B_NOT", INT_MIN, INT_MAX), ("B_NOT", -1, 0)),
    ("B_NOT", "A", -66),
]


@pytest.mark.parametrize(
    ("operator", "left", "right", "expected"),
    [*_INT, *_REAL, *_MIXED, *_RELATIONS, *_LOGIC, *_BITS],
)
def test_operators_of_two(operator: str, left: Value, right: Value, expected: Value) -> None:
    """Each operator gives its value in its type [TYP-02, ARI-01, ARI-02, ARI-07, ARI-10]."""
    found = apply(operator, left, right)
    assert expected == found
    assert type(expected) is type(found)


@pytest.mark.parametrize(("operator", "operand", "expected"), _SIGNS)
def test_operators_of_one(operator: str, operand: Value, expected: Value) -> None:
    """Signs keep the type, NOT works on BOOL, B_NOT on the 32 bits of an INT [ARI-05, ARI-07]."""
    found = apply_unary(operator, operand)
    assert expected == found
    assert type(expected) is type(found)


@pytest.mark.parametrize(
    ("operator", "left", "right", "slug"),
    [
        *(("+", INT_MAX, 1, "overflow"), ("+", INT_MIN, -1, "overflow")),
        *(("-", INT_MIN, 1, "overflow"), ("-", 0, INT_MIN, "overflow")),
        *(("*", 65536, 32768, "overflow"), ("*", INT_MIN, -1, "overflow")),
        *(("/", INT_MIN, -1, "overflow"), ("/", 1, 0, "division_by_zero")),
        *(("/", 0, 0, "division_by_zero"), ("/", INT_MIN, 0, "division_by_zero")),
        *(("/", 1.0, 0.0, "division_by_zero"), ("/", 0.0, 0.0, "division_by_zero")),
        *(("/", 1.0, -0.0, "division_by_zero"), ("/", 1, 0.0, "division_by_zero")),
        *(("+", REAL_MAX, REAL_MAX, "overflow"), ("-", -REAL_MAX, REAL_MAX, "overflow")),
        *(("*", 1e38, 10.0, "overflow"), ("/", 1e38, 0.0009765625, "overflow")),
    ],
)
def test_what_has_no_value_faults(operator: str, left: Value, right: Value, slug: str) -> None:
    """Overflow and division by zero are faults: nothing wraps, nothing is infinite [ARI-12]."""
    with pytest.raises(Fault) as caught:
        apply(operator, left, right)
    assert slug == caught.value.slug


def test_smallest_int_has_no_opposite() -> None:
    """The sign of the smallest INT cannot be turned [TYP-01, ARI-12]."""
    with pytest.raises(Fault) as caught:
        apply_unary("-", INT_MIN)
    assert "overflow" == caught.value.slug


_SAMPLES: list[Value] = [1, 1.0, True, "A", RED, _pose("FRAME", 1, 2, 3, 0, 0, 0)]


@pytest.mark.parametrize("operator", sorted(BINARY))
def test_operators_refuse_other_operands(operator: str) -> None:
    """Operators work on the operands that the checker allows, and fault on others [ARI-11]."""
    for left in _SAMPLES:
        for right in _SAMPLES:
            types = (_type_of(left), _type_of(right))
            verdict = operations.binary(operator, *types).verdict
            if verdict:
                apply(operator, left, right)
                continue
            with pytest.raises(Fault) as caught:
                apply(operator, left, right)
            assert "operand" == caught.value.slug


@pytest.mark.parametrize("operator", ["+", "-", "NOT", "B_NOT"])
def test_signs_refuse_other_operands(operator: str) -> None:
    """Signs, NOT and B_NOT fault on what the checker refuses [ARI-11]."""
    for operand in _SAMPLES:
        if operations.unary(operator, _type_of(operand)).verdict:
            apply_unary(operator, operand)
            continue
        with pytest.raises(Fault) as caught:
            apply_unary(operator, operand)
        assert "operand" == caught.value.slug


def _type_of(value: Value) -> Type:
    scalars: dict[type, Type] = {int: INT, float: REAL, bool: BOOL, str: CHAR}
    return scalars.get(type(value)) or value.type  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "value", [zero(Array(INT, (2,))), zero(_type("LOAD")), zero(_type("AXIS"))]
)
def test_compound_values_are_no_operands(value: Value) -> None:
    """Arrays, and structures that are no poses, are operands of nothing [ARI-10, ARI-11]."""
    for operator in BINARY:
        with pytest.raises(Fault):
            apply(operator, value, value)


def test_empty_text_is_no_operand() -> None:
    """An empty text, which the checker lets stand for a letter, has no code [TYP-03]."""
    with pytest.raises(Fault) as caught:
        apply("==", "A", "")
    assert "operand" == caught.value.slug


# ---------------------------------------------------------------------------------- selection


@pytest.mark.parametrize(
    ("operator", "kinds", "conversions", "primitive"),
    [
        ("+", ("INT", "INT"), ((), ()), "add_int"),
        ("+", ("INT", "REAL"), (("int_to_real",), ()), "add_real"),
        ("/", ("REAL", "INT"), ((), ("int_to_real",)), "div_real"),
        ("<", ("CHAR", "CHAR"), (("char_to_int",), ("char_to_int",)), "lt_int"),
        ("<", ("CHAR", "INT"), (("char_to_int",), ()), "lt_int"),
        ("==", ("REAL", "CHAR"), ((), ("char_to_int", "int_to_real")), "eq_real"),
        ("==", ("ENUM", "ENUM"), ((), ()), "eq_enum"),
        (":", ("FRAME", "FRAME"), ((), ()), "compose"),
        ("-", ("REAL",), ((),), "neg_real"),
        ("+", ("INT",), ((),), None),
    ],
)
def test_selection_reports_conversions(
    operator: str,
    kinds: tuple[Kind, ...],
    conversions: tuple[tuple[str, ...], ...],
    primitive: str | None,
) -> None:
    """From the kinds of the operands follow the conversions and the primitive [ARI-01, ARI-10]."""
    found = select(operator, *kinds)
    assert found is not None
    steps = tuple(tuple(step.name for step in one) for one in found.conversions)
    assert conversions == steps
    assert primitive == (None if found.primitive is None else found.primitive.name)


@pytest.mark.parametrize(
    ("operator", "kinds"),
    [
        *(("+", ("CHAR", "INT")), ("+", ("BOOL", "BOOL")), ("<", ("BOOL", "BOOL"))),
        *(("<", ("ENUM", "ENUM")), ("AND", ("INT", "INT")), ("B_AND", ("REAL", "INT"))),
        *((":", ("FRAME", "INT")), ("==", ("FRAME", "FRAME")), ("NOT", ("INT",))),
        *(("B_NOT", ("BOOL",)), ("+", ("BOOL",)), ("-", ("CHAR",)), ("==", ("BOOL", "INT"))),
    ],
)
def test_selection_refuses(operator: str, kinds: tuple[Kind, ...]) -> None:
    """No primitive is chosen where the operator does not work [ARI-10, ARI-11]."""
    assert select(operator, *kinds) is None


@pytest.mark.parametrize(("operator", "kinds"), [("%", ("INT", "INT")), ("*", ("INT",))])
def test_selection_of_no_operator(operator: str, kinds: tuple[Kind, ...]) -> None:
    """What is no operator, or not one of so many operands, is our own mistake."""
    with pytest.raises(ValueError, match="is no operator"):
        select(operator, *kinds)


@pytest.mark.parametrize(
    ("type_", "kind"),
    [
        *((INT, "INT"), (REAL, "REAL"), (BOOL, "BOOL"), (CHAR, "CHAR"), (COLOUR, "ENUM")),
        *((Constant("RED"), "ENUM"), (Text(1), "CHAR"), (Text(2), None), (UNKNOWN, None)),
        *((_type("FRAME"), "FRAME"), (_type("E6POS"), "FRAME"), (_type("AXIS"), None)),
        *((Aggregate(("X",)), "FRAME"), (Aggregate(("A1",), _type("AXIS")), None)),
        (Array(INT, (2,)), None),
    ],
)
def test_kinds_of_types(type_: Type, kind: Kind | None) -> None:
    """The kind of an operand is known from its type, before the program runs."""
    assert kind == kind_of(type_)


def test_kinds_of_values_are_those_of_their_types() -> None:
    """The kind that a value shows is the one its type told."""
    for value in _SAMPLES:
        assert kind_of(_type_of(value)) == kind_of_value(value)


def test_table_has_all_operators() -> None:
    """Every operator of the language has primitives, and each primitive is used."""
    written = operations.ARITHMETIC | operations.LOGICAL | operations.BITWISE
    assert {*written, *operations.EQUALITY, *operations.ORDER, ":"} == set(BINARY)
    used = {name for names in (*BINARY.values(), *UNARY.values()) for name in names}
    conversions = {"int_to_real", "real_to_int", "char_to_int", "int_to_char"}
    assert set(PRIMITIVES) == used | conversions
    for name in used:
        assert len(set(PRIMITIVES[name].operands)) == 1


def test_primitives_are_described() -> None:
    """A primitive has a name of its own, a sentence, and faults that are in the catalogue."""
    for name, primitive in PRIMITIVES.items():
        assert name == primitive.name
        assert primitive.sentence
        assert set(primitive.faults) <= set(FAULTS)


_BY_KIND: dict[Kind, st.SearchStrategy[Any]] = {
    "INT": INTS | st.integers(-3, 300),
    "REAL": SINGLES,
    "BOOL": st.booleans(),
    "CHAR": st.characters(max_codepoint=255),
    "ENUM": st.sampled_from([RED, GREEN]),
    "FRAME": st.tuples(*[st.floats(-1e4, 1e4, width=32)] * 6).map(lambda n: _pose("FRAME", *n)),
}


@pytest.mark.parametrize("name", sorted(PRIMITIVES))
@given(data=st.data())
def test_primitives_keep_their_word(name: str, data: st.DataObject) -> None:
    """A primitive gives a value of its kind, or one of the faults that it names."""
    primitive = PRIMITIVES[name]
    operands = [data.draw(_BY_KIND[kind]) for kind in primitive.operands]
    slug = ""
    try:
        result = primitive.function(*operands)
    except Fault as raised:
        slug = raised.slug
    if slug:
        assert slug in primitive.faults
        return
    assert primitive.result == kind_of_value(result)
    if isinstance(result, float):
        assert result == single(result)
    if type(result) is int:
        assert INT_MIN <= result <= INT_MAX


@pytest.mark.parametrize(("code", "letter"), [(0, "\0"), (65, "A"), (255, "\xff")])
def test_letters_have_codes(code: int, letter: str) -> None:
    """A CHAR and its code become each other [TYP-03]."""
    assert letter == PRIMITIVES["int_to_char"].function(code)
    assert code == PRIMITIVES["char_to_int"].function(letter)


@pytest.mark.parametrize("code", [-1, 256])
def test_no_letter_has_other_codes(code: int) -> None:
    """A number that no byte has is no letter [TYP-03, MSG-11]."""
    with pytest.raises(Fault) as caught:
        PRIMITIVES["int_to_char"].function(code)
    assert 1446 == caught.value.number


# ---------------------------------------------------------------------------------- laws


def _nearest(exact: Fraction) -> float | None:
    """An exact number rounded to single by the definition; ``None`` when it is too large."""
    size = abs(exact)
    exponent = -149
    if size:
        exponent = max(size.numerator.bit_length() - size.denominator.bit_length() - 25, -149)
        while size >= Fraction(2) ** (exponent + 24):
            exponent += 1
    units = round(size / Fraction(2) ** exponent)  # a Fraction is rounded half to even
    number = float(units * Fraction(2) ** exponent)
    return None if number > REAL_MAX else math.copysign(number, exact or 1)


@given(st.sampled_from("+-*/"), SINGLES, SINGLES)
def test_real_arithmetic_is_that_of_singles(operator: str, left: float, right: float) -> None:
    """A result is the exact one rounded once, though it was computed in double [TYP-02]."""
    a, b = Fraction(left), Fraction(right)
    exact = {"+": a + b, "-": a - b, "*": a * b, "/": a / b if b else None}[operator]
    expected = None if exact is None else _nearest(exact)
    if expected is None:
        with pytest.raises(Fault):
            apply(operator, left, right)
    else:
        assert expected == apply(operator, left, right)


@given(INTS, INTS.filter(bool))
def test_division_drops_the_fraction(left: int, right: int) -> None:
    """The quotient of INTs is the exact one, cut towards zero [ARI-02]."""
    exact = math.trunc(Fraction(left, right))
    if exact <= INT_MAX:
        assert exact == apply("/", left, right)


@given(INTS, INTS)
def test_bit_operators_are_those_of_32_bits(left: int, right: int) -> None:
    """Bit operators work on 32 bits in two's complement [ARI-07, TYP-04]."""
    mask = 0xFFFFFFFF
    for operator, expected in (
        ("B_AND", (left & mask) & (right & mask)),
        ("B_OR", (left & mask) | (right & mask)),
        ("B_EXOR", (left & mask) ^ (right & mask)),
    ):
        found = apply(operator, left, right)
        assert isinstance(found, int)
        assert expected == found & mask
    inverse = apply_unary("B_NOT", left)
    assert isinstance(inverse, int)
    assert mask == (inverse & mask) ^ (left & mask)


# ---------------------------------------------------------------------------------- frames


def _matrix(value: StructureValue) -> list[list[float]]:
    """The pose as a matrix of four rows, made by multiplying the three plain rotations."""
    x, y, z, a, b, c = value.members[:6]
    turns = []
    for axis, degrees in ((2, a), (1, b), (0, c)):
        sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        turn = [[float(row == column) for column in range(4)] for row in range(4)]
        one, other = [place for place in range(3) if place != axis]
        turn[one][one] = turn[other][other] = cosine
        turn[one][other], turn[other][one] = (-sine, sine) if axis != 1 else (sine, -sine)
        turns.append(turn)
    product = _product(_product(turns[0], turns[1]), turns[2])
    for row, shift in enumerate((x, y, z)):
        product[row][3] = shift
    return product


def _product(left: list[list[float]], right: list[list[float]]) -> list[list[float]]:
    return [
        [sum(left[row][k] * right[k][column] for k in range(4)) for column in range(4)]
        for row in range(4)
    ]


def _is_near(one: list[list[float]], other: list[list[float]], size: float) -> bool:
    return all(
        abs(one[row][column] - other[row][column]) <= (1e-4 * size if column == 3 else 5e-6)
        for row in range(4)
        for column in range(4)
    )


LENGTHS, ANGLES = st.floats(-3000, 3000, width=32), st.floats(-180, 180, width=32)
RIGHT_ANGLES = st.sampled_from([-180.0, -90.0, 0.0, 90.0, 180.0])
TURNS = ANGLES | RIGHT_ANGLES
POSES = st.tuples(LENGTHS, LENGTHS, LENGTHS, TURNS, TURNS, TURNS).map(
    lambda numbers: _pose("FRAME", *numbers)
)


def _composed(left: StructureValue, right: StructureValue) -> StructureValue:
    found = apply(":", left, right)
    assert isinstance(found, StructureValue)
    return found


@given(POSES, POSES)
def test_composition_is_the_product_of_matrices(
    left: StructureValue, right: StructureValue
) -> None:
    """A:B is the product of the matrices with R = Rz(A)·Ry(B)·Rx(C) [ARI-08, ARI-09]."""
    expected = _product(_matrix(left), _matrix(right))
    assert _is_near(expected, _matrix(_composed(left, right)), 10)


@given(POSES, POSES, POSES)
def test_composition_is_associative(
    one: StructureValue, two: StructureValue, three: StructureValue
) -> None:
    """(A:B):C and A:(B:C) are the same pose within what singles keep [ARI-08]."""
    left, right = _composed(_composed(one, two), three), _composed(one, _composed(two, three))
    assert _is_near(_matrix(left), _matrix(right), 100)


@given(POSES)
def test_inverse_undoes(pose: StructureValue) -> None:
    """A pose composed with its inverse, on either side, is zero [ARI-08, FCT-03]."""
    none = _matrix(_pose("FRAME", 0, 0, 0, 0, 0, 0))
    assert _is_near(none, _matrix(_composed(pose, inverted(pose))), 100)
    assert _is_near(none, _matrix(_composed(inverted(pose), pose)), 100)


@given(TURNS, TURNS, TURNS)
def test_angles_have_a_range(a: float, b: float, c: float) -> None:
    """A and C lie above -180 and up to 180, B between -90 and 90; A is 0 at B = ±90 [ARI-09]."""
    zero, turned = _pose("FRAME", 0, 0, 0, 0, 0, 0), _pose("FRAME", 0, 0, 0, a, b, c)
    found: Any = _composed(zero, turned).members[3:6]
    assert -180 < found[0] <= 180
    assert -90 <= found[1] <= 90
    assert -180 < found[2] <= 180
    assert all(number == single(number) for number in found)
    if abs(b) == 90:
        assert 0.0 == found[0]
        assert b == found[1]


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ((10, 20, 30, 0, 0, 0), (1, 2, 3, 0, 0, 0), (11, 22, 33, 0, 0, 0)),
        ((0, 0, 0, 90, 0, 0), (1, 0, 0, 0, 0, 0), (0, 1, 0, 90, 0, 0)),
        ((0, 0, 0, 0, 90, 0), (1, 0, 0, 0, 0, 0), (0, 0, -1, 0, 90, 0)),
        ((0, 0, 0, 0, 0, 90), (0, 1, 0, 0, 0, 0), (0, 0, 1, 0, 0, 90)),
        ((0, 0, 0, 90, 0, 0), (0, 0, 0, 90, 0, 0), (0, 0, 0, 180, 0, 0)),
        ((0, 0, 0, -90, 0, 0), (0, 0, 0, -90, 0, 0), (0, 0, 0, 180, 0, 0)),
        ((0, 0, 0, 30, 0, 0), (0, 0, 0, 0, 90, 0), (0, 0, 0, 0, 90, -30)),
        ((0, 0, 0, 30, 0, 0), (0, 0, 0, 0, -90, 0), (0, 0, 0, 0, -90, 30)),
        ((0, 0, 0, 0, 90, 0), (0, 0, 0, 30, 0, 0), (0, 0, 0, 90, 60, 90)),
        ((0, 0, 0, 20, 90, 50), (0, 0, 0, 0, 0, 0), (0, 0, 0, 0, 90, 30)),
        ((0, 0, 0, 0, 120, 0), (0, 0, 0, 0, 0, 0), (0, 0, 0, 180, 60, 180)),
        ((0, 0, 0, 10, 20, 30), (0, 0, 0, 0, 0, 0), (0, 0, 0, 10, 20, 30)),
        ((5, 0, 0, 370, 0, 0), (0, 0, 0, 0, 0, 0), (5, 0, 0, 10, 0, 0)),
    ],
)
def test_composition_by_hand(
    left: tuple[float, ...], right: tuple[float, ...], expected: tuple[float, ...]
) -> None:
    """Turns about one axis come out as worked out by hand, 180 and not -180 [ARI-08, ARI-09]."""
    found = _composed(_pose("FRAME", *left), _pose("FRAME", *right))
    assert pytest.approx(expected, abs=1e-5) == found.members
    assert all(number == single(number) for number in found.members)


def test_result_has_the_type_of_the_right_operand() -> None:
    """FRAME:E6POS is an E6POS, which keeps Status, Turn and external axes of the right [ARI-08]."""
    frame = _pose("FRAME", 10, 0, 0, 0, 0, 0)
    point = _pose("E6POS", 1, 2, 3, 0, 0, 0, S=2, T=35, E1=7.5)
    found = _composed(frame, point)
    assert "E6POS" == found.type.name
    others = {**dict.fromkeys(["E2", "E3", "E4", "E5", "E6"]), "S": 2, "T": 35, "E1": 7.5}
    assert others.items() <= to_json(found).items()
    assert 11.0 == found.get("X")
    assert "FRAME" == _composed(point, frame).type.name
    assert 1.0 == point.get("X")


def test_inverse_has_no_status() -> None:
    """The inverse of a pose has its type, and no Status, Turn or external axes [FCT-03]."""
    found = inverted(_pose("E6POS", 1, 2, 3, 0, 0, 90, S=2, T=35, E1=7.5))
    assert "E6POS" == found.type.name
    assert pytest.approx((-1, -3, 2, 0, 0, -90), abs=1e-6) == found.members[:6]
    assert [None] * 8 == found.members[6:]


@pytest.mark.parametrize("side", [0, 1])
def test_composition_needs_all_components(side: int) -> None:
    """A pose without one of X to C cannot be composed; without S and T it can [TYP-13]."""
    whole = _pose("POS", 1, 2, 3, 4, 5, 6)
    assert isinstance(_composed(whole, whole), StructureValue)
    for name in "XYZABC":
        lacking = _pose("POS", 1, 2, 3, 4, 5, 6)
        lacking.set(name, None)
        operands = [whole, whole]
        operands[side] = lacking
        with pytest.raises(Fault) as caught:
            _composed(*operands)
        assert "uninitialised" == caught.value.slug


def test_composition_may_overflow() -> None:
    """A place that no REAL can hold is a fault [TYP-02]."""
    far = _pose("FRAME", 3e38, 0, 0, 0, 0, 0)
    with pytest.raises(Fault) as caught:
        _composed(far, far)
    assert "overflow" == caught.value.slug


def test_axis_positions_are_not_composed() -> None:
    """The geometric operator joins poses only [ARI-08]."""
    axis = empty(_type("AXIS"))
    assert isinstance(axis, StructureValue)
    with pytest.raises(Fault) as caught:
        inverted(axis)
    assert "operand" == caught.value.slug
