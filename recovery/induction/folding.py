"""Folding: similar alternatives become one, and unused parts are removed.

Induction writes a form for each word that begins lines. If such words are of one kind, as ``INT``
and ``REAL`` are, one form for all of them is shorter, and it also reads combinations that were not
seen. Each kind of fold is a function that yields folds of a grammar. A fold is only a candidate:
`recovery.induction.rounds` accepts those after which the grammar reads at least as much.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from grammar.notation.model import Grammar, walk
from recovery.induction.folds_of_alternatives import (
    alternatives_of_a_word,
    alternatives_of_two_rules,
    derived_words,
    lists,
    unused_rules,
)
from recovery.induction.folds_of_declarations import (
    brackets,
    heads,
    kinds,
    modifiers,
    tails,
    types,
    undeclared,
    undeclared_elsewhere,
    words_of_a_kind,
)
from recovery.induction.folds_of_operands import (
    any_operands,
    behind_signs,
    heads_of_blocks,
    named_arguments,
    signs,
    trailing,
    variables,
)
from recovery.induction.grammar_view import GrammarView
from recovery.induction.steps import InferredStep

#: The kinds of fold, in the order in which they are tried.
FOLDS: tuple[Callable[[GrammarView], Iterator[InferredStep]], ...] = (
    unused_rules,
    types,
    words_of_a_kind,
    kinds,
    alternatives_of_a_word,
    alternatives_of_two_rules,
    lists,
    trailing,
    tails,
    brackets,
    signs,
    heads,
    modifiers,
    undeclared,
    undeclared_elsewhere,
    behind_signs,
    variables,
    any_operands,
    heads_of_blocks,
    derived_words,
    named_arguments,
)


def folds_of(view: GrammarView) -> Iterator[InferredStep]:
    """Yield what could be folded in a grammar; each fold stands for itself."""
    return (fold for kind in FOLDS for fold in kind(view) if fold.edits)


def size(grammar: Grammar) -> int:
    """Return how many symbols the parser rules of a grammar write."""
    return sum(len([*walk(rule), *rule.alternatives]) for rule in grammar.parser_rules)
