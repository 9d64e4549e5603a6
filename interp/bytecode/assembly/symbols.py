"""The symbol table of the assembler: what a text has named, and what a line means by a name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from grammar.semantics.types import SCALARS, Array, Enumeration, Structure, Type
from interp.bytecode.assembly.syntax import Key, Line, key, part_text
from interp.bytecode.cell_layout import offset_of, size
from interp.bytecode.program import BASIC_TYPES, Mode


class Symbols:
    """What can be named: types, labels of texts and entries, variables, code objects.

    ``types`` are the types by their numbers. Code objects can be named before they come, so all
    lines are looked through for them.
    """

    def __init__(self, lines: Sequence[Line]) -> None:
        self.types: list[Type] = list(BASIC_TYPES)
        self._numbers = {type_: number for number, type_ in enumerate(BASIC_TYPES)}
        self._named: dict[str, Type] = dict(SCALARS)
        self._labels: dict[str, dict[str, int]] = {"text": {}, "ask": {}, "builtin": {}}
        self._places: dict[tuple[str, Key], tuple[int, Type]] = {}
        self._codes = _announced(lines)

    # ------------------------------------------------------------------------------ types

    def add_type(self, line: Line, type_: Structure | Enumeration) -> None:
        """Name and number a structure or an enumeration."""
        if type_.name.upper() in self._named:
            raise line.error(f"there is a type {type_.name} already")
        size(type_)
        self._named[type_.name.upper()] = type_
        self.number_of(type_)

    def number_of(self, type_: Type) -> int:
        """Return the number of a type; a new array type is added."""
        number = self._numbers.get(type_)
        if number is None:
            number = self._numbers[type_] = len(self.types)
            self.types.append(type_)
        return number

    def type_named(self, line: Line, is_element: bool = False) -> Type:
        """Read a type; with ``is_element``, brackets after it belong to a view."""
        name = line.name()
        found = self._named.get(name.upper())
        if found is None:
            raise line.error(f"there is no type {name}")
        if not is_element and line.found("["):
            sizes = [line.integer(1)]
            while line.found(","):
                sizes.append(line.integer(1))
            line.expect("]")
            found = Array(found, tuple(sizes))
            size(found)
            self.number_of(found)
        return found

    def type_number(self, line: Line) -> int:
        """Read a type and return its number."""
        return line.integer(0) if line.found("#") else self.number_of(self.type_named(line))

    def handed_over(self, line: Line, mode: Mode) -> tuple[int, int]:
        """Read the type of an argument; return its number, and the dimensions if it is a view."""
        if line.found("#"):
            type_ = line.integer(0)
        else:
            type_ = self.number_of(self.type_named(line, is_element=mode is Mode.VIEW))
        dimensions = 0
        if mode is Mode.VIEW:
            line.expect("[")
            dimensions = 1
            while line.found(","):
                dimensions += 1
            line.expect("]")
        return type_, dimensions

    # ----------------------------------------------------------------- texts and entries

    def add_label(self, line: Line, section: str, number: int) -> None:
        """Name a text or an entry."""
        name = line.name()
        if name in self._labels[section]:
            raise line.error(f"there is a {section} {name} already")
        self._labels[section][name] = number

    def labelled(self, line: Line, section: str) -> int:
        """Read the name of a text or an entry and return its number."""
        return looked_up(line, line.name(), self._labels[section], section)

    # --------------------------------------------------------------------------- constants

    def constant(self, line: Line, type_: int) -> int:
        """Read a constant of an enumeration, by its name or index, and return its index."""
        if line.found("#"):
            return line.integer()
        enumeration = self.types[type_] if type_ < len(self.types) else None
        return constant_place(line, enumeration)

    # --------------------------------------------------------------------------- variables

    def add_variable(self, line: Line, module: str, label: Key, address: int, type_: Type) -> None:
        """Give a variable of a data list its address."""
        if (module.upper(), key(label)) in self._places:
            raise line.error(f"there is a variable {module}.{label[0]} already")
        self._places[module.upper(), key(label)] = address, type_

    def data_place(self, line: Line) -> int:
        """Read a part of a variable and return its address."""
        address, type_ = self._places[self._variable(line)]
        return address + part_offset(line, type_)

    def data_number(self, line: Line) -> int:
        """Read a variable and return its number among the data."""
        return list(self._places).index(self._variable(line))

    def _variable(self, line: Line) -> tuple[str, Key]:
        module = line.name()
        line.expect(".")
        label = line.label()
        if (module.upper(), key(label)) not in self._places:
            raise line.error(f"there is no variable {module}.{label[0]}")
        return module.upper(), key(label)

    # ------------------------------------------------------------------------ code objects

    def code_number(self, line: Line) -> int:
        """Read the name of a code object and return its number; it may be defined later."""
        if line.found("#"):
            return line.integer(0)
        label = line.label()
        number = self._codes.get(key(label))
        if number is None:
            raise line.error(f"there is no code object {label[0]}")
        return number


def _announced(lines: Sequence[Line]) -> dict[Key, int]:
    """Return the numbers of the code objects, which may be used before they are defined."""
    found: dict[Key, int] = {}
    for line in lines:
        if line.found("code"):
            label = key(line.label())
            if label in found:
                raise line.error("there is such a code object already")
            found[label] = len(found)
        line.restart()
    return found


def part_offset(line: Line, type_: Type) -> int:
    """Read what follows the name of a variable, ``.X[1,2]``; return the offset of that part."""
    path: list[str | int] = []
    while True:
        if line.found("."):
            path.append(line.name())
        elif line.found("["):
            path.append(line.integer())
            while line.found(","):
                path.append(line.integer())
            line.expect("]")
        else:
            break
    found = offset_of(type_, path)
    if found is None:
        raise line.error(f"{type_} has no part {part_text(tuple(path))}")
    return found[0]


def looked_up(line: Line, name: str, known: Mapping[str, int], what: str) -> int:
    """Return the number of a name; raise `AssemblyError` if it is unknown."""
    if name not in known:
        raise line.error(f"there is no {what} {name}")
    return known[name]


def constant_word(line: Line, kind: Type) -> int:
    """Read a constant of a kind and return its word."""
    if line.has("real"):
        return line.real()
    if line.found("!"):
        return constant_place(line, kind)
    if line.found("TRUE"):
        return 1
    return 0 if line.found("FALSE") else line.integer()


def constant_place(line: Line, type_: Type | None) -> int:
    """Read a constant of an enumeration and return its index."""
    name = line.name().upper()
    if isinstance(type_, Enumeration):
        for place, constant in enumerate(type_.constants):
            if constant.upper() == name:
                return place
    raise line.error(f"{name} is no constant of {type_}")
