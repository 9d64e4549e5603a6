"""Statements that stop the advance run, with the documented reason.

What counts is what a statement does when the advance run reaches it: the conditions that it
evaluates, its reads and writes. Later actions of interrupts and triggers do not count. The tables
of system variables and functions say which of them stop (`grammar.semantics.predefined`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.check.analysis.context import Context
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.syntax import ast
from grammar.syntax.walk import root_variable, walk
from support.lazy_dataclass import dataclass

_IN_STEP = "it is read or set in step with the robot"
_WAITS = "the program continues when the robot has reached it"
#: Delivered with every controller, and written so that it does not stop without need [ADV-06].
HARMLESS = frozenset({"BAS"})


@dataclass(frozen=True, slots=True)
class AdvanceStop:
    """The reason why a statement stops the advance run: ``what`` stops it, at the node ``where``.

    ``can_go_ahead`` if a CONTINUE before it makes sense, so that it is executed ahead of the robot.
    """

    where: ast.Node
    what: str
    reason: str
    rules: tuple[str, ...]
    can_go_ahead: bool


def stop_of(context: Context, node: ast.Node, is_test: bool = False) -> AdvanceStop | None:
    """Return why a statement stops, or ``None``; ``is_test`` asks about UNTIL of a REPEAT."""
    waiting = _waiting(context, node)
    if waiting is not None:
        return waiting
    where = node.condition if is_test and isinstance(node, ast.Repeat) else node
    found: dict[str, tuple[str, ...]] = {}
    written = _written(node)
    if written is not None:
        for name, rules in _variable(context, written, is_write=True):
            found.setdefault(f"setting {name}", rules)
    for expression in evaluated(node, is_test):
        for inner in walk(expression):
            if isinstance(inner, ast.Variable) and inner is not written:
                for name, rules in _variable(context, inner, is_write=False):
                    found.setdefault(f"reading {name}", rules)
            elif isinstance(inner, ast.Call):
                function = context.system.functions.get(inner.name.key)
                if function is not None and function.stops and _is_system(context, inner.name):
                    found.setdefault(function.name, function.stops)
    if not found:
        return None
    rules = tuple(dict.fromkeys(rule for its in found.values() for rule in its))
    return AdvanceStop(where, " and ".join(found), _IN_STEP, rules, can_go_ahead=True)


def _waiting(context: Context, node: ast.Node) -> AdvanceStop | None:
    match node:
        case ast.Halt():
            return AdvanceStop(node, "HALT", _WAITS, ("ADV-04", "CTL-08"), can_go_ahead=False)
        case ast.WaitSeconds():
            return AdvanceStop(node, "WAIT SEC", _WAITS, ("ADV-04", "CTL-12"), can_go_ahead=False)
        case ast.WaitFor():
            return AdvanceStop(node, "WAIT FOR", _WAITS, ("ADV-04", "CTL-12"), can_go_ahead=True)
        case ast.SignalOn(keyword=keyword) | ast.SignalOff(keyword=keyword):
            rules = ("ADV-07",) if keyword == "DIGIN" else ("ADV-04",)
            switch = "ON" if isinstance(node, ast.SignalOn) else "OFF"
            return AdvanceStop(node, f"{keyword} {switch}", _IN_STEP, rules, can_go_ahead=False)
        case ast.CallStatement(call=call):
            function = context.system.functions.get(call.name.key)
            if function is not None and function.stops and _is_system(context, call.name):
                return AdvanceStop(node, function.name, _IN_STEP, function.stops, can_go_ahead=True)
    return None


def is_known_call(context: Context, node: ast.Node, is_test: bool = False) -> bool:
    """Return whether the calls in a statement are known neither to move nor to stop."""
    return all(
        inner.name.key in HARMLESS or _is_system(context, inner.name)
        for expression in evaluated(node, is_test)
        for inner in walk(expression)
        if isinstance(inner, ast.Call)
    )


def evaluated(node: ast.Node, is_test: bool = False) -> Iterator[ast.Expression]:
    """Yield the expressions that the advance run evaluates for a statement, without blocks."""
    yield from (part for part in _parts(node, is_test) if part is not None)


def _parts(node: ast.Node, is_test: bool) -> Sequence[ast.Expression | None]:
    match node:
        case ast.Assignment(target=target, value=value):
            return (target,) if _is_cyclical(target) else (target, value)
        case ast.CallStatement(call=call):
            return (call,)
        case ast.If() | ast.While() | ast.WaitFor():
            return (node.condition,)
        case ast.Repeat(condition=condition) if is_test:
            return (condition,)
        case ast.For():
            return node.first, node.last, node.step
        case ast.Switch():
            return (node.selector,)
        case ast.Return():
            return (node.value,)
        case ast.Motion():
            values = [assignment.value for assignment in node.values]
            return node.auxiliary, node.target, node.angle, *values
        case ast.SplineBlock():
            return [assignment.value for assignment in node.values]
        case ast.Trigger():
            return node.place, node.delay
    return ()


def _is_cyclical(target: ast.Expression) -> bool:
    """Return whether an assignment stores the expression itself and not its value [IOT-11]."""
    root = root_variable(target)
    return root is not None and root.name.key == "$CYCFLAG"


def _written(node: ast.Node) -> ast.Variable | None:
    return root_variable(node.target) if isinstance(node, ast.Assignment) else None


def _is_system(context: Context, name: ast.Name) -> bool:
    """Return whether a name denotes something predefined, as far as is known."""
    found = context.found(name)
    if found is None:
        return name.key in context.system.functions
    return found.module is None


def _variable(
    context: Context, variable: ast.Variable, *, is_write: bool
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield what to call a variable whose access stops, with the rules that say so."""
    name = variable.name
    found = context.found(name)
    if found is not None and found.symbol.kind is Kind.IMPORT:
        yield f"{name.text}, which is imported,", ("ADV-05",)
        return
    shown, key = name.text, name.key
    if found is not None and isinstance(found.symbol, SignalSymbol):
        root = root_variable(found.symbol.first)
        if root is None:  # connected to nothing
            return
        shown, key = f"{shown}, a signal of {root.name.key},", root.name.key
    elif found is not None and found.module is not None and not key.startswith("$"):
        return
    known = context.system.variables.get(key) if key.startswith("$") else None
    if known is not None:
        rules = known.stops_on_write if is_write else known.stops_on_read
        if rules:
            yield shown, rules
