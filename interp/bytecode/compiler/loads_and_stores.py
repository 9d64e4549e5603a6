"""Code that reads a location, refers to it, stores a value in it, and traces the assignment.

`Memory` depends on cells and types, not on syntax trees.
"""

from __future__ import annotations

from grammar.semantics.types import CHAR, INT, REAL, UNKNOWN, Array, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, bits_of, elements, offset_of, shared_cells
from interp.bytecode.compiler.emitter import Emitter
from interp.bytecode.compiler.locations import (
    FixedCells,
    FrameCells,
    IndexCell,
    Location,
    Pushed,
    PushedView,
    Reference,
    ReferenceParameter,
    Scalar,
    SystemVariable,
    Text,
    Value,
    View,
    ViewParameter,
)
from interp.bytecode.program import Argument, Ask, Constant, Input, Items, Mode
from interp.program.variables import is_complete, untyped_value
from interp.values.values import single

#: The instructions that convert a value of one type to another.
_CONVERSIONS: dict[tuple[Type, Type], Op] = {
    (INT, REAL): Op.INT_TO_REAL,
    (REAL, INT): Op.REAL_TO_INT,
    (CHAR, INT): Op.CHAR_TO_INT,
    (INT, CHAR): Op.INT_TO_CHAR,
}


class Memory:
    """Generates loads and stores of one code object."""

    def __init__(self, emitter: Emitter) -> None:
        self._emitter = emitter
        self._context = emitter.context
        self._writer = emitter.writer
        self._emit = emitter.emit

    # ----------------------------------------------------------------------- loads

    def load(self, place: Location) -> Value:
        """Generate the value of a location."""
        match place:
            case SystemVariable():
                return self.read(place)
            case ViewParameter() | PushedView():
                return self.view(place)
        if isinstance(place.type, Plain):
            self._load_cell(place)
            return Scalar(place.type)
        self.refer(place)
        return Reference(place.type)

    def _load_cell(self, place: FixedCells | ReferenceParameter | Pushed) -> None:
        match place:
            case FixedCells(offset):
                self._emit(place.load, offset)
            case ReferenceParameter(offset):
                self._emit(Op.LOAD_REF, offset)
                self._emit(Op.LOAD)
            case Pushed():
                last = self._writer.last()
                element = _ELEMENTS.get(last.op) if last else None
                if last is None or element is None:
                    self._emit(Op.LOAD)
                else:
                    last.op = element

    def refer(self, place: FixedCells | ReferenceParameter | Pushed) -> None:
        """Push a reference to a location."""
        match place:
            case FixedCells(offset, type_):
                self._emit(place.refer, offset, self._emitter.number(type_))
            case ReferenceParameter(offset):
                self._emit(Op.LOAD_REF, offset)

    def refer_below(self, place: FrameCells, at: int) -> None:
        """Insert a reference to cells of the frame below what was pushed from ``at`` on."""
        self._writer.insert(at, Op.REF_LOCAL, place.offset, self._emitter.number(place.type))

    def kept(self, value: Reference | Scalar, behind: int) -> FrameCells:
        """Copy the value that was pushed from ``behind`` on to the frame; return where it is."""
        kept = FrameCells(self._writer.temporary(value.type), value.type)
        self.refer_below(kept, behind)
        if isinstance(value, Reference):
            self._emit(Op.COPY, self._emitter.number(value.type))
        else:
            self._emit(Op.STORE)
        return kept

    def view(self, place: ViewParameter | PushedView, *, may_be_missing: bool = False) -> View:
        """Push a view."""
        if isinstance(place, ViewParameter):
            self._emit(Op.PASS_VIEW if may_be_missing else Op.LOAD_VIEW, place.offset)
        return View(place.element, place.dimensions, place.most)

    def as_view(self, value: Reference | View, at: int | None = None) -> View:
        """Turn a reference to an array into a view.

        It is the one on top, or the one that is on top before the instruction at ``at``.
        """
        if isinstance(value, View):
            return value
        assert isinstance(value.type, Array), "only arrays have views"
        place = self._writer.here if at is None else at
        self._writer.insert(place, Op.VIEW, self._emitter.number(value.type))
        return View(value.type.element, len(value.type.sizes), elements(value.type))

    def read(self, place: SystemVariable) -> Scalar | Reference:
        """Generate a request for the value of a system variable."""
        type_ = place.type
        if not is_complete(type_):
            name, *rest = place.path
            raise self._emitter.refuse(str(untyped_value([str(name), *("" for _ in rest)])))
        type_ = self._emitter.closed(type_)
        path = self.pushed_path(place)
        ask = self._context.tables.ask(Ask("Read", (path,), self._emitter.number(type_)))
        return self.answered(Op.ASK, ask, type_)

    def answered(self, op: Op, entry: int, type_: Type) -> Scalar | Reference:
        """Generate a request or function with a result; a large one is stored in the frame."""
        if isinstance(type_, Plain):
            self._emit(op, entry)
            return Scalar(type_)
        kept = FrameCells(self._writer.temporary(type_), type_)
        self.refer(kept)
        self._emit(op, entry)
        self.refer(kept)
        return Reference(type_)

    def pushed_path(self, place: SystemVariable, at: int | None = None) -> Items:
        """Push the indices of a system variable; return its path as a part of a request.

        They come below what was pushed from ``at`` on, if that is given.
        """
        at = self._writer.here if at is None else at
        parts: list[Argument] = []
        for step in place.path:
            if isinstance(step, IndexCell):
                load = Op.LOAD_REF if step.is_formal else Op.LOAD_LOCAL
                self._writer.insert(at, load, step.offset)
                if step.is_formal:
                    self._writer.insert(at + 1, Op.LOAD)
                at += 1 + step.is_formal
                parts.append(Input(Mode.IN, self._emitter.number(INT)))
            else:
                parts.append(Constant(step))
        return Items(tuple(parts))

    # ----------------------------------------------------------------------- parts

    def member(self, base: Location, name: str) -> Location:
        """Return the location of a component of a structure."""
        key = name.upper()
        if isinstance(base, SystemVariable):
            known = base.type.member(key) if isinstance(base.type, Structure) else None
            return SystemVariable((*base.path, key), known or UNKNOWN)
        if isinstance(base, ViewParameter | PushedView) or not isinstance(base.type, Structure):
            raise self._emitter.unlinked(f"{key} is a member of nothing")
        found = offset_of(base.type, (key,))
        if found is None:
            raise self._emitter.unlinked(f"{base.type} has no component {name} that is known")
        return self._part(base, *found)

    def _part(
        self, base: FixedCells | ReferenceParameter | Pushed, offset: int, type_: Type
    ) -> Location:
        if isinstance(base, FixedCells):
            return type(base)(base.offset + offset, type_)
        through = base.offset if isinstance(base, ReferenceParameter) else base.through
        self.refer(base)
        last = self._writer.last()
        if last is not None and last.op is Op.MEMBER:
            before = last.operands[0]
            assert isinstance(before, int), "an offset"
            last.operands = (before + offset, self._emitter.number(type_))
        else:
            self._emit(Op.MEMBER, offset, self._emitter.number(type_))
        return Pushed(type_, through)

    def fixed_element(self, base: FixedCells, indices: tuple[int, ...]) -> FixedCells | None:
        """Return the location of an element or row with constant indices; ``None`` if outside."""
        found = offset_of(base.type, indices)
        return None if found is None else type(base)(base.offset + found[0], found[1])

    # ----------------------------------------------------------------------- conversion

    def convert(self, value: Value, to: Type) -> None:
        """Convert the value on top to a value of one cell of another type."""
        if isinstance(value, Text) and len(value.text) == 1:
            self._emit(Op.PUSH_CHAR, ord(value.text))
            value = Scalar(CHAR)
        if not isinstance(value, Scalar):
            raise self._emitter.fail("inadmissible")
        if value.type == to:
            return
        op = _CONVERSIONS.get((value.type, to))
        if op is None:
            raise self._emitter.fail("inadmissible")
        number = self._writer.constant()
        if op is Op.INT_TO_REAL and number is not None:
            self._writer.drop_last()
            self._emit(Op.PUSH_REAL, bits_of(single(number)))
        else:
            self._emit(op)

    # ----------------------------------------------------------------------- stores

    def ready(self, place: Location) -> Location:
        """Push what a location needs below the value that will be stored in it."""
        match place:
            case ReferenceParameter():
                self.refer(place)
                return Pushed(place.type, place.offset)
            case ViewParameter():
                self.view(place)
                return PushedView(place.element, place.dimensions, place.offset, place.most)
            case FixedCells() if not isinstance(place.type, Plain):
                self.refer(place)
        return place

    def store(self, place: Location, value: Value, behind: int) -> None:
        """Store the value on top in a location made `ready`.

        The code of the value begins at ``behind``.
        """
        if isinstance(place, SystemVariable):
            self._write(place, value, behind)
            return
        if isinstance(place, PushedView):
            self._fill(View(place.element, place.dimensions, place.most), value)
            return
        assert not isinstance(place, ViewParameter), "made ready"
        if isinstance(place.type, Plain):
            self.convert(value, place.type)
            if isinstance(place, FixedCells):
                self._emit(place.store, place.offset)
            else:
                self._emit(Op.STORE)
            return
        self.store_block(place.type, value, behind)

    def converted_below(self, kept: FrameCells, value: Value, behind: int) -> None:
        """Store the value that was pushed from ``behind`` on in the frame, and refer to it."""
        self.refer_below(kept, behind)
        self.store_block(kept.type, value, behind + 1)
        self.refer(kept)

    def store_block(self, type_: Type, value: Value, behind: int) -> None:
        """Store in a structure or array; the reference to it lies below the value."""
        match value:
            case Reference(of) if of == type_:
                self._emit(Op.COPY, self._emitter.number(type_))
            case Reference(of) if shared_cells(type_, of) is not None:
                self._emit(Op.FILL_POSE, self._emitter.number(type_), self._emitter.number(of))
            case _ if isinstance(type_, Array):
                target = self.as_view(Reference(type_), at=behind)
                self._fill(target, value)
            case _:
                raise self._emitter.fail("inadmissible")

    def _fill(self, target: View, value: Value) -> None:
        """Store in an array; the view of it lies below the value."""
        if isinstance(value, Text):
            if (target.element, target.dimensions) != (CHAR, 1):
                raise self._emitter.fail("inadmissible")
            self._emit(Op.SET_TEXT, self._context.tables.text(value.text))
            return
        if isinstance(value, Scalar) or (
            isinstance(value, Reference) and not isinstance(value.type, Array)
        ):
            raise self._emitter.fail("inadmissible")
        given = self.as_view(value)
        if given.dimensions != target.dimensions:
            raise self._emitter.fail("inadmissible")
        if given.element != target.element:
            raise self._emitter.refuse(f"an array of {given.element} fills one of {target.element}")
        self._emit(Op.FILL_ARRAY, self._emitter.number(target.element), target.dimensions)

    def _write(self, place: SystemVariable, value: Value, behind: int) -> None:
        """Generate a write request for a system variable; indices come below the value."""
        before = self._writer.here
        path = self.pushed_path(place, behind)
        part = self.remote_value(place.type, value, behind + self._writer.here - before)
        self._emitter.ask("Write", path, part)

    def remote_value(self, type_: Type, value: Value, behind: int) -> Argument:
        """Return the value on top as a part of a request, converted if the type is known."""
        if type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes):
            return self.handed(value)
        type_ = self._emitter.closed(type_)
        if isinstance(type_, Plain):
            self.convert(value, type_)
            return Input(Mode.IN, self._emitter.number(type_))
        if value != Reference(type_):
            kept = FrameCells(self._writer.temporary(type_), type_)
            self.converted_below(kept, value, behind)
        return Input(Mode.REF, self._emitter.number(type_))

    def handed(self, value: Value) -> Argument:
        """Return the value on top as a part of a request, without conversion."""
        match value:
            case Text(text):
                return Constant(text)
            case Scalar(type_):
                return Input(Mode.IN, self._emitter.number(type_))
            case Reference(type_):
                return Input(Mode.REF, self._emitter.number(type_))
        return Input(Mode.VIEW, self._emitter.number(value.element), value.dimensions)

    # ----------------------------------------------------------------------- trace

    def tell(self, place: Location) -> None:
        """Generate the trace event of an assignment to a location."""
        match place:
            case FixedCells(offset, type_):
                self._emit(place.tell, offset, self._emitter.number(type_))
            case Pushed(type_, through):
                self._tell_last(type_, 0, through)
            case PushedView(element, dimensions, through):
                self._tell_last(element, dimensions, through)

    def _tell_last(self, type_: Type, dimensions: int, through: int | None) -> None:
        if through is None:
            self._emit(Op.TELL, self._emitter.number(type_), dimensions)
        else:
            self._emit(Op.TELL_REF, through, self._emitter.number(type_), dimensions)


_ELEMENTS = {Op.INDEX_LOCAL: Op.ELEMENT_LOCAL, Op.INDEX_DATA: Op.ELEMENT_DATA}
