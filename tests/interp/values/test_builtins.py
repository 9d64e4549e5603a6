"""Predefined functions: numbers, random numbers, texts, conversions, variables by name."""

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    CHAR,
    INT_MAX,
    INT_MIN,
    Array,
    Enumeration,
)
from interp.values.builtins import BUILTINS, FUNCTIONS, WORLD, Randomness, Surroundings, call
from interp.values.faults import FAULTS, Fault
from interp.values.json_form import real_text
from interp.values.texts import Outcome
from interp.values.values import (
    ArrayValue,
    constant,
    empty,
    set_text,
    single,
    text_of,
)

CASE_SENSE = System.load().types["CASE_SENSE_T"]
assert isinstance(CASE_SENSE, Enumeration)
SENSITIVE, INSENSITIVE = constant(CASE_SENSE, "CASE_SENS"), constant(CASE_SENSE, "NOT_CASE_SENS")
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)
LETTERS = st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=12)
FEW_LETTERS = st.text("aAbB", max_size=6)
COLOUR = Enumeration("COLOUR", ("RED",))


def _nowhere(_name: str) -> None:
    return None


def _call(name: str, *arguments: Any) -> Outcome:
    return call(name, arguments, Surroundings(Randomness(), _nowhere))


def _result(name: str, *arguments: Any) -> Any:
    return _call(name, *arguments)[0]


def _text(size: int, text: str) -> ArrayValue:
    array = empty(Array(CHAR, (size,)))
    assert isinstance(array, ArrayValue)
    set_text(array, text)
    return array


# ---------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"INV_POS"}))
@given(data=st.data())
def test_functions_give_singles(name: str, data: st.DataObject) -> None:
    """For any REAL there is a REAL as result, or a fault that the table names [TYP-02]."""
    primitive = FUNCTIONS[name]
    operands = [data.draw(SINGLES | st.floats(-1, 1, width=32)) for _ in primitive.operands]
    slug = ""
    try:
        result = _result(name, *operands)
    except Fault as raised:
        slug = raised.slug
    if slug:
        assert slug in primitive.faults
    else:
        assert result == single(result)


@given(st.floats(-720, 720, width=32))
def test_angles_are_degrees(angle: float) -> None:
    """Sine and cosine lie on the circle, and ATAN2 finds the angle again [FCT-02]."""
    sine, cosine = _result("SIN", angle), _result("COS", angle)
    assert pytest.approx(math.sin(math.radians(angle)), abs=1e-7) == sine
    assert pytest.approx(1, abs=1e-6) == sine**2 + cosine**2
    found = _result("ATAN2", sine, cosine)
    assert -180 <= found <= 180
    assert pytest.approx(0, abs=2e-4) == math.remainder(found - angle, 360)


@given(SINGLES.map(abs).filter(bool))
def test_roots_are_those_of_singles(number: float) -> None:
    """The root is the REAL next to the exact one: rounding once is enough [TYP-02]."""
    root = Fraction(_result("SQRT", number))
    half = Fraction(math.ulp(float(root))) * 2**28  # half a unit in the last place of a single
    assert (root - half) ** 2 <= Fraction(number) <= (root + half) ** 2


# ---------------------------------------------------------------------------------- random numbers


def test_random_numbers_are_fixed() -> None:
    """The numbers follow from the seed alone, as any implementation of the generator has them."""
    numbers = Randomness(1)
    states = []
    for _ in range(3):
        number = numbers()
        states.append(numbers.state)
        assert numbers.state / 2**32 == number
    assert [270369, 67634689, 2647435461] == states
    assert Randomness(1)() == Randomness(0)()
    assert Randomness(2)() != Randomness(1)()


@given(SINGLES, SINGLES, st.floats(0, 1, exclude_max=True))
def test_frand_stays_between(least: float, most: float, number: float) -> None:
    """The result of FRAND lies between its limits, both included [FCT-01]."""
    low, high = sorted((least, most))
    found = call("FRAND", (low, high), Surroundings(lambda: number, _nowhere))[0]
    assert isinstance(found, float)
    assert low <= found <= high


# ---------------------------------------------------------------------------------- STR…


@given(LETTERS, LETTERS, st.integers(1, 24))
def test_strings_against_python(one: str, other: str, size: int) -> None:
    """Length, joining and copying are those of Python's texts [FCT-04]."""
    used = one[:size]
    target = _text(size, one)
    assert len(used) == _result("STRLEN", target)
    added = _call("STRADD", target, other)
    fits = len(used + other) <= size
    assert (len(used + other) if fits else 0) == added[0]
    assert text_of(added[1].get(0, target)) == (used + other if fits else used)
    assert (len(other) <= size) is _result("STRCOPY", target, other)


@given(FEW_LETTERS, FEW_LETTERS.filter(bool), st.integers(1, 8), st.booleans())
def test_search_against_python(text: str, wanted: str, start: int, is_sensitive: bool) -> None:
    """Searching and comparing are those of Python's texts, places counted from 1 [FCT-04]."""
    mode = SENSITIVE if is_sensitive else INSENSITIVE
    one, other = (text, wanted) if is_sensitive else (text.lower(), wanted.lower())
    assert one.find(other, start - 1) + 1 == _result("STRFIND", start, text, wanted, mode)
    assert (one == other) is _result("STRCOMP", text, wanted, mode)


# ---------------------------------------------------------------------------------- STRTO…


@given(SINGLES, st.integers(INT_MIN, INT_MAX))
def test_numbers_survive_as_texts(number: float, whole: int) -> None:
    """What a REAL or an INT is written as gives it again [FCT-05, TYP-02]."""
    assert number == _call("STRTOREAL", real_text(number), None)[1][1]
    assert whole == _call("STRTOINT", str(whole), None)[1][1]


# ---------------------------------------------------------------------------------- the tables


def test_every_predefined_routine_has_its_place() -> None:
    """What is predefined either computes or needs the world, and nothing does both [FCT-01]."""
    functions = set(System.load().functions)
    assert functions == set(BUILTINS) | WORLD
    assert set() == set(BUILTINS) & WORLD
    assert set(FUNCTIONS) <= set(BUILTINS)
    assert {"PULSE", "CWRITE", "SET_KRLMSG", "FORWARD", "INVERSE", "ERR_RAISE"} <= WORLD


def test_functions_are_described() -> None:
    """A function has faults of the catalogue, and as many operands as parameters."""
    for name, primitive in FUNCTIONS.items():
        assert primitive.name == name.lower()
        assert set(primitive.faults) <= set(FAULTS)
        assert len(primitive.operands) == len(BUILTINS[name].declared.parameters)


def test_changes_are_reported() -> None:
    """The table tells which arguments a function may change; all of SREAD's variables [FCT-09]."""

    def is_out(name: str, place: int) -> bool:
        parameter = BUILTINS[name].declared.parameter(place)
        return parameter is not None and parameter.is_out

    for name, places in (("STRADD", [0]), ("STRTOINT", [1]), ("STRLEN", []), ("SWRITE", [0, 1, 2])):
        assert places == [place for place in range(9) if is_out(name, place)]
    assert [1, 2, 4, 5] == [place for place in range(6) if is_out("SREAD", place)]
