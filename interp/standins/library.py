"""Reads the library: our own KRL versions of routines and data of controllers and packages.

A backup often lacks the routines behind inline forms, and the data of $config.dat that they need.
The files in ``library/`` are written from the rules and from public manuals. Each routine and each
declaration is independent, so only those that a backup lacks are used. Types and variables of
option packages are in `grammar.semantics.packages`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable

from grammar.semantics.packages import load_packages
from grammar.syntax import ast
from grammar.syntax.build import read_module
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Datum:
    """A variable: the name of its type, and its value; an aggregate by its members."""

    type: str
    value: str
    members: Mapping[str, str] | None


@dataclass(frozen=True, slots=True)
class Library:
    """Texts of routines and types, and variables with their values, by name in upper case."""

    routines: Mapping[str, str]
    types: Mapping[str, str]
    data: Mapping[str, Datum]


@dataclass(slots=True)
class _Reader:
    routines: dict[str, str] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    data: dict[str, Datum] = field(default_factory=dict)

    def take(self, text: str) -> None:
        module = read_module(text)
        assert isinstance(module, ast.Module), "our own files can be read"
        if isinstance(module.content, ast.Program):
            for routine in module.content.routines:
                self.routines[routine.name.key] = text[slice(*routine.span)] + "\n"
            return
        for item in module.content.items:
            if isinstance(item, ast.Enumeration | ast.Structure):
                self.types[item.name.key] = text[slice(*item.span)]
            elif isinstance(item, ast.VariableDeclaration):
                for one in item.declarators:
                    self.data[one.name.key] = _datum(text, item.type.key, one.value)


def _datum(text: str, type_: str, value: ast.Expression | None) -> Datum:
    assert value is not None, "each datum of the library has a value"
    members = None
    if isinstance(value, ast.Aggregate):
        members = {part.name.key: text[slice(*part.span)] for part in value.components}
    return Datum(type_, text[slice(*value.span)], members)


@cache
def load_library() -> Library:
    """Return the library of this package."""
    reader = _Reader()
    for file in _files():
        reader.take(file.read_text(encoding="utf-8"))
    reader.take(_of_packages())
    return Library(reader.routines, reader.types, reader.data)


def _of_packages() -> str:
    """Return types and variables of option packages as a data list; a default for each type."""
    packages = load_packages()
    lines = [one.declaration for one in packages.types.values()]
    lines += [
        f"DECL GLOBAL {one.name} {one.name}_DEFAULT={one.default}"
        for one in packages.types.values()
        if one.default
    ]
    lines += [
        f"DECL GLOBAL {one.type} {one.name}={one.value}" for one in packages.variables.values()
    ]
    return "\n".join(["DEFDAT PACKAGES PUBLIC", *lines, "ENDDAT", ""])


def _files() -> Iterator[Traversable]:
    folder = resources.files("interp.standins").joinpath("library")
    yield from sorted(folder.iterdir(), key=lambda file: file.name)
