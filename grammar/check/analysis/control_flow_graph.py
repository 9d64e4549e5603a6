"""The ways through a routine: what can come after each statement.

A graph of places. Each statement has one, where it begins; further places have none: the start and
the end, where ways meet behind a block, where UNTIL is tested. Conditions count as open, but for
TRUE and FALSE in loops. Linear in the size of the routine, and without recursion: depth of nesting
meets no limit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from grammar.syntax import ast
from grammar.syntax.walk import bodies, without_parentheses
from support.lazy_dataclass import dataclass, node


@node
class FlowNode:
    """A place in a routine: where its statement begins, or UNTIL of a REPEAT if ``is_test``."""

    statement: ast.Statement | None = None
    is_test: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class FlowGraph:
    """The ways through a routine from ``start`` to ``end``.

    ``after`` are the places that can come next. ``steps`` are the places of its statements in the
    order of the text, each with that of the statement before it in the same list and that of the
    block it stands in.
    """

    start: FlowNode
    end: FlowNode
    after: Mapping[FlowNode, Sequence[FlowNode]]
    steps: tuple[tuple[FlowNode, FlowNode | None, FlowNode | None], ...]

    def reached(self) -> frozenset[FlowNode]:
        """The places that some way from the start leads to, the start included."""
        found = {self.start}
        todo = [self.start]
        while todo:
            for step in self.after[todo.pop()]:
                if step not in found:
                    found.add(step)
                    todo.append(step)
        return frozenset(found)


#: Whether one branch of a SWITCH without DEFAULT is taken in any case.
IsExhaustive = Callable[[ast.Switch], bool]


def flow_graph(routine: ast.Routine, is_exhaustive: IsExhaustive = lambda _: False) -> FlowGraph:
    """The ways through a routine. A GOTO to a label that is not there leads nowhere."""
    return _Builder(is_exhaustive).build(routine)


#: Behind these something else may come than the next statement.
_TURNING = frozenset((
    ast.Label, ast.Goto, ast.Return, ast.Exit,
    ast.If, ast.Switch, ast.For, ast.While, ast.Loop, ast.Repeat,
))  # fmt: skip


class _Part:
    """A list of statements that is being gone through.

    ``at`` is where the last statement left off, ``behind`` what comes after the list, ``leave``
    where EXIT leads.
    """

    __slots__ = ("at", "before", "behind", "inside", "leave", "statements")

    def __init__(
        self,
        statements: tuple[ast.Statement, ...],
        at: FlowNode,
        behind: FlowNode,
        leave: FlowNode | None,
        inside: FlowNode | None,
    ) -> None:
        self.statements: Iterator[ast.Statement] = iter(statements)
        self.at = at
        self.behind = behind
        self.leave = leave
        self.inside = inside
        self.before: FlowNode | None = None


class _Builder:
    def __init__(self, is_exhaustive: IsExhaustive) -> None:
        self._is_exhaustive = is_exhaustive
        self._labels: dict[str, FlowNode] = {}
        self._jumps: list[tuple[FlowNode, str]] = []
        self._parts: list[_Part] = []
        # beside the places, not in them: a loop would refer to itself until garbage is collected
        self._after: dict[FlowNode, list[FlowNode]] = {}
        self._steps: list[tuple[FlowNode, FlowNode | None, FlowNode | None]] = []

    def build(self, routine: ast.Routine) -> FlowGraph:
        start, end = self._place(), self._place()
        self._parts.append(_Part(routine.body, start, end, None, None))
        while self._parts:
            part = self._parts[-1]
            for statement in part.statements:
                step = self._place(statement)
                self._steps.append((step, part.before, part.inside))
                self._after[part.at].append(step)
                part.at = part.before = step
                if type(statement) in _TURNING and self._enter(part, step, statement):
                    break
            else:
                self._after[part.at].append(part.behind)
                self._parts.pop()
        for step, label in self._jumps:
            if label in self._labels:
                self._after[step].append(self._labels[label])
        return FlowGraph(start, end, self._after, tuple(self._steps))

    def _place(self, statement: ast.Statement | None = None, is_test: bool = False) -> FlowNode:
        made = FlowNode(statement, is_test)
        self._after[made] = []
        return made

    def _enter(self, part: _Part, step: FlowNode, statement: ast.Statement) -> bool:
        """Continue from a statement; returns whether a block was begun."""
        match statement:
            case ast.Label(name=name):
                self._labels.setdefault(name.key, step)
            case ast.Goto(label=label):
                self._jumps.append((step, label.key))
                part.at = self._place()
            case ast.Return():
                part.at = self._place()
            case ast.Exit() if part.leave is not None:
                self._after[step].append(part.leave)
                part.at = self._place()
            case ast.If() | ast.Switch():
                part.at = self._place()
                for body in reversed(self._branches(statement, step, part.at)):
                    self._parts.append(_Part(body, step, part.at, part.leave, step))
                return True
            case ast.For(body=body) | ast.While(body=body) | ast.Loop(body=body):
                part.at = behind = self._place()
                if not _is_endless(statement):
                    self._after[step].append(behind)
                self._parts.append(_Part(body, step, step, behind, step))
                return True
            case ast.Repeat(body=body):
                part.at = behind = self._place()
                test = self._place(statement, is_test=True)
                self._after[test].append(step)
                if not _is_endless(statement):
                    self._after[test].append(behind)
                self._parts.append(_Part(body, step, test, behind, step))
                return True
        return False

    def _branches(
        self, statement: ast.If | ast.Switch, step: FlowNode, behind: FlowNode
    ) -> list[tuple[ast.Statement, ...]]:
        """What is chosen from; where nothing may be chosen, a way leads past it."""
        if isinstance(statement, ast.If):
            is_open = statement.otherwise is None
        else:
            is_open = statement.default is None and not self._is_exhaustive(statement)
        if is_open:
            self._after[step].append(behind)
        return list(bodies(statement))


def _is_endless(loop: ast.Statement) -> bool:
    """Whether a loop can be left by EXIT, GOTO and RETURN only."""
    match loop:
        case ast.Loop():
            return True
        case ast.While(condition=condition) | ast.Repeat(condition=condition):
            value = without_parentheses(condition)
            is_while = isinstance(loop, ast.While)
            return isinstance(value, ast.BoolLiteral) and value.value is is_while
    return False
