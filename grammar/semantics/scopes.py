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

from collections.abc import Iterator, Mapping
from enum import Enum
from typing import Protocol

from grammar.semantics.symbols import Kind, ModuleTable, RoutineTable, Symbol, Table, TypeSymbol
from grammar.semantics.types import Array, Enumeration, Scalar, Structure
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
        """Whether a type may have members, or a routine parameters, that are not known.

        Part of its line is unreadable, or its scope declares it as something else, too.
        """
        if isinstance(self.symbol, TypeSymbol) and self.symbol.is_open:
            return True
        is_unread = self.module is not None and self.module.is_head_unread(self.symbol.key)
        return is_unread or self.is_disputed

    @property
    def is_disputed(self) -> bool:
        """Whether its scope declares it once more, as something else or with another type."""
        return self.scope.disputes(self.symbol)

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

    def disputes(self, symbol: Symbol) -> bool:
        """Return whether another declaration of this scope contradicts that of a symbol."""
        duplicates = self._table.duplicates
        return any(one.first is symbol and not one.is_repetition for one in duplicates)

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
