"""Turns a survey into its record: finds causes, reduces reproducers, reviews proposals.

If the same files were analysed before with the same grammar, negatives and code, the stored record
is used.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Sequence
from pathlib import Path
from typing import cast

from recovery.clustering.cluster import cluster
from recovery.clustering.negative_score import negative_counter, no_negatives
from recovery.growth.answers import answered
from recovery.growth.growth import LedgerSteps
from recovery.negatives.negatives import Negative
from recovery.record.failure_records import FailureIndex, FailureRecords
from recovery.record.record_types import StartRecord, SurveyRecord
from recovery.record.survey_record import record_of
from recovery.survey.result_cache import key_of
from recovery.survey.survey import Survey
from support.files.result_store import ResultStore
from support.parallel.progress import Progress, no_progress


def analyse(
    found: Survey,
    negatives: Sequence[Negative],
    *,
    grammar_name: str,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> SurveyRecord:
    """Return the record of a survey (`recovery.record.survey_record`).

    Proposals are tried on ``negatives``. ``cache`` is the folder of stored records; ``on_found``
    and ``on_done`` report progress.
    """
    digest = _digest(found, negatives, grammar_name)
    with ResultStore(cache, key_of(found.grammar)) as store:
        record = cast("SurveyRecord | None", store.get_record(digest))
        index = cast("FailureIndex | None", store.get_record(f"{digest} failures"))
        if record is not None and index is not None:
            record["failures"] = FailureRecords(found, index)
        else:
            record = _worked_out(found, negatives, grammar_name, on_found, on_done)
            failures = record["failures"]
            assert isinstance(failures, FailureRecords)
            kept = {**record, "failures": ()}
            store.put([(digest, kept), (f"{digest} failures", failures.index)])
    return {**record, "seconds": round(found.seconds, 3)}


#: What the record of the start would only repeat of that of the grammar in force.
_REPEATED = frozenset({"failures", "skipped", "origins", "copies", "swallowed"})


def with_answers(
    record: SurveyRecord,
    found: Survey,
    steps: LedgerSteps,
    *,
    jobs: int | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> StartRecord:
    """Return the record of the restrictive start with the constructs that answer its clusters.

    ``record`` is that of ``found``, the survey of the start. Each cluster gets ``answered_by``, and
    ``constructs`` are those that answer clusters (`recovery.growth.answers`).
    """
    answers = answered(
        record["clusters"], found, steps, jobs=jobs, cache=cache, on_found=on_found, on_done=on_done
    )
    kept = {key: value for key, value in record.items() if key not in _REPEATED}
    return cast("StartRecord", kept | answers)


def _worked_out(
    found: Survey,
    negatives: Sequence[Negative],
    grammar_name: str,
    on_found: Progress,
    on_done: Progress,
) -> SurveyRecord:
    began = time.perf_counter()
    count_negatives = negative_counter(found.grammar, negatives) if negatives else no_negatives
    clusters = cluster(found, count_negatives=count_negatives, on_found=on_found, on_done=on_done)
    record = record_of(found, clusters, grammar_name=grammar_name)
    return {**record, "analysis_seconds": round(time.perf_counter() - began, 3)}


def _digest(found: Survey, negatives: Sequence[Negative], grammar_name: str) -> str:
    """Return a digest of everything on which the record depends, besides grammar and code."""
    code = hashlib.sha256(grammar_name.encode())
    for file in found.files:
        code.update(repr((file.digest, file.places)).encode())
    for skipped in found.skipped:
        code.update(repr((skipped.path, skipped.reason)).encode())
    for negative in negatives:
        code.update(negative.text.encode())
    return code.hexdigest()
