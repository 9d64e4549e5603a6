"""Lookahead: how many tokens a parser needs to choose a branch of a rule.

A *decision* is a place in a rule with a choice: alternatives, or an element with ``?``, ``*`` or
``+``. One token decides it if no token can begin two of its branches; two tokens do if no pair of
tokens can. Whatever can follow the rule anywhere counts (strong LL(k)), so the figures are those of
a parser that looks ahead without knowing the caller of a rule.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import chain
from operator import itemgetter
from typing import Literal

from grammar.notation.addresses import Address, element_at, sequence_at
from grammar.notation.model import Alternative, Element, Grammar, Repeat, Rule
from grammar.parser.ordered_network import FIRST, LAST, Step, ordered_automaton

#: Greatest lookahead in tokens; decisions that need more are not distinguished.
_FARTHEST = 2
_WIDEST = 60


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision of a grammar.

    ``tokens`` is 1 or 2 if so many tokens decide it, 3 if two do not. ``branches`` are those, as
    written, that can begin with the same tokens if one fewer is read, and ``alike`` is an example
    of such tokens, as people read them; both are empty if one token decides.
    """

    rule: str
    kind: Literal["choice", "optional", "repetition"]
    tokens: int
    branches: tuple[str, ...]
    alike: tuple[str, ...]

    @property
    def in_words(self) -> str:
        """What remains undecided, in one line."""
        if not self.branches:
            return f"{self.rule}: one token decides"
        named = " and ".join(f"“{branch}”" for branch in self.branches)
        return f"{self.rule}: {named} can begin alike, with {' '.join(self.alike)}"


def decisions(grammar: Grammar) -> tuple[Decision, ...]:
    """Return every decision of the parser rules in the order of the file.

    The grammar must not be left-recursive; `grammar.notation.g4.read` rejects such grammars.
    """
    graph = _Graph(grammar)
    return tuple(_decided(graph, forks) for forks in graph.forks)


def share_decided(found: Sequence[Decision], tokens: int) -> float:
    """Return the percentage of decisions that at most ``tokens`` decide; 100 if there are none."""
    decided = sum(decision.tokens <= tokens for decision in found)
    return 100 * decided / len(found) if found else 100.0


# ----------------------------------------------------------------------------- the rules as a graph

_Node = int
#: A node and the nodes to return to, the outermost first. Below these is any caller of the rule.
_Place = tuple[_Node, tuple[_Node, ...]]


@dataclass(frozen=True, slots=True)
class _Fork:
    """A decision: the text of each branch with its first node."""

    rule: str
    kind: Literal["choice", "optional", "repetition"]
    branches: tuple[tuple[str, _Node], ...]


class _Graph:
    """The parser rules as a graph of nodes without merging, so that branches stay distinct."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self.forks: list[_Fork] = []
        self._steps: list[list[tuple[str | None, _Node]]] = []  # a symbol, and the node after it
        self._entry: dict[str, _Node] = {}
        self._ends: dict[_Node, str] = {}
        for rule in grammar.parser_rules:
            base = len(self._steps)
            steps = ordered_automaton(grammar, rule).steps
            self._entry[rule.name], self._ends[base + LAST] = base + FIRST, rule.name
            self._steps += ([(s.symbol, base + s.target) for s in some] for some in steps)
            self.forks += _forks(rule, chain.from_iterable(steps), base)
        self._returns: dict[str, list[_Node]] = defaultdict(list)
        for symbol, target in chain.from_iterable(self._steps):
            if symbol in self._entry:
                self._returns[symbol].append(target)
        self._texts = {name: text for text, name in grammar.literal_tokens.items()}
        self.ahead = cache(self._ahead)

    def spelled(self, token: str) -> str:
        """Return a token as people read it: its text if it has only one, else its name."""
        return self._texts.get(token, token)

    def _ahead(self, place: _Place) -> Mapping[str, frozenset[_Place]]:
        """Return the tokens that can come at a place, with the places after each."""
        found: dict[str, set[_Place]] = defaultdict(set)
        seen = {place}
        todo = [place]
        while todo:
            node, returns = todo.pop()
            reached: list[_Place] = []
            for symbol, target in self._steps[node]:
                if symbol is None:
                    reached.append((target, returns))
                elif symbol in self._entry:
                    reached.append((self._entry[symbol], (*returns, target)))
                else:
                    found[symbol].add((target, returns))
            ended = self._ends.get(node)
            if ended is not None and returns:
                reached.append((returns[-1], returns[:-1]))
            elif ended is not None:
                reached += [(back, ()) for back in self._returns[ended]]
                if ended == self.grammar.start:  # the end of the file follows a program
                    found["EOF"].add((node, ()))
            for other in reached:
                if other not in seen:
                    seen.add(other)
                    todo.append(other)
        return {token: frozenset(places) for token, places in found.items()}


def _forks(rule: Rule, steps: Iterable[Step], base: _Node) -> list[_Fork]:
    """Return the decisions of a rule, each before those inside its branches."""
    choices: dict[Address, list[tuple[str, _Node]]] = defaultdict(list)
    parts: dict[Address, dict[str | None, _Node]] = defaultdict(dict)
    for step in steps:
        if step.sign == "alternative":
            text = _written(rule, sequence_at(rule, step.at))
            choices[step.at[:-1]].append((text, base + step.target))
        elif step.sign in ("round", "end"):
            parts[step.at][step.sign] = base + step.target
    found = {
        (at, True): _Fork(rule.name, "choice", tuple(branches))
        for at, branches in choices.items()
        if len(branches) > 1
    }
    for at, nodes in parts.items():
        element = element_at(rule, at)
        is_optional = isinstance(element, Repeat) and element.operator == "?"
        branches = (_written(rule, element), nodes["round"]), ("what follows it", nodes["end"])
        found[at, False] = _Fork(rule.name, "optional" if is_optional else "repetition", branches)
    return [fork for _, fork in sorted(found.items(), key=itemgetter(0))]


def _written(rule: Rule, node: Element | Alternative) -> str:
    text = rule.in_line(node) or "nothing"
    return text if len(text) <= _WIDEST else text[: _WIDEST - 1] + "…"


# ------------------------------------------------------------------------------------ the figures

#: The tokens read so far, and the possible places after them for each branch.
_Case = tuple[tuple[str, ...], Mapping[int, frozenset[_Place]]]


def _decided(graph: _Graph, fork: _Fork) -> Decision:
    """Return how much lookahead a decision needs."""
    start = {number: frozenset([(node, ())]) for number, (_, node) in enumerate(fork.branches)}
    undecided: list[_Case] = [((), start)]
    alike: tuple[str, ...] = ()
    together: list[int] = []
    needed = 1
    while needed <= _FARTHEST:
        undecided = [longer for case in undecided for longer in _alike(graph, *case)]
        if not undecided:
            break
        alike, after = min(undecided, key=lambda case: (-len(case[1]), case[0]))
        together = sorted(after)
        needed += 1
    return Decision(
        fork.rule,
        fork.kind,
        needed,
        tuple(fork.branches[number][0] for number in together),
        tuple(map(graph.spelled, alike)),
    )


def _alike(
    graph: _Graph, read: tuple[str, ...], reached: Mapping[int, frozenset[_Place]]
) -> Iterator[_Case]:
    """Yield the cases after one more token in which several branches remain."""
    following: dict[str, dict[int, set[_Place]]] = defaultdict(lambda: defaultdict(set))
    for number, places in reached.items():
        for place in places:
            for token, after in graph.ahead(place).items():
                following[token][number] |= after
    for token, branches in following.items():
        if len(branches) > 1:
            yield (*read, token), {n: frozenset(places) for n, places in branches.items()}
