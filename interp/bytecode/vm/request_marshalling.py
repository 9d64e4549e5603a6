"""Marshalling of requests: functions that build the fields of a request from operands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import count
from typing import Any

from grammar.semantics.types import Enumeration
from interp.bytecode.cell_layout import value_of
from interp.bytecode.program import (
    Argument,
    Changed,
    Choice,
    Constant,
    Handle,
    Input,
    Items,
    Program,
    Record,
    inputs_of,
)
from interp.port import requests
from interp.port.requests import At, CodeHandle, Value

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
