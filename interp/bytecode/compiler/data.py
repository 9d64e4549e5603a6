"""Data lists: cells for their variables, and the initial contents.

Nearly all initial values are literals or aggregates of literals, whose cells are known at once.
Others are compiled like any expression. That code runs once, during compilation, and the resulting
cells become part of the program.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from grammar.semantics.symbols import Access
from grammar.semantics.types import Array, Type
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Raw, cells_of, offset_of, size, value_at, word_of
from interp.bytecode.compiler.calls import Calls
from interp.bytecode.compiler.code_writer import Label, Writer
from interp.bytecode.compiler.context import Context, Shared
from interp.bytecode.compiler.emitter import Emitter, Ended
from interp.bytecode.compiler.locations import DataCells, SystemVariable
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.verifier.verify import Verified
from interp.bytecode.vm.executor import Machine
from interp.port.requests import End, Fail
from interp.program.literals import integer_literal, literal_value
from interp.program.load import CheckedProgram
from interp.program.reads import structure_of
from interp.program.variables import data_lists, data_variables, first_values
from interp.values.faults import Fault, LinkError, fault


def declare_data(program: CheckedProgram, tables: Tables) -> None:
    """Assign cells to the variables of all data lists.

    Raises `LinkError` if a program cannot have that many.
    """
    for unit, _ in data_lists(program):
        for found, type_ in data_variables(program, unit):
            symbol = found.symbol
            is_global = symbol.access is Access.GLOBAL
            tables.variable(symbol, type_, unit.module.name, is_global=is_global)
            if tables.cells > MAX_CELLS:
                raise LinkError(f"{unit.module.path}: the data lists hold too much")


class _DataListEmitter(Emitter):
    """Raises an error, or leaves the value out, where the program could not start."""

    def refuse(self, reason: str) -> Ended:
        """Treat code that cannot be compiled as an error in the program."""
        return self.unlinked(reason)

    def unlinked(self, reason: str) -> Ended:
        """Raise `LinkError` in strict mode; otherwise record the reason and leave the value out."""
        if self.context.program.is_strict:
            raise LinkError(f"{self.context.unit.module.path}:{self.context.line}: {reason}")
        self.context.note(reason, is_missing=True)
        return Ended()

    def fail(self, slug: str) -> Ended:
        """Treat a fault as an error in the program."""
        return self.unlinked(str(fault(slug)))


class _DataList:
    """Fills one data list: stores known values in cells, and generates code for the others.

    ``cells`` receives the contents of cells, by address, before that code runs.
    """

    def __init__(self, context: Context, cells: dict[int, Raw | None]) -> None:
        self._emitter = _DataListEmitter(context)
        self._context = context
        self._writer = context.writer
        self._expressions = Calls(self._emitter).expressions
        self._cells = cells

    def fill(self, content: ast.DataList, places: list[str]) -> None:
        """Store all initial values; the line number of a statement is an index into ``places``."""
        for line, target, value in first_values(self._context.unit, content):
            self._context.line = line
            start, end = self._writer.here, Label()
            if not self._context.program.is_strict:  # what faults has no value
                self._writer.emit(Op.PROCEED)
            self._writer.emit(Op.LINE, len(places), end)
            if self._needs_code(target, value, is_first=not start):
                places.append(f"{self._context.unit.module.path}:{line}")
            else:
                self._writer.cut(start)
            self._writer.place(end)

    def _needs_code(self, target: ast.Expression, value: ast.Expression, *, is_first: bool) -> bool:
        """Return whether code was generated for a value; otherwise it is stored, or there is none.

        After the first generated code, all values need code, because later values override earlier
        ones.
        """
        start = self._writer.here
        with self._writer.temporaries():
            try:
                place = self._expressions.designators.place(target)
                if isinstance(place, SystemVariable):
                    raise self._emitter.unlinked("a value is given to what is declared elsewhere")
                if is_first and self._writer.here == start and isinstance(place, DataCells):
                    with suppress(Fault, LinkError):  # the code for it reports this
                        found = self._cells_of(value, place.type)
                        self._cells.update(enumerate(found, place.offset))
                        return False
                self._expressions.assign(place, value)
                if {Op.ASK, Op.CALL} & self._writer.ops(start):
                    raise self._emitter.unlinked("an initial value needs a running program")
            except Ended:
                return False
        return True

    def _cells_of(self, node: ast.Expression, type_: Type) -> Sequence[Raw | None]:
        """Return the cells of a literal or aggregate of literals; raises `Fault`, `LinkError`."""
        tables, unit = self._context.tables, self._context.unit
        tables.number(type_)
        if isinstance(node, ast.Aggregate):
            structure = structure_of(unit, node, type_)
            if structure is None:
                raise fault("inadmissible")
            made = tables.closed(structure)
            cells: list[Raw | None] = [None] * size(made)
            for one in node.components:
                indices = one.indices or ()
                steps = [integer_literal(index) for index in indices if index is not None]
                found = offset_of(made, (one.name.key, *(step or 0 for step in steps)))
                if found is None or None in indices[:-1]:
                    raise fault("inadmissible")
                place, part = found
                cells[place : place + size(part)] = self._cells_of(one.value, part)
            return cells if made == type_ else cells_of(value_at(cells, 0, made), type_)
        value = literal_value(unit, node, type_)
        cells = cells_of(value, type_)
        if isinstance(value, str) and isinstance(type_, Array):
            tables.text(value)
        return cells


def initial_values(shared: Shared) -> tuple[tuple[int, int], ...]:
    """Return the initial contents of the data lists as address and word; raises `LinkError`."""
    tables = shared.tables
    writer = Writer(tables, "DATA", CodeKind.ROUTINE, "", 0)
    places: list[str] = []
    cells: dict[int, Raw | None] = {}
    for unit, content in data_lists(shared.program):
        scope = shared.program.project.scope(unit.module)
        context = Context(shared, unit, scope, writer, is_data_list=True)
        _DataList(context, cells).fill(content, places)
    known = sorted((address, word_of(raw)) for address, raw in cells.items() if raw is not None)
    if not places:
        return tuple(known)
    writer.emit(Op.RETURN)
    code = writer.code(shared.sizes)
    program = Program(
        tuple(tables.types),
        tuple(tables.texts),
        (),
        tuple(tables.builtins),
        tuple(tables.data),
        tuple(known),
        (code,),
    )
    machine = Machine(Verified(program, b""), "DATA")  # made here, and run here and now
    end = machine.advance()
    while not isinstance(end, End | Fail):
        end = machine.advance()
    if isinstance(end, Fail):
        raise LinkError(f"{places[end.at.line]}: {end.fault}")
    return tuple(
        (address, word_of(raw)) for address, raw in enumerate(machine.data()) if raw is not None
    )
