"""Lookahead: how many tokens a parser needs to choose a branch of a rule.

A *decision* is a place in a rule where its text leaves a choice: alternatives, or an element with
``?``, ``*`` or ``+``. One token decides it when no token can begin two of its branches; two do when
no pair of tokens can. What follows the rule counts wherever the rule is used (strong LL(k)), so a
figure here is what a parser pays that looks ahead without knowing where it came from.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal as OneOf

from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
)

#: Tokens looked at; decisions that need more are not distinguished.
_FARTHEST = 2
_WIDEST = 60


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision of a grammar.

    ``tokens`` is 1 or 2 where so many decide it, 3 where two do not. ``branches`` are those, as
    written in the rule, that begin alike with one token fewer than that, and ``alike`` these tokens
    in one case, as people read them; both are empty where one token decides.
    """

    rule: str
    kind: OneOf["choice", "optional", "repetition"]
    tokens: int
    branches: tuple[str, ...]
    alike: tuple[str, ...]

    @property
    def in_words(self) -> str:
        """What stays undecided, in one line."""
        if not self.branches:
            return f"{self.rule}: one token decides"
        named = " and ".join(f"“{branch}”" for branch in self.branches)
        return f"{self.rule}: {named} can begin alike, with {' '.join(self.alike)}"


def decisions(grammar: Grammar) -> tuple[Decision, ...]:
    """Every decision of the parser rules in the order of the file.

    The grammar has no left recursion: `grammar.notation.g4.read` refuses it.
    """
    graph = _Graph(grammar)
    return tuple(_decided(graph, forks) for forks in graph.forks)


def share_decided(found: Sequence[Decision], tokens: int) -> float:
    """Per cent of the decisions that so many tokens decide, or fewer; 100 where there are none."""
    decided = sum(decision.tokens <= tokens for decision in found)
    return 100 * decided / len(found) if found else 100.0


# ----------------------------------------------------------------------------- the rules as a graph

_Node = int
#: A node and the nodes to return to, the outermost first. Below them lies any caller of the rule.
_Place = tuple[_Node, tuple[_Node, ...]]


@dataclass(frozen=True, slots=True)
class _Fork:
    """A decision: the node each branch begins at, with its text as written."""

    rule: str
    kind: OneOf["choice", "optional", "repetition"]
    branches: tuple[tuple[str, _Node], ...]


class _Graph:
    """All parser rules, written out as nodes; nothing is merged, so that branches stay apart."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self.forks: list[_Fork] = []
        self._free: list[list[_Node]] = []  # steps that read nothing
        self._reads: list[tuple[str, _Node] | None] = []  # a token, and the node after it
        self._calls: list[tuple[str, _Node] | None] = []  # a rule, and the node to return to
        self._ends: dict[_Node, str] = {}
        self._returns: dict[str, list[_Node]] = defaultdict(list)
        rules = [rule for rule in grammar.rules if not rule.is_lexer]
        self._names = frozenset(rule.name for rule in rules)
        self._entry = {rule.name: self._node() for rule in rules}
        for rule in rules:
            end = self._choice(rule, rule.alternatives, self._entry[rule.name])
            self._ends[end] = rule.name
        self._texts = {name: text for text, name in grammar.literal_tokens.items()}
        self.ahead = cache(self._ahead)

    def spelled(self, token: str) -> str:
        """A token as people read it: its text where it has only one, else its name."""
        return self._texts.get(token, token)

    def _node(self) -> _Node:
        self._free.append([])
        self._reads.append(None)
        self._calls.append(None)
        return len(self._free) - 1

    def _choice(self, rule: Rule, alternatives: Sequence[Alternative], start: _Node) -> _Node:
        end = self._node()
        branches: list[tuple[str, _Node]] = []
        fork = self._fork(len(alternatives) > 1)
        for alternative in alternatives:
            first = last = self._node()
            self._free[start].append(first)
            branches.append((_written(rule, alternative), first))
            for element in alternative.elements:
                last = self._element(rule, element, last)
            self._free[last].append(end)
        if fork is not None:
            self.forks[fork] = _Fork(rule.name, "choice", tuple(branches))
        return end

    def _fork(self, wanted: bool) -> int | None:
        """Keep the place of a decision, which comes before those inside its branches."""
        if not wanted:
            return None
        self.forks.append(_Fork("", "choice", ()))
        return len(self.forks) - 1

    def _element(self, rule: Rule, element: Element, start: _Node) -> _Node:
        match element:
            case Group(alternatives=alternatives):
                return self._choice(rule, alternatives, start)
            case Repeat(item=item, operator=operator):
                fork = self._fork(wanted=True)
                assert fork is not None
                before, after = self._node(), self._node()
                self._free[start].append(before)
                end = self._element(rule, item, before)
                self._free[end].append(after)
                if operator != "+":
                    self._free[start].append(after)
                if operator != "?":
                    self._free[end].append(before)
                self.forks[fork] = _Fork(
                    rule.name,
                    "optional" if operator == "?" else "repetition",
                    ((_written(rule, element), before), ("what follows it", after)),
                )
                return after
            case Reference(name=name) if name in self._names:
                end = self._node()
                self._calls[start] = (name, end)
                self._returns[name].append(end)
                return end
            case Reference() | Literal():
                end = self._node()
                self._reads[start] = (self.grammar.token_of(element), end)
                return end
            case _:
                raise AssertionError("sets of characters do not occur in parser rules")

    def _ahead(self, place: _Place) -> Mapping[str, frozenset[_Place]]:
        """The tokens that may come at a place, and the places after each."""
        found: dict[str, set[_Place]] = defaultdict(set)
        seen = {place}
        todo = [place]
        while todo:
            node, returns = todo.pop()
            reached: list[_Place] = [(free, returns) for free in self._free[node]]
            read, call, ended = self._reads[node], self._calls[node], self._ends.get(node)
            if read is not None:
                found[read[0]].add((read[1], returns))
            if call is not None:
                reached.append((self._entry[call[0]], (*returns, call[1])))
            if ended is not None and returns:
                reached.append((returns[-1], returns[:-1]))
            elif ended is not None:
                reached += [(back, ()) for back in self._returns[ended]]
                if ended == self.grammar.start:  # behind a program lies the end of the file
                    found["EOF"].add((node, ()))
            for other in reached:
                if other not in seen:
                    seen.add(other)
                    todo.append(other)
        return {token: frozenset(places) for token, places in found.items()}


def _written(rule: Rule, node: Element | Alternative) -> str:
    text = " ".join(rule.source_of(node).split()) or "nothing"
    return text if len(text) <= _WIDEST else text[: _WIDEST - 1] + "…"


# ------------------------------------------------------------------------------------ the figures

#: Tokens read so far, and for each branch the places where it may then be.
_Case = tuple[tuple[str, ...], Mapping[int, frozenset[_Place]]]


def _decided(graph: _Graph, fork: _Fork) -> Decision:
    """How far ahead a decision has to look."""
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
    """One more token: those that several branches can continue with, and where they are then."""
    following: dict[str, dict[int, set[_Place]]] = defaultdict(lambda: defaultdict(set))
    for number, places in reached.items():
        for place in places:
            for token, after in graph.ahead(place).items():
                following[token][number] |= after
    for token, branches in following.items():
        if len(branches) > 1:
            yield (*read, token), {n: frozenset(places) for n, places in branches.items()}
