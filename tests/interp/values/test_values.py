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
    EnumValue,
    StructureValue,
    Value,
    constant,
    copied,
    empty,
    fill,
    has_value,
    member_place,
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


def _read(type_: Type, data: Any) -> Any:
    return from_json(type_, data)


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


def test_members_are_found_in_any_letter_case() -> None:
    """A member is found by its name, whose letter case does not matter [TYP-05]."""
    load = zero(LOAD)
    assert isinstance(load, StructureValue)
    load.set("m", 2.5)
    assert 2.5 == load.get("M")
    assert 1 == member_place(LOAD, "Cm")
    with pytest.raises(LinkError):
        member_place(LOAD, "X")


def test_constants_are_found_in_any_letter_case() -> None:
    """A constant has its place in the enumeration, and keeps its spelling [TYP-05, TYP-16]."""
    green = constant(COLOUR, "GREEN")
    assert EnumValue(COLOUR, 1) == green
    assert "Green" == green.name
    assert "#Green" == repr(green)
    with pytest.raises(LinkError):
        constant(COLOUR, "PINK")


# ---------------------------------------------------------------------------------- arrays


def test_part_of_an_array_is_no_copy() -> None:
    """A row is the same elements as in the array, with indices of its own [TYP-11]."""
    names = _array(CHAR, 3, 4)
    row = names.part(2)
    set_text(row, "abc")
    assert "b" == names.get(2, 2)
    assert [None] * 4 == list(names.part(1))
    assert "abc" == text_of(names.part(2))
    names.set("z", 2, 1)
    assert "zbc" == text_of(row)
    with pytest.raises(Fault):
        row.get(5)
    with pytest.raises(Fault):
        names.part(4)
    assert 18 == _array(INT, 3, 4, 2).part(3, 2).base


def test_arrays_are_equal_by_elements() -> None:
    """A part of an array equals an array of the same size with the same elements."""
    names = _array(CHAR, 2, 3)
    set_text(names.part(2), "ab")
    assert _text(3, "ab") == names.part(2)
    assert _text(3, "ab") != names.part(1)
    assert _text(4, "ab") != names.part(2)


# ---------------------------------------------------------------------------------- copies


def test_copies_share_nothing() -> None:
    """Changing a copy, however deep, does not change what it was copied from."""
    boxes = _array(BOX, 2)
    box = boxes.get(1)
    assert isinstance(box, StructureValue)
    fill(box, _read(BOX, {"FIRST": {"COUNT": 1, "NAME": "ab"}, "WEIGHT": 2.0, "C": "#RED"}))
    copy = copied(boxes)
    assert copy == boxes
    copy.get(1).get("FIRST").get("NAME").set("x", 1)
    copy.get(1).set("WEIGHT", 3.0)
    assert 'ab"' in rendered(boxes)
    assert 2.0 == box.get("WEIGHT")


def test_fill_keeps_references() -> None:
    """Filling a structure writes into its parts, so who holds a part sees the new value."""
    box = empty(BOX)
    assert isinstance(box, StructureValue)
    first = box.get("FIRST")
    assert isinstance(first, StructureValue)
    name = first.get("NAME")
    assert isinstance(name, ArrayValue)
    fill(box, _read(BOX, {"FIRST": {"COUNT": 7, "NAME": "xy"}}))
    assert first is box.get("FIRST")
    assert "xy" == text_of(name)
    assert 7 == first.get("COUNT")
    fill(box, _read(BOX, {}))
    assert not has_value(first)


def test_fill_copies_what_has_no_value() -> None:
    """Parts without a value are assigned like others, without a fault."""
    target = _read(FRAME, dict.fromkeys("XYZABC", 1))
    fill(target, _read(FRAME, {"X": 5}))
    assert {"X": 5.0, **dict.fromkeys("YZABC")} == to_json(target)


# ---------------------------------------------------------------------------------- conversion


def test_arrays_take_what_fits() -> None:
    """An array of one dimension takes the first elements of another; the rest has no value."""
    target = _numbers(9, 9, 9)
    fill(target, _numbers(1, 2))
    assert [1, 2, None] == list(target)
    fill(target, _numbers(4, None, 6, 7))
    assert [4, None, 6] == list(target)
    with pytest.raises(Fault) as caught:
        fill(_array(INT, 2, 3), _array(INT, 3, 2))
    assert 1446 == caught.value.number


def test_row_takes_no_more_than_it_has() -> None:
    """A long text in a row of an array leaves the next row alone [TYP-11]."""
    names = _array(CHAR, 2, 3)
    set_text(names.part(2), "xyz")
    fill(names.part(1), "abcdef")
    assert ["abc", "xyz"] == to_json(names)
    other = _numbers(1, 2, 3)
    fill(ArrayValue(Array(INT, (2,)), other.elements, 1), _numbers(8))
    assert [1, 8, None] == list(other)


def test_structures_behind_the_end_lose_their_values() -> None:
    """A shorter array leaves no value in the structures that it has nothing for [TYP-13]."""
    target = _read(Array(PART, (2,)), [{"COUNT": 1, "NAME": "a"}, {"COUNT": 2, "NAME": "b"}])
    second = target.get(2)
    fill(target, _read(Array(PART, (1,)), [{"COUNT": 9, "NAME": "z"}]))
    assert [{"COUNT": 9, "NAME": "z"}, {"COUNT": None, "NAME": ""}] == to_json(target)
    assert second is target.get(2)


def test_array_may_be_filled_with_itself() -> None:
    """Filling an array or a structure with itself changes nothing."""
    array, frame = _numbers(1, 2, None), _read(FRAME, {"X": 1})
    fill(array, array)
    fill(frame, frame)
    assert [1, 2, None] == list(array)
    assert 1.0 == frame.get("X")


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
