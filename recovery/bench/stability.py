"""Stability of the ranking: the search repeated under other conditions.

The ranking must not depend on the order of a set or on which process came first. So the
same damaged grammars are searched in several runs, each in new processes, with another seed for the
hashes of Python, one process and two by turns, and the rankings are compared.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from recovery.bench.assessment import BenchMaterial
from recovery.bench.mutation import Mutant
from recovery.clustering.cluster import Clusters, cluster
from recovery.clustering.negative_score import negative_counter
from recovery.survey.survey import survey_texts
from support.parallel.processes import process_pool
from support.parallel.progress import Progress, no_progress

_SEED = "PYTHONHASHSEED"
_MOST_PROCESSES = 2


def same_ranking(runs: Sequence[Sequence[str]]) -> float | None:
    """The share of mutants with one ranking in all runs; nothing where none was searched."""
    if not runs or not runs[0]:
        return None
    alike = [len(set(rankings)) == 1 for rankings in zip(*runs, strict=True)]
    return round(sum(alike) / len(alike), 4)


def rankings(
    material: BenchMaterial, chosen: Sequence[Mutant], runs: int, on_done: Progress = no_progress
) -> list[list[str]]:
    """For each run, a digest of the ranking of each mutant.

    A ranking is all clusters by their titles with all proposals, in the order of the page.
    """
    found = []
    for run in range(runs):
        processes = 1 + run % _MOST_PROCESSES
        with _hash_seed(run), process_pool(processes) as pool:
            found.append(list(pool.map(partial(_ranking, material), chosen)))
        on_done(1)
    return found


@contextmanager
def _hash_seed(seed: int) -> Iterator[None]:
    """Processes started within hash by this seed."""
    before = os.environ.get(_SEED)
    os.environ[_SEED] = str(seed)
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SEED]
        else:
            os.environ[_SEED] = before


def _ranking(material: BenchMaterial, mutant: Mutant) -> str:
    texts = dict(material.shown)
    clusters = cluster(
        survey_texts(material.shown, mutant.grammar),
        count_negatives=negative_counter(mutant.grammar, material.negatives),
        text_of=lambda file: texts[file.digest],
    )
    return _digest(clusters)


def _digest(clusters: Clusters) -> str:
    ranking = [(c.id, c.title, [p.edits for p in c.proposals]) for c in clusters.ranked]
    return hashlib.sha256(repr(ranking).encode()).hexdigest()
