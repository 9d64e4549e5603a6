"""The tables of a program: types, texts, requests, functions, data."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TypeVar

from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Array, Enumeration, Member, Scalar, Structure, Type
from interp.bytecode.cell_layout import size
from interp.bytecode.program import BASIC_TYPES, Ask, Builtin, Data
from interp.values.faults import LinkError

_T = TypeVar("_T", bound=Hashable)


class Tables:
    """The tables of a program that is being compiled, without duplicates."""

    def __init__(self) -> None:
        self.types: list[Type] = list(BASIC_TYPES)
        self.texts: list[str] = []
        self.asks: list[Ask] = []
        self.builtins: list[Builtin] = []
        self.data: list[Data] = []
        #: The variables of data lists that have cells: address and type.
        self.places: dict[Symbol, tuple[int, Type]] = {}
        self.cells = 0
        self._numbers: dict[Type, int] = {type_: n for n, type_ in enumerate(BASIC_TYPES)}
        self._names = {str(type_) for type_ in BASIC_TYPES}
        self._places: dict[Hashable, int] = {}

    # ----------------------------------------------------------------------- types

    def number(self, type_: Type) -> int:
        """Return the number of a type; raises `LinkError` if no variable can have it."""
        number = self._numbers.get(type_)
        if number is None:
            made = self._made(type_)
            size(made)
            number = self._numbers.get(made)
            if number is None:
                number = len(self.types)
                self.types.append(made)
                self._numbers[made] = number
            self._numbers[type_] = number
        return number

    def closed(self, type_: Type) -> Type:
        """Return the type as it is stored in the program; it cannot be extended."""
        return self.types[self.number(type_)]

    def _made(self, type_: Type) -> Type:
        """Return the type to store; the same object if unchanged, as types are often compared."""
        match type_:
            case Array():
                element = self.closed(type_.element)
                return type_ if element is type_.element else Array(element, type_.sizes)
            case Structure():
                members = tuple(
                    Member(member.name, self.closed(member.type)) for member in type_.members
                )
                name = self._named(type_.name)
                pairs = zip(members, type_.members, strict=True)
                is_same = all(one.type is other.type for one, other in pairs)
                if is_same and name == type_.name and not type_.is_open:
                    return type_
                return Structure(name, members)
            case Enumeration():
                name = self._named(type_.name)
                if name == type_.name and not type_.is_open:
                    return type_
                return Enumeration(name, type_.constants)
            case Scalar():
                return type_
        raise LinkError(f"no variable can be of {type_}")

    def _named(self, name: str) -> str:
        """Return the name of a type, made unique if another type has the same name."""
        found, number = name, 1
        while found.upper() in self._names:
            number += 1
            found = f"{name}@{number}"
        self._names.add(found.upper())
        return found

    # ----------------------------------------------------------------------- entries

    def text(self, text: str) -> int:
        """Return the number of a text."""
        return self._entry(self.texts, text)

    def ask(self, ask: Ask) -> int:
        """Return the number of a request."""
        return self._entry(self.asks, ask)

    def builtin(self, builtin: Builtin) -> int:
        """Return the number of a call of a predefined function."""
        return self._entry(self.builtins, builtin)

    def _entry(self, table: list[_T], entry: _T) -> int:
        # the written form distinguishes 1, 1.0 and TRUE, which compare as equal
        key = (type(entry), repr(entry))
        if key not in self._places:
            self._places[key] = len(table)
            table.append(entry)
        return self._places[key]

    # ----------------------------------------------------------------------- data

    def variable(self, symbol: Symbol, type_: Type, module: str, *, is_global: bool) -> None:
        """Assign cells to a variable of a data list; raises `LinkError` if its type has no size."""
        number = self.number(type_)
        self.places[symbol] = self.cells, self.types[number]
        self.data.append(Data(module, symbol.name, number, is_global))
        self.cells += size(self.types[number])
