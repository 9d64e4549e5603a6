"""All readings of some tokens under a grammar, found by trying everything as it is written."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from grammar.notation.addresses import Address
from grammar.notation.model import Alternative, Element, Grammar, Group, Literal, Reference, Repeat
from grammar.parser.tree import ParseNode

#: A tree as a test writes it: a rule and what it was made of, tokens as their names.
Plain = tuple[object, ...]
#: What is met on a way through a rule: an alternative with its number, a part with a suffix with
#: its rounds, or a symbol, each with its address.
Met = tuple[tuple[str, Address, int], ...]

_MOST = 4_000


def plain(node: ParseNode) -> Plain:
    """The tree of a node."""
    below = [plain(c) if isinstance(c, ParseNode) else c.kind for c in node.children]
    return (node.rule, *below)


@dataclass(frozen=True, slots=True)
class Way:
    """A way through a part of a rule: what it reads, what it meets, and where it ends."""

    below: Plain
    met: Met
    end: int


class Readings:
    """The trees of some tokens, in the order in which ANTLR prefers them, each once.

    Of rounds of a loop that read nothing two in a row are tried: more would go on for ever.
    """

    def __init__(self, grammar: Grammar, tokens: Sequence[str]) -> None:
        self.grammar = grammar
        self.tokens = tokens
        self._known: dict[tuple[str, int], tuple[tuple[Plain, int], ...]] = {}

    def __iter__(self) -> Iterator[Plain]:
        whole = self._of_rule(self.grammar.start, 0)
        return (tree for tree, end in whole if end == len(self.tokens))

    def _of_rule(self, name: str, at: int) -> tuple[tuple[Plain, int], ...]:
        if (name, at) not in self._known:
            ways = self.ways(self.grammar.by_name[name].alternatives, (), at)
            found = (((name, *way.below), way.end) for way in islice(ways, _MOST))
            self._known[name, at] = tuple(dict.fromkeys(found))
        return self._known[name, at]

    def ways(self, alternatives: Sequence[Alternative], at: Address, start: int) -> Iterator[Way]:
        """The ways through some alternatives at an address, from a token on."""
        for number, alternative in enumerate(alternatives, 1):
            for way in self._in_row(alternative.elements, (*at, number), 1, start):
                yield Way(way.below, (("taken", at, number), *way.met), way.end)

    def _in_row(
        self, elements: Sequence[Element], at: Address, place: int, start: int
    ) -> Iterator[Way]:
        if not elements:
            yield Way((), (), start)
            return
        for first in self._of(elements[0], (*at, place), start):
            for rest in self._in_row(elements[1:], at, place + 1, first.end):
                yield Way((*first.below, *rest.below), (*first.met, *rest.met), rest.end)

    def _of(self, element: Element, at: Address, start: int) -> Iterator[Way]:
        match element:
            case Group(alternatives=alternatives):
                yield from self.ways(alternatives, at, start)
            case Repeat(item=item, operator=operator):
                for way, rounds in self._rounds(item, operator, at, start, 2):
                    yield Way(way.below, (*way.met, ("rounds", at, rounds)), way.end)
            case Reference() | Literal():
                met: Met = (("symbol", at, 0),)
                name = self.grammar.token_of(element)
                rule = self.grammar.by_name.get(name)
                if rule is not None and not rule.is_lexer:
                    for tree, end in self._of_rule(name, start):
                        yield Way((tree,), met, end)
                elif self.tokens[start : start + 1] == [name]:
                    yield Way((name,), met, start + 1)
            case _:
                raise AssertionError(element)

    def _rounds(
        self, item: Element, operator: str, at: Address, start: int, idle: int
    ) -> Iterator[tuple[Way, int]]:
        for first in self._of(item, at, start):
            left = 2 if first.end != start else idle - 1
            if left >= 0 and operator != "?":
                for rest, rounds in self._rounds(item, "*", at, first.end, left):
                    yield (
                        Way((*first.below, *rest.below), (*first.met, *rest.met), rest.end),
                        rounds + 1,
                    )
            elif operator == "?":
                yield first, 1
        if operator != "+":
            yield Way((), (), start), 0


def first_way(grammar: Grammar, node: ParseNode) -> Met:
    """What is met on the way that ANTLR prefers from the children of a node through its rule."""
    symbols = [c.rule if isinstance(c, ParseNode) else c.kind for c in node.children]
    alternatives = grammar.by_name[node.rule].alternatives
    ways = _OfNode(grammar, symbols).ways(alternatives, (), 0)
    return next(way.met for way in ways if way.end == len(symbols))


class _OfNode(Readings):
    """Readings in which a rule is one symbol."""

    def _of_rule(self, name: str, at: int) -> tuple[tuple[Plain, int], ...]:
        return (((name,), at + 1),) if self.tokens[at : at + 1] == [name] else ()
