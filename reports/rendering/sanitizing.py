"""Conversion of untrusted values for display on a page: short, printable, finite."""

import math
from collections.abc import Mapping
from typing import Any

from reports.rendering.embedding import printable
from reports.rendering.number_format import clip, moment
from reports.rendering.record_fields import Record, text

_MOST_ITEMS = 2_000
_DEEPEST = 8


def shown(foreign: str, width: int = 400) -> str:
    """Return untrusted text as one line: cut to a width, tabs widened, all characters visible."""
    return printable(clip(foreign.replace("\t", "    "), width))


def shown_texts(record: Record, **widths: int) -> dict[str, str]:
    """Return texts of a record by their names, each as `shown` in its width."""
    return {name: shown(text(record, name), width) for name, width in widths.items()}


def made_by(record: Record) -> str:
    """Return the version that made a record and when."""
    version = text(record, "version")
    parts = [version and f"krl {version}", moment(text(record, "generated"))]
    return " · ".join(shown(part, 80) for part in parts if part)


def plain(value: Any, width: int = 400, depth: int = 0) -> Any:
    """Return a value of a record as JSON that can be shown.

    Long lists are cut, and numbers that are not finite become text.
    """
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else str(value)
    if depth > _DEEPEST:
        return "…"
    if isinstance(value, Mapping):
        return {shown(str(name), 80): plain(one, width, depth + 1) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one, width, depth + 1) for one in value[:_MOST_ITEMS]]
    return shown(str(value), width)
