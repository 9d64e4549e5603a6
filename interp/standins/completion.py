"""Completes a project with stand-ins for all that it, and they in turn, use and do not contain.

Files of the project have priority: a stand-in is made only for a name that nothing declares. Names
in `library` are taken from there; for other names a declaration is derived from their uses.
Stand-ins are ordinary files, so executors and checks need not know about them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from pathlib import PurePosixPath
from typing import Final, Literal

from grammar.check.project.framework import Checked, typed_module
from grammar.semantics.link import File, Project, extended
from grammar.semantics.packages import load_packages
from grammar.semantics.resolve import resolve
from grammar.semantics.scopes import Found, Module
from grammar.semantics.symbols import Kind
from grammar.semantics.system_scope import SystemScope
from grammar.semantics.types import UNKNOWN, Enumeration, Scalar, Structure, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from grammar.syntax.walk import walk
from interp.robot.models.stand_in import Places
from interp.standins.default_values import DefaultValues
from interp.standins.derived_declarations import DerivedDeclarations
from interp.standins.derived_routines import derived_routine
from interp.standins.library import Datum, load_library
from interp.standins.unreadable_lines import COUNT, UNREADABLE
from interp.standins.unset_data import unset_data, with_values
from interp.standins.use_reader import read_uses
from interp.standins.uses import FOLDER, DataUse, Uses
from support.lazy_dataclass import dataclass

_LIST: Final = "STANDIN"
#: Begins the name of a data list that stands in for that of one program.
LIST_OF_ONE: Final = "LIST_"
_ROUNDS: Final = 4
#: At the end of a name: the value that variables of its type begin with, LDEFAULT for instance.
_DEFAULT: Final = "DEFAULT"
_MOST_SHOWN: Final = 8
_ORIGINS: Final = {
    "library": "from the library",
    "package": "by the signature of an option package",
    "signature": "derived from its uses",
    "place": "at a point that the arm can reach",
    "default": "with the controller's default",
    "argument": "as arguments of the first routine",
    "unset": "with a value that the project never sets",
    "unreadable": "in place of unreadable lines, which are left out,",
}
#: Where a stand-in comes from: our own version of it, the signature that its option package has,
#: that which follows from its uses, also of points, which get places of their own, or the
#: controller's default for data that $config.dat would declare; ``argument`` is a parameter of what
#: the program begins with, ``unset`` is declared and has no value, ``unreadable`` a line that
#: cannot be read.
Origin = Literal[
    "library", "package", "signature", "place", "default", "argument", "unset", "unreadable"
]
_Kind = Literal["routine", "variable", "type"]
_Places = dict[str, tuple[Module, ast.Name]]


@dataclass(frozen=True, slots=True)
class StandIn:
    """A name that no file declares: its kind, the origin of its stand-in, and its first use."""

    name: str
    kind: _Kind
    origin: Origin
    path: str
    line: int


@dataclass(frozen=True, slots=True)
class Completed:
    """A project with its stand-ins, and their texts."""

    project: Project
    sources: Sequence[Source]
    stand_ins: Sequence[StandIn]


@dataclass(slots=True)
class _Wanted:
    """The names that nothing declares, in upper case, with the places of their first uses."""

    data: _Places = field(default_factory=dict)
    routines: _Places = field(default_factory=dict)
    types: _Places = field(default_factory=dict)
    defaults: _Places = field(default_factory=dict)
    modules: list[Module] = field(default_factory=list)

    @property
    def is_empty(self) -> bool:
        """Whether there are no such names."""
        return not (self.data or self.routines or self.types or self.defaults)

    def take(self, project: Project, module: Module, syntax: ast.Module) -> None:
        """Add the undeclared names of one file."""
        resolution = resolve(project, module)
        scalars = _scalars(syntax)
        names = {
            Space.VALUE: self.data,
            Space.ROUTINE: self.routines,
            Space.TYPE: self.types,
        }
        is_wanting = bool(resolution.unknown_members)
        for use in resolution.open_uses:
            wanted = names.get(use.space) if use.space is not None else None
            if wanted is not None:
                wanted.setdefault(use.name.key, (module, use.name))
                is_wanting = True
        for name, answer in resolution.answers.items():
            if not isinstance(answer, Found):
                continue
            if not isinstance(answer.scope, SystemScope):
                is_wanting = is_wanting or _is_of_unknown_type(project, answer)
                continue
            if _is_of_config(answer):
                known = name.key in load_library().data
                is_other = name.key in scalars and not isinstance(project.types.of(answer), Scalar)
                is_wanting = is_wanting or is_other
                (self.data if known or is_other else self.defaults).setdefault(
                    name.key, (module, name)
                )
            elif answer.symbol.kind is Kind.ROUTINE and answer.symbol.given == UNKNOWN:
                self.routines.setdefault(name.key, (module, name))
                is_wanting = True
            elif answer.symbol.kind is Kind.VARIABLE and project.types.of(answer) == UNKNOWN:
                self.data.setdefault(name.key, (module, name))
                is_wanting = True
        if is_wanting:
            self.modules.append(module)


def _scalars(syntax: ast.Module) -> set[str]:
    """Return the names that count a loop or are assigned a number, so they are scalars.

    A $config.dat declares names that programs often use for their own scalars, I and J for
    instance.
    """
    found = set()
    for node in walk(syntax):
        if isinstance(node, ast.For):
            found.add(node.counter.key)
        elif (
            isinstance(node, ast.Assignment)
            and isinstance(node.target, ast.Variable)
            and isinstance(node.value, ast.IntegerLiteral | ast.RealLiteral | ast.BoolLiteral)
        ):
            found.add(node.target.name.key)
    return found


def _is_of_unknown_type(project: Project, found: Found) -> bool:
    """Return whether this is of a type that has a name and no declaration."""
    return found.symbol.type is not None and project.types.of(found) == UNKNOWN


def _is_of_config(found: Found) -> bool:
    """Return whether this denotes data of a $config.dat that the project does not have."""
    if not isinstance(found.scope, SystemScope) or found.symbol.kind is not Kind.VARIABLE:
        return False
    name = found.symbol.name
    return not name.startswith("$") and bool(found.scope.system.variables[name].file)


def complete(project: Project, sources: Mapping[str, Source]) -> Completed:
    """Add stand-ins to a project; ``sources`` are the texts of its files by path.

    A project that lacks nothing is returned unchanged.
    """
    unset = unset_data(project, sources)
    wanted = _Wanted()
    for module in project.modules:
        if module.syntax is not None:
            wanted.take(project, module, module.syntax)
    listed = _listed(wanted, sources)
    listed += tuple(_stand_in(one.name, "variable", "unset", one.module, sources) for one in unset)
    if not (unset or wanted.data or wanted.routines or wanted.types):
        return Completed(project, (), listed)
    places = Places([sources[one.path] for one in project.modules])
    texts: tuple[Source, ...] = ()
    if unset:
        project, texts = with_values(project, sources, unset, DefaultValues(places).usable)
        sources = {**sources, **{one.path: one for one in texts}}
    if not (wanted.data or wanted.routines or wanted.types):
        return Completed(project, texts, listed)
    made = _Making(project, wanted, places)
    for number in range(_ROUNDS):
        if not made.improve(sources, is_last=number == _ROUNDS - 1):
            break
    stand_ins = tuple(
        replace(one, origin="place") if one.name.upper() in made.placed else one for one in listed
    )
    return Completed(made.project, (*texts, *made.sources()), stand_ins)


def _listed(wanted: _Wanted, sources: Mapping[str, Source]) -> tuple[StandIn, ...]:
    if wanted.is_empty:
        return ()  # and no need to read the library
    library = load_library()
    found = []
    kinds: tuple[tuple[_Kind, _Places, Mapping[str, object]], ...] = (
        ("routine", wanted.routines, library.routines),
        ("type", wanted.types, library.types),
        ("variable", wanted.data, library.data),
    )
    for kind, names, known in kinds:
        for key, (module, name) in names.items():
            origin: Origin = "library" if key in known else "signature"
            if origin == "signature" and kind == "routine" and key in load_packages().routines:
                origin = "package"
            if key in (COUNT, UNREADABLE):
                origin = "unreadable"
            found.append(_stand_in(name, kind, origin, module, sources))
    for module, name in wanted.defaults.values():
        found.append(_stand_in(name, "variable", "default", module, sources))
    return tuple(found)


def _stand_in(
    name: ast.Name,
    kind: _Kind,
    origin: Origin,
    module: Module,
    sources: Mapping[str, Source],
) -> StandIn:
    line = sources[module.path].place(name.span[0])[0]
    return StandIn(name.text, kind, origin, module.path, line)


class _Making:
    """Creates stand-ins in rounds: each round knows the types that the previous one has found."""

    def __init__(self, project: Project, wanted: _Wanted, places: Places) -> None:
        self._original = project
        self._wanted = wanted
        self._places = places
        #: Variables that stand in as points, by name in upper case.
        self.placed: set[str] = set()
        self._texts: dict[str, str] = {}
        self._types: dict[str, str] = {}
        self._files: dict[tuple[str, str], File] = {}
        self._apart: set[tuple[str, str]] | None = None
        self._add_types_of_packages()
        self._add_library()
        self.project = self._linked()

    def sources(self) -> Iterator[Source]:
        """Yield the stand-ins as files."""
        for path, text in sorted(self._texts.items()):
            yield Source(text, path)

    def improve(self, sources: Mapping[str, Source], *, is_last: bool) -> bool:
        """Write declarations from what is known now; return whether another round is needed."""
        library, wanted = load_library(), self._wanted
        checked = [
            typed_module(self.project, module, sources[module.path]) for module in wanted.modules
        ]
        unknown = [name for name in wanted.types if name not in library.types]
        if self._apart is None:
            alone = self._uses(checked, (), self._has_no_list)
            self._apart = set(_ambiguous(alone))
        apart = self._apart
        uses = self._uses(checked, unknown, lambda module, name: (module.path, name) in apart)
        values = {
            datum.type: self._value(datum)
            for name, datum in library.data.items()
            if name.endswith(_DEFAULT)
        }
        defaults = DefaultValues(self._places)
        declarations = DerivedDeclarations(
            self._enumerations(), self._type, values, defaults, self._types, unknown
        )
        before = dict(self._texts)
        for name in unknown:
            declarations.type(name, uses.types[name])
        for name, routine in uses.routines.items():
            known = load_packages().routines.get(name)
            self._texts[_path(name)] = derived_routine(name, routine, declarations, known)
        data = [
            line
            for name, use in uses.data.items()
            for line in declarations.data(name, use, is_last=is_last)
        ]
        self._add_own_lists(declarations, uses, is_last=is_last)
        self._texts[_data_path()] = self._data_list(declarations, data)
        self.placed = defaults.placed
        if self._texts == before and not is_last:
            return True
        self.project = self._linked()
        return not is_last

    def _uses(
        self,
        checked: Sequence[Checked],
        types: Sequence[str],
        is_apart: Callable[[Module, str], bool],
    ) -> Uses:
        """Return the uses of names that neither a file nor the library declares."""
        library, wanted = load_library(), self._wanted
        uses = Uses(
            [name for name in wanted.data if name not in library.data],
            [name for name in wanted.routines if name not in library.routines],
            types,
        )
        read_uses(uses, self.project, checked, is_apart)
        return uses

    def _has_no_list(self, module: Module, _name: str) -> bool:
        """Return whether the data list of a program is missing; it may have declared anything."""
        return module.suffix != ".dat" and self._original.data_of(module) is None

    def _add_own_lists(
        self, declarations: DerivedDeclarations, uses: Uses, *, is_last: bool
    ) -> None:
        """Add data lists for missing ones, with the variables whose types differ by program."""
        lines: dict[str, list[str]] = {}
        for (path, name), use in uses.apart.items():
            declarations.owner = path
            lines.setdefault(f"{path.rpartition('.')[0]}.dat", []).extend(
                declarations.data(name, use, is_last=is_last, access="")
            )
        for path, declared in lines.items():
            name = re.sub(r"\W", "_", PurePosixPath(path).stem, flags=re.ASCII)
            self._texts[path] = "\n".join([f"DEFDAT {LIST_OF_ONE}{name}", *declared, "ENDDAT", ""])

    # ------------------------------------------------------------------------- the library

    def _add_types_of_packages(self) -> None:
        """Add the undeclared types of parameters and results of package routines."""
        packages = load_packages()
        for name, place in self._wanted.routines.items():
            known = packages.routines.get(name)
            if known is None:
                continue
            for type_ in (known.result, *(one.type for one in known.parameters)):
                if type_ in packages.types and self._type(type_) is None:
                    self._wanted.types.setdefault(type_, place)

    def _add_library(self) -> None:
        """Add the library routines that are used, and everything that they use."""
        library, wanted = load_library(), self._wanted
        known: set[str] = set()
        while known != set(wanted.routines):
            known = set(wanted.routines)
            for name in known & set(library.routines):
                self._texts[_path(name)] = library.routines[name]
            project = self._linked()
            inner = _Wanted()
            for module in project.modules:
                if module.folder == FOLDER and module.syntax is not None:
                    inner.take(project, module, module.syntax)
            for mine, more in (
                (wanted.routines, inner.routines),
                (wanted.data, inner.data),
                (wanted.types, inner.types),
            ):
                for name in more:
                    if name in library.routines or name in library.data or name in library.types:
                        mine.setdefault(name, self._first_use())
        self._texts[_data_path()] = self._data_list(None, [])

    def _first_use(self) -> tuple[Module, ast.Name]:
        return next(iter((self._wanted.routines | self._wanted.data).values()))

    def _data_list(self, declarations: DerivedDeclarations | None, lines: Sequence[str]) -> str:
        library = load_library()
        texts = [library.types[one] for one in self._wanted.types if one in library.types]
        if declarations is not None:
            texts += declarations.types.values()
        for name in self._wanted.data:
            datum = library.data.get(name)
            if datum is not None:
                texts.append(f"DECL GLOBAL {datum.type} {name}={self._value(datum)}")
        return "\n".join([f"DEFDAT {_LIST} PUBLIC", *texts, *lines, "ENDDAT", ""])

    def _value(self, datum: Datum) -> str:
        """Return the value of a library variable, with the members that its type has here."""
        type_ = self._type(datum.type)
        if datum.members is None or not isinstance(type_, Structure):
            return datum.value
        known = {member.name.upper() for member in type_.members}
        return f"{{{','.join(text for name, text in datum.members.items() if name in known)}}}"

    # ------------------------------------------------------------------------- the project

    def _linked(self) -> Project:
        texts = sorted(self._texts.items())
        for path, text in texts:
            if (path, text) not in self._files:
                syntax = read_module(text, path)
                assert isinstance(syntax, ast.Module), f"stand-ins can be read: {syntax}"
                self._files[path, text] = File(path, syntax)
        return extended(self._original, [self._files[one] for one in texts])

    def _type(self, name: str) -> Type | None:
        project = getattr(self, "project", self._original)
        found = project.scope(project.modules[0]).find(Space.TYPE, name.upper())
        return project.types.of(found) if isinstance(found, Found) else None

    def _enumerations(self) -> Iterator[Enumeration]:
        for module in self.project.modules:
            if module.table is None or module.folder == FOLDER:
                continue
            for space, symbol in module.table.table.symbols():
                if space is Space.TYPE and symbol.kind is Kind.ENUMERATION:
                    found = self._type(symbol.key)
                    if isinstance(found, Enumeration):
                        yield found


def _ambiguous(uses: Uses) -> Iterator[tuple[str, str]]:
    """Yield variables by file and name whose files cannot mean one and the same by that name.

    Such files use it as of different types, or ask it for different numbers while none assigns it.
    """
    by_name: dict[str, list[tuple[str, DataUse]]] = {}
    for (path, name), use in uses.apart.items():
        by_name.setdefault(name, []).append((path, use))
    for name, places in by_name.items():
        every = [uses.data[name], *(use for _, use in places)]
        sorts = {(sort, bool(use.indices)) for use in every for sort in _sort(use)}
        asked_for = {use.asked_for for use in every if use.asked_for}
        is_constant = not any(use.is_assigned for use in every)
        if len(sorts) > 1 or (is_constant and len(asked_for) > 1):
            yield from ((path, name) for path, _ in places)


def _sort(use: DataUse) -> Iterator[str]:
    """Yield the kind of type of a variable, if it is certain."""
    if use.is_text:
        yield "text"
        return
    for type_ in use.types[:1]:
        match type_:
            case Scalar(name=name):
                yield "number" if name in ("INT", "REAL") else name
            case Structure():
                yield "structure"
            case Enumeration(name=name):
                yield name.upper()
    if use.members or use.motions:
        yield "structure"


def _path(name: str) -> str:
    return f"{FOLDER}/{name}.src"


def _data_path() -> str:
    return f"{FOLDER}/{_LIST}.dat"


def summary(stand_ins: Sequence[StandIn]) -> str:
    """Return one line that lists the stand-ins by origin, each with its first use."""
    parts = []
    for origin, words in _ORIGINS.items():
        some = [one for one in stand_ins if one.origin == origin]
        shown = [f"{one.name} ({one.path.rpartition('/')[2]}:{one.line})" for one in some]
        more = [f"{len(shown) - _MOST_SHOWN} more"] if len(shown) > _MOST_SHOWN else []
        if shown:
            parts.append(f"{words} {', '.join(shown[:_MOST_SHOWN] + more)}")
    return "; ".join(parts)
