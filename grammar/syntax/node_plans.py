"""Plans: how the nodes of a line are built, computed once for each `Outline`.

Lines with the same structure share an outline and differ only in the texts of their tokens. So the
rules of `grammar.syntax.statement_rules` and `grammar.syntax.expression_rules` do not build nodes.
They draft a plan, which is a list of steps: which node, over which tokens, from which values.
`Plan.run` then builds the nodes of one line with one call for each.

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


class Draft:
    """A plan that is being built."""

    def __init__(self, width: int) -> None:
        self._width = width
        self._constants: dict[tuple[type, object], int] = {}
        self._spans: dict[Span, int] = {}
        self._steps: list[tuple[Callable[..., object], int, tuple[int, ...]]] = []
        self._depths: list[int] = []

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
        depth = max(
            (self._depths[s - self._width] + (s != chain) for s in slots if s >= self._width),
            default=1,
        )
        if depth > MAX_DEPTH:
            raise TooDeep(first)
        span = self._spans.setdefault((first, stop - 1), len(self._spans))
        self._steps.append((make, span, slots))
        self._depths.append(depth)
        return self._width + len(self._steps) - 1

    def over(self, make: Callable[..., object], parts: Parts, *values: Value) -> int:
        """Add a step whose span is that of ``parts``; return the slot of its result."""
        return self.node(make, parts[0].first, parts[-1].stop, *values)

    def _slot(self, value: Value) -> int:
        """Return the slot of a value; a constant has a negative one until its number is known."""
        if type(value) is int:
            return value
        if isinstance(value, tuple) and not _is_constant(value):
            return self.node(_sequence, 0, 1, *value)
        return ~self._constants.setdefault((type(value), value), len(self._constants))

    def plan(self, value: Value) -> Plan:
        """Return the finished plan with ``value`` as its result."""
        result = self._slot(value)
        width, constants = self._width, tuple(value for _, value in self._constants)
        at_spans = width + len(constants)
        more = len(constants) + len(self._spans)

        def final(slot: int) -> int:
            return width + ~slot if slot < 0 else slot if slot < width else slot + more

        steps = tuple(
            (make, _getter([at_spans + span, *map(final, slots)]))
            for make, span, slots in self._steps
        )
        spans = tuple(self._spans)
        calls = tuple(spans[span][0] for make, span, _ in self._steps if make is Call)
        return Plan(width, constants, spans, steps, final(result), calls)


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


def draft(
    outline: Outline, names: Sequence[str], rules: Mapping[str, Rule], chains: frozenset[str]
) -> Plan:
    """Return the plan of an outline.

    ``names`` are the token names by kind. A rule in ``chains`` is skipped if its only child is a
    rule. Raises `TooDeep`, and `NoNode` where the rules do not know what the grammar reads.
    """
    plan = Draft(outline.width)
    top: list[Part[Value]] = []
    frames = [_Frame(outline, 0, top, chains)]
    while frames:
        frame = frames[-1]
        if len(frames) > _MOST_FRAMES:
            raise TooDeep(frame.first)
        if frame.inner.rule not in rules:
            raise NoNode(frame.inner.rule)
        if frame.place < len(frame.inner.children):
            child = frame.inner.children[frame.place]
            frame.place += 1
            at = frame.at
            if isinstance(child, Outline):
                frame.at += child.width
                frames.append(_Frame(child, at, frame.parts, chains))
            else:
                frame.at += 1
                frame.parts.append(Part(names[child], at, at, at + 1))
        else:
            frames.pop()
            try:
                value = rules[frame.inner.rule](plan, frame.parts)
            except (AssertionError, LookupError, TypeError, ValueError) as error:
                raise NoNode(frame.inner.rule) from error
            frame.above.append(Part(frame.outline.rule, value, frame.first, frame.at))
    return plan.plan(top[0].value)


class _Frame:
    """A rule whose children are being drafted; ``above`` are the parts of its parent."""

    __slots__ = ("above", "at", "first", "inner", "outline", "parts", "place")

    def __init__(
        self, outline: Outline, first: int, above: list[Part[Value]], chains: frozenset[str]
    ) -> None:
        self.outline = outline
        self.inner = _inner(outline, chains)
        self.first = self.at = first
        self.above = above
        self.parts: list[Part[Value]] = []
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
    """Return a function that takes the values in ``slots`` from a list, as a sequence."""
    if len(slots) > 1:
        return itemgetter(*slots)
    (only,) = slots
    return itemgetter(slice(only, only + 1))
