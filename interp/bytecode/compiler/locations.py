"""The locations of values in generated code, and the items that expressions leave on the stack."""

from __future__ import annotations

from typing import ClassVar

from grammar.semantics.types import Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.buffer_sizes import Bound
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class FixedCells:
    """Cells at a place that is known; the subclasses have the instructions for them."""

    offset: int
    type: Type

    load: ClassVar[Op]
    store: ClassVar[Op]
    refer: ClassVar[Op]
    index: ClassVar[Op]
    count: ClassVar[Op]
    tell: ClassVar[Op]


class FrameCells(FixedCells):
    """Cells in the frame."""

    __slots__ = ()
    load, store, refer = Op.LOAD_LOCAL, Op.STORE_LOCAL, Op.REF_LOCAL
    index, count, tell = Op.INDEX_LOCAL, Op.FOR_LOCAL, Op.TELL_LOCAL


class DataCells(FixedCells):
    """Cells in the data lists."""

    __slots__ = ()
    load, store, refer = Op.LOAD_DATA, Op.STORE_DATA, Op.REF_DATA
    index, count, tell = Op.INDEX_DATA, Op.FOR_DATA, Op.TELL_DATA


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


Location = FixedCells | ReferenceParameter | ViewParameter | Pushed | PushedView | SystemVariable


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
