"""The data lists: their cells, and what is in them at first.

Initial values are expressions, so they are compiled as any others. The code is run once, at the
time of compiling, and what it leaves in the cells is written into the program.
"""

from __future__ import annotations

from grammar.semantics.symbols import Access
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import word_of
from interp.bytecode.compiler.calls import Calls
from interp.bytecode.compiler.code_writer import Label, Writer
from interp.bytecode.compiler.context import Context, Shared
from interp.bytecode.compiler.emitter import Emitter, Ended
from interp.bytecode.compiler.locations import SystemVariable
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.verifier.verify import Verified
from interp.bytecode.vm.executor import Machine
from interp.port.requests import End, Fail
from interp.program.load import CheckedProgram
from interp.program.variables import data_lists, data_variables, first_values
from interp.values.faults import LinkError, fault


def declare_data(program: CheckedProgram, tables: Tables) -> None:
    """Give the variables of all data lists their cells.

    Raises `LinkError` where there are more than a program can have.
    """
    for unit, _ in data_lists(program):
        for found, type_ in data_variables(program, unit):
            symbol = found.symbol
            is_global = symbol.access is Access.GLOBAL
            tables.variable(symbol, type_, unit.module.name, is_global=is_global)
            if tables.cells > MAX_CELLS:
                raise LinkError(f"{unit.module.path}: the data lists hold too much")


class _DataListEmitter(Emitter):
    """Ends the compiling where the program could not begin."""

    def refuse(self, reason: str) -> Ended:
        """What cannot be compiled cannot be had."""
        return self.unlinked(reason)

    def unlinked(self, reason: str) -> Ended:
        """The program cannot begin; where errors are no obstacle, there is no value."""
        if self.context.program.is_strict:
            raise LinkError(f"{self.context.unit.module.path}:{self.context.line}: {reason}")
        self.context.note(reason, is_missing=True)
        return Ended()

    def fail(self, slug: str) -> Ended:
        """The same."""
        return self.unlinked(str(fault(slug)))


class _DataList:
    """Makes the code that fills one data list."""

    def __init__(self, context: Context) -> None:
        self._emitter = _DataListEmitter(context)
        self._context = context
        self._writer = context.writer
        self._expressions = Calls(self._emitter).expressions

    def fill(self, content: ast.DataList, places: list[str]) -> None:
        """All initial values of the list, each a statement: its line is its place in ``places``."""
        for line, target, value in first_values(self._context.unit, content):
            self._context.line = line
            end = Label()
            if not self._context.program.is_strict:  # what faults has no value
                self._writer.emit(Op.PROCEED)
            self._writer.emit(Op.LINE, len(places), end)
            places.append(f"{self._context.unit.module.path}:{line}")
            self._give(target, value)
            self._writer.place(end)

    def _give(self, target: ast.Expression, value: ast.Expression) -> None:
        start = self._writer.here
        with self._writer.temporaries():
            try:
                place = self._expressions.designators.place(target)
                if isinstance(place, SystemVariable):
                    raise self._emitter.unlinked("a value is given to what is declared elsewhere")
                self._expressions.assign(place, value)
                if {Op.ASK, Op.CALL} & self._writer.ops(start):
                    raise self._emitter.unlinked("an initial value needs a running program")
            except Ended:
                self._writer.cut(start)


def initial_values(shared: Shared) -> tuple[tuple[int, int], ...]:
    """What is in the cells of the data lists at first; raises `LinkError`."""
    tables = shared.tables
    writer = Writer(tables, "DATA", CodeKind.ROUTINE, "", 0)
    places: list[str] = []
    for unit, content in data_lists(shared.program):
        scope = shared.program.project.scope(unit.module)
        _DataList(Context(shared, unit, scope, writer, is_data_list=True)).fill(content, places)
    writer.emit(Op.RETURN)
    code = writer.code(shared.sizes)
    program = Program(
        tuple(tables.types),
        tuple(tables.texts),
        (),
        tuple(tables.builtins),
        tuple(tables.data),
        (),
        (code,),
    )
    machine = Machine(Verified(program, ()), "DATA")  # made here, and run here and now
    end = machine.advance()
    while not isinstance(end, End | Fail):
        end = machine.advance()
    if isinstance(end, Fail):
        raise LinkError(f"{places[end.at.line]}: {end.fault}")
    return tuple(
        (address, word_of(raw)) for address, raw in enumerate(machine.data()) if raw is not None
    )
