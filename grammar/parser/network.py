"""A grammar as a recursive transition network: the automata of all its parser rules, linked.

A *position* is a state of the automaton of one rule. At a position the network reads a token, calls
a rule and later returns to another position of the same rule, or leaves the rule. Positions are
small integers. The automaton of a rule is built once for its text and shared by every grammar with
that rule, so trying a candidate edit costs one automaton.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace

from grammar.notation.model import Grammar, Rule
from grammar.parser.lexer import Lexer, lexer_of
from grammar.parser.rule_automaton import RuleAutomaton, rule_automaton
from support.lazy_dataclass import dataclass

#: A position, and the positions to return to from it, the outermost first.
_Way = tuple[int, tuple[int, ...]]


class Reach(dict[int, Sequence[_Way]]):
    """What can be done at a position before its rule ends, with calls followed.

    As a dictionary it maps a token kind to the ways to read it: each is the position after the
    token and the positions to return to. An entry is computed on its first use, because most kinds
    are never asked for. ``ends`` says whether the rule may end without reading, and ``rules`` names
    the rules involved.
    """

    __slots__ = ("_first", "_network", "_sites", "_steps", "ends", "rules")

    def __init__(
        self, network: Network, steps: Sequence[int], rules: frozenset[str], *, ends: bool
    ) -> None:
        """Create it; ``steps`` are the positions of the rule that are reached by empty steps."""
        super().__init__()
        self._network = network
        self._steps = steps
        self._first: frozenset[int] | None = None
        self._sites: Sequence[_Way] | None = None
        self.ends = ends
        self.rules = rules

    def __missing__(self, kind: int) -> Sequence[_Way]:
        network = self._network
        found: list[_Way] = []
        for here in self._steps:
            target = network.shifts[here].get(kind)
            if target is not None:
                found.append((target, ()))
            for entry, back in network.calls[here]:
                for position, returns in network.reach(entry)[kind]:
                    found.append((position, (back, *returns)))
        self[kind] = found
        return found

    @property
    def first(self) -> frozenset[int]:
        """The token kinds that can come next (the FIRST set)."""
        if self._first is None:
            network = self._network
            shifts = (network.shifts[here] for here in self._steps)
            called = (network.reach(e).first for h in self._steps for e, _ in network.calls[h])
            self._first = frozenset[int]().union(*shifts, *called)
        return self._first

    @property
    def sites(self) -> Sequence[_Way]:
        """The positions reached without reading, each with the positions to return to."""
        if self._sites is None:
            network = self._network
            found: list[_Way] = []
            for here in self._steps:
                found.append((here, ()))
                for entry, back in network.calls[here]:
                    for position, returns in network.reach(entry).sites:
                        found.append((position, (back, *returns)))
            self._sites = found
        return self._sites

    __hash__ = object.__hash__  # type: ignore[assignment]  # a dict has none
    __eq__ = object.__eq__


class LeftRecursionError(Exception):
    """A rule calls itself before it has read a token."""


@dataclass(frozen=True, slots=True)
class Network:
    """The whole grammar, with positions numbered across rules.

    ``shifts[p]`` maps a token kind to the next position. ``calls[p]`` lists pairs of the first
    position of the called rule and the position to return to. ``final[p]`` says whether the rule
    may end at ``p``, and ``rule[p]`` is the name of the rule to which ``p`` belongs.
    """

    lexer: Lexer
    automata: Mapping[str, RuleAutomaton]
    shifts: Sequence[Mapping[int, int]]
    calls: Sequence[Sequence[tuple[int, int]]]
    final: Sequence[bool]
    rule: Sequence[str]
    entry: Mapping[str, int]
    start: int
    known: dict[int, Reach | None] = field(default_factory=dict, compare=False, repr=False)

    def passing(self) -> frozenset[int]:
        """Return the positions at which the only possible step is to leave the rule."""
        ways = zip(self.final, self.shifts, self.calls, strict=True)
        return frozenset(p for p, (f, s, c) in enumerate(ways) if f and not s and not c)

    def reach(self, position: int) -> Reach:
        """Return what can be done at a position; raises `LeftRecursionError`."""
        found = self.known.get(position)
        return self._reach(position) if found is None else found

    def _reach(self, position: int) -> Reach:
        if position in self.known:
            raise LeftRecursionError
        self.known[position] = None  # until it is known
        rules = {self.rule[position]}
        ends = False
        steps = [position]
        for here in steps:  # grows while it is walked
            ends = ends or self.final[here]
            for entry, back in self.calls[here]:
                called = self.reach(entry)
                rules |= called.rules
                if called.ends and back not in steps:
                    steps.append(back)
        found = self.known[position] = Reach(self, steps, frozenset(rules), ends=ends)
        return found


def network_of(grammar: Grammar, lexer: Lexer | None = None) -> Network:
    """Return the linked automata of all parser rules; ``lexer`` saves building it."""
    lexer = lexer or lexer_of(grammar)
    automata = {r.name: rule_automaton(grammar, r) for r in grammar.parser_rules}
    entry: dict[str, int] = {}
    size = 0
    for name, automaton in automata.items():
        entry[name] = size
        size += len(automaton.edges)
    shifts: list[Mapping[int, int]] = []
    calls: list[tuple[tuple[int, int], ...]] = []
    final: list[bool] = []
    rule: list[str] = []
    for name, automaton in automata.items():
        base = entry[name]
        for state, edges in enumerate(automaton.edges):
            shifts.append({lexer.kind_of[s]: base + t for s, t in edges.items() if s not in entry})
            calls.append(tuple((entry[s], base + t) for s, t in edges.items() if s in entry))
            final.append(state in automaton.final)
            rule.append(name)
    return Network(
        lexer,
        automata,
        tuple(shifts),
        tuple(calls),
        tuple(final),
        tuple(rule),
        entry,
        entry[grammar.start],
    )


def with_rule(network: Network, grammar: Grammar, rule: Rule, lexer: Lexer) -> Network:
    """Return the network with the automaton of one rule replaced by that of its new text.

    All other rules keep their positions, and this one its first position. ``grammar`` already has
    the new rule, and ``lexer`` numbers its tokens as the network does. This is far cheaper than
    linking the network again, and makes it possible to try thousands of edits.
    """
    automaton = rule_automaton(grammar, rule)
    entry, first = network.entry, network.entry[rule.name]
    size = len(network.rule) - 1
    place = [first, *range(size + 1, size + len(automaton.edges))]
    added = len(automaton.edges) - 1
    shifts = [*network.shifts, *({} for _ in range(added))]
    calls = [*network.calls, *(() for _ in range(added))]
    final = [*network.final, *(False for _ in range(added))]
    for state, edges in enumerate(automaton.edges):
        p = place[state]
        shifts[p] = {lexer.kind_of[s]: place[t] for s, t in edges.items() if s not in entry}
        calls[p] = tuple((entry[s], place[t]) for s, t in edges.items() if s in entry)
        final[p] = state in automaton.final
    return replace(
        network,
        lexer=lexer,
        shifts=tuple(shifts),
        calls=tuple(calls),
        final=tuple(final),
        rule=(*network.rule, *(rule.name for _ in range(added))),
        automata={**network.automata, rule.name: automaton},
        known={p: r for p, r in network.known.items() if r and rule.name not in r.rules},
    )


def is_left_recursive(network: Network) -> bool:
    """Return whether a rule can call itself before it has read a token.

    The simulation of such a network would not end.
    """
    try:
        for entry in network.entry.values():
            network.reach(entry)
    except LeftRecursionError:
        return True
    return False
