"""The parts of a rule, and functions that choose the fields of a node from them.

Nodes of a line are drafted from parts (`grammar.syntax.node_plans`), nodes that span lines are
built from them (`grammar.syntax.build`). Where a field is a part or some parts as they are, a node
is a row of a table: its kind, and a function for each field.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

_V = TypeVar("_V")


class Part(NamedTuple, Generic[_V]):
    """A child of a rule: a token or a rule by its name, and its text or node.

    ``first`` and ``stop`` are where it begins and ends: token indices in a draft, offsets in a
    block. In a draft the value is where the text or node will be (`grammar.syntax.node_plans`).
    """

    symbol: str
    value: _V
    first: int
    stop: int


#: Chooses the value of a field.
Field = Callable[[Sequence[Part[Any]]], Any]


def value_of(parts: Sequence[Part[_V]], symbol: str) -> _V | None:
    """Return the value of the first part of this kind, or ``None`` if there is none."""
    return next((part.value for part in parts if part.symbol == symbol), None)


def values_of(parts: Sequence[Part[_V]], symbol: str) -> tuple[_V, ...]:
    """Return the values of all parts of this kind, in order."""
    return tuple([part.value for part in parts if part.symbol == symbol])


def has(parts: Sequence[Part[Any]], symbol: str) -> bool:
    """Return whether there is a part of this kind."""
    return any(part.symbol == symbol for part in parts)


def after(parts: Sequence[Part[_V]], symbol: str) -> _V | None:
    """Return the value after a keyword and an equals sign; ``None`` without the keyword."""
    for place, part in enumerate(parts):
        if part.symbol == symbol:
            return parts[place + 2].value
    return None


def separated(parts: Sequence[Part[_V]]) -> tuple[_V | None, ...]:
    """Return the values between commas, with ``None`` for a missing one."""
    items: list[_V | None] = [None]
    for part in parts:
        if part.symbol == "COMMA":
            items.append(None)
        else:
            items[-1] = part.value
    return tuple(items)


def at(place: int) -> Field:
    """Return a field that is the value of the part with this index."""
    return lambda parts: parts[place].value


def one(symbol: str) -> Field:
    """Return a field that is the value of the first part of this kind, or ``None``."""
    return lambda parts: value_of(parts, symbol)


def each(symbol: str) -> Field:
    """Return a field that has the values of all parts of this kind."""
    return lambda parts: values_of(parts, symbol)


def flag(symbol: str) -> Field:
    """Return a field that says whether there is a part of this kind."""
    return lambda parts: has(parts, symbol)
