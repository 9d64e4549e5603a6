"""Values: numbers, compound values, conversion, texts, and how they are written."""

import json
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    UNKNOWN,
    Array,
    Enumeration,
    Member,
    Structure,
    Type,
)
from interp.values.faults import Fault, LinkError
from interp.values.json_form import from_json, real_text, to_json
from interp.values.values import (
    REAL_MAX,
    ArrayValue,
    Value,
    copied,
    empty,
    set_text,
    single,
    text_of,
    zero,
)

COLOUR = Enumeration("COLOUR", ("RED", "Green", "BLUE"))
PART = Structure("PART", (Member("COUNT", INT), Member("NAME", Array(CHAR, (4,)))))
BOX = Structure("BOX", (Member("FIRST", PART), Member("WEIGHT", REAL), Member("C", COLOUR)))
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)


def rendered(value: Value | None) -> str:
    """The value as JSON, in one line."""
    return json.dumps(to_json(value), ensure_ascii=False, separators=(",", ":"))


def _structure(name: str) -> Structure:
    type_ = System.load().types[name]
    assert isinstance(type_, Structure)
    return type_


FRAME, POS, E6POS, AXIS, E6AXIS, LOAD = map(
    _structure, ["FRAME", "POS", "E6POS", "AXIS", "E6AXIS", "LOAD"]
)


def _array(element: Type, *sizes: int) -> ArrayValue:
    array = empty(Array(element, sizes))
    assert isinstance(array, ArrayValue)
    return array


def _numbers(*values: int | None) -> ArrayValue:
    array = _array(INT, len(values))
    array.elements[:] = values
    return array


def _text(size: int, text: str) -> ArrayValue:
    array = _array(CHAR, size)
    set_text(array, text)
    return array


def _slug(caught: pytest.ExceptionInfo[Fault]) -> str:
    return caught.value.slug


# ---------------------------------------------------------------------------------- numbers


@given(st.floats(-3.4e38, 3.4e38))
def test_rounding_to_single_is_that_of_ieee(number: float) -> None:
    """Rounding agrees with the standard library's, and rounding again changes nothing [TYP-02]."""
    expected = struct.unpack("<f", struct.pack("<f", number))[0]
    assert expected == single(number)
    assert expected == single(single(number))


# ---------------------------------------------------------------------------------- compound values


def test_zero_has_a_value_in_every_part() -> None:
    """Zero is 0, FALSE, code 0 and the first constant, in all members and elements."""
    box = zero(BOX)
    expected = {"FIRST": {"COUNT": 0, "NAME": ["\0"] * 4}, "WEIGHT": 0.0, "C": "#RED"}
    assert expected == to_json(box)
    assert '{"M":0.0,"CM":{"X":0.0,"Y":0.0,"Z":0.0,"A":0.0,"B":0.0,"C":0.0},' in rendered(
        zero(LOAD)
    )
    assert [False, False] == to_json(zero(Array(BOOL, (2,))))


@pytest.mark.parametrize("type_", [UNKNOWN, Array(INT, (None,)), Array(UNKNOWN, (2,))])
def test_what_is_not_known_cannot_be_made(type_: Type) -> None:
    """A variable of unknown type or size cannot be made: the program does not link."""
    with pytest.raises(LinkError):
        empty(type_)
    with pytest.raises(LinkError):
        zero(type_)


# ---------------------------------------------------------------------------------- texts


@pytest.mark.parametrize("value", [1, True, _numbers(1, 2), zero(FRAME)])
def test_only_letters_are_a_text(value: Value) -> None:
    """What is no CHAR array and no text has no text."""
    with pytest.raises(Fault) as caught:
        text_of(value)
    assert "argument" == _slug(caught)


@given(st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=8))
def test_texts_survive(text: str) -> None:
    """A text that fits is read back as it was written [TYP-11]."""
    assert text == text_of(_text(8, text))


# ---------------------------------------------------------------------------------- as JSON


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        *((0.0, "0.0"), (-0.0, "0.0"), (1.0, "1.0"), (-2.5, "-2.5"), (0.1, "0.1")),
        *((1 / 3, "0.33333334"), (100.0, "100.0"), (1e20, "1e+20"), (123456.7, "123456.7")),
        *((16777216.0, "16777216.0"), (REAL_MAX, "3.4028235e+38"), (1e-45, "1e-45")),
        *(
            (1.1754943508222875e-38, "1.1754944e-38"),
            (1e-40, "1e-40"),
            (9.999999e-5, "9.999999e-05"),
        ),
        *((0.30000001192092896, "0.3"), (33554432.0, "33554432.0"), (8.589973e9, "8589974000.0")),
    ],
)
def test_reals_are_written_short(number: float, expected: str) -> None:
    """A REAL is written in the fewest digits that read back as it [TYP-02]."""
    assert expected == real_text(single(number))


@given(SINGLES)
def test_reals_are_read_back(number: float) -> None:
    """The text of a REAL gives it again, and no text of fewer digits does [TYP-02]."""
    text = real_text(number)
    assert number == single(float(text))
    digits = len(text.partition("e")[0].replace(".", "").lstrip("-0").rstrip("0"))
    fewer = max(digits - 1, 1)
    shorter = float(f"{number:.{fewer}g}")
    assert digits <= 1 or abs(shorter) > REAL_MAX or single(shorter) != number


@pytest.mark.parametrize(
    ("type_", "data", "line"),
    [
        (INT, 8, "8"),
        (REAL, 8.0, "8.0"),
        (BOOL, True, "true"),
        (CHAR, "A", '"A"'),
        (CHAR, "\xe4", '"ä"'),
        (INT, None, "null"),
        (COLOUR, "#GREEN", '"#GREEN"'),
        (Array(INT, (3,)), [1, None, 3], "[1,null,3]"),
        (Array(INT, (2, 2)), [[1, 2], [3, 4]], "[[1,2],[3,4]]"),
        (Array(CHAR, (4,)), "ab", '"ab"'),
        (Array(CHAR, (4,)), "", '""'),
        (Array(CHAR, (4,)), ["a", None, "c", None], '["a",null,"c",null]'),
        (Array(CHAR, (3,)), ["a", "\0", None], '["a","\\u0000",null]'),
        (Array(CHAR, (2, 3)), ["ab", ""], '["ab",""]'),
        (PART, {"COUNT": 1, "NAME": "x"}, '{"COUNT":1,"NAME":"x"}'),
        (Array(PART, (1,)), [{"COUNT": None, "NAME": ""}], '[{"COUNT":null,"NAME":""}]'),
        (
            BOX,
            {"FIRST": {"COUNT": 1, "NAME": ""}, "WEIGHT": 0.1, "C": "#RED"},
            '{"FIRST":{"COUNT":1,"NAME":""},"WEIGHT":0.1,"C":"#RED"}',
        ),
    ],
)
def test_values_are_written_and_read(type_: Type, data: Any, line: str) -> None:
    """Every kind of value has one form as JSON, from which it is made again."""
    value = from_json(type_, data)
    assert data == to_json(value)
    assert line == rendered(value)
    assert value == from_json(type_, json.loads(line))


def test_reals_may_be_written_without_a_point() -> None:
    """Who writes expectations may write 8 for 8.0; the value is a REAL all the same."""
    found = from_json(REAL, 8)
    assert 8.0 == found
    assert float is type(found)
    assert 0.10000000149011612 == from_json(REAL, 0.1)


@pytest.mark.parametrize(
    ("type_", "data"),
    [
        *((INT, 8.0), (INT, True), (BOOL, 1), (CHAR, 65), (REAL, "8"), (COLOUR, "RED")),
        *((FRAME, []), (Array(INT, (2,)), [1]), (Array(INT, (2,)), "ab"), (COLOUR, 1)),
    ],
)
def test_wrong_json_is_refused(type_: Type, data: Any) -> None:
    """What is no value of the type is refused in one line."""
    with pytest.raises(ValueError, match=r"^not "):
        from_json(type_, data)


def _written(type_: Any) -> st.SearchStrategy[Any]:
    """The JSON of values of a type, as `to_json` writes it."""
    match type_:
        case Structure():
            return st.fixed_dictionaries(
                {member.name: _written(member.type) for member in type_.members}
            )
        case Array():
            row = Array(type_.element, type_.sizes[1:]) if type_.sizes[1:] else type_.element
            if row == CHAR:
                return st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=2)
            size = type_.sizes[0] or 0
            return st.lists(_written(row), min_size=size, max_size=size)
        case Enumeration():
            return st.none() | st.sampled_from([f"#{name.upper()}" for name in type_.constants])
    if type_ == INT:
        return st.none() | st.integers(INT_MIN, INT_MAX)
    return st.none() | SINGLES.map(lambda number: float(real_text(number)))


@pytest.mark.parametrize(
    "type_",
    [BOX, LOAD, E6POS, Array(BOX, (2,)), Array(CHAR, (2, 3)), Array(REAL, (2, 1, 2))],
    ids=str,
)
@given(data=st.data())
def test_any_value_survives_json(type_: Type, data: st.DataObject) -> None:
    """Any value is read back equal, and so is a copy of it."""
    written = data.draw(_written(type_))
    value = from_json(type_, written)
    assert written == to_json(value)
    assert value == from_json(type_, json.loads(rendered(value)))
    assert rendered(value) == rendered(copied(value))
