"""Formatting of figures for display."""

from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True, slots=True)
class Figure:
    """A headline figure: label, value, a note below, and a share from 0 to 1 for a bar.

    ``href`` is a link to the section about it.
    """

    label: str
    value: str
    note: str = ""
    share: float | None = None
    href: str = ""


def percent(part: float, whole: float) -> str:
    """Return a share as text, never rounded up to 100 % or down to 0 %."""
    if whole <= 0:
        return "–"
    tenths = int(1000 * part / whole)
    if tenths == 0 and part > 0:
        return "<0.1 %"
    return "100 %" if tenths >= 1000 else f"{tenths / 10:.1f} %"


def share(part: float, whole: float) -> float:
    """Return a share from 0 to 1; 0 if the whole is 0."""
    return min(1.0, max(0.0, part / whole)) if whole > 0 else 0.0


def size(octets: float) -> str:
    """Return a number of bytes in decimal units."""
    if octets < 1000:
        return f"{octets:.0f} bytes"
    scale, unit = next(
        ((scale, unit) for scale, unit in ((1e3, "kB"), (1e6, "MB")) if octets < 1000 * scale),
        (1e9, "GB"),
    )
    value = octets / scale
    return f"{value:,.{0 if value >= 100 else 1 if value >= 10 else 2}f} {unit}"


def counted(total: int, noun: str) -> str:
    """Return a number with its noun: ``3 files``, ``1 file``."""
    return f"{total:,} {noun}" if total == 1 else f"{total:,} {noun}s"


def clip(line: str, width: int) -> str:
    """Return ``line`` cut to ``width`` characters; an ellipsis marks the cut."""
    return line if len(line) <= width else line[: width - 1] + "…"


def moment(generated: str) -> str:
    """Return an ISO date and time in readable form, to the minute; other texts unchanged."""
    try:
        found = datetime.fromisoformat(generated)
    except ValueError:
        return generated
    if len(generated) <= len("2031-05-06"):
        return generated
    return f"{found:%Y-%m-%d %H:%M} {found.tzname() or ''}".rstrip()
