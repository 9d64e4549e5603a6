"""Which of two similar names is spelt correctly, judged by the other names of a project.

Of two names that differ by one slip, the correct one is the one whose letters around the slip occur
in other names. A name that one file uses, and that is one slip away from a name that several files
use, or from a series of names, is probably misspelt.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Set
from functools import cached_property

from grammar.diagnostics.typos import Typos, common_start
from grammar.semantics.predefined import System
from grammar.syntax.source import Source, names_in_text

# So many letters before and behind a slip are compared, in this order.
_WIDTHS = ((4, 4), (3, 3), (2, 2), (3, 0), (0, 3), (2, 0), (0, 2), (1, 1))
# Of a letter too many or too few these: less of the shorter name stands everywhere.
_WIDE = _WIDTHS[:3]
# Shorter names are near too many others.
_SHORTEST = 5
# What so many files write, or one with so many numbers, is spelt as it is meant.
_USUAL = 2
# The controller makes each data list from a template that declares it.
_OF_EACH_LIST = "SUCCESS"
_NUMBER = re.compile(r"\d+")


class Spelling:
    """The names of some files.

    ``names_of_files`` returns the path of each file with its names in upper case; it is called
    once, when first needed.
    """

    def __init__(self, names_of_files: Callable[[], Iterable[tuple[str, Set[str]]]]) -> None:
        self._names_of_files = names_of_files

    @cached_property
    def files(self) -> Mapping[str, Set[str]]:
        """Return the names of each file."""
        return dict(self._names_of_files())

    @cached_property
    def _names(self) -> Counter[str]:
        """Return how many files have each name; the controller counts as one file."""
        system = System.load()
        files = (*self.files.values(), {*system.variables, *system.functions})
        counts = Counter(name for names in files for name in names)
        counts[_OF_EACH_LIST] += _USUAL
        return counts

    @cached_property
    def _text(self) -> str:
        return "\n".join(["", *sorted(self._names), ""])

    @cached_property
    def _series(self) -> Counter[str]:
        """Return how often names occur that differ in their numbers only."""
        series: Counter[str] = Counter()
        for name, count in self._names.items():
            series[_NUMBER.sub("0", name)] += count
        return series

    @cached_property
    def _usual(self) -> Typos:
        known = System.load().functions
        usual = (one for one, n in self._series.items() if n >= _USUAL and one not in known)
        return Typos(usual, _SHORTEST)

    def is_likelier(self, one: str, other: str) -> bool:
        """Return whether ``one`` is certainly the right one of two names that a slip separates."""
        names = one.upper(), other.upper()
        start = common_start(*names)
        end = common_start(*(name[: start - 1 if start else None : -1] for name in names))
        for widths in _WIDTHS if len(one) == len(other) else _WIDE:
            counts = [self._others(_around(name, start, end, *widths), names) for name in names]
            if counts[0] != counts[1]:
                return counts[0] > counts[1]
        return False

    def _others(self, part: str, names: Iterable[str]) -> int:
        """Return how often a part of a name occurs in names other than ``names``."""
        own = sum(f"\n{name}\n".count(part) for name in names if name in self._names)
        return self._text.count(part) - own

    def meant(self, name: str) -> str | None:
        """Return the only name in other files of which ``name`` is a slip, regardless of numbers.

        Return ``None`` if there is none, or if other files have the name, too, with any numbers.
        """
        if name[0] == "$" or self._series[_NUMBER.sub("0", name.upper())] > 1:
            return None
        near = self._usual.meant(_NUMBER.sub("0", name))
        numbers = _NUMBER.findall(name)
        if len(near) != 1 or near[0].count("0") != len(numbers):
            return None
        if near[0].replace("_", "") == _NUMBER.sub("0", name.upper()).replace("_", ""):
            return None
        return _cased(_NUMBER.sub(lambda _: numbers.pop(0), near[0]), name)


def _cased(name: str, written: str) -> str:
    """Return a name in upper case in the letter case of one that is a slip away."""
    start = common_start(name, written.upper())
    end = common_start(name[start:][::-1], written.upper()[start:][::-1])
    changed = name[start : len(name) - end]
    if (written[start - 1] if start else written[1:2]).islower():
        changed = changed.lower()
    return f"{written[:start]}{changed}{written[len(written) - end :]}"


def spelling_of(sources: Iterable[Source]) -> Spelling:
    """Return the spelling of the names in some texts, which are read when it is first used."""
    return Spelling(lambda: [(source.path, names_in_text(source.text)) for source in sources])


def _around(name: str, start: int, end: int, before: int, behind: int) -> str:
    """Return the part between a common start and end of a name, with its neighbours."""
    marked = f"\n{name}\n"
    return marked[max(0, start + 1 - before) : len(marked) - end - 1 + behind]
