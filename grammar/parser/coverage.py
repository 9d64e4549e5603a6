"""Coverage of a grammar by parse trees: the alternatives that occur, and the rounds of its loops.

A tree shows the children of each rule. From these the path through the text of the rule is
reconstructed (`grammar.parser.ordered_network`). If there are several, it is the one that ANTLR
prefers.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence

from grammar.notation.addresses import Address
from grammar.notation.model import Grammar
from grammar.parser.ordered_network import FIRST, LAST, OrderedAutomaton, Step, ordered_automaton
from grammar.parser.tree import Outline, Tree
from support.lazy_dataclass import dataclass

# Long sequences (the statements of a routine) seldom come twice: only short ones are remembered.
_LONGEST_REMEMBERED = 32
_MOST_REMEMBERED = 100_000


@dataclass(frozen=True, slots=True)
class _Match:
    """A rule matched with its children: its alternative, and what happened at each address."""

    alternative: int
    groups: tuple[tuple[Address, int], ...]
    rounds: tuple[tuple[Address, int], ...]
    children: tuple[Address, ...]


class GrammarCoverage:
    """The coverage of a grammar by the trees added so far; equal outlines in a tree count once.

    ``choices`` counts which alternative was taken, by rule and address: of the rule itself at the
    empty address, of a group, or of the rule that a reference names. ``rounds`` counts how many
    rounds each part with a suffix had.
    """

    def __init__(self, grammar: Grammar) -> None:
        self._rules = {rule.name: rule for rule in grammar.parser_rules}
        self._written = {
            name: ordered_automaton(grammar, rule) for name, rule in self._rules.items()
        }
        self._matches: dict[tuple[str, tuple[str, ...]], _Match] = {}
        self.choices: dict[tuple[str, Address], Counter[int]] = defaultdict(Counter)
        self.rounds: dict[tuple[str, Address], Counter[int]] = defaultdict(Counter)

    def add(self, tree: Tree) -> None:
        """Count what a tree, which must be one of this grammar, takes."""
        names = tree.lexer.names
        known: dict[Outline, _Match] = {}

        def match(outline: Outline) -> _Match:
            found = known.get(outline)
            if found is None:
                symbols = tuple(s if isinstance(s, str) else names[s] for s in outline.symbols)
                found = known[outline] = self._match(outline.rule, symbols)
            return found

        todo, met = [tree.outline], {tree.outline}
        while todo:
            outline = todo.pop()
            name, found = outline.rule, match(outline)
            for at, number in (((), found.alternative), *found.groups):
                self.choices[name, at][number] += 1
            for at, often in found.rounds:
                self.rounds[name, at][often] += 1
            for child, at in zip(outline.children, found.children, strict=True):
                if isinstance(child, Outline):
                    self.choices[name, at][match(child).alternative] += 1
                    if child not in met:
                        met.add(child)
                        todo.append(child)

    @property
    def unused_alternatives(self) -> list[tuple[str, int]]:
        """Rules and numbers of alternatives that never occur, in the order of the grammar."""
        return [
            (name, number)
            for name, rule in self._rules.items()
            for number in range(1, len(rule.alternatives) + 1)
            if not self.choices[name, ()][number]
        ]

    def _match(self, name: str, symbols: tuple[str, ...]) -> _Match:
        if len(symbols) > _LONGEST_REMEMBERED:
            return self._matched(name, symbols)
        found = self._matches.get((name, symbols))
        if found is None:
            if len(self._matches) >= _MOST_REMEMBERED:
                self._matches.clear()
            found = self._matches[name, symbols] = self._matched(name, symbols)
        return found

    def _matched(self, name: str, symbols: Sequence[str]) -> _Match:
        choices: list[tuple[Address, int]] = []
        children: list[Address] = []
        rounds: dict[Address, int] = {}
        ended: list[tuple[Address, int]] = []
        for step in _way(self._written[name], symbols):
            match step.sign:
                case "alternative":
                    choices.append((step.at[:-1], step.at[-1]))
                case "part":
                    rounds[step.at] = 0
                case "round":
                    rounds[step.at] += 1
                case "end":
                    ended.append((step.at, rounds[step.at]))
                case None if step.symbol is not None:
                    children.append(step.at)
        (_, alternative), *groups = choices
        return _Match(alternative, tuple(groups), tuple(ended), tuple(children))


# The steps to a state as a linked list, the last one first.
_Steps = tuple["_Steps", Step] | None


def _way(automaton: OrderedAutomaton, symbols: Sequence[str]) -> list[Step]:
    """Return the steps from the first to the last state that read the symbols.

    If there are several paths, it is the one that ANTLR prefers.
    """
    threads: list[tuple[int, _Steps]] = [(FIRST, None)]
    for symbol in symbols:
        threads = [
            (step.target, (steps, step))
            for state, steps in _reached(automaton, threads)
            for step in automaton.steps[state]
            if step.symbol == symbol
        ]
    way = next(steps for state, steps in _reached(automaton, threads) if state == LAST)
    found = []
    while way is not None:
        way, step = way
        found.append(step)
    return found[::-1]


def _reached(
    automaton: OrderedAutomaton, threads: Sequence[tuple[int, _Steps]]
) -> Iterator[tuple[int, _Steps]]:
    """Yield each state that is reached without reading once, by its preferred path."""
    seen = set()
    todo = list(reversed(threads))
    while todo:
        state, steps = todo.pop()
        if state not in seen:
            seen.add(state)
            yield state, steps
            empty = (step for step in reversed(automaton.steps[state]) if step.symbol is None)
            todo += [(step.target, (steps, step)) for step in empty]
