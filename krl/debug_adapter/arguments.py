"""The arguments of requests, which clients may leave out or get wrong."""

from collections.abc import Callable, Mapping
from enum import Enum
from pathlib import Path
from typing import Any, TypeVar

_E = TypeVar("_E", bound=Enum)


class Refused(Exception):
    """A request that cannot be fulfilled; its text is what the person reads."""


class Arguments:
    """The arguments of a request, of which each may be missing or of another type."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = values

    def get(self, name: str, kind: type[Any], default: Any) -> Any:
        """An argument of a type."""
        value = self.values.get(name)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            return float(value)
        is_fitting = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
        return value if is_fitting else default

    def text(self, name: str) -> str | None:
        """A text that is not empty."""
        found: str = self.get(name, str, "")
        return found or None

    def path(self, name: str) -> Path | None:
        """A path."""
        text = self.text(name)
        return None if text is None else Path(text)

    def of(self, kind: type[Any], name: str) -> Any:
        """An argument of a type, also a path or an enumeration.

        ``None`` where it is missing, empty or of another type; raises `Refused` for a word that the
        enumeration does not have.
        """
        if issubclass(kind, Path):
            return self.path(name)
        if issubclass(kind, Enum):
            return self.choice(name, kind)
        return self.text(name) if kind is str else self.get(name, kind, None)

    def choice(self, name: str, kind: type[_E]) -> _E | None:
        """One of some words; raises `Refused` for another one."""
        text = self.text(name)
        if text is None:
            return None
        try:
            return kind(text)
        except ValueError:
            words = ", ".join(str(one.value) for one in kind)
            raise Refused(f"{name}: {text} is none of {words}") from None

    def inner(self, name: str) -> "Arguments":
        """An object."""
        return Arguments(self.get(name, dict, {}))

    def all(self, name: str) -> "list[Arguments]":
        """A list of objects."""
        return [Arguments(one) for one in self.get(name, list, []) if isinstance(one, dict)]


#: What serves a request: from its arguments to the body of the answer. A function that the body has
#: as ``then`` is called once the client has its answer.
Handler = Callable[[Arguments], dict[str, Any]]
