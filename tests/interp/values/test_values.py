"""Values: numbers, compound values, conversion, texts, and how they are written."""

import json
import math
import struct
from fractions import Fraction
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
from interp.values.json_form import from_json, real_text, rendered, to_json
from interp.values.values import (
    REAL_MAX,
    ArrayValue,
    EnumValue,
    StructureValue,
    Value,
    constant,
    converted,
    copied,
    empty,
    fill,
    has_value,
    index,
    integer,
    known,
    letters,
    member_place,
    position_type,
    rounded,
    set_text,
    single,
    text_of,
    zero,
)

COLOUR = Enumeration("COLOUR", ("RED", "Green", "BLUE"))
PART = Structure("PART", (Member("COUNT", INT), Member("NAME", Array(CHAR, (4,)))))
BOX = Structure("BOX", (Member("FIRST", PART), Member("WEIGHT", REAL), Member("C", COLOUR)))
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)


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


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (0.1, 0.10000000149011612),
        (16777217.0, 16777216.0),  # a tie, to even
        (16777219.0, 16777220.0),  # a tie, to even
        (1.0 + 2.0**-24, 1.0),
        (1.0 + 3 * 2.0**-24, 1.0 + 2.0**-22),
        (2147483647, 2147483648.0),
        (3.4028235677973362e38, REAL_MAX),  # one below halfway to what is no single
        (-3.4e38, -3.3999999521443642e38),
        (1e-45, 2.0**-149),
        (7e-46, 0.0),
        (1e-300, 0.0),
    ],
)
def test_reals_are_singles(number: float, expected: float) -> None:
    """A REAL is rounded to the nearest IEEE single, ties to even [TYP-02]."""
    assert expected == single(number)


@pytest.mark.parametrize("number", [3.4028235677973366e38, 1e39, -1e39, math.inf, math.nan])
def test_reals_are_finite(number: float) -> None:
    """What is larger than the largest REAL, infinite or no number is a fault [TYP-02]."""
    with pytest.raises(Fault) as caught:
        single(number)
    assert "overflow" == _slug(caught)


@given(st.floats(-3.4e38, 3.4e38))
def test_rounding_to_single_is_that_of_ieee(number: float) -> None:
    """Rounding agrees with the standard library's, and rounding again changes nothing [TYP-02]."""
    expected = struct.unpack("<f", struct.pack("<f", number))[0]
    assert expected == single(number)
    assert expected == single(single(number))


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        *((7.9, 8), (7.4, 7), (7.5, 8), (0.5, 1), (1.5, 2), (2.5, 3), (0.0, 0), (-0.0, 0)),
        *((-7.9, -8), (-7.4, -7), (-7.5, -8), (-0.5, -1), (-1.5, -2), (-2.5, -3)),
        (0.49999997, 0),
        (-0.49999997, 0),
        (8388607.5, 8388608),
        (2147483520.0, 2147483520),
        (-2147483648.0, INT_MIN),
    ],
)
def test_real_to_int_rounds_halves_away_from_zero(number: float, expected: int) -> None:
    """REAL becomes the nearest INT, halves go away from zero on both sides [ARI-03]."""
    found = rounded(number)
    assert expected == found
    assert int is type(found)


@pytest.mark.parametrize("number", [2147483648.0, -2147483904.0, 3e38])
def test_real_to_int_has_a_range(number: float) -> None:
    """A REAL that no INT is near is a fault [ARI-03]."""
    with pytest.raises(Fault) as caught:
        rounded(number)
    assert "overflow" == _slug(caught)


@given(SINGLES.filter(lambda number: abs(number) < 2**31 - 128))
def test_real_to_int_is_within_a_half(number: float) -> None:
    """Rounding moves a number by a half at most, and an odd function it is [ARI-03]."""
    assert abs(Fraction(number) - rounded(number)) <= Fraction(1, 2)
    assert -rounded(number) == rounded(-number)


@pytest.mark.parametrize("number", [INT_MIN, -1, 0, INT_MAX])
def test_int_has_32_bits(number: int) -> None:
    """All numbers of 32 bits with sign are INT [TYP-01]."""
    assert number == integer(number)


@pytest.mark.parametrize("number", [INT_MIN - 1, INT_MAX + 1])
def test_int_does_not_wrap(number: int) -> None:
    """One more or less than the limits is a fault [TYP-01, ARI-12]."""
    with pytest.raises(Fault) as caught:
        integer(number)
    assert "overflow" == _slug(caught)


# ---------------------------------------------------------------------------------- compound values


def test_variables_begin_without_a_value() -> None:
    """What was declared and not set has no value in any part [TYP-13]."""
    assert None is empty(INT)
    assert None is empty(COLOUR)
    box = empty(BOX)
    assert isinstance(box, StructureValue)
    assert [StructureValue, type(None), type(None)] == [type(part) for part in box.members]
    assert not has_value(box)
    assert 6 == len(_array(REAL, 2, 3))
    assert [None] * 6 == list(_array(REAL, 2, 3))


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


def test_reading_no_value_faults() -> None:
    """A value that was never set cannot be used; zero and FALSE are values [TYP-13]."""
    assert 0 == known(0)
    assert known(False) is False
    with pytest.raises(Fault) as caught:
        known(None)
    assert "uninitialised" == _slug(caught)


def test_has_value_looks_into_all_parts() -> None:
    """A structure or array has a value as soon as one part of it has one [TYP-18]."""
    boxes = _array(BOX, 2)
    assert not has_value(boxes)
    box = boxes.get(2)
    assert isinstance(box, StructureValue)
    first = box.get("FIRST")
    assert isinstance(first, StructureValue)
    first.set("COUNT", 0)
    assert has_value(boxes)
    assert has_value(False)
    assert not has_value(None)


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


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ({"X", "Y"}, "FRAME"),
        ({"x", "c"}, "FRAME"),
        ({"X", "S"}, "POS"),
        ({"X", "E3"}, "E3POS"),
        ({"S", "E4"}, "E6POS"),
        ({"A1", "A6"}, "AXIS"),
        ({"A1", "E1"}, "E3AXIS"),
        ({"A1", "E6"}, "E6AXIS"),
        ({"X", "A1"}, None),
    ],
)
def test_aggregates_are_the_smallest_position(names: set[str], expected: str | None) -> None:
    """Components alone tell the type of an aggregate where nothing else does [TYP-15]."""
    found = position_type(frozenset(names))
    assert expected == (None if found is None else found.name)


# ---------------------------------------------------------------------------------- arrays


@pytest.mark.parametrize("place", [0, 4, -1, INT_MAX])
def test_indices_are_checked(place: int) -> None:
    """An index below 1 or above the size faults, for reading and writing [TYP-09, MSG-15]."""
    array = _array(INT, 3)
    with pytest.raises(Fault) as caught:
        array.get(place)
    assert 1444 == caught.value.number
    with pytest.raises(Fault):
        array.set(1, place)


@pytest.mark.parametrize("indices", [(0, 1, 1), (3, 1, 1), (1, 4, 1), (1, 1, 5), (1, 0, 1)])
def test_every_dimension_is_checked(indices: tuple[int, ...]) -> None:
    """Each index must lie in its own dimension, wherever the element would be [TYP-09]."""
    with pytest.raises(Fault) as caught:
        _array(INT, 2, 3, 4).get(*indices)
    assert "index" == _slug(caught)


def test_elements_lie_in_rows() -> None:
    """The last index runs fastest, and all of 1 to the size are elements [TYP-08, TYP-09]."""
    array = _array(INT, 2, 3)
    for row in (1, 2):
        for column in (1, 2, 3):
            array.set(10 * row + column, row, column)
    assert [11, 12, 13, 21, 22, 23] == array.elements
    assert 21 == array.get(2, 1)


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


@pytest.mark.parametrize(
    ("value", "to", "expected"),
    [
        (3, INT, 3),
        (3, REAL, 3.0),
        (16777217, REAL, 16777216.0),
        (3.0, INT, 3),
        (7.5, INT, 8),
        (-7.5, INT, -8),
        (0.5, REAL, 0.5),
        (True, BOOL, True),
        ("A", CHAR, "A"),
        ("A", INT, 65),
        (66, CHAR, "B"),
        (0, CHAR, "\0"),
        (255, CHAR, "\xff"),
        (constant(COLOUR, "BLUE"), COLOUR, constant(COLOUR, "BLUE")),
    ],
)
def test_values_are_converted(value: Value, to: Type, expected: Value) -> None:
    """Numbers become each other's type; letters and codes do too [ARI-03, TYP-12]."""
    found = converted(value, to)
    assert expected == found
    assert type(expected) is type(found)


@pytest.mark.parametrize(
    ("value", "to"),
    [
        *((True, INT), (True, REAL), (True, CHAR), (1, BOOL), (1.0, BOOL), ("A", BOOL)),
        *((1.0, CHAR), ("A", REAL), (256, CHAR), (-1, CHAR), ("", CHAR), ("AB", CHAR)),
        *(("AB", INT), (1, COLOUR), (constant(COLOUR, "RED"), INT), (1, UNKNOWN)),
        (constant(COLOUR, "RED"), Enumeration("OTHER", ("RED",))),
        (1, FRAME),
        (1, Array(INT, (2,))),
        ("ab", Array(INT, (2,))),
        ("ab", Array(CHAR, (2, 2))),
        (zero(FRAME), AXIS),
        (zero(AXIS), POS),
        (zero(LOAD), FRAME),
        (zero(PART), BOX),
    ],
)
def test_other_values_are_not_converted(value: Value, to: Type) -> None:
    """All other assignments are inadmissible [ARI-11, MSG-11]."""
    with pytest.raises(Fault) as caught:
        converted(value, to)
    assert 1446 == caught.value.number


def test_real_too_large_for_int_is_an_overflow() -> None:
    """Assigning a large REAL to an INT faults as rounding does [ARI-03]."""
    with pytest.raises(Fault) as caught:
        converted(3e9, INT)
    assert "overflow" == _slug(caught)


@pytest.mark.parametrize(
    ("value", "expected"),
    [(2, 2), (1.5, 2), (2.4, 2), ("\2", 2)],
    ids=["INT", "up", "down", "CHAR"],
)
def test_indices_are_converted(value: Value, expected: int) -> None:
    """A REAL is rounded to be an index, a CHAR has its code [ARI-03]."""
    assert expected == index(value)


def test_positions_take_what_they_have() -> None:
    """A pose takes from another what both have; the rest then has no value [TYP-12, TYP-15]."""
    pose = _read(E6POS, {**dict.fromkeys("XYZABC", 1), "S": 2, "T": 3, "E1": 4})
    assert dict.fromkeys("XYZABC", 1.0) == to_json(converted(pose, FRAME))
    assert {**dict.fromkeys("XYZABC", 1.0), "S": 2, "T": 3} == to_json(converted(pose, POS))
    target = zero(E6POS)
    assert isinstance(target, StructureValue)
    fill(target, _read(FRAME, {"X": 9}))
    assert 9.0 == target.get("X")
    assert [None] * 13 == target.members[1:]
    axes = _read(AXIS, {f"A{axis}": axis for axis in range(1, 7)})
    assert {f"A{axis}": axis for axis in range(1, 7)}.items() <= to_json(
        converted(axes, E6AXIS)
    ).items()


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


@pytest.mark.parametrize(
    ("size", "text", "expected"),
    [(5, "", ""), (5, "abc", "abc"), (5, "abcde", "abcde"), (5, "abcdef", "abcde"), (1, "x", "x")],
)
def test_texts_are_cut_to_size(size: int, text: str, expected: str) -> None:
    """A CHAR array takes what fits of a text, and nothing stands behind it [TYP-11]."""
    array = _text(size, "zzzzz")
    set_text(array, text)
    assert expected == text_of(array)
    assert [None] * (size - len(expected)) == list(array)[len(expected) :]


def test_text_ends_at_no_value_or_code_0() -> None:
    """The used part of a text ends before an element that has no value, or the code 0."""
    array = _text(5, "abcde")
    array.set(None, 4)
    assert "abc" == text_of(array)
    array.set("\0", 2)
    assert "a" == text_of(array)
    assert "ab" == text_of("ab\0c")


@pytest.mark.parametrize("value", [1, True, _numbers(1, 2), zero(FRAME)])
def test_only_letters_are_a_text(value: Value) -> None:
    """What is no CHAR array and no text has no text."""
    with pytest.raises(Fault) as caught:
        text_of(value)
    assert "argument" == _slug(caught)


def test_letters_of_a_program_are_bytes() -> None:
    """Letters of a source file become bytes of cp1252, each a character up to 255 [TYP-03]."""
    assert "a\xe4\xdf" == letters("aäß")
    assert "\x80" == letters("€")
    assert "?" == letters("中")


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
