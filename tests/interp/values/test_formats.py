"""SWRITE and SREAD, beyond what the cases of `data` state."""

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.types import CHAR, INT_MAX, INT_MIN, Array, Enumeration
from interp.values.builtins import Randomness, Surroundings, call
from interp.values.faults import Fault
from interp.values.json_form import to_json
from interp.values.values import ArrayValue, Value, constant, empty, set_text, single, text_of

GREEN = constant(Enumeration("COLOUR", ("RED", "Green")), "GREEN")


#: The new values of arguments, by place.
Changes = Mapping[int, Value]


def _call(name: str, *arguments: Any) -> Changes:
    result, changes = call(name, arguments, Surroundings(Randomness(), lambda _: None))
    assert result is None
    return changes


def _text(size: int, text: str) -> ArrayValue:
    array = empty(Array(CHAR, (size,)))
    assert isinstance(array, ArrayValue)
    set_text(array, text)
    return array


def _state(reply: Changes) -> tuple[str, int, int]:
    state = to_json(reply[1])
    return state["RET1"].removeprefix("#"), state["HITS"], state["LENGTH"]


def _swrite(
    pattern: str, *values: Any, size: int = 60, before: str = "", offset: int = 0
) -> Changes:
    return _call("SWRITE", _text(size, before), None, offset, pattern, *values)


def _written(reply: Changes) -> str:
    return text_of(reply[0] or "")


# ---------------------------------------------------------------------------------- SWRITE


def test_offset_is_where_writing_begins() -> None:
    """Writing begins behind the offset, which then lies behind what was written [FCT-09]."""
    reply = _swrite("%d", 12, before="abcdef", offset=2)
    assert "ab12ef" == _written(reply)
    assert 4 == reply[2]
    assert ("CMD_OK", 1, 2) == _state(reply)
    gap = _swrite("%d", 12, size=6, before="a", offset=3)
    assert ["a", None, None, "1", "2", None] == to_json(gap[0])
    end = _swrite("", size=3, before="abc", offset=3)
    assert ("CMD_OK", 0, 0) == _state(end)


def test_arguments_are_left_alone() -> None:
    """The text that was passed is not changed itself: the executor assigns the new one."""
    target = _text(5, "abc")
    _call("SWRITE", target, None, 0, "xy")
    assert "abc" == text_of(target)


def test_part_of_an_array_is_written() -> None:
    """A row of an array of texts is written like any text [TYP-11]."""
    names = empty(Array(CHAR, (2, 4)))
    assert isinstance(names, ArrayValue)
    reply = _call("SWRITE", names.part(2), None, 0, "%d", 42)
    assert "42" == to_json(reply[0])


@pytest.mark.parametrize(
    ("pattern", "values", "written", "hits"),
    [
        ("%d %d", (1,), "1 ", 1),
        ("%d", (1, 2), "1", 1),
        ("%d", (), "", 0),
        ("text", (1,), "text", 0),
        ("%d %q", (1, 2), "1 ", 1),
        ("%d %", (1, 2), "1 ", 1),
        ("a%d", ("abc",), "a", 0),
        *(("%s", (1,), "", 0), ("%s", (1.5,), "", 0), ("%c", ("ab",), "", 0)),
        *(("%c", (True,), "", 0), ("%c", (256,), "", 0), ("%c", (-1,), "", 0)),
        *(("%x", (1.5,), "", 0), ("%u", (1.5,), "", 0), ("%f", ("a",), "", 0)),
        *(("%d", (GREEN,), "", 0), ("%2048d", (1,), "", 0), ("%.2048d", (1,), "", 0)),
        *(("%99999d", (1,), "", 0), ("%1.2.3d", (1,), "", 0)),
        ("%d" * 11, tuple(range(11)), "0123456789", 10),
    ],
)
def test_writing_stops_at_what_does_not_fit(
    pattern: str, values: tuple[Any, ...], written: str, hits: int
) -> None:
    """What the format cannot write ends the call; STATE tells how far it came [FCT-08]."""
    reply = _swrite(pattern, *values)
    assert written == _written(reply)
    assert ("FMT_ERR", hits, len(written)) == _state(reply)
    assert len(written) == reply[2]


@pytest.mark.parametrize(
    ("size", "pattern", "values", "written", "hits"),
    [
        (3, "%d", (1234,), "", 0),
        (3, "%d", (123,), "123", 1),
        (3, "%d,%d", (1, 23), "1,", 1),
        (3, "abcd", (), "", 0),
        (3, "%2047d", (1,), "", 0),
    ],
)
def test_texts_have_an_end(
    size: int, pattern: str, values: tuple[int, ...], written: str, hits: int
) -> None:
    """What does not fit into the text is not written, not even in part [FCT-09]."""
    reply = _swrite(pattern, *values, size=size)
    assert written == _written(reply)
    assert hits == _state(reply)[1]
    assert ("CMD_OK" if hits == len(values) and values else "FMT_ERR") == _state(reply)[0]


@pytest.mark.parametrize("name", ["SWRITE", "SREAD"])
@pytest.mark.parametrize("offset", [-1, 4, INT_MAX])
def test_offset_must_lie_in_the_text(name: str, offset: int) -> None:
    """With an offset outside the text nothing is written or read [FCT-09]."""
    target = _text(3, "abc")
    reply = _call(name, target, None, offset, "%s", _text(3, "x"))
    assert ("CMD_ABORT", 0, 0) == _state(reply)
    assert [1] == list(reply)


@pytest.mark.parametrize("name", ["SWRITE", "SREAD"])
def test_offset_needs_a_value(name: str) -> None:
    """An offset that was never set faults, and so does a value to be written [TYP-13]."""
    for arguments in ((_text(3, ""), None, None, "x"), (_text(3, ""), None, 0, "%d", None)):
        if name == "SREAD" and arguments[2] == 0:
            continue
        with pytest.raises(Fault) as caught:
            _call(name, *arguments)
        assert "uninitialised" == caught.value.slug


# ---------------------------------------------------------------------------------- SREAD


def _read(reply: Changes) -> list[Value]:
    return [reply[place] for place in sorted(reply) if place >= 4]


def _sread(text: str, pattern: str, variables: int, offset: int = 0) -> Changes:
    return _call("SREAD", text, None, offset, pattern, *[None] * variables)


@pytest.mark.parametrize(
    ("text", "pattern", "expected"),
    [
        *(("12", "%d", 12), (" -7", "%d", -7), ("+3", "%i", 3), ("12345", "%3d", 123)),
        *(("2147483647", "%d", INT_MAX), ("-2147483648", "%d", INT_MIN), ("1.5", "%d", 1)),
        *(("1.5", "%f", 1.5), ("-.5e1", "%f", -5.0), ("0.1", "%g", single(0.1)), ("3", "%e", 3.0)),
        *(("1.2345", "%4f", single(1.23)), ("ff", "%x", 255), ("0xFF", "%x", 255)),
        *(("ffffffff", "%x", -1), ("4294967295", "%u", -1), ("7", "%u", 7), ("abcd", "%2x", 171)),
        *(("A", "%c", "A"), (" A", "%c", " "), ("abc", "%2c", "ab"), ("abc def", "%s", "abc")),
        *(("  abc", "%s", "abc"), ("abcdef", "%3s", "abc"), ("x=5", "x=%d", 5), ("5%", "%d%%", 5)),
        *(("a   5", "a %d", 5), ("a5", "a %d", 5)),
    ],
)
def test_values_are_read_by_format(text: str, pattern: str, expected: Value) -> None:
    """Each letter reads its values, no wider than the width [FCT-09]."""
    reply = _sread(text, pattern, 1)
    assert expected == reply[4]
    assert type(expected) is type(reply[4])
    assert "CMD_OK" == _state(reply)[0]
    assert 1 == _state(reply)[1]


@pytest.mark.parametrize(
    ("text", "pattern", "variables", "read"),
    [
        *(("abc", "%d", 1, ()), ("", "%d", 1, ()), ("", "%s", 1, ()), ("", "%c", 1, ())),
        *(("a", "%2c", 1, ()), ("5 x", "%d %d", 2, (5,)), ("5", "%d", 2, (5,))),
        *(("5 6", "%d %d", 1, (5,)), ("5,6", "%d;%d", 2, (5,)), ("2147483648", "%d", 1, ())),
        *(("4294967296", "%u", 1, ()), ("-1", "%u", 1, ()), ("fffffffff", "%x", 1, ())),
        *(("1e99", "%f", 1, ()), ("nan", "%f", 1, ()), ("5", "%q", 1, ()), ("5", "%0d", 1, ())),
        *(("5", "%.2d", 1, ()), ("9" * 400, "%d", 1, ()), ("9" * 400, "%u", 1, ())),
        (" ".join("0123456789a"), "%d" * 10 + "%s", 11, tuple(range(10))),
    ],
)
def test_reading_stops_at_what_does_not_fit(
    text: str, pattern: str, variables: int, read: tuple[Value, ...]
) -> None:
    """What is not as the format says ends the call; what was read before stays [FCT-08]."""
    reply = _sread(text, pattern, variables)
    assert list(read) == _read(reply)
    assert ("FMT_ERR", len(read)) == _state(reply)[:2]


@given(
    st.integers(INT_MIN, INT_MAX),
    st.floats(-1e6, 1e6, width=32),
    st.text("abcXYZ.-_", min_size=1, max_size=9),
)
def test_what_is_written_can_be_read(whole: int, number: float, word: str) -> None:
    """Values that SWRITE wrote are read again by SREAD [FCT-09]."""
    written = _swrite("%d %s %x %.9e", whole, word, whole, number, size=80)
    read = _sread(_written(written), "%d %s %x %e", 4)
    assert [whole, word, whole, number] == _read(read)


@given(st.text("%+-#0123456789.dfsxcgeu ", max_size=12), st.lists(st.integers(), max_size=3))
def test_any_format_is_survived(pattern: str, values: list[int]) -> None:
    """Whatever the format, STATE tells what came of it, and the text keeps its size [FCT-09]."""
    numbers = [max(INT_MIN, min(INT_MAX, value)) for value in values]
    reply = _swrite(pattern, *numbers, size=20)
    assert _state(reply)[0] in ("CMD_OK", "FMT_ERR")
    assert 20 == len(reply[0])  # type: ignore[arg-type]
    assert _state(_sread("12 3.5 abc", pattern, len(values)))[0] in ("CMD_OK", "FMT_ERR")
