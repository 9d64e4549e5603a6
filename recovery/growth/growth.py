"""Growth of the grammar over a corpus: the effect of each construct of the ledger.

The ledger is replayed from the restrictive start. After each accepted construct the corpus is read
and the grammar is measured. The record is exact: it has what surveys under all these grammars would
count for each file and line (`recovery.growth.timeline`).
"""

from __future__ import annotations

import hashlib
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import cast

from grammar.notation.model import Grammar
from recovery.growth.remaining import ambiguous_lines, remaining
from recovery.growth.timeline import Timeline, contents_of, read_through
from recovery.ledger.construct import Construct
from recovery.ledger.construct_record import START_RECORD, construct_record
from recovery.ledger.lookahead import decisions, share_decided
from recovery.ledger.metrics import MEANINGS, metrics
from recovery.record.record_types import GrowthRecord, SkippedRecord, StepRecord
from recovery.survey.result_cache import key_of
from recovery.survey.surveyed_files import SurveyedFile
from support.files.discovery import Skipped
from support.files.result_store import ResultStore
from support.parallel.progress import Progress, no_progress

#: Each construct with the grammar after it, as `recovery.ledger.ledger.replay` returns them.
LedgerSteps = Sequence[tuple[Construct, Grammar]]

_FILES_NAMED = 100


def growth(
    roots: Sequence[Path],
    start: Grammar,
    steps: LedgerSteps,
    *,
    jobs: int | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> GrowthRecord:
    """Return the record of the growth from ``start`` over ``steps`` on the corpus below ``roots``.

    Files and bytes include copies, lines do not. ``jobs``, ``cache`` and the callbacks are those of
    `recovery.growth.timeline.read_through`. Raises `support.files.discovery.IngestError` if there
    is nothing to read.
    """
    began = time.perf_counter()
    contents, skipped = contents_of(roots)
    grammars = [start, *(grammar for _, grammar in steps)]
    read = read_through(
        contents, grammars, jobs=jobs, cache=cache, on_found=on_found, on_done=on_done
    )
    digest = _digest(read, skipped, start, steps)
    with ResultStore(cache, key_of(start)) as store:
        kept = cast("GrowthRecord | None", store.get_record(digest))
        record = kept or _record(read, skipped, start, steps)
        if kept is None:
            store.put([(digest, record)])
    return {**record, "seconds": round(time.perf_counter() - began, 3)}


def _digest(
    read: Sequence[Timeline], skipped: Sequence[Skipped], start: Grammar, steps: LedgerSteps
) -> str:
    """Return a digest of everything that the record depends on, except the code."""
    code = hashlib.sha256(start.sha256.encode())
    for construct, grammar in steps:
        code.update(repr((construct, grammar.sha256)).encode())
    for line in read:
        code.update(repr((line.content.digest, line.content.places, line.reason)).encode())
    for entry in skipped:
        code.update(repr((entry.path, entry.reason)).encode())
    return code.hexdigest()


def _record(
    read: Sequence[Timeline], skipped: Sequence[Skipped], start: Grammar, steps: LedgerSteps
) -> GrowthRecord:
    files = [line for line in read if not line.reason]
    last = steps[-1][1] if steps else start
    choices = decisions(last)
    failing = [f.content for f in files if not f.parses(len(steps))]
    parsed = [f.content for f in files if f.parses(len(steps))]
    left = remaining(failing, last)
    return {
        "grammar_sha256": last.sha256,
        "files": sum(len(f.content.places) for f in files),
        "distinct": len(files),
        "bytes": _bytes(f.content for f in files),
        "skipped": _skipped(skipped, read),
        "meanings": dict(MEANINGS),
        "steps": list(_steps(files, start, steps)),
        "lookahead": {
            "decisions": len(choices),
            "one": round(share_decided(choices, 1), 3),
            "two": round(share_decided(choices, 2), 3),
            "others": [choice.in_words for choice in choices if choice.tokens > 2],
        },
        "ambiguous": ambiguous_lines(parsed, last),
        "remaining": left["remaining"],
        "remaining_files": left["remaining_files"],
    }


def _bytes(contents: Iterable[SurveyedFile]) -> int:
    return sum(c.size * len(c.places) for c in contents)


def _skipped(skipped: Sequence[Skipped], read: Sequence[Timeline]) -> list[SkippedRecord]:
    """Return everything that was not read, with the reason, sorted by path."""
    rows = [(entry.path, entry.reason, entry.origin) for entry in skipped]
    rows += [
        (path, f.reason, origin) for f in read if f.reason for path, origin in f.content.places
    ]
    return [{"path": p, "reason": reason, "origin": origin} for p, reason, origin in sorted(rows)]


# ---------------------------------------------------------------------------------- the steps


def _steps(files: Sequence[Timeline], start: Grammar, steps: LedgerSteps) -> Iterator[StepRecord]:
    total = sum(len(f.content.places) for f in files)
    size = _bytes(f.content for f in files)
    failing = _failing_lines(files, len(steps) + 1)
    fails = [(f.content, f.whenever) for f in files]
    parsed_before: set[str] | None = None
    before = start
    for number, (construct, grammar) in enumerate(((None, start), *steps)):
        parsed = [content for content, when in fails if not when >> number & 1]
        places = {path: None for content in parsed for path, _ in content.places}
        known = places.keys() if parsed_before is None else parsed_before
        restored = [path for path in places if path not in known]
        broken = sorted(known - places.keys())
        about = construct and construct_record(construct, before, grammar)
        yield {
            **(about or START_RECORD),
            "files": total,
            "bytes": size,
            "parsed": len(places),
            "parsed_bytes": _bytes(parsed),
            "restored": len(restored),
            "broken": len(broken),
            "restored_files": restored[:_FILES_NAMED],
            "broken_files": broken[:_FILES_NAMED],
            "failing_lines": failing[number],
            "metrics": dict(metrics(grammar)),
        }
        before, parsed_before = grammar, set(places)


def _failing_lines(files: Sequence[Timeline], grammars: int) -> list[int]:
    """Return the number of lines that fail under each grammar."""
    alike = Counter(when for file in files for when in file.failing.values())
    return [sum(n for when, n in alike.items() if when >> g & 1) for g in range(grammars)]
