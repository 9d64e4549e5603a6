"""Declarations for undeclared variables and types, derived from their uses.

The default values let a program continue:

- a truth value that nothing assigns ends the loops that test it;
- a number that nothing assigns is the first value that a SWITCH compares it with, otherwise 1;
- a point has a place of its own within reach of the arm;
- a variable that is only waited for is an input, and one that PULSE sets is an output.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from math import prod
from typing import Final
from zlib import crc32

from grammar.motion_kinds import AXIS_MOTIONS
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    SCALARS,
    Enumeration,
    Structure,
    Type,
    is_axes,
)
from interp.robot.kinematics.machine_data import AXIS_NAMES, EXTERNAL_NAMES
from interp.standins.default_values import NOTHING, DefaultValues
from interp.standins.uses import DataUse

_AXES: Final = frozenset(AXIS_NAMES)
_EXTERNAL_AXES: Final = frozenset(EXTERNAL_NAMES)
_FRAME: Final = frozenset("XYZABC")
_TEXT_LENGTH: Final = 80
#: Elements in each dimension, by how many there are; more where an index is a larger number.
_ELEMENTS: Final = {1: 32, 2: 8, 3: 4}
_MOST_ELEMENTS: Final = 4096
#: More elements than these get no value.
_MOST_VALUES: Final = 256
_FIRST_SIGNAL: Final = 1024
_LONGEST: Final = 20
#: Of an enumeration of which no constant is known.
_NO_CONSTANT: Final = "NOT_KNOWN"


@dataclass(frozen=True, slots=True)
class TypedValue:
    """The name of a type, and a value of it; ``is_text`` for a sequence of CHAR."""

    type: str
    value: str
    is_text: bool = False


class DerivedDeclarations:
    """Makes declarations; ``find_type`` gives a type of the project that is seen everywhere.

    ``values`` are defaults by the names of their types, where zeros will not do. ``types`` are the
    lines of new types, by name in upper case, also of those made before; ``named_types`` are those
    of them that files name; ``owner`` is the file that alone has what comes next.
    """

    def __init__(
        self,
        enumerations: Iterable[Enumeration],
        find_type: Callable[[str], Type | None],
        values: Mapping[str, str],
        defaults: DefaultValues,
        types: dict[str, str],
        named_types: Iterable[str],
    ) -> None:
        self.types = types
        self.owner = ""
        self._named_types = frozenset(named_types)
        self._defaults = defaults
        self._values = values
        self._enumerations = list(enumerations)
        self._find_type = find_type
        self._signal = _FIRST_SIGNAL

    def data(self, name: str, use: DataUse, *, is_last: bool, access: str = "GLOBAL ") -> list[str]:
        """Return the lines that declare a variable; none if its type is unknown."""
        kind = self.typed_value(name, use)
        if kind is None and not is_last:
            return []
        kind = kind or number(use)
        is_input = use.is_waited_for and not use.is_assigned
        if kind.type == "BOOL" and (use.is_pulsed or is_input) and not use.indices:
            self._signal -= 1
            place = "OUT" if use.is_pulsed else "IN"
            return [f"{access}SIGNAL {name} ${place}[{self._signal + 1}]"]
        if kind.is_text and use.indices <= 1:
            return [f"DECL {access}CHAR {name}[{_TEXT_LENGTH}]", f'{name}[]=" "']
        if not use.indices:
            given = f"={kind.value}" if kind.value != NOTHING else ""
            return [f"DECL {access}{kind.type} {name}{given}"]
        sizes = _sizes(use, is_text=kind.is_text)
        lines = [f"DECL {access}{kind.type} {name}[{','.join(map(str, sizes))}]"]
        if not is_last:  # values imply no type, and there are many
            return lines
        is_placed = name in self._defaults.placed
        type_ = self._find_type(kind.type)
        counted = sizes[:-1] if kind.is_text else sizes
        elements = product(*(range(1, size + 1) for size in counted))
        for indices in islice(elements, _MOST_VALUES):
            place = ",".join(map(str, indices)) + ("," if kind.is_text else "")
            value = kind.value
            if type_ is not None and is_placed:
                value = self._defaults.zero(type_, f"{name}[{place}]", is_target=bool(use.motions))
            lines += [f"{name}[{place}]={value}"] if value != NOTHING else ()
        return lines

    def type(self, name: str, use: DataUse) -> None:
        """Declare a type that only its name is known of, from how its variables are used."""
        if (use.constants or use.is_compared) and not use.members:  # no structure is compared
            constants = use.constants.values() or [_NO_CONSTANT]
            self.types[name] = f"GLOBAL ENUM {name} {','.join(constants)}"
        else:
            self._structure(name, use)

    def typed_value(self, name: str, use: DataUse) -> TypedValue | None:
        """Return the type and value of a variable, or ``None`` if nothing implies a type."""
        numbers = [one for one in use.types if one in (INT, REAL)]
        is_pose = bool(use.motions - AXIS_MOTIONS or _FRAME & set(use.members))
        # What was made for one of its other uses is made again with what this round knows.
        own = self.types.keys() - self._named_types if use.members or use.constants else ()
        for one in use.types:
            if one not in numbers and not (is_pose and is_axes(one)) and str(one) not in own:
                known = self._known(name, one, use)
                if known is not None:
                    return known
        if use.constants:
            return self._enumeration(name, use)
        members = set(use.members)
        if members:
            if members <= _AXES | _EXTERNAL_AXES:
                return self._named("E6AXIS", name)
            if members <= _FRAME and not use.motions:
                return self._named("FRAME", name)
            if members <= _FRAME | _EXTERNAL_AXES | {"S", "T"}:
                return self._named("E6POS", name)
            made = self._made(name, "T")
            return TypedValue(made, self._structure(made, use))
        if use.motions:
            return self._named("E6AXIS" if use.motions <= AXIS_MOTIONS else "E6POS", name)
        if use.is_text:
            return TypedValue("CHAR", '" "', is_text=True)
        return number(use) if numbers else None

    def _made(self, name: str, kind: str) -> str:
        """Return the name of the type that is created for a variable; it differs by owner."""
        if self.owner or len(name) > _LONGEST:
            digest = crc32(f"{self.owner} {name}".encode()) % 0x10000
            name = f"{name[: _LONGEST - 4]}{digest:04X}"
        return f"{name}_{kind}"

    def _known(self, name: str, type_: Type, use: DataUse) -> TypedValue | None:
        if type_ in (BOOL, CHAR):
            truth = "TRUE" if use.left_by and not use.is_assigned else "FALSE"
            return TypedValue(str(type_), truth if type_ == BOOL else '" "', use.is_text)
        if not isinstance(type_, Structure | Enumeration) or self._find_type(type_.name) != type_:
            return None
        return TypedValue(type_.name, self.value(type_, name, is_target=bool(use.motions)))

    def _named(self, type_: str, name: str) -> TypedValue:
        found = self._find_type(type_)
        assert found is not None, "every controller has it"
        return TypedValue(type_, self._defaults.zero(found, name))

    def _enumeration(self, name: str, use: DataUse) -> TypedValue:
        first = next(iter(use.constants.values()))
        for one in self._enumerations:
            has_all = not one.is_open and all(constant in one for constant in use.constants)
            if has_all and self._find_type(one.name) == one:
                return TypedValue(one.name, f"#{first}")
        made = self._made(name, "E")
        self.types[made] = f"GLOBAL ENUM {made} {','.join(use.constants.values())}"
        return TypedValue(made, f"#{first}")

    def _structure(self, name: str, use: DataUse) -> str:
        """Declare a structure with the members that are used; its value."""
        members, values = [], []
        for member, inner in use.members.items():
            kind = self.typed_value(f"{name}_{member}", inner) or number(inner)
            sizes = f"[{_TEXT_LENGTH}]" if kind.is_text else ""
            if inner.indices and not kind.is_text:
                sizes = f"[{','.join(map(str, _sizes(inner, is_text=False)))}]"
            members.append(f"{kind.type} {member}{sizes}")
            if kind.is_text or not (sizes or kind.value == NOTHING):
                values.append(f"{member}{'[]' if kind.is_text else ''} {kind.value}")
        self.types[name] = f"GLOBAL STRUC {name} {','.join(members) or 'INT UNUSED'}"
        return f"{{{','.join(values) if members else 'UNUSED 0'}}}"

    def type_named(self, name: str) -> Type | None:
        """Return the type with a name, ``None`` if there is none, also for an empty name."""
        return SCALARS.get(name) or (self._find_type(name) if name else None)

    def value(self, type_: Type, name: str, *, is_target: bool = False) -> str:
        """Return the default of a type for the variable ``name``; see `DefaultValues.zero`."""
        known = self._values.get(str(type_).upper())
        return self._defaults.zero(type_, name, is_target=is_target) if known is None else known


def number(use: DataUse) -> TypedValue:
    """Return the type and value of a variable that is a number, as far as is known."""
    begins_at_0 = use.is_assigned and not (use.is_index or use.is_part or use.indices)
    begins_at_0 &= not use.cases or "0" in use.cases  # else it is in none of its states
    value = "0" if begins_at_0 else use.asked_for or "1"
    return TypedValue("REAL", f"{value}.0") if REAL in use.types else TypedValue("INT", value)


def _sizes(use: DataUse, *, is_text: bool) -> Sequence[int]:
    count = min(use.indices, 3)
    sizes = [max(_ELEMENTS[count], largest) for largest in use.largest[:count]]
    if prod(sizes) > _MOST_ELEMENTS:
        sizes = [_ELEMENTS[count]] * count
    if is_text:
        sizes[-1] = _TEXT_LENGTH
    return sizes
