"""An opening: a place in the grammar, and the tokens of a failing line to be let in there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from grammar.notation.addresses import Address
from grammar.notation.edits import Edit
from grammar.parser.failures import Form
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import Recognizer, State
from recovery.proposals.segmentation import Word
from recovery.tuning import DEEPEST_STACK, LONGEST_LINE

__all__ = ["Line", "Opening", "Ranked", "places_of", "sites_of"]


#: Edits that need no phrase, and how much they let in.
Ranked = tuple[int, tuple[Edit, ...]]


@dataclass(frozen=True, slots=True)
class Line:
    """A failing line: its form, and the names in it that are meant as keywords, by place."""

    form: Form
    keywords: tuple[tuple[int, str], ...]

    @property
    def is_enormous(self) -> bool:
        """Whether it is too long, or too deeply nested, to be worth a search: nobody wrote it."""
        deepest = max(map(len, self.form.before), default=0)
        return len(self.form.kinds) > LONGEST_LINE or deepest > DEEPEST_STACK

    def words(self) -> list[Word]:
        """The tokens of the line."""
        meant = dict(self.keywords)
        return [(kind, meant.get(i)) for i, kind in enumerate(self.form.kinds)]


@dataclass(frozen=True, slots=True)
class Opening:
    """A place, and the words of a line that would have to be let in there.

    ``insert`` before the element at the place, ``lines`` the same with a line end behind them and
    any number of times; ``widen`` instead of that element; ``alternative`` of the rule, whatever
    the place, and ``line`` that with a line end behind it. ``rank`` says how much an edit there
    lets in besides what is written.
    """

    kind: OneOf["insert", "lines", "line", "widen", "alternative"]
    rule: str
    place: Address
    words: tuple[Word, ...]
    rank: int


def sites_of(recognizer: Recognizer, state: State) -> list[Configuration]:
    """Where the recogniser stands in a state, calls and returns followed."""
    return sorted(recognizer.sites(state), key=lambda c: (c[0], c[1].depth))


def places_of(recognizer: Recognizer, site: Configuration) -> list[Address]:
    """The places in the text of its rule at which it stands there."""
    network = recognizer.network
    rule = network.rule[site[0]]
    return sorted(network.automata[rule].places[site[0] - network.entry[rule]])
