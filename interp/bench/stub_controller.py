"""A world without a robot, for tests: it answers every request at once and always the same.

Motions take no time. System variables have the values they are given, else what was written to
them, else zeros of the type that the controller's tables tell. Inputs are drawn from a seed anew at
each look, so that a program that waits for one goes on some time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from random import Random
from typing import Any, Final

from grammar.semantics.predefined import System
from grammar.semantics.types import INT, UNKNOWN, Array, Structure, Type
from interp.port.executor import Executor
from interp.port.requests import Crash, End, Fail, Invoke, Path, Read, Request, Value, Write
from interp.values import texts
from interp.values.faults import Fault, LinkError, fault
from interp.values.values import ArrayValue, StructureValue, copied, has_value, zero

#: What is drawn from the seed.
_INPUTS: Final = frozenset({"$IN", "$ANIN", "$DIGIN"})


class StubController:
    """Answers requests.

    ``values`` are those of system variables at first, by name in upper case. They are not changed:
    what is handed out are copies.
    """

    def __init__(self, seed: int = 0, values: Mapping[str, Value] | None = None) -> None:
        self._random = Random(seed)  # nobody's secret depends on it
        self._given = values or {}
        self._values: dict[str, Any] = {}
        self._parts: dict[Path, Any] = {}
        self._system = System.load()

    def reply(self, request: Request) -> Any:
        """The answer to a request, a `Fault` where there is none."""
        match request:
            case Read():
                try:
                    return self.read(request.path)
                except Fault as error:
                    return error
            case Write():
                return self._write(request.path, request.value)
            case Invoke():
                return self._invoked(request)
        return None

    def _invoked(self, request: Invoke) -> texts.Outcome:
        """Zero as the result, and for all that is passed :OUT and has no value."""
        function = self._system.functions[request.name]
        given = zip(function.parameters, request.arguments, strict=False)
        changes = {
            place: self._zero(getattr(value, "type", parameter.type))
            for place, (parameter, value) in enumerate(given)
            if parameter.is_out and not has_value(value)
        }
        result = None if function.result is None else self._zero(function.result)
        return result, changes

    def read(self, path: Path) -> Value:
        """The value of a system variable or of a part of one; faults `index`, `uninitialised`."""
        if path[0] in _INPUTS and len(path) > 1:
            return self._drawn(path)
        if path in self._parts:
            found: Value = copied(self._parts[path])
            return found
        value = self._root(str(path[0]))
        for step in path[1:]:
            value = _part(value, step)
        if value is None:
            raise fault("uninitialised")
        kept: Value = copied(value)
        return kept

    def _write(self, path: Path, value: Value) -> Fault | None:
        if len(path) == 1 and path[0] not in self._values and path[0] not in self._given:
            self._values[str(path[0])] = copied(value)
            return None
        try:
            parent = self._root(str(path[0]))
            for step in path[1:-1]:
                parent = _part(parent, step)
            last = path[-1]
            if len(path) == 1:
                self._values[str(last)] = copied(value)
            elif isinstance(parent, StructureValue) and isinstance(last, str):
                parent.set(last, copied(value))
            elif isinstance(parent, ArrayValue) and isinstance(last, int):
                parent.set(copied(value), last)
            else:
                self._parts[path] = copied(value)
        except (Fault, KeyError, LinkError):  # no more is known of it than what is written
            self._parts[path] = copied(value)
        return None

    def _drawn(self, path: Path) -> Value:
        if path[0] == "$ANIN":
            return self._random.randrange(-4, 5) / 4
        if len(path) == 4:  # ("$IN", 1, "TO", 8)
            drawn = self._random.getrandbits(min(int(path[3]) - int(path[1]) + 1, 32))
            return drawn - 2**32 if drawn >= 2**31 else drawn
        return self._random.random() < 0.5

    def _root(self, name: str) -> Any:
        if name not in self._values:
            entry = self._system.variables.get(name)
            type_ = UNKNOWN if entry is None else entry.type
            given = self._given.get(name)
            self._values[name] = self._zero(type_) if given is None else copied(given)
        return self._values[name]

    def _zero(self, type_: Type) -> Any:
        """Zeros; of what no type is known it is an INT, of an unknown size there are 128."""
        match type_:
            case Array():
                sizes = tuple(128 if size is None else size for size in type_.sizes)
                known = INT if type_.element == UNKNOWN else type_.element
                return zero(Array(known, sizes))
            case Structure():
                members = [self._zero(one.type) for one in type_.members]
                return StructureValue(type_, members)
        return 0 if type_ == UNKNOWN else zero(type_)


def _part(value: Any, step: str | int) -> Any:
    if isinstance(value, StructureValue) and isinstance(step, str):
        return value.get(step)
    if isinstance(value, ArrayValue) and isinstance(step, int):
        return value.get(step)
    raise fault("uninitialised")


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run ended: all requests in order, and whether there were too many of them."""

    requests: tuple[Request, ...]
    is_cut: bool

    @property
    def last(self) -> Request:
        """The request it ended with: `End`, `Fail` or `Crash` where it was not cut."""
        return self.requests[-1]


def run(executor: Executor, world: StubController, most: int = 100_000) -> Outcome:
    """Run a program in a world until it ends, or has made so many requests.

    No interrupt ever comes, and no trigger; RESUME is answered by nothing.
    """
    requests: list[Request] = []
    reply: Any = None
    while len(requests) < most:
        request = executor.advance(reply)
        requests.append(request)
        if isinstance(request, End | Fail | Crash):
            return Outcome(tuple(requests), is_cut=False)
        reply = world.reply(request)
    return Outcome(tuple(requests), is_cut=True)
