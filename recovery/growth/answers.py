"""Which construct of the ledger resolved each cluster of the restrictive start.

A cluster has example lines in real files. The ledger is replayed over these files. A cluster is
answered by the construct from which on most of its lines can be read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypedDict

from recovery.growth.growth import LedgerSteps
from recovery.growth.timeline import Timeline, read_through
from recovery.ledger.construct_record import construct_record
from recovery.record.record_types import ClusterRecord, ConstructRecord
from recovery.survey.survey import Survey
from support.parallel.progress import Progress, no_progress


class Answers(TypedDict):
    """The clusters of the start, and the constructs that answered them."""

    clusters: list[ClusterRecord]
    constructs: list[ConstructRecord]


def answered(
    clusters: Sequence[ClusterRecord],
    found: Survey,
    steps: LedgerSteps,
    *,
    jobs: int | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> Answers:
    """Return the clusters with their answers, and the constructs that gave these.

    ``clusters`` are those in the record of ``found``, the survey of the start. Each gets
    ``answered_by``, the ID of a construct or ``None``. ``constructs`` are the records of these
    constructs (`recovery.ledger.construct_record`) in the order of the ledger.
    """
    grammars = [found.grammar, *(grammar for _, grammar in steps)]
    wanted = {path for cluster in clusters for path, _ in _lines(cluster)}
    contents = [
        replace(file, failures=())  # they are on a disk that other processes do not know
        for file in found.files
        if file.path in wanted
    ]
    read = read_through(
        contents, grammars, jobs=jobs, cache=cache, on_found=on_found, on_done=on_done
    )
    by_path = {line.content.path: line for line in read}
    answered_clusters: list[ClusterRecord] = []
    answers: set[int] = set()
    for cluster in clusters:
        number = _answer(_lines(cluster), by_path, len(steps))
        answered_clusters.append(
            {**cluster, "answered_by": steps[number - 1][0].id if number else None}
        )
        if number:
            answers.add(number)
    return {
        "clusters": answered_clusters,
        "constructs": [
            construct_record(steps[number - 1][0], grammars[number - 1], grammars[number])
            for number in sorted(answers)
        ],
    }


def _lines(cluster: ClusterRecord) -> list[tuple[str, int]]:
    """Return the path and line number of each example of a cluster."""
    return [(e["path"], e["line"]) for e in (cluster["example"], *cluster["examples"])]


def _answer(
    lines: Sequence[tuple[str, int]], by_path: Mapping[str, Timeline], steps: int
) -> int | None:
    """Return the first step from which on most of the lines can always be read."""
    failing = [by_path[path].failing.get(line, 0) for path, line in lines if path in by_path]
    answer = None
    for number in range(steps, 0, -1):
        unread = sum(when >> number & 1 for when in failing)
        if 2 * unread >= len(failing):
            break
        answer = number
    return answer
