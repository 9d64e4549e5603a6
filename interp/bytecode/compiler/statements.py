"""Code for routines and statements: which rule compiles which statement, and simple statements.

A statement begins with LINE. If it ends early, by a fault under ON_ERROR_PROCEED or by RESUME,
execution continues after the whole statement.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.calls import Calls
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.context import Context
from interp.bytecode.compiler.control_flow import ControlFlow
from interp.bytecode.compiler.emitter import Emitter, Ended
from interp.bytecode.compiler.expressions import CodeMaker
from interp.bytecode.compiler.locations import (
    FrameCells,
    IndexCell,
    Reference,
    Scalar,
    SystemVariable,
)
from interp.bytecode.compiler.motions import Motions
from interp.bytecode.program import CodeKind, Constant
from interp.program.statement_requests import STATEMENT_REQUESTS
from interp.values.faults import FAULTS


class Statements(CodeMaker):
    """Generates code for statements and for whole code objects."""

    def __init__(self, context: Context) -> None:
        self._calls = Calls(Emitter(context))
        super().__init__(self._calls.expressions)
        self.motions = Motions(self._expressions)
        self.flow = ControlFlow(self._expressions, self.statement)

    # ----------------------------------------------------------------------- routines

    def routine(self, node: ast.Routine) -> None:
        """Generate the body of a routine."""
        try:
            self._initialise(node)
        except Ended:
            return
        self.flow.block(node.body)
        if self._context.result is None:
            self._emit(Op.RETURN)
        else:
            self._emit(Op.FAIL, FAULTS["no_result"].code)

    def action(self, node: ast.Assignment | ast.CallStatement | ast.Brake) -> None:
        """Generate the action of an interrupt, a trigger or a cyclic signal."""
        self.statement(node)
        self._emit(Op.RETURN)

    def condition(self, node: ast.Expression) -> None:
        """Generate the condition of an interrupt or a conditional stop."""
        with suppress(Ended), self._writer.temporaries():
            self._expressions.truth(node)
            self._emit(Op.RETURN_VALUE)

    def _initialise(self, node: ast.Routine) -> None:
        """Generate the initial values of local variables."""
        for statement in node.body:
            if isinstance(statement, ast.VariableDeclaration):
                for declarator in statement.declarators:
                    found = self._context.unit.found(declarator.name)
                    if declarator.value is not None and found is not None:
                        place = self._context.variables.get(found.symbol)
                        if isinstance(place, FrameCells):
                            self._expressions.assign(place, declarator.value)

    # ----------------------------------------------------------------------- statements

    def statement(self, node: ast.Statement) -> None:
        """Generate any statement; a declaration generates nothing."""
        rule = _RULES.get(type(node))
        if rule is None:
            return
        end = Label()
        with self._writer.temporaries():
            self.flow.begin(node, end)
            with suppress(Ended):
                rule(self, node, end)
        self._writer.place(end)

    def _assignment(self, node: ast.Assignment, _end: Label) -> None:
        place = self._designators.place(node.target)
        match place:
            case SystemVariable(path=("$CYCFLAG", int() | IndexCell())):
                number = self._memory.pushed_path(place).parts[1]
                condition = self.motions.deferred(node.value, CodeKind.CONDITION)
                self._emitter.ask("SetCyclicFlag", number, condition)
            case _:
                self._memory.tell(self._expressions.assign(place, node.value))

    def _call(self, node: ast.CallStatement, _end: Label) -> None:
        value = self._calls.called(node.call, is_value=False)
        if isinstance(value, Scalar):
            self._emit(Op.DROP)
        elif isinstance(value, Reference):  # nothing takes the reference
            self._emit(Op.CLEAR, self._emitter.number(value.type))

    def _wait_for(self, node: ast.WaitFor, end: Label) -> None:
        """Generate WAIT FOR; a request before each evaluation lets time pass [CTL-12]."""
        test, again = Label(), Label()
        self._emitter.ask("Poll", Constant(True))
        self._writer.place(test)
        self._expressions.unless(node.condition, again)
        self._emit(Op.JUMP, end)
        self._writer.place(again)
        self._emitter.ask("Poll", Constant(False))
        self._emit(Op.JUMP, test)

    def _request(self, node: ast.Statement, _end: Label) -> None:
        """Generate a statement that only makes a request."""
        request = STATEMENT_REQUESTS[type(node)].request
        self._emitter.ask(request.__name__, *self.motions.parts(node))
        if node.span in self._context.unit.suppressing:  # the error of the next statement [FCT-12]
            self._emit(Op.PROCEED)


_Rule = Callable[[Statements, Any, Label], None]


def _flow(rule: Callable[[ControlFlow, Any, Label], None]) -> _Rule:
    return lambda self, node, end: rule(self.flow, node, end)


_RULES: Mapping[type[Any], _Rule] = {
    ast.Assignment: Statements._assignment,
    ast.CallStatement: Statements._call,
    ast.If: _flow(ControlFlow.if_statement),
    ast.For: _flow(ControlFlow.for_loop),
    ast.While: _flow(ControlFlow.while_loop),
    ast.Repeat: _flow(ControlFlow.repeat_loop),
    ast.Loop: _flow(ControlFlow.endless_loop),
    ast.Switch: _flow(ControlFlow.switch),
    ast.Exit: _flow(ControlFlow.exit_loop),
    ast.Goto: _flow(ControlFlow.goto),
    ast.Return: _flow(ControlFlow.return_statement),
    ast.WaitFor: Statements._wait_for,
    ast.Motion: lambda self, node, _end: self.motions.motion(node),
    ast.SplineBlock: lambda self, node, end: self.motions.spline_block(node, end),
    **dict.fromkeys(STATEMENT_REQUESTS, Statements._request),
}
