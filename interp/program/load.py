"""Loading: files are read, linked and checked, and become a program that can run.

`load` gives all that an interpreter or a compiler needs of a project: its files with their trees
and the results of the checker, its routines by symbol, and the meaning of names. An error anywhere
in the project is a `LinkError`. A missing routine is no error: its call fails [SCO-10].
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import field, replace
from functools import cached_property, partial
from itertools import chain

from grammar.check.analysis.context import placed
from grammar.check.analysis.spelling import spelling_of
from grammar.check.project.framework import Checked, check_module, check_project, typed_module
from grammar.diagnostics.syntax_errors import syntax_findings
from grammar.semantics.link import File, Project, extended, link
from grammar.semantics.predefined import System
from grammar.semantics.scopes import Found, Module, Scope
from grammar.semantics.symbols import ImportSymbol, Kind, RoutineTable, Symbol
from grammar.semantics.types import Array, Structure, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from interp.standins.completion import LIST_OF_ONE, StandIn, complete
from interp.standins.missing_returns import with_returns
from interp.standins.unreadable_lines import Readable, readable
from interp.standins.uses import FOLDER
from interp.values.faults import BudgetExhausted, LinkError
from support.gc_pause import gc_paused
from support.lazy_dataclass import dataclass

_TYPES = frozenset({Kind.STRUCTURE, Kind.ENUMERATION, Kind.PLAIN_TYPE})
#: Blocks within blocks that are run: so many that nothing people write comes near, and so few that
#: an interpreter may use Python's own stack for them.
MOST_BLOCKS = 50


@dataclass(frozen=True, slots=True)
class Limits:
    """How much a program may do.

    ``statements`` until it counts as endless, ``per_slice`` until time has to pass, ``depth`` of
    calls until the stack overflows [SCO-12]. Where it ``skips_failures``, a statement that fails is
    reported as `interp.port.requests.Skip`, and the program continues after it.
    """

    statements: int = 10_000_000
    per_slice: int = 1_000
    depth: int = 64
    skips_failures: bool = False

    def exhausted(self) -> BudgetExhausted:
        """What is raised where one more statement would begin."""
        return BudgetExhausted(f"it has not ended after {self.statements:,} statements")


@dataclass(frozen=True, eq=False)
class Unit:
    """A file of the program with all that is known of it."""

    module: Module
    source: Source
    checked: Checked

    def line(self, node: ast.Node) -> int:
        """The line that a node begins in."""
        return self.source.place(node.span[0])[0]

    def found(self, name: ast.Name) -> Found | None:
        """What a name in this file means, if that is known."""
        return self.checked.resolution.found(name)

    @staticmethod
    def undeclared(name: ast.Name) -> str:
        """What to say of a line with a name that nothing declares, when a run comes to it."""
        return f"{name.text} is declared nowhere"


@dataclass(frozen=True, slots=True, eq=False)
class Routine:
    """A routine that can be called; ``scope`` is what is known inside it."""

    unit: Unit
    node: ast.Routine
    table: RoutineTable
    scope: Scope

    @property
    def name(self) -> str:
        """As declared."""
        return self.node.name.text


@dataclass(frozen=True, eq=False)
class CheckedProgram:
    """A project, and the file that it begins with; without errors if it ``is_strict``.

    ``stand_ins`` are those for all files of the project, see `used_stand_ins`. ``callers`` are the
    routines that were added to begin with one that has parameters, by its name in upper case.
    ``damaged`` are the paths of files with lines that cannot be read.
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
        """All routines by the symbols that names lead to."""
        return {
            one.table.routine: one for unit in self.units.values() for one in self.routines_of(unit)
        }

    def routines_of(self, unit: Unit) -> tuple[Routine, ...]:
        """The routines of a file in their order; none in a data list."""
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
        """The routine of a name in the first file, by default its first one.

        One that the first file has not may be the first of another file. Raises `LinkError` where
        there is none, or where it needs arguments.
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
        """The routines that a run begins with; raises `LinkError` as `start` does."""
        return [self.start(routine), *([self.start(submit)] if submit else [])]

    def used_stand_ins(self, *routines: Routine) -> tuple[StandIn, ...]:
        """The stand-ins that files reached from some routines use, in their order.

        Each is listed with its first use there, where a file of the project uses it.
        """
        if not self.stand_ins:
            return ()
        places: dict[tuple[str, bool, bool], tuple[Unit, ast.Name]] = {}
        units = [one for one in self.reached(*routines) if not _declares_stand_ins(one)]
        for unit in sorted(units, key=lambda one: one.module.folder == FOLDER):
            answers = unit.checked.resolution.answers
            for name in sorted(answers, key=lambda one: one.span):
                answer = answers[name]
                is_type = isinstance(answer, Found) and answer.symbol.kind in _TYPES
                is_declared = isinstance(answer, Found) and _is_own(answer.module)
                places.setdefault((name.key, is_type, is_declared), (unit, name))
        used = [
            (one, *places[key])
            for one in self.stand_ins
            if (key := (one.name.upper(), one.kind == "type", one.origin == "unset")) in places
        ]
        return tuple(
            one
            if unit.module.folder == FOLDER
            else replace(one, path=unit.module.path, line=unit.line(name))
            for one, unit, name in used
        )

    def reached(self, *routines: Routine) -> tuple[Unit, ...]:
        """The files that some routines lie in, and all that these use, with their data lists.

        They come in the order of the project's.
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
        """Whether a program can begin with a routine: no caller has to give or take values."""
        result = self.result_of(routine)
        return not routine.node.parameters and not isinstance(result, Structure | Array)

    def type_of(self, found: Found) -> Type:
        """The type of a variable, or of what a function gives; `UNKNOWN` where it is not known."""
        return self.project.types.of(found)

    def result_of(self, routine: Routine) -> Type | None:
        """The type of what a function gives; ``None`` for a procedure."""
        if routine.node.result is None:
            return None
        return self.type_of(Found(routine.table.routine, self.project.scope(routine.unit.module)))

    def declaration(self, found: Found) -> Found:
        """What a name means in the end, where it may be the name of an IMPORT [ADV-05].

        Raises `LinkError` where it leads nowhere.
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


def _is_own(module: Module | None) -> bool:
    """Whether it is a file of the project itself, and no stand-in."""
    if module is None or module.folder == FOLDER:
        return False
    return module.table is None or not module.table.key.startswith(LIST_OF_ONE)


def _declares_stand_ins(unit: Unit) -> bool:
    """Whether it is the data list of all stand-ins, most of which other programs may need."""
    return unit.module.folder == FOLDER and unit.module.suffix == ".dat"


def _has_no_index(node: ast.Expression) -> bool:
    """Whether it is a whole array, ``NAME[]``."""
    return (
        isinstance(node, ast.Subscript)
        and isinstance(node.base, ast.Variable)
        and all(index is None for index in node.indices)
    )


@gc_paused()
def load(
    sources: Iterable[Source],
    main: str,
    system: System | None = None,
    *,
    strict: bool = True,
    stands_in: bool = False,
    unread: list[str] | None = None,
) -> CheckedProgram:
    """Link and type files, of which ``main`` is the path of the one to begin with.

    Only the project that it belongs to counts. With ``strict`` it is checked; without, errors that
    the checker would find are no obstacle: what they are about fails when it is reached. With
    ``stands_in`` the project gets stand-ins for what none of its files has, and a file with syntax
    errors is run as far as it can be read (`interp.standins.unreadable_lines`). Raises `LinkError`
    with the first thing that is wrong; where ``unread`` is given, it receives why other files
    cannot be read, which then are left out.
    """
    by_path, files, wrong = _files(sources, stands_in=stands_in)
    for path, (error, found) in wrong.items():
        if found is None and (unread is None or path == main):
            raise error
        if unread is not None:
            unread += [str(error)] if found is None else found.reasons
    damaged = frozenset(path for path, (_, found) in wrong.items() if found is not None)
    for project in link(files, system).projects:
        if any(module.path == main for module in project.modules):
            whole = _checked(project, by_path, main, strict=strict, stands_in=stands_in)
            return replace(whole, damaged=damaged)
    raise LinkError(f"{main} is not among the files")


def load_all(
    sources: Iterable[Source], system: System | None = None, *, stands_in: bool = False
) -> tuple[tuple[CheckedProgram, ...], tuple[tuple[str, str], ...]]:
    """Link and type files of any number of projects; gives a program for each file with routines.

    It is loaded as without ``strict`` in `load`, each project once. A file that cannot be read is
    listed with the reason, after the programs; without ``stands_in`` it is left out of its project.
    """
    by_path, files, wrong = _files(sources, stands_in=stands_in)
    programs: list[CheckedProgram] = []
    for project in link(files, system).projects:
        first = project.modules[0].path
        whole = _checked(project, by_path, first, strict=False, stands_in=stands_in)
        programs += [
            replace(whole, main=unit)
            for unit in whole.units.values()
            if unit.module.path in by_path and whole.routines_of(unit)
        ]
    return tuple(programs), tuple((path, str(error)) for path, (error, _) in wrong.items())


def _files(
    sources: Iterable[Source], *, stands_in: bool
) -> tuple[dict[str, Source], list[File], dict[str, tuple[LinkError, Readable | None]]]:
    """The texts by path, the files of them, and the errors with what can be read all the same."""
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
        whole = complete(project, sources)
        project, stand_ins = with_returns(whole.project), tuple(whole.stand_ins)
        sources = {**sources, **{source.path: source for source in whole.sources}}
    units = _units(project, sources, check_module if strict else typed_module)
    texts = {unit.module.path: unit.source for unit in units.values()}
    files = {
        unit.module.path: (unit.module.table, partial(texts.__getitem__, unit.module.path))
        for unit in units.values()
    }
    findings = [unit.checked.findings for unit in units.values()]
    spelling = spelling_of(unit.source for unit in units.values())
    for one in check_project(findings, files.__getitem__, spelling) if strict else ():
        if one.severity == "error":
            raise LinkError(f"{one.path}:{one.region.line}: {one.message}")
    first = next(unit for module, unit in units.items() if module.path == main)
    return CheckedProgram(project, first, units, strict, stand_ins)


def with_main(program: CheckedProgram, source: Source) -> CheckedProgram:
    """A program in which things stand in, with another text of its first file."""
    project = with_returns(extended(program.project, [File(source.path, _read(source))]))
    sources = {unit.source.path: unit.source for unit in program.units.values()}
    units = _units(project, sources | {source.path: source}, typed_module)
    main = next(unit for unit in units.values() if unit.source is source)
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
