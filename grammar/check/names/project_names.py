"""Names that files use and nothing declares, judged over all files of a project.

A single file cannot show whether such a name is a mistake or whether its file is missing. It
depends on whether all files that could declare it are read, whether it is a slip of a visible name,
how often it is used, and how many similar names there are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from grammar.check.analysis.spelling import Spelling
from grammar.check.names.unresolved_name import (
    MOST_SLIPS,
    SERIES,
    SLUGS,
    WORDS,
    Key,
    UnresolvedName,
    times,
)
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, diagnose
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Typos, prefix_of
from grammar.syntax.references import Space

# Two names of so many letters that are one slip apart and used once each are one.
_LONG = 6
# So many names that nothing declares are mistakes; of more, what declares them is missing. So it is
# where two of a program without a data list are declared nowhere.
_MOST_LOST = 3
# Data that more modules use were declared in a file that has gone, rather than nowhere.
_MOST_MODULES = 2

_Uses = Mapping[Key, Sequence[UnresolvedName]]


def of_project(found: Iterable[UnresolvedName], spelling: Spelling) -> Iterator[Diagnostic]:
    """Yield the findings on names that the files of a project use from elsewhere.

    An undeclared name is an error if all files that could declare it are read; a warning if it is a
    slip of a visible name, or of a name that is used often and comes from elsewhere itself;
    otherwise a note, once for each name. If many names are undeclared and none is a slip, the file
    that declares them is missing, and all of them are notes.
    """
    uses: dict[Key, list[UnresolvedName]] = {}
    for reference in found:
        uses.setdefault(reference.key, []).append(reference)
    counts = {key: sum(one.count for one in some) for key, some in uses.items()}
    slips = _slips(uses, counts, spelling)
    lost = _lost({key: some for key, some in uses.items() if key not in slips})
    for key, some in uses.items():
        if key in slips or key in lost:
            yield from (_undeclared(one, slips.get(key, ())) for one in some)
        elif key[0]:
            yield _from_elsewhere(some, counts[key])


def _slips(
    uses: _Uses, counts: Mapping[Key, int], spelling: Spelling
) -> dict[Key, tuple[str, ...]]:
    """Return the rare names that are slips, with the names that may be meant."""
    meant = _meant(uses, counts, spelling)
    series = Counter(name for names in meant.values() for name in names)
    slips = {}
    for key, some in uses.items():
        near = tuple(name for name in meant[key] if series[name] < SERIES)
        if not near and counts[key] == 1 and (word := spelling.meant(some[0].name)):
            near = (word,)
        is_rare = counts[key] <= (MOST_SLIPS if key[0] else 1)
        if near and (is_rare or any(one.is_swapped for one in some)):
            slips[key] = near
    return slips


def _meant(
    uses: _Uses, counts: Mapping[Key, int], spelling: Spelling
) -> dict[Key, tuple[str, ...]]:
    """Return the names of which each may be a slip: visible ones, or others that are undeclared."""
    typos = {
        space: Typos(some[0].name for (at, _), some in uses.items() if at is space)
        for space in SLUGS
    }
    prefixes = Counter((space, prefix_of(some[0].name)) for (space, _), some in uses.items())
    ranks = {key: (counts[key], -number) for number, key in enumerate(uses)}

    def is_right(space: Space | None, right: str, wrong: str) -> bool:
        """Return whether a name is more frequent than another, more likely spelt, or first."""
        rank, other = ranks[space, right.upper()], ranks[space, wrong.upper()]
        if rank[0] != other[0]:
            return rank > other
        if spelling.meant(right) == wrong:
            return False
        if rank[0] > 1 or len(right) < _LONG:
            return False
        return spelling.is_likelier(right, wrong) or (
            rank > other and not spelling.is_likelier(wrong, right)
        )

    def among_undeclared(space: Space | None, name: str) -> Iterator[str]:
        prefix = prefix_of(name)
        has_slipped = bool(prefix) and prefixes[space, prefix] == 1
        has_plurals = space is Space.VALUE
        for near in typos[space].meant(name, has_slipped=has_slipped, has_plurals=has_plurals):
            if is_right(space, near, name):
                yield near

    return {
        key: some[0].near or tuple(among_undeclared(key[0], some[0].name))
        for key, some in uses.items()
    }


def _lost(uses: _Uses) -> frozenset[Key]:
    """Return the names that are declared nowhere although all files that could are read."""
    lost: dict[bool, list[Key]] = {True: [], False: []}
    for key, some in uses.items():
        if all(one.is_all_read for one in some) and len(some) <= _MOST_MODULES:
            lost[all(one.is_certain for one in some)].append(key)
    programs = Counter(uses[key][0].path for key in lost[False])
    alone = [key for key in lost[False] if programs[uses[key][0].path] == 1]
    return frozenset(
        key
        for names, few in ((lost[True], lost[True]), (lost[False], alone))
        if len(names) <= _MOST_LOST
        for key in few
    )


def _undeclared(reference: UnresolvedName, near: Sequence[str]) -> Diagnostic:
    is_certain = reference.is_all_read and reference.is_certain
    severity: Severity = "error" if is_certain else "warning"
    slug = SLUGS[reference.space]
    message = f"no {WORDS[reference.space]} is called {reference.name}"
    if reference.is_system:
        slug, message = "unknown-system-name", f"no system variable is called {reference.name}"
    return diagnose(
        slug, reference.path, reference.region, message, severity=severity, fix=one_of(near)
    )


def _from_elsewhere(some: Sequence[UnresolvedName], count: int) -> Diagnostic:
    first = min(some, key=lambda reference: (reference.path, reference.region))
    uses_of_it = f"used {times(count)}"
    if first.is_system:
        slug = "unknown-system-name"
        message = f"{first.name} is in no table of system variables; {uses_of_it}"
    else:
        slug = "unknown-external"
        message = (
            f"the {WORDS[first.space]} {first.name} is declared in no file at hand; {uses_of_it}"
        )
    return diagnose(slug, first.path, first.region, message, severity="note")
