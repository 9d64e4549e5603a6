"""Typed reading of a record that came from JSON.

Fields may be absent, and a count may be given as the list of the counted items. Reading is lenient
on purpose: the record of an older or newer release still gives a page.
"""

from collections.abc import Mapping
from typing import Any

Record = Mapping[str, Any]
_MOST = 1 << 63
_LARGEST = 1e300


def count(record: Record, key: str) -> int:
    """Return the number at ``key``, or the length of a list there; else 0.

    Also 0 for numbers too large to be a count.
    """
    value = record.get(key)
    if isinstance(value, int | float):
        return int(value) if -_MOST < value < _MOST else 0
    return len(value) if isinstance(value, list | tuple) else 0


def optional_count(record: Record, key: str) -> int | None:
    """Return `count`, but ``None`` for an absent field, so that it is not shown as 0."""
    return None if record.get(key) is None else count(record, key)


def number(record: Record, key: str) -> float:
    """Return the finite number at ``key``, else 0.0."""
    value = record.get(key)
    return float(value) if isinstance(value, int | float) and -_LARGEST < value < _LARGEST else 0.0


def text(record: Record, key: str) -> str:
    """Return the text at ``key``; numbers are converted; empty for other values."""
    value = record.get(key)
    if isinstance(value, str):
        return value
    return "" if value is None or isinstance(value, list | tuple | Mapping) else str(value)


def texts(record: Record, key: str) -> list[str]:
    """Return the texts listed at ``key``; anything else in the list is left out."""
    return _listed(record, key, str)


def records(record: Record, key: str) -> list[Record]:
    """Return the records listed at ``key``; anything else in the list is left out."""
    return _listed(record, key, Mapping)


def _listed(record: Record, key: str, kind: type[Any]) -> list[Any]:
    value = record.get(key)
    return (
        [item for item in value if isinstance(item, kind)]
        if isinstance(value, list | tuple)
        else []
    )


def nested(record: Record, key: str) -> Record:
    """Return the record at ``key``; empty if there is none."""
    value = record.get(key)
    return value if isinstance(value, Mapping) else {}
