"""Causes: failing lines grouped by the edit that mends them.

Two failures have one cause when the same edit mends both. Shapes give a first grouping; then,
heaviest group first, the best edit is sought for its lines (`recovery.clustering.search`). It takes
every line it mends, whatever its shape; lines of the group that it does not mend are searched
again. In the end causes that are one become one (`recovery.clustering.cause_merging`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, Judge
from recovery.clustering.cause_merging import joined, sought_together
from recovery.clustering.file_trial import WholeFiles
from recovery.clustering.regression import Readable, nothing_readable
from recovery.clustering.search import Search
from recovery.proposals.candidates import Line
from recovery.tuning import CAUSES_PER_GROUP, HEAVY_GROUPS, TRIAL_GARBAGE
from support.parallel.gc_pause import gc_paused
from support.parallel.progress import Progress, no_progress

__all__ = ["find_causes"]


def find_causes(
    recognizer: Recognizer,
    lines: Sequence[Line],
    weights: Sequence[int],
    groups: Sequence[Sequence[int]],
    judge: Judge,
    on_done: Progress = no_progress,
    whole: WholeFiles | None = None,
    readable: Readable = nothing_readable,
) -> list[Cause]:
    """Group ``lines`` by cause.

    ``weights[i]`` is what line ``i`` holds back; ``groups`` partition the indices of the lines, the
    heaviest first. ``on_done`` is told of each group dealt with. ``whole`` has the files in which
    the lines fail, ``readable`` those that can be read.
    """
    search = Search(recognizer, lines, weights, judge, whole, readable)
    causes: list[Cause] = []
    for place, group in enumerate(groups):
        search.thorough = place < HEAVY_GROUPS
        is_open = not search.open.isdisjoint(group)
        with gc_paused(TRIAL_GARBAGE if is_open else 0):
            causes += _of_group(search, group)
        on_done(1)
    with gc_paused(TRIAL_GARBAGE):
        causes = sought_together(search, causes)
    return joined(search, causes)


def _of_group(search: Search, group: Sequence[int]) -> Iterator[Cause]:
    """The causes of a group, one after the other; lines without any are one of their own."""
    left = [n for n in group if n in search.open]
    for _ in range(CAUSES_PER_GROUP):
        cause = search.best_for(left) if left else None
        if cause is None:
            break
        cause = search.with_entailed(cause)
        yield cause
        search.open.difference_update(cause.lines)
        left = [n for n in left if n in search.open]
    left += [n for n in group if search.lines[n].is_enormous]
    if left:
        search.open.difference_update(left)
        yield Cause(tuple(left), ())
