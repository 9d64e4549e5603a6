"""What the controller predefines: system variables, types, functions and messages, as data.

The tables are in ``system/``. Each entry has its source and, if known, the releases that have it;
``system/README.md`` says how to read and extend them. Supporting a newer release only needs changes
to the tables. A table is read on its first use, and an entry is built when it is looked up.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from operator import itemgetter
from typing import Literal, TypeVar

from grammar.semantics.rules import is_confirmed, tiers
from grammar.semantics.types import (
    BOOL,
    SCALARS,
    UNKNOWN,
    Array,
    Enumeration,
    Member,
    Structure,
    Type,
)
from support.files.tables import read_table
from support.lazy_dataclass import dataclass

#: A release of the controller's software, KSS: 8.6 is ``(8, 6)``.
Release = tuple[int, int]

_Row = Mapping[str, str]
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class SystemVariable:
    """A variable of the controller.

    ``type`` is `UNKNOWN` if no declaration written by the controller was available; array sizes are
    the largest documented ones. ``signal`` says whether it refers to inputs or outputs or is
    "unconnected"; the type is INT if it is a group. ``access`` is "read" if the variable is
    write-protected, "write" if it can be written; ``access_unconfirmed`` if that is recollection
    only. ``limits`` are the least and greatest value. ``stops_on_read`` and ``stops_on_write`` are
    the rules by which reading or writing it stops the advance run; empty if it does not. ``twin``
    is the variable with its value in the main run. ``file`` is the file that declares it in a
    delivered controller and may differ in another one; "" if the controller itself declares it.
    """

    name: str
    type: Type
    signal: Literal["inputs", "outputs", "unconnected"] | None
    access: Literal["read", "write"] | None
    access_unconfirmed: bool
    limits: tuple[int, int] | None
    stops_on_read: tuple[str, ...]
    stops_on_write: tuple[str, ...]
    twin: str | None
    file: str
    source: tuple[str, ...]
    meaning: str

    @property
    def rules(self) -> tuple[str, ...]:
        """The sources that are rule IDs."""
        return tuple(key for key in self.source if key in tiers())


@dataclass(frozen=True, slots=True)
class PredefinedParameter:
    """A parameter of a predefined function; ``mode`` is IN, OUT, or empty if it is not known."""

    name: str
    type: Type
    mode: str

    @property
    def is_out(self) -> bool:
        """Whether the function may change the argument."""
        return self.mode != "IN"


@dataclass(frozen=True, slots=True)
class PredefinedFunction:
    """A predefined routine; ``result`` is ``None`` if it returns no value.

    ``more`` describes the arguments that can follow those of ``parameters``; ``None`` if none can.
    ``stops`` are the rules by which it stops the advance run.
    """

    name: str
    result: Type | None
    parameters: tuple[PredefinedParameter, ...]
    more: PredefinedParameter | None
    stops: tuple[str, ...]
    source: tuple[str, ...]
    meaning: str

    def parameter(self, place: int) -> PredefinedParameter | None:
        """Return the parameter of the argument at ``place``, counted from 0, if it can have one."""
        return self.parameters[place] if place < len(self.parameters) else self.more

    def takes(self, count: int) -> bool:
        """Return whether a call may have so many arguments."""
        least = len(self.parameters)
        return count == least or (count > least and self.more is not None)

    @property
    def is_unconfirmed(self) -> bool:
        """Whether its parameters rest on recollection only, which cannot support an error."""
        rules = [key for key in self.source if key in tiers()]
        return "R" in self.source or (len(rules) == len(self.source) and not is_confirmed(rules))


@dataclass(frozen=True, slots=True)
class Message:
    """A message of the controller, in our words.

    ``phase`` is "check" if it is issued before a program runs, otherwise "run". ``kind`` is its
    class (state, acknowledgement, notification), empty if that is unknown. ``same_as`` is the
    number of the message that says the same and that we report instead of this one.
    """

    number: int
    phase: Literal["check", "run"]
    kind: str
    same_as: int | None
    text: str
    source: tuple[str, ...]


class _Entries(Mapping[str, _T]):
    """The rows of a table for one release, by name in any letter case; built on demand.

    If several rows have the same name, the first one counts, which is the newest.
    """

    def __init__(self, table: str, release: Release | None, make: Callable[[_Row], _T]) -> None:
        self._columns, rows = _table(table)
        if release is not None and "releases" in self._columns:
            place = self._columns.index("releases")
            rows = [row for row in rows if _is_in(release, row[place])]
        self._rows = {row[0].upper(): row for row in reversed(rows)}
        self._make = make
        self._made: dict[str, _T] = {}

    def __getitem__(self, name: str) -> _T:
        key = name.upper()
        found = self._made.get(key)
        if found is None:
            row = dict(zip(self._columns, self._rows[key], strict=True))
            found = self._made[key] = self._make(row)
        return found

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name.upper() in self._rows

    def cell(self, name: str, column: str) -> str:
        """Return the text in a column of a row."""
        return self._rows[name.upper()][self._columns.index(column)]

    def __iter__(self) -> Iterator[str]:
        return reversed(self._rows)

    def __len__(self) -> int:
        return len(self._rows)


class System:
    """What a controller of one release predefines. `System.load` builds and caches it.

    Names are looked up in any letter case and listed in upper case.
    """

    def __init__(self, release: Release | None) -> None:
        self.release = release
        self.channels: Mapping[str, str] = _Entries("channels", release, itemgetter("name"))
        #: Functions and procedures that no file declares.
        self.functions = _Entries("functions", release, self._function)
        self._messages = _Entries("messages", release, _message)
        #: Structures and enumerations; `UNKNOWN` if only the name is known. Those declared in a
        #: delivered ``$config.dat`` are open: another file may add members.
        self.types = _Entries("types", release, self._type)
        #: Variables, including those of a delivered ``$config.dat`` (`SystemVariable.file`).
        self.variables = _Entries("variables", release, self._variable)

    @staticmethod
    @cache
    def load(release: str | None = None) -> System:
        """Return what is predefined in a release, given as "8.6" or "KSS 8.6.2".

        Without a release it is everything that any release has, in its newest form. Raises
        `ValueError` if the text contains no release.
        """
        if release is None:
            return System(None)
        found = re.search(r"(\d+)\.(\d+)", release)
        if not found:
            raise ValueError(f"not a release such as 8.6: {release!r}")
        return System((int(found[1]), int(found[2])))

    def is_described(self, type_: Type) -> bool:
        """Return whether the members of a type rest on a rule, not only on one release's tables.

        Types that files declare are described by their declarations.
        """
        if (
            not isinstance(type_, Structure | Enumeration)
            or self.types.get(type_.name) is not type_
        ):
            return True
        return any(key in tiers() for key in self.types.cell(str(type_), "source").split())

    def message(self, number: int) -> Message | None:
        """Return the message with a number, or ``None`` if it is unknown."""
        return self._messages.get(str(number))

    @property
    def messages(self) -> list[Message]:
        """All known messages, by number."""
        return list(self._messages.values())

    # ----------------------------------------------------------------------- from the tables

    def _named(self, name: str) -> Type:
        """Return the type with a name in a table; a question mark means that it is uncertain."""
        if name.startswith("?"):
            return UNKNOWN
        return SCALARS[name] if name in SCALARS else self.types[name]

    def _typed(self, name: str, sizes: str) -> Type:
        element = self._named(name)
        if not sizes or element == UNKNOWN:
            return element
        return Array(
            element, tuple(int(size) if size.isdigit() else None for size in _split(sizes))
        )

    def _variable(self, row: _Row) -> SystemVariable:
        type_name, _, side = row["type"].partition(" ")
        is_signal = type_name == "SIGNAL"
        access = row["access"]
        low, _, high = row["range"].partition("..")
        ways, _, stops = row["stops"].partition(" ")
        rules = tuple(stops.split())
        return SystemVariable(
            name=row["name"],
            type=BOOL if is_signal else self._typed(type_name, row["size"]),
            signal=_SIDES[side] if is_signal else None,
            access=_ACCESS[access.rstrip("?")],
            access_unconfirmed=access.endswith("?"),
            limits=(int(low), int(high)) if high else None,
            stops_on_read=rules if "r" in ways else (),
            stops_on_write=rules if "w" in ways else (),
            twin=row["twin"] or None,
            file=row["file"],
            source=tuple(row["source"].split()),
            meaning=row["meaning"].removeprefix("-"),
        )

    def _type(self, row: _Row) -> Type:
        name, content, is_open = row["name"], row["content"], row["content"].endswith("...")
        if row["kind"] == "enum":
            constants = tuple(word for word in content.split() if word != "...")
            return Enumeration(name, constants, is_open)
        if row["kind"] == "struct":
            groups = (group.split() for group in _split(content, ";") if group != "...")
            members = tuple(
                Member(member, self._typed(type_name, sizes))
                for type_name, *words in groups
                for member, sizes in map(_indexed, words)
            )
            return Structure(name, members, is_open)
        return UNKNOWN

    def _function(self, row: _Row) -> PredefinedFunction:
        parameters = _split(row["parameters"], ";")
        has_more = bool(parameters) and parameters[-1].endswith("...")
        mode = parameters.pop().removesuffix("...").strip() if has_more else ""
        return PredefinedFunction(
            name=row["name"],
            result=self._named(row["result"]) if row["result"] else None,
            parameters=tuple(map(self._parameter, parameters)),
            more=PredefinedParameter("VALUE", UNKNOWN, mode) if has_more else None,
            stops=tuple(row["stops"].split()),
            source=tuple(row["source"].split()),
            meaning=row["meaning"].removeprefix("-"),
        )

    def _parameter(self, text: str) -> PredefinedParameter:
        mode, type_name, word = text.split()
        name, sizes = _indexed(word)
        return PredefinedParameter(name, self._typed(type_name, sizes), mode)


def is_priority(number: float) -> bool:
    """Return whether a program may give this number to an interrupt or trigger [INT-02, TRG-06]."""
    return number in (1, 2) or 4 <= number <= 39 or 81 <= number <= 128


_SIDES: Mapping[str, Literal["inputs", "outputs", "unconnected"]] = {
    "IN": "inputs",
    "OUT": "outputs",
    "": "unconnected",
}
_ACCESS: Mapping[str, Literal["read", "write"] | None] = {"r": "read", "rw": "write", "": None}


def _message(row: _Row) -> Message:
    return Message(
        number=int(row["number"]),
        phase="check" if row["phase"] == "check" else "run",
        kind=row["class"],
        same_as=int(row["same_as"]) if row["same_as"] else None,
        text=row["text"],
        source=tuple(row["source"].split()),
    )


@cache
def _table(name: str) -> tuple[list[str], list[list[str]]]:
    """Return the names of the columns of a table, and its rows."""
    columns, *rows = read_table("grammar", f"system/{name}.tsv")
    return columns, rows


def _is_in(release: Release | None, releases: str) -> bool:
    """Return whether a release lies in a range such as ``8.6..`` or ``..4.1``; "" means all."""
    if release is None or not releases:
        return True
    low, _, high = releases.partition("..")
    return (not low or _number(low) <= release) and (not high or release <= _number(high))


def _number(release: str) -> Release:
    major, _, minor = release.partition(".")
    return int(major), int(minor)


def _split(text: str, separator: str = ",") -> list[str]:
    return [part.strip() for part in text.split(separator)] if text else []


def _indexed(word: str) -> tuple[str, str]:
    """Return the name and the sizes of ``NAME[32]``; "" for no sizes, ``?`` for an unknown one."""
    name, _, sizes = word.partition("[")
    return name, sizes.rstrip("]")
