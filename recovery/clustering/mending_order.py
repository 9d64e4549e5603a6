"""The mending order: which cause to repair next so that most files parse soonest."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from recovery.survey.surveyed_files import SurveyedFile


class FileNeed(NamedTuple):
    """What a file needs to parse: its failing lines, and their causes."""

    file: SurveyedFile
    lines: Sequence[int]
    causes: frozenset[int]


def mending_order(
    parsed: int, needs: Sequence[FileNeed], ids: Sequence[str]
) -> Iterator[tuple[int, int]]:
    """Yield the causes in mending order, with the number of files that parse after each.

    ``parsed`` files parse before the first; ``ids`` are those of the clusters of the causes. The
    order is greedy: next comes the cause that makes most files parse or, on a tie, brings most
    files closest to it.
    """
    waiting: Counter[frozenset[int]] = Counter()
    for need in needs:
        waiting[need.causes] += len(need.file.places)
    while waiting:
        gain: Counter[int] = Counter()
        near: dict[int, float] = defaultdict(float)
        for wanted, count in waiting.items():
            for number in wanted:
                near[number] += count / len(wanted) ** 2
                if len(wanted) == 1:
                    gain[number] += count
        best = max(near, key=lambda n: (gain[n], near[n], ids[n]))
        left: Counter[frozenset[int]] = Counter()
        for wanted, count in waiting.items():
            rest = wanted - {best}
            if rest:
                left[rest] += count
            else:
                parsed += count
        waiting = left
        yield best, parsed
