"""Plans: how the nodes of a line are made, worked out once for each `Outline`.

Lines that are built alike share an outline, and differ only in the texts of their tokens. So the
rules of `grammar.syntax.statement_rules` and `grammar.syntax.expression_rules` do not make nodes.
They draft a plan, a list of steps: which node, over which tokens, from which values. `Plan.run`
then makes the nodes of one line: a call for each.

A plan works on a list of values. It begins with the texts of the tokens, then come constants, then
the result of each step in order. Drafting goes through the outline without recursion, so depth of
nesting meets the limit that is set here and no other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from grammar.parser.tree import Outline
from grammar.syntax.ast import Span
from support.lazy_dataclass import dataclass

#: How deep nodes may lie within a line, chains of operators counted once. Whoever walks an
#: expression may rely on it and recurse, but for `grammar.syntax.walk.left_chain`.
MAX_DEPTH = 200
# A call has three rules for its one node, nothing has more: no need to draft what is far too deep.
_MOST_FRAMES = 3 * MAX_DEPTH + 10

#: What a rule comes to: a slot in the list of values, a constant, or a sequence of these.
Value = int | str | bool | None | tuple["Value", ...]


class TooDeep(Exception):
    """A node lies deeper than `MAX_DEPTH`; ``first`` is the index of its first token."""

    def __init__(self, first: int) -> None:
        super().__init__(first)
        self.first = first


class DraftPart(NamedTuple):
    """A child of a rule: a token by its name, its value its slot, or a rule and what it came to.

    ``first`` and ``stop`` are indices of tokens, as in a tree.
    """

    symbol: str
    value: Value
    first: int
    stop: int


class Draft:
    """A plan in the making."""

    def __init__(self, width: int) -> None:
        self._width = width
        self._constants: dict[tuple[type, object], int] = {}
        self._steps: list[tuple[Callable[..., object], int, int, tuple[int, ...]]] = []
        self._depths: list[int] = []

    def node(
        self,
        make: Callable[..., object],
        first: int,
        stop: int,
        *values: Value,
        chain: int | None = None,
    ) -> int:
        """A step: ``make`` called with a span and ``values``; returns the slot of its result.

        The node at the slot ``chain`` lies no deeper for it: it is the same chain, begun before.
        """
        slots = tuple(map(self._slot, values))
        depth = max(
            (self._depths[s - self._width] + (s != chain) for s in slots if s >= self._width),
            default=1,
        )
        if depth > MAX_DEPTH:
            raise TooDeep(first)
        self._steps.append((make, first, stop - 1, slots))
        self._depths.append(depth)
        return self._width + len(self._steps) - 1

    def over(self, make: Callable[..., object], parts: Sequence[DraftPart], *values: Value) -> int:
        """A step whose span is that of ``parts``."""
        return self.node(make, parts[0].first, parts[-1].stop, *values)

    def _slot(self, value: Value) -> int:
        """The slot of a value; constants have negative ones while their number is not known."""
        if type(value) is int:
            return value
        if isinstance(value, tuple) and not _is_constant(value):
            return self.node(_sequence, 0, 1, *value)
        return ~self._constants.setdefault((type(value), value), len(self._constants))

    def plan(self, value: Value) -> Plan:
        """The plan, once all is drafted, whose result is ``value``."""
        result = self._slot(value)
        width, count = self._width, len(self._constants)

        def final(slot: int) -> int:
            return width + ~slot if slot < 0 else slot if slot < width else slot + count

        steps = tuple(
            (make, first, last, _getter([*map(final, slots)]))
            for make, first, last, slots in self._steps
        )
        return Plan(width, tuple(value for _, value in self._constants), steps, final(result))


@dataclass(frozen=True, slots=True)
class Plan:
    """Makes the nodes of lines that share an outline; ``width`` tokens each."""

    width: int
    constants: tuple[object, ...]
    steps: tuple[tuple[Callable[..., object], int, int, Callable[[list[Any]], Any]], ...]
    result: int

    def run(
        self, lexemes: Sequence[str], starts: Sequence[int], ends: Sequence[int], first: int
    ) -> Any:
        """What the tokens from ``first`` on become.

        ``lexemes``, ``starts`` and ``ends`` are the texts of all tokens and their offsets.
        """
        values: list[Any] = [*lexemes[first : first + self.width], *self.constants]
        add = values.append
        for make, begin, last, get in self.steps:
            add(make((starts[first + begin], ends[first + last]), *get(values)))
        return values[self.result]


#: What a rule of the grammar comes to, given what it consists of.
Rule = Callable[[Draft, Sequence[DraftPart]], Value]


def draft(
    outline: Outline, names: Sequence[str], rules: Mapping[str, Rule], chains: frozenset[str]
) -> Plan:
    """The plan of an outline.

    ``names`` are those of kinds of tokens. Rules in ``chains`` mean nothing of their own where they
    have but one child, a rule. Raises `TooDeep`.
    """
    plan = Draft(outline.width)
    top: list[DraftPart] = []
    frames = [_Frame(outline, 0, top, chains)]
    while frames:
        frame = frames[-1]
        if len(frames) > _MOST_FRAMES:
            raise TooDeep(frame.first)
        if frame.place < len(frame.inner.children):
            child = frame.inner.children[frame.place]
            frame.place += 1
            at = frame.at
            if isinstance(child, Outline):
                frame.at += child.width
                frames.append(_Frame(child, at, frame.parts, chains))
            else:
                frame.at += 1
                frame.parts.append(DraftPart(names[child], at, at, at + 1))
        else:
            frames.pop()
            value = rules[frame.inner.rule](plan, frame.parts)
            frame.above.append(DraftPart(frame.outline.rule, value, frame.first, frame.at))
    return plan.plan(top[0].value)


class _Frame:
    """A rule whose children are being drafted; ``above`` is where its own part goes."""

    __slots__ = ("above", "at", "first", "inner", "outline", "parts", "place")

    def __init__(
        self, outline: Outline, first: int, above: list[DraftPart], chains: frozenset[str]
    ) -> None:
        self.outline = outline
        self.inner = _inner(outline, chains)
        self.first = self.at = first
        self.above = above
        self.parts: list[DraftPart] = []
        self.place = 0


def _inner(outline: Outline, chains: frozenset[str]) -> Outline:
    while outline.rule in chains and len(outline.children) == 1:
        only = outline.children[0]
        if not isinstance(only, Outline):
            break
        outline = only
    return outline


def _is_constant(value: Value) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_constant, value))
    return type(value) is not int


def _sequence(_span: Span, *items: object) -> tuple[object, ...]:
    return items


def _getter(slots: list[int]) -> Callable[[list[Any]], Any]:
    """What takes the values in ``slots`` from a list, as a sequence."""
    if len(slots) > 1:
        return itemgetter(*slots)
    only = slots[0] if slots else 0
    return itemgetter(slice(only, only + len(slots)))


# -------------------------------------------------------------------------- choices from the parts


def value_of(parts: Sequence[DraftPart], symbol: str) -> Value:
    """What the first part of this kind came to; ``None`` where there is none."""
    return next((part.value for part in parts if part.symbol == symbol), None)


def values_of(parts: Sequence[DraftPart], symbol: str) -> tuple[Value, ...]:
    """What all parts of this kind came to, in their order."""
    return tuple(part.value for part in parts if part.symbol == symbol)


def has(parts: Sequence[DraftPart], symbol: str) -> bool:
    """Whether there is a part of this kind."""
    return any(part.symbol == symbol for part in parts)


def after(parts: Sequence[DraftPart], symbol: str) -> Value:
    """What the part two after a keyword came to, an equals sign between; ``None`` without it."""
    for place, part in enumerate(parts):
        if part.symbol == symbol:
            return parts[place + 2].value
    return None


def separated(parts: Sequence[DraftPart]) -> tuple[Value, ...]:
    """What commas separate, ``None`` for what is left out."""
    items: list[Value] = [None]
    for part in parts:
        if part.symbol == "COMMA":
            items.append(None)
        else:
            items[-1] = part.value
    return tuple(items)
