"""The loader: reads, links and checks files, and returns a program that can run.

`load` returns all that an interpreter or a compiler needs of a project: its files with their syntax
trees and the results of the check, its routines by symbol, and what each name refers to. An error
anywhere in the project is a `LinkError`. A missing routine is no error: the call fails when the
program reaches it [SCO-10].
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import field, replace
from enum import Enum
from functools import cached_property
from itertools import chain

from grammar.check.analysis.context import placed
from grammar.check.names.unresolved_name import Files
from grammar.check.project.framework import Checked, check_module, check_project, typed_module
from grammar.diagnostics.syntax_errors.findings import syntax_findings
from grammar.semantics.error_suppression import suppressions
from grammar.semantics.link import File, Project, extended, link
from grammar.semantics.scopes import Found, Module, Scope
from grammar.semantics.symbols import ImportSymbol, Kind, RoutineTable, Symbol
from grammar.semantics.types import Array, Structure, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.walk import bodies, walk
from interp.standins.completion import LIST_OF_ONE, StandIn, complete
from interp.standins.missing_returns import with_returns
from interp.standins.unreadable_lines import Readable, readable
from interp.standins.uses import FOLDER
from interp.values.faults import BudgetExhausted, LinkError
from support.gc_pause import gc_paused
from support.lazy_dataclass import dataclass

_TYPES = frozenset({Kind.STRUCTURE, Kind.ENUMERATION, Kind.PLAIN_TYPE})
#: What only a routine or a structure declares, and so no stand-in.
_INNER = frozenset({Kind.PARAMETER, Kind.MEMBER})
#: The deepest nesting of blocks that is run. It is far above what people write, and low enough for
#: an interpreter that recurses on Python's stack.
MOST_BLOCKS = 50


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of a run.

    A program counts as endless after ``statements`` statements; also after functions that take as
    long as ``functions`` of them (`interp.values.builtins.WEIGHTS`), if it has not waited in
    between. Time must pass after ``per_slice`` statements without another request. The stack
    overflows at ``depth`` calls [SCO-12]. If ``skips_failures`` is set, a statement that fails is
    reported as `interp.port.requests.Skip`, and the program continues after it.
    """

    statements: int = 10_000_000
    functions: int = 10_000_000
    per_slice: int = 1_000
    depth: int = 64
    skips_failures: bool = False

    def exhausted(self) -> BudgetExhausted:
        """Return the exception to raise when a statement beyond the limit would begin."""
        return BudgetExhausted(f"it has not ended after {self.statements:,} statements")

    def overrun(self) -> BudgetExhausted:
        """Return the exception to raise when functions have taken longer than they may."""
        return BudgetExhausted(
            f"it has not ended or waited after functions as long as {self.functions:,} statements"
        )


class Guard(Enum):
    """Whether ON_ERROR_PROCEED applies: to the next statement, or to the present one."""

    OFF = 0
    NEXT = 1
    NOW = 2


@dataclass(frozen=True, eq=False)
class Unit:
    """A file of the program: its module, its text, and the results of its check."""

    module: Module
    source: Source
    checked: Checked

    def line(self, node: ast.Node) -> int:
        """Return the line in which a node begins, counted from 1."""
        return self.source.place(node.span[0])[0]

    @cached_property
    def suppressing(self) -> frozenset[ast.Span]:
        """The spans of each ON_ERROR_PROCEED with an effect, or of CONTINUE behind it [FCT-12]."""
        nodes = walk(self.module.syntax) if self.module.syntax else ()
        lists = [body for node in nodes for body in bodies(node)]
        every = chain.from_iterable(suppressions(body, self.line) for body in lists)
        return frozenset(last.span for _, last, _, has_effect in every if has_effect)

    def found(self, name: ast.Name) -> Found | None:
        """Return what a name in this file refers to, or ``None`` if that is unknown."""
        return self.checked.resolution.found(name)

    @staticmethod
    def undeclared(name: ast.Name) -> str:
        """Return the error text for a line with an undeclared name, when a run reaches it."""
        return f"{name.text} is declared nowhere"


@dataclass(frozen=True, slots=True, eq=False)
class Routine:
    """A routine that can be called; ``scope`` is the scope of its body."""

    unit: Unit
    node: ast.Routine
    table: RoutineTable
    scope: Scope

    @property
    def name(self) -> str:
        """The name as written in the declaration."""
        return self.node.name.text


@dataclass(frozen=True, eq=False)
class CheckedProgram:
    """A linked project and the file with which it begins.

    If ``is_strict`` is set, the project has no errors. ``stand_ins`` are those of all files of the
    project; `used_stand_ins` says which of them a run can reach. ``callers`` are the routines that
    were added to call a routine with parameters, by the name of the called routine in upper case.
    ``damaged`` has the paths of the files with unreadable lines.
    """

    project: Project
    main: Unit
    units: Mapping[Module, Unit]
    is_strict: bool = True
    stand_ins: tuple[StandIn, ...] = ()
    callers: Mapping[str, str] = field(default_factory=dict)
    damaged: Set[str] = frozenset()

    @cached_property
    def routines(self) -> Mapping[Symbol, Routine]:
        """All routines, by their symbols."""
        return {
            one.table.routine: one for unit in self.units.values() for one in self.routines_of(unit)
        }

    @cached_property
    def routines_by_name(self) -> Mapping[tuple[str, str], Routine]:
        """The first routine of each name in a file, by path and by name in upper case."""
        found: dict[tuple[str, str], Routine] = {}
        for unit in self.units.values():
            for one in self.routines_of(unit):
                found.setdefault((unit.module.path, one.node.name.key), one)
        return found

    def unit_of(self, file: str) -> Unit | None:
        """Return the file with a path, or ``None`` if the project has none."""
        return next((one for one in self.units.values() if one.module.path == file), None)

    def routines_of(self, unit: Unit) -> tuple[Routine, ...]:
        """Return the routines of a file in their order; a data list has none."""
        syntax, table = unit.module.syntax, unit.module.table
        assert syntax is not None, "only what can be read is loaded"
        assert table is not None, "what can be read has its table"
        if isinstance(syntax.content, ast.DataList):
            return ()
        pairs = zip(syntax.content.routines, table.routines, strict=True)
        return tuple(
            Routine(unit, node, inner, self.project.scope(unit.module, inner))
            for node, inner in pairs
        )

    def start(self, name: str | None = None) -> Routine:
        """Return the routine of that name in the main file, by default the file's first routine.

        If the main file has no such routine, it may be the first routine of another file. Raises
        `LinkError` if there is none, or if it needs arguments.
        """
        others = (self.routines_of(one)[:1] for one in self.units.values() if one is not self.main)
        found = [
            one
            for one in (*self.routines_of(self.main), *chain.from_iterable(others))
            if name is None or one.node.name.key == name.upper()
        ]
        if not found:
            raise LinkError(f"there is no routine {name or 'in ' + self.main.module.path}")
        if found[0].node.name.key in self.callers:
            return self.start(self.callers[found[0].node.name.key])
        if not self.can_begin(found[0]):
            has = "parameters" if found[0].node.parameters else "a structure or array as its result"
            raise LinkError(f"{found[0].name} has {has}, so a program cannot begin with it")
        return found[0]

    def starts(self, routine: str | None, submit: str | None = None) -> list[Routine]:
        """Return the routines with which a run begins; raise `LinkError` as `start` does."""
        return [self.start(routine), *([self.start(submit)] if submit else [])]

    def submit_name(self) -> str | None:
        """Return the name of the project's submit program, which controllers call SPS."""
        for unit in self.units.values():
            routines = self.routines_of(unit)
            if unit.module.suffix == ".sub" and routines and routines[0].node.name.key == "SPS":
                return routines[0].name
        return None

    def used_stand_ins(self, *routines: Routine) -> tuple[StandIn, ...]:
        """Return the stand-ins that the files reachable from some routines use, in their order.

        Each has the place of its first use in these files, those of the project itself first.
        """
        if not self.stand_ins:
            return ()
        places: dict[tuple[str, bool, bool], tuple[Unit, ast.Name]] = {}
        units = [one for one in self.reached(*routines) if not _declares_stand_ins(one)]
        for unit in sorted(units, key=lambda one: one.module.folder == FOLDER):
            answers = unit.checked.resolution.answers
            for name in sorted(answers, key=lambda one: one.span):
                answer = answers[name]
                if isinstance(answer, Found) and answer.symbol.kind in _INNER:
                    continue
                is_type = isinstance(answer, Found) and answer.symbol.kind in _TYPES
                is_declared = isinstance(answer, Found) and _is_project_file(answer.module)
                places.setdefault((name.key, is_type, is_declared), (unit, name))
        used = []
        for one in self.stand_ins:
            key = one.name.upper(), one.kind == "type", one.origin == "unset"
            if one.origin == "argument":  # a parameter of the routine that a run begins with
                used.append(one)
            elif key in places:
                unit, name = places[key]
                used.append(replace(one, path=unit.module.path, line=unit.line(name)))
        return tuple(used)

    def reached(self, *routines: Routine) -> tuple[Unit, ...]:
        """Return the files with these routines, and all files that they use, with their data lists.

        The files are in the order of the project.
        """
        reached: set[Module] = set()
        todo = [routine.unit for routine in routines]
        while todo:
            unit = todo.pop()
            if unit.module in reached:
                continue
            reached.add(unit.module)
            answers = unit.checked.resolution.answers.values()
            others = {one.module for one in answers if isinstance(one, Found)}
            data = self.project.data_of(unit.module)
            others.add(data)
            todo += [self.units[other] for other in others if other is not None]
        return tuple(unit for module, unit in self.units.items() if module in reached)

    def can_begin(self, routine: Routine) -> bool:
        """Return whether a program can begin with a routine.

        It can if the routine has no parameters and its result is no structure or array.
        """
        result = self.result_of(routine)
        return not routine.node.parameters and not isinstance(result, Structure | Array)

    def type_of(self, found: Found) -> Type:
        """Return the type of a variable or of a function's result; `UNKNOWN` if it is not known."""
        return self.project.types.of(found)

    def result_of(self, routine: Routine) -> Type | None:
        """Return the type of a function's result; ``None`` for a procedure."""
        if routine.node.result is None:
            return None
        return self.type_of(Found(routine.table.routine, self.project.scope(routine.unit.module)))

    def declaration(self, found: Found) -> Found:
        """Follow IMPORT declarations, and return the declaration that a name refers to [ADV-05].

        Raises `LinkError` if an import leads nowhere.
        """
        seen: set[Symbol] = set()
        while found.symbol.kind is Kind.IMPORT:
            answer = self.project.imported(found)
            symbol = found.symbol
            assert isinstance(symbol, ImportSymbol), "of that kind"
            is_whole = isinstance(symbol.source, ast.Variable) or _has_no_index(symbol.source)
            if symbol in seen or not is_whole or not isinstance(answer, Found):
                raise LinkError(f"the import of {symbol.name} leads nowhere")
            seen.add(symbol)
            found = answer
        return found


def _is_project_file(module: Module | None) -> bool:
    """Return whether a module is a file of the project itself, and no stand-in."""
    if module is None or module.folder == FOLDER:
        return False
    return module.table is None or not module.table.key.startswith(LIST_OF_ONE)


def _declares_stand_ins(unit: Unit) -> bool:
    """Return whether a file is the data list of all stand-ins, of which a run uses only some."""
    return unit.module.folder == FOLDER and unit.module.suffix == ".dat"


def _has_no_index(node: ast.Expression) -> bool:
    """Return whether an expression denotes a whole array, as ``NAME[]`` does."""
    return (
        isinstance(node, ast.Subscript)
        and isinstance(node.base, ast.Variable)
        and all(index is None for index in node.indices)
    )


@gc_paused()
def load(
    sources: Iterable[Source],
    main: str,
    *,
    strict: bool = True,
    stands_in: bool = False,
    unread: list[str] | None = None,
) -> CheckedProgram:
    """Link and type files, and return the program that begins with the file ``main``, a path.

    Only the project to which ``main`` belongs is loaded. With ``strict`` the project is checked.
    Without it, errors that the check would report are accepted: the statements concerned fail when
    they are reached. With ``stands_in`` the project gets stand-ins for names that none of its files
    declares, and a file with syntax errors is run as far as it can be read
    (`interp.standins.unreadable_lines`).

    Raises `LinkError` with the first error. If ``unread`` is given, other files that cannot be read
    are left out, and the reasons are added to that list.
    """
    by_path, files, wrong = _read_files(sources, stands_in=stands_in)
    for path, (error, found) in wrong.items():
        if found is None and (unread is None or path == main):
            raise error
        if unread is not None:
            unread += [str(error)] if found is None else found.reasons
    damaged = frozenset(path for path, (_, found) in wrong.items() if found is not None)
    for project in link(files).projects:
        if any(module.path == main for module in project.modules):
            whole = _checked(project, by_path, main, strict=strict, stands_in=stands_in)
            return replace(whole, damaged=damaged)
    raise LinkError(f"{main} is not among the files")


def load_all(
    sources: Iterable[Source], *, stands_in: bool = False
) -> tuple[tuple[CheckedProgram, ...], tuple[tuple[str, str], ...]]:
    """Link and type files of any number of projects.

    Return a program for each file with routines, loaded as by `load` without ``strict``, and a pair
    (path, reason) for each file that cannot be read. Each project is loaded once. Without
    ``stands_in``, a file that cannot be read is left out of its project.
    """
    by_path, files, wrong = _read_files(sources, stands_in=stands_in)
    programs: list[CheckedProgram] = []
    for project in link(files).projects:
        first = project.modules[0].path
        whole = _checked(project, by_path, first, strict=False, stands_in=stands_in)
        programs += [
            replace(whole, main=unit)
            for unit in whole.units.values()
            if unit.module.path in by_path and whole.routines_of(unit)
        ]
    return tuple(programs), tuple((path, str(error)) for path, (error, _) in wrong.items())


def _read_files(
    sources: Iterable[Source], *, stands_in: bool
) -> tuple[dict[str, Source], list[File], dict[str, tuple[LinkError, Readable | None]]]:
    """Return the sources by path, the files to link, and the errors by path.

    An error is paired with the readable part of its file if ``stands_in`` is set and there is one.
    """
    by_path = {source.path: source for source in sources}
    files: list[File] = []
    wrong: dict[str, tuple[LinkError, Readable | None]] = {}
    for path, source in by_path.items():
        try:
            files.append(File(path, _read(source)))
        except LinkError as error:
            found = readable(source) if stands_in else None
            wrong[path] = error, found
            if found is not None:
                by_path[path] = found.source
                files.append(File(path, found.syntax))
    return by_path, files, wrong


def _checked(
    project: Project, sources: Mapping[str, Source], main: str, *, strict: bool, stands_in: bool
) -> CheckedProgram:
    stand_ins: tuple[StandIn, ...] = ()
    if stands_in:
        if project.clashes:  # people keep copies beside their programs
            project = extended(project, (), takes_copies=True)
        whole = complete(project, sources)
        project, stand_ins = with_returns(whole.project), tuple(whole.stand_ins)
        sources = {**sources, **{source.path: source for source in whole.sources}}
    units = _units(project, sources, check_module if strict else typed_module)
    findings = [unit.checked.findings for unit in units.values()]
    files = Files.of((unit.source, unit.module.table) for unit in units.values())
    for one in check_project(findings, files) if strict else ():
        if one.severity == "error":
            where = "" if one.path == main else f"; it is in the project of {main}"
            raise LinkError(f"{one.path}:{one.region.line}: {one.code}: {one.message}{where}")
    first = next(unit for module, unit in units.items() if module.path == main)
    return CheckedProgram(project, first, units, strict, stand_ins)


def with_main(program: CheckedProgram, syntax: ast.Module) -> CheckedProgram:
    """Return a program with stand-ins after replacing the syntax tree of its main file."""
    path = program.main.module.path
    project = with_returns(extended(program.project, [File(path, syntax)]))
    sources = {unit.source.path: unit.source for unit in program.units.values()}
    units = _units(project, sources, typed_module)
    main = next(unit for unit in units.values() if unit.module.path == path)
    return replace(program, project=project, main=main, units=units)


def _units(
    project: Project,
    sources: Mapping[str, Source],
    known: Callable[[Project, Module, Source], Checked],
) -> dict[Module, Unit]:
    units: dict[Module, Unit] = {}
    for module in project.modules:
        source = sources[module.path]
        units[module] = Unit(module, source, known(project, module, source))
    return units


def _read(source: Source) -> ast.Module:
    found = read_module(source.text, source.path)
    if not isinstance(found, ast.Module):
        first = syntax_findings(found, source)[0]
        raise LinkError(f"{source.path}:{first.region.line}: {first.message}")
    if isinstance(found.content, ast.Program):
        for routine in found.content.routines:
            _check_blocks(source, routine)
    return found


def _check_blocks(source: Source, routine: ast.Routine) -> None:
    depths: dict[object, int] = {None: 0}
    for one in placed(routine.body):
        depths[one] = depths[one.inside] + 1
        if depths[one] > MOST_BLOCKS:
            line = source.place(one.statement.span[0])[0]
            raise LinkError(f"{source.path}:{line}: more than {MOST_BLOCKS} blocks are nested")
