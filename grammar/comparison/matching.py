"""What belongs together in two states: the same name, else the same content, else the likest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import TypeVar

_K = TypeVar("_K", bound=Hashable)

# Less is no likeness: short routines have much in common.
_LEAST = 0.6
# More candidates than anybody renames at once: then only what is the same counts.
_MOST = 300
# Beyond so many lines, or pairs of equal lines, exact comparison takes long.
_LONG = 5_000
_MOST_PAIRS = 200_000


def line_matcher(old: Sequence[str], new: Sequence[str]) -> SequenceMatcher[str]:
    """Compares two lists of lines; in long ones lines that come up often are left aside."""
    one, other = Counter(old), Counter(new)
    pairs = sum(count * other[line] for line, count in one.items())
    is_long = len(old) + len(new) > _LONG or pairs > _MOST_PAIRS
    return SequenceMatcher(None, old, new, autojunk=is_long)


def likest(
    old: Mapping[_K, Sequence[str]],
    new: Mapping[_K, Sequence[str]],
    may_be: Callable[[_K, _K], bool] = lambda _old, _new: True,
) -> Iterator[tuple[_K, _K]]:
    """Pairs of old and new things, each in one pair, by the lines they consist of.

    What is the same comes first, then what has most in common, the first of several. Things of no
    lines are in no pair.
    """
    pairs = _candidates(old, new, may_be)
    done: set[tuple[bool, _K]] = set()
    for _, before, after in pairs:
        if (False, before) not in done and (True, after) not in done:
            done |= {(False, before), (True, after)}
            yield before, after


def _candidates(
    old: Mapping[_K, Sequence[str]],
    new: Mapping[_K, Sequence[str]],
    may_be: Callable[[_K, _K], bool],
) -> list[tuple[float, _K, _K]]:
    least = _LEAST if max(len(old), len(new)) <= _MOST else 1.0
    counts = {key: Counter(lines) for key, lines in new.items() if lines}
    found = []
    for before, lines in old.items():
        mine = Counter(lines)
        for after, theirs in counts.items():
            if not mine or not may_be(before, after):
                continue
            likeness = _likeness(mine, theirs)
            if likeness >= least:
                found.append((likeness, before, after))
    return sorted(found, key=lambda one: -one[0])


def _likeness(one: Counter[str], other: Counter[str]) -> float:
    size, size2 = one.total(), other.total()
    if min(size, size2) < _LEAST / 2 * max(size, size2):
        return 0.0
    return 2 * (one & other).total() / (size + size2)
