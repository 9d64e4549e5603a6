"""Scopes, and the possible answers of a look-up.

Scopes are nested: a routine (parameters, local data), its program (the routines of the file), the
data list of the same name [SCO-05], everything GLOBAL in the project [SCO-04], the controller
itself. The innermost declaration counts, so a local name shadows a global one.

A look-up answers `Found`, `NotFound` or `Undetermined`. The last one is the answer if the files
at hand cannot decide it: a single file without its $CONFIG, a module with syntax errors, a call of
a missing package; `Reason` says which. A check may rely on `Found` and `NotFound` and must report
nothing for `Undetermined`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from enum import Enum
from typing import Protocol

from grammar.semantics.predefined import PredefinedFunction, PredefinedParameter, System
from grammar.semantics.symbols import (
    Access,
    Kind,
    ModuleTable,
    ParameterSymbol,
    RoutineSymbol,
    RoutineTable,
    Symbol,
    Table,
    TypeSymbol,
)
from grammar.semantics.types import SCALARS, Array, Enumeration, Scalar, Structure, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from support.lazy_dataclass import dataclass, node

#: A marker among the words of a file: its end is missing, so it may declare any name.
REST = "*"


@dataclass(frozen=True, slots=True, eq=False)
class Module:
    """A file of a project.

    ``path`` is as it was given, with ``/``. ``name`` is the file name without its suffix, in upper
    case; ``suffix`` is in lower case. ``table`` is ``None`` if the file cannot be read. ``syntax``
    is also ``None`` for a file that is only referred to, whose table is enough. ``words`` are the
    names in its unreadable part, if these are known.
    """

    path: str
    folder: str
    name: str
    suffix: str
    table: ModuleTable | None
    syntax: ast.Module | None
    words: frozenset[str] | None = None

    @property
    def is_cut(self) -> bool:
        """Whether the end of the file is missing."""
        return self.words is not None and REST in self.words

    def is_head_unread(self, key: str) -> bool:
        """Return whether the line that begins this routine, data list or type cannot be read.

        That line may contain PUBLIC, or other parameters or members.
        """
        return self.words is not None and key in self.words

    @property
    def is_misnamed(self) -> bool:
        """Whether the first routine or data list has another name than the file [SCO-01].

        A missing dollar sign does not count: tools that copy files of the controller drop it.
        """
        if self.table is None or self.table.key == self.name:
            return False
        return not (self.table.is_system and self.table.key == f"${self.name}")


class Reason(Enum):
    """Why a look-up has no definite answer."""

    MODULES_MISSING = "not every module of the controller is here"
    UNREADABLE = "a module that may declare it cannot be read"
    AMBIGUOUS = "several modules declare it, none nearer than the others, or a line may too"
    SYSTEM = "the controller may know it: system variables and packages differ between releases"


@node
class Found:
    """The symbol that a name means, and the scope that declares it.

    Names in the declaration, such as that of its type, have to be looked up in that scope.
    """

    symbol: Symbol
    scope: Scope

    @property
    def module(self) -> Module | None:
        """The file that declares the symbol; ``None`` if the controller predefines it."""
        return self.scope.module

    @property
    def is_open(self) -> bool:
        """Whether a type may have members that are not known, as part of its line is unreadable."""
        if isinstance(self.symbol, TypeSymbol) and self.symbol.is_open:
            return True
        return self.module is not None and self.module.is_head_unread(self.symbol.key)

    def type_symbol(self) -> Answer | None:
        """Return the answer for the symbol's type name; ``None`` if it has none.

        For an array it is the type of its elements.
        """
        written, given = self.symbol.type, self.symbol.given
        if written is not None:
            return self.scope.find(Space.TYPE, written.key)
        if isinstance(given, Array):
            given = given.element
        if isinstance(given, Structure | Enumeration | Scalar):
            return self.scope.find(Space.TYPE, given.name.upper())
        return None


@dataclass(frozen=True, slots=True)
class NotFound:
    """Nothing has that name. ``hidden`` is a declaration that is not visible from here."""

    hidden: Found | None = None


@dataclass(frozen=True, slots=True)
class Undetermined:
    """No declaration at hand is the right one for certain; one may exist elsewhere."""

    reason: Reason
    candidates: tuple[Found, ...] = ()


Answer = Found | NotFound | Undetermined


class Outer(Protocol):
    """The enclosing scope, which is asked for names that a scope does not declare."""

    def find(self, space: Space, key: str) -> Answer:
        """Look up a name, given in upper case."""


class Scope:
    """The names that are visible in one place.

    ``module`` is ``None`` for the controller itself, ``routine`` is ``None`` outside a routine.
    """

    __slots__ = ("_externals", "_memory", "_outer", "_table", "module", "routine")

    def __init__(
        self,
        module: Module | None,
        routine: RoutineTable | None,
        table: Table,
        outer: Outer,
        externals: Mapping[str, Symbol] | None = None,
    ) -> None:
        self.module = module
        self.routine = routine
        self._table = table
        self._outer = outer
        self._externals = externals or {}
        self._memory: dict[tuple[Space, str], Found] = {}

    def find(self, space: Space, key: str) -> Answer:
        """Return the meaning of a name in upper case; the same `Found` object each time."""
        known = self._memory.get((space, key))
        if known is not None:
            return known
        answer = self._answer(space, key)
        if isinstance(answer, Found):
            self._memory[space, key] = answer
        return answer

    def forget(self) -> None:
        """Clear the cached answers, which refer back to this scope."""
        self._memory.clear()

    def own(self, space: Space, key: str) -> Found | None:
        """Return the symbol with that name if this scope itself declares it."""
        symbol = self._table.find(space, key)
        return self._here(space, key, symbol) if symbol else None

    def shadowed(self) -> Iterator[tuple[Found, Found]]:
        """Yield each symbol of this scope that hides one of an outer scope, with that one."""
        for space, symbol in self._table.symbols():
            if space is not Space.LABEL and symbol.kind is not Kind.EXTERNAL:
                outer = self._outer.find(space, symbol.key)
                if isinstance(outer, Found):
                    yield self._here(space, symbol.key, symbol), outer

    def _here(self, space: Space, key: str, symbol: Symbol) -> Found:
        known = self._memory.get((space, key))
        if known and known.symbol is symbol:
            return known
        found = Found(symbol, self)
        if symbol.kind is not Kind.EXTERNAL:
            self._memory[space, key] = found
        return found

    def _answer(self, space: Space, key: str) -> Answer:
        symbol = self._table.find(space, key)
        if symbol is not None and symbol.kind is not Kind.EXTERNAL:
            return self._here(space, key, symbol)
        if space is Space.LABEL:
            return NotFound()
        outer = self._outer.find(space, key)
        if space is Space.ROUTINE:
            # EXT announces a routine of another module; its own declaration has priority.
            announced = symbol or self._externals.get(key)
            if announced is not None and not isinstance(outer, Found):
                return Found(announced, self)
        return outer


class SystemScope(Scope):
    """What the controller predefines; symbols are created on demand.

    The entry for a symbol has the same name in `System.variables`, `System.functions` or
    `System.types`.
    """

    __slots__ = ("system",)

    def __init__(self, system: System) -> None:
        super().__init__(None, None, Table({space: {} for space in Space}, ()), self)
        self.system = system

    def names(self, space: Space) -> Iterable[str]:
        """Return all names that the controller predefines in a space."""
        match space:
            case Space.VALUE:
                return ("TRUE", "FALSE", *self.system.variables)
            case Space.ROUTINE:
                return self.system.functions
            case Space.TYPE:
                return (*SCALARS, *self.system.types)
            case Space.CHANNEL:
                return self.system.channels
        return ()

    def own(self, space: Space, key: str) -> Found | None:
        """Return the symbol with that name if the controller predefines it."""
        answer = self.find(space, key)
        return answer if isinstance(answer, Found) else None

    def _answer(self, space: Space, key: str) -> Answer:
        symbol = self._symbol(space, key)
        return Found(symbol, self) if symbol else NotFound()

    def _symbol(self, space: Space, key: str) -> Symbol | None:
        if space is Space.VALUE and key in self.system.variables:
            variable = self.system.variables[key]
            return _given(Kind.VARIABLE, variable.name, variable.type)
        if space is Space.ROUTINE and key in self.system.functions:
            return _routine(self.system.functions[key])
        if space is Space.CHANNEL and key in self.system.channels:
            return _given(Kind.CHANNEL, self.system.channels[key], None)
        if space is Space.TYPE:
            if key in SCALARS:
                return _type(key, SCALARS[key])
            if key in self.system.types:
                return _type(key, self.system.types[key])
        return None


def _given(kind: Kind, name: str, type_: Type | None) -> Symbol:
    return Symbol(kind, name, _NO_SPAN, Access.GLOBAL, given=type_)


def _routine(function: PredefinedFunction) -> RoutineSymbol:
    def parameter(known: PredefinedParameter) -> ParameterSymbol:
        return ParameterSymbol(
            Kind.PARAMETER, known.name, _NO_SPAN, Access.ROUTINE, given=known.type, mode=known.mode
        )

    return RoutineSymbol(
        Kind.ROUTINE,
        function.name,
        _NO_SPAN,
        Access.GLOBAL,
        given=function.result,
        parameters=tuple(map(parameter, function.parameters)),
        more=parameter(function.more) if function.more is not None else None,
    )


def _type(key: str, type_: Type) -> TypeSymbol:
    kind, members, is_open = Kind.PLAIN_TYPE, dict[str, Symbol](), False
    if isinstance(type_, Structure):
        kind, is_open = Kind.STRUCTURE, type_.is_open
        for member in type_.members:
            members[member.name.upper()] = _given(Kind.MEMBER, member.name, member.type)
    elif isinstance(type_, Enumeration):
        kind, is_open = Kind.ENUMERATION, type_.is_open
        for name in type_.constants:
            members[name.upper()] = _given(Kind.ENUM_CONSTANT, name, type_)
    name = type_.name if isinstance(type_, Structure | Enumeration) else key
    return TypeSymbol(
        kind, name, _NO_SPAN, Access.GLOBAL, given=type_, members=members, is_open=is_open
    )


_NO_SPAN = (0, 0)


@dataclass(frozen=True, slots=True, eq=False)
class Globals:
    """The names that are visible in a whole project, and beyond it the controller's.

    ``names`` can have several declarations of a name. ``hidden`` are declarations that are not
    GLOBAL. ``gap`` says by space why a name without a declaration may still be declared; a space
    without a reason is completely known. ``unread`` are the words of unreadable files. With
    ``takes_copies`` one of several declarations is taken where none is nearer than the others.
    """

    names: Mapping[Space, dict[str, list[Found]]]
    hidden: Mapping[Space, dict[str, Found]]
    gap: Mapping[Space, Reason]
    unread: Mapping[Space, frozenset[str]]
    system: SystemScope
    takes_copies: bool = False
    _copies: dict[tuple[Space, str], Mapping[str, Answer]] = field(default_factory=dict)

    def forget(self) -> None:
        """Clear all names, whose scopes refer back to this object."""
        for names in self.names.values():
            names.clear()
        for hidden in self.hidden.values():
            hidden.clear()
        self._copies.clear()

    def near(self, folder: str) -> Outer:
        """Return these names as the files in a folder see them."""
        return _Near(self, folder)

    def find(self, space: Space, key: str, folder: str) -> Answer:
        """Return the meaning of a name in upper case in the files of a folder."""
        found = self.names[space].get(key, ())
        if len(found) == 1:
            return found[0]
        if found:
            if (space, key) not in self._copies:
                self._copies[space, key] = _by_folder(found, takes_copies=self.takes_copies)
            return _seen_from(self._copies[space, key], folder)
        answer = self.system.find(space, key)
        if isinstance(answer, Found):
            return answer
        if key.startswith("$"):
            return Undetermined(Reason.SYSTEM)
        hidden = self.hidden[space].get(key)
        unread = self.unread[space]
        reason = Reason.UNREADABLE if key in unread or REST in unread else self.gap.get(space)
        if hidden and hidden.module and hidden.module.table:
            is_head_unread = hidden.module.is_head_unread(hidden.module.table.key)
            reason = Reason.UNREADABLE if is_head_unread else reason
        if reason is None:
            return NotFound(hidden)
        return Undetermined(reason, (hidden,) if hidden else ())


@dataclass(frozen=True, slots=True)
class _Near:
    """The global names as seen from one folder."""

    names: Globals
    folder: str

    def find(self, space: Space, key: str) -> Answer:
        return self.names.find(space, key, self.folder)


@dataclass(frozen=True, slots=True)
class PartlyRead:
    """An outer scope seen through a partly unreadable file, which may declare its ``words``."""

    outer: Outer
    words: frozenset[str] | None

    def find(self, space: Space, key: str) -> Answer:
        """Look up a name, given in upper case."""
        answer = self.outer.find(space, key)
        if space is Space.ROUTINE or key.startswith("$"):
            return answer
        if self.words is not None and key not in self.words and REST not in self.words:
            return answer
        if isinstance(answer, Found) and answer.module is None:  # predefined by the controller
            return answer
        if isinstance(answer, Found):
            return Undetermined(Reason.AMBIGUOUS, (answer,))
        return Undetermined(Reason.UNREADABLE)


def nearest(found: Sequence[Found], folder: str) -> Answer:
    """Return the declaration whose file shares most folders with ``folder``, if it is unique.

    A controller rejects two global declarations of a name, but folders in which people collect
    programs are full of copies.
    """
    return _seen_from(_by_folder(found), folder)


def _by_folder(found: Sequence[Found], *, takes_copies: bool = False) -> dict[str, Answer]:
    """Return the answer for each folder above a declaration.

    With this index many copies cost no more than one. Of equally near copies the one whose file has
    the name of the declaration is taken, then the one in the fewest folders, if one is to be taken.
    """
    below: dict[str, list[Found]] = {}
    for one in found:
        for folder in _upwards(one.module.folder if one.module else ""):
            below.setdefault(folder, []).append(one)
    return {
        folder: min(some, key=_rank_of_copy)
        if takes_copies or len(some) == 1
        else Undetermined(Reason.AMBIGUOUS, tuple(some))
        for folder, some in below.items()
    }


def _rank_of_copy(found: Found) -> tuple[bool, int, str]:
    name, path = (found.module.name, found.module.path) if found.module else ("", "")
    return name != found.symbol.key, path.count("/"), path


def _seen_from(below: Mapping[str, Answer], folder: str) -> Answer:
    return next((below[at] for at in _upwards(folder) if at in below), NotFound())


def _upwards(folder: str) -> Iterator[str]:
    """Yield a folder and its parents, up to the root, whose name is empty."""
    yield folder
    while folder:
        folder = folder.rpartition("/")[0]
        yield folder
