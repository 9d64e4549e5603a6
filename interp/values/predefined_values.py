"""Values of types that the controller predefines, by the names of these types."""

from __future__ import annotations

from grammar.semantics.predefined import System
from grammar.semantics.types import Enumeration, Structure
from interp.values.values import EnumValue, StructureValue, constant, empty


def empty_structure(type_name: str) -> StructureValue:
    """Return a structure in which no member has a value."""
    type_ = System.load().types[type_name]
    assert isinstance(type_, Structure), type_name
    value = empty(type_)
    assert isinstance(value, StructureValue)
    return value


def word(type_name: str, name: str) -> EnumValue:
    """Return a constant of an enumeration."""
    type_ = System.load().types[type_name]
    assert isinstance(type_, Enumeration), type_name
    return constant(type_, name)
