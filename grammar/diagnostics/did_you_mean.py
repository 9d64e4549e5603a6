"""Suggestions of similar names: "did you mean …"."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from grammar.diagnostics.diagnostic import Fix

# Bounds on the cost: the number of names that are compared, and their length.
_MOST_NAMES = 20_000
_LONGEST_NAME = 64
_MOST_SHOWN = 3
# Suggestions for one file: each costs a look at every name that is known.
_MOST_SUGGESTIONS = 20
# A word of fewer letters is the beginning of too much.
_SHORTEST_BEGINNING = 3


def nearest(name: str, names: Iterable[str], most: int = _MOST_SHOWN) -> list[str]:
    """Return up to ``most`` of ``names`` with a small edit distance to ``name``, nearest first.

    The distance counts letters that are missing, added or replaced, and neighbours that are
    swapped; letter case is ignored. It may be 1 for short names and up to 3 for longer ones. The
    result depends only on the order of ``names``; the cost for each is bounded by the length of
    ``name`` times the allowed distance.
    """
    return [candidate for _, _, candidate in _ranked(name, names)[:most]]


def _ranked(name: str, names: Iterable[str]) -> list[tuple[int, int, str]]:
    """Return the near names by distance, then by length of the common beginning, then as given."""
    wanted = name.upper()
    if not wanted or len(wanted) > _LONGEST_NAME:
        return []
    slips = 1 if len(wanted) <= 4 else 2 if len(wanted) <= 8 else 3
    found: list[tuple[int, int, str]] = []
    for candidate in islice(names, _MOST_NAMES):
        if abs(len(candidate) - len(wanted)) > slips:
            continue
        key = candidate.upper()
        distance = edit_distance(wanted, key, slips)
        if 0 < distance <= slips and distance < len(wanted):
            found.append((distance, -_common_start(wanted, key), candidate))
    return sorted(found, key=lambda one: one[:2])


def did_you_mean(name: str, names: Iterable[str], mark: str = "") -> Fix | None:
    """Return the fix ``did you mean X?`` with the nearest names, up to three on a tie."""
    ranked = _ranked(name, names)
    return one_of((near for slips, _, near in ranked if slips == ranked[0][0]), mark)


def one_of(names: Iterable[str], mark: str = "") -> Fix | None:
    """Return the fix ``did you mean X or Y?`` for the first three names, each after ``mark``."""
    shown = [f"{mark}{one}" for one in {one.upper(): one for one in names}.values()][:_MOST_SHOWN]
    if not shown:
        return None
    *first, last = shown
    asked = f"{', '.join(first)} or {last}" if first else last
    return Fix(f"did you mean {asked}?", names=tuple(shown))


class NameSuggestions:
    """Suggests names for the first unknown names of a file."""

    def __init__(self) -> None:
        self._left = _MOST_SUGGESTIONS

    def suggest(self, name: str, names: Iterable[str], mark: str = "") -> Fix | None:
        """Return those of ``names`` that are similar to ``name``, each after ``mark``."""
        if not self._left:
            return None
        self._left -= 1
        known = list(names)
        fix = did_you_mean(name, known, mark)
        if fix is None and len(name) >= _SHORTEST_BEGINNING:
            key = name.upper()
            fix = one_of((one for one in known if one.upper().startswith(key)), mark)
        return fix


def _common_start(one: str, other: str) -> int:
    return next((i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), len(one))


def edit_distance(one: str, other: str, most: int) -> int:
    """Return the edit distance of two names, or ``most + 1`` if it is greater than ``most``.

    Optimal string alignment, computed in a band of width ``most`` around the diagonal.
    """
    if one == other:
        return 0
    far = most + 1
    width = len(other)
    before: list[int] = []
    row = [column if column <= most else far for column in range(width + 1)]
    for line, letter in enumerate(one, 1):
        first, last = max(1, line - most), min(width, line + most)
        new = [far] * (width + 1)
        if line <= most:
            new[0] = line
        for column in range(first, last + 1):
            is_same = letter == other[column - 1]
            best = min(row[column - 1] + (not is_same), row[column] + 1, new[column - 1] + 1)
            if (
                line > 1
                and column > 1
                and letter == other[column - 2]
                and one[line - 2] == other[column - 1]
            ):
                best = min(best, before[column - 2] + 1)
            new[column] = best
        if min(new) > most:
            return far
        before, row = row, new
    return row[width]
