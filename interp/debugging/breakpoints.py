"""The breakpoints of a debugger: their places, and which of their hits count."""

from __future__ import annotations

import operator
import re
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import Final

from interp.debugging.client import Breakpoint
from interp.debugging.conditions import guard_of
from interp.debugging.names import signals_of
from interp.port.inspection import Guard
from interp.program.load import CheckedProgram
from interp.program.statement_paths import statement_lines
from interp.values.faults import LinkError

_HITS: Final = re.compile(r"(>=|<=|==?|[><%]|)([0-9]+)")
_COUNTS: Final = {">=": operator.ge, ">": operator.gt, "<=": operator.le, "<": operator.lt}


class Breakpoints:
    """The breakpoints of a program.

    ``places`` has the guard of each (file, line) with a breakpoint, as executors take them.
    """

    def __init__(self, program: CheckedProgram) -> None:
        self.places: dict[tuple[str, int], Guard | None] = {}
        self._program = program
        self._by_line: dict[int, list[Breakpoint]] = {}
        self._hits: dict[Breakpoint, array[int]] = {}

    def set(self, breakpoints: Sequence[Breakpoint]) -> None:
        """Replace all breakpoints; raise `LinkError` for invalid hits."""
        by_line: dict[int, list[Breakpoint]] = {}
        for one in breakpoints:
            is_hit(one.hits, 1)
            by_line.setdefault(one.line, []).append(one)
        self._by_line = by_line
        self.places = {}
        signals = signals_of(self._program)
        for unit in self._program.units.values():
            for one in breakpoints:
                place = unit.module.path, one.line
                if is_path_of(one.file, unit.module.path):
                    is_only = place not in self.places
                    guard = guard_of(one.condition) if one.condition and is_only else None
                    is_signal = guard is not None and guard.name.upper() in signals
                    self.places[place] = None if is_signal else guard
        self._hits = {one: self._hits.get(one, array("q")) for one in breakpoints if one.hits}

    @property
    def all(self) -> list[Breakpoint]:
        """All breakpoints, by lines."""
        return [one for _, found in sorted(self._by_line.items()) for one in found]

    def at(self, file: str, line: int) -> Iterator[Breakpoint]:
        """Yield the breakpoints on a line."""
        return (one for one in self._by_line.get(line, ()) if is_path_of(one.file, file))

    def lines(self, file: str) -> tuple[int, ...]:
        """Return the lines of a file at which a program can stop, in ascending order."""
        units = [one for one in self._program.units.values() if is_path_of(file, one.module.path)]
        routines = [one for unit in units for one in self._program.routines_of(unit)]
        return tuple(sorted({line for one in routines for line in statement_lines(one)}))

    def hit_counts(self, one: Breakpoint, moment: int, *, is_new: bool) -> bool:
        """Return whether the hit after ``moment`` statements counts; a new hit is stored."""
        if one.hits is None:
            return True
        hits = self._hits[one]
        if is_new:
            hits.append(moment)
        return is_hit(one.hits, bisect_right(hits, moment))

    def forget_hits(self, after: int = -1) -> None:
        """Drop the hits after so many statements, by default all."""
        for hits in self._hits.values():
            del hits[bisect_right(hits, after) :]


def is_hit(hits: str | None, count: int) -> bool:
    """Return whether hit number ``count`` counts; raise `LinkError` if ``hits`` is invalid.

    ``hits`` is a number with an optional ``=``, ``==``, ``>``, ``>=``, ``<``, ``<=`` or ``%``.
    """
    match = _HITS.fullmatch((hits or ">=1").replace(" ", ""))
    if match is None or (match[1] == "%" and not int(match[2])):
        raise LinkError(f"{hits}: hits are a number such as 3, >=3 or %3")
    number = int(match[2])
    return (
        not count % number if match[1] == "%" else _COUNTS.get(match[1], operator.eq)(count, number)
    )


def is_path_of(wanted: str, file: str) -> bool:
    """Return whether ``wanted`` is the path of a file or the end of that path."""
    wanted, file = wanted.replace("\\", "/").upper(), file.upper()
    return file == wanted or file.endswith(f"/{wanted}")
