"""SWRITE and SREAD: formatted output to a text and formatted input from a text [FCT-09].

A format is text with specifications ``%[flags][width][.precision]letter``, as in C's printf:

=====  ==================================================================================
``+``  write a sign before positive numbers too
``-``  align to the left
``0``  fill with zeros instead of blanks
``#``  ``0x`` before hexadecimal numbers except zero; always a point in e, f, g
=====  ==================================================================================

The width is the least number of characters. It counts the point but not the sign. Here KUKA's
format differs from C's: 1.56 in ``%+8.4f`` is two blanks, then ``+1.5600``.

=============  ===============================================================================
``d i``        INT; a REAL as by ``f``; BOOL as 1 or 0
``u x``        INT as an unsigned 32-bit number, decimal or hexadecimal
``e f g``      REAL, INT
``c``          CHAR, or INT as its character code
``s``          text; the precision is the largest number of characters. BOOL as TRUE or FALSE,
               an enumeration constant as ``#NAME``
``%``          a percent sign
=============  ===============================================================================

The flags, the width, the offset and the limit of ten variables are from a transcription of the
manual on CREAD and CWRITE. All letters but ``d``, BOOL, enumerations, STATE and all of SREAD are
from memory (unconfirmed). Both functions stop at a value that cannot be converted: STATE then holds
#FMT_ERR and the number of conversions before it, and what was written or read until then stays.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from grammar.semantics.types import INT, INT_MAX
from interp.values.faults import fault
from interp.values.predefined_values import empty_structure, word
from interp.values.texts import DECIMAL, INTEGER, Outcome, integer_of, real_of
from interp.values.values import (
    ArrayValue,
    EnumValue,
    StructureValue,
    Value,
    converted,
    copied,
    known,
    text_of,
)

#: The longest text [FCT-04], so also the largest width and precision.
LONGEST = 2047
#: The largest number of variables in one call.
_MOST = 10

_PIECE = re.compile(r"([^%]+)|%%|%([-+#0]*)([0-9]{0,4})(?:\.([0-9]{1,4}))?([a-zA-Z])|%")


class _Mismatch(Exception):
    """A value or a text does not match its format specification."""


#: Flags, width, precision, letter.
_Specification = tuple[str, int | None, int | None, str]


def _pieces(pattern: str) -> Iterator[str | _Specification]:
    """Yield literal texts and specifications in order; raise `_Mismatch` at an invalid one."""
    for found in _PIECE.finditer(pattern):
        literal, flags, width, precision, letter = found.groups()
        if letter:
            yield flags, _count(width), _count(precision), letter
        elif literal or found[0] == "%%":
            yield literal or "%"
        else:
            raise _Mismatch


def _conversions(pattern: str, count: int) -> Iterator[tuple[str | _Specification, int]]:
    """Yield each piece of a format with the number of the variable that it converts.

    Raise `_Mismatch` where one of ``count`` variables, or a specification, has no counterpart.
    """
    number = 0
    for piece in _pieces(pattern):
        is_specification = not isinstance(piece, str)
        if is_specification and number in (count, _MOST):
            raise _Mismatch
        yield piece, number
        number += is_specification
    if number != count:
        raise _Mismatch


def _count(digits: str | None) -> int | None:
    return int(digits) if digits else None


# ------------------------------------------------------------------------------- STATE


def state_value(result: str, hits: int = 0, length: int = 0) -> StructureValue:
    """Return a STATE_T with the result and the numbers of conversions and characters [FCT-08]."""
    value = empty_structure("STATE_T")
    value.set("RET1", word("CMD_STAT", result))
    value.set("MSG_NO", 0)
    value.set("HITS", hits)
    value.set("LENGTH", length)
    return value


# ------------------------------------------------------------------------------- SWRITE


def swrite(
    target: Value | None, _state_before: Value | None, offset: Value, pattern: Value, *values: Value
) -> Outcome:
    """Write values to a text, after its first ``offset`` characters.

    The offset is then increased by what was written. The rest of the text stays: a program that
    does not want it clears the text first (unconfirmed). An offset outside the text results in
    #CMD_ABORT (unconfirmed).
    """
    if not isinstance(target, ArrayValue):
        raise fault("argument")
    start = converted(known(offset), INT)
    assert isinstance(start, int)
    if not 0 <= start <= len(target):
        return None, {1: state_value("CMD_ABORT")}
    text: ArrayValue = copied(target)
    end, hits, result = start, 0, "CMD_OK"
    try:
        for piece, number in _conversions(text_of(pattern), len(values)):
            written = piece if isinstance(piece, str) else _written(piece, known(values[number]))
            if end + len(written) > len(text):
                raise _Mismatch
            text.elements[end : end + len(written)] = written
            end += len(written)
            hits += not isinstance(piece, str)
    except _Mismatch:
        result = "FMT_ERR"
    return None, {0: text, 1: state_value(result, hits, end - start), 2: end}


def _written(specification: _Specification, value: Value) -> str:
    flags, least, precision, letter = specification
    width = least or 0
    if letter in "cs":
        body = _characters(letter, precision, value)
        return body.ljust(width) if "-" in flags else body.rjust(width)
    sign, prefix, digits = _digits(specification, value)
    if "-" in flags:
        return sign + (prefix + digits).ljust(width)
    if "0" in flags:
        return sign + prefix + digits.rjust(width - len(prefix), "0")
    return " " * (width - len(prefix + digits)) + sign + prefix + digits


def _characters(letter: str, precision: int | None, value: Value) -> str:
    match letter, value:
        case ("c", str()) if len(value) == 1:
            return value
        case ("c", int()) if not isinstance(value, bool) and 0 <= value <= 255:
            return chr(value)
        case ("s", bool()):
            text = "TRUE" if value else "FALSE"
        case ("s", EnumValue()):
            text = f"#{value.name.upper()}"
        case ("s", str() | ArrayValue()):
            text = text_of(value)
        case _:
            raise _Mismatch
    return text[:precision]


def _digits(specification: _Specification, value: Value) -> tuple[str, str, str]:
    """Return sign, prefix and digits of a number."""
    flags, _, precision, letter = specification
    if not isinstance(value, int | float):
        raise _Mismatch
    sign = "-" if value < 0 else "+" if "+" in flags else ""
    if letter in "efg" or (letter in "di" and isinstance(value, float)):
        kind = letter if letter in "efg" else "f"
        form = f"{'#' if '#' in flags else ''}.{6 if precision is None else precision}{kind}"
        return sign, "", format(abs(float(value)), form)
    if letter not in "diux" or isinstance(value, float):
        raise _Mismatch
    number = int(value)
    if letter in "di":
        return sign, "", str(abs(number)).zfill(precision or 0)
    prefix = "0x" if letter == "x" and "#" in flags and number != 0 else ""
    return (
        "",
        prefix,
        format(number & 0xFFFFFFFF, "d" if letter == "u" else "x").zfill(precision or 0),
    )


# ------------------------------------------------------------------------------- SREAD

#: What is read, by the letter of its specification.
_FORMS: Mapping[str, re.Pattern[str]] = {
    **dict.fromkeys("di", INTEGER),
    "u": re.compile("[0-9]+"),
    "x": re.compile("(?:0[xX])?[0-9a-fA-F]+"),
    **dict.fromkeys("efg", DECIMAL),
    "s": re.compile("[^ ]+"),
}
_BLANKS = re.compile(" *")


def sread(
    text: Value,
    _state_before: Value | None,
    offset: Value,
    pattern: Value,
    *variables: Value | None,
) -> Outcome:
    """Read values from a text, after its first ``offset`` characters, as C's scanf does.

    A blank in the format matches any number of blanks, any other character matches itself. Blanks
    before a value are skipped, except for ``c``. The width is the largest number of characters. The
    offset is increased by what was read. An offset outside the text results in #CMD_ABORT.
    """
    given = text_of(text)
    start = converted(known(offset), INT)
    assert isinstance(start, int)
    if not 0 <= start <= len(given):
        return None, {1: state_value("CMD_ABORT")}
    changes: dict[int, Value] = {}
    end, result = start, "CMD_OK"
    try:
        for piece, number in _conversions(text_of(pattern), len(variables)):
            if isinstance(piece, str):
                end = _match(re.compile(_literal(piece)), given, end).end()
            else:
                changes[4 + number], end = _read(given, end, piece)
    except _Mismatch:
        result = "FMT_ERR"
    hits = len(changes)
    return None, {1: state_value(result, hits, end - start), 2: end, **changes}


def _literal(piece: str) -> str:
    """Return the pattern of the text that a format expects; of blanks there may be any number."""
    return " *".join(map(re.escape, re.split(" +", piece)))


def _match(
    form: re.Pattern[str] | None, text: str, place: int, width: int | None = None
) -> re.Match[str]:
    """Return what matches at a place; raise `_Mismatch` if nothing does."""
    match = form and form.match(text, place, place + (width or len(text)))
    if not match:
        raise _Mismatch
    return match


def _read(text: str, place: int, specification: _Specification) -> tuple[Value, int]:
    """Return a value and the place after it."""
    flags, width, precision, letter = specification
    if flags or precision is not None:
        raise _Mismatch
    if letter == "c":
        found = _match(re.compile(f"(?s:.{{{width or 1}}})"), text, place)
    else:
        place = _match(_BLANKS, text, place).end()
        found = _match(_FORMS.get(letter), text, place, width)
    value = _value(letter, found[0])
    if value is None:
        raise _Mismatch
    return value, found.end()


def _value(letter: str, found: str) -> Value | None:
    """Return what a text denotes, or ``None`` if the number is too large."""
    if letter in "cs":
        return found
    if letter in "efg":
        return real_of(found)
    if letter in "di":
        return integer_of(found)
    number = int(found, 16) if letter == "x" else float(found)  # of thousands of digits, too
    if number > 0xFFFFFFFF:
        return None
    return int(number) - (1 << 32) if number > INT_MAX else int(number)
