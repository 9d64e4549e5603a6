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
    Enumeration,
    Structure,
    Type,
)
from interp.values.faults import FAULTS, Fault
from interp.values.json_form import from_json
from interp.values.operators import (
    BINARY,
    PRIMITIVES,
    UNARY,
    Kind,
    apply,
    apply_unary,
    kind_of,
    kind_of_value,
)
from interp.values.values import REAL_MAX, StructureValue, Value, constant, single

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

_SAMPLES: list[Value] = [1, 1.0, True, "A", RED, _pose("FRAME", 1, 2, 3, 0, 0, 0)]


def _type_of(value: Value) -> Type:
    scalars: dict[type, Type] = {int: INT, float: REAL, bool: BOOL, str: CHAR}
    return scalars.get(type(value)) or value.type  # type: ignore[union-attr]


# ---------------------------------------------------------------------------------- selection


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
    """A primitive has a name of its own, and faults that are in the catalogue."""
    for name, primitive in PRIMITIVES.items():
        assert name == primitive.name
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
