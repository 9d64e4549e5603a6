"""Signatures of option packages: ``system/packages.tsv``.

A backup that calls a package often lacks its files. `load_packages` returns the routines, types and
data of all packages by name in upper case, each with its package; types are written in KRL, because
a project may declare them itself. A run makes stand-ins from them (`interp.standins`). A check
treats such a name as declared if the package is installed, or if the project calls another routine
of the same package: ``load_packages().routines["EKI_OPEN"].package`` is ``"EKI"`` and
``parameters`` are its parameters. An entry that rests on source R alone is unconfirmed: its name is
likely, its parameters are unknown.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from support.files.tables import read_table
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class PackageParameter:
    """A parameter; ``type`` is ``?`` if it is unknown.

    ``is_optional`` says that a call can leave it out.
    """

    name: str
    type: str
    is_array: bool
    is_out: bool
    is_optional: bool


@dataclass(frozen=True, slots=True)
class PackageRoutine:
    """A routine; ``result`` is the name of its type, "" for a procedure.

    ``default`` is the value that a stand-in returns, "" for the default of the type. ``has_more``
    says that its parameters are unknown, or that more arguments of any type can follow.
    """

    package: str
    name: str
    result: str
    parameters: tuple[PackageParameter, ...]
    has_more: bool
    default: str
    is_unconfirmed: bool


@dataclass(frozen=True, slots=True)
class PackageType:
    """A structure or enumeration as the text of its declaration; ``default`` is a value of it."""

    package: str
    name: str
    declaration: str
    default: str


@dataclass(frozen=True, slots=True)
class PackageVariable:
    """A variable with the name of its type and its value."""

    package: str
    name: str
    type: str
    value: str


@dataclass(frozen=True, slots=True)
class Packages:
    """The declarations of all packages, by name in upper case."""

    routines: Mapping[str, PackageRoutine]
    types: Mapping[str, PackageType]
    variables: Mapping[str, PackageVariable]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the packages in alphabetical order."""
        parts: tuple[PackageRoutine | PackageType | PackageVariable, ...] = (
            *self.routines.values(),
            *self.types.values(),
            *self.variables.values(),
        )
        return tuple(sorted({one.package for one in parts}))


@cache
def load_packages() -> Packages:
    """Return the packages in the table."""
    columns, *rows = read_table("grammar", "system/packages.tsv")
    routines: dict[str, PackageRoutine] = {}
    types: dict[str, PackageType] = {}
    variables: dict[str, PackageVariable] = {}
    for row in (dict(zip(columns, cells, strict=True)) for cells in rows):
        package, name, default = row["package"], row["name"], row["default"]
        match row["kind"]:
            case "routine":
                routines[name] = _routine(row)
            case "variable":
                variables[name] = PackageVariable(package, name, row["result"], default)
            case kind:
                declaration = _declaration(kind, name, row["parameters"])
                types[name] = PackageType(package, name, declaration, default)
    return Packages(routines, types, variables)


def _routine(row: Mapping[str, str]) -> PackageRoutine:
    written = [part.strip() for part in row["parameters"].split(";") if part]
    parameters = tuple(_parameter(text) for text in written if text != "...")
    return PackageRoutine(
        package=row["package"],
        name=row["name"],
        result=row["result"],
        parameters=parameters,
        has_more="..." in written,
        default=row["default"],
        is_unconfirmed=row["source"] == "R",
    )


def _parameter(text: str) -> PackageParameter:
    mode, type_, word = text.split()
    name, bracket, _ = word.partition("[")
    return PackageParameter(name, type_, bool(bracket), mode == "OUT", mode.endswith("?"))


def _declaration(kind: str, name: str, content: str) -> str:
    """Return a declaration as KRL; ``INT A B; BOOL C`` becomes ``INT A,B,BOOL C``."""
    if kind == "enum":
        return f"GLOBAL ENUM {name} {','.join(content.split())}"
    groups = (group.split() for group in content.split(";"))
    members = (f"{type_} {','.join(names)}" for type_, *names in groups)
    return f"GLOBAL STRUC {name} {','.join(members)}"
