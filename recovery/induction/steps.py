"""Steps of an induction: accepted and refused edits, their evidence, and how files parse."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from grammar.notation.edits import AddAlternative, AddToken, Edit, apply, describe, to_data
from grammar.notation.model import Grammar, GrammarError
from recovery.ledger.construct import Evidence


@dataclass(frozen=True, slots=True)
class InferredStep:
    """Edits, their reason, and the lines from which they were inferred.

    Edits that are ``is_strict`` read so much that they must not accept any program that must be
    rejected. If edits are ``is_known`` the rest of a line is a form that the grammar has, so one
    line shows enough. ``breadth`` is how much more they read than others for the same lines, in
    symbols of a rule.
    """

    title: str
    edits: tuple[Edit, ...]
    lines: tuple[int, ...]
    is_strict: bool = False
    is_block: bool = False
    is_known: bool = False
    breadth: int = 0


@dataclass(frozen=True, slots=True)
class AcceptedStep:
    """A step of the induction: edits, reason and evidence."""

    title: str
    edits: tuple[Edit, ...]
    evidence: Evidence = field(default_factory=Evidence)


@dataclass(frozen=True, slots=True)
class RefusedStep:
    """Edits that were tried and refused, with the reason."""

    title: str
    edits: tuple[Edit, ...]
    gain: float
    reason: str


@dataclass(frozen=True, slots=True)
class Reading:
    """How files read under a grammar: which parse, and which of their lines fail."""

    parsed: int
    files: int
    failing: int


@dataclass(frozen=True, slots=True)
class Round:
    """One round: how the files read before it, and its accepted and refused edits."""

    shown: Reading
    held: Reading
    taken: tuple[AcceptedStep, ...]
    refused: tuple[RefusedStep, ...]


def grown(grammar: Grammar, steps: Iterable[InferredStep | AcceptedStep]) -> Grammar:
    """Return the grammar after the edits of steps; raises `GrammarError` if one does not fit."""
    for step in steps:
        grammar, _ = new_in(grammar, step.edits)
    return grammar


def new_in(grammar: Grammar, edits: Iterable[Edit]) -> tuple[Grammar, list[Edit]]:
    """Return the grammar after edits, and those among them that it needs.

    Tokens and alternatives that are there already, also by an edit before, are not added again.
    Raises `GrammarError` if an edit does not fit.
    """
    new = []
    for edit in edits:
        if not _is_there(grammar, edit):
            grammar = apply(grammar, [edit])
            new.append(edit)
    return grammar, new


def _is_there(grammar: Grammar, edit: Edit) -> bool:
    match edit:
        case AddToken(name=name):
            return name in grammar.by_name
        case AddAlternative(rule=name, text=text) if name in grammar.by_name:
            rule = grammar.by_name[name]
            return text in map(rule.source_of, rule.alternatives)
    return False


def described(grammar: Grammar, edits: Iterable[Edit]) -> tuple[str, ...]:
    """Return a line for each edit, with the text that it changes instead of its address."""

    def line(edit: Edit) -> str:
        try:
            return describe(grammar, edit)
        except (GrammarError, KeyError, IndexError):  # its place is of an edit before it
            return str(to_data(edit))

    return tuple(map(line, edits))
