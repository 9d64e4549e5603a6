"""The data lists: their cells, and what is in them at first.

Initial values are expressions, so they are compiled as any others. The code is run once, at the
time of compiling, and what it leaves in the cells is written into the program.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar import ast
from grammar.scopes import Found
from grammar.symbols import Access, Kind, SignalSymbol, Space
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import word_of
from interp.bytecode.compiler.calls import Calls
from interp.bytecode.compiler.context import Context, Ended
from interp.bytecode.compiler.places import Place
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.compiler.writer import Writer
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.isa import MAX_CELLS
from interp.bytecode.verify import Verified
from interp.bytecode.vm import Machine
from interp.faults import Fault, LinkError, fault
from interp.program import CheckedProgram, Unit
from interp.requests import Fail

__all__ = ["declare_data", "initial_values", "lists_of"]


def lists_of(program: CheckedProgram) -> Iterator[tuple[Unit, ast.DataList]]:
    """The data lists of a program."""
    for unit in program.units.values():
        content = unit.module.syntax.content if unit.module.syntax else None
        if isinstance(content, ast.DataList):
            yield unit, content


def declare_data(program: CheckedProgram, tables: Tables) -> None:
    """Give the variables of all data lists their cells.

    The controller's own are among them, because others may begin with their values; it is the world
    that has them when the program runs. What has no known type has no cells.
    """
    for unit, _ in lists_of(program):
        scope = program.project.scope(unit.module)
        assert unit.module.table is not None, "it was checked"
        for space, symbol in unit.module.table.table.symbols():
            is_variable = symbol.kind in (Kind.VARIABLE, Kind.CONSTANT)
            if space is not Space.VALUE or not is_variable or isinstance(symbol, SignalSymbol):
                continue
            found = scope.own(space, symbol.key)
            assert found is not None, "a scope has what its table has"
            is_global = symbol.access is Access.GLOBAL
            try:
                type_ = program.type_of(found)
                tables.variable(symbol, type_, unit.module.name, is_global=is_global)
            except LinkError:
                continue
            if tables.cells > MAX_CELLS:
                raise LinkError(f"{unit.module.path}: the data lists hold too much")


class _DataList(Calls):
    """Makes the code that fills one data list."""

    def _is_remote(self, found: Found) -> bool:
        return found.symbol not in self.context.places and super()._is_remote(found)

    def refuse(self, reason: str) -> Ended:
        """An initial value that cannot be compiled is left out, and told."""
        self.context.note(reason)
        return Ended()

    def unlinked(self, reason: str) -> Ended:
        """The program cannot begin."""
        raise LinkError(f"{self.context.unit.module.path}:{self.context.line}: {reason}")

    def fail(self, slug: str) -> Ended:
        """The program cannot begin."""
        raise LinkError(f"the data lists cannot be filled: {fault(slug)}")

    def fill(self, content: ast.DataList) -> None:
        """All initial values of the list."""
        for item in content.items:
            self.context.line = self.context.unit.line(item)
            match item:
                case ast.VariableDeclaration():
                    for declarator in item.declarators:
                        if declarator.value is not None:
                            variable = ast.Variable(declarator.span, declarator.name)
                            self._give(variable, declarator.value)
                case ast.Assignment():
                    self._give(item.target, item.value)

    def _give(self, target: ast.Expression, value: ast.Expression) -> None:
        start = self.writer.here
        with self.writer.temporaries():
            try:
                self.assign(self._own(target), value)
            except Ended:
                self.writer.cut(start)
        if {Op.ASK, Op.CALL} & self.writer.ops(start):
            raise self.unlinked("an initial value needs a running program")

    def _own(self, target: ast.Expression) -> Place:
        return self.place(target)


def initial_values(context: Context, tables: Tables) -> tuple[tuple[int, int], ...]:
    """What is in the cells of the data lists at first; raises `LinkError`.

    ``context`` is that of the project; a code object of its own is made in it.
    """
    writer = Writer(tables, "DATA", CodeKind.ROUTINE, "", 0)
    for unit, content in lists_of(context.program):
        scope = context.program.project.scope(unit.module)
        _DataList(Context(context.project, unit, scope, writer)).fill(content)
    writer.emit(Op.RETURN)
    program = Program(
        tuple(tables.types),
        tuple(tables.texts),
        (),
        tuple(tables.builtins),
        tuple(tables.data),
        (),
        (writer.code(),),
    )
    machine = Machine(Verified(program, ()), "DATA")  # made here, and run here and now
    end = machine.advance()
    if isinstance(end, Fail) and isinstance(end.fault, Fault):
        raise LinkError(f"the data lists cannot be filled: {end.fault}")
    return tuple(
        (address, word_of(raw)) for address, raw in enumerate(machine.data()) if raw is not None
    )
