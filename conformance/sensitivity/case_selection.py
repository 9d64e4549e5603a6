"""Which cases are tried on a seeded fault, and in which order: those that may notice it soonest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, zip_longest
from operator import itemgetter

from conformance.sensitivity.line_reach import Reach
from conformance.sensitivity.seeded_faults import SeededFault, around, cited, uses_of


@dataclass(frozen=True, slots=True)
class Candidates:
    """The cases to try on a mutant; ``reached`` and ``sure`` as in `Detection`."""

    tried: tuple[Reach, ...]
    reached: int
    sure: int


def candidates(
    fault: SeededFault, reaches: Sequence[Reach], most: int, *, is_search: bool
) -> Candidates:
    """Return at most ``most`` cases that may fail and run its lines, and a tenth as many others.

    If fewer may fail there are more of the others, as executors that differ fail any case. First
    come cases of each line around it, those of the rarest lines first; then a case of each rule
    that the code there cites; then one of each set of lines run in its module, because cases with
    the same set mostly notice the same; then an even sample of the rest. A change of a search is
    tried on all cases that run it, as it is equivalent only if it changes none of their runs.
    """
    uses = uses_of(fault)
    reaching = [one for one in reaches if any(one.has(*lines) for lines in uses.items())]
    hard = [one for one in reaching if one.case.may_fail]
    tried = reaching
    if not is_search:
        soft = [one for one in reaching if not one.case.may_fail]
        room = max(most - len(hard), most // 10, 1)
        tried = [*_chosen(fault, hard, most), *_chosen(fault, soft, room)]
    # the lines are large, and no longer needed
    return Candidates(tuple(replace(one, lines={}) for one in tried), len(reaching), len(hard))


def _chosen(fault: SeededFault, cases: Sequence[Reach], most: int) -> Iterator[Reach]:
    """Yield at most ``most`` of the cases."""
    chosen: dict[str, Reach] = {}
    for way in (_of_rarest(fault, cases), _of_rules(fault, cases), _of_ways(fault, cases)):
        new = (one for one in way if one.case.name not in chosen)
        chosen.update((one.case.name, one) for one in islice(new, most // 4))
    yield from chosen.values()
    left = [one for one in cases if one.case.name not in chosen]
    room = most - len(chosen)
    if room:
        yield from left[:: -(-len(left) // room) or 1]


def _of_rarest(fault: SeededFault, cases: Sequence[Reach]) -> Iterator[Reach]:
    """Yield for each line around a fault the first case that runs it, the rarest lines first."""
    near = around(fault)
    running_it: dict[tuple[str, int], list[Reach]] = {}
    for one in cases:
        for module, lines in near.items():
            for line in lines.intersection(one.lines.get(module, ())):
                running_it.setdefault((module, line), []).append(one)
    found: set[str] = set()
    for _, those in sorted(running_it.items(), key=lambda item: (len(item[1]), item[0])):
        if those[0].case.name not in found:
            found.add(those[0].case.name)
            yield those[0]


def _of_rules(fault: SeededFault, cases: Sequence[Reach]) -> Iterator[Reach]:
    """Yield a case of each rule that the code around a fault cites, the rarest first, then more."""
    wanted = cited(fault)
    stating: dict[str, list[Reach]] = {}
    for one in cases:
        for rule in wanted.intersection(one.case.rules):
            stating.setdefault(rule, []).append(one)
    rows = (those for _, those in sorted(stating.items(), key=lambda row: (len(row[1]), row[0])))
    return (one for turn in zip_longest(*rows) for one in turn if one is not None)


def _of_ways(fault: SeededFault, cases: Sequence[Reach]) -> list[Reach]:
    """Return one case of each set of lines run in the module of a fault, then a second of each."""
    turns: Counter[frozenset[int]] = Counter()
    found = []
    for one in cases:
        way = one.lines.get(fault.module, frozenset())
        turns[way] += 1
        found.append((turns[way], one))
    return [one for _, one in sorted(found, key=itemgetter(0))]
