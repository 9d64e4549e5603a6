"""Values as text in the form in which programs write them."""

from __future__ import annotations

from typing import Final

from grammar.semantics.types import CHAR
from interp.values.json_form import real_text
from interp.values.values import ArrayValue, EnumValue, StructureValue, Value, has_value, text_of

_MOST_ELEMENTS: Final = 10


def value_text(value: Value | None) -> str:
    """Return a value in one line: ``{X 1.0, Y 2.0}``, ``#T1``, ``"text"``; long arrays are cut."""
    match value:
        case None:
            return "(no value)"
        case bool():
            return "TRUE" if value else "FALSE"
        case float():
            return real_text(value)
        case EnumValue():
            return f"#{value.name}"
        case str():
            return f'"{value}"'
        case StructureValue():
            parts = zip(value.type.members, value.members, strict=True)
            given = (f"{one.name} {value_text(part)}" for one, part in parts if has_value(part))
            return "{" + ", ".join(given) + "}"
        case ArrayValue() if value.type.element == CHAR and len(value.sizes) == 1:
            return f'"{text_of(value)}"'
        case ArrayValue():
            sizes = ",".join(map(str, value.sizes))
            shown = ", ".join(value_text(part) for part in value.elements[:_MOST_ELEMENTS])
            more = ", …" if len(value.elements) > _MOST_ELEMENTS else ""
            return f"[{sizes}] {shown}{more}"
    return str(value)
