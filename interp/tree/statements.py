"""Statements: control flow, implemented by exceptions, and all statements that are no motion.

GOTO, EXIT and RETURN raise an exception that the target block, loop or routine catches. The
executor raises RESUME in the statement to which the program returns, which ends that statement. A
fault ends only the present statement if ON_ERROR_PROCEED applies to it, else the program.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from grammar.semantics.types import INT, Array
from grammar.syntax import ast
from interp.port import requests
from interp.port.requests import Poll, Skip, Write
from interp.program.load import Guard
from interp.program.statement_requests import STATEMENT_REQUESTS
from interp.program.variables import is_complete
from interp.tree.motions import Motions
from interp.tree.places import SystemPlace, fresh, is_left_out, of_type
from interp.tree.program_state import Steps, at_once
from interp.values.faults import Fault, LinkError, RuntimeFailure, fault
from interp.values.operators import apply
from interp.values.values import Value, known


@dataclass(slots=True, eq=False)
class _Goto(Exception):  # these exceptions are control flow, not errors
    """GOTO, on its way to the block with the label [CTL-07]."""

    label: str


class _Exit(Exception):
    """EXIT, on its way to the innermost loop [CTL-02]."""


@dataclass(slots=True, eq=False)
class _Return(Exception):
    """RETURN, on its way out of the routine [CTL-09]."""

    value: Value | None


class Resumed(Exception):
    """RESUME has returned the program to this statement; it continues after it [INT-10]."""


@dataclass(slots=True, eq=False)
class Selected(Exception):
    """Block selection: the program continues elsewhere in the routine [ADV-14].

    ``way`` has the blocks around the selected statement, outermost first, and the statement.
    """

    way: tuple[ast.Statement, ...]


_Loop = TypeVar("_Loop", bound=ast.Node)


def _catches_exit(
    loop: Callable[[Statements, _Loop], Steps[None]],
) -> Callable[[Statements, _Loop], Steps[None]]:
    def left(self: Statements, node: _Loop) -> Steps[None]:
        self._loops += 1
        try:
            yield from loop(self, node)
        except _Exit:
            return
        finally:
            self._loops -= 1

    return left


class Statements(Motions):
    """The execution of the statements of one frame.

    ``_way`` is empty except on the way to a selected statement. ``_blocks`` are the open blocks,
    outermost first, and ``_loops`` is the number of open loops.
    """

    _way: tuple[ast.Statement, ...] = ()
    _blocks: tuple[tuple[ast.Statement, ...], ...] = ()
    _loops = 0

    def routine(self, node: ast.Routine) -> Steps[Value | None]:
        """Execute a routine to its end, and return its result."""
        self._declare(node)
        value: Value | None = None
        try:
            yield from self._block(node.body)
            if node.result is not None:
                raise fault("no_result")
        except _Return as returned:
            value = returned.value
        if self.run.returns is not None:
            self.run.changed()
            self.run.returns.leave(self.at(), self.frame.name)
        return value

    def action(self, node: ast.Assignment | ast.CallStatement | ast.Brake) -> Steps[None]:
        """Execute the action of an interrupt, a trigger or a cyclic signal."""
        yield from self._statement(node)

    def _declare(self, node: ast.Routine) -> None:
        """Create the local variables, with their initial values if they have any."""
        for statement in node.body:
            if isinstance(statement, ast.VariableDeclaration):
                for declarator in statement.declarators:
                    self._declare_one(declarator)

    def _declare_one(self, declarator: ast.Declarator) -> None:
        found = self.frame.unit.found(declarator.name)
        if found is None or found.symbol in self.frame.variables:  # a parameter
            return
        type_ = self.run.program.type_of(found)
        if not is_complete(type_):  # a statement that uses it fails
            return
        place = fresh(type_, declarator.name.key)
        self.frame.variables[found.symbol] = place
        if declarator.value is not None:
            place.set(at_once(self.value(declarator.value, place.type)))

    # ----------------------------------------------------------------------- blocks

    def _block(self, body: tuple[ast.Statement, ...]) -> Steps[None]:
        outer = self._blocks
        self._blocks = (*outer, body)
        place, last = self._place_on_way(body) or 0, None
        try:
            while place < len(body):
                try:
                    yield from self._statement(body[place])
                    place += 1
                except _Goto as jump:
                    place = _place_of(jump.label, body)
                    if place < 0:
                        raise
                    last = self.run.again(place, last)
                except Selected as selected:
                    place = self._selected(selected, body)
        finally:
            self._blocks = outer

    def _place_on_way(self, body: tuple[ast.Statement, ...]) -> int | None:
        """Return the index of the statement that leads to the selected one, if there is one."""
        return next((place for place, one in enumerate(body) if one in self._way), None)

    def _selected(self, selected: Selected, body: tuple[ast.Statement, ...]) -> int:
        """Return the index of the statement that leads to a selected one, or raise ``selected``."""
        self._way = selected.way
        place = self._place_on_way(body)
        if place is None:
            raise selected
        return place

    def _is_entered(self, node: ast.Statement) -> bool:
        """Return whether a block is only entered, on the way to the selected statement in it."""
        if self._way[-1:] == (node,):
            self._way = ()
        return node in self._way

    def _statement(self, node: ast.Statement) -> Steps[None]:
        rule = _RULES.get(type(node))
        if rule is None:  # a declaration or a label
            return
        try:
            try:
                if not self._is_entered(node):
                    yield from self._begin(node)
                yield from rule(self, node)
            except RuntimeFailure as error:
                if isinstance(error, Fault) and self.run.guard is Guard.NOW:
                    yield Write(self.at(), ("$ERR", "NUMBER"), error.number or 1)
                elif self.run.skips and error.is_of_statement:
                    yield Skip(self.at(), error)
                else:
                    raise
        except Resumed:
            return

    def _begin(self, node: ast.Node) -> Steps[None]:
        return self.run.begin(self.frame, self.frame.unit.line(node))

    def _branch(self, way: int) -> None:
        if self.run.branches is not None:
            self.run.changed()
            self.run.branches.branch(self.at(), way)

    def _is_true(self, condition: ast.Expression) -> Steps[bool]:
        """Evaluate the condition of a branch, and report which way the program takes."""
        found = yield from self.truth(condition)
        self._branch(int(found))
        return found

    # ----------------------------------------------------------------------- control flow

    def _if(self, node: ast.If) -> Steps[None]:  # [CTL-13]
        is_entered = self._place_on_way(node.body) is not None
        if is_entered or (not self._way and (yield from self._is_true(node.condition))):
            yield from self._block(node.body)
        elif node.otherwise is not None:
            yield from self._block(node.otherwise)

    def _switch(self, node: ast.Switch) -> Steps[None]:
        for block in (*(branch.body for branch in node.branches), node.default or ()):
            if self._place_on_way(block) is not None:
                yield from self._block(block)
                return
        selector = yield from self.value(node.selector)
        wanted = getattr(selector, "type", INT)
        for number, branch in enumerate(node.branches, start=1):
            for label in branch.values:
                value = yield from self.value(label, wanted)
                if apply("==", selector, value):
                    self._branch(number)
                    yield from self._block(branch.body)
                    return
        self._branch(0)
        yield from self._block(node.default or ())

    @_catches_exit
    def _for(self, node: ast.For) -> Steps[None]:  # [CTL-05, CTL-06]
        step = 1 if node.step is None else (yield from self.integer(node.step))
        counter = self.variable(node.counter)
        yield from self.store(counter, (yield from self.integer(node.first)))
        last = yield from self.integer(node.last)
        while True:
            value = known((yield from self.read(counter)))
            if apply(">" if step > 0 else "<", value, last):
                return
            yield from self._block(node.body)
            yield from self._begin(node)
            value = known((yield from self.read(counter)))
            yield from self.store(counter, apply("+", value, step))

    @_catches_exit
    def _while(self, node: ast.While) -> Steps[None]:  # [CTL-01]
        last = None
        while self._way or (yield from self._is_true(node.condition)):
            yield from self._block(node.body)
            yield from self._begin(node)
            last = self.run.again(node, last)

    @_catches_exit
    def _repeat(self, node: ast.Repeat) -> Steps[None]:  # [CTL-01]
        is_done, last = False, None
        while not is_done:
            yield from self._block(node.body)
            yield from self._begin(node.condition)
            last = self.run.again(node, last)
            is_done = yield from self._is_true(node.condition)

    @_catches_exit
    def _loop(self, node: ast.Loop) -> Steps[None]:  # [CTL-01]
        last = None
        while True:
            yield from self._block(node.body)
            yield from self._begin(node)
            last = self.run.again(node, last)

    def _exit(self, _node: ast.Exit) -> Steps[None]:
        if not self._loops:
            raise LinkError("EXIT outside of a loop")
        raise _Exit
        yield

    def _goto(self, node: ast.Goto) -> Steps[None]:
        label = node.label.key
        if all(_place_of(label, body) < 0 for body in self._blocks):
            raise LinkError(f"the label {label} is not there to go to")
        raise _Goto(label)
        yield

    def _return(self, node: ast.Return) -> Steps[None]:
        type_ = self.frame.result
        if node.value is None and type_ is not None:
            raise LinkError("RETURN without a value")
        if node.value is None or type_ is None:
            raise _Return(None)
        value = yield from self.value(node.value, type_)
        if isinstance(type_, Array) and isinstance(value, str):
            made = fresh(type_, "")
            made.set(value)
            raise _Return(made.get())
        raise _Return(of_type(type_, value))

    # ----------------------------------------------------------------------- plain statements

    def _assignment(self, node: ast.Assignment) -> Steps[None]:
        place = yield from self.place(node.target)
        if is_left_out(place):
            raise fault("uninitialised")
        if isinstance(place, SystemPlace) and place.path[0] == "$CYCFLAG" and len(place.path) == 2:
            condition = self.run.defer(node.value, self.frame)
            yield requests.SetCyclicFlag(self.at(), int(place.path[1]), condition)
            return
        yield from self.store(place, (yield from self.value(node.value, place.type)))

    def _call(self, node: ast.CallStatement) -> Steps[None]:
        yield from self.call(node.call, is_value=False)

    def _request(self, node: ast.Statement) -> Steps[None]:
        """Execute a statement that only makes a request."""
        yield (yield from self.requested(node))
        if node.span in self.frame.unit.suppressing:  # the error of the next statement [FCT-12]
            self.run.guard = Guard.NEXT

    def _wait_for(self, node: ast.WaitFor) -> Steps[None]:
        """WAIT FOR: make a request before each evaluation, so that time passes [CTL-12]."""
        yield Poll(self.at(), is_first=True)
        while not (yield from self.truth(node.condition)):
            yield Poll(self.at(), is_first=False)


def _place_of(label: str, body: tuple[ast.Statement, ...]) -> int:
    """Return the index of a label in a block, or -1."""
    for place, statement in enumerate(body):
        if isinstance(statement, ast.Label) and statement.name.key == label:
            return place
    return -1


_Rule = Callable[[Statements, Any], Steps[None]]
_RULES: Mapping[type[Any], _Rule] = {
    ast.Assignment: Statements._assignment,
    ast.CallStatement: Statements._call,
    ast.If: Statements._if,
    ast.For: Statements._for,
    ast.While: Statements._while,
    ast.Repeat: Statements._repeat,
    ast.Loop: Statements._loop,
    ast.Switch: Statements._switch,
    ast.Exit: Statements._exit,
    ast.Goto: Statements._goto,
    ast.Return: Statements._return,
    ast.WaitFor: Statements._wait_for,
    ast.Motion: Statements.motion,
    ast.SplineBlock: Statements.spline_block,
    **dict.fromkeys(STATEMENT_REQUESTS, Statements._request),
}
