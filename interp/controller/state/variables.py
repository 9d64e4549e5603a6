"""The system variables: their values, the twins of the main run, and their advance stops.

The tables of `grammar.semantics.predefined` say which variables exist, their types, who may write
them, their limits, their twins in the main run [ADV-10], and whether an access stops the advance
run [ADV-05 to ADV-07]. Inputs, timers, positions and other variables that are more than a stored
value are read and written through a `Live` object.

Each motion is planned with a `Snapshot` of the values of the advance run. When the motion starts,
the ``_C`` variables take the values of its snapshot.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache, lru_cache, reduce
from typing import Any, Final, Protocol

from grammar.semantics.predefined import System, SystemVariable
from grammar.semantics.types import INT, UNKNOWN, Array, Structure, Type
from interp.controller.state.activity import Activity
from interp.controller.state.profile import Profile, ProfileError
from interp.port.requests import Path, Value
from interp.values.faults import Fault, LinkError, fault
from interp.values.json_form import from_json
from interp.values.values import (
    ArrayValue,
    StructureValue,
    converted,
    copied,
    empty,
    fill,
    known,
    zero,
)
from support.lazy_dataclass import dataclass

#: The values in the advance run of all variables that have a twin in the main run, by name.
Snapshot = Mapping[str, Any]
_UNKNOWN_SIZE: Final = 128
_SIZES: Final = {"$FLAG": "flags", "$CYCFLAG": "cyclic_flags"}


class Live(Protocol):
    """A system variable that is computed or has side effects, unlike a stored value."""

    def read(self, path: Path) -> Value:
        """Return its value, or that of a part; raise `Fault`."""
        ...

    def write(self, path: Path, value: Value) -> None:
        """Assign a value; raise `Fault`."""
        ...


@dataclass(frozen=True, slots=True)
class Computed:
    """A read-only variable whose value is computed whenever it is read."""

    compute: Callable[[], Value]

    def read(self, path: Path) -> Value:
        """Return the value, or that of a part."""
        return part(self.compute(), path[1:])

    def write(self, _path: Path, _value: Value) -> None:
        """Raise the fault ``read_only``."""
        raise fault("read_only")


class Variables:
    """All system variables, by their names in upper case.

    ``activity`` is what programs do to them.
    """

    def __init__(self, profile: Profile, given: Mapping[str, Value] | None = None) -> None:
        self._profile = profile
        self._release = System.load(profile.release)
        self._newest = System.load()
        self._values: dict[str, Any] = {}
        self._live: dict[str, Live] = {}
        self._untyped_parts: dict[Path, Value] = {}
        self.activity = Activity()
        self._twins = _twins()
        self._with_twins = frozenset(self._twins.values())
        self._snapshot: Snapshot | None = None
        self._values["$ADVANCE"] = profile.advance
        for name, data in profile.values.items():
            self._values[name] = self._initial(name, data)
        for name, value in (given or {}).items():
            self._give(name.upper(), value)
        #: The values with which the running motion, or the last one, was planned.
        self.main: Snapshot = self.snapshot()

    # ------------------------------------------------------------------------------- the tables

    def entry(self, name: str) -> SystemVariable | None:
        """Return the entry of a variable in the tables, ``None`` if there is none."""
        return self._release.variables.get(name) or self._newest.variables.get(name)

    def stops(self, name: str, *, is_write: bool) -> bool:
        """Return whether an access stops the advance run."""
        entry = self.entry(name)
        return entry is not None and bool(entry.stops_on_write if is_write else entry.stops_on_read)

    def type_of(self, name: str) -> Type:
        """Return the type of a variable; `UNKNOWN` if it is not in a table."""
        for system in (self._release, self._newest):
            found = system.variables.get(name)
            if found is not None and found.type != UNKNOWN:
                return self._sized(name, found.type)
        return UNKNOWN

    def part_type(self, path: Path) -> Type:
        """Return the type of a variable or of a part of it; `UNKNOWN` if it is not in a table."""
        type_ = self.type_of(str(path[0]))
        for step in path[1:]:
            if isinstance(type_, Array):
                type_ = type_.element
            elif isinstance(type_, Structure) and isinstance(step, str):
                type_ = type_.member(step) or UNKNOWN
        return type_

    def _sized(self, name: str, type_: Type) -> Type:
        if not isinstance(type_, Array):
            return type_
        sizes = tuple(_UNKNOWN_SIZE if size is None else size for size in type_.sizes)
        if name in _SIZES:
            sizes = (self._profile.sizes[_SIZES[name]],)
        return Array(type_.element, sizes)

    def size(self, name: str) -> int:
        """Return the number of elements of an array; 1 for any other variable."""
        root = self._root(name)
        return len(root) if isinstance(root, ArrayValue) else 1

    # ------------------------------------------------------------------------------- the values

    def connect(self, names: Iterable[str], live: Live) -> None:
        """Let ``live`` read and write these variables."""
        for name in names:
            self._live[name] = live

    def read(self, path: Path) -> Value:
        """Return a copy of a variable or of a part of it; faults ``uninitialised``, ``index``."""
        name = str(path[0])
        live = self._live.get(name)
        if live is not None:
            self.activity.read(name)
            return live.read(path)
        if self._is_untyped_part(path):
            return self._untyped_parts.get(path, 0)
        root = self.main[self._twins[name]] if name in self._twins else self._root(name)
        return part(root, path[1:])

    def write(self, path: Path, value: Value) -> None:
        """Assign for a program; faults ``read_only``, ``invalid``, ``inadmissible``, ``index``."""
        if path[0] in self._twins:
            raise fault("read_only")
        self.put(path, value)

    def put(self, path: Path, value: Value) -> None:
        """Assign a value, even to a write-protected variable."""
        name = str(path[0])
        entry = self.entry(name)
        if entry is not None and entry.limits is not None and isinstance(value, int | float):
            low, high = entry.limits
            if not low <= value <= high:
                raise fault("invalid")
        live = self._live.get(name)
        if live is not None:
            self.activity.wrote(name)
            live.write(path, value)
            return
        if self._is_untyped_part(path):
            self.activity.stored(self._untyped_parts.get(path), value)
            self._untyped_parts[path] = copied(value)
            return
        before = self._part(path)
        self._store(path, value)
        self.activity.stored(before, self._part(path))

    def _part(self, path: Path) -> Value | None:
        """Return a copy of a stored value or of a part of it; ``None`` if it has none."""
        try:
            return part(self._root(str(path[0])), path[1:])
        except Fault:
            return None

    def _is_untyped_part(self, path: Path) -> bool:
        """Return whether a path is a part of a variable of unknown type, perhaps of an option.

        With a tolerant profile such a part can be written and read.
        """
        name = str(path[0])
        if len(path) == 1 or not self._profile.is_tolerant or self.type_of(name) != UNKNOWN:
            return False
        return not isinstance(self._root(name), StructureValue | ArrayValue)

    def snapshot(self, changes: Iterable[tuple[Path, Value]] = ()) -> Snapshot:
        """Return the present values of the advance run, with changes for one motion only."""
        if self._snapshot is None:
            self._snapshot = {name: self._root(name) for name in sorted(self._with_twins)}
        changed: dict[str, Any] = {}
        for path, value in changes:
            name = str(path[0])
            root = changed[name] if name in changed else copied(self._root(name))
            changed[name] = self._changed(name, root, path[1:], value)
        return {**self._snapshot, **changed} if changed else self._snapshot

    def _store(self, path: Path, value: Value) -> None:
        name = str(path[0])
        if name in self._with_twins:  # existing snapshots keep the old value
            self._values[name] = copied(self._root(name))
            self._snapshot = None
        self._values[name] = self._changed(name, self._root(name), path[1:], value)

    def _changed(self, name: str, root: Any, steps: Path, value: Value) -> Any:
        """Return what a variable holds after an assignment to it or to a part of it."""
        if steps:
            _put(root, steps, value)
            return root
        if isinstance(root, StructureValue | ArrayValue):
            whole = copied(root)
            fill(whole, value)
            return whole
        type_ = self.type_of(name)
        return copied(value) if type_ == UNKNOWN else converted(value, type_)

    def _root(self, name: str) -> Any:
        if name not in self._values:
            # a variable with a twin is copied before it is written
            new = _shared_zero if name in self._with_twins else _zero
            self._values[name] = new(self.type_of(name))
        return self._values[name]

    def _initial(self, name: str, data: Any) -> Any:
        type_ = self.type_of(name)
        if isinstance(type_, Structure | Array) and data is False:
            return empty(type_)
        try:
            return data if type_ == UNKNOWN else from_json(type_, data)
        except (ValueError, Fault, LinkError) as error:
            raise ProfileError(f"profile {self._profile.name}: {name}: {error}") from None

    def _give(self, name: str, value: Value) -> None:
        """Assign the initial value from a data list."""
        try:
            self._store((name,), value)
        except Fault:  # the data list declares another type, which is then the right one
            self._values[name] = copied(value)


@cache
def _twins() -> Mapping[str, str]:
    """Return the variables that have a twin in the main run, by its name."""
    return {one.twin: name for name, one in System.load().variables.items() if one.twin}


def part(value: Any, steps: Path) -> Value:
    """Return a copy of a part of a value; faults ``uninitialised``, ``index``."""
    found: Value = copied(known(reduce(_step, steps, value)))
    return found


def _step(whole: Any, step: str | int) -> Any:
    """Return a member, an element, or a part of an array without its first dimension."""
    match whole, step:
        case StructureValue(), str() if whole.type.member(step) is not None:
            return whole.get(step)
        case ArrayValue(), int():
            return whole.get(step) if len(whole.sizes) == 1 else whole.part(step)
    raise fault("uninitialised")


def _put(root: Any, steps: Path, value: Value) -> None:
    """Assign a value, converted and copied, to the part that ``steps`` lead to."""
    last: Any
    *way, last = steps
    whole = reduce(_step, way, root)
    old = _step(whole, last)
    if isinstance(old, StructureValue | ArrayValue):
        fill(old, value)
    elif isinstance(whole, ArrayValue):
        whole.set(converted(value, whole.type.element), last)
    else:
        whole.set(last, converted(value, whole.type.member(last)))


def _zero(type_: Type) -> Any:
    """Return a value that is zero in every part; a part of unknown type is an INT."""
    match type_:
        case Array():
            sizes = tuple(_UNKNOWN_SIZE if size is None else size for size in type_.sizes)
            return zero(Array(INT if type_.element == UNKNOWN else type_.element, sizes))
        case Structure():
            return StructureValue(type_, [_zero(one.type) for one in type_.members])
    return 0 if type_ == UNKNOWN else zero(type_)


_shared_zero = lru_cache(maxsize=256)(_zero)
