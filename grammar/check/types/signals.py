"""Signals: names of inputs, outputs, and groups of them [IOT-03]."""

from __future__ import annotations

from grammar.check.analysis.constant_folding import integer_of
from grammar.check.analysis.context import Context
from grammar.check.analysis.signal_direction import written_side
from grammar.check.analysis.type_checker import TypeChecker
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import SignalSymbol
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import root_variable

_WIDEST = 32


def check_signal(checker: TypeChecker, node: ast.Signal) -> None:
    """Check the declaration of a signal."""
    checker.infer(node.first)
    key, context = node.name.key, checker.context
    if key.startswith("$") and not context.table.is_system and key not in context.system.variables:
        message = f"{node.name.text} is not a predefined signal"
        checker.report("not-predefined-signal", node.name, message, is_unconfirmed=True)
    circle = _circle(context, node)
    own = [one.symbol.span for one in circle if context.declares(one)]
    if circle and node.name.span == max(own):  # one finding in each file
        names = [one.symbol.name for one in (*circle, circle[0])]
        message = f"{node.name.text} is no input or output, because it leads back to itself"
        reason = " names ".join(names)
        checker.report("signal-circle", node.first, message, reason=reason)
        return
    if node.last is None:
        return
    checker.infer(node.last)
    sides = written_side(node.first), written_side(node.last)
    if None not in sides and sides[0] != sides[1]:
        message = f"{node.name.text} mixes {sides[0]} and {sides[1]}"
        checker.report("signal-mixed", node.last, message)
        return
    first, last = _number(checker, node.first), _number(checker, node.last)
    if first is None or last is None:
        return
    width = last - first + 1
    if width < 1:
        message = f"{node.name.text} goes from {first} down to {last}"
        checker.report("signal-order", node.last, message, is_unconfirmed=True)
    elif width > _WIDEST:
        message = f"{node.name.text} has {width} bits, and a signal has at most {_WIDEST}"
        checker.report("signal-too-wide", node.last, message)


def _circle(context: Context, node: ast.Signal) -> list[Found]:
    """Return the signals over which a signal names itself, beginning with it; none if it does not.

    A controller that reads such a declaration has nothing to read or set, and linking refuses it.
    """
    found, circle = context.found(node.name), list[Found]()
    while found is not None and isinstance(found.symbol, SignalSymbol):
        if found in circle:
            return circle if found is circle[0] and found.symbol.span == node.name.span else []
        circle.append(found)
        root = root_variable(found.symbol.first)
        answer = found.scope.find(Space.VALUE, root.name.key) if root else None
        found = answer if isinstance(answer, Found) else None
    return []


def _number(checker: TypeChecker, node: ast.Expression) -> int | None:
    """Return the number of an input or output."""
    if isinstance(node, ast.Subscript) and len(node.indices) == 1:
        return integer_of(checker.context, node.indices[0])
    return None
