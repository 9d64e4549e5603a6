"""Serialisation of our own classes that is safe for untrusted bytes.

Pickle can build any object. This reader only builds plain values, and dataclasses and enumerations
of the named packages. Forged bytes can contain wrong values of these classes, but nothing else.
"""

from __future__ import annotations

import io
import pickle
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, lru_cache
from importlib import import_module
from typing import Any


def dumps(value: object) -> bytes:
    """Return the value as bytes."""
    stream = io.BytesIO()
    _Writer(stream, protocol=5).dump(value)
    return stream.getvalue()


def loads(data: bytes, packages: Sequence[str]) -> Any:
    """Return the value, built from plain values and classes of these packages.

    Raises `ValueError` for any other content and for damaged data.
    """
    try:
        return _Reader(data, packages).load()
    except Exception as error:  # damage may raise anything
        raise ValueError(f"not readable: {type(error).__name__}: {error}") from error


class _Writer(pickle.Pickler):
    """Writes a dataclass as a call with the values of its fields.

    The default way looks the fields up again for every value that is read, which is most of the
    reading time.
    """

    def reducer_override(self, value: Any) -> Any:
        """Return how to rebuild a value; `NotImplemented` leaves it to pickle."""
        kind: Callable[..., Any] = type(value)
        if isinstance(value, Enum):  # some Pythons pickle it by getattr, which must not be loaded
            return kind, (value.value,)
        names = _fields(kind)
        if names is None:
            return NotImplemented
        return type(value), tuple([getattr(value, name) for name in names])


@cache
def _fields(kind: Callable[..., Any]) -> tuple[str, ...] | None:
    """Return the field names of a dataclass if its constructor takes all of them in order."""
    if not is_dataclass(kind) or any(not one.init or one.kw_only for one in fields(kind)):
        return None
    return tuple(one.name for one in fields(kind))


class _Reader(pickle.Unpickler):
    """Finds only the classes that are allowed."""

    def __init__(self, data: bytes, packages: Sequence[str]) -> None:
        super().__init__(io.BytesIO(data))
        self._packages = frozenset(packages)

    def find_class(self, module: str, name: str) -> Any:
        """Return a dataclass or an enumeration of an allowed package; raises `UnpicklingError`."""
        found = _class(module, name) if module.partition(".")[0] in self._packages else None
        if found is None:
            raise pickle.UnpicklingError(f"{module}.{name} must not be loaded")
        return found


@lru_cache(maxsize=1024)
def _class(module: str, name: str) -> type | None:
    found = getattr(import_module(module), name, None)
    is_class = isinstance(found, type) and (is_dataclass(found) or issubclass(found, Enum))
    return found if is_class else None
