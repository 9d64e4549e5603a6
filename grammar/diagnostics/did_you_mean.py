"""Suggestions of similar names: "did you mean …"."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

from grammar.diagnostics.diagnostic import Fix

# Cost is bounded: so many names are looked at, and none that is longer.
_MOST_NAMES = 20_000
_LONGEST_NAME = 64
_MOST_SHOWN = 3


def nearest(name: str, names: Iterable[str], most: int = _MOST_SHOWN) -> list[str]:
    """Up to ``most`` of ``names`` that differ from ``name`` by few slips, the likeliest first.

    A slip is a letter too many, too few or wrong, or two that changed places; letter case is no
    difference. Short names may have one slip, longer ones up to three. Each costs at most the
    length of ``name`` times the number of slips, and the same names give the same answer.
    """
    return [candidate for _, _, candidate in _ranked(name, names)[:most]]


def _ranked(name: str, names: Iterable[str]) -> list[tuple[int, int, str]]:
    """The names that are near, the likeliest first: slips, letters that begin alike, the name."""
    wanted = name.upper()
    if not wanted or len(wanted) > _LONGEST_NAME:
        return []
    slips = 1 if len(wanted) <= 4 else 2 if len(wanted) <= 8 else 3
    found: list[tuple[int, int, str]] = []
    for candidate in islice(names, _MOST_NAMES):
        if abs(len(candidate) - len(wanted)) > slips:
            continue
        key = candidate.upper()
        distance = _distance(wanted, key, slips)
        if 0 < distance <= slips and distance < len(wanted):
            found.append((distance, -_common_start(wanted, key), candidate))
    return sorted(found)


def did_you_mean(name: str, names: Iterable[str], mark: str = "") -> Fix | None:
    """``did you mean X?``; where several of ``names`` are equally near, up to three of them."""
    ranked = _ranked(name, names)
    return one_of((near for slips, _, near in ranked if slips == ranked[0][0]), mark)


def one_of(names: Iterable[str], mark: str = "") -> Fix | None:
    """``did you mean X or Y?`` for the first names, each once with a ``mark`` in front, if any."""
    shown = [f"{mark}{one}" for one in {one.upper(): one for one in names}.values()][:_MOST_SHOWN]
    if not shown:
        return None
    *first, last = shown
    asked = f"{', '.join(first)} or {last}" if first else last
    return Fix(f"did you mean {asked}?", names=tuple(shown))


def _common_start(one: str, other: str) -> int:
    return next((i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), len(one))


def _distance(one: str, other: str, most: int) -> int:
    """Slips between two names, or a number above ``most`` when there are more.

    Optimal string alignment, in a band of ``most`` around the diagonal.
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
