"""Edits as detours in one shared network.

An edit that only adds something lets a rule be left at one place, another text be read, and the
rule be continued at a later place. These texts, and the remainders of the rules, become additional
positions of one network, to which nothing in the grammar itself leads.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

from grammar.notation.addresses import Address, element_at, sequence_at
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, MakeOptional, Widen
from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Grammar, GrammarError, Repeat, Rule
from grammar.parser.lazy_automaton import Core
from grammar.parser.network import Network
from grammar.parser.recognizer import Recognizer
from grammar.parser.rule_automaton import RuleAutomaton, exact_automata
from recovery.forms.parts import parts
from recovery.tuning import MOST_CONFIGURATIONS_TRIED

#: The first position of a detour, and the position to return to after it, if it reads a text.
_Detour = tuple[int, int | None]


@dataclass(frozen=True, slots=True)
class Detours:
    """Edits as detours: those that begin at each position, and the words the edits reserve.

    ``after`` caches the core to which they lead from a core, and ``starts`` the same for a token
    kind that has to follow.
    """

    at: dict[int, list[_Detour]]
    words: frozenset[str]
    after: dict[Core, Core | None] = field(default_factory=dict, compare=False)
    starts: dict[tuple[Core, int], Core | None] = field(default_factory=dict, compare=False)


@dataclass(frozen=True, slots=True)
class _Way:
    """The detour of one edit; it begins at ``place`` in its rule, or at its start if ``None``.

    ``rest`` are the positions of the remainder of the rule after the detour. At the position
    ``never`` among them the detour must not begin again.
    """

    rule: str
    place: Address | None
    detour: _Detour
    rest: range = range(0)
    never: int = -1


_ADDING = AddToken | AddAlternative | Insert | Widen | MakeOptional
_NOTHING = RuleAutomaton(({},), frozenset([0]), (frozenset(),))


class DetourNetwork:
    """The network of a grammar with the positions of the detours that were asked for."""

    def __init__(self, grammar: Grammar, network: Network, kind: Callable[[str], int]) -> None:
        """``kind`` numbers the words that no rule has."""
        self._grammar = grammar
        self._lexer = network.lexer
        self._shifts: list[Mapping[int, int]] = []
        self._calls: list[Sequence[tuple[int, int]]] = []
        self._final: list[bool] = []
        self._rule: list[str] = []
        self._entry: dict[str, int] = {}
        self._places: list[frozenset[Address]] = []
        self._kind = kind
        self._exact = cache(lambda name: exact_automata(grammar, grammar.by_name[name]))
        self._texts: dict[str, tuple[int, bool, bool, frozenset[str]]] = {}
        self._rests: dict[tuple[str, Address, bool], range] = {}
        self._ends: dict[str, int] = {}
        automata = {name: self._exact(name)(()) for name in network.entry}
        size = 0
        for name, automaton in automata.items():
            self._entry[name] = size
            size += len(automaton.edges)
        self._whole = {name: self._added(name, automaton) for name, automaton in automata.items()}
        entry = self._entry
        self.recognizer = Recognizer(
            grammar,
            Network(
                network.lexer,
                automata,
                self._shifts,
                self._calls,
                self._final,
                self._rule,
                entry,
                entry[grammar.start],
            ),
        )
        self.recognizer.most_ways = MOST_CONFIGURATIONS_TRIED

    # ------------------------------------------------------------------------------- edits

    def detours(self, edits: Sequence[Edit]) -> Detours | None:
        """Return the edits as detours, or ``None`` if they cannot be expressed as such.

        Raises `GrammarError` if they do not fit the grammar.
        """
        inserted = [(edit.rule, edit.at) for edit in edits if isinstance(edit, Insert)]
        if not all(isinstance(e, _ADDING) for e in edits) or len({*inserted}) < len(inserted):
            return None  # two texts inserted at one place: each of them is optional
        words = frozenset(edit.name for edit in edits if isinstance(edit, AddToken))
        if not self._grammar.by_name.keys().isdisjoint(words):
            raise GrammarError("a token exists already")
        found = [self._detour(edit, words) for edit in edits if not isinstance(edit, AddToken)]
        ways = [way for way in found if way is not None]
        if len(ways) < len(found):
            return None
        at: dict[int, list[_Detour]] = {}
        for way in ways:
            for position in {
                *self._whole[way.rule],
                *(p for other in ways if other.rule == way.rule for p in other.rest),
            }:
                if way.place is None:
                    begins = position == self._entry[way.rule]
                else:
                    begins = position != way.never and way.place in self._places[position]
                if begins:
                    at.setdefault(position, []).append(way.detour)
        for target in {target for some in at.values() for target, _ in some}:
            if any(p in at and back for p, back in self.recognizer.network.reach(target).sites):
                return None  # a rule may begin with itself
        return Detours(at, words)

    def _detour(self, edit: Edit, words: frozenset[str]) -> _Way | None:
        """Return the detour of an edit, or ``None`` if the edit does more than add one."""
        assert isinstance(edit, AddAlternative | Insert | Widen | MakeOptional)
        rule = self._grammar.by_name.get(edit.rule)
        if rule is None or rule.is_lexer:
            raise GrammarError(f"there is no rule {edit.rule}")
        if isinstance(edit, AddAlternative):
            return _Way(edit.rule, None, (self._text(edit.text, words)[0], self._end(edit.rule)))
        place, sequence = edit.at, sequence_at(rule, edit.at[:-1])
        behind = (*place[:-1], place[-1] + 1)
        if isinstance(edit, Insert):
            first, may_be_left_out, is_choice = self._text(edit.text, words)
            if not may_be_left_out or is_choice or not sequence.elements:
                return None
            rest = self._rest(edit.rule, place, is_inserted=True)
            return _Way(edit.rule, place, (first, rest[0]), rest, rest[0])
        if isinstance(edit, Widen):
            if isinstance(element_at(rule, place), Repeat):
                place, behind = (*place, 0), (*place, -1)
            rest = self._rest(edit.rule, behind)
            return _Way(edit.rule, place, (self._text(edit.text, words)[0], rest[0]), rest)
        behind = (*place[:-1], place[-1] + edit.count)
        rest = self._rest(edit.rule, behind)
        return _Way(edit.rule, place, (rest[0], None), rest)

    def _text(self, text: str, words: frozenset[str]) -> tuple[int, bool, bool]:
        """Return a text's first position, whether it may be empty, whether it is a bare choice."""
        known = self._texts.get(text)
        if known is None:
            rule = rule_of(text)
            try:
                automaton = exact_automata(self._grammar, rule)(())
            except KeyError:
                raise GrammarError(f"there is no token in {text}") from None
            used = {symbol for edges in automaton.edges for symbol in edges}
            new = used - self._entry.keys() - self._lexer.kind_of.keys()
            first = self._added("", automaton)[0]
            known = (first, 0 in automaton.final, len(rule.alternatives) > 1, frozenset(new))
            self._texts[text] = known
        if not known[3] <= words:
            raise GrammarError(f"there is no token in {text}")
        return known[:3]

    def _rest(self, rule: str, at: Address, *, is_inserted: bool = False) -> range:
        """Return the positions of the remainder of a rule from an address on.

        Text that is inserted there has a remainder of its own.
        """
        found = self._rests.get((rule, at, is_inserted))
        if found is None:
            try:
                automaton = self._exact(rule)(at)
            except KeyError:
                raise GrammarError(f"rule {rule} has no place {at}") from None
            found = self._rests[rule, at, is_inserted] = self._added(rule, automaton)
        return found

    def _end(self, rule: str) -> int:
        """Return a position at the end of a rule."""
        if rule not in self._ends:
            self._ends[rule] = self._added(rule, _NOTHING)[0]
        return self._ends[rule]

    def _added(self, rule: str, automaton: RuleAutomaton) -> range:
        """Add the states of an automaton as positions of a rule, and return these."""
        base = len(self._rule)
        for state, edges in enumerate(automaton.edges):
            calls, shifts = [], {}
            for symbol, target in edges.items():
                if symbol in self._entry:
                    calls.append((self._entry[symbol], base + target))
                else:
                    kind = self._lexer.kind_of.get(symbol)
                    shifts[self._kind(symbol) if kind is None else kind] = base + target
            self._shifts.append(shifts)
            self._calls.append(calls)
            self._final.append(state in automaton.final)
            self._rule.append(rule)
            self._places.append(automaton.places[state])
        return range(base, len(self._rule))


def rule_of(text: str) -> Rule:
    """Return a text as a rule without a name; most of its parts are in the cache of rules."""
    pieces = parts(text)
    if "|" in pieces or not pieces:
        return read_rule(f"text : {text} ;")
    read = [read_rule(f"text : {piece} ;") for piece in pieces]
    elements = tuple(e for rule in read for e in rule.alternatives[0].elements)
    return Rule("text", (Alternative(elements, None, (0, 0)),))
