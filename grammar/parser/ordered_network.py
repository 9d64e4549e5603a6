"""Parser rules as they are written: automata that keep the order and the places of the text.

Where `grammar.parser.network` merges all that accepts the same, here every way through a rule is
one way through its text. Steps out of a state are in the order in which ANTLR prefers them:
alternatives as they are written, an optional part before its absence, one more round of a loop
before its end. Of all ways to read something, ANTLR takes the first one in that order.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal as OneOf

from grammar.notation.addresses import Address
from grammar.notation.model import Alternative, CharSet, Element, Grammar, Group, Repeat, Rule
from support.lazy_dataclass import dataclass

#: States of every rule.
FIRST, LAST = 0, 1

#: What a step without a symbol means: an alternative begins, a part with a suffix begins, a round
#: of it begins, the part ends.
Sign = OneOf["alternative", "part", "round", "end"]


@dataclass(frozen=True, slots=True)
class Step:
    """A step to the state ``target``: over ``symbol``, the name of a token or a rule, or over none.

    ``at`` is the address (`grammar.notation.addresses`) of what the step is about: of the element
    for a symbol, of the alternative or of the element with the suffix for a ``sign``.
    """

    target: int
    symbol: str | None
    sign: Sign | None
    at: Address


@dataclass(frozen=True, slots=True)
class OrderedAutomaton:
    """``steps[state]`` are the steps out of a state in order, `FIRST` and `LAST` among them."""

    steps: tuple[tuple[Step, ...], ...]

    def moves(self, state: int) -> list[tuple[str, int] | None]:
        """What comes next from a state, best first: a symbol and the state after it.

        ``None`` stands for the end of the rule. Each is given once, where it is best.
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
    """The automaton of one parser rule."""
    building = _Building(grammar)
    building.choice(rule.alternatives, FIRST, LAST, ())
    return OrderedAutomaton(tuple(map(tuple, building.steps)))


class _Building:
    """Thompson's construction, each step where it comes in the text."""

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
