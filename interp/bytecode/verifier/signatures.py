"""Checks that requests and calls of predefined functions have the arguments that they need.

An entry of the table of requests names a request of `interp.port.requests` and has one part for
each of its fields except ``at``.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

from grammar.semantics.assignability import assignable
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Text, Type, is_same
from interp.bytecode.program import (
    Argument,
    Ask,
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
from interp.values.builtins import BUILTINS, reads_text

#: The kind of a field of a request, by its annotation.
_KINDS: Mapping[str, str] = {
    "Path": "path",
    "Value": "value",
    "Text": "text",
    "str": "word",
    "int": "integer",
    "float": "number",
    "bool": "flag",
    "tuple[str, ...]": "words",
    "tuple[Path, Value]": "output",
    "tuple[tuple[Path, Value], ...]": "values",
    "tuple[Value | None, ...]": "arguments",
    "tuple[SplineItem, ...]": "items",
}
_ASSIGNMENT = ("path", "value")
#: Requests that executors make themselves and that no program contains.
_UNASKED = (requests.Skip, requests.Slice, requests.End, requests.Fail, requests.Crash)


def _kinds(request: type) -> tuple[str, ...]:
    """Return the kinds of the required fields of a record except ``at``; ``?`` means optional."""
    return tuple(
        _kind(one.name, str(one.type))
        for one in dataclasses.fields(request)
        if one.name != "at" and one.default is dataclasses.MISSING
    )


def _kind(name: str, annotation: str) -> str:
    required = annotation.removesuffix(" | None")
    mark = "" if required == annotation else "?"
    if required == "CodeHandle":
        return ("condition" if name == "condition" else "action") + mark
    return _KINDS[required] + mark


_REQUESTS: Mapping[str, tuple[str, ...]] = {
    one.__name__: _kinds(one) for one in get_args(requests.Request) if one not in _UNASKED
}
#: The items of a spline block: their fields, and whether they have a place in the source.
_SPLINE_ITEMS: Mapping[str, tuple[tuple[str, ...], bool]] = {
    one.__name__: (_kinds(one), issubclass(one, requests.BaseRequest))
    for one in get_args(requests.SplineItem)
}


def request_mismatch(program: Program, ask: Ask) -> str | None:
    """Return why the parts do not fit the request, or ``None`` if they do."""
    if ask.name not in _REQUESTS:
        return f"{ask.name} is not a request"
    return _Fit(program).fields(_REQUESTS[ask.name], ask.parts)


@dataclass(frozen=True, slots=True)
class _Fit:
    program: Program

    def fields(self, kinds: Sequence[str], parts: Sequence[Argument]) -> str | None:
        if len(kinds) != len(parts):
            return f"{len(kinds)} fields are required, not {len(parts)}"
        for number, (kind, part) in enumerate(zip(kinds, parts, strict=True), start=1):
            if not self._fits(kind, part):
                return f"field {number} is not of the kind {kind.rstrip('?')}"
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
                    isinstance(part, Items) and self.fields(_ASSIGNMENT, part.parts) is None
                    for part in parts
                )
            case "output":
                return self.fields(_ASSIGNMENT, parts) is None
            case "arguments":
                return all(part == Constant(None) or self.is_value(part) for part in parts)
            case "items":
                return all(isinstance(part, Record) and self._is_item(part) for part in parts)
        return False

    def _is_item(self, part: Record) -> bool:
        kinds, has_place = _SPLINE_ITEMS.get(part.name, ((), False))
        return (
            part.name in _SPLINE_ITEMS
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
        """Return whether a part is a value of the language."""
        if isinstance(part, Choice):
            return True
        if isinstance(part, Constant):
            return part.value is not None
        if isinstance(part, Changed):
            return part.path is None or self._fits("path", part.path)
        return isinstance(part, Input)


def call_mismatch(program: Program, builtin: Builtin) -> str | None:
    """Return why an entry is no valid call of a predefined function, or ``None`` if it is one."""
    computing = BUILTINS.get(builtin.name.upper())
    if computing is None:
        return "there is no such function that only computes"
    known = computing.declared
    if not known.takes(len(builtin.parts)):
        return f"it has {len(known.parameters)} arguments, not {len(builtin.parts)}"
    result = None if builtin.result is None else program.types[builtin.result]
    if result != known.result:
        return f"its result is {known.result or 'nothing'}"
    for place, part in enumerate(builtin.parts):
        if part == Constant(None):  # left out
            continue
        is_changed = isinstance(part, Changed)
        type_ = _type_of(program, part.given if isinstance(part, Changed) else part)
        parameter = known.parameter(place)
        assert parameter is not None, "it takes so many"
        if type_ is None or (is_changed and not parameter.is_out):
            return f"argument {place + 1} cannot be passed"
        wanted = parameter.type
        fits = is_same(wanted, type_) if is_changed else assignable(wanted, type_).is_fine
        if not fits or not _is_written(program, part):
            return f"argument {place + 1} is not a {wanted}"
    return None


def may_be_missing(builtin: Builtin) -> Iterator[bool]:
    """Yield for each input of a predefined function whether it is a text that may be left out.

    See `interp.values.builtins.reads_text`.
    """
    parameters = BUILTINS[builtin.name.upper()].declared.parameters
    for place, part in enumerate(builtin.parts):
        is_text = (
            place < len(parameters)
            and not parameters[place].is_out
            and reads_text(parameters[place].type)
        )
        for given in inputs_of((part,)):
            yield is_text and part is given and given.mode is Mode.VIEW


def _is_written(program: Program, part: Argument) -> bool:
    """Return whether the new value of a part can be written, if the part is :OUT."""
    return not isinstance(part, Changed) or _Fit(program).is_value(part)


def _is_text(program: Program, part: Argument) -> bool:
    if isinstance(part, Input):
        of = program.types[part.type]
        return (part.mode, part.dimensions, of) == (Mode.VIEW, 1, CHAR)
    return isinstance(part, Constant) and isinstance(part.value, str)


def _type_of(program: Program, part: Argument) -> Type | None:
    """Return the type of an argument, or ``None`` if the part is no argument."""
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
