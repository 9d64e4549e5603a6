"""Conversion of values to JSON and back, in the one form that traces, watches and reports use.

==============  ===============================================================================
no value        ``null``
INT, BOOL       ``8``, ``true``
REAL            ``8.0``, ``0.1``, ``1e+20``: see `real_text`; never without a point or exponent
CHAR            ``"A"``; the character's code point is the byte
enumeration     ``"#NAME"``, in upper case
structure       ``{"X":1.0,"Y":null}``: all members, in upper case, in the order of the type
CHAR array      ``"abc"``, the used part, when nothing behind it has a value
other arrays    ``[1,2,null]``; of more dimensions, ``[[1,2],[3,4]]``
==============  ===============================================================================

Equal values have equal texts. There is one deliberate exception: -0.0 is written as 0.0.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type
from interp.values.values import (
    ArrayValue,
    EnumValue,
    StructureValue,
    Value,
    constant,
    converted,
    empty,
    member_place,
    set_text,
    single,
    text_of,
)

#: Anything that `json.dumps` accepts.
Json = Any

#: The smallest normal single; a subnormal REAL has fewer digits.
_NORMAL = 1.1754943508222875e-38


def real_text(number: float) -> str:
    """Return a REAL with the fewest significant digits that read back as the same single.

    The number is rounded to these digits as C's ``%g`` does, then written as Python writes a float.
    """
    return repr(_shortest(number))


def _shortest(number: float) -> float:
    # All numbers of up to six digits differ as singles, so fewer digits than six need not be tried,
    # except below the normal range.
    fewest = 6 if abs(number) >= _NORMAL else 1
    for digits in range(fewest, 9):
        found = float(f"{number:.{digits}g}")
        if abs(found) <= _LARGEST and single(found) == number:
            return found + 0.0  # makes 0.0 of -0.0
    return float(f"{number:.9g}")


#: Above this, rounding to single overflows: halfway between the largest REAL and the next single.
_LARGEST = 3.4028235677973362e38


def to_json(value: Value | None) -> Json:
    """Return the value in the form that `json.dumps` accepts."""
    match value:
        case float():
            return _shortest(value)
        case EnumValue():
            return f"#{value.name.upper()}"
        case StructureValue():
            pairs = zip(value.type.members, value.members, strict=True)
            return {member.name.upper(): to_json(part) for member, part in pairs}
        case ArrayValue() if len(value.sizes) > 1:
            return [to_json(value.part(row)) for row in range(1, value.sizes[0] + 1)]
        case ArrayValue():
            elements = list(value)
            if value.type.element == CHAR:
                text = text_of(value)
                if all(element is None for element in elements[len(text) :]):
                    return text
            return [to_json(element) for element in elements]
    return value


def from_json(type_: Type, data: Any) -> Value | None:
    """Return the value of a type from its JSON form.

    A REAL may be written without a point. A missing member gets no value. Raises `ValueError`, and
    a fault if a number is outside the range of its type.
    """
    match type_:
        case Structure() if isinstance(data, dict):
            structure = empty(type_)
            assert isinstance(structure, StructureValue)
            for name, part in data.items():
                place = member_place(type_, name)
                structure.members[place] = _part(type_.members[place].type, part)
            return structure
        case Array():
            array = empty(type_)
            assert isinstance(array, ArrayValue)
            _read_array(array, data)
            return array
        case Enumeration() if isinstance(data, str) and data.startswith("#"):
            return constant(type_, data[1:])
    if data is None:
        return None
    if type_ == REAL and type(data) in (int, float):
        return single(data)
    if isinstance(data, int | str) and type(data) is _PYTHON.get(type_):
        return converted(data, type_)
    raise ValueError(f"not {type_}: {json.dumps(data)}")


_PYTHON: Mapping[Type, type] = {INT: int, BOOL: bool, CHAR: str}


def _part(type_: Type, data: Json) -> Value | None:
    return empty(type_) if data is None else from_json(type_, data)


def _read_array(array: ArrayValue, data: Json) -> None:
    if isinstance(data, str) and array.type.element == CHAR and len(array.sizes) == 1:
        set_text(array, data)
        return
    if not isinstance(data, list) or len(data) != array.sizes[0]:
        raise ValueError(f"not {array.type}: {json.dumps(data)}")
    for place, part in enumerate(data, start=1):
        if len(array.sizes) > 1:
            _read_array(array.part(place), part)
        else:
            array.set(_part(array.type.element, part), place)
