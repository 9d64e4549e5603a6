"""Remainder of a corpus under a grammar: unreadable files and ambiguous lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TypedDict

from grammar.notation.model import Grammar
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.failures import FailureFinder
from grammar.parser.line_reader import LineReader, Spot
from grammar.parser.recognizer import Recognizer
from recovery.growth.timeline import Content
from recovery.negatives.language_facts import violation
from recovery.records import (
    AmbiguousLineRecord,
    AmbiguousRecord,
    RemainingFileRecord,
    RemainingLineRecord,
)
from recovery.survey.failing_line import failures_of, source_lines
from support.files.decode import digest
from support.files.discovery import SourceFile, read_source

_REASONS = Path(__file__).with_name("remaining.tsv")
_EXAMPLES = 20
_LONGEST_LINE = 1_000


class Remaining(TypedDict):
    """What does not parse at the end of the growth."""

    remaining: list[RemainingLineRecord]
    remaining_files: list[RemainingFileRecord]


def remaining(contents: Sequence[Content], grammar: Grammar) -> Remaining:
    """The files that do not parse (``remaining_files``) and their failing lines (``remaining``).

    ``fact`` of a file is a fact that no KRL program breaks (`recovery.negatives.language_facts`)
    and this one does, at ``fact_line``: the file is no valid KRL, whatever the grammar. It is empty
    where none is known. ``kind`` is invalid, template, damaged or waiting (for the verdict on a
    construct), and ``reason`` says why: written by hand for files of the public corpus, else by the
    broken fact. Both are empty where nothing is known.
    """
    finder = FailureFinder(Recognizer(grammar))
    lines: list[RemainingLineRecord] = []
    files: list[RemainingFileRecord] = []
    for content, text in _texts(contents):
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
    """Kind and reason by the digest of a file."""
    lines = _REASONS.read_text(encoding="utf-8").splitlines()
    rows = (line.split("\t") for line in lines if not line.startswith(("#", "sha256")))
    return {digest: (kind, reason) for digest, kind, _, _, reason in rows}


def ambiguous_lines(contents: Sequence[Content], grammar: Grammar) -> AmbiguousRecord:
    """How many lines of files that parse have two readings, and the first of them as examples.

    Each line is looked at in its place. ``lines`` counts them, each content once, ``of`` says how
    many lines there are.
    """
    recognizer = Recognizer(grammar)
    reader = LineReader(recognizer)
    known: dict[tuple[Spot, int], bool] = {}
    examples: list[AmbiguousLineRecord] = []
    count = total = 0
    for content, text in _texts(contents):
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


def _texts(contents: Sequence[Content]) -> Iterator[tuple[Content, str]]:
    """The contents with their texts; one that has changed since it was found is left out."""
    for content in contents:
        file = read_source(content.found)
        if isinstance(file, SourceFile) and digest(file.data) == content.digest:
            yield content, file.text
