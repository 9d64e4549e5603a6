"""Values of our own classes as bytes, read back without trusting who wrote the bytes.

Pickle builds whatever it is told to; here it builds data classes and enumerations of the packages
that are named, and plain values. Whoever can write the bytes can make up such values, and nothing
else.
"""

from __future__ import annotations

import io
import pickle
from collections.abc import Sequence
from dataclasses import is_dataclass
from enum import Enum
from importlib import import_module
from typing import Any

__all__ = ["dumps", "loads"]


def dumps(value: object) -> bytes:
    """The value as bytes."""
    return pickle.dumps(value, protocol=5)


def loads(data: bytes, packages: Sequence[str]) -> Any:
    """The value, made of classes of these packages.

    Raises `ValueError` for anything else, and for what is damaged.
    """
    try:
        return _Reader(data, packages).load()
    except Exception as error:  # damage may raise anything
        raise ValueError(f"not readable: {type(error).__name__}: {error}") from error


class _Reader(pickle.Unpickler):
    """Finds no classes but those that are allowed."""

    def __init__(self, data: bytes, packages: Sequence[str]) -> None:
        super().__init__(io.BytesIO(data))
        self._packages = frozenset(packages)

    def find_class(self, module: str, name: str) -> Any:
        """A data class or an enumeration of an allowed package."""
        if module.partition(".")[0] in self._packages:
            found = getattr(import_module(module), name, None)
            if isinstance(found, type) and (is_dataclass(found) or issubclass(found, Enum)):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} is not to be read")
