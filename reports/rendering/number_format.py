"""Formatting of figures for people."""

from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True, slots=True)
class Figure:
    """One headline figure: what it is, its value, a line below, and a share in 0…1 for a bar."""

    label: str
    value: str
    note: str = ""
    share: float | None = None


def percent(part: float, whole: float) -> str:
    """A share as text, never rounded up to 100 % nor down to 0 %."""
    if whole <= 0:
        return "–"
    tenths = int(1000 * part / whole)
    if tenths == 0 and part > 0:
        return "<0.1 %"
    return "100 %" if tenths >= 1000 else f"{tenths / 10:.1f} %"


def share(part: float, whole: float) -> float:
    """A share in 0…1, 0 where there is no whole."""
    return min(1.0, max(0.0, part / whole)) if whole > 0 else 0.0


def size(octets: float) -> str:
    """A number of bytes in decimal units."""
    if octets < 1000:
        return f"{octets:.0f} bytes"
    scale, unit = next(
        ((scale, unit) for scale, unit in ((1e3, "kB"), (1e6, "MB")) if octets < 1000 * scale),
        (1e9, "GB"),
    )
    value = octets / scale
    return f"{value:,.{0 if value >= 100 else 1 if value >= 10 else 2}f} {unit}"


def counted(total: int, noun: str) -> str:
    """``3 files``, ``1 file``."""
    return f"{total:,} {noun}" if total == 1 else f"{total:,} {noun}s"


def clip(line: str, width: int) -> str:
    """``line`` cut to ``width`` characters, the cut marked with an ellipsis."""
    return line if len(line) <= width else line[: width - 1] + "…"


def moment(generated: str) -> str:
    """An ISO date and time to the minute, as people read it; anything else unchanged."""
    try:
        found = datetime.fromisoformat(generated)
    except ValueError:
        return generated
    if len(generated) <= len("2031-05-06"):
        return generated
    return f"{found:%Y-%m-%d %H:%M} {found.tzname() or ''}".rstrip()
