"""Literals: constants of each type, aggregates, and initial values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import product
from typing import Final

from grammar.generation.choices import Choices
from grammar.generation.types import TEXT
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type

#: The path to a part: literal text, or the size of a dimension for which to draw an index.
Path = tuple[str | int, ...]


@cache
def parts(type_: Type) -> Mapping[Type, tuple[Path, ...]]:
    """Return the paths to the parts of a type, by the type of the part; itself included.

    An array of open size is taken to have two elements in each dimension, which every array that is
    passed has.
    """
    found: dict[Type, list[Path]] = {type_: [()]}
    ways: list[tuple[Path, Type]] = []
    if isinstance(type_, Structure):
        ways = [((f".{member.name}",), member.type) for member in type_.members]
    elif isinstance(type_, Array):
        way: Path = ("[",)
        for place, size in enumerate(type_.sizes):
            way += (",",) * (place > 0) + (2 if size is None else size,)
        ways = [((*way, "]"), type_.element)]
    for way, inner in ways:
        for part, paths in parts(inner).items():
            found.setdefault(part, []).extend(way + path for path in paths)
    return {part: tuple(paths) for part, paths in found.items()}


def elements(type_: Array) -> Iterator[str]:
    """Yield the indices of all elements, as written, in ascending order."""
    for place in product(*(range(1, (size or 0) + 1) for size in type_.sizes)):
        yield ",".join(map(str, place))


def type_name(type_: Type) -> str:
    """Return the name of a type in a declaration; for an array that of its elements."""
    return type_name(type_.element) if isinstance(type_, Array) else str(type_)


def declarator(type_: Type, name: str, *, is_open: bool = False) -> str:
    """Return a name with its array sizes: ``A[2,3]``, or ``A[,]`` if they are open."""
    if not isinstance(type_, Array):
        return name
    return f"{name}[{','.join('' if is_open or n is None else str(n) for n in type_.sizes)}]"


_INTEGERS: Final = (
    *("0", "1", "2", "3", "4", "5", "7", "8", "10", "12", "31", "64", "100", "255", "1000"),
    *("'B101'", "'HF'", "'H7F'", "'B0110'", "32767"),
)
#: Integers that are rarely drawn.
_LARGE: Final = (
    *("2147483647", "16777217", "'HFFFFFFFF'", "'H80000000'", "65536", "1073741824"),
    "99999999",
)
_REALS: Final = (
    *("0.0", "0.5", "1.0", "1.5", "2.0", "0.1", "3.25", "10.0", "45.0", "90.0", "0.25"),
    *("100.0", "2.5", "3.5", "0.333333333", "1.0E-3", "2.5E+2", "12.3456789", "180.0"),
    *("7.0E1", "1.0E-45"),
)
_LETTERS: Final = "AZaz09 +.x"
_TEXTS: Final = (
    *("", "A", "abc", "KRL", "a b", "12", "-7", "3.5", "xyz12", "TRUE", "Hello World"),
    *(" 7 ", "+1.E5", "1e400", "2147483648", "-2147483648", "0x1F", "tRuE", ".5e-3 9"),
)


def constant(choices: Choices, type_: Type, *, is_signed: bool = True) -> str:
    """Return a constant; ``is_signed`` says that a sign may precede it."""
    if type_ == INT:
        text = choices.pick(_LARGE if choices.chance(3) else _INTEGERS)
        is_negative = is_signed and text.isdigit() and choices.chance(15)
        return f"-{text}" if is_negative else text
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
        return _aggregate(choices, type_)
    assert isinstance(type_, Array), type_
    return f'"{choices.pick(_TEXTS)}"'


def _aggregate(choices: Choices, type_: Structure, *, is_full: bool = False) -> str:
    """Return an aggregate; its first component is always present, the others nearly always."""
    written: list[str] = []
    for place, member in enumerate(type_.members):
        if place and not is_full and choices.chance(1):
            continue
        if isinstance(member.type, Array):
            written += _elements(choices, member.name, member.type)
        elif isinstance(member.type, Structure):
            value = _aggregate(choices, member.type, is_full=is_full)
            written.append(f"{member.name} {value}")
        else:
            written.append(f"{member.name} {constant(choices, member.type)}")
    prefix = f"{type_.name}: " if choices.chance(25) else ""
    return f"{{{prefix}{','.join(written)}}}"


def _elements(choices: Choices, name: str, type_: Array) -> list[str]:
    if type_.is_text:
        return [f"{name}[] {constant(choices, type_)}"]
    return [f"{name}[{index}] {constant(choices, type_.element)}" for index in elements(type_)]


def initialisation(choices: Choices, type_: Type, name: str) -> list[tuple[str, str]]:
    """Return targets and constants that together initialise all of a variable [TYP-10]."""
    if isinstance(type_, Structure):
        return [(name, _aggregate(choices, type_, is_full=True))]
    if not isinstance(type_, Array):
        return [(name, constant(choices, type_))]
    if type_.is_text:
        return [(f"{name}[]", constant(choices, type_))]
    if type_.element == CHAR:
        rows = elements(Array(CHAR, type_.sizes[:-1]))
        return [(f"{name}[{row},]", constant(choices, TEXT)) for row in rows]
    return [
        found
        for index in elements(type_)
        for found in initialisation(choices, type_.element, f"{name}[{index}]")
    ]
