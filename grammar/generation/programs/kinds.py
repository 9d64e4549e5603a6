"""The types that generated programs use, their constants, and the parts that values have."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Final

from grammar.generation.programs.choices import Choices
from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    Array,
    Enumeration,
    Member,
    Structure,
    Type,
)

__all__ = [
    "AXIS_TYPES",
    "CASES",
    "COLOUR",
    "MODE",
    "POINT",
    "POSES",
    "RECORD",
    "SCALARS",
    "STATE",
    "TEXT",
    "USERS",
    "VAR_STATE",
    "VAR_TYPE",
    "WITHOUT_DECL",
    "Piece",
    "aggregate",
    "constant",
    "declared",
    "initialisation",
    "parts",
    "predefined",
    "structure",
]

SCALARS: Final = (INT, REAL, BOOL, CHAR)
#: A text of any length.
TEXT: Final = Array(CHAR, (None,))


def predefined(name: str) -> Type:
    """A type that the controller brings along."""
    return System.load().types[name]


def structure(name: str) -> Structure:
    """A structure that the controller brings along."""
    found = predefined(name)
    assert isinstance(found, Structure)
    return found


#: Types that programs declare themselves. A structure holds structures, arrays and texts.
COLOUR: Final = Enumeration("COLOUR_T", ("RED", "GREEN", "BLUE", "END"))
MODE: Final = Enumeration("MODE_T", ("IDLE", "BUSY"))
POINT: Final = Structure(
    "POINT_T", (Member("PX", REAL), Member("PY", REAL), Member("N", INT), Member("C", COLOUR))
)
RECORD: Final = Structure(
    "RECORD_T",
    (
        Member("P", POINT),
        Member("FR", structure("FRAME")),
        Member("OK", BOOL),
        Member("K", Array(INT, (3,))),
        Member("TXT", Array(CHAR, (6,))),
        Member("L", CHAR),
    ),
)
USERS: Final = (COLOUR, MODE, POINT, RECORD)
POSES: Final = tuple(structure(name) for name in ("FRAME", "POS", "E3POS", "E6POS"))
AXIS_TYPES: Final = tuple(structure(name) for name in ("AXIS", "E3AXIS", "E6AXIS"))
CASES: Final = predefined("CASE_SENSE_T")
STATE: Final = structure("STATE_T")
VAR_STATE: Final = predefined("VAR_STATE")
VAR_TYPE: Final = predefined("VAR_TYPE")

#: A part of a path to a value: text as it is, or an index for a dimension of so many elements.
Piece = str | int


@cache
def parts(type_: Type) -> tuple[tuple[Type, tuple[Piece, ...]], ...]:
    """A type itself and those of all its parts, with the way that leads to each.

    An array of open size is taken to have two elements in each dimension, as all that are passed
    have at least.
    """
    found: list[tuple[Type, tuple[Piece, ...]]] = [(type_, ())]
    if isinstance(type_, Structure):
        for member in type_.members:
            way: tuple[Piece, ...] = (f".{member.name}",)
            found += [(one, way + rest) for one, rest in parts(member.type)]
    elif isinstance(type_, Array):
        way = ("[",)
        for place, size in enumerate(type_.sizes):
            way += (",",) * (place > 0) + (2 if size is None else size,)
        found += [(one, (*way, "]", *rest)) for one, rest in parts(type_.element)]
    return tuple(found)


# ------------------------------------------------------------------------------- declarations


def declared(type_: Type, name: str, *, is_open: bool = False) -> tuple[str, str]:
    """The name of the type, and the declarator: ``("INT", "A[2,3]")``; ``A[,]`` where open."""
    if isinstance(type_, Array):
        sizes = ",".join("" if is_open or size is None else str(size) for size in type_.sizes)
        return str(_name(type_.element)), f"{name}[{sizes}]"
    return _name(type_), name


def _name(type_: Type) -> str:
    return str(type_.name) if isinstance(type_, Structure | Enumeration) else str(type_)


# ------------------------------------------------------------------------------- constants

_INTEGERS: Final = (
    *("0", "1", "2", "3", "4", "5", "7", "8", "10", "12", "31", "64", "100", "255", "1000"),
    *("'B101'", "'HF'", "'H7F'", "'B0110'", "32767"),
)
_LARGE: Final = (
    "2147483647",
    "16777217",
    "'HFFFFFFFF'",
    "'H80000000'",
    "65536",
    "1073741824",
    "99999999",
)
_REALS: Final = (
    *("0.0", "0.5", "1.0", "1.5", "2.0", "0.1", "3.25", "10.0", "45.0", "90.0", "0.25", "100.0"),
    *("2.5", "3.5", "0.333333333", "1.0E-3", "2.5E+2", "12.3456789", "180.0", "7.0E1"),
)
_LETTERS: Final = "AZaz09 +.x"
_TEXTS: Final = ("", "A", "abc", "KRL", "a b", "12", "-7", "3.5", "xyz12", "TRUE", "Hello World")


def constant(choices: Choices, type_: Type, *, is_signed: bool = True) -> str:
    """A constant as written; a structure is written as an aggregate of most of its parts.

    ``is_signed`` tells that a sign may stand in front.
    """
    if type_ == INT:
        text = choices.pick(_LARGE) if choices.chance(3) else choices.pick(_INTEGERS)
        return f"-{text}" if is_signed and text.isdigit() and choices.chance(15) else text
    if type_ == REAL:
        text = choices.pick(_REALS)
        return f"-{text}" if is_signed and choices.chance(20) else text
    if type_ == BOOL:
        return choices.pick(("TRUE", "FALSE"))
    if type_ == CHAR:
        return f'"{choices.pick(_LETTERS)}"'
    if isinstance(type_, Enumeration):
        return f"#{choices.pick(type_.constants)}"
    if isinstance(type_, Structure):
        return aggregate(choices, type_)
    assert isinstance(type_, Array)
    return f'"{choices.pick(_TEXTS)}"'


def aggregate(choices: Choices, type_: Structure, *, is_full: bool = False) -> str:
    """An aggregate; its first part is always there, the others nearly always."""
    written: list[str] = []
    for place, member in enumerate(type_.members):
        if place and not is_full and choices.chance(1):
            continue
        if isinstance(member.type, Array):
            written += _elements(choices, member.name, member.type)
        elif isinstance(member.type, Structure):
            written.append(f"{member.name} {aggregate(choices, member.type, is_full=is_full)}")
        else:
            written.append(f"{member.name} {constant(choices, member.type)}")
    prefix = f"{type_.name}: " if choices.chance(25) else ""
    return f"{{{prefix}{','.join(written)}}}"


def _elements(choices: Choices, name: str, type_: Array) -> list[str]:
    if type_.is_text:
        return [f"{name}[] {constant(choices, type_)}"]
    sizes = [size or 0 for size in type_.sizes]
    return [
        f"{name}[{','.join(map(str, place))}] {constant(choices, type_.element)}"
        for place in product(*(range(1, size + 1) for size in sizes))
    ]


def initialisation(choices: Choices, type_: Type, name: str) -> list[tuple[str, str]]:
    """Targets and constants that give a variable a value in all its parts."""
    if isinstance(type_, Structure):
        return [(name, aggregate(choices, type_, is_full=True))]
    if not isinstance(type_, Array):
        return [(name, constant(choices, type_))]
    if type_.is_text:
        return [(f"{name}[]", constant(choices, type_))]
    found: list[tuple[str, str]] = []
    sizes = [size or 0 for size in type_.sizes]
    is_rows = type_.element == CHAR
    for place in product(*(range(1, size + 1) for size in (sizes[:-1] if is_rows else sizes))):
        written = ",".join(map(str, place))
        if is_rows:
            found.append((f"{name}[{written},]", constant(choices, TEXT)))
        else:
            found += initialisation(choices, type_.element, f"{name}[{written}]")
    return found


#: What predefined types are declared without DECL [TYP-06].
WITHOUT_DECL: Final = frozenset(
    "INT REAL BOOL CHAR FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split()
)
