"""The survey: every file of a corpus read under one grammar, every failure collected.

Files are surveyed in parallel processes, each with a recogniser of its own; results come back in
the order of discovery, whatever process they came from, so the same corpus gives the same survey.
A file with the same content as an earlier one is not read again but counted with it.
"""

from __future__ import annotations

import multiprocessing
import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from grammar import g4
from grammar.failures import Failure, FailureFinder, Form
from grammar.recognizer import Recognizer
from recovery.ingest import Found, Skipped, decode, digest, discover, read

__all__ = ["Failed", "Survey", "SurveyedFile", "source_lines", "survey", "survey_texts"]

# One task for a process: enough work to outweigh its passage, little enough to keep memory flat.
_TASK_BYTES = 1 << 20
_TASK_FILES = 64
_LONGEST_LINE_KEPT = 1_000
_WORDS_KEPT = 24


@dataclass(frozen=True, slots=True)
class Failed:
    """One failing line of a file.

    ``line`` and ``column`` from 1; ``token`` is the offending token as written; ``source`` the line
    (cut at 1,000 characters); ``words`` its tokens in upper case, to the offending one and at
    least 24; ``form`` indexes `Survey.forms`.
    """

    line: int
    column: int
    token: str
    source: str
    words: tuple[str, ...]
    form: int
    follows: bool


@dataclass(frozen=True, slots=True)
class SurveyedFile:
    """A distinct content: where it lies, and what failed in it.

    ``places`` are (path, origin) of the file and of every copy of it, in the order of discovery;
    ``found`` is the first of them.
    """

    found: Found
    places: tuple[tuple[str, str], ...]
    digest: str
    size: int
    failures: tuple[Failed, ...]

    @property
    def path(self) -> str:
        return self.found.path

    def lines(self) -> list[str]:
        """The lines of the file, read again; empty where it has changed since the survey."""
        data = read(self.found)
        if isinstance(data, Skipped) or digest(data) != self.digest:
            return []
        source = decode(data)
        return [] if isinstance(source, str) else source_lines(source.text)


@dataclass(frozen=True, slots=True)
class Survey:
    """What reading a corpus under a grammar found. ``seconds`` is wall-clock time."""

    grammar: g4.Grammar
    files: tuple[SurveyedFile, ...]
    skipped: tuple[Skipped, ...]
    forms: tuple[Form, ...]
    seconds: float


def survey(
    roots: Sequence[Path],
    grammar: g4.Grammar,
    *,
    jobs: int | None = None,
    on_found: Callable[[int], object] = lambda count: None,
    on_done: Callable[[int], object] = lambda count: None,
) -> Survey:
    """Read everything below ``roots`` under ``grammar``.

    ``jobs`` is the number of processes, by default one a core. ``on_found`` is told how many
    candidates there are once they are known, ``on_done`` how many more have been dealt with.

    Raises `recovery.ingest.IngestError` where there is nothing to survey.
    """
    began = time.perf_counter()
    candidates = list(discover(roots))
    on_found(len(candidates))
    gathered = _Gathered()
    tasks = _tasks(candidates, gathered)
    jobs = jobs or os.cpu_count() or 1
    for done in _run(tasks, grammar.text, jobs):
        on_done(gathered.add(done))
    on_done(len(candidates) - gathered.dealt_with)
    return gathered.survey(grammar, time.perf_counter() - began)


def survey_texts(programs: Sequence[tuple[str, str]], grammar: g4.Grammar) -> Survey:
    """Read programs given as (path, text) in this process; each is taken for a file of its own."""
    began = time.perf_counter()
    finder = FailureFinder(Recognizer(grammar))
    forms: dict[Form, int] = {}
    files = []
    for path, text in programs:
        failures = finder.find(text)
        lines = source_lines(text) if failures else []
        found = Found(path, "given", len(text), Path(path), None)
        failed = tuple(_failed(f, lines, forms) for f in failures)
        files.append(SurveyedFile(found, ((path, "given"),), path, len(text), failed))
    return Survey(grammar, tuple(files), (), tuple(forms), time.perf_counter() - began)


# ------------------------------------------------------------------------------ in a process


@dataclass(frozen=True, slots=True)
class _Task:
    """Contents to survey."""

    contents: tuple[bytes, ...]


@dataclass(frozen=True, slots=True)
class _Done:
    """Failures of each file of a task, or why it is no KRL; forms are local to the task."""

    results: tuple[tuple[Failed, ...] | str, ...]
    forms: tuple[Form, ...]


@cache
def _finder(grammar_text: str) -> FailureFinder:
    return FailureFinder(Recognizer(g4.read(grammar_text)))


def _perform(grammar_text: str, task: _Task) -> _Done:
    finder = _finder(grammar_text)
    forms: dict[Form, int] = {}
    results: list[tuple[Failed, ...] | str] = []
    for data in task.contents:
        source = decode(data)
        if isinstance(source, str):
            results.append(source)
            continue
        failures = finder.find(source.text)
        lines = source_lines(source.text) if failures else []
        results.append(tuple(_failed(f, lines, forms) for f in failures))
    return _Done(tuple(results), tuple(forms))


def _failed(failure: Failure, lines: list[str], forms: dict[Form, int]) -> Failed:
    lexemes, index = failure.lexemes, failure.form.index
    words = tuple(lexeme.upper()[:40] for lexeme in lexemes[: max(_WORDS_KEPT, index + 1)])
    source = lines[failure.line - 1] if failure.line <= len(lines) else ""
    return Failed(
        line=failure.line,
        column=failure.column,
        token=failure.text[:200],
        source=source[:_LONGEST_LINE_KEPT],
        words=words,
        form=forms.setdefault(failure.form, len(forms)),
        follows=failure.follows,
    )


def source_lines(text: str) -> list[str]:
    """The lines of a program as KRL ends them: CRLF, LF or CR, and nothing else."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _run(tasks: Iterable[_Task], grammar_text: str, jobs: int) -> Iterator[_Done]:
    """Results in the order of the tasks."""
    if jobs == 1:
        for task in tasks:
            yield _perform(grammar_text, task)
        return
    # 'spawn' behaves the same on every system and never copies a process with threads in it
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        waiting: deque[Future[_Done]] = deque()
        for task in tasks:
            waiting.append(pool.submit(_perform, grammar_text, task))
            if len(waiting) > 2 * jobs:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


# ------------------------------------------------------------------------------ in the parent


@dataclass(slots=True)
class _Content:
    found: Found
    places: list[tuple[str, str]]
    size: int
    result: tuple[Failed, ...] | str | None = None


@dataclass(slots=True)
class _Gathered:
    """Results so far, by content."""

    contents: dict[str, _Content] = field(default_factory=dict)
    skipped: list[Skipped] = field(default_factory=list)
    forms: dict[Form, int] = field(default_factory=dict)
    submitted: deque[str] = field(default_factory=deque)
    dealt_with: int = 0

    def add(self, done: _Done) -> int:
        """Take the results of the next task; returns how many files it dealt with."""
        numbers = [self.forms.setdefault(form, len(self.forms)) for form in done.forms]
        for result in done.results:
            content = self.contents[self.submitted.popleft()]
            if isinstance(result, str):
                content.result = result
            else:
                content.result = tuple(replace(f, form=numbers[f.form]) for f in result)
        self.dealt_with += len(done.results)
        return len(done.results)

    def survey(self, grammar: g4.Grammar, seconds: float) -> Survey:
        files: list[SurveyedFile] = []
        skipped = list(self.skipped)
        for key, content in self.contents.items():
            if isinstance(content.result, str):
                skipped += [Skipped(p, content.result, o) for p, o in content.places]
            elif content.result is not None:
                places = tuple(content.places)
                files.append(SurveyedFile(content.found, places, key, content.size, content.result))
        skipped.sort(key=lambda s: s.path)
        return Survey(grammar, tuple(files), tuple(skipped), tuple(self.forms), seconds)


def _tasks(candidates: Iterable[Found | Skipped], gathered: _Gathered) -> Iterator[_Task]:
    """Cut the contents not met before into tasks; note copies and what cannot be read."""
    contents: list[bytes] = []
    size = 0
    for candidate in candidates:
        if isinstance(candidate, Skipped):
            gathered.skipped.append(candidate)
            continue
        data = read(candidate)
        if isinstance(data, Skipped):
            gathered.skipped.append(data)
            continue
        place = (candidate.path, candidate.origin)
        key = digest(data)
        known = gathered.contents.get(key)
        if known is not None:
            known.places.append(place)
            continue
        gathered.contents[key] = _Content(candidate, [place], len(data))
        gathered.submitted.append(key)
        contents.append(data)
        size += len(data)
        if size >= _TASK_BYTES or len(contents) >= _TASK_FILES:
            yield _Task(tuple(contents))
            contents, size = [], 0
    if contents:
        yield _Task(tuple(contents))
