"""Linking: which names each file of a project sees.

`link` takes the files of a call, and returns a `Workspace` of `Project`s, which see nothing of one
another. `grammar.semantics.project_grouping` says what a project is; files outside a controller
are one for each origin, if they do not have several $CONFIG lists.

Within a project, a `.src` or `.sub` file and the `.dat` file of the same name in the same folder
are one module [SCO-01]. Visible everywhere are the first routine of a file, routines declared
GLOBAL, GLOBAL declarations in a PUBLIC data list, and everything in the controller's own data
lists, whose names begin with a dollar sign [SCO-04].

To get a scope: ``project.scope(module)`` for a file, ``project.scope(module, routine)`` for one of
``module.table.routines``; then ``scope.find(Space.VALUE, "NAME")``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cache, cached_property
from itertools import chain
from pathlib import PurePosixPath

from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.declared_types import DeclaredTypes
from grammar.semantics.package_scope import PackageScope, called_packages
from grammar.semantics.packages import load_packages
from grammar.semantics.predefined import System
from grammar.semantics.project_grouping import grouped
from grammar.semantics.project_scope import Globals, PartlyRead, nearest
from grammar.semantics.scopes import (
    REST,
    Answer,
    Found,
    Module,
    NotFound,
    Outer,
    Reason,
    Scope,
    Undetermined,
)
from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import Access, ImportSymbol, Kind, ModuleTable, RoutineTable, Symbol
from grammar.semantics.system_scope import SystemScope
from grammar.syntax import ast
from grammar.syntax.references import Space
from support.lazy_dataclass import dataclass

#: Names with this many equal first letters are taken to belong together.
SHARED = 5


@dataclass(frozen=True, slots=True)
class File:
    """A file to link. ``path`` has ``/``; files of different origins never share a project.

    A file that cannot be read has neither ``syntax`` nor ``table``, but its presence still matters.
    ``words`` are the names in its unreadable part (`names_in_text`), because it cannot declare any
    others. ``table`` may come from a cache, since it depends on the content alone; a file with a
    table and no ``syntax`` can be referred to.
    """

    path: str
    syntax: ast.Module | None
    origin: str = ""
    table: ModuleTable | None = None
    words: frozenset[str] | None = None


@dataclass(frozen=True, slots=True)
class Clash:
    """Several declarations of one name, all of which are visible everywhere."""

    space: Space
    declarations: tuple[Found, ...]


class Project:
    """The files of one controller. ``root`` is their common folder.

    ``is_controller`` says that the files are laid out like a controller's drive. ``is_complete``
    says that a name without a declaration is certainly undeclared. ``clashes`` are names with
    several global declarations; outside a controller's drive these may just be copies. ``types``
    are the types of the symbols. ``has_config`` says that the $CONFIG list is present and readable
    to its end, and that there are files outside its folder.
    """

    def __init__(
        self,
        root: str,
        is_controller: bool,
        modules: Sequence[Module],
        system: SystemScope,
        is_complete: bool | None,
        packages: frozenset[str] | None = None,
        *,
        takes_copies: bool = False,
    ) -> None:
        self.root = root
        self.takes_copies = takes_copies
        self.system = system
        self.is_controller = is_controller
        self.modules = tuple(modules)
        self._data = {_place(module): module for module in modules if module.suffix == ".dat"}
        self._lists: dict[str, list[Module]] = {}
        for module in self._data.values():
            self._lists.setdefault(module.name, []).append(module)
        self._scopes: dict[ModuleTable, Scope] = {}
        self._inner: dict[RoutineTable, Scope] = {}
        self._names: dict[Space, dict[str, list[Found]]] = {space: {} for space in Space}
        self._hidden: dict[Space, dict[str, Found]] = {space: {} for space in Space}
        self._gap: dict[Space, Reason] = {}
        unread = {space: _words_in_unread(modules, space) for space in Space}
        self._globals = Globals(self._names, self._hidden, self._gap, unread, system, takes_copies)
        self._collect()
        if is_complete is None:
            is_complete = _has_all(modules) and not any(map(self._misses, modules))
        self.is_complete = is_complete
        self.packages = packages
        if packages is not None:
            self.packages = packages | called_packages(self._undeclared_calls())
            self._add_packages(self.packages)
        self._gap.update(_gap(modules, is_complete))
        self.types = DeclaredTypes()
        config = [one for one in modules if _is_config(one) and one.table and not one.is_cut]
        self.has_config = bool(config) and not all(map(_is_in_system, modules))
        self.clashes = tuple(
            Clash(space, tuple(found))
            for space, names in self._names.items()
            for found in names.values()
            if len(found) > 1
        )

    def scope(self, module: Module, routine: RoutineTable | None = None) -> Scope:
        """Return the scope of a readable file, or of one of its routines."""
        assert module.table is not None, "nothing is known of a file that cannot be read"
        scope = self._scopes.get(module.table)
        if scope is None:
            scope = self._scopes[module.table] = self._scope(module, module.table)
        if routine is None:
            return scope
        inner = self._inner.get(routine)
        if inner is None:
            # scope.module, because the argument may hold a tree, which must not be kept alive
            inner = self._inner[routine] = Scope(scope.module, routine, routine.table, scope)
        return inner

    def forget(self) -> None:
        """Clear scopes and look-up results, which form reference cycles.

        Otherwise they stay in memory until a garbage collection, which has to visit all of them.
        """
        for scope in (*self._scopes.values(), *self._inner.values()):
            scope.forget()
        self._globals.forget()

    def data_of(self, module: Module) -> Module | None:
        """Return the data list that belongs to a program, whether it is readable or not."""
        return None if module.suffix == ".dat" else self._data.get(_place(module))

    @cached_property
    def typos(self) -> Mapping[Space, Typos]:
        """The names that are visible everywhere, by space, as an index for misspellings."""
        made = {}
        for space, names in self._names.items():
            known = [found[0] for found in names.values()]
            system = _system_typos(self._globals.system.system, space)
            digits = (one.symbol.name for one in known if not one.module)
            made[space] = Typos(digits, series=Series.DIGITS, known=system)
            made[space].add((one.symbol.name for one in known if one.module), Series.LETTERS)
        return made

    @cached_property
    def without_data(self) -> Set[str]:
        """Prefixes, up to `SHARED` letters, of the names of programs that have no data list."""
        lacking = (one for one in self.modules if one.suffix != ".dat" and not self.data_of(one))
        return {one.name[:length] for one in lacking for length in range(1, SHARED + 1)}

    def imported(self, found: Found) -> Answer:
        """Return the variable that an IMPORT refers to; its data list has to be PUBLIC [ADV-05]."""
        symbol, module = found.symbol, found.module
        assert isinstance(symbol, ImportSymbol), "only an IMPORT stands for something else"
        assert module is not None, "the controller imports nothing"
        source = symbol.source
        while isinstance(source, ast.Subscript | ast.Member):
            source = source.base
        key = source.name.key if isinstance(source, ast.Variable) else ""
        lists = [other for other in self._lists.get(symbol.module, ()) if other.table]
        there = [self.scope(other).own(Space.VALUE, key) for other in lists]
        seen = [found for found in there if found and _is_public(found)]
        if seen:
            return nearest(seen, module.folder)
        reason = self._gap.get(Space.VALUE)
        if reason is not None and not lists:
            return Undetermined(reason)
        return NotFound(next(filter(None, there), None))

    def _scope(self, module: Module, table: ModuleTable) -> Scope:
        outer: Outer = self._globals.near(module.folder)
        data = self.data_of(module)
        if data is not None:
            outer = self.scope(data) if data.table else PartlyRead(outer, data.words)
        if module.words:
            outer = PartlyRead(outer, module.words)
        return Scope(module, None, table.table, outer, table.externals)

    def _misses(self, module: Module) -> bool:
        """Return whether a module calls a routine that nothing declares or announces."""
        if module.table is None:
            return False
        find = self.scope(module).find
        return any(not isinstance(find(Space.ROUTINE, key), Found) for key in module.table.calls)

    def _undeclared_calls(self) -> Iterator[str]:
        """Yield the called routines that no file declares globally."""
        names = self._names[Space.ROUTINE]
        for module in self.modules:
            if module.table is not None:
                yield from (key for key in module.table.calls if key not in names)

    def _add_packages(self, packages: frozenset[str]) -> None:
        """Add the declarations of option packages as global ones, where no file has the name."""
        for space, found in PackageScope(packages, self._globals.near("")).all():
            self._names[space].setdefault(found.symbol.key, [found])

    def _collect(self) -> None:
        """Sort the declarations of all modules into those visible everywhere and all others."""
        announced: list[Found] = []
        for module in self.modules:
            if module.table is None:
                continue
            scope = self.scope(module)
            is_list = module.suffix == ".dat"
            for space, symbol in module.table.table.symbols():
                found = scope.own(space, symbol.key)
                assert found is not None, "a scope has what its table has"
                if not _is_exported(symbol, module):
                    self._hidden[space].setdefault(symbol.key, found)
                elif symbol.kind is Kind.EXTERNAL or (space is Space.ROUTINE and is_list):
                    announced.append(found)
                else:
                    self._names[space].setdefault(symbol.key, []).append(found)
        for found in announced:  # EXT and EXTP in a data list: a declaration elsewhere has priority
            key = found.symbol.key
            if not isinstance(self._globals.system.find(Space.ROUTINE, key), Found):
                self._names[Space.ROUTINE].setdefault(key, [found])


@dataclass(frozen=True, slots=True)
class Workspace:
    """All projects of a call, sorted by their roots; every file belongs to exactly one."""

    projects: tuple[Project, ...]

    def modules(self) -> Iterator[tuple[Project, Module]]:
        """Yield all files with their projects."""
        for project in self.projects:
            for module in project.modules:
                yield project, module


def link(
    files: Iterable[File],
    system: System | None = None,
    is_complete: bool | None = None,
    packages: frozenset[str] | None = None,
    before: Workspace | None = None,
) -> Workspace:
    """Return the files grouped into projects. Linear in the number of files and declarations.

    ``system`` is what the controller declares, the same for all projects; by default the
    declarations of all releases. ``is_complete`` says whether all files are present. If it is
    ``None``, a project counts as complete when it has the files that every backup has and calls no
    unknown routine: a missing package may declare data as well as routines. ``packages`` are option
    packages that are installed besides those whose routines are called; with ``None``, package
    names are not declared at all. Projects whose files did not change are taken over from
    ``before``, which must have been linked with the same options.
    """
    projects, scope = [], SystemScope(system or System.load())
    known = {one.modules[0].path: one for one in before.projects} if before else {}
    by_origin: dict[str, list[File]] = defaultdict(list)
    for file in files:
        by_origin[file.origin].append(file)
    groups = (grouped(by_origin[origin]) for origin in sorted(by_origin))
    for root, is_controller, members in chain.from_iterable(groups):
        project = known.get(members[0].path)
        if project is None or not _is_of(members, project) or root != project.root:
            modules = [_module(file) for file in members]
            project = Project(root, is_controller, modules, scope, is_complete, packages)
        projects.append(project)
    return Workspace(tuple(projects))


def _is_of(files: Sequence[File], project: Project) -> bool:
    """Return whether a project consists of exactly these files with the same content."""
    return len(files) == len(project.modules) and all(
        file.path == one.path and file.table is one.table and file.words is one.words
        for file, one in zip(files, project.modules, strict=True)
    )


def extended(
    project: Project, files: Iterable[File], *, takes_copies: bool | None = None
) -> Project:
    """Return the project with more files; a file replaces the one with the same path.

    ``takes_copies`` says whether one of several equally near declarations of a name is taken.
    """
    by_path = {module.path: module for module in project.modules}
    by_path |= {file.path: _module(file) for file in files}
    modules = list(by_path.values())
    return Project(
        project.root,
        project.is_controller,
        modules,
        project.system,
        project.is_complete,
        project.packages,
        takes_copies=project.takes_copies if takes_copies is None else takes_copies,
    )


# ------------------------------------------------------------------------------------- modules


def _module(file: File) -> Module:
    path = PurePosixPath(file.path.replace("\\", "/"))
    table = file.table
    if table is None and file.syntax is not None:
        table = table_of(file.syntax)
    folder, suffix = path.parent.as_posix(), path.suffix.lower()
    return Module(file.path, folder, path.stem.upper(), suffix, table, file.syntax, file.words)


def _place(module: Module) -> tuple[str, str]:
    """Return a key that is the same for a program and its data list."""
    return module.folder.casefold(), module.name


def _is_exported(symbol: Symbol, module: Module) -> bool:
    """Return whether a top-level symbol is visible everywhere.

    The routine with the name of the file is, even if it wrongly is not the first one.
    """
    return symbol.access is Access.GLOBAL or (
        symbol.kind is Kind.ROUTINE and symbol.key == module.name and module.suffix != ".dat"
    )


def _is_config(module: Module) -> bool:
    return module.name == "$CONFIG" and module.suffix == ".dat"


@cache
def _system_typos(system: System, space: Space) -> Typos:
    packages = load_packages()
    installed = {Space.ROUTINE: packages.routines, Space.VALUE: packages.variables}
    names = (*SystemScope(system).names(space), *installed.get(space, ()))
    return Typos(names, series=Series.DIGITS)


def _is_in_system(module: Module) -> bool:
    return module.folder.casefold().rpartition("/")[2] == "system"


def _is_public(found: Found) -> bool:
    table = found.module.table if found.module else None
    return table is not None and (table.is_public or table.is_system)


def _gap(modules: Sequence[Module], is_complete: bool) -> dict[Space, Reason]:
    """Return for each space why a name without a declaration may be declared all the same."""
    everything = [Space.VALUE, Space.ROUTINE, Space.TYPE, Space.CHANNEL]
    gap = {} if is_complete else dict.fromkeys(everything, Reason.MODULES_MISSING)
    if not any(module.name == "$CUSTOM" for module in modules):  # it is in no backup of R1 alone
        gap[Space.CHANNEL] = Reason.MODULES_MISSING
    for module in modules:
        if module.table is None and module.words is None:
            spaces = everything if module.suffix == ".dat" else [Space.ROUTINE]
            gap |= dict.fromkeys(spaces, Reason.UNREADABLE)
    return gap


def _words_in_unread(modules: Sequence[Module], space: Space) -> frozenset[str]:
    """Return the words of unreadable files that may declare global names of a space."""
    is_data = space is not Space.ROUTINE
    some = [one for one in modules if one.words and (not is_data or one.suffix == ".dat")]
    words = frozenset[str]().union(*(one.words or () for one in some)) - {REST}
    is_cut = any(one.is_cut and (not is_data or _may_be_public(one)) for one in some)
    return words | {REST} if is_cut else words


def _may_be_public(module: Module) -> bool:
    table = module.table
    return table is None or table.is_public or table.is_system or module.is_head_unread(table.key)


def _has_all(modules: Sequence[Module]) -> bool:
    """Return whether the files that every backup of a controller has are present."""
    lists = {module.table.key for module in modules if module.table and module.table.is_system}
    return {"$CONFIG", "$MACHINE"} <= lists and any(module.name == "BAS" for module in modules)
