"""Simulated controllers with replies from a seed, for differential testing.

A `RandomWorld` also replies with a fault now and then, and its unwritten variables have random
values. A `QuietWorld` does neither. Large arrays cost nothing before they are used.
"""

from __future__ import annotations

from collections.abc import Mapping
from random import Random
from typing import Any, Final

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    UNKNOWN,
    Array,
    Enumeration,
    Structure,
    Type,
)
from interp.port.requests import Invoke, Move, MoveSpline, Path, Poll, Read, Request, Value, Write
from interp.values.faults import Fault, fault
from interp.values.texts import Outcome
from interp.values.values import (
    ArrayValue,
    EnumValue,
    StructureValue,
    copied,
    empty,
    has_value,
    zero,
)

_INPUTS: Final = frozenset({"$IN", "$ANIN", "$DIGIN1"})
#: After so many polls in vain every digital input is TRUE, so that no wait is endless.
_PATIENCE: Final = 3
#: One of so many requests is answered with a fault.
_SELDOM: Final = 250
_FAULTS: Final = ("invalid", "read_only", "index")
_LARGEST_WHOLE: Final = 256


class RandomWorld:
    """A controller that answers requests at random; the seed and the requests determine replies."""

    def __init__(self, seed: str, *, has_faults: bool = True) -> None:
        self._random = Random(seed)  # no secret depends on it
        self._has_faults = has_faults
        self._values: dict[Path, Any] = {}
        self._system = System.load()
        self._polls = 0

    def reply(self, request: Request) -> Any:
        """Return the reply to a request, which is a `Fault` now and then without a reason."""
        self._polls = self._polls + 1 if isinstance(request, Poll) and not request.is_first else 0
        if not isinstance(request, Read | Write | Invoke | Move | MoveSpline):
            return None
        if self._has_faults and not self._random.randrange(_SELDOM):
            return fault(self._random.choice(_FAULTS))
        try:
            match request:
                case Read():
                    return self.read(request.path)
                case Write():
                    self._write(request.path, request.value)
                case Invoke():
                    return self._invoke(request)
        except Fault as error:
            return error
        return None

    def below(self, end: int) -> int:
        """Return a random number in [0, ``end``), also for decisions of the caller."""
        return self._random.randrange(end)

    def read(self, path: Path) -> Value:
        """Return a system variable or a part of one; faults ``index``, ``uninitialised``."""
        if path[0] in _INPUTS:
            return self._input(path)
        key, members = _split(path)
        value = self._values.get(key)
        if value is None:
            value = self._values[key] = self._first(key)
        for name in members:
            value = _member(value, name)
        if value is None:
            raise fault("uninitialised")
        found: Value = copied(value)
        return found

    def _write(self, path: Path, value: Value) -> None:
        key, members = _split(path)
        if not members:
            self._type(key)
            self._values[key] = copied(value)
            return
        if key not in self._values:
            self._values[key] = self._first(key)
        whole = self._values[key]
        for name in members[:-1]:
            whole = _member(whole, name)
        last = members[-1]
        if isinstance(whole, StructureValue) and isinstance(last, str):
            whole.set(last, copied(value))
        elif isinstance(whole, ArrayValue) and isinstance(last, int):
            whole.set(copied(value), last)
        else:
            raise fault("invalid")

    def _invoke(self, request: Invoke) -> Outcome:
        """Return a random result, and random values for arguments passed :OUT without a value."""
        function = self._system.functions[request.name]
        given = zip(function.parameters, request.arguments, strict=False)
        changes = {
            place: self._new_value(getattr(value, "type", parameter.type))
            for place, (parameter, value) in enumerate(given)
            if parameter.is_out and not has_value(value)
        }
        result = None if function.result is None else self._new_value(function.result)
        return result, changes

    # ----------------------------------------------------------------------- values

    def _input(self, path: Path) -> Value:
        """Return the value of an input, a new one at each access."""
        if path[0] == "$ANIN":
            return self.below(9) / 4 - 1
        if path[0] == "$DIGIN1":
            return self.below(9) - 4
        if len(path) == 4:  # ("$IN", 9, "TO", 12)
            return self.below(16)
        drawn = self.below(2) == 1
        return drawn or self._polls >= _PATIENCE

    def _first(self, key: Path) -> Any:
        """Return the initial value of a variable that was never written."""
        return self._new_value(self._type(key))

    def _type(self, key: Path) -> Type:
        entry = self._system.variables.get(str(key[0]))
        type_ = UNKNOWN if entry is None else entry.type
        indices = [one for one in key[1:] if isinstance(one, int)]
        if "TO" in key:
            return INT
        if indices and isinstance(type_, Array):
            for index, size in zip(indices, type_.sizes, strict=False):
                if not 1 <= index <= (_LARGEST_WHOLE if size is None else size):
                    raise fault("index")
            return type_.element
        return type_

    def _new_value(self, type_: Type) -> Any:
        """Return a random value of a type; texts are short and numbers small."""
        match type_:
            case Structure():
                return StructureValue(type_, [self._new_value(one.type) for one in type_.members])
            case Array():
                sizes = tuple(_LARGEST_WHOLE if one is None else one for one in type_.sizes)
                known = Array(INT if type_.element == UNKNOWN else type_.element, sizes)
                made = empty(known)
                assert isinstance(made, ArrayValue)
                for place in range(min(len(made), 3)):
                    made.elements[place] = self._new_value(known.element)
                return made
            case Enumeration():
                return EnumValue(type_, self.below(len(type_.constants)))
        if type_ == REAL:
            return self.below(16) / 8
        if type_ == BOOL:
            return self.below(2) == 1
        return "KRL "[self.below(4)] if type_ == CHAR else self.below(5)


class QuietWorld(RandomWorld):
    """A world without a robot, in which only inputs are random, and nothing fails.

    Motions take no time. ``values`` are the initial values of system variables, by name in upper
    case; they are copied. All other variables are zeros of the types in the controller's tables, or
    INT if a type is unknown.
    """

    def __init__(self, seed: int = 0, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(str(seed), has_faults=False)
        self._given = values or {}

    def _first(self, key: Path) -> Any:
        value: Any = self._given.get(str(key[0]))
        if value is None:
            return super()._first(key)
        for step in key[1:]:
            value = _member(value, step)
        return copied(value)

    def _new_value(self, type_: Type) -> Any:
        match type_:
            case Array():
                sizes = tuple(_LARGEST_WHOLE if one is None else one for one in type_.sizes)
                return zero(Array(INT if type_.element == UNKNOWN else type_.element, sizes))
            case Structure():
                return StructureValue(type_, [self._new_value(one.type) for one in type_.members])
        return 0 if type_ == UNKNOWN else zero(type_)


def _split(path: Path) -> tuple[Path, tuple[str | int, ...]]:
    """Split a path into the variable or element that is stored, and the members within it."""
    place = 1
    while place < len(path) and (isinstance(path[place], int) or path[place] == "TO"):
        place += 1
    return path[:place], path[place:]


def _member(value: Any, step: str | int) -> Any:
    if isinstance(value, StructureValue) and isinstance(step, str):
        return value.get(step)
    if isinstance(value, ArrayValue) and isinstance(step, int):
        return value.get(step)
    raise fault("uninitialised")
