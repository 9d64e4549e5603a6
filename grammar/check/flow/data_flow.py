"""Data flow of a routine: which statements give its variables values, and on which paths.

Only local variables are analysed, because nothing else can access them.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial, reduce
from operator import or_

from grammar.check.analysis.accesses import Access, Parameter, Use, accesses, calls_of
from grammar.check.analysis.context import Context, PlacedStatement, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode
from grammar.semantics.symbols import Kind
from grammar.syntax import ast
from grammar.syntax.references import Space

_WORD = re.compile(r"[A-Za-z_$][\w$]*")
# A text, or a comment, which is none.
_TEXT = re.compile(r';[^\r\n]*|"([^"\r\n]*)"')


def data_flow(context: Context, routine: RoutineBody) -> DataFlow:
    """Return the variables of a routine and the accesses of its statements."""
    known: DataFlow | None = context.flows.get(routine.node)
    if known is None:
        known = context.flows[routine.node] = DataFlow(context, routine)
    return known


class DataFlow:
    """The local variables of one routine and the accesses of its statements.

    ``parameters`` and ``variables`` are the keys of those that only this routine can access.
    """

    def __init__(self, context: Context, routine: RoutineBody) -> None:
        self._context = context
        self._routine = routine
        unread = context.module.words or frozenset()
        symbols = routine.table.table.spaces[Space.VALUE].values()
        asked = _names_in_texts(context, routine) if symbols else ()
        is_partial = context.is_cut(routine) or context.module.is_head_unread(routine.node.name.key)
        followed = {
            one.key: one
            for one in symbols
            if one.key not in unread and one.key not in asked and not is_partial
        }
        self.parameters = frozenset(
            key for key, one in followed.items() if one.kind is Kind.PARAMETER
        )
        self.variables = frozenset(
            key for key, one in followed.items() if one.kind is Kind.VARIABLE
        )
        self._accesses: dict[FlowNode, Sequence[Access]] = {}

    def accesses_at(self, node: FlowNode) -> Sequence[Access]:
        """Return the accesses at a node; the condition of a REPEAT is at its end."""
        found = self._accesses.get(node)
        if found is None:
            statement: ast.Node | None = node.statement
            if isinstance(statement, ast.Repeat):
                statement = statement.condition if node.is_test else None
            found = () if statement is None else accesses(self._context, statement)
            self._accesses[node] = found
        return found

    @cached_property
    def uses(self) -> dict[str, list[Access]]:
        """Return all accesses to parameters and variables, by key, in the order of the text."""
        found: dict[str, list[Access]] = {}
        followed = self.parameters | self.variables
        for placed in self._routine.statements if followed else ():
            for access in all_accesses(self._context, placed):
                if access.key in followed:
                    found.setdefault(access.key, []).append(access)
        return found

    def early(self, followed: frozenset[str], *, is_passed_open: bool = False) -> Iterator[Access]:
        """Yield the first read of each variable that no path with a value reaches.

        Passing a variable to a routine counts as assigning it. If ``is_passed_open``, passing it to
        a routine of the project does not, and the first such call is returned, too.
        """
        if not followed:
            return
        bits = {key: 1 << index for index, key in enumerate(sorted(followed))}

        def given(access: Access) -> int:
            is_open = access.use is Use.READ or (is_passed_open and access.to)
            return 0 if is_open else bits.get(access.key, 0)

        at_node = {
            node: reduce(or_, map(given, self.accesses_at(node)), 0)
            for node in self._routine.reached
        }
        known = self.reaching(0, lambda node, _, value: value | at_node[node])
        reported = dict.fromkeys(Use, 0)
        for node in sorted(known, key=position):
            value = known[node]
            for access in self.accesses_at(node):
                bit = bits.get(access.key, 0)
                value |= given(access)
                if bit & ~(value | reported[access.use]):
                    reported[access.use] |= bit
                    yield access

    def changed(self, node: FlowNode, bits: dict[str, int]) -> int:
        """Return the variables that are assigned at a node."""
        changed = (one.key for one in self.accesses_at(node) if one.use is not Use.READ)
        return reduce(or_, (bits.get(key, 0) for key in changed), 0)

    def reaching(
        self, first: int, passed: Callable[[FlowNode, int, int], int]
    ) -> dict[FlowNode, int]:
        """Return what may reach each reachable node, as bits; ``first`` holds at the start.

        ``passed`` returns the bits that leave a node, given those that reach it and the successor.
        """
        start = self._routine.ways.start
        known = {start: first}
        todo = deque([start])
        while todo:
            node = todo.popleft()
            for number, after in enumerate(self._routine.ways.after[node]):
                value = passed(node, number, known[node])
                before = known.get(after)
                if before is None or value | before != before:
                    known[after] = value | (before or 0)
                    todo.append(after)
        return known

    @cached_property
    def _uses_at(self) -> dict[str, dict[FlowNode, list[Access]]]:
        """Return the accesses to each parameter, by key and node."""
        found: dict[str, dict[FlowNode, list[Access]]] = {}
        for node in self._routine.ways.after:
            for access in self.accesses_at(node):
                if access.key in self.parameters:
                    found.setdefault(access.key, {}).setdefault(node, []).append(access)
        return found

    def reads(self, key: str) -> tuple[Parameter, ...] | None:
        """Return the condition for a parameter to be read before it is assigned, on every path.

        The condition is that called routines read their parameters that receive it; it is ``()`` if
        the routine itself reads it, and ``None`` if it is not read on some path. Passing a
        parameter on is no read, because the called routine may test it with VARSTATE.
        """
        met: set[Parameter] = set()
        at_node = self._uses_at.get(key, {})

        def is_read(node: FlowNode, *, is_handed_on: bool) -> bool | None:
            uses = at_node.get(node)
            if not uses:
                return False
            if self._is_passed(node, key):
                to = [one.to for one in uses if one.to] if is_handed_on else []
                met.update(to)
                return bool(to)
            return True if uses[0].use is Use.READ else None

        if self._is_on_every_way(partial(is_read, is_handed_on=False)):
            return ()
        is_handed_on = any(one.to for one in self.uses.get(key, ()))
        if is_handed_on and self._is_on_every_way(partial(is_read, is_handed_on=True)):
            return tuple(sorted(met))
        return None

    def is_on_every_way(self, access: Access) -> bool:
        """Return whether every path to the end contains an access."""
        return self._is_on_every_way(
            lambda node: any(one is access for one in self.accesses_at(node))
        )

    def _is_on_every_way(self, is_met: Callable[[FlowNode], bool | None]) -> bool:
        """Return whether every path to the end contains a node for which ``is_met`` is true.

        The result is ``None`` if one does not. Paths over HALT, where an operator takes over, do
        not count.
        """
        return self._leads_over(is_met, past_halts=True) or (
            any(type(placed.statement) is ast.Halt for placed in self._routine.statements)
            and self._leads_over(is_met, past_halts=False)
        )

    def _leads_over(self, is_met: Callable[[FlowNode], bool | None], *, past_halts: bool) -> bool:
        start, end = self._routine.ways.start, self._routine.ways.end
        seen = {start}
        todo = [start]
        has_met = False
        while todo:
            node = todo.pop()
            met = is_met(node)
            if met or (type(node.statement) is ast.Halt and not past_halts):
                has_met |= bool(met)
                continue
            if met is None or node is end or type(node.statement) is ast.Return:
                return False
            behind = self._routine.ways.after[node]
            todo.extend(after for after in behind if after not in seen)
            seen.update(behind)
        return has_met

    def _is_passed(self, node: FlowNode, key: str) -> bool:
        return node.statement is not None and any(
            _is_whole(argument, key)
            for call in calls_of(node.statement)
            for argument in call.arguments
        )


def _is_whole(node: ast.Expression | None, key: str) -> bool:
    """Return whether an argument is a whole variable: ``NAME`` or ``NAME[]``."""
    if isinstance(node, ast.Subscript) and not any(node.indices):
        node = node.base
    return isinstance(node, ast.Variable) and node.name.key == key


def all_accesses(context: Context, placed: PlacedStatement) -> Iterator[Access]:
    """Yield the accesses of a statement, and of the indices that a declaration has."""
    statement = placed.statement
    yield from accesses(context, statement)
    if isinstance(statement, ast.VariableDeclaration):
        for declarator in statement.declarators:
            for index in declarator.indices or ():
                if index is not None:
                    yield from accesses(context, index)


def position(node: FlowNode) -> tuple[int, int]:
    """Return the place of a node in the order of the text."""
    if node.statement is None:
        return (-1, 0)
    return node.statement.span[node.is_test], node.is_test


def _names_in_texts(context: Context, routine: RoutineBody) -> frozenset[str]:
    """Return the names that a routine passes as texts, as in VARSTATE("NAME")."""
    start, end = routine.node.span
    texts = _TEXT.findall(context.source.text, start, end)  # a walk over the tree takes long
    return frozenset(word.upper() for text in texts for word in _WORD.findall(text))
