"""Types of the parts of statements: conditions, targets, values, times, numbers.

This check infers the types of expressions in a program, for all later checks.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, RoutineBody
from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.types.assignments import assign
from grammar.check.types.calls import call
from grammar.check.types.expressions import type_checker
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.assignability import case_label, condition, integer, number, selector, target
from grammar.semantics.types import (
    REAL,
    UNKNOWN,
    Structure,
    Type,
    Verdict,
)
from grammar.syntax import ast
from grammar.syntax.walk import children, without_parentheses


def check(context: Context) -> Iterator[Diagnostic]:
    """Type all expressions in the routines of a file."""
    checker = type_checker(context)
    for routine in context.routines:
        rules = _Routine(checker, routine)
        for placed in routine.statements:
            rule = _RULES.get(type(placed.statement), _Routine.parts)
            rule(rules, placed.statement)
    yield from checker.diagnostics


def _bound(value: Type) -> Verdict:
    """FOR counts with INT; that a REAL is refused is recollection [CTL-05]."""
    verdict = integer(value, "CTL-05")
    return replace(verdict, rules=("CTL-05",)) if value == REAL else verdict


class _Routine:
    """Checks the statements of one routine."""

    def __init__(self, checker: TypeChecker, routine: RoutineBody) -> None:
        self.checker = checker
        self.context = checker.context
        self.routine = routine

    # ----------------------------------------------------------------------- places

    def needs(
        self,
        accepts: Callable[[Type], Verdict],
        slug: str,
        *nodes: ast.Expression | None,
        to: Type = UNKNOWN,
    ) -> None:
        """Type values that a statement needs; those that are left out need nothing."""
        for node in nodes:
            if node is not None:
                self.checker.check(to, node, lambda _to, value: accepts(value), slug)

    def condition(self, node: ast.Expression) -> None:
        """Check that an expression is BOOL."""
        self.needs(condition, "not-a-truth-value", node)

    def numbers(self, *nodes: ast.Expression | None) -> None:
        """Numbers: times, distances, angles."""
        self.needs(number, "not-a-number-here", *nodes, to=REAL)

    def integers(self, *nodes: ast.Expression | None) -> None:
        """Integers: numbers of interrupts, priorities."""
        self.needs(integer, "not-an-integer", *nodes)

    def types(self, *nodes: ast.Expression | None) -> None:
        """Expressions that may be anything."""
        for node in nodes:
            if node is not None:
                self.checker.infer(node)

    def parts(self, node: ast.Statement) -> None:
        """Infer the expressions of a statement without a rule of its own; any type is valid."""
        if not isinstance(node, ast.Definition):
            self.types(*(one for one in children(node) if isinstance(one, ast.Expression)))

    def action(self, node: ast.Assignment | ast.CallStatement | ast.Brake) -> None:
        """Check the action of a trigger or an interrupt."""
        if isinstance(node, ast.Assignment):
            assign(self.checker, node)
        elif isinstance(node, ast.CallStatement):
            call(self.checker, node.call, is_value=False)

    # ----------------------------------------------------------------- control flow

    def loop(self, node: ast.For) -> None:
        """FOR: its counter, bounds and step are INT, the step a constant [CTL-05, CTL-06]."""
        found = self.context.found(node.counter)
        if found is not None:
            verdict = _bound(self.checker.type_of(found))
            if not verdict:
                self.checker.reject("wrong-counter", node.counter, verdict)
        self.needs(_bound, "wrong-counter", node.first, node.last)
        if node.step is not None:
            self._step(node.step)

    def _step(self, node: ast.Expression) -> None:
        before = len(self.checker.diagnostics)
        self.needs(_bound, "wrong-counter", node)
        if len(self.checker.diagnostics) > before:
            return
        value = constant(self.context, node)
        if value == 0:
            self.checker.report("wrong-step", node, "STEP cannot be zero")
        elif value is None and self.context.types[node] != UNKNOWN:
            self.checker.report("wrong-step", node, "STEP is a constant")

    def switch(self, node: ast.Switch) -> None:
        """SWITCH over CHAR, INT or an enumeration; CASE has constants of that [CTL-03]."""
        self.needs(selector, "wrong-selector", node.selector)
        chosen = self.context.types[node.selector]
        is_known = bool(selector(chosen))
        seen: dict[object, ast.Node] = {}
        for branch in node.branches:
            for label in branch.values:
                if is_known:
                    self.checker.check(chosen, label, case_label, "wrong-selector")
                else:
                    self.checker.infer(label)
                value = constant(self.context, label)
                first = seen.setdefault((type(value), value), label)
                if value is not None and first is not label:
                    line = self.context.line(first)
                    message = f"the CASE of line {line} has this constant, so this one never runs"
                    self.checker.report("case-twice", label, message)

    def returned(self, node: ast.Return) -> None:
        """RETURN has a value in functions, and in these only [CTL-09]."""
        result = self.routine.node.result
        name = self.routine.node.name.text
        if node.value is None:
            if result is not None:
                message = f"{name} is a function, so RETURN needs a value"
                self.checker.report("return-without-value", node, message)
        elif result is None:
            self.checker.infer(node.value)
            message = f"{name} is not a function, so RETURN has no value"
            self.checker.report("return-with-value", node.value, message)
        else:
            symbol, scope = self.routine.table.routine, self.routine.scope
            self.checker.check(self.checker.type_of_symbol(symbol, scope), node.value)

    # ---------------------------------------------------------------------- motions

    def motion(self, node: ast.Motion) -> None:
        """Check that the targets of a motion are positions."""
        for place in (node.auxiliary, node.target):
            if place is not None:
                self._target(place)
                self._on_path(node, place)
        self.numbers(node.angle)
        self.values(node.values)
        if node.reference is not None:
            self._reference(node.reference)

    def values(self, nodes: tuple[ast.Assignment, ...]) -> None:
        """Check the assignments after WITH [SPL-08]."""
        for node in nodes:
            assign(self.checker, node)

    def stop(self, node: ast.StopWhen) -> None:
        """STOP WHEN PATH … IF [SPL-06]."""
        self.numbers(node.place)
        self.condition(node.condition)

    def _target(self, node: ast.Expression) -> None:
        inner = without_parentheses(node)
        if isinstance(inner, ast.Aggregate):
            self.checker.infer(inner, self._position(inner))
        else:
            self.needs(target, "not-a-position", node)

    def _on_path(self, node: ast.Motion, place: ast.Expression) -> None:
        """Report an axis position as target of a CP motion, which needs a pose."""
        kind = self.context.types.get(without_parentheses(place))
        is_path = not node.kind.startswith(("PTP", "SPTP", "ASYPTP"))
        if is_path and isinstance(kind, Structure) and kind.name in ("AXIS", "E6AXIS"):
            message = f"{node.kind} goes to a pose, and these are axis positions"
            self.checker.report("path-to-axes", place, message, is_unconfirmed=True)

    def _position(self, node: ast.Aggregate) -> Type:
        """Return the structure of a position aggregate: axes or a pose."""
        is_axes = any(_AXIS.fullmatch(part.name.text) for part in node.components)
        return self.context.system.types["E6AXIS" if is_axes else "E6POS"]

    def _reference(self, node: ast.EnumConstant) -> None:
        self.checker.infer(node)
        if node.name.key not in _REFERENCES:
            message = f"a relative motion refers to #BASE or #TOOL, not to #{node.name.text}"
            self.checker.report("no-such-constant", node, message, rules=("MOT-14",))

    def trigger(self, node: ast.Trigger) -> None:
        """TRIGGER: place and delay are numbers, the priority is an integer [TRG-01 to TRG-06]."""
        self.numbers(node.place, node.delay)
        self.integers(node.priority)
        self.action(node.action)

    def interrupt(self, node: ast.InterruptDeclaration) -> None:
        """INTERRUPT DECL: a number, an event, a routine [INT-01, INT-06]."""
        self.integers(node.number)
        self.condition(node.condition)
        self.action(node.action)

    # ---------------------------------------------------------------------- signals

    def signal_on(self, node: ast.SignalOn) -> None:
        """ANIN, ANOUT and DIGIN compute numbers again and again [IOT-05, IOT-09]."""
        assign(self.checker, node.assignment)
        self.numbers(node.delay, node.minimum, node.maximum)


_AXIS = re.compile(r"A[1-6]", re.IGNORECASE)
_REFERENCES = frozenset({"BASE", "TOOL"})

_Rule = Callable[[_Routine, Any], None]

_RULES: Mapping[type[Any], _Rule] = {
    ast.Assignment: lambda routine, node: assign(routine.checker, node),
    ast.CallStatement: _Routine.action,
    ast.If: lambda routine, node: routine.condition(node.condition),
    ast.For: _Routine.loop,
    ast.While: lambda routine, node: routine.condition(node.condition),
    ast.Repeat: lambda routine, node: routine.condition(node.condition),
    ast.Switch: _Routine.switch,
    ast.Return: _Routine.returned,
    ast.WaitFor: lambda routine, node: routine.condition(node.condition),
    ast.WaitSeconds: lambda routine, node: routine.numbers(node.duration),
    ast.SignalOn: _Routine.signal_on,
    ast.Motion: _Routine.motion,
    ast.SplineBlock: lambda routine, node: routine.values(node.values),
    ast.ConstantVelocity: lambda routine, node: routine.numbers(node.place),
    ast.TimeBlock: lambda routine, node: routine.numbers(node.value),
    ast.StopWhen: _Routine.stop,
    ast.InterruptDeclaration: _Routine.interrupt,
    ast.InterruptSwitch: lambda routine, node: routine.integers(node.number),
    ast.Trigger: _Routine.trigger,
}
