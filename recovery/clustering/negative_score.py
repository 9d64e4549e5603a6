"""How many programs that must stay rejected an edit would accept.

What an edit accepts besides has to use the text that the edit writes, and so has every token that
this text never goes without. Of thousands of programs only a few have to be read for that reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Element, Grammar, Group, Literal, Reference, Repeat
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import NegativeCounter
from recovery.clustering.edit_trial import edited
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.tuning import GENERATED_NEGATIVES, NEGATIVES_SEED


def negative_counter(grammar: Grammar, negatives: Iterable[Negative]) -> NegativeCounter:
    """Counts what edits of ``grammar`` accept; negatives that it accepts already do not count.

    Counted are ``negatives`` and a fixed sample of generated ones (`recovery.negatives.generate`).
    """
    recognizer = Recognizer(grammar)
    rejected = NegativeSet((*negatives, *_generated())).rejected_by(recognizer)
    known: dict[tuple[Edit, ...], int] = {}

    def count_negatives(edits: Sequence[Edit]) -> int:
        key = tuple(edits)
        if key not in known:
            wider = edited(recognizer, edits)
            known[key] = (
                0 if wider is None else len(rejected.accepted(wider, required_tokens(edits, wider)))
            )
        return known[key]

    return count_negatives


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))


# ------------------------------------------------------------------------------ required tokens


def required_tokens(edits: Sequence[Edit], wider: Recognizer) -> list[frozenset[int]]:
    """For each place the edits change, the kinds of the tokens in all that it newly accepts.

    ``wider`` is a recogniser of the edited grammar.
    """
    tokens = _Tokens(wider.grammar, wider.lexer.kind_of)
    changes = [edit for edit in edits if not isinstance(edit, AddToken)]
    return list(dict.fromkeys(_of_edit(edit, tokens) for edit in changes))


def _of_edit(edit: Edit, tokens: _Tokens) -> frozenset[int]:
    if not isinstance(edit, Insert | Widen | AddAlternative):
        return frozenset()  # to leave something out needs no token
    return tokens.of_text(edit.text)


class _Tokens:
    """Tokens that every sentence of something has."""

    def __init__(self, grammar: Grammar, kind_of: Mapping[str, int]) -> None:
        self._grammar = grammar
        self._kind_of = kind_of
        self._of_rule: dict[str, frozenset[int]] = {}

    def of_text(self, text: str) -> frozenset[int]:
        """Tokens of all that a text reads; where it may be left out, of all but nothing."""
        alternatives = read_rule(f"text : {text} ;").alternatives
        while (inner := _only(alternatives)) is not None:
            alternatives = inner
        return self._of_choice(alternatives)

    def _of_choice(self, alternatives: Iterable[Alternative]) -> frozenset[int]:
        found = (frozenset().union(*map(self._of, a.elements)) for a in alternatives)
        return frozenset.intersection(*found)

    def _of(self, element: Element) -> frozenset[int]:
        match element:
            case Repeat(item=item, operator=operator):
                return self._of(item) if operator == "+" else frozenset()
            case Group(alternatives=alternatives):
                return self._of_choice(alternatives)
            case Reference(name=name, is_token=False):
                if name not in self._of_rule:
                    self._of_rule[name] = frozenset()  # no more is known of what it calls itself
                    self._of_rule[name] = self._of_choice(self._grammar.by_name[name].alternatives)
                return self._of_rule[name]
            case Reference() | Literal():
                return frozenset([self._kind_of[self._grammar.token_of(element)]])
            case _:
                return frozenset()


def _only(alternatives: Sequence[Alternative]) -> tuple[Alternative, ...] | None:
    """What a text consists of that is one thing in brackets, or one thing repeated or optional."""
    if len(alternatives) != 1 or len(alternatives[0].elements) != 1:
        return None
    match alternatives[0].elements[0]:
        case Group(alternatives=inner):
            return inner
        case Repeat(item=item):
            return (Alternative((item,), None, item.span),)
        case _:
            return None
