"""Compiles a checked program: routines are compiled as they are called."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from grammar.semantics.symbols import Access, Kind, Symbol
from grammar.semantics.types import BOOL, INT, Array, Type
from grammar.syntax import ast
from grammar.syntax.walk import walk
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, flattened, word_of
from interp.bytecode.compiler.calls import Formals, formals_of
from interp.bytecode.compiler.code_writer import Writer
from interp.bytecode.compiler.context import Binding, Context, Deferred, Refusal, Shared
from interp.bytecode.compiler.emitter import Emitter
from interp.bytecode.compiler.locations import (
    DataCells,
    FrameCells,
    IndexCell,
    Location,
    Pushed,
    PushedView,
    ReferenceParameter,
    SystemVariable,
    ViewParameter,
)
from interp.bytecode.compiler.predefined_calls import BY_TEXT
from interp.bytecode.compiler.statements import Statements
from interp.bytecode.program import CodeKind, Import, Mode, Program
from interp.bytecode.verifier.verify import measured
from interp.program.load import CheckedProgram, Routine
from interp.program.variables import (
    MOST_CELLS,
    cells_of_routine,
    data_lists,
    data_variables,
    is_complete,
    too_large,
)
from interp.tree.memory import initial_data
from interp.values.faults import LinkError


@dataclass(frozen=True, slots=True)
class Compiled:
    """A compiled program, and the places where it ends if they are executed.

    ``starts`` maps the routines with which the program can begin to their code objects.
    """

    program: Program
    refusals: tuple[Refusal, ...]
    starts: Mapping[Symbol, int]


def compile_program(program: CheckedProgram, starts: Iterable[Routine] = ()) -> Compiled:
    """Compile a program; raises `LinkError` if it cannot run at all.

    It can begin with the routines without parameters of its first file and of submit programs, and
    with ``starts``. Routines that none of them calls are not compiled.
    """
    submits = (unit for unit in program.units.values() if unit.module.suffix == ".sub")
    files = dict.fromkeys((program.main, *submits))
    found = (routine for unit in files for routine in program.routines_of(unit))
    return Project(program).compiled((*filter(program.can_begin, found), *starts))


class Project:
    """The compilation of one program."""

    def __init__(self, program: CheckedProgram) -> None:
        self._shared = Shared(program, self)
        self._program = program
        self._tables = self._shared.tables
        self._codes: list[Writer | None] = []
        self._numbers: dict[tuple[Symbol, tuple[Binding, ...]], int] = {}
        self._todo: deque[tuple[int, Routine, tuple[Binding, ...]]] = deque()

    def compiled(self, starts: Sequence[Routine]) -> Compiled:
        """Return the compiled program."""
        main = self._program.main
        initial = tuple(self._initial_values())
        numbers: dict[Symbol, int] = {
            routine.table.routine: self.code_of(routine, ()) for routine in starts
        }
        if not numbers:
            raise LinkError(f"{main.module.path} has no routine that a program can begin with")
        while self._todo:
            number, routine, bindings = self._todo.popleft()
            self._codes[number] = self._routine(number, routine, bindings)
        tables = self._tables
        codes = tuple(one.code(self._shared.sizes) for one in self._codes if one is not None)
        program = Program(
            tuple(tables.types),
            tuple(tables.texts),
            tuple(tables.asks),
            tuple(tables.builtins),
            tuple(tables.data),
            initial,
            codes,
            tuple(self._imports()),
        )
        return Compiled(measured(program), tuple(self._shared.refusals), numbers)

    def _initial_values(self) -> Iterator[tuple[int, int]]:
        """Assign cells to the variables of data lists; yield their contents as address and word."""
        program, tables = self._program, self._tables
        data = initial_data(program)
        for unit, _ in data_lists(program):
            for found, type_ in data_variables(program, unit):
                symbol, first = found.symbol, tables.cells
                is_global = symbol.access is Access.GLOBAL
                tables.variable(symbol, type_, unit.module.name, is_global=is_global)
                cells = flattened(data.places[symbol].get(), type_)
                yield from (
                    (at, word_of(raw)) for at, raw in enumerate(cells, first) if raw is not None
                )
        for path, line, reason in data.left_out:
            self._shared.refusals[Refusal(path, line, reason, is_missing=True)] = None

    def _imports(self) -> Iterator[Import]:
        """Yield the imported names of modules and routines, except imports without a target."""
        program = self._program
        numbers = {symbol: number for number, symbol in enumerate(self._tables.places)}
        for unit in program.units.values():
            assert unit.module.table is not None, "only what can be read is loaded"
            tables = [(unit.module.table.table, program.project.scope(unit.module), "")]
            tables += [(one.table.table, one.scope, one.name) for one in program.routines_of(unit)]
            for table, scope, routine in tables:
                for space, symbol in table.symbols():
                    if symbol.kind is Kind.IMPORT:
                        found = scope.own(space, symbol.key)
                        assert found is not None, "a scope has what its table has"
                        with suppress(LinkError):
                            number = numbers.get(program.declaration(found).symbol)
                            if number is not None:
                                yield Import(unit.module.name, routine, symbol.name, number)

    # ----------------------------------------------------------------------- routines

    def code_of(self, routine: Routine, bindings: tuple[Binding, ...]) -> int:
        """Return the number of a routine's code object for these system variables as arguments."""
        key = routine.table.routine, bindings
        if key not in self._numbers:
            self._numbers[key] = self._reserved()
            self._todo.append((self._numbers[key], routine, bindings))
        return self._numbers[key]

    def _reserved(self) -> int:
        self._codes.append(None)
        return len(self._codes) - 1

    def _routine(self, number: int, routine: Routine, bindings: tuple[Binding, ...]) -> Writer:
        unit = routine.unit
        line = unit.line(routine.node)
        writer = Writer(self._tables, routine.name, CodeKind.ROUTINE, unit.module.path, line)
        context = Context(self._shared, unit, routine.scope, writer, line=line, number=number)
        if self._tables.cells + cells_of_routine(self._program, routine) > MOST_CELLS:
            writer.emit(Op.UNLINKED, self._tables.text(str(too_large(routine))))
            return writer
        result = self._program.result_of(routine)
        if result is not None and not is_complete(result):
            Emitter(context).unlinked(f"{routine.name} gives {result}")
            return writer
        if result is not None:
            self._give(context, result)
        formals = formals_of(routine, self._program.type_of)
        for place, binding in enumerate(bindings):
            self._formal(context, formals, place, binding)
        self._declare(context, routine, {found.symbol for found in formals.found})
        Statements(context).routine(routine.node)
        return writer

    def _give(self, context: Context, result: Type) -> None:
        """Set the result of a function; a large one is stored through a hidden parameter."""
        context.result = self._tables.closed(result)
        if isinstance(context.result, Plain):
            context.writer.result = self._tables.number(result)
        else:
            context.target = context.writer.parameter("%result", Mode.REF, context.result)

    def _formal(self, context: Context, formals: Formals, place: int, binding: Binding) -> None:
        writer, symbol = context.writer, formals.found[place].symbol
        if binding is not None:
            path, type_ = binding
            steps = tuple(
                IndexCell(writer.parameter(f"%{symbol.key}", Mode.IN, INT))
                if step is None
                else step
                for step in path
            )
            context.variables[symbol] = SystemVariable(steps, type_)
            return
        type_, is_in = formals.types[place], formals.is_in[place]
        if isinstance(type_, Array) and (not is_in or None in type_.sizes):
            element, count = self._tables.closed(type_.element), len(type_.sizes)
            offset = writer.parameter(symbol.name, Mode.VIEW, element, count)
            context.variables[symbol] = ViewParameter(
                offset, element, count, (context.number, place)
            )
            return
        closed = self._tables.closed(type_)
        offset = writer.parameter(symbol.name, Mode.IN if is_in else Mode.REF, closed)
        context.variables[symbol] = (
            FrameCells(offset, closed) if is_in else ReferenceParameter(offset, closed)
        )

    def _declare(self, context: Context, routine: Routine, formals: set[Symbol]) -> None:
        """Declare the local variables. One of unknown type is refused where it is used."""
        for statement in routine.node.body:
            if not isinstance(statement, ast.VariableDeclaration):
                continue
            for declarator in statement.declarators:
                found = context.unit.found(declarator.name)
                if found is None or found.symbol in formals or found.symbol in context.variables:
                    continue
                type_ = self._program.type_of(found)
                if not is_complete(type_):
                    continue
                closed = self._tables.closed(type_)
                offset = context.writer.local(found.symbol.name, closed)
                context.variables[found.symbol] = FrameCells(offset, closed)

    # ----------------------------------------------------------------------- deferred

    def deferred(self, owner: Context, node: Deferred, kind: CodeKind) -> int:
        """Return the number of an action or a condition, which uses variables of its owner."""
        number = self._reserved()
        line = owner.unit.line(node)
        file = owner.unit.module.path
        name = owner.writer.name
        writer = Writer(self._tables, name, kind, file, line, owner.number)
        context = Context(self._shared, owner.unit, owner.scope, writer, line=line, number=number)
        for symbol in self._used(owner, node):
            context.variables[symbol] = self._captured(writer, symbol, owner.variables[symbol])
        made = Statements(context)
        if isinstance(node, ast.Assignment | ast.CallStatement | ast.Brake):
            made.action(node)
        else:
            writer.result = self._tables.number(BOOL)
            made.condition(node)
        self._codes[number] = writer
        return number

    def _used(self, owner: Context, node: ast.Node) -> list[Symbol]:
        """Return the variables of the owner that a node names, in the order of the text."""
        found: dict[Symbol, None] = {}
        for one in walk(node):
            if isinstance(one, ast.Variable):
                means = owner.unit.found(one.name)
                if means is not None and means.symbol in owner.variables:
                    found[means.symbol] = None
            elif isinstance(one, ast.Call) and one.name.key in BY_TEXT:
                found.update(dict.fromkeys(_named_by_text(owner, one)))
        return list(found)

    def _captured(self, writer: Writer, symbol: Symbol, place: Location) -> Location:
        """Declare a parameter for a variable of the owner; return its location."""
        match place:
            case FrameCells(offset, type_) | ReferenceParameter(offset, type_):
                writer.captures.append(offset)
                return ReferenceParameter(writer.parameter(symbol.name, Mode.REF, type_), type_)
            case ViewParameter(offset, element, dimensions, most):
                writer.captures.append(offset)
                mine = writer.parameter(symbol.name, Mode.VIEW, element, dimensions)
                return ViewParameter(mine, element, dimensions, most)
            case SystemVariable():
                return self._captured_remote(writer, symbol, place)
        assert not isinstance(place, DataCells | Pushed | PushedView), "a variable of a frame"
        return place

    def _captured_remote(
        self, writer: Writer, symbol: Symbol, place: SystemVariable
    ) -> SystemVariable:
        steps: list[str | int | IndexCell] = []
        for step in place.path:
            if isinstance(step, IndexCell):
                writer.captures.append(step.offset)
                steps.append(IndexCell(writer.parameter(f"%{symbol.key}", Mode.REF, INT), True))
            else:
                steps.append(step)
        return SystemVariable(tuple(steps), place.type)


def _named_by_text(owner: Context, call: ast.Call) -> list[Symbol]:
    """Return the owner's variables that a call may name by a text: one if the text is known."""
    match call.arguments:
        case (ast.StringLiteral(text=text),):
            wanted = text.partition("[")[0].partition(".")[0].strip().upper()
            return [symbol for symbol in owner.variables if symbol.key == wanted]
    return list(owner.variables)
