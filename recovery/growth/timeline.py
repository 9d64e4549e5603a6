"""A corpus read under a sequence of grammars: which lines of which file fail under which.

The sequence is that of a growing grammar, so most of a corpus stays as it was from one grammar to
the next. A file that parses is not read again while the grammar only adds
(`recovery.growth.inclusion`). All others are read, so nothing is estimated. Files are divided into
blocks and grammars into runs, and each task reads one block under one run. So the cost grows with
the corpus, and the memory does not.
"""

from __future__ import annotations

import math
import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.growth.inclusion import fixed_texts_added, occurs
from recovery.survey.result_cache import key_of
from recovery.survey.surveyed_files import SurveyedFile
from support.files.decode import Decoded, decode, digest
from support.files.discovery import FoundFile, Skipped, discover, read
from support.files.result_store import ResultStore
from support.parallel.ordered_map import ordered_map
from support.parallel.progress import Progress, no_progress

_BLOCK_BYTES = 8 << 20
_RUNS = 16  # least number of runs for a block, so that progress is visible
_RUNS_A_PROCESS = 4  # runs for each process, so that all processes end at about the same time
_SMALL = 32 << 20  # bytes times grammars; for less work one process is faster


@dataclass(frozen=True, slots=True)
class Timeline:
    """Under which grammars the lines of a content fail.

    ``failing`` maps each line that ever fails to a number whose bit ``n`` is set if it fails under
    grammar ``n``. ``reason`` says why the content is no KRL, and is empty if it is.
    """

    content: SurveyedFile
    failing: Mapping[int, int]
    reason: str = ""

    @property
    def whenever(self) -> int:
        """The bits of the grammars under which the content does not parse."""
        bits = 0
        for when in self.failing.values():
            bits |= when
        return bits

    def parses(self, number: int) -> bool:
        """Return whether it parses under the grammar with this number."""
        return not self.whenever >> number & 1


def contents_of(roots: Sequence[Path]) -> tuple[list[SurveyedFile], list[Skipped]]:
    """Return the distinct contents below ``roots``, in the order of discovery, and those skipped.

    Raises `support.files.discovery.IngestError` if there is nothing to read.
    """
    met: dict[str, tuple[FoundFile, list[tuple[str, str]], int]] = {}
    skipped = []
    for candidate in discover(roots):
        data = candidate if isinstance(candidate, Skipped) else read(candidate)
        if isinstance(candidate, Skipped) or isinstance(data, Skipped):
            skipped.append(data)
            continue
        entry = met.setdefault(digest(data), (candidate, [], len(data)))
        entry[1].append((candidate.path, candidate.origin))
    contents = [SurveyedFile(f, tuple(places), key, size) for key, (f, places, size) in met.items()]
    return contents, [entry for entry in skipped if isinstance(entry, Skipped)]


def read_through(
    contents: Sequence[SurveyedFile],
    grammars: Sequence[Grammar],
    *,
    jobs: int | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> list[Timeline]:
    """Return the timeline of each content under the grammars, in the given order.

    ``jobs`` is the number of processes; the default is one for each core, or one for little work.
    ``cache`` is the folder for cached results. ``on_found`` is called with the number of readings
    (a content under a grammar is one), ``on_done`` with the number finished since its last call. A
    content that has changed since it was found is reported as no KRL, with that reason.
    """
    if not grammars:
        raise ValueError("there is no grammar to read under")
    names = [grammar.sha256 for grammar in grammars]
    # the cache key has the first grammar of the sequence, which rarely changes
    with ResultStore(cache, key_of(grammars[0])) as store:
        known = [_recalled(store, content, names) for content in contents]
        blocks = list(_blocks(contents, known))
        on_found(sum(len(block.members) * len(block.missing) for block in blocks))
        jobs = jobs or _processes(blocks)
        runs = [(block, run) for block in blocks for run in block.runs(jobs)]
        tasks = (
            (tuple((n, grammars[n]) for n in run), tuple(m.content for m in block.members))
            for block, run in runs
        )
        read = ordered_map(_read_under, tasks, jobs=jobs)
        for (block, run), results in zip(runs, read, strict=True):
            for member, result in zip(block.members, results, strict=True):
                known[member.index].add(result, run)
            store.put(  # after each run, so that a killed growth continues from there
                (_key(member.content), known[member.index].record(names))
                for member in block.members
                if known[member.index].lasting
            )
            on_done(len(block.members) * len(run))
    return [
        Timeline(content, dict(sorted(entry.failing.items())), entry.reason)
        for content, entry in zip(contents, known, strict=True)
    ]


def _processes(blocks: Iterable[_Block]) -> int:
    work = sum(m.content.size * len(block.missing) for block in blocks for m in block.members)
    return 1 if work < _SMALL else os.cpu_count() or 1


# ------------------------------------------------------------------------------ what is known


@dataclass(slots=True)
class _Known:
    """What is known about a content; ``missing`` are the grammars not read yet.

    If it is not ``lasting``, the result does not depend on the content alone and is not cached.
    """

    failing: dict[int, int]
    reason: str
    missing: tuple[int, ...]
    lasting: bool = True

    def add(self, result: _Result, run: tuple[int, ...]) -> None:
        if not isinstance(result, dict):
            self.lasting = isinstance(result, str)
            self.reason = result if isinstance(result, str) else result.reason
            return
        for line, when in result.items():
            self.failing[line] = self.failing.get(line, 0) | when
        self.missing = tuple(n for n in self.missing if n not in run)

    def record(self, names: Sequence[str]) -> dict[str, Any]:
        if self.reason:
            return {"reason": self.reason}
        missing = frozenset(self.missing)
        read = [n for n in range(len(names)) if n not in missing]
        failing = [
            [line, hex(sum((when >> n & 1) << bit for bit, n in enumerate(read)))]
            for line, when in self.failing.items()
        ]
        return {"grammars": [names[n] for n in read], "failing": failing}


def _key(content: SurveyedFile) -> str:
    return f"timeline {content.digest}"


def _recalled(store: ResultStore, content: SurveyedFile, names: Sequence[str]) -> _Known:
    """Return the cached result for these grammars; others in the cache are ignored."""
    kept = store.get_record(_key(content))
    if kept is None:
        return _Known({}, "", tuple(range(len(names))))
    try:
        if kept.get("reason"):
            return _Known({}, str(kept["reason"]), ())
        place = {str(name): bit for bit, name in enumerate(kept["grammars"])}
        bits = [(n, place[name]) for n, name in enumerate(names) if name in place]
        failing = {}
        for line, written in kept["failing"]:
            when = int(written, 16)
            moved = sum((when >> bit & 1) << n for n, bit in bits)
            if moved:
                failing[int(line)] = moved
        return _Known(failing, "", tuple(n for n, name in enumerate(names) if name not in place))
    except (KeyError, TypeError, ValueError):  # damaged: compute it again
        return _Known({}, "", tuple(range(len(names))))


# -------------------------------------------------------------------------------- the work


@dataclass(frozen=True, slots=True)
class _Member:
    index: int
    content: SurveyedFile


@dataclass(frozen=True, slots=True)
class _Block:
    """Contents that are read together under the grammars ``missing``."""

    members: tuple[_Member, ...]
    missing: tuple[int, ...]

    def runs(self, jobs: int) -> Iterator[tuple[int, ...]]:
        """Yield the grammars in slices."""
        length = math.ceil(len(self.missing) / max(_RUNS, jobs * _RUNS_A_PROCESS))
        for first in range(0, len(self.missing), length):
            yield self.missing[first : first + length]


def _blocks(contents: Sequence[SurveyedFile], known: Sequence[_Known]) -> Iterator[_Block]:
    """Yield blocks of contents to read; all contents of a block miss the same grammars."""
    waiting: dict[tuple[int, ...], list[_Member]] = defaultdict(list)
    sizes: dict[tuple[int, ...], int] = defaultdict(int)
    for index, (content, entry) in enumerate(zip(contents, known, strict=True)):
        if entry.missing:
            waiting[entry.missing].append(_Member(index, content))
            sizes[entry.missing] += content.size
            if sizes[entry.missing] >= _BLOCK_BYTES:
                yield _Block(tuple(waiting.pop(entry.missing)), entry.missing)
                del sizes[entry.missing]
    for missing, members in waiting.items():
        yield _Block(tuple(members), missing)


#: Failing lines of a content with the bits of the grammars; or why it is no KRL; or was not read.
_Result = dict[int, int] | str | Skipped


def _read_under(
    run: tuple[tuple[int, Grammar], ...], contents: tuple[SurveyedFile, ...]
) -> list[_Result]:
    """Return the results of contents under a run of grammars."""
    texts = [_text(content) for content in contents]
    results: list[_Result] = [{} if isinstance(text, Decoded) else text for text in texts]
    programs = {place: text.text for place, text in enumerate(texts) if isinstance(text, Decoded)}
    folded = {place: text.upper() for place, text in programs.items()}
    parsed: set[int] = set()
    before: Recognizer | None = None
    for number, grammar in run:
        recognizer = Recognizer(grammar)
        finder = FailureFinder(recognizer)
        added = None if before is None else fixed_texts_added(before, recognizer)
        for place, text in programs.items():
            if place in parsed and added is not None and not occurs(added, folded[place]):
                continue
            found = {failure.line for failure in finder.find(text)}
            parsed.discard(place)
            if not found:
                parsed.add(place)
            failing = results[place]
            assert isinstance(failing, dict)
            for line in found:
                failing[line] = failing.get(line, 0) | 1 << number
        before = recognizer
    return results


def _text(content: SurveyedFile) -> Decoded | str | Skipped:
    """Return the text of a content, or why it is no KRL, or why it cannot be read any more."""
    data = read(content.found)
    if isinstance(data, Skipped):
        return data
    if digest(data) != content.digest:
        return Skipped(content.path, "changed while it was read", content.places[0][1])
    return decode(data)
