"""Matching the items of two versions: by name, else by equal content, else by similarity."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter, deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import groupby
from typing import TypeVar

_K = TypeVar("_K", bound=Hashable)
_Counted = dict[_K, tuple[object, Counter[str]]]

# Less similar items are not matched, because short routines always have much in common.
_LEAST = 0.6
# With more unmatched items on one side, only equal ones are matched.
_MOST = 300
# Beyond so many lines, or pairs of equal lines, `SequenceMatcher` takes long.
_LONG = 5_000
_MOST_PAIRS = 200_000
# After so many edits the search for a short edit script begins anew where it has come furthest.
_MOST_EDITS = 100


#: ``equal``, ``replace``, ``delete`` or ``insert``, with its range in the old and the new list.
_Operation = tuple[str, int, int, int, int]
#: Equal lines: their first numbers in the old and the new list, and how many there are.
_Run = tuple[int, int, int]


def line_operations(old: Sequence[str], new: Sequence[str]) -> list[_Operation]:
    """Return the edit operations between two lists of lines, as `SequenceMatcher.get_opcodes` does.

    In long lists, lines that occur once in each list are anchors, as in a patience diff, and the
    parts between them are compared on their own; by `_common_runs` where lines recur very often.
    """
    anchors = _anchors(old, new) if len(old) + len(new) > _LONG else []
    found: list[_Operation] = []
    at = start = 0
    for before, after in (*anchors, (len(old), len(new))):
        for tag, first, last, begin, end in _exact(old[at:before], new[start:after]):
            found.append((tag, at + first, at + last, start + begin, start + end))
        at, start = before + 1, after + 1
        found.append(("equal", before, at, after, start))
    found.pop()  # the sentinel after the last line
    return [_joined(list(ones)) for ones in _runs(found)]


def _exact(old: Sequence[str], new: Sequence[str]) -> list[_Operation]:
    if not old and not new:
        return []
    one, other = Counter(old), Counter(new)
    pairs = sum(count * other[line] for line, count in one.items())
    if len(old) + len(new) <= _LONG and pairs <= _MOST_PAIRS:
        return list(SequenceMatcher(None, old, new, autojunk=False).get_opcodes())
    return list(_operations(_common_runs(old, new), len(old), len(new)))


def _operations(runs: Iterable[_Run], old: int, new: int) -> Iterator[_Operation]:
    """Yield the operations between runs of equal lines, for lists of that many lines."""
    at = start = 0
    for first, begin, size in (*runs, (old, new, 0)):
        if (at, start) != (first, begin):
            tag = "insert" if at == first else "delete" if start == begin else "replace"
            yield tag, at, first, start, begin
        at, start = first + size, begin + size
        if size:
            yield "equal", first, at, begin, start


def _common_runs(old: Sequence[str], new: Sequence[str]) -> Iterator[_Run]:
    """Yield runs of equal lines in order, by the greedy search of Myers (1986).

    The edit script between them is the shortest if it has at most `_MOST_EDITS` edits in common
    lines. After so many the search begins anew where it has come furthest, so the time grows with
    the number of lines and not with its square.
    """
    both = set(old) & set(new)  # other lines are edits wherever the search goes
    mine = [number for number, line in enumerate(old) if line in both]
    theirs = [number for number, line in enumerate(new) if line in both]
    lines = [old[number] for number in mine], [new[number] for number in theirs]
    at = start = 0
    while at < len(mine) and start < len(theirs):
        for first, begin, size in _way(*lines, at, start):
            for step in range(size):
                yield mine[first + step], theirs[begin + step], 1
            at, start = first + size, begin + size


def _way(old: Sequence[str], new: Sequence[str], at: int, start: int) -> list[_Run]:
    """Return the runs on the way from a place in both lists to their ends, or as far as it comes.

    The last run is where it ends, and may be empty.
    """
    # by diagonal, the number of a line in the old list less that in the new one: the old line at
    # which a run begins there after so many edits, the one behind the run, and the diagonal before
    rounds: list[dict[int, tuple[int, int, int]]] = []
    begun = {at - start: (at, at - start)}
    ends = len(old), len(new)
    while True:
        reached: dict[int, tuple[int, int, int]] = {}
        for diagonal, (first, before) in begun.items():
            end = first
            while end < ends[0] and end - diagonal < ends[1] and old[end] == new[end - diagonal]:
                end += 1
            reached[diagonal] = first, end, before
        rounds.append(reached)
        furthest = max(reached, key=lambda one: 2 * reached[one][1] - one)
        end = reached[furthest][1]
        if len(rounds) > _MOST_EDITS or (end, end - furthest) == ends:
            break
        begun = {}
        for diagonal, (_, end, _) in reached.items():
            for other, first in ((diagonal + 1, end + 1), (diagonal - 1, end)):
                is_inside = first <= ends[0] and first - other <= ends[1]
                if is_inside and first > begun.get(other, (-1, 0))[0]:
                    begun[other] = first, diagonal
    runs = []
    for reached in reversed(rounds):
        first, end, before = reached[furthest]
        runs.append((first, first - furthest, end - first))
        furthest = before
    return runs[::-1]


def _anchors(old: Sequence[str], new: Sequence[str]) -> list[tuple[int, int]]:
    """Return the index pairs of lines that occur once in each list, as many as are in order."""
    one, other = Counter(old), Counter(new)
    place = {line: number for number, line in enumerate(new) if other[line] == 1}
    # longest increasing subsequence: for each length, the least index in the new list at which a
    # subsequence of it ends, and the index of that line in the old list
    ends: list[int] = []
    last: list[int] = []
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
    """Yield runs of equal lines as one group, and every other operation as a group of its own."""
    return (run for _, run in groupby(found, key=lambda one: one[0] == "equal" or one))


def _joined(ones: Sequence[_Operation]) -> _Operation:
    tag, first, _, begin, _ = ones[0]
    return tag, first, ones[-1][2], begin, ones[-1][4]


def likest(
    old: Mapping[_K, Sequence[str]],
    new: Mapping[_K, Sequence[str]],
    kind: Callable[[_K], object] = lambda _: None,
) -> Iterator[tuple[_K, _K]]:
    """Yield matching pairs of old and new items of the same kind, each item in at most one pair.

    Items are compared by their lines. Equal ones are matched first, then the most similar ones; on
    a tie the first one counts. Items without lines are not matched.
    """
    left, right = _counted(old, kind), _counted(new, kind)
    same: dict[object, deque[_K]] = {}
    for key, (what, lines) in right.items():
        same.setdefault((what, frozenset(lines.items())), deque()).append(key)
    for key, (what, lines) in list(left.items()):
        if alike := same.get((what, frozenset(lines.items()))):
            match = alike.popleft()
            del left[key], right[match]
            yield key, match
    if max(len(left), len(right)) > _MOST:
        return
    for _, before, after in _candidates(left, right):
        if before in left and after in right:
            del left[before], right[after]
            yield before, after


def _counted(things: Mapping[_K, Sequence[str]], kind: Callable[[_K], object]) -> _Counted[_K]:
    """Return the kind of each item and its multiset of lines; items without lines are left out."""
    return {key: (kind(key), Counter(lines)) for key, lines in things.items() if lines}


def _candidates(old: _Counted[_K], new: _Counted[_K]) -> list[tuple[float, _K, _K]]:
    found = []
    for before, (kind, mine) in old.items():
        for after, (other, theirs) in new.items():
            likeness = _likeness(mine, theirs) if kind == other else 0.0
            if likeness >= _LEAST:
                found.append((likeness, before, after))
    return sorted(found, key=lambda one: -one[0])


def _likeness(one: Counter[str], other: Counter[str]) -> float:
    size, size2 = one.total(), other.total()
    if min(size, size2) < _LEAST / 2 * max(size, size2):
        return 0.0
    return 2 * (one & other).total() / (size + size2)
