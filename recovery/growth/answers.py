"""Which construct of the ledger resolved each cluster of the restrictive start.

A cluster has example lines in real files. It is answered by the construct from which on most of its
lines can be read. So the grammars of the ledger are tried from the last one back, each only on the
files of clusters whose lines could be read under all grammars behind it, and only as far as these
lines.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypedDict

from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder, beginning
from grammar.parser.recognizer import Recognizer
from recovery.growth.growth import LedgerSteps
from recovery.ledger.construct_record import construct_record
from recovery.record.record_types import ClusterRecord, ConstructRecord
from recovery.survey.result_cache import key_of
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile
from support.files.result_store import ResultStore
from support.parallel.ordered_map import ordered_map
from support.parallel.progress import Progress, no_progress

#: Characters times grammars; for less work one process is faster.
_SMALL = 32 << 20

#: Example lines of a cluster: path and line number.
_Lines = Sequence[tuple[str, int]]
#: Paths, each with the text to read of the file.
_Texts = tuple[tuple[str, str], ...]


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
    constructs (`recovery.ledger.construct_record`) in the order of the ledger. A line of a file
    that has changed since the survey counts as read.

    ``jobs`` is the number of processes; the default is one for each core, or one for little work.
    ``cache`` is the folder for cached answers. ``on_found`` is called with the number of grammars,
    ``on_done`` with the number finished since its last call.
    """
    grammars = [found.grammar, *(grammar for _, grammar in steps)]
    files = {file.path: file for file in found.files}
    examples = [[e for e in _lines(cluster) if e[0] in files] for cluster in clusters]
    keys = [_key(lines, files, grammars) for lines in examples]
    with ResultStore(cache, key_of(found.grammar)) as store:
        known = {key: store.get(key) for key in keys}
        asked = {
            key: lines
            for key, lines in zip(keys, examples, strict=True)
            if not isinstance(known[key], int)
        }
        texts = {
            path: files[path].text() for path in sorted({p for ns in asked.values() for p, _ in ns})
        }
        on_found(len(steps))
        numbers = _numbers(asked, texts, grammars, jobs, on_done)
        lasting = (
            key for key, lines in asked.items() if all(texts[path] is not None for path, _ in lines)
        )
        store.put((key, numbers[key]) for key in lasting)
    by_key = {**known, **numbers}
    answers = [number if isinstance(number := by_key[key], int) else 0 for key in keys]
    return {
        "clusters": [
            {**cluster, "answered_by": steps[number - 1][0].id if number else None}
            for cluster, number in zip(clusters, answers, strict=True)
        ],
        "constructs": [
            construct_record(steps[number - 1][0], grammars[number - 1], grammars[number])
            for number in sorted({*answers} - {0})
        ],
    }


def _lines(cluster: ClusterRecord) -> _Lines:
    """Return the path and line number of each example of a cluster."""
    return [(e["path"], e["line"]) for e in (cluster["example"], *cluster["examples"])]


def _key(lines: _Lines, files: Mapping[str, SurveyedFile], grammars: Sequence[Grammar]) -> str:
    """Return a digest of the contents and lines, and of the grammars."""
    written = [(files[path].digest, line) for path, line in lines], [g.sha256 for g in grammars]
    return f"answer {hashlib.sha256(repr(written).encode()).hexdigest()}"


def _numbers(
    asked: Mapping[str, _Lines],
    texts: Mapping[str, str | None],
    grammars: Sequence[Grammar],
    jobs: int | None,
    on_done: Progress,
) -> dict[str, int]:
    """Return the first grammar from which on most of some lines can always be read; 0 for none.

    The first of the grammars is the start, under which the lines fail.
    """
    numbers = dict.fromkeys(asked, 0)
    left = dict(asked)

    def tasks() -> Iterator[tuple[Grammar, _Texts]]:
        for grammar in reversed(grammars[1:]):
            if not left:
                return
            last: dict[str, int] = {}
            for path, line in (place for lines in left.values() for place in lines):
                last[path] = max(line, last.get(path, 0))
            read = ((path, texts[path] or "", line) for path, line in sorted(last.items()))
            yield grammar, tuple((path, beginning(text, line)) for path, text, line in read if text)

    jobs = jobs or _processes(texts, len(grammars))
    tried = range(len(grammars) - 1, 0, -1)
    for number, failing in zip(tried, ordered_map(_failing, tasks(), jobs=jobs), strict=False):
        for key, lines in [*left.items()]:
            unread = sum(place in failing for place in lines)
            if 2 * unread >= len(lines):
                del left[key]
            else:
                numbers[key] = number
        on_done(1)
    return numbers


def _processes(texts: Mapping[str, str | None], grammars: int) -> int:
    work = sum(len(text or "") for text in texts.values()) * grammars
    return 1 if work < _SMALL else os.cpu_count() or 1


def _failing(grammar: Grammar, texts: _Texts) -> frozenset[tuple[str, int]]:
    """Return path and number of the lines that fail under a grammar."""
    finder = FailureFinder(Recognizer(grammar))
    return frozenset((path, failure.line) for path, text in texts for failure in finder.find(text))
