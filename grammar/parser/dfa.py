"""Deterministic finite automata over characters: lexer rules become one longest-match pattern.

ANTLR's lexer takes the longest match; Python's ``re`` takes the first alternative that matches. The
union of all lexer rules is therefore made deterministic (subset construction) and minimal. From the
result a pattern is written whose greedy match is the longest one, because in a deterministic
automaton the next character always decides which branch to take.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from grammar.notation.model import (
    MAX_CODE_POINT,
    CharRange,
    CharSet,
    Element,
    Grammar,
    GrammarError,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    complement,
    normalised,
)
from support.lazy_dataclass import dataclass

#: Distance of the two cases of an ASCII letter; ANTLR's ``caseInsensitive`` adds the other case.
_CASE_OFFSET = ord("a") - ord("A")


@dataclass(frozen=True, slots=True)
class CharAutomaton:
    """A minimal deterministic finite automaton; state 0 is the start.

    ``edges[state]`` maps each next state to the characters that lead to it.
    """

    edges: tuple[Mapping[int, tuple[CharRange, ...]], ...]
    accepting: frozenset[int]

    def longest(self, text: str, start: int) -> int:
        """Return where the longest match from ``start`` ends; ``start`` if nothing matches."""
        state, end = 0, start
        for position in range(start, len(text)):
            code = ord(text[position])
            following = (
                target
                for target, ranges in self.edges[state].items()
                if any(low <= code <= high for low, high in ranges)
            )
            step = next(following, None)
            if step is None:
                break
            state = step
            if state in self.accepting:
                end = position + 1
        return end


def both_cases(ranges: Iterable[CharRange]) -> tuple[CharRange, ...]:
    """Return the ranges with the other case of every ASCII letter added."""
    out = list(ranges)
    for low, high in list(out):
        for first, last, offset in (("A", "Z", _CASE_OFFSET), ("a", "z", -_CASE_OFFSET)):
            start, end = max(low, ord(first)), min(high, ord(last))
            if start <= end:
                out.append((start + offset, end + offset))
    return normalised(out)


class _Nfa:
    """Thompson's construction; an edge carries character ranges, or ``None`` for an empty step."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self.edges: list[list[tuple[tuple[CharRange, ...] | None, int]]] = [[]]
        self.open_rules: list[str] = []
        self._closures: dict[int, frozenset[int]] = {}

    def state(self) -> int:
        self.edges.append([])
        return len(self.edges) - 1

    def rule(self, rule: Rule, start: int) -> int:
        if rule.name in self.open_rules:
            raise GrammarError(f"lexer rule {rule.name} is recursive")
        self.open_rules.append(rule.name)
        end = self.choice((a.elements for a in rule.alternatives), start)
        self.open_rules.pop()
        return end

    def choice(self, sequences: Iterable[tuple[Element, ...]], start: int) -> int:
        end = self.state()
        for elements in sequences:
            last = start
            for element in elements:
                last = self.element(element, last)
            self.edges[last].append((None, end))
        return end

    def element(self, element: Element, start: int) -> int:
        fold = both_cases if self.grammar.case_insensitive else tuple
        match element:
            case Literal(text=text):
                for character in text:
                    start = self.step(fold([(ord(character), ord(character))]), start)
                return start
            case CharSet(ranges=ranges):
                return self.step(fold(ranges), start)
            case Reference(name=name):
                return self.rule(self.grammar.by_name[name], start)
            case Group(alternatives=alternatives):
                return self.choice((a.elements for a in alternatives), start)
            case Repeat(item=item, operator=operator):
                before, after = self.state(), self.state()
                self.edges[start].append((None, before))
                end = self.element(item, before)
                self.edges[end].append((None, after))
                if operator != "+":
                    self.edges[before].append((None, after))
                if operator != "?":
                    self.edges[end].append((None, before))
                return after

    def step(self, ranges: tuple[CharRange, ...], start: int) -> int:
        end = self.state()
        self.edges[start].append((ranges, end))
        return end

    def closure(self, state: int) -> frozenset[int]:
        """Return the epsilon closure of a state; call it only when all edges have been added."""
        found = self._closures.get(state)
        if found is None:
            seen = {state}
            todo = [state]
            while todo:
                for ranges, target in self.edges[todo.pop()]:
                    if ranges is None and target not in seen:
                        seen.add(target)
                        todo.append(target)
            found = self._closures[state] = frozenset(seen)
        return found


def automaton_of(grammar: Grammar, rules: Sequence[Rule]) -> CharAutomaton:
    """Return the minimal automaton for the union of the lexer rules."""
    nfa = _Nfa(grammar)
    ends = frozenset([nfa.choice(((Reference(r.name, (0, 0)),) for r in rules), 0)])
    cuts = sorted(
        {0, MAX_CODE_POINT + 1}
        | {p for edges in nfa.edges for rs, _ in edges for lo, hi in rs or () for p in (lo, hi + 1)}
    )
    letters = cuts[:-1]  # one representative for each class of characters
    index = {nfa.closure(0): 0}
    table: list[list[int]] = []
    order = list(index)
    for states in order:  # grows while it is walked
        row = []
        ways = [(rs, t) for s in states for rs, t in nfa.edges[s] if rs is not None]
        for letter in letters:
            targets = frozenset[int]().union(
                *(nfa.closure(t) for rs, t in ways if any(lo <= letter <= hi for lo, hi in rs))
            )
            if targets and targets not in index:
                index[targets] = len(order)
                order.append(targets)
            row.append(index[targets] if targets else -1)
        table.append(row)
    accepting = [bool(states & ends) for states in order]
    return _minimal(table, accepting, cuts)


def _minimal(table: list[list[int]], accepting: list[bool], cuts: list[int]) -> CharAutomaton:
    block = [int(a) for a in accepting]
    while True:
        keys: dict[tuple[int, ...], int] = {}
        refined = [
            keys.setdefault((block[s], *(block[t] if t >= 0 else -1 for t in row)), len(keys))
            for s, row in enumerate(table)
        ]
        if len(keys) == len(set(block)):
            break
        block = refined
    number: dict[int, int] = {block[0]: 0}
    for b in block:
        number.setdefault(b, len(number))
    edges: list[dict[int, list[CharRange]]] = [{} for _ in number]
    done: set[int] = set()
    for s, row in enumerate(table):
        here = number[block[s]]
        if here in done:
            continue
        done.add(here)
        for (low, high), target in zip(pairwise(cuts), row, strict=True):
            if target >= 0:
                edges[here].setdefault(number[block[target]], []).append((low, high - 1))
    return CharAutomaton(
        tuple({t: normalised(rs) for t, rs in e.items()} for e in edges),
        frozenset(number[block[s]] for s, a in enumerate(accepting) if a),
    )


def first_characters(automaton: CharAutomaton) -> tuple[CharRange, ...]:
    """Return the characters with which some accepted text begins."""
    return normalised([r for ranges in automaton.edges[0].values() for r in ranges])


def overlap(left: Sequence[CharRange], right: Sequence[CharRange]) -> bool:
    """Return whether two sets of characters intersect."""
    return any(a <= d and c <= b for a, b in left for c, d in right)


#: Longest path of states. Each state is a group inside the one before, and ``re`` compiles groups
#: recursively.
_LONGEST_WAY = 150


def pattern_of(automaton: CharAutomaton) -> str | None:
    """Return a pattern for ``re`` that matches the longest accepted text, never the empty one.

    Returns ``None`` if the automaton has a cycle through several states, because no such pattern
    exists for it, or if a path is longer than ``re`` can nest groups.
    """
    on_path: set[int] = set()

    def of(state: int, *, may_stop: bool) -> str | None:
        if state in on_path or len(on_path) >= _LONGEST_WAY:
            return None
        on_path.add(state)
        loop, ways = "", []
        ordered = sorted(automaton.edges[state].items(), key=lambda e: -_size(e[1]))
        for target, ranges in ordered:
            if target == state:
                # possessive, because no character of the loop can follow it
                loop = f"{class_of(ranges)}*+"
                continue
            rest = of(target, may_stop=target in automaton.accepting)
            if rest is None:
                return None
            ways.append(class_of(ranges) + rest)
        on_path.remove(state)
        if not ways:
            return loop
        return f"{loop}(?:{'|'.join(ways)}){'?' if may_stop else ''}"

    return of(0, may_stop=False)


def _size(ranges: Sequence[CharRange]) -> int:
    return sum(high - low + 1 for low, high in ranges if low < 128)


def class_of(ranges: Sequence[CharRange]) -> str:
    """Return a set of characters as a class of ``re``."""

    def one(code: int) -> str:
        return re.escape(chr(code)) if code < 128 else f"\\U{code:08x}"

    if len(ranges) == 1 and ranges[0][0] == ranges[0][1]:
        return one(ranges[0][0])
    negated = ranges[-1][1] == MAX_CODE_POINT and len(ranges) > 1  # compiled in far less time
    written = complement(ranges) if negated else ranges
    inside = "".join(one(lo) if lo == hi else f"{one(lo)}-{one(hi)}" for lo, hi in written)
    return f"[{'^' if negated else ''}{inside}]"
