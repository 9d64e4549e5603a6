"""Parser rules as they are written: automata that keep the order and the addresses of the text.

The automata of `grammar.parser.network` are minimal; here every path through an automaton is one
path through the text of the rule. The steps out of a state are in the order in which ANTLR prefers
them: alternatives as they are written, an optional part before its absence, one more round of a
loop before its end. Of all paths that read a text, ANTLR takes the first in this order.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal as OneOf

from grammar.notation.addresses import Address
from grammar.notation.model import Alternative, CharSet, Element, Grammar, Group, Repeat, Rule
from support.lazy_dataclass import dataclass

#: States of every rule.
FIRST, LAST = 0, 1

#: Meaning of a step without a symbol: an alternative begins, a part with a suffix begins, a round
#: of it begins, or the part ends.
Sign = OneOf["alternative", "part", "round", "end"]


@dataclass(frozen=True, slots=True)
class Step:
    """A step to the state ``target`` that reads ``symbol``, a token or a rule, or nothing.

    ``at`` is the address (`grammar.notation.addresses`) of the element with that symbol or, for a
    ``sign``, of the alternative or the element with the suffix.
    """

    target: int
    symbol: str | None
    sign: Sign | None
    at: Address


@dataclass(frozen=True, slots=True)
class OrderedAutomaton:
    """The automaton of a rule; ``steps[state]`` are the steps out of a state, preferred first."""

    steps: tuple[tuple[Step, ...], ...]

    @property
    def stops(self) -> list[int]:
        """The states between symbols, which `moves` lead to, the first one first."""
        targets = (step.target for steps in self.steps for step in steps if step.symbol is not None)
        return [FIRST, *targets]

    def moves(self, state: int) -> list[tuple[str, int] | None]:
        """Return the symbols that can come next with the state after each, the preferred first.

        ``None`` stands for the end of the rule. Each move is listed once.
        """
        found: dict[tuple[str, int] | None, None] = {}
        seen = set()
        todo: list[Step | int] = [state]
        while todo:
            here = todo.pop()
            if isinstance(here, Step):
                if here.symbol is not None:
                    found.setdefault((here.symbol, here.target))
                    continue
                here = here.target
            if here not in seen:
                seen.add(here)
                if here == LAST:
                    found.setdefault(None)
                todo += reversed(self.steps[here])
        return list(found)


def ordered_automaton(grammar: Grammar, rule: Rule) -> OrderedAutomaton:
    """Return the automaton of one parser rule."""
    building = _Building(grammar)
    building.choice(rule.alternatives, FIRST, LAST, ())
    return OrderedAutomaton(tuple(map(tuple, building.steps)))


class _Building:
    """Thompson's construction that keeps the order of the text."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self.steps: list[list[Step]] = [[], []]

    def state(self) -> int:
        self.steps.append([])
        return len(self.steps) - 1

    def step(
        self, start: int, end: int, at: Address, symbol: str | None = None, sign: Sign | None = None
    ) -> None:
        self.steps[start].append(Step(end, symbol, sign, at))

    def choice(
        self, alternatives: Sequence[Alternative], start: int, end: int, at: Address
    ) -> None:
        for number, alternative in enumerate(alternatives, 1):
            here = (*at, number)
            last = self.state()
            self.step(start, last, here, sign="alternative")
            for place, element in enumerate(alternative.elements, 1):
                following = self.state()
                self.element(element, last, following, (*here, place))
                last = following
            self.step(last, end, here)

    def element(self, element: Element, start: int, end: int, at: Address) -> None:
        match element:
            case Group(alternatives=alternatives):
                self.choice(alternatives, start, end, at)
            case Repeat(item=item, operator=operator):
                before, inside, after = self.state(), self.state(), self.state()
                self.step(start, before, at, sign="part")
                self.step(before, inside, at, sign="round")
                self.element(item, inside, after, at)
                if operator != "+":
                    self.step(before, end, at, sign="end")
                if operator != "?":
                    self.step(after, inside, at, sign="round")
                self.step(after, end, at, sign="end")
            case CharSet():
                raise AssertionError("sets of characters do not occur in parser rules")
            case _:
                self.step(start, end, at, symbol=self.grammar.token_of(element))
