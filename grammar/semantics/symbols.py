"""Symbols that a file declares and their tables, made from the content of the file alone.

A table has five spaces of names that do not meet: values (variables, constants, parameters,
signals, imports), routines, types, channels and labels. Keys are names in upper case [TYP-05].
Constants of an enumeration are in no table: they are found by the type of their target [TYP-16],
as members of a structure are by the type of their base.

A `ModuleTable` is one file, as `grammar.semantics.symbol_table` makes it: one table for what its
data list or its first level holds, and one for each routine. Nothing in it knows the name of the
file, other files or the controller, and nothing refers to the tree of statements, so that it can be
pickled, kept by the digest of the content, and shared by files that say the same. Where names lead
to from there is the affair of `grammar.semantics.link` and `grammar.semantics.resolve`. What is
declared twice is data here: the first declaration counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from enum import Enum

from grammar.semantics.types import Type
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.references import Space
from support.lazy_dataclass import dataclass

Indices = tuple[ast.Expression | None, ...]


class Kind(Enum):
    """What a symbol is; the value is a word for messages."""

    VARIABLE = "variable"
    CONSTANT = "constant"
    PARAMETER = "parameter"
    SIGNAL = "signal"
    IMPORT = "imported variable"
    ROUTINE = "routine"
    EXTERNAL = "external routine"
    STRUCTURE = "structure"
    ENUMERATION = "enumeration"
    #: Of which no parts are known: INT, REAL, BOOL, CHAR, and what is known by its name only.
    PLAIN_TYPE = "type"
    MEMBER = "member"
    ENUM_CONSTANT = "enumeration constant"
    CHANNEL = "channel"
    LABEL = "label"


class Access(Enum):
    """From where a symbol can be seen."""

    #: In its own routine.
    ROUTINE = "routine"
    #: In every routine of its module [SCO-05].
    MODULE = "module"
    #: Everywhere: declared GLOBAL in a PUBLIC data list, or in one of the system's [SCO-04].
    GLOBAL = "global"


@dataclass(frozen=True, slots=True)
class TypeReference:
    """A type as a declaration names it; ``indices`` of an array, with its sizes as written."""

    name: str
    indices: Indices | None = None

    @property
    def key(self) -> str:
        """The name of the type in upper case."""
        return self.name.upper()


@dataclass(frozen=True, slots=True, eq=False)
class Symbol:
    """Something with a name. ``span`` is that of the name in the declaration.

    ``type`` is ``None`` for what has no type, and for a parameter that is declared nowhere.
    ``value`` is the initial value of a constant, which array sizes may be made of, and of machine
    data that limit what programs set. What the
    controller brings along stands in no file: its type is ``given``, its span is empty.
    """

    kind: Kind
    name: str
    span: Span
    access: Access
    type: TypeReference | None = None
    value: ast.Expression | None = None
    given: Type | None = None

    @property
    def key(self) -> str:
        """The name in upper case."""
        return self.name.upper()


@dataclass(frozen=True, slots=True, eq=False)
class ParameterSymbol(Symbol):
    """A parameter. ``mode`` is IN or OUT, which it is where nothing is written [SCO-06]."""

    mode: str = "OUT"


@dataclass(frozen=True, slots=True, eq=False)
class SignalSymbol(Symbol):
    """A signal: what it stands for, ``first`` alone or up to ``last`` [IOT-03]."""

    first: ast.Expression = field(kw_only=True)
    last: ast.Expression | None = field(kw_only=True)


@dataclass(frozen=True, slots=True, eq=False)
class ImportSymbol(Symbol):
    """A variable of another data list under a name of its own [ADV-05].

    ``module`` is the last name of the path, in upper case; ``source`` is looked up there.
    """

    module: str = field(kw_only=True)
    source: ast.Expression = field(kw_only=True)


@dataclass(frozen=True, slots=True, eq=False)
class RoutineSymbol(Symbol):
    """A routine; ``type`` is that of its result, ``None`` where it has no value.

    Routines of other modules are announced by EXT and EXTFCT; EXTP and EXTFCTP are the controller's
    own way to write routines that need no file [SCO-10]. ``has_more``: arguments of any type may
    follow, as in some that the controller brings along.
    """

    parameters: tuple[ParameterSymbol, ...] = field(kw_only=True)
    has_more: bool = field(default=False, kw_only=True)


@dataclass(frozen=True, slots=True, eq=False)
class TypeSymbol(Symbol):
    """A structure or an enumeration, with its members or constants by key, in their order.

    ``is_open``: there may be more of them than are known, which no declaration in a file is.
    """

    members: Mapping[str, Symbol] = field(kw_only=True)
    is_open: bool = field(default=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Duplicate:
    """A name that is declared where it has been declared already; the first one counts."""

    first: Symbol
    second: Symbol


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """The symbols of one scope by space and key, and what is declared in it more than once."""

    spaces: Mapping[Space, Mapping[str, Symbol]]
    duplicates: tuple[Duplicate, ...]

    def find(self, space: Space, key: str) -> Symbol | None:
        """The symbol of a name in upper case, if this very scope has it."""
        return self.spaces[space].get(key)

    def symbols(self) -> Iterator[tuple[Space, Symbol]]:
        """All symbols with their spaces, in the order of declaration within each space."""
        for space, names in self.spaces.items():
            for symbol in names.values():
                yield space, symbol


@dataclass(frozen=True, slots=True, eq=False)
class RoutineTable:
    """What is known inside one routine: parameters, local data and types, labels."""

    routine: RoutineSymbol
    table: Table


@dataclass(frozen=True, slots=True, eq=False)
class ModuleTable:
    """What one file declares.

    ``name`` is what the file calls itself: that of its first routine or of its data list.
    ``table`` holds what is declared at its first level. ``routines`` are in the order of the file
    and empty for a data list; routines of the same name are all there. ``is_system``: a data list
    of the controller, which needs neither PUBLIC nor GLOBAL to be seen everywhere [SCO-04].
    ``calls`` are the names of all routines that are called in the file.
    """

    name: str
    span: Span
    is_data: bool
    is_public: bool
    table: Table
    routines: tuple[RoutineTable, ...]
    calls: frozenset[str]

    @property
    def key(self) -> str:
        """The name in upper case."""
        return self.name.upper()

    @property
    def is_system(self) -> bool:
        """Whether this is a data list of the controller: $CONFIG, $MACHINE …"""
        return self.is_data and self.name.startswith("$")

    @property
    def externals(self) -> Mapping[str, Symbol]:
        """What EXT announces in any routine of the file, by key; the first one counts."""
        found: dict[str, Symbol] = {}
        for routine in self.routines:
            for symbol in routine.table.spaces[Space.ROUTINE].values():
                found.setdefault(symbol.key, symbol)
        return found
