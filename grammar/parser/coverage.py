"""Coverage of a grammar by parse trees: rules, alternatives and branches.

*Context-dependent branch coverage* (Ralf Lämmel, "Grammar Testing", FASE 2001) demands more than
that every alternative of every rule occurs somewhere: every alternative has to occur at every
reference to its rule. Groups and parts with a suffix count as rules without a name. Each
alternative of a group is a branch. So are the absence and presence of an optional part, and no
round, one round and several rounds of a loop.

Rules that only choose between words would dominate the count. A name, for example, may be spelled
like some keywords, and each of these words would be a branch at every place of a name. Such rules
can be passed as *words*; each of their alternatives is then one branch, wherever it occurs.

A tree shows the children of each rule. From these the path through the text of the rule is
reconstructed (`grammar.parser.ordered_network`). If there are several, it is the one that ANTLR
prefers.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from grammar.notation.addresses import Address, element_at, sequences, spelled
from grammar.notation.model import Alternative, Element, Grammar, Group, Reference, Repeat, Rule
from grammar.parser.ordered_network import FIRST, LAST, OrderedAutomaton, Step, ordered_automaton
from grammar.parser.tree import Outline, Tree

_HOW_OFTEN: Mapping[str, tuple[str, ...]] = {
    "?": ("absent", "present"),
    "*": ("none", "one", "more"),
    "+": ("one", "more"),
}
_NEVER: Mapping[int | str, str] = {
    "absent": "is always there",
    "present": "is never there",
    "none": "is always there",
    "one": "never comes just once",
    "more": "never comes more than once",
}
# Long sequences (the statements of a routine) seldom come twice: only short ones are remembered.
_LONGEST_REMEMBERED = 32
_MOST_REMEMBERED = 100_000


@dataclass(frozen=True, slots=True)
class Branch:
    """One choice at a place of a rule.

    ``taken`` is the number of an alternative: of the rule ``referred`` to at this place or, if that
    is ``None``, of the group there. For a part with a suffix, ``taken`` says how often it occurs:
    ``absent`` or ``present``, ``none``, ``one`` or ``more``. At a reference to a rule of words
    ``taken`` is always 1; the alternatives of that rule are branches of the rule itself with an
    empty address ``at``.
    """

    rule: str
    at: Address
    referred: str | None
    taken: int | str


@dataclass(frozen=True, slots=True)
class Share:
    """The number of items, and how many of them were covered."""

    covered: int
    total: int

    @property
    def percent(self) -> float:
        """From 0 to 100; 100 if there are no items."""
        return 100 * self.covered / self.total if self.total else 100.0


@dataclass(frozen=True, slots=True)
class _Match:
    """A rule matched with its children: alternative, branches taken, and address of each child."""

    alternative: int
    branches: frozenset[Branch]
    places: tuple[Address, ...]
    rounds: tuple[tuple[Address, int], ...]


class GrammarCoverage:
    """The coverage of a grammar by the trees added so far; ``words`` as in the module docstring."""

    def __init__(self, grammar: Grammar, words: Collection[str] = ()) -> None:
        self.grammar = grammar
        self._words = frozenset(words)
        self._rules = {rule.name: rule for rule in grammar.rules if not rule.is_lexer}
        self._written = {
            name: ordered_automaton(grammar, rule) for name, rule in self._rules.items()
        }
        self._matches: dict[tuple[str, tuple[str, ...]], _Match] = {}
        self._alternatives: set[tuple[str, int]] = set()
        self._branches: set[Branch] = set()
        #: How many rounds each part with a suffix had; equal outlines in a tree count once.
        self.rounds: dict[tuple[str, Address], Counter[int]] = defaultdict(Counter)

    def add(self, tree: Tree) -> None:
        """Count the branches of a tree, which must be one of this grammar."""
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
            found = match(outline)
            self._alternatives.add((outline.rule, found.alternative))
            self._branches.update(found.branches)
            for at, often in found.rounds:
                self.rounds[outline.rule, at][often] += 1
            for child, place in zip(outline.children, found.places, strict=True):
                if isinstance(child, Outline):
                    is_word = child.rule in self._words
                    number = 1 if is_word else match(child).alternative
                    self._branches.add(Branch(outline.rule, place, child.rule, number))
                    if child not in met:
                        met.add(child)
                        todo.append(child)

    # ---------------------------------------------------------------------------- results

    @property
    def rules(self) -> Share:
        """Share of the rules that occur."""
        return Share(len({name for name, _ in self._alternatives}), len(self._rules))

    @property
    def alternatives(self) -> Share:
        """Share of the alternatives that occur anywhere."""
        total = sum(len(rule.alternatives) for rule in self._rules.values())
        return Share(len(self._alternatives), total)

    @property
    def branches(self) -> Share:
        """Share of the context-dependent branches that are taken."""
        return Share(len(self._branches), len(self._all))

    @property
    def unused_rules(self) -> list[str]:
        """Names of the rules that never occur, in the order of the grammar."""
        used = {name for name, _ in self._alternatives}
        return [name for name in self._rules if name not in used]

    @property
    def unused_alternatives(self) -> list[tuple[str, int]]:
        """Rules and numbers of alternatives that never occur, in the order of the grammar."""
        return [
            (name, number)
            for name, rule in self._rules.items()
            for number in range(1, len(rule.alternatives) + 1)
            if (name, number) not in self._alternatives
        ]

    @property
    def uncovered(self) -> list[Branch]:
        """Branches that are never taken, in the order of the grammar."""
        return [branch for branch in self._all if branch not in self._branches]

    def describe(self, branch: Branch) -> str:
        """Return what is missing if a branch is not covered, in one line for a person."""
        rule = self._rules[branch.rule]
        if not branch.at:
            return f"{rule.name} is never {_alternative(rule, branch.taken)}"
        element = element_at(rule, branch.at)
        what = branch.referred or _source(rule, element)
        place = f"{rule.name} {spelled(branch.at)}: {what}"
        if branch.taken in _NEVER:
            return f"{place} {_NEVER[branch.taken]}"
        if branch.referred is not None:
            callee = self._rules[branch.referred]
            if len(callee.alternatives) == 1 or callee.name in self._words:
                return f"{place} is never there"
            return f"{place} is never {_alternative(callee, branch.taken)}"
        group = element.item if isinstance(element, Repeat) else element
        assert isinstance(group, Group)
        return f"{place} is never {_source(rule, group.alternatives[int(branch.taken) - 1])}"

    @cached_property
    def _all(self) -> Mapping[Branch, None]:
        """All branches, in the order of the grammar."""
        return dict.fromkeys(branches(self.grammar, self._words))

    # --------------------------------------------------------------------------- matching

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
        alternative = 0
        taken: set[Branch] = set()
        places: list[Address] = []
        rounds: dict[Address, int] = {}
        ended: list[tuple[Address, int]] = []
        for step in _way(self._written[name], symbols):
            at = step.at
            match step.sign:
                case "alternative" if len(at) == 1:
                    alternative = at[0]
                case "alternative":
                    taken.add(Branch(name, at[:-1], None, at[-1]))
                case "part":
                    rounds[at] = 0
                case "round":
                    rounds[at] += 1
                case "end":
                    element = element_at(self._rules[name], at)
                    assert isinstance(element, Repeat)
                    ended.append((at, rounds[at]))
                    taken.add(Branch(name, at, None, _how_often(element.operator, rounds[at])))
                case None if step.symbol is not None:
                    places.append(at)
        if name in self._words:
            taken.add(Branch(name, (), None, alternative))
        return _Match(alternative, frozenset(taken & self._all.keys()), tuple(places), tuple(ended))


def _how_often(operator: str, rounds: int) -> str:
    words = _HOW_OFTEN[operator]
    return words[min(rounds - (operator == "+"), len(words) - 1)]


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


# ------------------------------------------------------------------------------ branches


def branches(grammar: Grammar, words: Collection[str] = ()) -> Iterator[Branch]:
    """Yield every context-dependent branch of a grammar; ``words`` as in `GrammarCoverage`."""
    for rule in grammar.rules:
        if rule.is_lexer:
            continue
        if rule.name in words:
            for number in range(1, len(rule.alternatives) + 1):
                yield Branch(rule.name, (), None, number)
        for address, alternative in sequences(rule):
            for place, element in enumerate(alternative.elements, 1):
                for referred, taken in _choices(grammar, element, words):
                    yield Branch(rule.name, (*address, place), referred, taken)


def _choices(
    grammar: Grammar, element: Element, words: Collection[str]
) -> Iterator[tuple[str | None, int | str]]:
    """Yield the pairs ``(referred, taken)`` of an element: see `Branch`."""
    match element:
        case Repeat(item=item, operator=operator):
            yield from ((None, word) for word in _HOW_OFTEN[operator])
            yield from _choices(grammar, item, words)
        case Group(alternatives=alternatives) if len(alternatives) > 1:
            yield from ((None, number) for number in range(1, len(alternatives) + 1))
        case Reference(name=name) if not element.is_token:
            count = 1 if name in words else len(grammar.by_name[name].alternatives)
            yield from ((name, number) for number in range(1, count + 1))


def _alternative(rule: Rule, number: int | str) -> str:
    return _source(rule, rule.alternatives[int(number) - 1])


def _source(rule: Rule, node: Element | Alternative) -> str:
    return " ".join(rule.source_of(node).split()) or "empty"
