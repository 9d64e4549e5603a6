"""The data lists: their cells, and what is in them at first.

Initial values are expressions, so they are compiled as any others. The code is run once, at the
time of compiling, and what it leaves in the cells is written into the program.
"""

from __future__ import annotations

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Access
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import word_of
from interp.bytecode.compiler.calls import Calls
from interp.bytecode.compiler.code_writer import Writer
from interp.bytecode.compiler.context import Context, Ended
from interp.bytecode.compiler.places import Remote
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.verifier.verify import Verified
from interp.bytecode.vm.executor import Machine
from interp.port.requests import Fail
from interp.program.load import CheckedProgram
from interp.program.variables import data_lists, data_variables, first_values
from interp.values.faults import Fault, LinkError, fault

__all__ = ["declare_data", "initial_values"]


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


class _DataList(Calls):
    """Makes the code that fills one data list."""

    def _is_remote(self, found: Found) -> bool:
        return found.symbol not in self.context.places and super()._is_remote(found)

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
        """The program cannot begin."""
        raise LinkError(f"the data lists cannot be filled: {fault(slug)}")

    def fill(self, content: ast.DataList) -> None:
        """All initial values of the list."""
        for line, target, value in first_values(self.context.unit, content):
            self.context.line = line
            self._give(target, value)

    def _give(self, target: ast.Expression, value: ast.Expression) -> None:
        start = self.writer.here
        with self.writer.temporaries():
            try:
                place = self.place(target)
                if isinstance(place, Remote):
                    raise self.unlinked("a value is given to what is declared elsewhere")
                self.assign(place, value)
                if {Op.ASK, Op.CALL} & self.writer.ops(start):
                    raise self.unlinked("an initial value needs a running program")
            except Ended:
                self.writer.cut(start)


def initial_values(context: Context, tables: Tables) -> tuple[tuple[int, int], ...]:
    """What is in the cells of the data lists at first; raises `LinkError`.

    ``context`` is that of the project; a code object of its own is made in it.
    """
    writer = Writer(tables, "DATA", CodeKind.ROUTINE, "", 0)
    for unit, content in data_lists(context.program):
        scope = context.program.project.scope(unit.module)
        _DataList(Context(context.project, unit, scope, writer)).fill(content)
    writer.emit(Op.RETURN)
    code = writer.code(context.project.sizes)
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
    if isinstance(end, Fail) and isinstance(end.fault, Fault):
        raise LinkError(f"the data lists cannot be filled: {end.fault}")
    return tuple(
        (address, word_of(raw)) for address, raw in enumerate(machine.data()) if raw is not None
    )
