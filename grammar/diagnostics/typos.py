"""Typing errors: whether a name is a misspelling of one among many others.

This is stricter than `grammar.diagnostics.did_you_mean`, which only words a hint, because a finding
rests on it. A slip is one letter that is missing, added or replaced, or two neighbours that are
swapped. Names that belong to a series are not slips of one another: those that differ in a digit,
in the last letter of a word (``PICKA``, ``PICKB``), in a prefix (``XP1`` and ``FP1``), or as GET
and SET. If all names of a series are known, only digits tell its members apart; `Series` says so
for each name. What tells the kind of a name (``gnPart``, ``MY_PART``) is a prefix only if other
names have the same prefix.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum

# Shorter names are similar to too many others, and shorter words to other words.
_SHORTEST = 3
_SHORTEST_WORD = 4
_LONGEST = 64
# Part of a name: a run of letters, or of other characters.
_WORD = re.compile(r"[A-Z]+|[^A-Z]+", re.IGNORECASE)
_NUMBER = re.compile(r"[\d_]+")
# Every library has functions in such pairs.
_PAIR = {"GET", "SET"}
# Letters and the digits that look like them.
_ALIKE = ({"O", "0"}, {"I", "1"}, {"L", "1"})
# A final letter can number a word that is shorter than this: POSX, POSY.
_SHORTEST_TO_END = 6
# Prefixes with which inline forms name the data of a point: XP1, FP1.
_OF_POINTS = frozenset("XF")
# A prefix that tells the kind of a name: gnPart, a global number; IPO_MODE, APO_MODE.
_PREFIX = re.compile(r"[a-z]+(?=[A-Z])|[A-Za-z]{1,3}_")


class Series(Enum):
    """What may distinguish names of a series from one another."""

    #: Nothing: a name that is near a word of the language is a slip.
    NONE = 0
    #: Digits: names of the controller or of a file at hand, where the whole series is known.
    DIGITS = 1
    #: Digits and letters: others of the series may be declared elsewhere.
    LETTERS = 2


class Typos:
    """An index of correctly spelled names; a look-up costs time proportional to the name's length.

    Each name is entered under itself and under itself without each one of its letters (SymSpell,
    symmetric delete), so names that are one slip apart share a key. Names with fewer than
    ``shortest`` letters are left out. The names of ``known`` are shared without being entered
    again; it must not be changed afterwards.
    """

    def __init__(
        self,
        names: Iterable[str],
        shortest: int = _SHORTEST,
        *,
        series: Series = Series.LETTERS,
        known: Typos | None = None,
    ) -> None:
        self._shortest = shortest
        self._names: dict[str, tuple[str, Series]] = {} if known is None else known._names.copy()
        self._known: Mapping[str, Sequence[str]] = {} if known is None else known._keys
        self._keys: defaultdict[str, list[str]] = defaultdict(list)
        self.prefixes: Counter[str] = Counter() if known is None else known.prefixes.copy()
        self.add(names, series)

    def add(self, names: Iterable[str], series: Series) -> None:
        """Add names. Letter case is ignored; the first spelling of a name is kept."""
        for name in names:
            key = name.upper()
            if key not in self._names and self._shortest <= len(key) <= _LONGEST:
                self.prefixes[prefix_of(name)] += 1
                self._names[key] = name, series
                for shorter in _shortened(key):
                    self._keys[shorter].append(key)

    def meant(
        self, name: str, *, has_slipped: bool = False, has_plurals: bool = True
    ) -> tuple[str, ...]:
        """Return the names of which ``name`` may be a misspelling, in alphabetical order.

        ``has_slipped`` says that no other name has its prefix, ``has_plurals`` that a name
        with an S more may be another name: PART and PARTS, as data are called.
        """
        wrong = name.upper()
        if not self._shortest <= len(wrong) + 1 <= _LONGEST:
            return ()
        near = {
            right
            for shorter in _shortened(wrong)
            for right in (*self._keys.get(shorter, ()), *self._known.get(shorter, ()))
            if right != wrong and _is_slip(name, *self._names[right], has_slipped, has_plurals)
        }
        return tuple(self._names[right][0] for right in sorted(near))


def _shortened(key: str) -> list[str]:
    return [key, *[key[:index] + key[index + 1 :] for index in range(len(key))]]


def common_start(one: str, other: str) -> int:
    """Return the length of the common beginning of two names."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((at for at, (a, b) in pairs if a != b), min(len(one), len(other)))


def prefix_of(name: str) -> str:
    """Return what tells the kind of a name: small letters before a capital, a few before a mark.

    It is in upper case.
    """
    found = _PREFIX.match(name)
    return found[0].upper() if found else ""


def _is_slip(
    misspelt: str, name: str, series: Series, has_slipped: bool, has_plurals: bool
) -> bool:
    """Return whether two names with a common key are one slip apart and not in a series."""
    has_slipped = has_slipped and bool(prefix_of(name))
    wrong, right = misspelt.upper(), name.upper()
    start = common_start(wrong, right)
    if len(wrong) != len(right):
        longer, shorter = (wrong, right) if len(wrong) > len(right) else (right, wrong)
        if longer[start + 1 :] != shorter[start:]:
            return False
        if series is Series.NONE:
            return True
        letter = longer[start]
        is_doubled = (
            letter.isalpha()
            and letter == shorter[start - 1 : start]
            and (longer is wrong or start > 1)
            and {letter} != set(_word(longer, start))
        )
        # what ends with the mark before a number is no name of its own
        if is_doubled or (longer is right and letter.isdigit() and shorter[start - 1 :] == "_"):
            return True
        is_plural = longer is wrong and letter == "S" and start == len(shorter)
        if has_plurals and is_plural and name[0] != "$":
            return False  # singular and plural
        if start == 0:
            return has_slipped or (longer is right and _loses_its_first(name))
        spelt = misspelt if longer is wrong else name
        return not _numbers(spelt, start, series, _SHORTEST_TO_END)
    if wrong[start + 1 :] == right[start + 1 :]:
        if series is Series.NONE or {wrong[start], right[start]} in _ALIKE:
            return True
        if not has_slipped and _is_prefix(misspelt, name, start):
            return False
        if series is Series.DIGITS:
            return not (wrong[start].isdigit() and right[start].isdigit())
        if {wrong[start : start + 3], right[start : start + 3]} == _PAIR:
            return False
        return not (_numbers(misspelt, start, series) or _numbers(name, start, series))
    swapped = right[start + 1 : start + 2] + right[start : start + 1] + right[start + 2 :]
    # as above: a name that ends with the mark has lost its number
    is_numbered = _NUMBER.fullmatch(swapped[:2]) and wrong[-1] != "_"
    return wrong[start:] == swapped and not is_numbered


def _is_prefix(misspelt: str, name: str, index: int) -> bool:
    """Return whether a letter of a name belongs to what tells its kind: xHome, I_START."""
    if name[0] == "$" and index == 0:
        return misspelt[1:] != name[1:] and misspelt[0].islower() and misspelt[1:2].isupper()
    if index == 0:
        is_of_point = {misspelt[0].upper(), name[0].upper()} <= _OF_POINTS
        return is_of_point or bool(prefix_of(name))
    return name[index - 1] == "_" and name[index + 1 : index + 2] in ("", "_")


def _loses_its_first(name: str) -> bool:
    """Return whether a name is not plausible without its first letter, which is no prefix then."""
    is_prefix = name[0] == "$" or name[0].upper() in _OF_POINTS or prefix_of(name)
    return not is_prefix or (name[0].isupper() and name[1:2].islower())


def _numbers(name: str, index: int, series: Series, shortest: int = _LONGEST) -> bool:
    """Return whether the character at an index numbers the name: a digit, or a last letter.

    The last letter of a word with ``shortest`` or more letters numbers nothing. Nor does a small
    letter after another one, in a name that has capitals too.
    """
    if series is Series.DIGITS or name[index] == "_":
        return name[index].isdigit()
    word = _word(name, index)
    if not word.isalpha():
        return True
    if len(word) >= _SHORTEST_WORD and name[index - 1 : index + 1].islower() and not name.islower():
        return False
    if name[index + 1 : index + 2].isalpha():
        return False
    return len(word) < shortest or (name[index].isupper() and name[index - 1].islower())


def _word(name: str, index: int) -> str:
    """Return the run of letters, or of other characters, that contains an index."""
    return next(word[0] for word in _WORD.finditer(name) if index < word.end())
