"""Matching of two versions: by the same name, else the same content, else similarity."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter, deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import groupby
from typing import TypeVar

_K = TypeVar("_K", bound=Hashable)

# Less is no likeness: short routines have much in common.
_LEAST = 0.6
# More than anybody renames and changes at once: then only what is the same counts.
_MOST = 300
# Beyond so many lines, or pairs of equal lines, exact comparison takes long.
_LONG = 5_000
_MOST_PAIRS = 200_000


#: ``equal``, ``replace``, ``delete`` or ``insert``; where that begins and ends in both lists.
_Operation = tuple[str, int, int, int, int]


def line_operations(old: Sequence[str], new: Sequence[str]) -> list[_Operation]:
    """What makes one list of lines the other, as `SequenceMatcher.get_opcodes` says it.

    In long lists lines that each has once are taken for the same, as many as are in order (patience
    diff): comparison costs as much as there is between them. What comes up often is left aside.
    """
    anchors = _anchors(old, new) if len(old) + len(new) > _LONG else []
    found: list[_Operation] = []
    at = start = 0
    for before, after in (*anchors, (len(old), len(new))):
        for tag, first, last, begin, end in _exact(old[at:before], new[start:after]):
            found.append((tag, at + first, at + last, start + begin, start + end))
        at, start = before + 1, after + 1
        found.append(("equal", before, at, after, start))
    found.pop()  # what is no line, behind the last
    return [_joined(list(ones)) for ones in _runs(found)]


def _exact(old: Sequence[str], new: Sequence[str]) -> list[_Operation]:
    if not old and not new:
        return []
    one, other = Counter(old), Counter(new)
    pairs = sum(count * other[line] for line, count in one.items())
    is_long = len(old) + len(new) > _LONG or pairs > _MOST_PAIRS
    return list(SequenceMatcher(None, old, new, autojunk=is_long).get_opcodes())


def _anchors(old: Sequence[str], new: Sequence[str]) -> list[tuple[int, int]]:
    """The places of lines that are once in each list, as many as come in the same order."""
    one, other = Counter(old), Counter(new)
    place = {line: number for number, line in enumerate(new) if other[line] == 1}
    ends: list[int] = []  # the least place in the new list that so long a row can end at
    last: list[int] = []  # that place in the old list
    way: dict[int, int | None] = {}
    for number, line in enumerate(old):
        if one[line] == 1 and line in place:
            length = bisect_left(ends, place[line])
            ends[length : length + 1] = [place[line]]
            last[length : length + 1] = [number]
            way[number] = last[length - 1] if length else None
    row = []
    here = last[-1] if last else None
    while here is not None:
        row.append((here, place[old[here]]))
        here = way[here]
    return row[::-1]


def _runs(found: Iterable[_Operation]) -> Iterator[Iterator[_Operation]]:
    """Equal lines in one run, and each change by itself."""
    return (run for _, run in groupby(found, key=lambda one: one[0] == "equal" or one))


def _joined(ones: Sequence[_Operation]) -> _Operation:
    tag, first, _, begin, _ = ones[0]
    return tag, first, ones[-1][2], begin, ones[-1][4]


def likest(
    old: Mapping[_K, Sequence[str]],
    new: Mapping[_K, Sequence[str]],
    kind: Callable[[_K], object] = lambda _: None,
) -> Iterator[tuple[_K, _K]]:
    """Pairs of old and new things of a kind, each in one pair, by the lines they consist of.

    What is the same comes first, then what has most in common, the first of several. Things of no
    lines are in no pair.
    """
    left, right = _counted(old, kind), _counted(new, kind)
    same: dict[object, deque[_K]] = {}
    for key, what in right.items():
        same.setdefault(what, deque()).append(key)
    for key, what in list(left.items()):
        if same.get(what):
            match = same[what].popleft()
            del left[key], right[match]
            yield key, match
    if max(len(left), len(right)) > _MOST:
        return
    for _, before, after in _candidates(left, right):
        if before in left and after in right:
            del left[before], right[after]
            yield before, after


def _counted(
    things: Mapping[_K, Sequence[str]], kind: Callable[[_K], object]
) -> dict[_K, tuple[object, frozenset[tuple[str, int]]]]:
    """The kind of each thing, and its lines with how often each comes; those that have any."""
    return {
        key: (kind(key), frozenset(Counter(lines).items()))
        for key, lines in things.items()
        if lines
    }


def _candidates(
    old: Mapping[_K, tuple[object, frozenset[tuple[str, int]]]],
    new: Mapping[_K, tuple[object, frozenset[tuple[str, int]]]],
) -> list[tuple[float, _K, _K]]:
    counts = {key: (kind, Counter(dict(lines))) for key, (kind, lines) in new.items()}
    found = []
    for before, (kind, lines) in old.items():
        mine = Counter(dict(lines))
        for after, (other, theirs) in counts.items():
            likeness = _likeness(mine, theirs) if kind == other else 0.0
            if likeness >= _LEAST:
                found.append((likeness, before, after))
    return sorted(found, key=lambda one: -one[0])


def _likeness(one: Counter[str], other: Counter[str]) -> float:
    size, size2 = one.total(), other.total()
    if min(size, size2) < _LEAST / 2 * max(size, size2):
        return 0.0
    return 2 * (one & other).total() / (size + size2)
