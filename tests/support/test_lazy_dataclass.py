"""Dataclasses whose generated code is compiled late behave like those of the standard library."""

import copy
import dataclasses
import pickle
from dataclasses import field
from typing import Any

import pytest

from support import lazy_dataclass


@lazy_dataclass.dataclass(frozen=True, slots=True)
class _Lazy:
    first: int
    second: list[int] = field(default_factory=list)
    third: str = field(default="x", repr=False, compare=False)
    fourth: float = field(default=0.5, kw_only=True)
    made: int = field(init=False)
    told: list[int] = field(init=False, default_factory=list)
    state: str = field(init=False, default="new")

    def __post_init__(self) -> None:
        object.__setattr__(self, "made", self.first + 1)


@dataclasses.dataclass(frozen=True, slots=True)
class _Eager:
    first: int
    second: list[int] = field(default_factory=list)
    third: str = field(default="x", repr=False, compare=False)
    fourth: float = field(default=0.5, kw_only=True)
    made: int = field(init=False)
    told: list[int] = field(init=False, default_factory=list)
    state: str = field(init=False, default="new")

    def __post_init__(self) -> None:
        object.__setattr__(self, "made", self.first + 1)


@lazy_dataclass.dataclass(slots=True)
class _Open:
    value: float


@lazy_dataclass.dataclass(frozen=True, slots=True, order=True)
class _Ordered:
    first: int
    second: str


@lazy_dataclass.dataclass(frozen=True, slots=True)
class _Unhashed:
    value: int
    table: dict[int, int] = field(hash=False)


@lazy_dataclass.dataclass(frozen=True, eq=False, repr=False)
class _Hidden:
    value: int


_GIVEN: tuple[tuple[tuple[Any, ...], dict[str, Any]], ...] = (
    ((1,), {}),
    ((1, [2]), {"fourth": 2.5}),
    ((1,), {"third": "y"}),
    ((), {}),
    ((1, [2], "z", 3.5), {}),
    ((1,), {"first": 2}),
    ((1,), {"made": 2}),
)


@pytest.mark.parametrize(("values", "named"), _GIVEN)
def test_arguments_are_taken_alike(values: tuple[Any, ...], named: dict[str, Any]) -> None:
    """The same arguments make the same values, or are refused."""

    def made(kind: Any) -> object:
        try:
            one = kind(*values, **named)
        except TypeError as error:
            return str(error).replace(_Eager.__name__, _Lazy.__name__)
        return dataclasses.asdict(one), repr(one).partition("(")[2]

    assert made(_Eager) == made(_Lazy)


def test_each_instance_has_a_list_of_its_own() -> None:
    """A factory is called for each instance."""
    one, other = _Lazy(1), _Lazy(1)
    one.second.append(5)
    assert ([5], []) == (one.second, other.second)


def test_what_is_compared_is_compared_alike() -> None:
    """Equality and hash go by the fields that count; another class is never equal."""
    assert [True, False, False] == [
        _Lazy(1) == _Lazy(1, third="y"),
        _Lazy(1) == _Lazy(2),
        _Lazy(1).__eq__(_Eager(1)) is True,
    ]
    nan = float("nan")
    assert _Open(nan) == _Open(nan)
    with pytest.raises(TypeError, match="unhashable"):
        hash(_Open(1.0))


def test_what_holds_itself_can_be_shown() -> None:
    """Where an instance comes again in itself, it is shown as dots."""
    one = _Open(1.0)
    one.value = one  # type: ignore[assignment]
    assert "_Open(value=...)" == repr(one)


def test_frozen_means_frozen() -> None:
    """A field can neither be set nor deleted; copies and pickles are made all the same."""
    one = _Lazy(1, [2])
    with pytest.raises(dataclasses.FrozenInstanceError, match="first"):
        one.first = 2  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError, match="first"):
        del one.first
    assert one == copy.copy(one) == pickle.loads(pickle.dumps(one))
    assert 3 == dataclasses.replace(one, first=2).made


def test_order_goes_by_the_fields() -> None:
    """With ``order``, instances are compared field by field, and are equal and hashed so."""
    made = [_Ordered(2, "a"), _Ordered(1, "b"), _Ordered(1, "a")]
    assert [_Ordered(1, "a"), _Ordered(1, "b"), _Ordered(2, "a")] == sorted(made)
    assert {_Ordered(1, "a")} == {_Ordered(1, "a"), _Ordered(1, "a")}


def test_a_class_may_keep_the_text_of_any_object() -> None:
    """Without ``repr`` no field is shown: a whole file may be in one."""
    assert object.__repr__(hidden := _Hidden(3)) == repr(hidden)


def test_a_field_may_be_left_out_of_the_hash() -> None:
    """What is compared and not hashed may be a value that has no hash."""
    assert hash(_Unhashed(1, {2: 3})) == hash(_Unhashed(1, {}))
    assert _Unhashed(1, {2: 3}) != _Unhashed(1, {})
