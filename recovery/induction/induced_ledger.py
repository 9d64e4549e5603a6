"""The ledger of an automatic recovery: its constructs in order, and its rounds as data.

On disk it is a folder of constructs like that of the project's grammar (`recovery.ledger.ledger`),
so the same commands read, show and replay it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from random import Random
from typing import Any

from grammar.notation.edits import Edit, apply
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.rebase import rebased
from grammar.notation.wellformed import problem
from recovery.induction.steps import AcceptedStep, RefusedStep, Round, described, new_in
from recovery.ledger.construct import Construct, LedgerError
from recovery.ledger.construct_file import name_from
from recovery.ledger.ledger import in_force

_MOST_REFUSED = 40
_LONGEST_EDIT = 1_000


@dataclass(slots=True)
class InducedLedger:
    """The steps so far: constructs in order, the resulting grammar, and the rounds as data."""

    start: Grammar
    grammar: Grammar
    constructs: list[Construct] = field(default_factory=list)
    rounds: list[dict[str, Any]] = field(default_factory=list)

    def add(self, done: Round) -> list[Construct]:
        """Take in a round; returns its constructs, which say only what is new in the grammar."""
        before = self.grammar
        added = [self._construct(step) for step in done.taken]
        refused = list({(one.title, one.reason): one for one in done.refused}.values())
        self.rounds.append(
            {
                "shown": asdict(done.shown),
                "held": asdict(done.held),
                "rules": len(before.parser_rules),
                "taken": [
                    {
                        "id": construct.id,
                        "title": step.title,
                        "edits": _short(before, construct.edits),
                        "files": step.evidence.files,
                        "origins": step.evidence.origins,
                        "lines": step.evidence.lines,
                        "seen": list(step.evidence.seen),
                    }
                    for step, construct in zip(done.taken, added, strict=True)
                ],
                "refused": [_refused(before, one) for one in refused[:_MOST_REFUSED]],
            }
        )
        return added

    def _construct(self, step: AcceptedStep) -> Construct:
        self.grammar, edits = new_in(self.grammar, step.edits)
        construct = Construct(
            name_from(step.title),
            step.title,
            tuple(edits),
            number=len(self.constructs) + 1,
            summary="Inferred from the lines that fail without it."
            if step.evidence.lines
            else "Says more with less: no line needs it.",
            evidence=step.evidence,
        )
        construct = replace(construct, state=construct.earned_state)
        self.constructs.append(construct)
        return construct


def without(
    start: Grammar, constructs: Sequence[Construct], struck: Iterable[str]
) -> tuple[list[Construct], list[Construct]]:
    """Return the constructs that remain after some are struck out, and those removed with them.

    Constructs that no longer apply are removed, too. The others are numbered again, and their edits
    have the addresses of the same places in the remaining grammar. Raises `LedgerError` if there is
    no construct of such an id.
    """
    wanted = set(struck)
    if unknown := sorted(wanted - {construct.id for construct in constructs}):
        known = f"; the first is {constructs[0].id}" if constructs else ""
        raise LedgerError(f"there is no construct {', '.join(unknown)}{known}")
    left: list[Construct] = []
    gone: list[Construct] = []
    whole = grammar = start
    for construct in constructs:
        kept = None if construct.id in wanted else _rebased(construct, whole, grammar)
        whole = apply(whole, construct.edits)
        if kept is None:
            gone.append(construct)
        else:
            edits, grammar = kept
            left.append(replace(construct, number=len(left) + 1, edits=edits))
    return left, gone


def _rebased(
    construct: Construct, whole: Grammar, grammar: Grammar
) -> tuple[tuple[Edit, ...], Grammar] | None:
    """Return the edits of a construct of ``whole`` for another grammar, and the result of these.

    ``None`` if they do not apply to it.
    """
    edits: list[Edit] = []
    after = grammar
    try:
        for edit in construct.edits:
            edits.append(rebased(edit, whole, after))
            whole, after = apply(whole, [edit]), apply(after, edits[-1:])
    except GrammarError:
        return None
    return None if after is grammar or problem(after) else (tuple(edits), after)


def without_some(
    start: Grammar, constructs: Sequence[Construct], count: int, seed: int
) -> tuple[Grammar, list[Construct]]:
    """Return the grammar without ``count`` constructs drawn by a seed, and all removed constructs.

    Constructs that depend on one of them are removed, too. Raises `ValueError` if there are too
    few.
    """
    ids = sorted(construct.id for construct in constructs)
    left, gone = without(start, constructs, Random(seed).sample(ids, count))
    return in_force(start, left), gone


def _short(grammar: Grammar, edits: Iterable[Edit]) -> list[str]:
    return [text[:_LONGEST_EDIT] for text in described(grammar, edits)]


def _refused(grammar: Grammar, refused: RefusedStep) -> dict[str, Any]:
    return {
        "title": refused.title,
        "edits": _short(grammar, refused.edits),
        "gain": round(refused.gain, 1),
        "reason": refused.reason,
    }
