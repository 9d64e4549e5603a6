"""Traces for comparison: requests and events in one sequence, as plain values.

A fact is a tuple of a word, the place, and further values. Values of different types are never
equal, nor are 0.0 and -0.0. Code handles are replaced by a word, because executors number them
differently.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from interp.port.events import EVERY_KIND
from interp.port.requests import At, CodeHandle, Path, Request, Value
from interp.values.values import ArrayValue, EnumValue, StructureValue

Fact = tuple[Any, ...]


class Trace:
    """A sink that stores facts."""

    __slots__ = ("facts",)

    kinds = EVERY_KIND

    def __init__(self) -> None:
        self.facts: list[Fact] = []

    # ----------------------------------------------------------------------- events

    def line(self, at: At) -> None:
        """A statement begins."""
        self.facts.append(("line", at))

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable was assigned."""
        self.facts.append(("assign", at, path, plain(value)))

    def call(self, at: At, name: str) -> None:
        """A routine is called."""
        self.facts.append(("call", at, name))

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""
        self.facts.append(("return", at, name))

    def branch(self, at: At, way: int) -> None:
        """A statement chose a branch."""
        self.facts.append(("branch", at, way))

    # ----------------------------------------------------------------------- requests, and more

    def request(self, request: Request) -> None:
        """The executor has made a request."""
        self.facts.append(fact_of(request))

    def evaluated(self, outcome: object) -> None:
        """A condition was evaluated; ``outcome`` is its value or the exception."""
        self.facts.append(("evaluated", None, _plain(outcome)))

    def entered(self) -> None:
        """An action was entered."""
        self.facts.append(("entered", None))

    def unwound(self, depth: int) -> None:
        """RESUME has left routines."""
        self.facts.append(("unwound", None, depth))

    def raised(self, error: Exception) -> None:
        """The executor could not be created, or has raised an unexpected exception."""
        self.facts.append(("raised", None, *_plain(error)))


def fact_of(step: Any) -> Fact:
    """Return a request, a part of one, or an event, as its name and its fields."""
    return (type(step).__name__, *(_plain(getattr(step, name)) for name in _fields(type(step))))


def _plain(value: Any) -> Any:
    match value:
        case At() | None | str():
            return value
        case CodeHandle():
            return "CODE"
        case Exception():
            return (type(value).__name__, str(value))
        case tuple():
            return tuple(_plain(one) for one in value)
        case _ if type(value).__module__ == "interp.port.requests":
            return fact_of(value)
    return plain(value)


_FIELDS: dict[Any, tuple[str, ...]] = {}


def _fields(kind: Any) -> tuple[str, ...]:
    """Return the names of the fields of a class, from a cache."""
    if kind not in _FIELDS:
        _FIELDS[kind] = tuple(field.name for field in dataclasses.fields(kind))
    return _FIELDS[kind]


def plain(value: Value | None) -> Any:
    """Return a value as constants and nested tuples of them."""
    match value:
        case bool() | float():
            return (type(value).__name__, repr(value))
        case EnumValue():
            return (value.type.name.upper(), value.index)
        case StructureValue():
            return (value.type.name.upper(), tuple(plain(one) for one in value.members))
        case ArrayValue():
            return ("ARRAY", value.sizes, tuple(plain(one) for one in value))
    return value


def place_of(fact: Fact) -> At | None:
    """Return the place that reported a fact, ``None`` if it has none."""
    return fact[1] if len(fact) > 1 and isinstance(fact[1], At) else None


def shown(fact: Fact | None) -> str:
    """Return a fact as a line of text."""
    if fact is None:
        return "nothing more"
    at = place_of(fact)
    where = "" if at is None else f"{at.file}:{at.line} (depth {at.depth}) "
    rest = " ".join(_text(one) for one in fact[2:])
    return f"{where}{fact[0]} {rest}".rstrip()


def _text(value: Any) -> str:
    match value:
        case (("float" | "bool"), str() as text):
            return text
        case tuple():
            return f"({' '.join(_text(one) for one in value)})"
        case At():
            return f"{value.file}:{value.line}"
    return "-" if value is None else repr(value) if isinstance(value, str) else str(value)
