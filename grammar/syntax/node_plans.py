"""Plans: how the nodes of a line are built, computed once for each `Outline`.

Lines with the same structure share an outline and differ only in the texts of their tokens. So the
rules of `grammar.syntax.statement_rules` and `grammar.syntax.expression_rules` do not build nodes.
They draft a plan, which is a list of steps: which node, over which tokens, from which values.
`Plan.run` then builds the nodes of one line with one call for each. Lines of different structure
have parts in common; the steps of a part are copied from the draft in which it was met first.

A plan works on a list of values: first the texts of the tokens, then constants, the spans of nodes,
and the result of each step in order. An outline is drafted without recursion, so the only limit on
nesting is the one set here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Any

from grammar.parser.tree import Outline
from grammar.syntax.ast import Call, Span
from grammar.syntax.parts import Field, Part
from support.lazy_dataclass import dataclass

#: Greatest depth of nodes within a line; a chain of operators counts once. Code that walks an
#: expression relies on it and recurses, except along `grammar.syntax.walk.left_chain`.
MAX_DEPTH = 200
# No node needs more than the three rules of a call, so deeper rules are certainly too deep.
_MOST_FRAMES = 3 * MAX_DEPTH + 10
# Slots of a draft from here on are results of steps, those below are tokens, and negative ones
# constants. No line has so many tokens.
_RESULTS = 1 << 29
# The cache of parts is bounded, and enormous ones are not cached.
_MOST_REMEMBERED = 20_000
_WIDEST_REMEMBERED = 1_000

#: The result of a rule: a slot in the list of values, a constant, or a sequence of these.
Value = int | str | bool | None | tuple["Value", ...]
Parts = Sequence[Part[Value]]


class TooDeep(Exception):
    """A node is deeper than `MAX_DEPTH`; ``first`` is the index of its first token."""

    def __init__(self, first: int) -> None:
        super().__init__(first)
        self.first = first


class NoNode(Exception):
    """The grammar reads a form of a rule that no function here expects."""

    def __init__(self, rule: str) -> None:
        super().__init__(rule)
        self.rule = rule

    def __str__(self) -> str:
        return (
            f"the syntax tree has no node for a form of {self.rule} that the grammar reads: see "
            "CONTRIBUTING.md, the recipe for constructs, step 6"
        )


#: What makes a node, its first and last token, and the slots of its parts.
_Step = tuple[Callable[..., object], int, int, tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class _Part:
    """What a rule adds to a draft, as it did from the token ``first`` and the step ``start`` on.

    ``height`` is that of the rules within it.
    """

    first: int
    start: int
    steps: Sequence[_Step]
    depths: Sequence[int]
    value: Value
    height: int


class Draft:
    """A plan that is being built; ``constants`` has the slots of those of many drafts."""

    def __init__(self, width: int, constants: dict[tuple[type, object], int]) -> None:
        self._width = width
        self._constants = constants
        self.steps: list[_Step] = []
        self.depths: list[int] = []

    def node(
        self,
        make: Callable[..., object],
        first: int,
        stop: int,
        *values: Value,
        chain: int | None = None,
    ) -> int:
        """Add a step that calls ``make`` with a span and ``values``; return the slot of its result.

        The node in the slot ``chain`` does not add to the depth: it is an earlier part of the same
        chain of operators.
        """
        slots = tuple(map(self._slot, values))
        depth = 1
        for slot in slots:
            if slot >= _RESULTS:
                depth = max(depth, self.depths[slot - _RESULTS] + (slot != chain))
        if depth > MAX_DEPTH:
            raise TooDeep(first)
        self.steps.append((make, first, stop - 1, slots))
        self.depths.append(depth)
        return _RESULTS + len(self.steps) - 1

    def copy(self, part: _Part, first: int) -> Value:
        """Add the steps of a part that begins with the token ``first``; return its result."""
        tokens, results = first - part.first, len(self.steps) - part.start
        for make, begin, last, slots in part.steps:
            moved = [s if s < 0 else s + (tokens if s < _RESULTS else results) for s in slots]
            self.steps.append((make, begin + tokens, last + tokens, tuple(moved)))
        self.depths += part.depths
        return _moved(part.value, tokens, results)

    def over(self, make: Callable[..., object], parts: Parts, *values: Value) -> int:
        """Add a step whose span is that of ``parts``; return the slot of its result."""
        return self.node(make, parts[0].first, parts[-1].stop, *values)

    def _slot(self, value: Value) -> int:
        """Return the slot of a value; a constant has a negative one until its number is known."""
        if type(value) is int:
            return value
        if isinstance(value, tuple) and not _is_constant(value):
            return self.node(_sequence, 0, 1, *value)
        return self._constants.setdefault((type(value), value), ~len(self._constants))

    def plan(self, value: Value) -> Plan:
        """Return the finished plan with ``value`` as its result."""
        result, width = self._slot(value), self._width
        used = dict.fromkeys(slot for step in self.steps for slot in step[3] if slot < 0)
        used |= {result: None} if result < 0 else {}
        place = {slot: width + index for index, slot in enumerate(used)}
        known = [value for _, value in self._constants]
        spans: dict[Span, int] = {}
        made = [
            (make, spans.setdefault((0, 0) if make is _sequence else (first, last), len(spans)))
            for make, first, last, _ in self.steps
        ]
        at_spans = width + len(used)
        results = at_spans + len(spans) - _RESULTS

        def final(slot: int) -> int:
            return place[slot] if slot < 0 else slot if slot < _RESULTS else slot + results

        steps = tuple(
            (make, _getter([at_spans + span, *map(final, step[3])]))
            for (make, span), step in zip(made, self.steps, strict=True)
        )
        constants = tuple(known[~slot] for slot in used)
        calls = tuple(first for make, first, _, _ in self.steps if make is Call)
        return Plan(width, constants, tuple(spans), steps, final(result), calls)


@dataclass(frozen=True, slots=True)
class Plan:
    """Builds the nodes of all lines with one outline, which has ``width`` tokens.

    ``spans`` are the first and the last token of nodes; each of the ``steps`` is what makes a node,
    and what takes its span and its parts from the values. ``calls`` are the tokens that name the
    routines called.
    """

    width: int
    constants: tuple[object, ...]
    spans: tuple[Span, ...]
    steps: tuple[tuple[Callable[..., object], Callable[[list[Any]], Any]], ...]
    result: int
    calls: tuple[int, ...]

    def run(
        self, lexemes: Sequence[str], starts: Sequence[int], ends: Sequence[int], first: int
    ) -> Any:
        """Return the node built from the tokens from ``first`` on.

        ``lexemes``, ``starts`` and ``ends`` are the texts of all tokens and their offsets.
        """
        values: list[Any] = [*lexemes[first : first + self.width], *self.constants]
        values += [(starts[first + begin], ends[first + last]) for begin, last in self.spans]
        add = values.append
        for make, get in self.steps:
            add(make(*get(values)))
        return values[self.result]


#: Drafts the nodes of a rule of the grammar from its children and returns its result.
Rule = Callable[[Draft, Parts], Value]


def node(kind: Callable[..., object], *of: Field) -> Rule:
    """Return a function for a rule whose node has these fields."""
    return lambda draft, parts: draft.over(kind, parts, *(field(parts) for field in of))


class Drafter:
    """Drafts the plans of a grammar; caches what rules add to them.

    ``names`` are the token names by kind. A rule in ``chains`` is skipped if its only child is a
    rule.
    """

    def __init__(
        self, names: Sequence[str], rules: Mapping[str, Rule], chains: frozenset[str]
    ) -> None:
        self._names = names
        self._rules = rules
        self._chains = chains
        self._constants: dict[tuple[type, object], int] = {}
        self._parts: dict[Outline, _Part] = {}

    def plan(self, outline: Outline) -> Plan:
        """Return the plan of an outline.

        Raises `TooDeep`, and `NoNode` where the rules do not know what the grammar reads.
        """
        if len(self._parts) >= _MOST_REMEMBERED:
            self._parts.clear()
        plan = Draft(outline.width, self._constants)
        frames = [_Frame(outline, 0, 0, self._chains)]
        while True:
            frame = frames[-1]
            if len(frames) > _MOST_FRAMES:
                raise TooDeep(frame.first)
            if frame.inner.rule not in self._rules:
                raise NoNode(frame.inner.rule)
            if frame.place < len(frame.inner.children):
                child = frame.inner.children[frame.place]
                frame.place += 1
                at = frame.at
                if not isinstance(child, Outline):
                    frame.at += 1
                    frame.parts.append(Part(self._names[child], at, at, at + 1))
                    continue
                part = self._parts.get(child)
                if part is None or len(frames) + part.height > _MOST_FRAMES:
                    frames.append(_Frame(child, at, len(plan.steps), self._chains))
                    continue
                value = plan.copy(part, at)
            else:
                frames.pop()
                value = self._value(plan, frame)
                if not frames:
                    return plan.plan(value)
                child, part = frame.outline, self._kept(plan, frame, value)
                at, frame = frame.first, frames[-1]
            frame.height = max(frame.height, part.height + 1)
            frame.at += child.width
            frame.parts.append(Part(child.rule, value, at, frame.at))

    def _value(self, plan: Draft, frame: _Frame) -> Value:
        rule = frame.inner.rule
        try:
            return self._rules[rule](plan, frame.parts)
        except (AssertionError, LookupError, TypeError, ValueError) as error:
            raise NoNode(rule) from error

    def _kept(self, plan: Draft, frame: _Frame, value: Value) -> _Part:
        """Return what a rule has added to a plan, and keep it for others."""
        first, start = frame.first, frame.start
        steps, depths = plan.steps[start:], plan.depths[start:]
        part = _Part(first, start, steps, depths, value, frame.height)
        if frame.outline.width <= _WIDEST_REMEMBERED:
            self._parts[frame.outline] = part
        return part


class _Frame:
    """A rule whose children are being drafted, from a step of the draft on."""

    __slots__ = ("at", "first", "height", "inner", "outline", "parts", "place", "start")

    def __init__(self, outline: Outline, first: int, start: int, chains: frozenset[str]) -> None:
        self.outline = outline
        self.inner = _inner(outline, chains)
        self.first = self.at = first
        self.start = start
        self.parts: list[Part[Value]] = []
        self.place = 0
        self.height = 1


def _inner(outline: Outline, chains: frozenset[str]) -> Outline:
    while outline.rule in chains and len(outline.children) == 1:
        only = outline.children[0]
        if not isinstance(only, Outline):
            break
        outline = only
    return outline


def _moved(value: Value, tokens: int, results: int) -> Value:
    """Return the result of a part at another place."""
    if isinstance(value, tuple):
        return tuple(_moved(one, tokens, results) for one in value)
    if type(value) is not int:
        return value
    return value + (tokens if value < _RESULTS else results)


def _is_constant(value: Value) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_constant, value))
    return type(value) is not int


def _sequence(_span: Span, *items: object) -> tuple[object, ...]:
    return items


def _getter(slots: list[int]) -> Callable[[list[Any]], Any]:
    """Return a function that takes the values in ``slots`` from a list, as a sequence."""
    if len(slots) > 1:
        return itemgetter(*slots)
    (only,) = slots
    return itemgetter(slice(only, only + 1))
