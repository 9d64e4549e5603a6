"""The survey: every file of a corpus is read under one grammar, and all failures are collected.

Files are surveyed in parallel processes, each with its own recogniser. Results come back in the
order of discovery, so the same corpus always gives the same survey. A file with the content of an
earlier one is not read again, but counted as a copy of it.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from grammar.notation import g4
from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder, Form
from grammar.parser.recognizer import Recognizer
from recovery.survey.failing_line import failures_of
from recovery.survey.result_cache import Kept, keep, key_of, recall
from recovery.survey.surveyed_files import SurveyedFile, SurveyedFiles
from recovery.survey.unreserved_keywords import (
    NameUse,
    UnreservedKeyword,
    UnreservedKeywords,
    names_used,
)
from support.files.decode import decode, digest
from support.files.discovery import FoundFile, IngestError, Skipped, discover, read
from support.files.result_store import ResultStore
from support.parallel.ordered_map import check_scheduler, ordered_map
from support.parallel.progress import Progress, no_progress

# Size of a task: large enough to outweigh its transfer, small enough to bound memory.
_TASK_BYTES = 1 << 20
_TASK_FILES = 64
_SMALL = 8 << 20
# The states of a recogniser in a process; one with more is replaced, so that memory is bounded.
_MOST_STATES = 20_000


@dataclass(frozen=True)
class Survey:
    """The result of reading a corpus under a grammar.

    ``unreserved`` are words in files that parse which may be keywords missing in the grammar;
    ``seconds`` is wall-clock time.
    """

    grammar: Grammar
    files: Sequence[SurveyedFile]
    skipped: tuple[Skipped, ...]
    forms: tuple[Form, ...]
    unreserved: tuple[UnreservedKeyword, ...]
    seconds: float

    @cached_property
    def failing(self) -> tuple[SurveyedFile, ...]:
        """The files with failures."""
        return tuple(file for file in self.files if file.failures)


def survey(
    roots: Sequence[Path],
    grammar: Grammar,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> Survey:
    """Return the survey of everything below ``roots`` under ``grammar``.

    ``jobs`` is the number of processes; the default is one for each core, or one for a small
    corpus. ``scheduler`` is the address of a Dask cluster that does the work instead
    (`support.parallel.ordered_map`). ``cache`` is the folder for cached results; without it nothing
    is cached. ``on_found`` is called with the number of candidates, ``on_done`` with the number of
    files that have been finished since its last call.

    Raises `support.files.discovery.IngestError` if there is nothing to survey, and
    `support.parallel.workers.WorkersError` if there are no workers.
    """
    began = time.perf_counter()
    try:
        files = SurveyedFiles()
        count, size = files.add(discover(roots))
        on_found(count)
        check_scheduler(scheduler)  # before anything is written
        with ResultStore(cache, key_of(grammar)) as store:
            gathered = _Gathered(store, files)
            tasks = ((grammar.text, contents) for contents in _tasks(gathered))
            for done in ordered_map(
                _read_contents, tasks, jobs=jobs or _processes(size), scheduler=scheduler
            ):
                gathered.add(done)
                on_done(len(done))
        on_done(count - gathered.read_now)
        return gathered.survey(grammar, time.perf_counter() - began)
    except sqlite3.Error as error:
        raise IngestError(f"temporary files cannot be written: {error}") from error


def _processes(size: int) -> int:
    """Return the number of cores; 1 for a small corpus, where more processes would not pay."""
    return 1 if size < _SMALL else os.cpu_count() or 1


def survey_texts(programs: Sequence[tuple[str, str]], grammar: Grammar) -> Survey:
    """Return the survey of programs given as (path, text), read in this process.

    Each counts as a file of its own.
    """
    began = time.perf_counter()
    finder = FailureFinder(Recognizer(grammar))
    forms: dict[Form, int] = {}
    files = []
    unreserved = UnreservedKeywords()
    for path, text in programs:
        found = FoundFile(path, "given", len(text), Path(path), None)
        failed = failures_of(finder, text, forms)
        files.append(SurveyedFile(found, ((path, "given"),), path, len(text), failed))
        if not failed:
            unreserved.add("given", names_used(text, finder.recognizer.lexer))
    seconds = time.perf_counter() - began
    return Survey(grammar, tuple(files), (), tuple(forms), unreserved.found(), seconds)


# ------------------------------------------------------------------------------ in a process


@cache
def _finder(grammar_text: str) -> FailureFinder:
    return FailureFinder(Recognizer(g4.read(grammar_text)))


def _read_contents(grammar_text: str, contents: tuple[bytes, ...]) -> list[Kept]:
    """Return what is found in each content: why it is skipped, or its failures and names."""
    finder = _finder(grammar_text)
    if finder.recognizer.size > _MOST_STATES:
        finder.recognizer.release()
        _finder.cache_clear()
        finder = _finder(grammar_text)
    results: list[Kept] = []
    for data in contents:
        source = decode(data)
        if isinstance(source, str):
            results.append(source)
        else:
            forms: dict[Form, int] = {}
            failures = failures_of(finder, source.text, forms)
            lexer = finder.recognizer.lexer
            names = NameUse() if failures else names_used(source.text, lexer)
            results.append((failures, tuple(forms), names))
    return results


# ------------------------------------------------------------------------------ in the parent


class _Gathered:
    """The results so far, by content."""

    def __init__(self, store: ResultStore, files: SurveyedFiles) -> None:
        self.store = store
        self.files = files
        self.skipped: list[Skipped] = []
        self.forms: dict[Form, int] = {}
        self.unreserved = UnreservedKeywords()
        self.submitted: deque[tuple[str, str]] = deque()
        self.read_now = 0

    def register(self, number: int, found: FoundFile, data: bytes) -> bool:
        """Record the content of a candidate; return whether it has to be read."""
        key = digest(data)
        if not self.files.register(number, key, len(data)):
            return False
        kept = recall(self.store, key)
        if kept is not None:
            self._take(key, found.origin, kept)
            return False
        self.submitted.append((key, found.origin))
        return True

    def add(self, done: list[Kept]) -> None:
        """Add the results of the next task."""
        submitted = [self.submitted.popleft() for _ in done]
        keep(self.store, [(key, kept) for (key, _), kept in zip(submitted, done, strict=True)])
        for (key, origin), kept in zip(submitted, done, strict=True):
            self._take(key, origin, kept)
        self.read_now += len(done)

    def _take(self, key: str, origin: str, kept: Kept) -> None:
        if isinstance(kept, str):
            self.files.leave_out(key, kept)
            return
        failures, forms, names = kept
        numbers = [self.forms.setdefault(form, len(self.forms)) for form in forms]
        self.files.set_failures(key, tuple([f.with_form(numbers[f.form]) for f in failures]))
        if not failures:
            self.unreserved.add(origin, names)

    def survey(self, grammar: Grammar, seconds: float) -> Survey:
        skipped = sorted([*self.skipped, *self.files.left_out()], key=lambda s: s.path)
        forms, unreserved = tuple(self.forms), self.unreserved.found()
        return Survey(grammar, self.files, tuple(skipped), forms, unreserved, seconds)


def _tasks(gathered: _Gathered) -> Iterator[tuple[bytes, ...]]:
    """Yield the contents that have to be read, grouped into tasks."""
    contents: list[bytes] = []
    size = 0
    for number, candidate in gathered.files.candidates():
        data = candidate if isinstance(candidate, Skipped) else read(candidate)
        if isinstance(data, Skipped):
            gathered.skipped.append(data)
        elif isinstance(candidate, FoundFile) and gathered.register(number, candidate, data):
            contents.append(data)
            size += len(data)
            if size >= _TASK_BYTES or len(contents) >= _TASK_FILES:
                yield tuple(contents)
                contents, size = [], 0
    if contents:
        yield tuple(contents)
