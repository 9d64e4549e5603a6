"""Names that were changed throughout: reported once instead of line by line.

A name counts as renamed if changed lines differ only in it, always in the same way, the old name is
nowhere in the new state, and the new name is nowhere in the old one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from grammar.comparison.content import Content, RoutineText
from grammar.comparison.matching import line_operations
from grammar.diagnostics.expected_tokens import is_reserved

_NAME = re.compile(r'"[^"]*"|([$A-Z_][\w$]*)')


def names_in(content: Content) -> set[str]:
    """Return the names in a file that can be changed, in upper case: no keywords, no `$` names."""
    names = {name for key in _keys(content) for name in _NAME.findall(key)}
    return {name for name in names if name and name[0] != "$" and not is_reserved(name)}


def _keys(content: Content) -> Iterator[str]:
    for routine in content.routines:
        yield routine.name.upper()
        yield routine.signature
        yield from routine.keys
    for name, datum in content.data.items():
        yield name
        yield datum.key


def renamings(
    pairs: Sequence[tuple[Content, Content]], old: set[str], new: set[str]
) -> dict[str, str]:
    """Return the new name of each renamed one; ``old`` and ``new`` are all names of the states."""
    votes: Counter[tuple[str, str]] = Counter()
    gone, come = old - new, new - old
    for before, after in pairs:
        for one, other in zip(before.routines, after.routines, strict=False):
            votes.update(_votes(one.keys, other.keys, gone, come))
        votes.update(_votes(_data_keys(before), _data_keys(after), gone, come))
    found: dict[str, str] = {}
    taken: set[str] = set()
    for (was, now), _ in sorted(votes.items(), key=lambda vote: (-vote[1], vote[0])):
        if was not in found and now not in taken:
            found[was] = now
            taken.add(now)
    return found


def _data_keys(content: Content) -> tuple[str, ...]:
    return tuple(f"{name} {datum.key}" for name, datum in content.data.items())


def _votes(
    old: Sequence[str], new: Sequence[str], gone: set[str], come: set[str]
) -> Iterator[tuple[str, str]]:
    """Yield the old and new name for each changed line that differs only in renamed names."""
    for tag, first, last, start, end in line_operations(old, new):
        if tag != "replace" or last - first != end - start:
            continue
        for before, after in zip(old[first:last], new[start:end], strict=True):
            one, other = _NAME.sub(_split, before).split(), _NAME.sub(_split, after).split()
            if len(one) != len(other):
                continue
            different = {(a, b) for a, b in zip(one, other, strict=True) if a != b}
            if all(a in gone and b in come for a, b in different):
                yield from different


def _split(found: re.Match[str]) -> str:
    return f" {found[0]} "


def renamed(content: Content, names: Mapping[str, str]) -> Content:
    """Return the file with names replaced in everything that is compared."""
    if not names:
        return content
    data = {}
    for key, datum in content.data.items():
        data[_in(key, names)] = replace(datum, key=_in(datum.key, names))
    routines = tuple(_routine(routine, names) for routine in content.routines)
    return Content(content.path, routines, data)


def _routine(routine: RoutineText, names: Mapping[str, str]) -> RoutineText:
    body = tuple(replace(line, key=_in(line.key, names)) for line in routine.body)
    return replace(routine, signature=_in(routine.signature, names), body=body)


def _in(key: str, names: Mapping[str, str]) -> str:
    return _NAME.sub(lambda found: names.get(found[1] or "", found[0]), key)
