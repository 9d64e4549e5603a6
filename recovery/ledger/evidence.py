"""Evidence: the lines of real files that can be read because of a construct.

A line counts if it failed by itself under the grammar before the construct and does not fail under
the grammar after it. If a line needs several constructs, it counts for the last of them, so nothing
is counted twice. A content in several locations is one witness: its lines count once, and there are
never more origins than distinct contents.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, zip_longest

from grammar.parser.failures import Form
from recovery.ledger.construct import Evidence
from recovery.survey.failing_line import FailingLine
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile

_PLACES_SEEN = 10


@dataclass(frozen=True, slots=True)
class RestoredLine:
    """A line that failed by itself and no longer fails, with its file and its failure."""

    file: SurveyedFile
    failed: FailingLine
    form: Form


def restored_lines(before: Survey, after: Survey) -> list[RestoredLine]:
    """Return the lines that fail in ``before`` and not in ``after``, copies left out."""
    return [
        RestoredLine(old, failed, before.forms[failed.form])
        for old, new in _pairs(before, after)
        if old.failures
        for still in ({failed.line for failed in new.failures},)
        for failed in old.failures
        if not failed.follows and failed.line not in still
    ]


def restored_files(before: Survey, after: Survey) -> list[SurveyedFile]:
    """Return the files that parse in ``after`` only."""
    return [new for old, new in _pairs(before, after) if old.failures and not new.failures]


def broken_files(before: Survey, after: Survey) -> list[tuple[SurveyedFile, FailingLine]]:
    """Return the files that parse in ``before`` only, each with its first failure in ``after``."""
    return [
        (new, new.failures[0])
        for old, new in _pairs(before, after)
        if new.failures and not old.failures
    ]


def _pairs(before: Survey, after: Survey) -> Iterator[tuple[SurveyedFile, SurveyedFile]]:
    """Yield the same content in two surveys of one corpus."""
    known = {file.digest: file for file in after.files}
    return ((old, known[old.digest]) for old in before.files if old.digest in known)


def with_counts(evidence: Evidence, lines: Sequence[RestoredLine]) -> Evidence:
    """Return the evidence with new counts and places, those of the restored lines."""
    files = {line.file.digest: line.file for line in lines}
    origins = {origin for file in files.values() for _, origin in file.places}
    return replace(
        evidence,
        files=sum(len(file.places) for file in files.values()),
        origins=min(len(origins), len(files)),
        lines=len(lines),
        seen=tuple(_seen(lines)),
    )


def _seen(lines: Iterable[RestoredLine]) -> list[str]:
    """Return the first places, spread over the origins and then over the files of each."""
    by_file: dict[str, dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for line in lines:
        path, origin = line.file.places[0]
        by_file[origin][path].append(f"{place(path, origin)}:{line.failed.line}")
    by_origin = [list(_in_turns(files.values())) for files in by_file.values()]
    return sorted(islice(_in_turns(by_origin), _PLACES_SEEN))


def _in_turns(rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield the first item of each row, then the second of each, and so on."""
    return (text for turn in zip_longest(*rows) for text in turn if text is not None)


def place(path: str, origin: str) -> str:
    """Return the path of a file within its origin, beginning with the origin's folder.

    The folders above the origin are left out, because they differ on every machine.
    """
    folders = path.split("/")
    for index, folder in enumerate(folders[:-1]):
        names = (folder, folder.replace("__", "/", 1), folder.rpartition(".")[0])
        if origin in names:
            return "/".join(folders[index:])
    return f"{origin}/{folders[-1]}"
