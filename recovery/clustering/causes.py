"""Finding causes: failing lines are grouped by the edit that repairs them.

Two failures have one cause if the same edit repairs both. Signatures give a first grouping. Then,
for each group, heaviest first, the best edit for its lines is sought
(`recovery.clustering.search`). It takes every line it repairs, whatever its signature; lines of the
group that it does not repair are searched again.

At the end, causes that are one are joined (`recovery.clustering.joined_causes`), and their best
proposals completed (`recovery.clustering.completion`): where few causes are left with all that
their lines need, else only in further places.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.clustering.cause import Cause
from recovery.clustering.completion import completed, with_more_places
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.joined_causes import joined
from recovery.clustering.negative_score import NegativeCounter
from recovery.clustering.reason import Reason
from recovery.clustering.regression import ParsedFiles, no_parsed_files
from recovery.clustering.search import LIGHT, THOROUGH, CauseSearch, Limits
from recovery.proposals.edit_site import LinePattern
from support.gc_pause import gc_paused
from support.parallel.progress import Progress, no_progress


def find_causes(
    recognizer: Recognizer,
    lines: Sequence[LinePattern],
    weights: Sequence[int],
    groups: Sequence[Sequence[int]],
    count_negatives: NegativeCounter,
    on_done: Progress = no_progress,
    file_trial: FileTrial | None = None,
    parsed_files: ParsedFiles = no_parsed_files,
    reasons: Sequence[Reason] = (),
) -> list[Cause]:
    """Return the causes of ``lines``.

    ``weights[i]`` is the number of files with line ``i``, ``reasons[i]`` why it fails. ``groups``
    partition the indices of the lines, the heaviest group first. ``on_done`` is called after each
    group. ``file_trial`` has the files in which the lines fail, ``parsed_files`` those that parse.
    """
    search = CauseSearch(recognizer, lines, weights, count_negatives, file_trial, parsed_files)
    causes: list[Cause] = []
    with gc_paused(tuning.MANY_OBJECTS):
        open_lines = set(search.ordinary)
        for place, group in enumerate(groups):
            limits = THOROUGH if place < tuning.HEAVY_GROUPS else LIGHT
            causes += _of_group(search, group, open_lines, limits)
            on_done(1)
        causes = joined(search, causes, reasons)
        more = completed if len(causes) <= tuning.MOST_CAUSES_COMPLETED else with_more_places
        causes = [more(search, cause) for cause in causes]
    return [replace(cause, proposals=cause.proposals[: tuning.MOST_PROPOSALS]) for cause in causes]


def _of_group(
    search: CauseSearch, group: Sequence[int], open_lines: set[int], limits: Limits
) -> Iterator[Cause]:
    """Yield the causes of a group, and take their lines out of the ``open_lines``.

    Lines for which no edit is found form a cause of their own.
    """
    left = [n for n in group if n in open_lines]
    for _ in range(tuning.CAUSES_PER_GROUP):
        cause = search.best_for(left, open_lines, limits) if left else None
        if cause is None:
            break
        cause = search.with_entailed(cause, open_lines)
        open_lines.difference_update(cause.lines)
        yield cause
        left = [n for n in left if n in open_lines]
    left += [n for n in group if n not in search.ordinary]
    if left:
        open_lines.difference_update(left)
        yield Cause(tuple(left), ())
