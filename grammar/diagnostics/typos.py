"""Whether a name is another one with a slip of the finger, among many names at once.

Stricter than `grammar.diagnostics.did_you_mean`, which only words a hint: here a finding rests on
it. One slip is a letter too many, too few or wrong, or two that changed places. Names that people
make in series are no slips of one another: those that differ in a digit, in the last letter of a
word (``PICKA``, ``PICKB``), in a prefix (``XHOME`` of ``HOME``), or as GET and SET.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

__all__ = ["Typos"]

# Shorter names are near too many others.
_SHORTEST = 4
_LONGEST = 64
# A word of a name: letters, or what is no letter.
_WORD = re.compile(r"[A-Z]+|[^A-Z]+")
# Both are there in every library.
_PAIR = {"GET", "SET"}
# A letter behind a shorter word may number it: POSX, POSY.
_SHORTEST_TO_END = 6


class Typos:
    """Names that can be meant, indexed so that a look-up costs the length of the name.

    Each name is entered under itself without each of its letters, as SymSpell does: names that are
    one slip apart meet in such a key. Names of fewer than ``shortest`` letters are left out. Words
    of the language are in no series, ``is_series`` false: what is near one of these is a slip.
    """

    def __init__(
        self, names: Iterable[str], shortest: int = _SHORTEST, *, is_series: bool = True
    ) -> None:
        self._shortest = shortest
        self._is_series = is_series
        self._names: dict[str, str] = {}
        self._keys: dict[str, list[str]] = {}
        for name in names:
            self.add(name)

    def add(self, name: str) -> None:
        """Enter a name; letter case makes no difference, the first spelling counts."""
        key = name.upper()
        if key in self._names or not self._shortest <= len(key) <= _LONGEST:
            return
        self._names[key] = name
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
            if right != wrong and _is_slip(wrong, right, is_series=self._is_series)
        }
        return tuple(self._names[right] for right in sorted(near))


def _shortened(key: str) -> Iterator[str]:
    yield key
    for index in range(len(key)):
        yield key[:index] + key[index + 1 :]


def _is_slip(wrong: str, right: str, *, is_series: bool) -> bool:
    """Whether two names in upper case that share a key are one slip apart, and in no series."""
    pairs = enumerate(zip(wrong, right, strict=False))
    start = next((i for i, (a, b) in pairs if a != b), min(len(wrong), len(right)))
    if len(wrong) != len(right):
        longer, shorter = (wrong, right) if len(wrong) > len(right) else (right, wrong)
        if longer[start + 1 :] != shorter[start:]:
            return False
        if not is_series:
            return True
        return start > 0 and not _numbers(longer, start, _SHORTEST_TO_END)
    if wrong[start + 1 :] == right[start + 1 :]:
        if not is_series:
            return True
        if {wrong[start : start + 3], right[start : start + 3]} == _PAIR:
            return False
        return not (_numbers(wrong, start) or _numbers(right, start))
    swapped = right[start + 1 : start + 2] + right[start : start + 1] + right[start + 2 :]
    return wrong[start:] == swapped and swapped[:2].replace("_", "").isalpha()


def _numbers(name: str, index: int, shortest: int = _LONGEST) -> bool:
    """Whether the character at an index numbers the name: a digit, or the last of a word.

    The last letter of a word with so many letters numbers nothing.
    """
    word = next(word for word in _WORD.finditer(name) if word.start() <= index < word.end())
    is_last = index == word.end() - 1
    if name[index] == "_":
        return False
    return not word.group().isalpha() or (is_last and len(word.group()) < shortest)
