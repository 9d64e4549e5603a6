"""A bytecode program in memory; assembly text and image hold the same.

Types, texts, requests, predefined functions, data and code objects are referred to by their index.
The first four types are the scalars, which are not part of text or image. A cell of the data lists
has an address, counted from 0 through all variables in order. A cell of a frame has an offset:
parameters come first, then locals.

Nothing is checked here, see `interp.bytecode.verifier.verify`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from enum import Enum
from functools import cached_property
from itertools import accumulate
from operator import attrgetter
from typing import ClassVar

from grammar.semantics.types import SCALARS, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Raw, kind_at, raw_of_word, size
from interp.bytecode.instruction_set.table import instructions, shape
from support.lazy_dataclass import dataclass

#: The types that every program begins with.
BASIC_TYPES: tuple[Type, ...] = tuple(SCALARS.values())
#: The maximum nesting of types and of parts of requests.
DEEPEST = 64


class Mode(Enum):
    """How an argument is passed; the value is the word in assembly."""

    #: A value; structures are copied cell by cell.
    IN = "in"
    #: A reference.
    REF = "ref"
    #: A reference to the elements of an array, together with its sizes.
    VIEW = "view"


class CodeKind(Enum):
    """The kind of a code object; the value is the word in assembly."""

    ROUTINE = "routine"
    #: Executed later by an interrupt, a trigger or a cyclic signal.
    ACTION = "action"
    #: Evaluated later, without side effects.
    CONDITION = "condition"


# ----------------------------------------------------------------------------- requests


@dataclass(frozen=True, slots=True)
class Constant:
    """A name, a number, a truth value, or ``None`` for something left out."""

    value: str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Choice:
    """A constant of an enumeration, by its place among the constants."""

    type: int
    place: int


@dataclass(frozen=True, slots=True)
class Input:
    """An operand on the stack; for a view, ``type`` is the type of the elements."""

    mode: Mode
    type: int
    dimensions: int = 0


@dataclass(frozen=True, slots=True)
class Changed:
    """An argument by reference that gets a new value from the reply.

    ``through`` is the offset of the :OUT parameter through which the variable was reached, for the
    trace; ``None`` for a variable of the frame or of the data lists. If the argument is a copy of a
    system variable, ``path`` names the variable, to which the new value is then written. Inputs of
    the path lie below the reference on the stack.
    """

    given: Input
    through: int | None = None
    path: Items | None = None


@dataclass(frozen=True, slots=True)
class Handle:
    """An action or a condition, together with the frame in which the handle is created."""

    code: int


@dataclass(frozen=True, slots=True)
class Items:
    """A sequence of parts."""

    parts: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class Record:
    """A nested request or another record of `interp.port.requests`.

    ``line`` is its line in the source, or 0 if the record has no place.
    """

    name: str
    line: int
    parts: tuple[Argument, ...]


Argument = Constant | Choice | Input | Changed | Handle | Items | Record


def part_kind(part: Argument) -> object:
    """Return what kind of part this is: its class, or the type of a constant or its value."""
    if isinstance(part, Constant):
        return part.value if isinstance(part.value, bool | None) else type(part.value)
    return type(part)


@dataclass(frozen=True, slots=True)
class Ask:
    """A request with its fields; inputs are on the stack in the order of the fields.

    ``result`` is the type of the answer, or ``None`` if there is none. An answer of one cell is
    pushed; a larger one is stored through the reference on top of the inputs.
    """

    name: str
    parts: tuple[Argument, ...]
    result: int | None


class Builtin(Ask):
    """A call of a predefined function, otherwise like a request."""

    __slots__ = ()


def printable(text: str) -> str:
    """Return a text with unprintable characters escaped; names in an image can be anything."""
    return "".join(one if one.isprintable() else repr(one)[1:-1] for one in text)


def variables(code: Code) -> tuple[Variable, ...]:
    """Return the parameters and locals of a code object, in the order of the frame."""
    return (*code.parameters, *code.locals)


def stack_cells(given: Data | Variable | Input) -> int:
    """Return the number of stack cells of an argument; a structure is passed by reference."""
    return 1 + given.dimensions


def width(variable: Data | Variable, type_: Type) -> int:
    """Return the number of cells of a variable of this type in its data list or frame."""
    return size(type_) if variable.mode is Mode.IN else stack_cells(variable)


def inputs_of(parts: tuple[Argument, ...]) -> Iterator[Input]:
    """Yield the operands of an entry on the stack, from bottom to top."""
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
    """A variable of a data list; ``is_global`` if other modules can see it."""

    mode: ClassVar[Mode] = Mode.IN
    dimensions: ClassVar[int] = 0
    module: str
    name: str
    type: int
    is_global: bool = False


@dataclass(frozen=True, slots=True)
class Import:
    """The name under which a routine imports a variable of another data list [ADV-05].

    ``number`` is the index of the variable. If ``routine`` is empty, the whole module imports it.
    Instructions use addresses; this is for texts that name variables at run time.
    """

    module: str
    routine: str
    name: str
    number: int


@dataclass(frozen=True, slots=True)
class Variable:
    """A parameter or a local variable of a code object; for views see `Input`.

    A local variable has the mode ``IN``, and no value when the frame is created.
    """

    name: str
    mode: Mode
    type: int
    dimensions: int = 0


@dataclass(frozen=True, slots=True)
class Slot:
    """The position of a parameter or local in the frame, in cells."""

    offset: int
    cells: int
    variable: Variable


@dataclass(frozen=True, slots=True)
class Instruction:
    """An instruction; jump targets are indices of instructions, not of words."""

    op: Op
    operands: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Code:
    """A code object.

    ``line`` is its first line in ``file``. An action or condition belongs to the code object
    ``owner`` and has a parameter by reference or view for each variable of the owner that it uses;
    ``captures`` are the offsets of these variables in the owner's frame. ``stack`` is the maximum
    size of the operand stack in cells.
    """

    name: str
    kind: CodeKind
    file: str
    line: int
    owner: int | None
    parameters: tuple[Variable, ...]
    captures: tuple[int, ...]
    locals: tuple[Variable, ...]
    result: int | None
    stack: int
    instructions: tuple[Instruction, ...]


@dataclass(frozen=True, eq=True)
class Program:
    """A program.

    ``initial`` has the initial values of the data lists as pairs of address and word, by ascending
    address.
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
        """The address of each variable of the data lists, followed by the total number of cells."""
        return tuple(accumulate(map(self.width, self.data), initial=0))

    @cached_property
    def cells(self) -> tuple[Raw | None, ...]:
        """The initial contents of the data lists; ``None`` is a cell without a value."""
        cells: list[Raw | None] = [None] * self.addresses[-1]
        for address, word in self.initial:
            number = self.data_at(address)
            assert number is not None, "verified"
            type_ = self.types[self.data[number].type]
            cells[address] = raw_of_word(word, kind_at(type_, address - self.addresses[number]))
        return tuple(cells)

    @cached_property
    def frames(self) -> tuple[int, ...]:
        """The frame size of each code object in cells."""
        return tuple(self.frame_size(code) for code in self.codes)

    def data_at(self, address: int) -> int | None:
        """Return the index of the variable of the data lists at an address, or ``None``."""
        if not 0 <= address < self.addresses[-1]:
            return None
        return bisect_right(self.addresses, address) - 1

    def slots(self, code: Code) -> tuple[Slot, ...]:
        """Return the positions of the parameters and locals of a code object, in order."""
        found = variables(code)
        widths = [self.width(one) for one in found]
        return tuple(map(Slot, accumulate(widths, initial=0), widths, found))

    def width(self, variable: Data | Variable) -> int:
        """Return the number of cells of a variable."""
        return width(variable, self.types[variable.type])

    def frame_size(self, code: Code) -> int:
        """Return the number of cells of a frame of the code object."""
        return sum(map(self.width, variables(code)))


def slot_at(slots: Sequence[Slot], place: int) -> Slot | None:
    """Return the parameter or local to which a cell of a frame belongs, or ``None``."""
    found = slots[bisect_right(slots, place, key=attrgetter("offset")) - 1] if slots else None
    return found if found and 0 <= place - found.offset < found.cells else None


# ----------------------------------------------------------------------------- control flow

#: Instructions without a next instruction.
ENDS = frozenset(Op(one.number) for one in instructions() if "ends" in one.flags)


def targets(instruction: Instruction) -> Iterator[int]:
    """Yield the jump targets of an instruction."""
    kinds = shape(instruction.op.name).operands
    for kind, operand in zip(kinds, instruction.operands, strict=True):
        if kind == "target":
            yield operand


def successors(place: int, instruction: Instruction) -> Iterator[int]:
    """Yield the instructions that can come after the one at this place."""
    yield from targets(instruction)
    if instruction.op not in ENDS:
        yield place + 1
