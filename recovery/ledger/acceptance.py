"""Acceptance: constructs taken into the grammar, all of them or none.

The constructs are put behind those accepted before, each is evaluated at its place, and only when
nothing speaks against any of them are the ledger, the grammar and its generated parser written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from grammar.notation.generate import generate
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.ledger.baseline import Corpora, GrammarMeasurement
from recovery.ledger.construct import ACCEPTED, Construct, LedgerError
from recovery.ledger.construct_file import text_of
from recovery.ledger.evaluation import Evaluation, evaluate, losses
from recovery.ledger.ledger import UNFINISHED, Ledger, broken_examples, grown, in_force
from recovery.ledger.regeneration import Generator, parser_of
from support.files.atomic_write import write_together
from support.parallel.progress import Progress, no_progress


@dataclass(frozen=True, slots=True)
class GrammarPaths:
    """The files of a grammar: the restrictive start, the grammar, its parser, its ledger."""

    preliminary: Path
    grammar: Path
    generated: Path
    ledger: Path


class AcceptanceRefused(Exception):
    """Something speaks against an acceptance; ``refusals`` are pairs of where and why."""

    def __init__(self, refusals: Sequence[tuple[str, str]]) -> None:
        super().__init__("; ".join(f"{where}: {why}" for where, why in refusals))
        self.refusals = tuple(refusals)


@dataclass(frozen=True, slots=True)
class Acceptance:
    """The ledger as it would be, the grammar it gives, and the evaluations of the constructs given.

    ``constructs`` are those of the whole ledger, in order; ``file`` of each says where it lay so
    far. ``refusals`` are pairs of where and why, those of the evaluations included; without any the
    acceptance can be written.
    """

    constructs: tuple[Construct, ...]
    evaluations: tuple[Evaluation, ...]
    grammar: Grammar
    refusals: tuple[tuple[str, str], ...]

    @property
    def other_refusals(self) -> tuple[tuple[str, str], ...]:
        """Those that are of no evaluation: an edit does not fit, or the whole does not hold."""
        known = {(e.construct.id, why) for e in self.evaluations for why in e.refusals}
        return tuple(refusal for refusal in self.refusals if refusal not in known)


def prepare(
    given: Sequence[Construct],
    preliminary: Grammar,
    ledger: Ledger,
    corpora: Corpora,
    current: Grammar | None = None,
    on_done: Progress = no_progress,
) -> Acceptance:
    """Evaluate constructs, in order, as the next to be accepted; nothing is written.

    What was accepted before keeps its place and is evaluated there again. ``current`` is the
    grammar in force, where it matters what becomes of it. ``on_done`` gets each construct
    evaluated.

    Raises `LedgerError` where the grammar in force is not that of the ledger, unless a construct is
    evaluated again, and `support.files.discovery.IngestError` where a corpus cannot be read.
    """
    is_again = any(_is_in(construct, ledger.accepted) for construct in given)
    if current and not is_again and in_force(preliminary, ledger.accepted).text != current.text:
        raise LedgerError(
            "the grammar in force is not the replay of the ledger (krl construct replay --check "
            "says where); rebuild it first: krl construct replay --out grammar/KRL.g4"
        )
    order = _ordered(given, ledger)
    asked = {c.file for c in given}
    refusals: list[tuple[str, str]] = []
    evaluations: list[Evaluation] = []
    grammar, known = preliminary, _LastMeasurement(corpora)
    for place, construct in enumerate(order):
        if not construct.is_accepted and construct.file not in asked:
            continue
        try:
            wider = grown(grammar, construct)
        except LedgerError as error:  # there is no grammar for what comes after it
            refusals.append((construct.id, str(error)))
            return Acceptance(tuple(order), tuple(evaluations), grammar, tuple(refusals))
        if construct.file in asked:
            found = evaluate(construct, known.measure(grammar), known.measure(wider))
            evaluations.append(found)
            refusals += ((construct.id, why) for why in found.refusals)
            order[place] = replace(found.construct, state=ACCEPTED, comment="")
            on_done(1)
        grammar = wider
    if is_again and current:  # what was changed in the middle must not undo what came after it
        final, now = known.measure(grammar), corpora.measure(current)
        refusals += (("in the end", why) for why in losses(now, final))
    recognizer = Recognizer(grammar)
    refusals += (
        (construct.id, f"in the end {why}")
        for construct in order
        if construct.is_accepted
        for why in broken_examples(construct, recognizer)
        if (construct.id, why) not in refusals
    )
    return Acceptance(tuple(order), tuple(evaluations), grammar, tuple(refusals))


class _LastMeasurement:
    """The measurement of the last grammar: the next construct begins with it."""

    def __init__(self, corpora: Corpora) -> None:
        self._corpora = corpora
        self._last: GrammarMeasurement | None = None

    def measure(self, grammar: Grammar) -> GrammarMeasurement:
        if self._last is None or self._last.grammar.text != grammar.text:
            self._last = self._corpora.measure(grammar)
        return self._last


def _is_in(construct: Construct, constructs: Sequence[Construct]) -> bool:
    return construct.file in [c.file for c in constructs]


def _ordered(given: Sequence[Construct], ledger: Ledger) -> list[Construct]:
    """The ledger with what is given behind all that is accepted, numbered anew."""
    new = [c for c in given if not _is_in(c, ledger.accepted)]
    rest = [c for c in ledger.constructs if not _is_in(c, new)]
    last = max((n for n, c in enumerate(rest, 1) if c.is_accepted), default=0)
    order = [*rest[:last], *new, *rest[last:]]
    return [replace(c, number=number) for number, c in enumerate(order, 1)]


# ------------------------------------------------------------------------------------ writing


def write(
    acceptance: Acceptance, home: GrammarPaths, generator: Generator = generate
) -> list[Path]:
    """Write ledger, grammar and parser, all or nothing; returns the files that have changed.

    Raises `AcceptanceRefused` where something speaks against it or ANTLR's parser does not treat
    the examples as they ask for, `grammar.notation.generate.GenerationError` where there is none,
    and `OSError`.
    """
    if acceptance.refusals:
        raise AcceptanceRefused(acceptance.refusals)
    accepted = [c for c in acceptance.constructs if c.is_accepted]
    parser, disagreements = parser_of(acceptance.grammar, home.generated, accepted, generator)
    if disagreements:
        raise AcceptanceRefused(disagreements)
    asked = {e.construct.file for e in acceptance.evaluations}
    changes: dict[Path, bytes | None] = {c.file: None for c in acceptance.constructs if c.file}
    for construct in acceptance.constructs:
        assert construct.file is not None
        is_new = construct.file in asked
        content = text_of(construct).encode() if is_new else construct.file.read_bytes()
        changes[home.ledger / f"{construct.id}.toml"] = content
    changes[home.grammar] = acceptance.grammar.text.encode()
    changes |= {home.generated / name: content for name, content in parser.items()}
    return write_together(changes, journal=home.ledger / UNFINISHED)
