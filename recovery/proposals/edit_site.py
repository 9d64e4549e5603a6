"""Edit sites: a place in the grammar, and the tokens of a failing line to accept there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from grammar.notation.addresses import Address
from grammar.notation.edits import Edit
from grammar.parser.failures import Form
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import Recognizer, State
from recovery.forms.symbols import Token
from recovery.tuning import DEEPEST_STACK, LONGEST_LINE

#: Complete edits with their rank, which estimates how much they accept.
RankedEdits = tuple[int, tuple[Edit, ...]]


@dataclass(frozen=True, slots=True)
class LinePattern:
    """What failing lines of one kind share: their form, and names meant as keywords, by index."""

    form: Form
    keywords: tuple[tuple[int, str], ...]

    @property
    def is_enormous(self) -> bool:
        """Whether the line is too long or too deeply nested to be written by hand."""
        deepest = max(map(len, self.form.before), default=0)
        return len(self.form.kinds) > LONGEST_LINE or deepest > DEEPEST_STACK

    def words(self) -> list[Token]:
        """Return the tokens of the line."""
        meant = dict(self.keywords)
        return [(kind, meant.get(i)) for i, kind in enumerate(self.form.kinds)]


@dataclass(frozen=True, slots=True)
class EditSite:
    """A place in a rule, and the tokens of a line that it would have to accept.

    ``insert`` means before the element at the place; ``lines`` the same, with a line end after them
    and any number of times; ``widen`` instead of that element; ``alternative`` an alternative of
    the rule, whatever the place; ``line`` an alternative with a line end; ``repetition`` that the
    element before the place may come again, behind any of the words. ``rank`` estimates how much an
    edit there accepts besides its text.
    """

    kind: OneOf["insert", "lines", "line", "widen", "alternative", "repetition"]
    rule: str
    place: Address
    words: tuple[Token, ...]
    rank: int


def configurations_of(recognizer: Recognizer, state: State) -> list[Configuration]:
    """Return the configurations of a state, calls and returns followed, in a fixed order.

    The recogniser returns a set of interned objects, whose order changes from run to run.
    """
    found = recognizer.sites(state)
    return sorted(found, key=lambda c: (c[0], c[1].depth, c[1].positions()))


def places_of(recognizer: Recognizer, site: Configuration) -> list[Address]:
    """Return the addresses in the text of its rule at which a configuration is."""
    network = recognizer.network
    rule = network.rule[site[0]]
    return sorted(network.automata[rule].places[site[0] - network.entry[rule]])
