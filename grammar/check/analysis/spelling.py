"""How likely a name is spelt as it is meant, judged by the other names of a project.

Of two names one slip apart, the one whose letters around the slip stand in other names is right. A
word that stands in one name alone, one slip from a word of several others, is that word.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Set
from functools import cached_property

from grammar.diagnostics.typos import Typos
from grammar.semantics.link import words_of
from grammar.semantics.predefined import System
from grammar.syntax.source import Source

# So many letters before and behind a slip are compared, in this order.
_WIDTHS = ((4, 4), (3, 3), (2, 2), (3, 0), (0, 3), (2, 0), (0, 2), (1, 1))
# Of a letter too many or too few these: less of the shorter name stands everywhere.
_WIDE = _WIDTHS[:3]
# Shorter words are near too many others.
_SHORTEST = 5
# A word that so many files write, or so many names of one have, is spelt as it is meant.
_USUAL = 2
_WORD = re.compile(r"[A-Z]+")


class Spelling:
    """The names of some files.

    ``names_of_files`` gives those of each, in upper case; it is called once, when first needed.
    """

    def __init__(self, names_of_files: Callable[[], Iterable[Set[str]]]) -> None:
        self._names_of_files = names_of_files

    @cached_property
    def _names(self) -> Counter[str]:
        """How many files have each name; the controller counts as one."""
        system = System.load()
        files = (*self._names_of_files(), {*system.variables, *system.functions})
        return Counter(name for names in files for name in names)

    @cached_property
    def _text(self) -> str:
        return "\n".join(["", *sorted(self._names), ""])

    @cached_property
    def _words(self) -> Counter[str]:
        words: Counter[str] = Counter()
        for name, count in self._names.items():
            for word in set(_WORD.findall(name)):
                if len(word) >= _SHORTEST:
                    words[word] += count
        return words

    @cached_property
    def _usual(self) -> Typos:
        usual = (word for word, count in self._words.items() if count >= _USUAL)
        return Typos(usual, _SHORTEST)

    def is_likelier(self, one: str, other: str) -> bool:
        """Whether ``one`` of two names that are a slip apart is certainly the right one."""
        names = one.upper(), other.upper()
        start = _common(*names)
        end = _common(*(name[: start - 1 if start else None : -1] for name in names))
        for widths in _WIDTHS if len(one) == len(other) else _WIDE:
            counts = [self._others(_around(name, start, end, *widths), names) for name in names]
            if counts[0] != counts[1]:
                return counts[0] > counts[1]
        return False

    def _others(self, part: str, names: Iterable[str]) -> int:
        """How often a part of a name stands in others than ``names``."""
        own = sum(f"\n{name}\n".count(part) for name in names if name in self._names)
        return self._text.count(part) - own

    def meant(self, name: str) -> str | None:
        """The name with its one misspelt word as other names have it; ``None`` if none is."""
        key = name.upper()
        for found in _WORD.finditer(key):
            if self._words[found[0]] <= self._names[key] and len(found[0]) >= _SHORTEST - 1:
                near = self._usual.meant(found[0])
                if len(near) == 1:
                    return key[: found.start()] + near[0] + key[found.end() :]
        return None


def spelling_of(sources: Iterable[Source]) -> Spelling:
    """The spelling of the names in some texts, which are read when it is asked for."""
    return Spelling(lambda: [words_of(source.text) for source in sources])


def _common(one: str, other: str) -> int:
    pairs = enumerate(zip(one, other, strict=False))
    return next((at for at, (a, b) in pairs if a != b), min(len(one), len(other)))


def _around(name: str, start: int, end: int, before: int, behind: int) -> str:
    """What stands between a common start and end of a name, and beside it."""
    marked = f"\n{name}\n"
    return marked[max(0, start + 1 - before) : len(marked) - end - 1 + behind]
