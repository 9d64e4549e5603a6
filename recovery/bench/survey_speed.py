"""Speed of the survey: cold and warm, and beside ANTLR.

Every figure comes from a process of its own, so that nothing remembered from one measurement helps
the next. Importing modules is not counted; reading the grammar, building the recogniser and, where
a survey is timed, finding, reading and decoding the files are. MB are 1,000,000 bytes.
"""

from __future__ import annotations

import gc
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from grammar.notation import g4
from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.survey.survey import Survey, survey
from support.files.decode import Decoded, decode
from support.files.discovery import FoundFile, IngestError, discover, read, source_files
from support.measure.isolated import call_isolated
from support.measure.speed import MB, ROUNDS, Clock, machine, shares

#: What ANTLR's Python runtime reads in a second on a slow machine. The bytes it is given are fixed
#: with it beforehand, so that they are the same in every run and on every machine.
ANTLR_BYTES_PER_S = 60_000


def measure(
    roots: Sequence[Path],
    grammar: Grammar,
    *,
    rounds: int = ROUNDS,
    antlr_seconds: float = 60,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Measure on everything below ``roots``, each content once.

    ``grammar`` has to be the one that the ANTLR parser was generated from. ``antlr_seconds`` is
    about how long ANTLR may read. ``on_step`` is called `steps` times.

    In the record, ``bytes_per_s`` and ``warm_bytes_per_s`` are for a first and a second survey, all
    failures found, ``recognise_bytes_per_s`` for a yes or no to each file, the best of ``rounds``
    each; ``unchanged_s_per_mb`` is for a survey in a new process that finds its results kept from
    the one before. ``ratio_vs_antlr_python`` is how many times as long ANTLR takes for the same
    valid texts; ``None`` where not measured.

    Raises `support.files.discovery.IngestError` where there is nothing to measure on.
    """
    for _ in discover(roots):  # what cannot be surveyed is said before a process is started
        pass
    surveyed, phased = [], []
    for _ in range(rounds):
        surveyed.append(call_isolated(_surveyed, roots, grammar.text))
        if not surveyed[0].bytes:
            raise IngestError("none of the files is KRL")
        on_step()
        phased.append(call_isolated(_phased, roots, grammar.text))
        on_step()
    of = surveyed[0]
    cold = min(s.cold for s in surveyed)
    warm = min(s.warm for s in surveyed)
    phases = min(phased, key=lambda phases: sum(phases.values()))
    phases["recording"] = max(cold - sum(phases.values()), 0.0)
    recognising = sum(phases[name] for name in ("decoding", "building", "lexing", "recognising"))
    beside = call_isolated(_beside_antlr, roots, grammar.text, antlr_seconds)
    on_step()
    unchanged = _unchanged(roots, grammar, rounds)
    on_step()
    return {
        "grammar_sha256": grammar.sha256,
        "files": of.files,
        "parsed": of.parsed,
        "bytes": of.bytes,
        "failures": of.failures,
        "rounds": rounds,
        **machine(),
        "seconds": cold,
        "bytes_per_s": of.bytes / cold,
        "warm_bytes_per_s": of.bytes / warm,
        "recognise_bytes_per_s": of.bytes / recognising,
        "phases": shares(phases),
        "ratio_vs_antlr_python": beside["valid"]["ratio"],
        "antlr": beside,
        "unchanged_s_per_mb": unchanged * MB / of.bytes,
    }


def steps(rounds: int = ROUNDS) -> int:
    """Return how often `measure` calls ``on_step``."""
    return 2 * rounds + 2


def _texts(roots: Sequence[Path]) -> list[str]:
    """Return the texts of the files below the roots, without duplicates."""
    return list({file.data: file.text for file in source_files(roots)}.values())


# -------------------------------------------------------------------------------- the survey


@dataclass(frozen=True, slots=True)
class _Surveyed:
    """Seconds of a first and a second survey in one process; what the first of them found."""

    cold: float
    warm: float
    files: int
    parsed: int
    bytes: int
    failures: int


def _surveyed(roots: Sequence[Path], grammar_text: str) -> _Surveyed:
    grammar = g4.read(grammar_text)
    cold, found = _timed_survey(roots, grammar)
    files, failures = len(found.files), sum(len(f.failures) for f in found.files)
    parsed = sum(not f.failures for f in found.files)
    size = sum(f.size for f in found.files)
    del found  # else the second survey would run beside the results of the first
    warm, _ = _timed_survey(roots, grammar)
    return _Surveyed(cold, warm, files, parsed, size, failures)


def _timed_survey(
    roots: Sequence[Path], grammar: Grammar, cache: Path | None = None
) -> tuple[float, Survey]:
    gc.collect()
    began = time.perf_counter()
    found = survey(roots, grammar, jobs=1, cache=cache)
    return time.perf_counter() - began, found


def _unchanged(roots: Sequence[Path], grammar: Grammar, rounds: int) -> float:
    """Seconds for a survey whose results are all kept."""
    with tempfile.TemporaryDirectory() as folder:
        _, *again = (
            call_isolated(_kept, roots, grammar.text, Path(folder)) for _ in range(rounds + 1)
        )
    return min(again)


def _kept(roots: Sequence[Path], grammar_text: str, cache: Path) -> float:
    return _timed_survey(roots, g4.read(grammar_text), cache)[0]


def _phased(roots: Sequence[Path], grammar_text: str) -> dict[str, float]:
    """Seconds of each phase, each done for all files before the next.

    ``failures`` is what finding all of them costs beyond lexing and recognising once. The rest of
    what a survey takes, ``recording``, is keeping what was found.
    """
    clock = Clock()
    gc.collect()
    with clock.during("reading"):
        read_now = (read(found) for found in discover(roots) if isinstance(found, FoundFile))
        contents = dict.fromkeys(data for data in read_now if isinstance(data, bytes))
    with clock.during("decoding"):
        texts = [one.text for one in map(decode, contents) if isinstance(one, Decoded)]
    with clock.during("building"):
        recognizer = Recognizer(g4.read(grammar_text))
        finder = FailureFinder(recognizer)
    with clock.during("lexing"):
        kinds = [recognizer.kinds(text) for text in texts]
    with clock.during("recognising"):
        for tokens in kinds:
            recognizer.run(recognizer.start, tokens)
    with clock.during("again"):
        for text in texts:
            recognizer.accepts(text)
    with clock.during("failures"):
        for text in texts:
            finder.find(text)
    again = clock.seconds.pop("again")
    return {**clock.seconds, "failures": max(clock.seconds["failures"] - again, 0.0)}


# ------------------------------------------------------------------------------ beside ANTLR


@dataclass(slots=True)
class _Side:
    """Both readers on the same texts, file by file in turn, so that a busy machine slows both."""

    files: int = 0
    bytes: int = 0
    tokens: int = 0
    antlr_seconds: float = 0.0
    our_seconds: float = 0.0

    def compare(
        self, text: str, antlr: Callable[[str], object], ours: Callable[[str], object]
    ) -> None:
        began = time.perf_counter()
        antlr(text)
        between = time.perf_counter()
        ours(text)
        ended = time.perf_counter()
        self.files += 1
        self.bytes += len(text.encode())
        self.antlr_seconds += between - began
        self.our_seconds += ended - between

    def record(self) -> dict[str, Any]:
        known = bool(self.files)
        return {
            **asdict(self),
            "antlr_bytes_per_s": self.bytes / self.antlr_seconds if known else None,
            "our_bytes_per_s": self.bytes / self.our_seconds if known else None,
            "ratio": self.antlr_seconds / self.our_seconds if known else None,
        }


def _beside_antlr(roots: Sequence[Path], grammar_text: str, seconds: float) -> dict[str, Any]:
    """Both readers on valid texts, accept or reject, and on failing ones, all errors reported.

    The tables of both readers are built before the clock runs; what they learn while reading is
    not.
    """
    from grammar.parser import antlr_reference

    grammar = g4.read(grammar_text)
    recognizer = Recognizer(grammar)
    finder = FailureFinder(Recognizer(grammar))
    recovering = _recovering_antlr()
    antlr_reference.accepts("")
    budget = seconds * ANTLR_BYTES_PER_S
    texts = _spread(_texts(roots))
    valid, failing = _Side(), _Side()
    checker = Recognizer(grammar)  # a third one: what is compared has to be cold
    for text in texts:
        if checker.accepts(text):
            if valid.bytes + len(text) <= budget * 2 / 3:
                valid.compare(text, antlr_reference.accepts, recognizer.accepts)
                valid.tokens += len(recognizer.kinds(text))
        elif failing.bytes + len(text) <= budget / 3:
            failing.compare(text, recovering, finder.find)
            failing.tokens += len(recognizer.kinds(text))
    return {"valid": valid.record(), "failing": failing.record()}


def _spread(texts: Sequence[str]) -> list[str]:
    """Return the texts in an order in which every prefix has small and large files alike."""
    ordered = sorted(texts, key=lambda text: (len(text), text))
    bits = len(ordered).bit_length()
    # the bits of the places read backwards: halves first, then quarters, then eighths
    places = sorted(range(len(ordered)), key=lambda place: int(f"{place:0{bits}b}"[::-1], 2))
    return [ordered[place] for place in places]


def _recovering_antlr() -> Callable[[str], object]:
    """ANTLR as it comes: it mends errors by its default strategy and reads to the end."""
    from antlr4 import CommonTokenStream, InputStream

    from grammar._generated.KRLLexer import KRLLexer
    from grammar._generated.KRLParser import KRLParser

    def read_on(text: str) -> None:
        lexer = KRLLexer(InputStream(text))
        lexer.removeErrorListeners()
        parser = KRLParser(CommonTokenStream(lexer))
        parser.removeErrorListeners()
        parser.buildParseTrees = False
        parser.module()

    read_on("")
    return read_on
