"""Agreement of clusters with the ledger: ideally one cluster for each construct.

The ledger says which construct answers a failure: the one from which on its file can be read past
the place of the failure. So the clusters of the restrictive start can be held against it, on a
whole corpus and on parts of it that are drawn by a seed.
"""

from __future__ import annotations

import random
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import Clusters, cluster
from recovery.clustering.negative_score import negative_counter
from recovery.negatives.negatives import Negative
from recovery.survey.survey import Survey
from support.parallel.progress import Progress, no_progress

#: The digest of a file and the index of a failure in it.
FailureKey = tuple[str, int]


def answers(found: Survey, grammars: Sequence[Grammar]) -> dict[FailureKey, int]:
    """For each failure the number of the grammar from which on its file is read past it.

    ``found`` is the survey under ``grammars[0]``, each of which reads more than the one before.
    Failures that follow from others, and those that remain under the last, are left out.
    """
    waiting = {
        (file.digest, index): (failed.line, failed.column)
        for file in found.files
        for index, failed in enumerate(file.failures)
        if not failed.follows
    }
    texts = {file.digest: "\n".join(file.lines()) for file in found.files if file.failures}
    answered: dict[FailureKey, int] = {}
    for number in range(len(grammars) - 1, 0, -1):  # from the last: what fails there is never read
        finder = FailureFinder(Recognizer(grammars[number]))
        failing = {
            digest: {failure.line: failure.column for failure in finder.find(texts[digest])}
            for digest in sorted({digest for digest, _ in waiting})
        }
        for key, (line, column) in list(waiting.items()):
            if failing[key[0]].get(line, column + 1) > column:
                answered[key] = number
            else:
                del waiting[key]
    return answered


def agreement(
    clusters: Clusters, answered: Mapping[FailureKey, int], names: Sequence[str]
) -> dict[str, Any]:
    """How clusters agree with the constructs that answer their failures.

    A cluster stands for the construct that answers most of its failures. ``names[n - 1]`` is the
    construct of the grammar of number ``n``.

    - clusters: those that stand for a construct; constructs: those that answer any failure.
    - clusters_per_construct: clusters for each construct that one stands for.
    - purity: the share of answered failures in a cluster that stands for their construct.
    - hidden: constructs that no cluster stands for. several: those with more than one, by title.
    """
    titles = {entry.id: entry.title for entry in clusters.ranked}
    counts: dict[str, Counter[int]] = defaultdict(Counter)
    for key, name in clusters.cluster_of.items():
        if key in answered:
            counts[name][answered[key]] += 1
    standing: dict[int, list[str]] = defaultdict(list)
    for name, count in counts.items():
        standing[max(count, key=lambda n: (count[n], -n))].append(titles[name])
    all_of = sum(map(Counter.total, counts.values()))
    own = sum(max(count.values()) for count in counts.values())
    constructs = {number for count in counts.values() for number in count}
    return {
        "clusters": len(counts),
        "constructs": len(constructs),
        "clusters_per_construct": round(len(counts) / len(standing), 3) if standing else None,
        "purity": round(own / all_of, 4) if all_of else None,
        "hidden": sorted(names[number - 1] for number in constructs - standing.keys()),
        "several": {
            names[number - 1]: sorted(some)
            for number, some in sorted(standing.items())
            if len(some) > 1
        },
    }


def measured(
    found: Survey,
    grammars: Sequence[Grammar],
    names: Sequence[str],
    negatives: Sequence[Negative],
    parts: int,
    seed: int,
    on_done: Progress = no_progress,
) -> Iterator[dict[str, Any]]:
    """The agreement on the whole survey, then on ``parts`` halves of its origins, drawn by seed."""
    count_negatives = negative_counter(grammars[0], negatives)
    answered = answers(found, grammars)
    on_done(1)
    for part, files in enumerate(_halves(found, parts, seed)):
        clusters = cluster(replace(found, files=files), count_negatives=count_negatives)
        on_done(1)
        figures = agreement(clusters, answered, names)
        yield {"part": f"half {part}" if part else "all", "files": len(files), **figures}


def _halves(found: Survey, parts: int, seed: int) -> Iterator[tuple[Any, ...]]:
    yield found.files
    origins = sorted({origin for file in found.files for _, origin in file.places})
    chance = random.Random(seed)
    for _ in range(parts):
        chosen = set(chance.sample(origins, (len(origins) + 1) // 2))
        yield tuple(file for file in found.files if file.places[0][1] in chosen)
