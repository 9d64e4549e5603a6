"""Variables that are read before they have a value.

If no path through the routine assigns a variable before it is read, the finding is certain. If some
paths do and others do not, these may never be executed, so it is a note.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from functools import cached_property

from grammar.check.analysis.accesses import Access, Use, accesses
from grammar.check.analysis.context import Context, PlacedStatement, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode
from grammar.check.analysis.likely_names import LikelyNames
from grammar.check.flow.data_flow import data_flow, position
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import BODIES
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class _OnCondition:
    """A variable that is assigned in blocks only, first at an ``offset`` of the text.

    ``deciding`` are the names in the conditions of ``blocks``, and those that are assigned together
    with it.
    """

    offset: int
    deciding: frozenset[str]
    blocks: frozenset[ast.Node]


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about missing values in all routines of a file."""
    slips = _Slips(context)
    for routine in context.routines:
        yield from _read_too_early(context, routine, slips)


class _Slips:
    """What the undeclared names of a file may be slips of, which is told there."""

    def __init__(self, context: Context) -> None:
        self._context = context

    def within(self, routine: RoutineBody) -> frozenset[str]:
        """Return the names that may be meant in a routine, in upper case."""
        first, last = (bisect_left(self._places, (end, "")) for end in routine.node.span)
        return frozenset(name for _, name in self._places[first:last])

    @cached_property
    def _places(self) -> list[tuple[int, str]]:
        """The names that may be meant, each with where another one is written, in that order."""
        likely = LikelyNames(self._context)
        return sorted(
            (use.name.span[0], near.upper())
            for uses in self._context.open_uses.values()
            for use in uses
            if use.space is Space.VALUE
            for near in likely.of(use)
        )


def _read_too_early(context: Context, routine: RoutineBody, slips: _Slips) -> Iterator[Diagnostic]:
    """Yield variables that are read where they cannot have a value yet [SCO-03, SCO-08]."""
    flow = data_flow(context, routine)
    reported: set[str] = set()
    early = list(flow.early(flow.variables))
    misspelt = slips.within(routine) if early else frozenset()
    for access in early:
        reported.add(access.key)
        if access.key in misspelt:
            continue
        message = f"{access.name.text} has no value yet"
        reason = "nothing before this assigns to it"
        yield context.finding("read-too-early", access.name, message, reason=reason)
    for access, line in _possibly_early(context, routine, flow.variables - reported):
        message = f"{access.name.text} may have no value yet"
        reason = f"line {line} assigns to it, and there is a way past that"
        yield context.finding("read-perhaps-early", access.name, message, reason=reason)


def _possibly_early(
    context: Context, routine: RoutineBody, followed: frozenset[str]
) -> Iterator[tuple[Access, int]]:
    """Yield the first read of each variable that some path without a value reaches.

    Each comes with the line of an assignment. Loops count as executed at least once. A read is
    left out if a condition may prevent it: one with a name that also decides about the
    assignment of the variable, or that is assigned together with it.
    """
    some = _on_conditions(context, routine, followed)
    if not some:
        return
    flow = data_flow(context, routine)
    bits = {key: 1 << index for index, key in enumerate(sorted(some))}

    def lacking(node: FlowNode, number: int, value: int) -> int:
        value &= ~flow.changed(node, bits)
        if number == 0 and isinstance(node.statement, ast.For | ast.While):  # the way past it
            for key, one in some.items():
                value &= ~bits[key] if node.statement in one.blocks else ~0
        return value

    known = flow.reaching(sum(bits.values()), lacking)
    place_of = {placed.statement: placed for placed in routine.statements}
    reported: set[str] = set()
    for node in sorted(known, key=position):
        value = known[node]
        for access in flow.accesses_at(node):
            key = access.key
            if access.use is not Use.READ:
                value &= ~bits.get(key, 0)
            elif node.statement and key not in reported and bits.get(key, 0) & value:
                read = place_of[node.statement]
                asked = set[str]().union(*(_asked(context, one) for one in (read, *read.around)))
                if asked.isdisjoint(some[key].deciding):
                    reported.add(key)
                    yield access, context.source.place(some[key].offset)[0]


def _on_conditions(
    context: Context, routine: RoutineBody, followed: frozenset[str]
) -> dict[str, _OnCondition]:
    """Return the variables that are assigned only in blocks or after a possible GOTO."""
    if not followed:
        return {}
    assigned: dict[str, list[PlacedStatement]] = {}
    along: dict[PlacedStatement | None, set[str]] = {}
    has_jumps = False
    for placed in routine.statements:
        has_jumps |= isinstance(placed.statement, ast.Goto)
        for access in accesses(context, placed.statement):
            key = access.key
            if access.use is not Use.READ:
                along.setdefault(placed.inside, set()).add(key)
                if key in followed:
                    assigned.setdefault(key, []).append(placed)
    found: dict[str, _OnCondition] = {}
    for key, places in assigned.items():
        blocks = {around for one in places for around in one.around}
        if blocks or has_jumps:
            beside = [along[one.inside] for one in places if one.inside]
            names = set[str]().union(*(_asked(context, one) for one in blocks), *beside) - {key}
            nodes = frozenset(one.statement for one in blocks)
            found[key] = _OnCondition(places[0].statement.span[0], frozenset(names), nodes)
    return found


def _asked(context: Context, placed: PlacedStatement) -> set[str]:
    """Return the names in the condition of a block; none for other statements."""
    if type(placed.statement) not in BODIES:
        return set()
    return {access.key for access in accesses(context, placed.statement)}
