"""The types of what lies on the stack of operands: values, references, views."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from grammar.semantics.types import SCALARS
from interp.bytecode.program import Input, Mode, Parameter

__all__ = ["NOTHING", "SCALAR", "Held", "Refused", "Stack", "handed_over", "reference", "view_of"]


class Refused(Exception):
    """An instruction does not fit what it works on; the message says why, but not where."""


@dataclass(frozen=True, slots=True)
class Held:
    """What lies on the stack.

    ``mode`` is ``IN`` for a value of one cell. ``type`` is a number of the program; -1 stands for
    a value that was left out, ``is_missing`` for such a view. ``cells`` is how many cells it takes.
    """

    mode: Mode
    type: int
    cells: int = 1
    is_missing: bool = False


Stack = tuple[Held, ...]

NOTHING = Held(Mode.IN, -1)
#: A value of each scalar type, by its name.
SCALAR: Mapping[str, Held] = {name: Held(Mode.IN, number) for number, name in enumerate(SCALARS)}


def reference(type_: int) -> Held:
    """A reference to a place of this type."""
    return Held(Mode.REF, type_)


def view_of(type_: int, dimensions: int) -> Held:
    """A view of an array that has elements of this type."""
    return Held(Mode.VIEW, type_, 1 + dimensions)


def handed_over(given: Parameter | Input) -> Held:
    """An argument, as it lies on the stack."""
    return Held(given.mode, given.type, 1 + given.dimensions)
