"""The control flow graph of a routine: which statement can come after which.

Each statement has a node at its beginning. Further nodes without a statement are the start, the
end, the joins after blocks, and the test of UNTIL. Conditions are not evaluated, except TRUE and
FALSE in loops. Construction is linear in the size of the routine and does not recurse, so nesting
is not limited.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from grammar.syntax import ast
from grammar.syntax.walk import bodies, without_parentheses
from support.lazy_dataclass import dataclass, node


@node
class FlowNode:
    """A node: the beginning of its statement, or UNTIL of a REPEAT if ``is_test``."""

    statement: ast.Statement | None = None
    is_test: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class FlowGraph:
    """The control flow graph of a routine from ``start`` to ``end``.

    ``after`` are the successors of each node. ``steps`` are the nodes of all statements in the
    order of the text, each with the previous statement in the same list and the enclosing block.
    """

    start: FlowNode
    end: FlowNode
    after: Mapping[FlowNode, Sequence[FlowNode]]
    steps: tuple[tuple[FlowNode, FlowNode | None, FlowNode | None], ...]

    def reached(self) -> frozenset[FlowNode]:
        """Return the nodes that can be reached from the start, including the start."""
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
    """Return the control flow graph of a routine. A GOTO to an unknown label has no successor."""
    return _Builder(is_exhaustive).build(routine)


#: Behind these something else may come than the next statement.
_TURNING = frozenset((
    ast.Label, ast.Goto, ast.Return, ast.Exit,
    ast.If, ast.Switch, ast.For, ast.While, ast.Loop, ast.Repeat,
))  # fmt: skip


class _Part:
    """A list of statements that is being processed.

    ``at`` is the end of the last statement, ``behind`` the node after the list, ``leave`` the
    target of EXIT.
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
        """Add the branches of a statement, and an edge past them if none may be chosen."""
        if isinstance(statement, ast.If):
            is_open = statement.otherwise is None
        else:
            is_open = statement.default is None and not self._is_exhaustive(statement)
        if is_open:
            self._after[step].append(behind)
        return list(bodies(statement))


def _is_endless(loop: ast.Statement) -> bool:
    """Return whether only EXIT, GOTO and RETURN leave a loop."""
    match loop:
        case ast.Loop():
            return True
        case ast.While(condition=condition) | ast.Repeat(condition=condition):
            value = without_parentheses(condition)
            is_while = isinstance(loop, ast.While)
            return isinstance(value, ast.BoolLiteral) and value.value is is_while
    return False
