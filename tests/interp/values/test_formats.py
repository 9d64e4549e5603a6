"""SWRITE and SREAD, beyond what the cases of `data` state."""

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.semantics.types import CHAR, INT_MAX, INT_MIN, Array, Enumeration
from interp.values.builtins import Randomness, Surroundings, call
from interp.values.json_form import to_json
from interp.values.texts import real_of
from interp.values.values import ArrayValue, Value, constant, empty, set_text, text_of

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


def test_arguments_are_left_alone() -> None:
    """The text that was passed is not changed itself: the executor assigns the new one."""
    target = _text(5, "abc")
    _call("SWRITE", target, None, 0, "xy")
    assert "abc" == text_of(target)


# ---------------------------------------------------------------------------------- SREAD


def _read(reply: Changes) -> list[Value]:
    return [reply[place] for place in sorted(reply) if place >= 4]


def _sread(text: str, pattern: str, variables: int, offset: int = 0) -> Changes:
    return _call("SREAD", text, None, offset, pattern, *[None] * variables)


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


@pytest.mark.parametrize("letter", "duxfeg")
def test_thousands_of_digits_are_no_number(letter: str) -> None:
    """They are read as little as any other number that is too large."""
    assert "FMT_ERR" == _state(_sread("9" * 5000, f"%{letter}", 1))[0]


def test_digits_before_what_is_no_number_are_read_once() -> None:
    """A text as long as an array may be takes no hours."""
    assert real_of("9" * 500_000 + "x") is None


@given(st.text("%+-#0123456789.dfsxcgeu ", max_size=12), st.lists(st.integers(), max_size=3))
def test_any_format_is_survived(pattern: str, values: list[int]) -> None:
    """Whatever the format, STATE tells what came of it, and the text keeps its size [FCT-09]."""
    numbers = [max(INT_MIN, min(INT_MAX, value)) for value in values]
    reply = _swrite(pattern, *numbers, size=20)
    assert _state(reply)[0] in ("CMD_OK", "FMT_ERR")
    assert 20 == len(reply[0])  # type: ignore[arg-type]
    assert _state(_sread("12 3.5 abc", pattern, len(values)))[0] in ("CMD_OK", "FMT_ERR")
