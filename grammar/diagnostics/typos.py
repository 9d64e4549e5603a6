"""Whether a name is another one with a slip of the finger, among many names at once.

Stricter than `grammar.diagnostics.did_you_mean`, which only words a hint: here a finding rests on
it. One slip is a letter too many, too few or wrong, or two that changed places. Names that people
make in series are no slips of one another: those that differ in a digit, in the last letter of a
word (``PICKA``, ``PICKB``), in a prefix (``XHOME`` of ``HOME``), or as GET and SET. Where all of
a series would be known, only digits tell names apart: `Series` says so for each name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from enum import Enum

__all__ = ["Series", "Typos"]

# Shorter names are near too many others.
_SHORTEST = 4
_LONGEST = 64
# A word of a name: letters, or what is no letter.
_WORD = re.compile(r"[A-Z]+|[^A-Z]+")
# Both are there in every library.
_PAIR = {"GET", "SET"}
# A letter behind a shorter word may number it: POSX, POSY.
_SHORTEST_TO_END = 6


class Series(Enum):
    """What may tell a name from others on purpose."""

    #: Nothing: what is near a word of the language is a slip.
    NONE = 0
    #: Digits: names of the controller, and of a file that is there, of which all are known.
    DIGITS = 1
    #: Digits and letters: others of the series may be declared where nobody has looked.
    LETTERS = 2


class Typos:
    """Names that can be meant, indexed so that a look-up costs the length of the name.

    Each name is entered under itself without each of its letters, as SymSpell does: names that are
    one slip apart meet in such a key. Names of fewer than ``shortest`` letters are left out.
    """

    def __init__(
        self,
        names: Iterable[str],
        shortest: int = _SHORTEST,
        *,
        series: Series = Series.LETTERS,
    ) -> None:
        self._shortest = shortest
        self._names: dict[str, tuple[str, Series]] = {}
        self._keys: dict[str, list[str]] = {}
        self.add(names, series)

    def add(self, names: Iterable[str], series: Series) -> None:
        """Enter names; letter case makes no difference, the first spelling counts."""
        for name in names:
            key = name.upper()
            if key not in self._names and self._shortest <= len(key) <= _LONGEST:
                self._names[key] = name, series
                for shorter in _shortened(key):
                    self._keys.setdefault(shorter, []).append(key)

    def meant(self, name: str) -> tuple[str, ...]:
        """The names that ``name`` may be a slip of, in the order of the alphabet."""
        wrong = name.upper()
        if not self._shortest <= len(wrong) <= _LONGEST:
            return ()
        near = {
            right
            for shorter in _shortened(wrong)
            for right in self._keys.get(shorter, ())
            if right != wrong and _is_slip(wrong, right, self._names[right][1])
        }
        return tuple(self._names[right][0] for right in sorted(near))


def _shortened(key: str) -> Iterator[str]:
    yield key
    for index in range(len(key)):
        yield key[:index] + key[index + 1 :]


def _is_slip(wrong: str, right: str, series: Series) -> bool:
    """Whether two names in upper case that share a key are one slip apart, and in no series."""
    pairs = enumerate(zip(wrong, right, strict=False))
    start = next((i for i, (a, b) in pairs if a != b), min(len(wrong), len(right)))
    if len(wrong) != len(right):
        longer, shorter = (wrong, right) if len(wrong) > len(right) else (right, wrong)
        if longer[start + 1 :] != shorter[start:]:
            return False
        if series is Series.NONE:
            return True
        letter = longer[start]
        if longer is wrong and letter.isalpha() and letter == shorter[start - 1 : start]:
            return True  # a letter doubled
        return start > 0 and not _numbers(longer, start, series, _SHORTEST_TO_END)
    if wrong[start + 1 :] == right[start + 1 :]:
        if series is Series.NONE:
            return True
        if {wrong[start : start + 3], right[start : start + 3]} == _PAIR:
            return False
        return not (_numbers(wrong, start, series) or _numbers(right, start, series))
    swapped = right[start + 1 : start + 2] + right[start : start + 1] + right[start + 2 :]
    return wrong[start:] == swapped and swapped[:2].replace("_", "").isalpha()


def _numbers(name: str, index: int, series: Series, shortest: int = _LONGEST) -> bool:
    """Whether the character at an index numbers the name: a digit, or the last of a word.

    The last letter of a word with so many letters numbers nothing.
    """
    if series is Series.DIGITS or name[index] == "_":
        return name[index].isdigit()
    word = next(word for word in _WORD.finditer(name) if word.start() <= index < word.end())
    is_last = index == word.end() - 1
    return not word.group().isalpha() or (is_last and len(word.group()) < shortest)
