"""Declarations for undeclared names, derived from their uses.

A routine consists of its signature: it does nothing, assigns a default to arguments without a
value, and returns a default. The defaults let a program continue:

- a function that reports success returns TRUE, and other numeric functions return 0;
- a truth value that nothing assigns ends the loops that test it;
- a number that nothing assigns is the first value that a SWITCH compares it with, otherwise 1;
- a point has a place of its own within reach of the arm;
- a variable that is only waited for is an input, and one that PULSE sets is an output.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from math import prod
from typing import Final
from zlib import crc32

from grammar.motion_kinds import AXIS_MOTIONS
from grammar.semantics.packages import PackageRoutine
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    SCALARS,
    UNKNOWN,
    Array,
    Constant,
    Enumeration,
    Scalar,
    Structure,
    Text,
    Type,
    is_axes,
    is_cartesian,
)
from interp.robot.models.stand_in import Places
from interp.standins.uses import DataUse, RoutineUse

_ROBOT_AXES: Final = tuple(f"A{number}" for number in range(1, 7))
_AXES: Final = frozenset(_ROBOT_AXES)
_EXTERNAL: Final = frozenset({f"E{number}" for number in range(1, 7)})
_COMPONENTS: Final = tuple("XYZABC")
_FRAME: Final = frozenset(_COMPONENTS)
_TEXT_LENGTH: Final = 80
#: Elements in each dimension, by how many there are; more where an index is a larger number.
_ELEMENTS: Final = {1: 32, 2: 8, 3: 4}
_MOST_ELEMENTS: Final = 4096
#: More elements than these get no value.
_MOST_VALUES: Final = 256
_FIRST_SIGNAL: Final = 1024
_LONGEST: Final = 20
#: Of a structure of arrays, whose elements nothing sets: it cannot be written.
_NOTHING: Final = "{}"
#: Of an enumeration of which no constant is known.
_NO_CONSTANT: Final = "NOT_KNOWN"


@dataclass(frozen=True, slots=True)
class _Kind:
    """A type as it is written, and a value of it; ``is_text`` for a sequence of CHAR."""

    name: str
    value: str
    is_text: bool = False


class Signatures:
    """Makes declarations; ``find_type`` gives a type of the project that is seen everywhere.

    ``values`` are defaults by the names of their types, where zeros will not do; ``places`` are for
    points. ``types`` are the lines of new types, by name in upper case, also of those made before;
    ``named_types`` are those of them that files name, ``placed`` the variables that have got
    places; ``owner`` is the file that alone has what comes next.
    """

    def __init__(
        self,
        enumerations: Iterable[Enumeration],
        find_type: Callable[[str], Type | None],
        values: Mapping[str, str],
        places: Places,
        types: dict[str, str] | None = None,
        named_types: Iterable[str] = (),
    ) -> None:
        self.types = {} if types is None else types
        self.owner = ""
        self._named_types = frozenset(named_types)
        self.placed: set[str] = set()
        self._places = places
        self._values = values
        self._enumerations = list(enumerations)
        self._find_type = find_type
        self._signal = _FIRST_SIGNAL

    # ------------------------------------------------------------------------- data

    def data(self, name: str, use: DataUse, *, is_last: bool, access: str = "GLOBAL ") -> list[str]:
        """Return the lines that declare a variable; none if its type is unknown."""
        kind = self._kind(name, use)
        if kind is None and not is_last:
            return []
        kind = kind or self._number(use)
        is_input = use.is_waited_for and not use.is_assigned
        if kind.name == "BOOL" and (use.is_pulsed or is_input) and not use.indices:
            self._signal -= 1
            place = "OUT" if use.is_pulsed else "IN"
            return [f"{access}SIGNAL {name} ${place}[{self._signal + 1}]"]
        if kind.is_text and use.indices <= 1:
            return [f"DECL {access}CHAR {name}[{_TEXT_LENGTH}]", f'{name}[]=" "']
        if not use.indices:
            given = f"={kind.value}" if kind.value != _NOTHING else ""
            return [f"DECL {access}{kind.name} {name}{given}"]
        sizes = self._sizes(use, is_text=kind.is_text)
        lines = [f"DECL {access}{kind.name} {name}[{','.join(map(str, sizes))}]"]
        if not is_last:  # values imply no type, and there are many
            return lines
        is_placed = name in self.placed
        type_ = self._find_type(kind.name)
        counted = sizes[:-1] if kind.is_text else sizes
        elements = product(*(range(1, size + 1) for size in counted))
        for indices in islice(elements, _MOST_VALUES):
            place = ",".join(map(str, indices)) + ("," if kind.is_text else "")
            value = kind.value
            if type_ is not None and is_placed:
                value = self._default(type_, f"{name}[{place}]", is_target=bool(use.motions))
            lines += [f"{name}[{place}]={value}"] if value != _NOTHING else ()
        return lines

    def type(self, name: str, use: DataUse) -> None:
        """Declare a type that only its name is known of, from how its variables are used."""
        if (use.constants or use.is_compared) and not use.members:  # no structure is compared
            constants = use.constants.values() or [_NO_CONSTANT]
            self.types[name] = f"GLOBAL ENUM {name} {','.join(constants)}"
        else:
            self._structure(name, use)

    def _kind(self, name: str, use: DataUse) -> _Kind | None:
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
            if members <= _AXES | _EXTERNAL:
                return self._named("E6AXIS", name)
            if members <= _FRAME and not use.motions:
                return self._named("FRAME", name)
            if members <= _FRAME | _EXTERNAL | {"S", "T"}:
                return self._named("E6POS", name)
            made = self._made(name, "T")
            return _Kind(made, self._structure(made, use))
        if use.motions:
            return self._named("E6AXIS" if use.motions <= AXIS_MOTIONS else "E6POS", name)
        if use.is_text:
            return _Kind("CHAR", '" "', is_text=True)
        return self._number(use) if numbers else None

    def _made(self, name: str, kind: str) -> str:
        """Return the name of the type that is created for a variable; it differs by owner."""
        if self.owner or len(name) > _LONGEST:
            digest = crc32(f"{self.owner} {name}".encode()) % 0x10000
            name = f"{name[: _LONGEST - 4]}{digest:04X}"
        return f"{name}_{kind}"

    def _number(self, use: DataUse) -> _Kind:
        begins_at_0 = use.is_assigned and not (use.is_index or use.is_part or use.indices)
        begins_at_0 &= not use.cases or "0" in use.cases  # else it is in none of its states
        value = "0" if begins_at_0 else use.asked_for or "1"
        return _Kind("REAL", f"{value}.0") if REAL in use.types else _Kind("INT", value)

    def _known(self, name: str, type_: Type, use: DataUse) -> _Kind | None:
        if type_ in (BOOL, CHAR):
            truth = "TRUE" if use.left_by and not use.is_assigned else "FALSE"
            return _Kind(str(type_), truth if type_ == BOOL else '" "', use.is_text)
        if not isinstance(type_, Structure | Enumeration) or self._find_type(type_.name) != type_:
            return None
        value = self._values.get(type_.name.upper())
        if value is None:
            value = self._default(type_, name, is_target=bool(use.motions))
        return _Kind(type_.name, value)

    def _named(self, type_: str, name: str) -> _Kind:
        found = self._find_type(type_)
        assert found is not None, "every controller has it"
        return _Kind(type_, self._default(found, name))

    def _enumeration(self, name: str, use: DataUse) -> _Kind:
        first = next(iter(use.constants.values()))
        for one in self._enumerations:
            has_all = not one.is_open and all(constant in one for constant in use.constants)
            if has_all and self._find_type(one.name) == one:
                return _Kind(one.name, f"#{first}")
        made = self._made(name, "E")
        self.types[made] = f"GLOBAL ENUM {made} {','.join(use.constants.values())}"
        return _Kind(made, f"#{first}")

    def _structure(self, name: str, use: DataUse) -> str:
        """Declare a structure with the members that are used; its value."""
        members, values = [], []
        for member, inner in use.members.items():
            kind = self._kind(f"{name}_{member}", inner) or self._number(inner)
            sizes = f"[{_TEXT_LENGTH}]" if kind.is_text else ""
            if inner.indices and not kind.is_text:
                sizes = f"[{','.join(map(str, self._sizes(inner, is_text=False)))}]"
            members.append(f"{kind.name} {member}{sizes}")
            if kind.is_text or not (sizes or kind.value == _NOTHING):
                values.append(f"{member}{'[]' if kind.is_text else ''} {kind.value}")
        self.types[name] = f"GLOBAL STRUC {name} {','.join(members) or 'INT UNUSED'}"
        return f"{{{','.join(values) if members else 'UNUSED 0'}}}"

    @staticmethod
    def _sizes(use: DataUse, *, is_text: bool) -> Sequence[int]:
        count = min(use.indices, 3)
        sizes = [max(_ELEMENTS[count], largest) for largest in use.largest[:count]]
        if prod(sizes) > _MOST_ELEMENTS:
            sizes = [_ELEMENTS[count]] * count
        if is_text:
            sizes[-1] = _TEXT_LENGTH
        return sizes

    def value(self, type_: Type, name: str) -> str:
        """Return a value for data set outside; numbers are 1, a valid divisor and index."""
        if type_ in (INT, REAL):
            return "1" if type_ == INT else "1.0"
        return self._default(type_, name)

    def _default(self, type_: Type, name: str, *, is_target: bool = False) -> str:
        """Return a value of a type as it is written in a data list; ``name`` is its variable.

        Points have places of their own. A FRAME is a point if it ``is_target`` of motions,
        otherwise a base or an offset.
        """
        match type_:
            case Enumeration(constants=constants):
                return f"#{constants[0]}"
            case Structure():
                is_point = is_cartesian(type_) and (is_target or type_.name.upper() != "FRAME")
                if is_point or is_axes(type_):
                    return f"{{{','.join(self._place(type_, name))}}}"
                return f"{{{','.join(self._components(type_, name))}}}"
            case Scalar():
                return {REAL: "0.0", BOOL: "FALSE", CHAR: '" "'}.get(type_, "0")
        return "0"

    def _place(self, type_: Structure, name: str) -> Iterator[str]:
        self.placed.add(re.split(r"\W", name)[0])
        if is_axes(type_):
            place = zip(_ROBOT_AXES, self._places.axes(name), strict=True)
        else:
            place = zip(_COMPONENTS, self._places.pose(name), strict=True)
        yield from (f"{part} {value}" for part, value in place)
        externals = _EXTERNAL & {one.name.upper() for one in type_.members}
        yield from (f"{part} 0.0" for part in sorted(externals))

    def _components(self, type_: Structure, name: str) -> Iterator[str]:
        for member in type_.members:
            if isinstance(member.type, Array):
                if member.type.element == CHAR and len(member.type.sizes) == 1:
                    yield f'{member.name}[] " "'
            elif member.type != UNKNOWN:
                value = self._default(member.type, f"{name}.{member.name}")
                if value != _NOTHING:
                    yield f"{member.name} {value}"

    # ------------------------------------------------------------------------- routines

    def routine(self, name: str, use: RoutineUse, known: PackageRoutine | None = None) -> str:
        """Return the text of a routine without a body; ``known`` is its signature in a package."""
        heads, declared, body = [], [], []
        parameters = () if known is None or known.has_more else known.parameters
        given_to = [*use.arguments, *([] for _ in parameters[len(use.arguments) :])]
        for place, given in enumerate(given_to, start=1):
            parameter = f"P{place}"
            kind, is_out, brackets = self._parameter(f"{name}_{parameter}", given)
            typed = parameters[place - 1] if place <= len(parameters) else None
            if typed is not None and not typed.is_out and self._has_type(typed.type):
                is_out, brackets = False, "[]" if typed.is_array else ""
                kind = _Kind(typed.type, kind.value, is_text=typed.is_array)
            heads.append(f"{parameter}{brackets} :{'OUT' if is_out else 'IN'}")
            declared.append(f"DECL {kind.name} {parameter}{brackets}")
            if is_out and not brackets and kind.value != _NOTHING:
                body += [
                    f'IF VARSTATE("{parameter}")<>#INITIALIZED THEN',
                    f"{parameter}={kind.value}",
                    "ENDIF",
                ]
        lines = [f"GLOBAL DEF {name} ({','.join(heads)} )", *declared, *body, "END"]
        if use.is_function or (known is not None and known.result):
            kind = self._kind(f"{name}_R", use.result) or self._number(DataUse(is_assigned=True))
            is_met = kind.name not in ("INT", "REAL", "BOOL")
            if known is not None and self._has_type(known.result) and not is_met:
                kind = self._result(name, known)
            value = kind.value
            if known is not None and known.default and kind.name == known.result:
                value = known.default
            elif kind.name == "BOOL":
                value = "FALSE" if use.result.left_by is False else "TRUE"
            elif kind.name in ("INT", "REAL"):
                value = "0" if kind.name == "INT" else "0.0"
            lines = [
                f"GLOBAL DEFFCT {kind.name} {name} ({','.join(heads)} )",
                *declared,
                f"DECL {kind.name} RESULT",
                *body,
                *([f"RESULT={value}"] if value != _NOTHING else ()),
                "RETURN RESULT",
                "ENDFCT",
            ]
        return "\n".join(lines) + "\n"

    def _has_type(self, name: str) -> bool:
        return name in SCALARS or (bool(name) and self._find_type(name) is not None)

    def _result(self, name: str, known: PackageRoutine) -> _Kind:
        """Return the result of a package routine."""
        found = SCALARS.get(known.result) or self._find_type(known.result)
        assert found is not None, "it was looked for"
        value = self._values.get(known.result)
        return _Kind(known.result, self._default(found, name) if value is None else value)

    def _parameter(self, name: str, given: Sequence[tuple[Type, bool]]) -> tuple[_Kind, bool, str]:
        """Return the type of a parameter, whether it is :OUT, and the brackets of an array."""
        use = DataUse(is_assigned=True)
        brackets = ""
        for type_, _ in given:
            match type_:
                case Constant(name=constant):
                    use.constants.setdefault(constant.upper(), constant)
                case Text() | Array(element=Scalar(name="CHAR")):
                    use.is_text = True
                case Array(element=element, sizes=sizes):
                    use.types.append(element)
                    brackets = f"[{',' * (len(sizes) - 1)}]"
                case _:
                    use.types.append(type_)
        kind = self._kind(name, use) or self._number(use)
        brackets = "[]" if kind.is_text else brackets
        is_out = bool(given) and all(
            is_variable and str(_element(type_)) == kind.name for type_, is_variable in given
        )
        return kind, is_out and not kind.is_text, brackets


def _element(type_: Type) -> Type:
    return type_.element if isinstance(type_, Array) else type_
