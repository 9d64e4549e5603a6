"""A program of the machine in memory, as its text and its byte image have it.

Types, texts, requests, predefined functions, data and code objects are numbered by their place.
The first types are the four scalars; they are not written anywhere. A cell of the data lists has
its address, counted from 0 through all variables in order; a cell of a frame its offset: first the
parameters, then the locals.

Nothing is checked here: see `interp.bytecode.verifier.verify`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from enum import Enum
from functools import cached_property

from grammar.semantics.types import SCALARS, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Raw, kind_at, raw_of_word, size
from support.lazy_dataclass import dataclass

#: The types that every program begins with.
BASIC_TYPES: tuple[Type, ...] = tuple(SCALARS.values())


class Mode(Enum):
    """How something is handed over; the value is the word in the text form."""

    #: A value; structures are copied cell by cell.
    IN = "in"
    #: A reference.
    REF = "ref"
    #: A reference to elements, and the sizes of the array.
    VIEW = "view"


class CodeKind(Enum):
    """What a code object is; the value is the word in the text form."""

    ROUTINE = "routine"
    #: Entered later: what an interrupt, a trigger or a cyclic signal does.
    ACTION = "action"
    #: Evaluated later, without side effects.
    CONDITION = "condition"


# ----------------------------------------------------------------------------- requests


@dataclass(frozen=True, slots=True)
class Constant:
    """A name, a number, a truth value, or what is left out."""

    value: str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Choice:
    """A constant of an enumeration."""

    type: int
    place: int


@dataclass(frozen=True, slots=True)
class Input:
    """What the stack holds; of a view, ``type`` is that of its elements."""

    mode: Mode
    type: int
    dimensions: int = 0


@dataclass(frozen=True, slots=True)
class Changed:
    """An argument that gets a new value from the reply; it is handed over by reference.

    For the trace, ``through`` is the offset of the parameter by which it was reached, ``None`` in
    the frame or the data lists. Where it is a copy of a system variable, ``path`` says of which,
    with its inputs below the reference, and the new value is written there.
    """

    given: Input
    through: int | None = None
    path: Items | None = None


@dataclass(frozen=True, slots=True)
class Handle:
    """An action or a condition, with the frame it is made in."""

    code: int


@dataclass(frozen=True, slots=True)
class Items:
    """Several, in order."""

    parts: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class Record:
    """A request within a request, or another record of `interp.port.requests`, by its name.

    ``line`` is where it stands in the source, 0 where the record has no place.
    """

    name: str
    line: int
    parts: tuple[Argument, ...]


Argument = Constant | Choice | Input | Changed | Handle | Items | Record


@dataclass(frozen=True, slots=True)
class Ask:
    """A request: its name and its fields; inputs are on the stack in this order.

    ``result`` is the type of the reply, ``None`` where there is none. A value of one cell is
    pushed, a larger one goes where a reference leads that lies on top of the inputs.
    """

    request: str
    parts: tuple[Argument, ...]
    result: int | None


@dataclass(frozen=True, slots=True)
class Builtin:
    """A predefined function with its arguments; else like `Ask`."""

    name: str
    parts: tuple[Argument, ...]
    result: int | None


def printable(text: str) -> str:
    """A text on one line: names come from images and may hold anything."""
    return "".join(one if one.isprintable() else repr(one)[1:-1] for one in text)


def variables(code: Code) -> tuple[Parameter | Local, ...]:
    """The parameters and locals of a code object, in the order of the frame."""
    return (*code.parameters, *code.locals)


def stack_cells(given: Parameter | Input) -> int:
    """How many cells an argument has on the stack; a structure lies there by reference."""
    return 1 + given.dimensions


def inputs_of(parts: tuple[Argument, ...]) -> Iterator[Input]:
    """What the stack holds for an entry, from the bottom to the top."""
    for part in parts:
        if isinstance(part, Input):
            yield part
        elif isinstance(part, Items | Record):
            yield from inputs_of(part.parts)
        elif isinstance(part, Changed):
            yield from inputs_of((part.path,) if part.path else ())
            yield part.given


# ----------------------------------------------------------------------------- data and code


@dataclass(frozen=True, slots=True)
class Data:
    """A variable of a data list; ``is_global`` where other modules see it."""

    module: str
    name: str
    type: int
    is_global: bool = False


@dataclass(frozen=True, slots=True)
class Import:
    """What a routine calls a variable of another data list, by its number among the data [ADV-05].

    Without a routine it is what the whole module calls it. Instructions have addresses; it is for
    texts that name variables.
    """

    module: str
    routine: str
    name: str
    number: int


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a code object; see `Input` for views."""

    name: str
    mode: Mode
    type: int
    dimensions: int = 0


@dataclass(frozen=True, slots=True)
class Local:
    """A variable of a frame; has no value when the frame is made."""

    name: str
    type: int


@dataclass(frozen=True, slots=True)
class Slot:
    """Where a parameter or a local is: its first cell and how many it has."""

    offset: int
    cells: int
    variable: Parameter | Local


@dataclass(frozen=True, slots=True)
class Instruction:
    """An instruction; targets are places of instructions in the code object, not of words."""

    op: Op
    operands: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Code:
    """A code object.

    ``line`` is where it begins in ``file``. An action or condition belongs to the code object
    ``owner`` and has a reference or view parameter for each variable of the owner that it uses;
    ``captures`` are the offsets of these in the owner's frame. ``stack`` is the largest number of
    cells that it has on the stack of operands.
    """

    name: str
    kind: CodeKind
    file: str
    line: int
    owner: int | None
    parameters: tuple[Parameter, ...]
    captures: tuple[int, ...]
    locals: tuple[Local, ...]
    result: int | None
    stack: int
    instructions: tuple[Instruction, ...]


@dataclass(frozen=True, eq=True)
class Program:
    """A program.

    ``initial`` are the initial values of the data lists, as address and word, in ascending order.
    """

    types: tuple[Type, ...]
    texts: tuple[str, ...]
    asks: tuple[Ask, ...]
    builtins: tuple[Builtin, ...]
    data: tuple[Data, ...]
    initial: tuple[tuple[int, int], ...]
    codes: tuple[Code, ...]
    imports: tuple[Import, ...] = ()

    @cached_property
    def addresses(self) -> tuple[int, ...]:
        """The address of each variable of the data lists, and behind them how many cells."""
        places = [0]
        for variable in self.data:
            places.append(places[-1] + size(self.types[variable.type]))
        return tuple(places)

    @cached_property
    def cells(self) -> tuple[Raw | None, ...]:
        """What is in the cells of the data lists at first."""
        cells: list[Raw | None] = [None] * self.addresses[-1]
        for address, word in self.initial:
            number = self.data_at(address)
            assert number is not None, "verified"
            type_ = self.types[self.data[number].type]
            cells[address] = raw_of_word(word, kind_at(type_, address - self.addresses[number]))
        return tuple(cells)

    @cached_property
    def frames(self) -> tuple[int, ...]:
        """How many cells a frame of each code object has."""
        return tuple(self.frame_size(code) for code in self.codes)

    def data_at(self, address: int) -> int | None:
        """The number of the variable of the data lists that has a cell."""
        if not 0 <= address < self.addresses[-1]:
            return None
        return bisect_right(self.addresses, address) - 1

    def slots(self, code: Code) -> tuple[Slot, ...]:
        """The parameters and locals of a code object, in their order."""
        slots: list[Slot] = []
        offset = 0
        for variable in variables(code):
            cells = self.width(variable)
            slots.append(Slot(offset, cells, variable))
            offset += cells
        return tuple(slots)

    def width(self, variable: Parameter | Local) -> int:
        """How many cells a parameter or a local has in its frame."""
        if isinstance(variable, Parameter) and variable.mode is not Mode.IN:
            return stack_cells(variable)
        return size(self.types[variable.type])

    def frame_size(self, code: Code) -> int:
        """How many cells a frame of the code object has."""
        return sum(map(self.width, code.parameters)) + sum(map(self.width, code.locals))
