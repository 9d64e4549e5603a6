"""The automaton of a parser rule: deterministic and minimal, over the names of tokens and rules.

It is built once for the text of a rule and shared by every grammar with that rule. The network
(`grammar.parser.network`) links the automata of all rules; `grammar.parser.lexer_automaton` has the
automaton over characters.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from grammar.notation.model import Element, Grammar, Group, Literal, Reference, Repeat, Rule, walk
from grammar.parser.nfa import Nfa
from support.lazy_dataclass import dataclass

Symbol = str  # the name of a token or a rule


@dataclass(frozen=True, slots=True)
class RuleAutomaton:
    """The minimal automaton of one rule; state 0 is its start.

    ``edges[state]`` maps a symbol to the next state. ``places[state]`` are the addresses
    (`grammar.notation.addresses`) of the elements that can come next in that state; the number of
    the last element plus one stands for the end of a sequence.
    """

    edges: tuple[Mapping[Symbol, int], ...]
    final: frozenset[int]
    places: tuple[frozenset[tuple[int, ...]], ...]


_automata: dict[tuple[str, tuple[tuple[str, str], ...]], RuleAutomaton] = {}


def rule_automaton(grammar: Grammar, rule: Rule) -> RuleAutomaton:
    """Return the minimal automaton of one parser rule over the names of tokens and rules."""
    names = _names(grammar, rule)
    key = (rule.text, tuple(sorted(names.items())))
    found = _automata.get(key)
    if found is None:
        if len(_automata) >= 4_000:
            _automata.clear()
        fragments = _Fragments(names)
        end = fragments.choice((a.elements for a in rule.alternatives), 0)
        found = _automata[key] = _minimal(*_subsets(fragments, 0, end))
    return found


def exact_automata(grammar: Grammar, rule: Rule) -> Callable[[tuple[int, ...]], RuleAutomaton]:
    """Return a function that gives the automaton of a rule from an address on.

    The empty address stands for the start of the rule. Unlike in the minimal automaton, a state
    stands before an element only if the rule as written can be there after what has been read, and
    no edge leads back to the start. In ``places``, the address of a repetition followed by 0 is the
    place where another item may begin, followed by -1 the place after an item.
    """
    fragments = _Fragments(_names(grammar, rule), is_split=True)
    end = fragments.choice((a.elements for a in rule.alternatives), 0)
    state_of = {at: state for state, found in fragments.places.items() for at in found}

    def automaton(at: tuple[int, ...]) -> RuleAutomaton:
        start = state_of[at] if at else 0
        table, final, places = _subsets(fragments, start, end, is_apart=True)
        ends = frozenset(state for state, is_final in enumerate(final) if is_final)
        return RuleAutomaton(tuple(table), ends, tuple(map(frozenset, places)))

    return automaton


def _names(grammar: Grammar, rule: Rule) -> dict[str, str]:
    """Return the token names of the literals in a rule."""
    quoted = {e.text for e in walk(rule) if isinstance(e, Literal)}
    return {text: grammar.literal_tokens[grammar.fold(text)] for text in quoted}


class _Fragments(Nfa[Symbol]):
    """An automaton over symbols, which knows the addresses of its states.

    Alternatives begin in one common state or, if ``is_split``, each in a state of its own.
    """

    def __init__(self, names: Mapping[str, str], *, is_split: bool = False) -> None:
        super().__init__()
        self.names = names
        self.is_split = is_split
        self.places: dict[int, list[tuple[int, ...]]] = {}

    def choice(
        self, sequences: Iterable[tuple[Element, ...]], start: int, address: tuple[int, ...] = ()
    ) -> int:
        end = self.state()
        for number, elements in enumerate(sequences, 1):
            last = start
            if self.is_split:
                last = self.state()
                self.skip(start, last)
            for place, element in enumerate(elements, 1):
                self.places.setdefault(last, []).append((*address, number, place))
                last = self.element(element, last, (*address, number, place))
            self.places.setdefault(last, []).append((*address, number, len(elements) + 1))
            self.skip(last, end)
        return end

    def element(self, element: Element, start: int, address: tuple[int, ...]) -> int:
        match element:
            case Reference(name=name):
                return self.step(name, start)
            case Literal(text=text):
                return self.step(self.names[text], start)
            case Group(alternatives=alternatives):
                return self.choice((a.elements for a in alternatives), start, address)
            case Repeat(item=item, operator=operator):

                def added(before: int) -> int:
                    end = self.element(item, before, address)
                    if self.is_split:  # before another item, and after one
                        self.places.setdefault(before, []).append((*address, 0))
                        self.places.setdefault(end, []).append((*address, -1))
                    return end

                return self.repeated(operator, start, added)
            case _:
                raise AssertionError("sets of characters do not occur in parser rules")


def _subsets(
    fragments: _Fragments,
    start: int,
    end: int,
    *,
    is_apart: bool = False,
) -> tuple[list[dict[Symbol, int]], list[bool], list[set[tuple[int, ...]]]]:
    """Return the states of the subset construction: edges, whether each is final, and places.

    If ``is_apart``, no edge leads back to the start.
    """
    order = [fragments.closure(start)]
    index = {} if is_apart else {order[0]: 0}
    table: list[dict[Symbol, int]] = []
    for states in order:  # grows while it is walked
        targets: dict[Symbol, set[int]] = {}
        for state in sorted(states):
            for symbol, target in fragments.edges[state]:
                if symbol is not None:
                    targets.setdefault(symbol, set()).add(target)
        row: dict[Symbol, int] = {}
        for symbol, raw in targets.items():
            first, *others = map(fragments.closure, raw)
            closed = first.union(*others) if others else first
            if closed not in index:
                index[closed] = len(order)
                order.append(closed)
            row[symbol] = index[closed]
        table.append(row)
    places = [{a for s in states for a in fragments.places.get(s, ())} for states in order]
    return table, [end in states for states in order], places


def _minimal(
    table: list[dict[Symbol, int]], final: list[bool], places: list[set[tuple[int, ...]]]
) -> RuleAutomaton:
    block = _blocks(table, final)
    number: dict[int, int] = {}
    for b in block:  # states keep the order in which they are met; the start stays 0
        number.setdefault(b, len(number))
    edges: list[dict[Symbol, int]] = [{} for _ in number]
    merged: list[set[tuple[int, ...]]] = [set() for _ in number]
    for s, row in enumerate(table):
        edges[number[block[s]]] = {symbol: number[block[t]] for symbol, t in row.items()}
        merged[number[block[s]]] |= places[s]
    return RuleAutomaton(
        tuple(edges),
        frozenset(number[block[s]] for s, f in enumerate(final) if f),
        tuple(map(frozenset, merged)),
    )


def _blocks(table: Sequence[Mapping[Symbol, int]], final: Sequence[bool]) -> list[int]:
    """Return a number for each state, the same for states from which the same can follow.

    This is Hopcroft's algorithm: a block is divided by the states that lead into another one, and
    only the smaller half is looked at again.
    """
    before: list[dict[Symbol, list[int]]] = [{} for _ in table]
    kinds: dict[object, int] = {}
    block: list[int] = []
    for state, row in enumerate(table):
        # what can follow at once tells states apart, so that each state of a block has each edge
        block.append(kinds.setdefault((final[state], frozenset(row)), len(kinds)))
        for symbol, target in row.items():
            before[target].setdefault(symbol, []).append(state)
    members: list[set[int]] = [set() for _ in kinds]
    for state, number in enumerate(block):
        members[number].add(state)
    todo = set(range(len(members)))
    while todo:
        leading: dict[Symbol, set[int]] = {}
        for target in members[todo.pop()]:
            for symbol, states in before[target].items():
                leading.setdefault(symbol, set()).update(states)
        for found in leading.values():
            parts: dict[int, set[int]] = {}
            for state in found:
                parts.setdefault(block[state], set()).add(state)
            for number, part in parts.items():
                whole = members[number]
                if len(part) == len(whole):
                    continue
                whole -= part
                for state in part:
                    block[state] = len(members)
                is_smaller = number in todo or len(part) <= len(whole)
                todo.add(len(members) if is_smaller else number)
                members.append(part)
    return block
