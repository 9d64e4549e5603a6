"""Marshalling: cells become the values and the fields of requests, and replies become cells."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

from grammar.semantics.types import Array, Enumeration, Type
from interp.bytecode.cell_layout import (
    Plain,
    Raw,
    cells_of,
    raw_of,
    shown,
    size,
    value_at,
    value_of,
)
from interp.bytecode.program import (
    Argument,
    Changed,
    Choice,
    Constant,
    Handle,
    Input,
    Items,
    Mode,
    Program,
    Record,
    inputs_of,
    stack_cells,
)
from interp.bytecode.vm.state import State
from interp.port import requests
from interp.port.requests import At, CodeHandle
from interp.values.values import Value, converted, known

#: The operands of an entry; a reference for a large result comes last.
Block = Sequence[Any]


@dataclass(frozen=True, slots=True)
class Change:
    """An argument that may change: its place among the arguments, and the number of its input.

    ``first`` is the number of the first input of its path.
    """

    argument: int
    number: int
    first: int
    changed: Changed


class Entry:
    """Pops the inputs of a request or function from the stack, and stores results.

    ``arguments`` are the parts that the reply may change.
    """

    def __init__(
        self,
        program: Program,
        state: State,
        parts: Sequence[Argument],
        arguments: Sequence[Argument],
        result: int | None,
    ) -> None:
        self._state = state
        self._types = program.types
        self._inputs = list(inputs_of(tuple(parts)))
        self._result = None if result is None else program.types[result]
        self._has_target = result is not None and not isinstance(self._result, Plain)
        self._places: list[int] = []
        place = 0
        for given in self._inputs:
            self._places.append(place)
            place += stack_cells(given)
        self._cells = place + int(self._has_target)
        self.changes = tuple(_changes(arguments))

    def take(self) -> Block:
        """Pop the inputs from the stack."""
        if self._cells == 0:
            return ()
        stack = self._state.stack
        block = stack[-self._cells :]
        del stack[-self._cells :]
        return block

    def values(self, block: Block) -> list[Value | None]:
        """Return the inputs as values; a structure without any value is still a structure."""
        return [
            self._value(given, block, place)
            for given, place in zip(self._inputs, self._places, strict=True)
        ]

    def put(self, block: Block, result: Value | None) -> None:
        """Store the result; raises `faults.Fault` if it is missing or cannot be converted."""
        if self._result is None:
            return
        if self._has_target:
            self._write(block[-1], self._result, result)
            return
        assert isinstance(self._result, Plain), "what has no target has one cell"
        self._state.stack.append(
            raw_of(converted(known(result), shown(self._result)), self._result)
        )

    def store(self, block: Block, change: Change, value: Value) -> None:
        """Assign a new value to a changed argument; raises `interp.values.faults.Fault`."""
        address: int = block[self._places[change.number]]
        self._write(address, self.type_of(block, change), value)
        self._state.last = address

    def type_of(self, block: Block, change: Change) -> Type:
        """Return the type of a changed argument."""
        return self._referred(change.changed.given, block, self._places[change.number])

    def _value(self, given: Input, block: Block, place: int) -> Value | None:
        raw = block[place]
        if raw is None:  # a text that was left out, see `interp.values.builtins.reads_text`
            return ""
        if given.mode is not Mode.IN:
            return value_at(self._state.cells, raw, self._referred(given, block, place))
        type_ = self._types[given.type]
        assert isinstance(type_, Plain), "a structure is passed by reference"
        return value_of(raw, type_)

    def _referred(self, given: Input, block: Block, place: int) -> Type:
        type_ = self._types[given.type]
        if given.mode is Mode.VIEW:
            return Array(type_, tuple(block[place + 1 : place + 1 + given.dimensions]))
        return type_

    def _write(self, address: int, type_: Type, value: Value | None) -> None:
        found: list[Raw | None] = cells_of(value, type_)
        self._state.cells[address : address + size(type_)] = found


def _changes(arguments: Sequence[Argument]) -> Iterator[Change]:
    number = 0
    for place, part in enumerate(arguments):
        inputs = list(inputs_of((part,)))
        if isinstance(part, Changed):
            yield Change(place, number + len(inputs) - 1, number, part)
        number += len(inputs)


def arguments_of(parts: Sequence[Argument]) -> Sequence[Argument]:
    """Return the arguments of a routine of the controller: the last field of its request."""
    last = parts[-1]
    return last.parts if isinstance(last, Items) else ()


# --------------------------------------------------------------------------------- requests

#: Builds a part from the values of the inputs and the place of the request.
Part = Callable[[Sequence[Value | None], At], Any]


def _nothing(_inputs: Sequence[Value | None], _at: At) -> None:
    """Return the path of an argument that is no system variable."""


class RequestBuilder:
    """Makes functions that build requests; ``handle_of`` returns the handle of a code object."""

    def __init__(self, program: Program, handle_of: Callable[[int], CodeHandle]) -> None:
        self._program = program
        self._handle_of = handle_of

    def parts(self, parts: Sequence[Argument]) -> Part:
        """Return a function that builds a tuple of the parts; they use the inputs in order."""
        return self._together(parts, count())

    def paths(self, arguments: Sequence[Argument]) -> Part:
        """Return a function that builds the paths of those arguments that are system variables."""
        makers: list[Part] = []
        first = 0
        for part in arguments:
            path = part.path if isinstance(part, Changed) else None
            makers.append(_nothing if path is None else self.path(path, first))
            first += len(list(inputs_of((part,))))
        return lambda inputs, at: tuple([make(inputs, at) for make in makers])

    def path(self, path: Items, first: int) -> Part:
        """Return a function that builds a path; ``first`` is the number of its first input."""
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
