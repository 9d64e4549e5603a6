"""Data flow of a routine: reads before a value, unused variables, changed counters.

Only local variables are analysed, because nothing else can access them. If no path through the
routine assigns a variable before it is read, the finding is certain. If some paths do and others do
not, these may never be executed, so it is a note.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial

from grammar.check.analysis.accesses import Access, Parameter, Use, accesses, calls_of
from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, PlacedStatement, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Typos
from grammar.semantics.symbols import Kind
from grammar.semantics.types import BOOL, REAL
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import BODIES, root_variable, walk, without_parentheses
from support.lazy_dataclass import dataclass

_WORD = re.compile(r"[A-Za-z_$][\w$]*")
# A text, or a comment, which is none.
_TEXT = re.compile(r';[^\r\n]*|"([^"\r\n]*)"')


def check(context: Context) -> Iterator[Diagnostic]:
    """Findings about the data of all routines of a file."""
    for routine in context.routines:
        flow = data_flow(context, routine)
        yield from flow.read_too_early()
        yield from flow.unused()
        yield from _counters(context, routine)
        before: ast.Node | None = None
        for placed in routine.statements:
            is_tried = isinstance(before, ast.OnErrorProceed)
            if isinstance(placed.statement, ast.Assignment) and not is_tried:
                yield from _to_itself(context, placed.statement)
            elif isinstance(placed.statement, ast.WaitFor):
                yield from _waiting(context, placed.statement)
            before = placed.statement
    if context.routines:
        yield from _real_equality(context)


def data_flow(context: Context, routine: RoutineBody) -> DataFlow:
    """Return the variables of a routine and the accesses of its statements."""
    known: DataFlow | None = context.flows.get(routine.node)
    if known is None:
        known = context.flows[routine.node] = DataFlow(context, routine)
    return known


@dataclass(frozen=True, slots=True)
class _OnCondition:
    """A variable that is assigned in blocks only, first at an ``offset`` of the text.

    ``deciding`` are the names in the conditions of ``blocks``, and those that are assigned together
    with it.
    """

    offset: int
    deciding: frozenset[str]
    blocks: frozenset[ast.Node]


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
        followed = {
            one.key: one
            for one in symbols
            if one.key not in unread and one.key not in asked and not context.is_cut(routine)
        }
        self.parameters = frozenset(
            key for key, one in followed.items() if one.kind is Kind.PARAMETER
        )
        self.variables = frozenset(
            key for key, one in followed.items() if one.kind is Kind.VARIABLE
        )
        self._accesses: dict[FlowNode, Sequence[Access]] = {}

    def _of(self, node: FlowNode) -> Sequence[Access]:
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
            for access in _all(self._context, placed):
                if access.name.key in followed:
                    found.setdefault(access.name.key, []).append(access)
        return found

    def early(self, followed: frozenset[str], *, is_passed_open: bool = False) -> Iterator[Access]:
        """Return the first read of each variable that no path with a value reaches.

        Passing a variable to a routine counts as assigning it. If ``is_passed_open``, passing it to
        a routine of the project does not, and the first such call is returned, too.
        """
        if not followed:
            return
        bits = {key: 1 << index for index, key in enumerate(sorted(followed))}

        def given(access: Access) -> int:
            is_open = access.use is Use.READ or (is_passed_open and access.to)
            return 0 if is_open else bits.get(access.name.key, 0)

        def passed(node: FlowNode, _: int, value: int) -> int:
            for access in self._of(node):
                value |= given(access)
            return value

        known = self._reaching(0, passed)
        reported = dict.fromkeys(Use, 0)
        for node in sorted(known, key=_position):
            value = known[node]
            for access in self._of(node):
                bit = bits.get(access.name.key, 0)
                value |= given(access)
                if bit & ~(value | reported[access.use]):
                    reported[access.use] |= bit
                    yield access

    def _changed(self, node: FlowNode, bits: dict[str, int]) -> int:
        """Return the variables that are assigned at a node."""
        changed = 0
        for access in self._of(node):
            if access.use is not Use.READ:
                changed |= bits.get(access.name.key, 0)
        return changed

    def _reaching(
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

    def reads(self, key: str) -> tuple[Parameter, ...] | None:
        """Return the condition for a parameter to be read before it is assigned, on every path.

        The condition is that called routines read their parameters that receive it; it is ``()`` if
        the routine itself reads it, and ``None`` if it is not read on some path. Passing a
        parameter on is no read, because the called routine may test it with VARSTATE.
        """
        met: set[Parameter] = set()

        def is_read(node: FlowNode, *, is_handed_on: bool) -> bool | None:
            uses = [access for access in self._of(node) if access.name.key == key]
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
        return self._is_on_every_way(lambda node: any(one is access for one in self._of(node)))

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

    def read_too_early(self) -> Iterator[Diagnostic]:
        """Variables that are read where they cannot have a value yet [SCO-03, SCO-08]."""
        reported: set[str] = set()
        for access in self.early(self.variables):
            reported.add(access.name.key)
            message = f"{access.name.text} has no value yet"
            reason = "nothing before this assigns to it"
            yield self._context.finding("read-too-early", access.name, message, reason=reason)
        for access, line in self._possibly_early(self.variables - reported):
            message = f"{access.name.text} may have no value yet"
            reason = f"line {line} assigns to it, and there is a way past that"
            yield self._context.finding("read-perhaps-early", access.name, message, reason=reason)

    def _possibly_early(self, followed: frozenset[str]) -> Iterator[tuple[Access, int]]:
        """Return the first read of each variable that some path without a value reaches.

        Each comes with the line of an assignment. Loops count as executed at least once. A read is
        left out if a condition may prevent it: one with a name that also decides about the
        assignment of the variable, or that is assigned together with it.
        """
        some = self._on_conditions(followed)
        if not some:
            return
        bits = {key: 1 << index for index, key in enumerate(sorted(some))}

        def lacking(node: FlowNode, number: int, value: int) -> int:
            value &= ~self._changed(node, bits)
            if number == 0 and isinstance(node.statement, ast.For | ast.While):  # the way past it
                for key, one in some.items():
                    value &= ~bits[key] if node.statement in one.blocks else ~0
            return value

        known = self._reaching(sum(bits.values()), lacking)
        place_of = {placed.statement: placed for placed in self._routine.statements}
        reported: set[str] = set()
        for node in sorted(known, key=_position):
            value = known[node]
            for access in self._of(node):
                key = access.name.key
                if access.use is not Use.READ:
                    value &= ~bits.get(key, 0)
                elif node.statement and key not in reported and bits.get(key, 0) & value:
                    read = place_of[node.statement]
                    asked = set[str]().union(*map(self._asked, (read, *_around(read))))
                    if asked.isdisjoint(some[key].deciding):
                        reported.add(key)
                        yield access, self._context.source.place(some[key].offset)[0]

    def _on_conditions(self, followed: frozenset[str]) -> dict[str, _OnCondition]:
        """Return the variables that are assigned only in blocks or after a possible GOTO."""
        if not followed:
            return {}
        assigned: dict[str, list[PlacedStatement]] = {}
        along: dict[PlacedStatement | None, set[str]] = {}
        has_jumps = False
        for placed in self._routine.statements:
            has_jumps |= isinstance(placed.statement, ast.Goto)
            for access in accesses(self._context, placed.statement):
                key = access.name.key
                if access.use is not Use.READ:
                    along.setdefault(placed.inside, set()).add(key)
                    if key in followed:
                        assigned.setdefault(key, []).append(placed)
        found: dict[str, _OnCondition] = {}
        for key, places in assigned.items():
            blocks = {around for one in places for around in _around(one)}
            if blocks or has_jumps:
                beside = [along[one.inside] for one in places if one.inside]
                names = set[str]().union(*map(self._asked, blocks), *beside) - {key}
                nodes = frozenset(one.statement for one in blocks)
                found[key] = _OnCondition(places[0].statement.span[0], frozenset(names), nodes)
        return found

    def _asked(self, placed: PlacedStatement) -> set[str]:
        """Return the names in the condition of a block; none for other statements."""
        if type(placed.statement) not in BODIES:
            return set()
        return {access.name.key for access in accesses(self._context, placed.statement)}

    def unused(self) -> Iterator[Diagnostic]:
        """Variables and parameters that nothing reads; notes.

        What is one slip away from a name of another file that the routine uses is a warning.
        """
        if not self.variables and not self.parameters:
            return
        used: set[str] = set()
        written: set[str] = set()
        table = self._routine.table.table.spaces[Space.VALUE]
        others: dict[str, str] = {}
        for placed in self._routine.statements:
            for access in _all(self._context, placed):
                key = access.name.key
                (written if access.use is Use.WRITTEN else used).add(key)
                if key not in table and self._context.found(access.name):
                    others[key] = access.name.text
        unused = [
            table[key]
            for key in sorted((self.variables | self.parameters) - used)
            if table[key].kind is not Kind.PARAMETER or key not in written
        ]
        typos = Typos(others.values() if unused else ())
        for symbol in unused:
            key = symbol.key
            what = "is assigned to and never read" if key in written else "is never used"
            may_slip = symbol.kind is Kind.VARIABLE and key not in written
            near = typos.meant(symbol.name) if may_slip else ()
            is_slip = len(near) == 1
            yield self._context.finding(
                "unused",
                symbol.span,
                f"{symbol.name} {what}",
                reason=f"{near[0]} is used here and declared elsewhere" if is_slip else "",
                severity="warning" if is_slip else None,
                fix=one_of(near) if is_slip else None,
            )


def _around(placed: PlacedStatement) -> Iterator[PlacedStatement]:
    """Yield the enclosing statements of a statement, innermost first."""
    around = placed.inside
    while around is not None:
        yield around
        around = around.inside


def _is_whole(node: ast.Expression | None, key: str) -> bool:
    """Return whether an argument is a whole variable: ``NAME`` or ``NAME[]``."""
    if isinstance(node, ast.Subscript) and not any(node.indices):
        node = node.base
    return isinstance(node, ast.Variable) and node.name.key == key


def _all(context: Context, placed: PlacedStatement) -> Iterator[Access]:
    statement = placed.statement
    yield from accesses(context, statement)
    if isinstance(statement, ast.VariableDeclaration):
        for declarator in statement.declarators:
            for index in declarator.indices or ():
                if index is not None:
                    yield from accesses(context, index)


def _position(node: FlowNode) -> tuple[int, int]:
    if node.statement is None:
        return (-1, 0)
    return node.statement.span[node.is_test], node.is_test


def _names_in_texts(context: Context, routine: RoutineBody) -> frozenset[str]:
    """Return the names that a routine passes as texts, as in VARSTATE("NAME")."""
    start, end = routine.node.span
    texts = _TEXT.findall(context.source.text, start, end)  # a walk over the tree takes long
    return frozenset(word.upper() for text in texts for word in _WORD.findall(text))


# ------------------------------------------------------------------------------- single statements


def _counters(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Counters that are changed inside their own loop [CTL-05]."""
    for placed in routine.statements:
        statement = placed.statement
        if isinstance(statement, ast.For):
            name, place = statement.counter, statement.counter
        elif isinstance(statement, ast.Assignment) and isinstance(statement.target, ast.Variable):
            name, place = statement.target.name, statement.target.name
        else:
            continue
        around = placed.inside
        while around is not None:
            if type(around.statement) is ast.For and around.statement.counter.key == name.key:
                line = context.source.place(around.statement.span[0])[0]
                message = f"{name.text} counts the loop of line {line} and is changed inside it"
                yield context.finding("counter-changed", place, message)
                break
            around = around.inside


def _to_itself(context: Context, node: ast.Assignment) -> Iterator[Diagnostic]:
    """``A = A``; to assign to a variable of the controller has effects of its own.

    Behind ON_ERROR_PROCEED it is a way to ask whether there is a value.
    """
    root = root_variable(node.target)
    value = without_parentheses(node.value)
    if root is None or root.name.text.startswith("$") or type(value) is not type(node.target):
        return
    found = context.found(root.name)
    is_plain = found is not None and found.symbol.kind is not Kind.SIGNAL
    has_call = any(isinstance(inner, ast.Call) for inner in walk(node.target))
    shown = [
        "".join(context.source.text[slice(*one.span)].upper().split())
        for one in (node.target, value)
    ]
    if is_plain and not has_call and shown[0] == shown[1]:
        written = context.source.text[slice(*node.target.span)]
        yield context.finding("self-assignment", node, f"{written} is assigned to itself")


def _real_equality(context: Context) -> Iterator[Diagnostic]:
    """``==`` and ``<>`` of numbers that are rounded [ARI-10]."""
    for node in context.typed_nodes[ast.Binary]:
        if node.operator in ("==", "<>"):
            types = context.types.get(node.left), context.types.get(node.right)
            if REAL in types:
                message = f"{node.operator} compares REAL values, which are rounded"
                yield context.finding("real-equality", node, message)


def _waiting(context: Context, node: ast.WaitFor) -> Iterator[Diagnostic]:
    """WAIT FOR on what nothing can change while the routine waits: FALSE, its own variables."""
    used = accesses(context, node)
    found = [context.found(access.name) for access in used]
    has_call = any(isinstance(inner, ast.Call) for inner in walk(node))
    is_own = bool(found) and all(
        one is not None and one.scope.routine is not None and one.symbol.kind is Kind.VARIABLE
        for one in found
    )
    if is_own and not has_call and context.types.get(node.condition) == BOOL:
        names = ", ".join(dict.fromkeys(access.name.text for access in used))
        message = f"{names} cannot change while this waits"
        yield context.finding("waits-for-ever", node.condition, message)
    elif constant(context, node.condition) is False:
        is_on_purpose = isinstance(without_parentheses(node.condition), ast.BoolLiteral)
        severity: Severity = "note" if is_on_purpose else "warning"
        message = "this condition is never true"
        yield context.finding("waits-for-ever", node.condition, message, severity=severity)
