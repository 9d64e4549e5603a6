"""Symbols and symbol tables, built from the content of one file alone.

A table has five separate name spaces: values (variables, constants, parameters, signals, imports),
routines, types, channels and labels. Keys are names in upper case [TYP-05]. Enumeration constants
are in no table: they are found by the type of their target [TYP-16], as members of a structure are
found by the type of their base.

A `ModuleTable` is one file, as `grammar.semantics.symbol_table` builds it: one table for its data
list or its top level, and one for each routine. It depends neither on the file's name nor on other
files or the controller, and it does not refer to statements. So it can be pickled, cached by the
digest of the content, and shared by equal files. What the names refer to in other files is found by
`grammar.semantics.link` and `grammar.semantics.resolve`. A duplicate declaration is recorded as
data; the first one counts.
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
    """The kind of a symbol; the value is a word for messages."""

    VARIABLE = "variable"
    CONSTANT = "constant"
    PARAMETER = "parameter"
    SIGNAL = "signal"
    IMPORT = "imported variable"
    ROUTINE = "routine"
    EXTERNAL = "external routine"
    STRUCTURE = "structure"
    ENUMERATION = "enumeration"
    #: A type without known parts: INT, REAL, BOOL, CHAR, and types of which only the name is known.
    PLAIN_TYPE = "type"
    MEMBER = "member"
    ENUM_CONSTANT = "enumeration constant"
    CHANNEL = "channel"
    LABEL = "label"


class Access(Enum):
    """Where a symbol is visible."""

    #: In its own routine.
    ROUTINE = "routine"
    #: In every routine of its module [SCO-05].
    MODULE = "module"
    #: Everywhere: declared GLOBAL in a PUBLIC data list, or in one of the system's [SCO-04].
    GLOBAL = "global"


@dataclass(frozen=True, slots=True)
class TypeReference:
    """A type as a declaration names it; ``indices`` are the sizes of an array as written."""

    name: str
    indices: Indices | None = None

    @property
    def key(self) -> str:
        """The name of the type in upper case."""
        return self.name.upper()


@dataclass(frozen=True, slots=True, eq=False)
class Symbol:
    """A named entity. ``span`` is that of the name in the declaration.

    ``type`` is ``None`` for symbols without a type and for parameters without a declaration.
    ``value`` is the initial value of a constant, which array sizes may refer to, or of machine data
    that are upper limits. Predefined symbols are in no file: their type is ``given`` and their span
    is empty.
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
    """A parameter. ``mode`` is IN or OUT, empty if it is not known; the default is OUT [SCO-06].

    ``is_optional`` is known of routines of option packages: a call can leave it out.
    """

    mode: str = "OUT"
    is_optional: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class SignalSymbol(Symbol):
    """A signal: the input or output ``first``, or the range from ``first`` to ``last`` [IOT-03]."""

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
    """A routine; ``type`` is that of its result, ``None`` if it returns no value.

    EXT and EXTFCT announce routines of other modules; EXTP and EXTFCTP declare routines of the
    controller that need no file [SCO-10]. ``more`` describes the arguments that can follow those of
    ``parameters``, as in some predefined routines; ``None`` if none can.
    """

    parameters: tuple[ParameterSymbol, ...] = field(kw_only=True)
    more: ParameterSymbol | None = field(default=None, kw_only=True)

    def parameter(self, place: int) -> ParameterSymbol | None:
        """Return the parameter of the argument at ``place``, counted from 0, if it can have one."""
        return self.parameters[place] if place < len(self.parameters) else self.more


@dataclass(frozen=True, slots=True, eq=False)
class TypeSymbol(Symbol):
    """A structure or an enumeration, with its members or constants by key, in their order.

    ``is_open`` says that it may have others. A declaration in a file never is.
    """

    members: Mapping[str, Symbol] = field(kw_only=True)
    is_open: bool = field(default=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Duplicate:
    """A name that is declared again in the same scope; the first declaration counts."""

    first: Symbol
    second: Symbol

    @property
    def is_repetition(self) -> bool:
        """Whether both are variables of one simple type: then it does not matter which counts."""
        one, other = self.first.type, self.second.type
        if not one or not other or one.indices or other.indices or one.key != other.key:
            return False
        return self.first.kind is self.second.kind is Kind.VARIABLE


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """The symbols of one scope by space and key, and its duplicate declarations."""

    spaces: Mapping[Space, Mapping[str, Symbol]]
    duplicates: tuple[Duplicate, ...]

    def find(self, space: Space, key: str) -> Symbol | None:
        """Return the symbol with a name in upper case, if this scope declares it."""
        return self.spaces[space].get(key)

    def symbols(self) -> Iterator[tuple[Space, Symbol]]:
        """Yield all symbols with their spaces, in the order of declaration within each space."""
        for space, names in self.spaces.items():
            for symbol in names.values():
                yield space, symbol

    def names(self, space: Space, access: Access | None = None) -> Iterator[str]:
        """Yield the names in a space as written, all or those with one kind of access."""
        for symbol in self.spaces[space].values():
            if access is None or symbol.access is access:
                yield symbol.name


@dataclass(frozen=True, slots=True, eq=False)
class RoutineTable:
    """The symbols of one routine: parameters, local data and types, labels."""

    routine: RoutineSymbol
    table: Table


@dataclass(frozen=True, slots=True, eq=False)
class ModuleTable:
    """The symbols of one file.

    ``name`` is the name of its first routine or of its data list. ``table`` holds its top-level
    declarations. ``routines`` are in the order of the file, with duplicates; empty for a data list.
    ``is_system`` says that it is a data list of the controller, which needs neither PUBLIC nor
    GLOBAL to be visible everywhere [SCO-04]. ``calls`` are the names of all called routines.
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
        """Whether this is a data list of the controller, such as $CONFIG or $MACHINE."""
        return self.is_data and self.name.startswith("$")

    @property
    def externals(self) -> Mapping[str, Symbol]:
        """The routines that EXT announces anywhere in the file, by key; the first one counts."""
        found: dict[str, Symbol] = {}
        for routine in self.routines:
            for symbol in routine.table.spaces[Space.ROUTINE].values():
                found.setdefault(symbol.key, symbol)
        return found
