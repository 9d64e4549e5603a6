"""What remains of a corpus under a grammar: files that do not parse, and ambiguous lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TypedDict

from grammar.notation.model import Grammar
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.failures import FailureFinder
from grammar.parser.line_reader import LineReader, Spot
from grammar.parser.recognizer import Recognizer
from recovery.negatives.language_facts import violation
from recovery.record.record_types import (
    AmbiguousLineRecord,
    AmbiguousRecord,
    RemainingFileRecord,
    RemainingLineRecord,
)
from recovery.survey.failing_line import failures_of, source_lines
from recovery.survey.surveyed_files import SurveyedFile

_REASONS = Path(__file__).with_name("remaining.tsv")
_EXAMPLES = 20
_LONGEST_LINE = 1_000


class Remaining(TypedDict):
    """The files and lines that do not parse at the end of the growth."""

    remaining: list[RemainingLineRecord]
    remaining_files: list[RemainingFileRecord]


def remaining(contents: Sequence[SurveyedFile], grammar: Grammar) -> Remaining:
    """Return the files that do not parse and their failing lines.

    ``fact`` of a file is a fact that every KRL program obeys (`recovery.negatives.language_facts`)
    and this one breaks at ``fact_line``, so it is invalid under any grammar; empty if none is
    known. ``kind`` is invalid, template, damaged or waiting (for the verdict on a construct), and
    ``reason`` explains it: by hand for files of the public corpus, otherwise by the broken fact.
    Both are empty if nothing is known.
    """
    finder = FailureFinder(Recognizer(grammar))
    lines: list[RemainingLineRecord] = []
    files: list[RemainingFileRecord] = []
    for content in contents:
        text = content.text()
        if text is None:
            continue
        failures = failures_of(finder, text, {})
        broken = violation(text)
        known = ("invalid", broken.fact) if broken else ("", "")
        kind, reason = _reasons().get(content.digest, known)
        files.append(
            {
                "path": content.path,
                "origin": content.places[0][1],
                "copies": [path for path, _ in content.places[1:]],
                "bytes": content.size,
                "lines": len(source_lines(text)),
                "failing": len(failures),
                "fact": broken.fact if broken else "",
                "fact_line": broken.line if broken else 0,
                "kind": kind,
                "reason": reason,
            }
        )
        lines += [
            {
                "path": content.path,
                "line": failed.line,
                "column": failed.column,
                "token": failed.token,
                "text": failed.source,
                "follows": failed.follows,
            }
            for failed in failures
        ]
    return {"remaining": lines, "remaining_files": files}


@cache
def _reasons() -> Mapping[str, tuple[str, str]]:
    """Return the kind and the reason for known files, by digest."""
    lines = _REASONS.read_text(encoding="utf-8").splitlines()
    rows = (line.split("\t") for line in lines if not line.startswith(("#", "sha256")))
    return {digest: (kind, reason) for digest, kind, _, _, reason in rows}


def ambiguous_lines(contents: Sequence[SurveyedFile], grammar: Grammar) -> AmbiguousRecord:
    """Return how many lines in files that parse have two readings, with the first as examples.

    Each line is examined in its context. ``lines`` is the number of ambiguous lines, copies left
    out, ``of`` that of all lines.
    """
    recognizer = Recognizer(grammar)
    reader = LineReader(recognizer)
    known: dict[tuple[Spot, int], bool] = {}
    examples: list[AmbiguousLineRecord] = []
    count = total = 0
    for content in contents:
        text = content.text()
        if text is None:
            continue
        spot = reader.spot(recognizer.start)
        found: list[int] = []
        *lines, _ = reader.numbers(recognizer.kinds(text))  # the last is the end of the file
        for number, line in enumerate(lines, 1):
            key = (spot, line)
            if key not in known:
                known[key] = is_ambiguous(recognizer, spot.state, reader.kinds[line])
            if known[key]:
                found.append(number)
            after = reader.after(spot, line)
            if after is None:  # the file has changed since it was read
                break
            spot = after
        count += len(found)
        total += len(lines)
        if found and len(examples) < _EXAMPLES:
            written = source_lines(text)
            examples += [
                {"path": content.path, "line": n, "text": written[n - 1][:_LONGEST_LINE]}
                for n in found
                if n <= len(written)
            ]
    return {"lines": count, "of": total, "examples": examples[:_EXAMPLES]}
