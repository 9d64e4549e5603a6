"""The locations of values in generated code, and the items that expressions leave on the stack."""

from __future__ import annotations

from grammar.semantics.types import Type
from interp.bytecode.compiler.buffer_sizes import Bound
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class FrameCells:
    """Cells in the frame."""

    offset: int
    type: Type


@dataclass(frozen=True, slots=True)
class DataCells:
    """Cells in the data lists."""

    address: int
    type: Type


@dataclass(frozen=True, slots=True)
class ReferenceParameter:
    """The target of the reference parameter at this offset."""

    offset: int
    type: Type


@dataclass(frozen=True, slots=True)
class ViewParameter:
    """The array of the view parameter at this offset.

    ``most`` is the maximum number of elements.
    """

    offset: int
    element: Type
    dimensions: int
    most: Bound


@dataclass(frozen=True, slots=True)
class Pushed:
    """The target of a reference on the stack; ``through`` is the parameter it came from."""

    type: Type
    through: int | None


@dataclass(frozen=True, slots=True)
class PushedView:
    """The array of a view on the stack."""

    element: Type
    dimensions: int
    through: int | None
    most: Bound


@dataclass(frozen=True, slots=True)
class IndexCell:
    """An index in a cell of the frame, or in the target of the parameter there if ``is_formal``."""

    offset: int
    is_formal: bool = False


@dataclass(frozen=True, slots=True)
class SystemVariable:
    """A system variable or a part of one; ``type`` is `UNKNOWN` if it is in no table."""

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
    """A text of the program, with nothing on the stack."""

    text: str


Value = Scalar | Reference | View | Text


def is_view_of(view: View | ViewParameter, element: Type, dimensions: int) -> bool:
    """Return whether a view has elements of this type and this number of dimensions."""
    return (view.element, view.dimensions) == (element, dimensions)
