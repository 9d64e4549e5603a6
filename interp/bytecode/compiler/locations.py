"""Locations of values during code generation, and what an expression leaves on the stack."""

from __future__ import annotations

from grammar.semantics.types import Type
from interp.bytecode.compiler.array_bounds import Bound
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class FrameCells:
    """In the frame."""

    offset: int
    type: Type


@dataclass(frozen=True, slots=True)
class DataCells:
    """In the data lists."""

    address: int
    type: Type


@dataclass(frozen=True, slots=True)
class ReferenceParameter:
    """What the parameter at this offset refers to."""

    offset: int
    type: Type


@dataclass(frozen=True, slots=True)
class ViewParameter:
    """The array that the parameter at this offset is a view of.

    ``most`` is how many elements a view has at most.
    """

    offset: int
    element: Type
    dimensions: int
    most: Bound


@dataclass(frozen=True, slots=True)
class Pushed:
    """A reference on the stack. ``through`` is the parameter it was reached by, if any."""

    type: Type
    through: int | None


@dataclass(frozen=True, slots=True)
class PushedView:
    """A view on the stack."""

    element: Type
    dimensions: int
    through: int | None
    most: Bound


@dataclass(frozen=True, slots=True)
class IndexCell:
    """An index that a cell of the frame has, or what the parameter there refers to."""

    offset: int
    is_formal: bool = False


@dataclass(frozen=True, slots=True)
class SystemVariable:
    """A system variable or a part of one; ``type`` is `UNKNOWN` where no table has it."""

    path: tuple[str | int | IndexCell, ...]
    type: Type


Location = (
    FrameCells
    | DataCells
    | ReferenceParameter
    | ViewParameter
    | Pushed
    | PushedView
    | SystemVariable
)


@dataclass(frozen=True, slots=True)
class Scalar:
    """A value on the stack."""

    type: Type


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference to a structure or an array on the stack."""

    type: Type


@dataclass(frozen=True, slots=True)
class View:
    """A view of an array on the stack."""

    element: Type
    dimensions: int
    most: Bound


@dataclass(frozen=True, slots=True)
class Text:
    """A text of the program; nothing is on the stack."""

    text: str


Value = Scalar | Reference | View | Text


def is_view_of(view: View | ViewParameter, element: Type, dimensions: int) -> bool:
    """Whether a view is one of an array with such elements and so many dimensions."""
    return (view.element, view.dimensions) == (element, dimensions)
