"""Profiles: the differences between releases of the controller, as data in ``profiles/*.toml``.

A profile has the sizes of arrays, the interpolation cycle, the number of interrupts, and the
initial values of system variables [CON-07]. It is selected by its name, or by the path of another
file.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from datetime import datetime
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from grammar.semantics.predefined import System
from interp.values.faults import RuntimeFailure
from support.files.untrusted import DocumentError, read_text, toml_of
from support.lazy_dataclass import dataclass

_T = TypeVar("_T")


class ProfileError(RuntimeFailure):
    """A profile does not exist or is invalid; the text is one line."""


#: The entries that every profile must have.
_SIZES = "inputs outputs analog_inputs analog_outputs flags cyclic_flags timers".split()
_MOST = (
    "cyclic_flags interrupts active_interrupts triggers analog_inputs analog_outputs digital_inputs"
).split()
_LARGEST = 10_000_000
_LAST_YEAR = 9_000
_ARM = re.compile(r"[A-Za-z0-9_]+")


@dataclass(frozen=True, slots=True)
class Profile:
    """One profile.

    ``cycle`` is the interpolation cycle in µs. ``statements`` and ``requests`` limit what a task
    may do in a cycle. ``start`` is the date at which the virtual clock begins. ``submit_every`` is
    the period of the submit interpreter in cycles. ``sizes`` are those of arrays; ``most`` says how
    many interrupts, triggers and so on there may be at once. ``values`` are initial values by name,
    as `interp.values.json_form` writes them.

    With ``runs_coincidence``, the first motion is a block coincidence run: it ends exactly, and the
    program waits until it is started again [ADV-14]. With ``is_tolerant``, a motion that cannot be
    planned and a predefined routine that is not simulated are skipped with a message instead of
    being a fault. With ``brings_arm``, a program may begin with any motion.
    """

    name: str
    release: str
    machine: str
    cycle: int
    statements: int
    requests: int
    start: datetime
    advance: int
    runs_coincidence: bool
    submit_every: int
    submit_requests: int
    sizes: Mapping[str, int]
    most: Mapping[str, int]
    values: Mapping[str, Any]
    is_tolerant: bool = False
    brings_arm: bool = False

    @staticmethod
    def load(name: str = "kss8") -> Profile:
        """Return the profile of a name or of a ``.toml`` file; raise `ProfileError`."""
        if name.lower().endswith(".toml"):
            try:
                return _read(Path(name).stem, read_text(Path(name)))
            except (OSError, UnicodeDecodeError) as error:
                raise ProfileError(f"{name} cannot be read: {error}") from None
        return _built_in(name)


def profile_names() -> list[str]:
    """Return the names of the built-in profiles."""
    folder = resources.files(__package__).joinpath("profiles")
    return sorted(one.name.removesuffix(".toml") for one in folder.iterdir() if _is_profile(one))


def _is_profile(entry: Any) -> bool:
    return str(entry.name).endswith(".toml")


@cache
def _built_in(name: str) -> Profile:
    if name not in profile_names():
        known = ", ".join(profile_names())
        raise ProfileError(f"there is no profile {name}; there are {known}, and any .toml file")
    file = resources.files(__package__).joinpath("profiles", f"{name}.toml")
    return _read(name, file.read_text(encoding="utf-8"))


def _read(name: str, text: str) -> Profile:
    try:
        data = toml_of(text)
    except DocumentError as error:
        raise ProfileError(f"profile {name}: {error}") from None
    reader = _Reader(name, data)
    coincidence = reader.get("advance", "coincidence", str)
    if coincidence not in ("assumed", "run"):
        raise reader.wrong("advance", "coincidence", 'is neither "assumed" nor "run"')
    return Profile(
        name,
        reader.get("", "release", str),
        reader.machine(),
        reader.count("time", "cycle"),
        reader.count("time", "statements"),
        reader.count("time", "requests"),
        reader.start(),
        reader.count("advance", "default", 0),
        coincidence == "run",
        reader.count("submit", "every"),
        reader.count("submit", "requests"),
        reader.counts("sizes", _SIZES),
        reader.counts("most", _MOST),
        reader.values(),
    )


@dataclass(frozen=True, slots=True)
class _Reader:
    """Reads the entries of a profile, with a clear error for an invalid one."""

    name: str
    data: Mapping[str, Any]

    def wrong(self, table: str, key: str, why: str) -> ProfileError:
        """Return an error about an entry."""
        return ProfileError(f"profile {self.name}: {table + '.' if table else ''}{key} {why}")

    def get(self, table: str, key: str, type_: type[_T]) -> _T:
        """Return an entry of a type."""
        holder = self.data.get(table, {}) if table else self.data
        value = holder.get(key) if isinstance(holder, Mapping) else None
        if not isinstance(value, type_) or (isinstance(value, bool) and type_ is int):
            raise self.wrong(table, key, f"is no {type_.__name__}")
        return value

    def machine(self) -> str:
        """Return the name of a built-in arm; a path is rejected, wherever the profile is from."""
        name = self.get("", "machine", str)
        if not _ARM.fullmatch(name):
            raise self.wrong("", "machine", "is no name of letters, digits and _")
        return name

    def start(self) -> datetime:
        """Return the date at which the clock begins; it leaves room for a run after it."""
        start = self.get("time", "start", datetime)
        if start.year > _LAST_YEAR:
            raise self.wrong("time", "start", f"is after {_LAST_YEAR}")
        return start

    def count(self, table: str, key: str, least: int = 1) -> int:
        """Return an entry that is a count between ``least`` and `_LARGEST`."""
        value = self.get(table, key, int)
        if value < least:
            raise self.wrong(table, key, f"is below {least}")
        if value > _LARGEST:
            raise self.wrong(table, key, f"is above {_LARGEST:,}")
        return value

    def values(self) -> Mapping[str, Any]:
        """Return the initial values of system variables, by their names in upper case."""
        values = self.get("", "values", dict)
        known = System.load().variables
        if unknown := [name for name in values if name.upper() not in known]:
            raise self.wrong("values", unknown[0], "is no variable of the controller")
        return {name.upper(): value for name, value in values.items()}

    def counts(self, table: str, needed: Iterable[str]) -> Mapping[str, int]:
        """Return a table of counts, which must have the entries ``needed``."""
        there = dict.fromkeys((*needed, *self.get("", table, dict)))
        return {key: self.count(table, key, 0) for key in there}
