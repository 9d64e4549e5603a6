"""SWRITE and SREAD: conversions between values and texts [FCT-10]."""

from __future__ import annotations

from typing import Final

from grammar.generation.expressions import array, constant_or_place, expression, read, target, text
from grammar.generation.routine_writer import RoutineWriter
from grammar.generation.types import COLOUR, STATE, TEXT
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

_FORMATS: Final[tuple[tuple[Type, tuple[str, ...]], ...]] = (
    (INT, ("%d", "%5d", "%x", "%-4d|", "%+d", "%03d", "%c", "%u", "%#x", "%.3i")),
    (REAL, ("%f", "%8.3f", "%.2f", "%e", "%g", "%+.1f", "%d")),
    (BOOL, ("%s", "%d")),
    (CHAR, ("%c", "%d", "%s")),
    (COLOUR, ("%s", "%d")),
    (TEXT, ("%s", "%10s", "%.2s", "%-6s|")),
)
_SCANNED: Final[tuple[tuple[str, str, tuple[Type, ...]], ...]] = (
    ('"12 3.5"', '"%d %f"', (INT, REAL)),
    ('"x7"', '"x%d"', (INT,)),
    ('"A1"', '"%c%d"', (CHAR, INT)),
    ('"TRUE"', '"%s"', (BOOL,)),
    ('"1"', '"%d"', (BOOL,)),
    ('"#RED"', '"%s"', (COLOUR,)),
    ('"ff"', '"%x"', (INT,)),
    ('"abc"', '"%d"', (INT,)),
    ('"1.25E1 9"', '"%e %2d"', (REAL, INT)),
    ('"77"', '"%1d%1d"', (INT, INT)),
)


#: Parts of specifications: flags, widths and precisions, the empty ones most often.
_FLAGS: Final = ("", "", "", "-", "+", "0", "#", "-0", "+#", "#0-")
_WIDTHS: Final = ("", "", "", "1", "7", "12", "2047", "2048")
_PRECISIONS: Final = ("", "", "", ".0", ".1", ".9", ".2047", ".")
_LETTERS: Final = "diuxefgcsXq"


def _specification(code: RoutineWriter, width_only: bool = False) -> str:
    """Return a random format specification, rarely an invalid one; it need not fit its value."""
    pick = code.choices.pick
    flags, precision = ("", "") if width_only else (pick(_FLAGS), pick(_PRECISIONS))
    return f"%{flags}{pick(_WIDTHS)}{precision}{pick(_LETTERS)}"


def format_text(code: RoutineWriter) -> bool:
    """Write an SWRITE; sometimes a format does not fit its value."""
    place, state = array(code, TEXT), target(code, STATE)
    offset = target(code, INT)
    if not place or state is None or offset is None:
        return False
    pattern, values = "", ""
    for _ in range(code.choices.between(0, 3)):
        type_, formats = code.choices.pick(_FORMATS)
        pattern += code.choices.pick(("", " ", "x=", "%%"))
        pattern += code.choices.pick(formats) if code.choices.chance(60) else _specification(code)
        if type_ == COLOUR:  # the enumeration of a constant would be unknown
            values += f", {read(code, COLOUR) or 'TRUE'}"
        else:
            values += f", {text(code) if type_ == TEXT else expression(code, type_, 1)}"
    code.spend(2)
    code.set(offset, code.choices.pick(("0", "0", "1", "3", "99")))
    return code.line(f'SWRITE({place}, {state}, {offset}, "{pattern}"{values})')


def scan_text(code: RoutineWriter) -> bool:
    """Write an SREAD."""
    state, offset = target(code, STATE), target(code, INT)
    if state is None or offset is None:
        return False
    choices = code.choices
    given, pattern, types = choices.pick(_SCANNED)
    if choices.chance(30):
        pattern = f'"{"".join(_specification(code, width_only=True) for _ in types)}"'
    source = given if choices.chance(70) else text(code)
    places = [constant_or_place(code, type_) for type_ in types]
    code.spend(2)
    code.set(offset, choices.pick(("0", "0", "1")))
    return code.line(f"SREAD({source}, {state}, {offset}, {', '.join((pattern, *places))})")
