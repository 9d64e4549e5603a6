"""The predefined functions on texts: STRLEN to STRTOE6AXIS [FCT-04 to FCT-06].

Each function receives its arguments as `interp.values.builtins.call` prepares them, and returns its
result and the new values of arguments passed :OUT, by position. A function that fails says so by
its result and changes nothing. This, and all that is marked *unconfirmed*, is our decision and
stated by no rule. Ignoring case affects A to Z only, whatever the code page.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from string import ascii_lowercase, ascii_uppercase
from typing import Any

from grammar.semantics.types import INT, INT_MAX, INT_MIN, Type
from interp.values.faults import Fault, fault
from interp.values.predefined_values import empty_structure
from interp.values.values import (
    ArrayValue,
    EnumValue,
    StructureValue,
    Value,
    single,
    text_of,
)

#: The result (``None`` for a procedure), and the new values of the arguments that the function
#: sets, by their positions counted from 0.
Outcome = tuple[Value | None, Mapping[int, Value]]

_UPPER = str.maketrans(ascii_lowercase, ascii_uppercase)


def _array(value: Value | None) -> ArrayValue:
    if not isinstance(value, ArrayValue):
        raise fault("argument")
    return value


def _cased(text: str, mode: EnumValue) -> str:
    return text if mode.name == "CASE_SENS" else text.translate(_UPPER)


# ------------------------------------------------------------------------------- STR…


def _strlen(text: Value) -> Outcome:
    return len(text_of(text)), {}


def _strdecllen(text: Value | None) -> Outcome:
    return len(_array(text)), {}


def _strclear(text: Value | None) -> Outcome:
    _array(text)
    return True, {0: ""}


def _stradd(target: Value | None, text: Value) -> Outcome:
    """Return the length of both texts; 0 without a change if they do not fit (unconfirmed)."""
    joined = text_of(_array(target)) + text_of(text)
    if len(joined) > len(_array(target)):
        return 0, {}
    return len(joined), {0: joined}


def _strfind(start: int, text: Value, wanted: Value, mode: EnumValue) -> Outcome:
    """Return the first place at or after ``start``, counted from 1, or 0 if there is none.

    Return 0 also if ``start`` is below 1 or the wanted text is empty (unconfirmed).
    """
    what = _cased(text_of(wanted), mode)
    if start < 1 or not what:
        return 0, {}
    return _cased(text_of(text), mode).find(what, start - 1) + 1, {}


def _strcomp(one: Value, other: Value, mode: EnumValue) -> Outcome:
    return _cased(text_of(one), mode) == _cased(text_of(other), mode), {}


def _strcopy(target: Value | None, text: Value) -> Outcome:
    """Return FALSE, without a change, if the text does not fit (unconfirmed)."""
    found = text_of(text)
    if len(found) > len(_array(target)):
        return False, {}
    return True, {0: found}


# ------------------------------------------------------------------------------- STRTO…

#: The syntax of an INT and of a REAL.
INTEGER = re.compile(r"[+-]?[0-9]+")
DECIMAL = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


def integer_of(text: str) -> int | None:
    """Return a decimal INT, or ``None`` if the text is not one or the number is too large."""
    if not INTEGER.fullmatch(text):
        return None
    number = float(text)  # exact for every INT, and of any number of digits
    return int(number) if INT_MIN <= number <= INT_MAX else None


def real_of(text: str) -> float | None:
    """Return a decimal REAL, or ``None`` if the text is not one or the number is too large."""
    if not DECIMAL.fullmatch(text):
        return None
    try:
        return single(float(text))
    except Fault:
        return None


def _bool_of(text: str) -> bool | None:
    return {"TRUE": True, "FALSE": False}.get(text.translate(_UPPER))


def _structure_of(name: str, text: str) -> StructureValue | None:
    """Return a structure from ``{X 1.0,Y 2.0}``, with or without braces, type and names [FCT-06].

    Without names the text must have all components in order (unconfirmed). With names, components
    that are left out get no value, as in an aggregate of a program [TYP-19]. Return ``None`` if the
    text is malformed.
    """
    inner = re.fullmatch(rf"\{{(?:\s*{name}\s*:)?(.*)\}}", text, re.IGNORECASE | re.DOTALL)
    parts = [part.split() for part in (inner[1] if inner else text).split(",")]
    value = empty_structure(name)
    names = [member.name for member in value.type.members]
    if len(parts) == len(names) and all(len(part) == 1 for part in parts):
        parts = [[name, *part] for name, part in zip(names, parts, strict=True)]
    for part in parts:
        place = names.index(part[0].upper()) if part and part[0].upper() in names else None
        if len(part) != 2 or place is None or value.members[place] is not None:
            return None
        number = _number_of(value.type.members[place].type, part[1])
        if number is None:
            return None
        value.members[place] = number
    return value


def _number_of(type_: Type, text: str) -> int | float | None:
    return integer_of(text) if type_ == INT else real_of(text)


def _reader(read: Callable[[str], Value | None]) -> Callable[..., Outcome]:
    """Return a KRL function that reads a value from a text; its result is FALSE on failure."""

    def function(text: Value, _target: Value | None) -> Outcome:
        value = read(text_of(text).strip(" "))
        return (False, {}) if value is None else (True, {1: value})

    return function


def _structure_reader(name: str) -> Callable[..., Outcome]:
    return _reader(lambda text: _structure_of(name, text))


def _strtostring(text: Value, target: Value | None) -> Outcome:
    copied, changes = _strcopy(target, text)
    return copied, {place + 1: value for place, value in changes.items()}


#: The functions by name; ``grammar/system/functions.tsv`` describes them.
TEXTS: Mapping[str, Callable[..., Any]] = {
    "STRLEN": _strlen,
    "STRDECLLEN": _strdecllen,
    "STRCLEAR": _strclear,
    "STRADD": _stradd,
    "STRFIND": _strfind,
    "STRCOMP": _strcomp,
    "STRCOPY": _strcopy,
    "STRTOBOOL": _reader(_bool_of),
    "STRTOINT": _reader(integer_of),
    "STRTOREAL": _reader(real_of),
    "STRTOSTRING": _strtostring,
    **{
        f"STRTO{name}": _structure_reader(name)
        for name in ("FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS")
    },
}
