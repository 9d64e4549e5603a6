"""Lexer rules as one deterministic automaton over characters, and as one pattern for ``re``.

ANTLR's lexer takes the longest match; Python's ``re`` takes the first alternative that matches. The
union of all lexer rules is therefore made deterministic (subset construction) and minimal. From the
result a pattern is written whose greedy match is the longest one, because in a deterministic
automaton the next character always decides which branch to take.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

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
    normalised_ranges,
)
from grammar.parser.nfa import Nfa
from support.lazy_dataclass import dataclass

#: Distance of the two cases of an ASCII letter; ANTLR's ``caseInsensitive`` adds the other case.
_CASE_OFFSET = ord("a") - ord("A")


#: Members of sets of states that are looked at to make rules deterministic; some seconds.
_MOST_WORK = 2_000_000


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
    return normalised_ranges(out)


class _CharNfa(Nfa[tuple[CharRange, ...]]):
    """An automaton over ranges of characters."""

    def __init__(self, grammar: Grammar) -> None:
        super().__init__()
        self.grammar = grammar
        self.open_rules: list[str] = []

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
            self.skip(last, end)
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
                return self.repeated(operator, start, lambda before: self.element(item, before))


def automaton_of(grammar: Grammar, rules: Sequence[Rule]) -> CharAutomaton:
    """Return the minimal automaton for the union of the lexer rules."""
    nfa = _CharNfa(grammar)
    ends = frozenset([nfa.choice(((Reference(r.name, (0, 0)),) for r in rules), 0)])
    cuts = sorted(
        {0, MAX_CODE_POINT + 1}
        | {p for edges in nfa.edges for rs, _ in edges for lo, hi in rs or () for p in (lo, hi + 1)}
    )
    index = {nfa.closure(0): 0}
    table: list[dict[int, int]] = []  # targets by class of characters, the number of its first cut
    order = list(index)
    work = 0
    for states in order:  # grows while it is walked
        reached: dict[int, set[int]] = defaultdict(set)
        for ranges, target in (edge for state in states for edge in nfa.edges[state]):
            for low, high in ranges or ():
                letters = range(bisect_left(cuts, low), bisect_left(cuts, high + 1))
                closure = nfa.closure(target)
                work += len(letters) * len(closure)
                if work > _MOST_WORK:
                    what = f"lexer rule {rules[0].name}" if len(rules) == 1 else "the lexer rules"
                    raise GrammarError(f"{what}: the automaton has too many states")
                for letter in letters:
                    reached[letter] |= closure
        row = {}
        for letter in sorted(reached):
            targets = frozenset(reached[letter])
            if targets not in index:
                index[targets] = len(order)
                order.append(targets)
            row[letter] = index[targets]
        table.append(row)
    accepting = [bool(states & ends) for states in order]
    return _minimal(table, accepting, cuts)


def _minimal(
    table: Sequence[Mapping[int, int]], accepting: Sequence[bool], cuts: Sequence[int]
) -> CharAutomaton:
    block = _equivalent(table, accepting)
    number: dict[int, int] = {}
    for b in block:
        number.setdefault(b, len(number))
    edges: list[dict[int, list[CharRange]]] = [{} for _ in number]
    done: set[int] = set()
    for s, row in enumerate(table):
        here = number[block[s]]
        if here in done:
            continue
        done.add(here)
        for letter, target in row.items():
            there = edges[here].setdefault(number[block[target]], [])
            there.append((cuts[letter], cuts[letter + 1] - 1))
    return CharAutomaton(
        tuple({t: normalised_ranges(rs) for t, rs in e.items()} for e in edges),
        frozenset(number[block[s]] for s, a in enumerate(accepting) if a),
    )


def _equivalent(table: Sequence[Mapping[int, int]], accepting: Sequence[bool]) -> list[int]:
    """Return a block for each state, the same for states that accept the same texts.

    This is Hopcroft's algorithm: its cost is that of the edges, times the logarithm of the states.
    """
    sources: list[dict[int, list[int]]] = [defaultdict(list) for _ in table]
    for state, row in enumerate(table):
        for letter, target in row.items():
            sources[target][letter].append(state)
    block = [int(one) for one in accepting]
    blocks = [{s for s, b in enumerate(block) if b == number} for number in (0, 1)]
    waiting = {0, 1}
    while waiting:
        before: dict[int, list[int]] = defaultdict(list)
        for state in blocks[waiting.pop()]:
            for letter, found in sources[state].items():
                before[letter] += found
        for states in before.values():
            parts: dict[int, set[int]] = defaultdict(set)
            for state in states:
                parts[block[state]].add(state)
            for old, part in parts.items():
                blocks[old] -= part
                if not blocks[old]:
                    blocks[old] = part
                    continue
                new = len(blocks)
                blocks.append(part)
                for state in part:
                    block[state] = new
                is_smaller = len(part) <= len(blocks[old])
                waiting.add(new if old in waiting or is_smaller else old)
    return block


def first_characters(automaton: CharAutomaton) -> tuple[CharRange, ...]:
    """Return the characters with which some accepted text begins."""
    return normalised_ranges([r for ranges in automaton.edges[0].values() for r in ranges])


def overlap(left: Sequence[CharRange], right: Sequence[CharRange]) -> bool:
    """Return whether two sets of characters intersect."""
    return any(a <= d and c <= b for a, b in left for c, d in right)


#: Longest path of states. Each state is a group inside the one before, and ``re`` compiles groups
#: recursively.
_LONGEST_WAY = 150
#: States in a pattern, each as often as paths lead to it.
_MOST_PARTS = 5_000


def pattern_of(automaton: CharAutomaton) -> str | None:
    """Return a pattern for ``re`` that matches the longest accepted text, never the empty one.

    Returns ``None`` if the automaton has a cycle through several states, because no such pattern
    exists for it, or if a path is longer than ``re`` can nest groups, or the pattern would be too
    long: it repeats what several paths share.
    """
    on_path: set[int] = set()
    parts = 0

    def of(state: int, *, may_stop: bool) -> str | None:
        nonlocal parts
        parts += 1
        if state in on_path or len(on_path) >= _LONGEST_WAY or parts > _MOST_PARTS:
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
