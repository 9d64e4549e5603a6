"""Statements: which rule makes the code of which, the bodies of routines, and plain statements.

A statement begins with LINE. Where it ends early, by a fault that ON_ERROR_PROCEED takes or by
RESUME, the routine goes on behind all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from grammar.semantics.types import INT, REAL
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.context import Ended
from interp.bytecode.compiler.control_flow import ControlFlow
from interp.bytecode.compiler.places import Block, Cells, Hole, Remote, Scalar
from interp.bytecode.program import CodeKind, Constant, Input, Mode
from interp.values.faults import FAULTS

__all__ = ["Statements"]


class Statements(ControlFlow):
    """Makes the code of statements."""

    # ----------------------------------------------------------------------- routines

    def routine(self, node: ast.Routine) -> None:
        """The body of a routine."""
        try:
            self._initialise(node)
        except Ended:
            return
        self.block(node.body)
        if self.context.result is None:
            self.emit(Op.RETURN)
        else:
            self.emit(Op.FAIL, FAULTS["no_result"].code)

    def action(self, node: ast.Assignment | ast.CallStatement | ast.Brake) -> None:
        """What an interrupt, a trigger or a cyclic signal does."""
        self.statement(node)
        self.emit(Op.RETURN)

    def condition(self, node: ast.Expression) -> None:
        """What an interrupt or a conditional stop waits for."""
        with suppress(Ended), self.writer.temporaries():
            self.truth(node)
            self.emit(Op.RETURN_VALUE)

    def _initialise(self, node: ast.Routine) -> None:
        """Initial values of local data."""
        for statement in node.body:
            if isinstance(statement, ast.VariableDeclaration):
                for declarator in statement.declarators:
                    found = self.context.unit.found(declarator.name)
                    if declarator.value is not None and found is not None:
                        place = self.context.variables.get(found.symbol)
                        if isinstance(place, Cells):
                            self.assign(place, declarator.value)

    # ----------------------------------------------------------------------- statements

    def statement(self, node: ast.Statement) -> None:
        """Any statement; a declaration does nothing."""
        rule = _RULES.get(type(node))
        if rule is None:
            return
        end = Label()
        with self.writer.temporaries():
            self.begin(node, end)
            with suppress(Ended):
                rule(self, node, end)
        self.writer.place(end)

    def _assignment(self, node: ast.Assignment, _end: Label) -> None:
        place = self.place(node.target)
        match place:
            case Remote(path=("$CYCFLAG", int() | Hole())):
                number = self.pushed_path(place).parts[1]
                condition = self.handed_over(node.value, CodeKind.CONDITION)
                self.ask("SetCyclicFlag", number, condition)
            case _:
                self.tell(self.assign(place, node.value))

    def _call(self, node: ast.CallStatement, _end: Label) -> None:
        value = self.called(node.call, is_value=False)
        if isinstance(value, Scalar):
            self.emit(Op.DROP)
        elif isinstance(value, Block):  # nothing takes the reference
            self.emit(Op.CLEAR, self.number(value.type))

    def _proceed(self, _node: ast.OnErrorProceed, _end: Label) -> None:
        self.emit(Op.PROCEED)

    def _confirm(self, node: ast.Confirm, _end: Label) -> None:
        self.integer(node.number)
        self.ask("Confirm", Input(Mode.IN, self.number(INT)))

    def _wait_for(self, node: ast.WaitFor, end: Label) -> None:
        """Asked before each look at the condition, so that time passes between two [CTL-12]."""
        test, again = Label(), Label()
        self.ask("Poll", Constant(True))
        self.writer.place(test)
        self.unless(node.condition, again)
        self.emit(Op.JUMP, end)
        self.writer.place(again)
        self.ask("Poll", Constant(False))
        self.emit(Op.JUMP, test)

    def _wait_seconds(self, node: ast.WaitSeconds, _end: Label) -> None:
        self.real(node.duration)
        self.ask("Wait", Input(Mode.IN, self.number(REAL)))


_Rule = Callable[[Statements, Any, Label], None]


def _plain(request: str) -> _Rule:
    return lambda self, _node, _end: self.ask(request)


def _without_end(rule: Callable[[Statements, Any], None]) -> _Rule:
    return lambda self, node, _end: rule(self, node)


_RULES: Mapping[type[Any], _Rule] = {
    ast.Assignment: Statements._assignment,
    ast.CallStatement: Statements._call,
    ast.If: Statements.if_statement,
    ast.For: Statements.for_loop,
    ast.While: Statements.while_loop,
    ast.Repeat: Statements.repeat_loop,
    ast.Loop: Statements.endless_loop,
    ast.Switch: Statements.switch,
    ast.Exit: Statements.exit_loop,
    ast.Goto: Statements.goto,
    ast.Return: Statements.return_statement,
    ast.Halt: _plain("Halt"),
    ast.Continue: _plain("Continue"),
    ast.Resume: _plain("Resume"),
    ast.OnErrorProceed: Statements._proceed,
    ast.Confirm: Statements._confirm,
    ast.WaitFor: Statements._wait_for,
    ast.WaitSeconds: Statements._wait_seconds,
    ast.SignalOn: _without_end(Statements.signal_on),
    ast.SignalOff: _without_end(Statements.signal_off),
    ast.Motion: _without_end(Statements.motion),
    ast.EmilyMotion: _without_end(Statements.emily_motion),
    ast.SplineBlock: Statements.spline_block,
    ast.Brake: _without_end(Statements.brake),
    ast.InterruptDeclaration: _without_end(Statements.interrupt_declaration),
    ast.InterruptSwitch: _without_end(Statements.interrupt_switch),
    ast.Trigger: _without_end(Statements.trigger),
}
