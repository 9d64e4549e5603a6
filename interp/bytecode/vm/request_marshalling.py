"""What the machine asks of the world: what a request is made of, and how it is made from cells.

An entry of the table of requests names a request of `interp.port.requests` and has a part for each
of its fields but ``at``. `misfit` tells whether the parts fit the fields, `unlike` the same for
calls of predefined functions. `Makers` turn parts that fit into functions that make the values of
the fields.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

from grammar.semantics.assignability import assignable
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    UNKNOWN,
    Array,
    Enumeration,
    Text,
    Type,
    is_same,
)
from interp.bytecode.cell_layout import value_of
from interp.bytecode.program import (
    Argument,
    Builtin,
    Changed,
    Choice,
    CodeKind,
    Constant,
    Handle,
    Input,
    Items,
    Mode,
    Program,
    Record,
    inputs_of,
)
from interp.port import requests
from interp.port.requests import At, Code, Value
from interp.values.builtins import BUILTINS, reads_text

__all__ = ["ASKED", "Makers", "Part", "may_be_missing", "misfit", "unlike"]

#: The fields of what can be asked, without ``at``, in the order of `interp.port.requests`. A word
#: with a question mark may be left out.
ASKED: Mapping[str, str] = {
    "Read": "path",
    "Write": "path value",
    "Invoke": "word arguments",
    "SetCyclicFlag": "integer condition",
    "StopAdvance": "",
    "Wait": "number",
    "Poll": "flag",
    "Halt": "",
    "Continue": "",
    "Confirm": "integer",
    "Move": "word value value? number? values words word?",
    "MoveSpline": "word values items flag",
    "MoveEmily": "text text number?",
    "SetTrigger": "word number flag number action output? integer?",
    "DeclareInterrupt": "integer flag condition action",
    "SwitchInterrupt": "word integer?",
    "BrakeArm": "word?",
    "Resume": "",
    "SwitchSignal": "word flag word action? number? number? number?",
}
#: The fields of what stands in a spline block, and whether it has a place.
_ITEMS: Mapping[str, tuple[str, bool]] = {
    "Move": (ASKED["Move"], True),
    "SetTrigger": (ASKED["SetTrigger"], True),
    "SplineRange": ("word word number? flag", False),
    "SplineStop": ("number flag condition", False),
}


# ------------------------------------------------------------------------------ do they fit?


def misfit(program: Program, request: str, parts: Sequence[Argument]) -> str | None:
    """Why the parts are not those of the request, or ``None`` where they are."""
    if request not in ASKED:
        return f"{request} is nothing that can be asked"
    return _Fit(program).fields(ASKED[request], parts)


@dataclass(frozen=True, slots=True)
class _Fit:
    program: Program

    def fields(self, kinds: str, parts: Sequence[Argument]) -> str | None:
        wanted = kinds.split()
        if len(wanted) != len(parts):
            return f"{len(wanted)} fields are needed, and there are {len(parts)}"
        for number, (kind, part) in enumerate(zip(wanted, parts, strict=True), start=1):
            if not self._fits(kind, part):
                return f"field {number} is no {kind.rstrip('?')}"
        return None

    def _fits(self, kind: str, part: Argument) -> bool:
        if kind.endswith("?"):
            return part == Constant(None) or self._fits(kind[:-1], part)
        if isinstance(part, Items):
            return self._fits_items(kind, part.parts)
        match kind:
            case "word":
                return isinstance(part, Constant) and isinstance(part.value, str)
            case "flag":
                return isinstance(part, Constant) and isinstance(part.value, bool)
            case "integer":
                return self._is_number(part, INT)
            case "number":
                return self._is_number(part, REAL)
            case "value":
                return self.is_value(part) and not isinstance(part, Changed)
            case "text":
                return _is_text(self.program, part)
            case "action" | "condition":
                return self._is_handle(part, CodeKind(kind))
        return False

    def _fits_items(self, kind: str, parts: Sequence[Argument]) -> bool:
        match kind:
            case "path":
                first, *steps = parts or (Constant(None),)
                return self._fits("word", first) and all(map(self._is_step, steps))
            case "words":
                return all(self._fits("word", part) for part in parts)
            case "values":
                return all(
                    isinstance(part, Items) and self.fields("path value", part.parts) is None
                    for part in parts
                )
            case "output":
                return self.fields("path value", parts) is None
            case "arguments":
                return all(part == Constant(None) or self.is_value(part) for part in parts)
            case "items":
                return all(isinstance(part, Record) and self._is_item(part) for part in parts)
        return False

    def _is_item(self, part: Record) -> bool:
        kinds, has_place = _ITEMS.get(part.name, ("", False))
        return (
            part.name in _ITEMS
            and (part.line > 0) == has_place
            and self.fields(kinds, part.parts) is None
        )

    def _is_step(self, part: Argument) -> bool:
        return self._fits("word", part) or self._is_number(part, INT)

    def _is_number(self, part: Argument, type_: Type) -> bool:
        if isinstance(part, Input):
            return part.mode is Mode.IN and self.program.types[part.type] == type_
        python = int if type_ == INT else float
        return isinstance(part, Constant) and type(part.value) is python

    def _is_handle(self, part: Argument, kind: CodeKind) -> bool:
        codes = self.program.codes
        return isinstance(part, Handle) and part.code < len(codes) and codes[part.code].kind is kind

    def is_value(self, part: Argument) -> bool:
        """Whether it is a value of the language."""
        if isinstance(part, Choice):
            return True
        if isinstance(part, Constant):
            return part.value is not None
        if isinstance(part, Changed):
            return part.path is None or self._fits("path", part.path)
        return isinstance(part, Input)


def unlike(program: Program, builtin: Builtin) -> str | None:
    """Why an entry is no call of a predefined function, or ``None`` where it is one."""
    known = BUILTINS.get(builtin.name.upper())
    if known is None:
        return "there is no such function that only computes"
    least, given = len(known.parameters), len(builtin.parts)
    if given < least or (given > least and not known.has_more):
        return f"it has {least} arguments, not {given}"
    result = None if builtin.result is None else program.types[builtin.result]
    if result != known.result:
        return f"it gives {known.result or 'nothing'}"
    for place, part in enumerate(builtin.parts):
        if part == Constant(None):  # left out
            continue
        is_changed = isinstance(part, Changed)
        type_ = _type_of(program, part.given if isinstance(part, Changed) else part)
        if type_ is None or (is_changed and not known.is_out(place)):
            return f"argument {place + 1} cannot be handed over"
        wanted = known.parameters[place].type if place < least else UNKNOWN
        fits = is_same(wanted, type_) if is_changed else assignable(wanted, type_).is_fine
        if not fits or not _is_written(program, part):
            return f"argument {place + 1} is no {wanted}"
    return None


def may_be_missing(builtin: Builtin) -> Iterator[bool]:
    """For each input of a predefined function, whether it may be a text that was left out.

    See `interp.values.builtins.reads_text`.
    """
    parameters = BUILTINS[builtin.name.upper()].parameters
    for place, part in enumerate(builtin.parts):
        is_text = (
            place < len(parameters)
            and not parameters[place].is_out
            and reads_text(parameters[place].type)
        )
        for given in inputs_of((part,)):
            yield is_text and part is given and given.mode is Mode.VIEW


def _is_written(program: Program, part: Argument) -> bool:
    """Whether the new value of a system variable has a place to be written to, if it is one."""
    return not isinstance(part, Changed) or _Fit(program).is_value(part)


def _is_text(program: Program, part: Argument) -> bool:
    if isinstance(part, Input):
        of = program.types[part.type]
        return (part.mode, part.dimensions, of) == (Mode.VIEW, 1, CHAR)
    return isinstance(part, Constant) and isinstance(part.value, str)


def _type_of(program: Program, part: Argument) -> Type | None:
    """The type of an argument; ``None`` for what is none."""
    match part:
        case Input(Mode.VIEW):
            return Array(program.types[part.type], (None,) * part.dimensions)
        case Input() | Choice():
            return program.types[part.type]
        case Constant(str() as text):
            return Text(len(text))
        case Constant(value):
            return _PYTHON[type(value)]
    return None


_PYTHON: Mapping[type, Type] = {bool: BOOL, int: INT, float: REAL}


# -------------------------------------------------------------------------------- making them

#: Makes a part from the inputs, as values, and the place of the request.
Part = Callable[[Sequence[Value | None], At], Any]


def _nothing(_inputs: Sequence[Value | None], _at: At) -> None:
    """What an argument has that is no system variable."""


class Makers:
    """Makes the functions that make requests; ``handle_of`` gives a code object in this frame."""

    def __init__(self, program: Program, handle_of: Callable[[int], Code]) -> None:
        self._program = program
        self._handle_of = handle_of

    def parts(self, parts: Sequence[Argument]) -> Part:
        """A function that makes the parts as a tuple. They take the inputs in their order."""
        return self._together(parts, count())

    def paths(self, arguments: Sequence[Argument]) -> Part:
        """A function that makes the paths of those arguments that are system variables."""
        makers: list[Part] = []
        first = 0
        for part in arguments:
            path = part.path if isinstance(part, Changed) else None
            makers.append(_nothing if path is None else self.path(path, first))
            first += len(list(inputs_of((part,))))
        return lambda inputs, at: tuple([make(inputs, at) for make in makers])

    def path(self, path: Items, first: int) -> Part:
        """A function that makes a path; ``first`` is the number of its first input."""
        return self._together(path.parts, count(first))

    def _together(self, parts: Sequence[Argument], numbers: Any) -> Part:
        makers = [self._maker(part, numbers) for part in parts]
        if not makers:
            return lambda _inputs, _at: ()
        return lambda inputs, at: tuple([make(inputs, at) for make in makers])

    def _maker(self, part: Argument, numbers: Any) -> Part:
        match part:
            case Constant(value):
                return lambda _inputs, _at: value
            case Choice(type_, place):
                enumeration = self._program.types[type_]
                assert isinstance(enumeration, Enumeration), "verified"
                choice = value_of(place, enumeration)
                return lambda _inputs, _at: choice
            case Input():
                number = next(numbers)
                return lambda inputs, _at: inputs[number]
            case Changed(given, _, path):
                for _ in inputs_of((path,) if path else ()):
                    next(numbers)
                return self._maker(given, numbers)
            case Handle(code):
                handle_of = self._handle_of
                return lambda _inputs, _at: handle_of(code)
            case Items(parts):
                return self._together(parts, numbers)
            case Record(name, line, parts):
                make, kind = self._together(parts, numbers), getattr(requests, name)
                if line:
                    return lambda inputs, at: kind(At(at.file, line, at.depth), *make(inputs, at))
                return lambda inputs, at: kind(*make(inputs, at))
