"""Acceptance: constructs are added to the grammar, all of them or none.

The new constructs follow those accepted before. Each is evaluated at its place. Only if there is no
objection to any of them are the ledger, the grammar and its generated parser written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from grammar.notation.generate import generate
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.ledger.baseline import Corpora
from recovery.ledger.construct import ACCEPTED, Construct, LedgerError
from recovery.ledger.construct_file import text_of
from recovery.ledger.evaluation import Evaluation, evaluate, losses
from recovery.ledger.ledger import UNFINISHED, Ledger, broken_examples, grown, in_force
from recovery.ledger.regeneration import Generator, parser_of
from support.files.atomic_write import write_together
from support.parallel.progress import Progress, no_progress


@dataclass(frozen=True, slots=True)
class GrammarPaths:
    """The files of a grammar: restrictive start, grammar, generated parser, ledger."""

    preliminary: Path
    grammar: Path
    generated: Path
    ledger: Path


class AcceptanceRefused(Exception):
    """There are objections to an acceptance; ``refusals`` are pairs of where and why."""

    def __init__(self, refusals: Sequence[tuple[str, str]]) -> None:
        super().__init__("; ".join(f"{where}: {why}" for where, why in refusals))
        self.refusals = tuple(refusals)


@dataclass(frozen=True, slots=True)
class Acceptance:
    """A prepared acceptance: the new ledger, its grammar, and the evaluations.

    ``constructs`` are those of the whole ledger, in order; the ``file`` of each is its present one.
    ``refusals`` are pairs of where and why, including those of the evaluations; without any, the
    acceptance can be written.
    """

    constructs: tuple[Construct, ...]
    evaluations: tuple[Evaluation, ...]
    grammar: Grammar
    refusals: tuple[tuple[str, str], ...]

    @property
    def other_refusals(self) -> tuple[tuple[str, str], ...]:
        """The refusals from no evaluation: an edit does not fit, or the final grammar fails."""
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
    """Return the evaluation of constructs, in order, as the next to be accepted; writes nothing.

    A construct that was accepted before keeps its place and is evaluated there again. ``current``
    is the grammar in force, if regressions against it matter. ``on_done`` is called after each
    evaluation.

    Raises `LedgerError` if the grammar in force is not the replay of the ledger, unless a construct
    is evaluated again, and `support.files.discovery.IngestError` if a corpus cannot be read.
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
    grammar = preliminary
    measure = lru_cache(maxsize=1)(corpora.measure)  # the next construct begins with the last one
    for place, construct in enumerate(order):
        if not construct.is_accepted and construct.file not in asked:
            continue
        try:
            wider = grown(grammar, construct)
        except LedgerError as error:  # without this grammar, later constructs cannot be tried
            refusals.append((construct.id, str(error)))
            return Acceptance(tuple(order), tuple(evaluations), grammar, tuple(refusals))
        if construct.file in asked:
            found = evaluate(construct, measure(grammar), measure(wider))
            evaluations.append(found)
            refusals += ((construct.id, why) for why in found.refusals)
            order[place] = replace(found.construct, state=ACCEPTED, comment="")
            on_done(1)
        grammar = wider
    if is_again and current:  # a change in the middle must not undo later constructs
        final, now = measure(grammar), corpora.measure(current)
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


def _is_in(construct: Construct, constructs: Sequence[Construct]) -> bool:
    return construct.file in [c.file for c in constructs]


def _ordered(given: Sequence[Construct], ledger: Ledger) -> list[Construct]:
    """Return the ledger with new constructs after all accepted ones, renumbered."""
    new = [c for c in given if not _is_in(c, ledger.accepted)]
    rest = [c for c in ledger.constructs if not _is_in(c, new)]
    last = max((n for n, c in enumerate(rest, 1) if c.is_accepted), default=0)
    order = [*rest[:last], *new, *rest[last:]]
    return [replace(c, number=number) for number, c in enumerate(order, 1)]


# ------------------------------------------------------------------------------------ writing


def write(
    acceptance: Acceptance, home: GrammarPaths, generator: Generator = generate
) -> list[Path]:
    """Write ledger, grammar and parser, all or nothing; return the files that changed.

    Raises `AcceptanceRefused` if there are refusals or ANTLR's parser disagrees about the examples,
    `grammar.notation.generate.GenerationError` if it cannot be generated, and `OSError`.
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
