"""What the names in a text stand for; the same for reading and for writing.

An assembler adds names as it reads them, a disassembler takes them from a program.
"""

from __future__ import annotations

from bisect import bisect_right

from grammar.semantics.types import SCALARS, Array, Enumeration, Structure, Type
from interp.bytecode.assembly.syntax import Label, Line, labels, name_text, part_text
from interp.bytecode.cell_layout import offset_of, path_to, size
from interp.bytecode.program import BASIC_TYPES, Data, Mode, Program, Variable, width
from interp.values.faults import LinkError


class Table:
    """The labels of things of one kind, each with ``parts`` names, and their numbers."""

    def __init__(self, what: str, parts: int = 1) -> None:
        self.labels: dict[int, Label] = {}
        self._what = what
        self._parts = parts
        self._numbers: dict[Label, int] = {}

    def add(self, label: Label, number: int | None = None) -> None:
        """Name the next thing, or that with a number; raises `LinkError` if the name is taken."""
        if label.key in self._numbers:
            raise LinkError(f"there is a {self._what} {label} already")
        number = len(self.labels) if number is None else number
        self._numbers[label.key] = number
        self.labels[number] = label

    def read(self, line: Line) -> int:
        """Read a label and return its number; raises `LinkError` if there is none."""
        label = line.label(self._parts)
        if label.key not in self._numbers:
            raise LinkError(f"there is no {self._what} {label}")
        return self._numbers[label.key]


class Area(Table):
    """Variables one after the other, those of the data lists or of a frame, and their cells."""

    def __init__(self, what: str, parts: int = 1) -> None:
        super().__init__(what, parts)
        self._starts = [0]
        self._types: list[Type | None] = []

    def place(self, label: Label, type_: Type | None, cells: int) -> None:
        """Add a variable with so many cells; a reference has parts that have no names."""
        self.add(label)
        self._types.append(type_)
        self._starts.append(self._starts[-1] + cells)

    @property
    def end(self) -> int:
        """The address after the last variable."""
        return self._starts[-1]

    def address(self, line: Line) -> int:
        """Read a part of a variable, ``V.X[1,2]``, and return its address."""
        number = self.read(line)
        type_, path = self._types[number], list[str | int]()
        while type_ is not None and line.at(".", "["):
            if line.found("."):
                path.append(line.name())
            else:
                path += line.indices()
        part = (0, None) if type_ is None else offset_of(type_, path)
        if part is None:
            raise LinkError(f"{type_} has no part {part_text(tuple(path))}")
        return self._starts[number] + part[0]

    def text(self, address: int, wanted: Type | None) -> str:
        """Return the name of the part at an address; ``wanted`` is its type, if it is no cell."""
        number = bisect_right(self._starts, address) - 1
        if 0 <= number < len(self._types):
            type_, inside = self._types[number], address - self._starts[number]
            path = path_to(type_, inside, wanted) if type_ else None if inside else ()
            if path is not None:
                return str(self.labels[number]) + part_text(path)
        return f"+{address}"


class Names:
    """The types, and the labels of all else by the kinds of operands that name it."""

    def __init__(self) -> None:
        self.types: list[Type] = []
        self._numbers: dict[Type, int] = {}
        self._named: dict[str, Type] = dict(SCALARS)
        self.tables = {kind: Table(kind) for kind in ("text", "ask", "builtin")}
        self.tables["code"] = Table("code object")
        self.data = self.tables["data"] = Area("variable", parts=2)
        self.open_code()
        for type_ in BASIC_TYPES:
            self.number_of(type_)

    @classmethod
    def of(cls, program: Program) -> Names:
        """Return the names that a program has in its text."""
        names = cls()
        for type_ in program.types:
            names.number_of(type_)
        entries = {"text": program.texts, "ask": program.asks, "builtin": program.builtins}
        for kind, section in entries.items():
            for number in range(len(section)):
                names.tables[kind].add(Label((f"{kind[0].upper()}{number}",)))
        for label in labels((code.name,) for code in program.codes):
            names.tables["code"].add(label)
        variables = labels((one.module, one.name) for one in program.data)
        for label, one in zip(variables, program.data, strict=True):
            names.place(names.data, label, one)
        return names

    def place(self, area: Area, label: Label, variable: Data | Variable) -> None:
        """Add a variable to its area."""
        type_ = self.type_at(variable.type)
        is_value = variable.mode is Mode.IN
        area.place(label, type_ if is_value else None, width(variable, type_))

    def open_code(self) -> None:
        """Go to a code object: its frame has no variables yet, and it has no labels."""
        self.frame = self.tables["local"] = Area("parameter or local")
        self.tables["target"] = Table("label")

    # ------------------------------------------------------------------------------ types

    def add_type(self, type_: Structure | Enumeration) -> None:
        """Name and number a structure or an enumeration."""
        if type_.name.upper() in self._named:
            raise LinkError(f"there is a type {type_.name} already")
        size(type_)
        self._named[type_.name.upper()] = type_
        self.number_of(type_)

    def number_of(self, type_: Type) -> int:
        """Return the number of a type; a new one is added."""
        number = self._numbers.setdefault(type_, len(self.types))
        if number == len(self.types):
            self.types.append(type_)
        return number

    def type_at(self, number: int) -> Type:
        """Return the type with a number; raises `LinkError` if there is none."""
        if not 0 <= number < len(self.types):
            raise LinkError(f"there is no type #{number}")
        return self.types[number]

    def read_type(self, line: Line) -> Type:
        """Read a type; brackets without sizes are left to the caller."""
        name = line.name()
        found = self._named.get(name.upper())
        if found is None:
            raise LinkError(f"there is no type {name}")
        if line.at("[") and not line.at(",", "]", ahead=1):
            found = Array(found, tuple(line.indices()))
            size(found)
            self.number_of(found)
        return found


def type_text(type_: Type) -> str:
    """Return a type as it is written."""
    if isinstance(type_, Array):
        return f"{type_text(type_.element)}[{','.join(map(str, type_.sizes))}]"
    return name_text(type_.name) if isinstance(type_, Structure | Enumeration) else str(type_)
