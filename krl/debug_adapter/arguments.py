"""Arguments of requests, which clients may omit or get wrong."""

from collections.abc import Mapping
from enum import Enum
from pathlib import Path
from typing import Any


class Refused(Exception):
    """A request that cannot be fulfilled; the message is shown to the user."""


class Arguments:
    """The arguments of a request; any of them may be missing or have a wrong type."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = values

    def get(self, name: str, kind: type[Any], default: Any) -> Any:
        """Return an argument, or the default if it is missing or has another type."""
        value = self.values.get(name)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            return float(value)
        is_fitting = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
        return value if is_fitting else default

    def text(self, name: str) -> str | None:
        """Return a text argument, or ``None`` if it is missing or empty."""
        found: str = self.get(name, str, "")
        return found or None

    def path(self, name: str) -> Path | None:
        """Return a path argument, or ``None``."""
        text = self.text(name)
        return None if text is None else Path(text)

    def of(self, kind: type[Any], name: str) -> Any:
        """Return an argument of a type, which may be a path or an enumeration.

        Returns ``None`` if it is missing, empty or of another type. Raises `Refused` for a word
        that the enumeration does not have.
        """
        if issubclass(kind, Path):
            return self.path(name)
        if issubclass(kind, Enum) and (text := self.text(name)):
            try:
                return kind(text)
            except ValueError:
                words = ", ".join(str(one.value) for one in kind)
                raise Refused(f"{name}: {text} is none of {words}") from None
        return self.text(name) if kind is str else self.get(name, kind, None)

    def inner(self, name: str) -> "Arguments":
        """Return an argument that is an object."""
        return Arguments(self.get(name, dict, {}))

    def all(self, name: str) -> "list[Arguments]":
        """Return an argument that is a list of objects."""
        return [Arguments(one) for one in self.get(name, list, []) if isinstance(one, dict)]
