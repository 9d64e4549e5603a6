"""Numbers and values with limits: interrupts, triggers, pulses, cyclic flags.

Only values that are known before a program runs are checked.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, RoutineBody
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.motion_kinds import WITHOUT_PATH
from grammar.semantics.predefined import is_priority
from grammar.semantics.symbols import Access, Kind
from grammar.syntax import ast
from grammar.syntax.walk import root_variable, walk

#: The shortest and the longest pulse in seconds, a little more than 0.1 as a REAL [IOT-07.a].
_PULSE = (0.1, 3.0)
#: Milliseconds or millimetres: how far a trigger can be shifted [TRG-03, TRG-04].
_FARTHEST = 10_000_000
_STOP_MESSAGE = "$STOPMESS"


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about values outside their limits."""
    for routine in context.routines:
        for placed in routine.statements:
            match placed.statement:
                case ast.InterruptDeclaration() as declaration:
                    yield from _interrupt(context, declaration)
                case ast.InterruptSwitch(number=number) if number is not None:
                    yield from _interrupt_number(context, number, is_own=False)
                case ast.WaitSeconds(duration=duration):
                    yield from _duration(context, duration)
                case ast.Trigger() as trigger:
                    yield from _trigger(context, trigger)
                case ast.Assignment(target=ast.Subscript()) as assignment:
                    yield from _cyclical_flag(context, assignment)
        yield from _before_ptp(context, routine)
    for call in context.typed_nodes[ast.Call] if context.routines else ():
        if call.name.key == "PULSE" and len(call.arguments) == 3:
            yield from _pulse(context, call.arguments[2])


def _number(context: Context, node: ast.Expression | None) -> float | None:
    """Return the value of a constant number, or ``None``."""
    value = None if node is None else constant(context, node)
    return value if isinstance(value, int | float) and not isinstance(value, bool) else None


# ------------------------------------------------------------------------------------- interrupts


def _interrupt(context: Context, node: ast.InterruptDeclaration) -> Iterator[Diagnostic]:
    is_own = not _may_be_stop_message(context, node.condition)
    yield from _interrupt_number(context, node.number, is_own=is_own)


def _interrupt_number(
    context: Context, node: ast.Expression, *, is_own: bool
) -> Iterator[Diagnostic]:
    number = _number(context, node)
    if number is None or is_priority(number) or (number == 3 and not is_own):
        return
    message = f"an interrupt cannot have the number {number:g}"
    reason = "3 and 40 to 80 belong to the system" if 0 < number <= 80 else ""
    yield context.finding(
        "interrupt-number",
        node,
        message,
        reason=reason,
        severity="warning" if number == 3 else None,
    )


def _duration(context: Context, node: ast.Expression) -> Iterator[Diagnostic]:
    """WAIT SEC with less than nothing waits for nothing: the sign is a slip."""
    seconds = _number(context, node)
    if seconds is not None and seconds < 0:
        message = f"WAIT SEC of {seconds:g} seconds does not wait"
        yield context.finding("negative-wait", node, message)


def _pulse(context: Context, node: ast.Expression | None) -> Iterator[Diagnostic]:
    seconds, (shortest, longest) = _number(context, node), _PULSE
    if node is not None and seconds is not None and not shortest <= seconds <= longest:
        message = f"a pulse lasts {shortest:g} to {longest:g} seconds, and not {seconds:g}"
        yield context.finding("pulse-duration", node, message)


def _may_be_stop_message(context: Context, condition: ast.Expression) -> bool:
    """Return whether a condition is that of interrupt 3, which every program has [INT-02]."""
    names = (node.name for node in walk(condition) if isinstance(node, ast.Variable))
    return any(name.key == _STOP_MESSAGE or context.found(name) is None for name in names)


# --------------------------------------------------------------------------------------- triggers


def _trigger(context: Context, node: ast.Trigger) -> Iterator[Diagnostic]:
    place, delay = _number(context, node.place), _number(context, node.delay)
    if node.place_kind == "DISTANCE":
        if place is not None and place not in (0, 1):
            message = f"DISTANCE is 0 or 1, and not {place:g}"
            yield context.finding("trigger-limits", node.place, message, rules=("TRG-01",))
    elif place is not None and abs(place) > _FARTHEST:
        message = f"PATH reaches to {_FARTHEST:,} mm"
        yield context.finding("trigger-limits", node.place, message, rules=("TRG-04",))
    if delay is not None and abs(delay) > _FARTHEST:
        message = f"DELAY reaches to {_FARTHEST:,} ms"
        yield context.finding("trigger-limits", node.delay, message, rules=("TRG-03",))
    priority = _number(context, node.priority)
    if priority is not None and priority != -1 and not is_priority(priority):
        assert node.priority is not None
        message = f"a trigger cannot have the priority {priority:g}"
        yield context.finding("trigger-priority", node.priority, message)
    if isinstance(node.action, ast.CallStatement):
        if node.priority is None and node.action.call.name.key != "PULSE":  # no call [TRG-05]
            message = f"a trigger that calls {node.action.call.name.text} needs PRIO"
            yield context.finding("trigger-priority", node.action, message)
        return
    variable = root_variable(node.action.target)
    if variable is not None and _is_local(context, variable):
        message = f"a trigger assigns to {variable.name.text}, a variable of the routine"
        yield context.finding("trigger-local", node.action.target, message)


def _before_ptp(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Triggers with PATH whose next motion is a PTP, as far as statements follow one another."""
    waiting: list[ast.Trigger] = []
    inside = None
    for placed in routine.statements:
        statement = placed.statement
        if placed.inside is not inside or type(statement) in _ELSEWHERE:
            waiting, inside = [], placed.inside
        if isinstance(statement, ast.Trigger) and statement.place_kind == "PATH":
            waiting.append(statement)
        elif isinstance(statement, ast.Motion):
            if statement.kind in WITHOUT_PATH:
                line = context.line(statement)
                for trigger in waiting:
                    message = f"PATH before {statement.kind} on line {line}"
                    yield context.finding("path-before-ptp", trigger, message)
            waiting = []


#: Behind these the next motion may be one that stands elsewhere.
_ELSEWHERE = frozenset((
    ast.Goto, ast.Label, ast.Return, ast.Exit, ast.CallStatement, ast.If, ast.Switch,
    ast.For, ast.While, ast.Repeat, ast.Loop, ast.SplineBlock, ast.EmilyMotion,
))  # fmt: skip


# --------------------------------------------------------------------------------- cyclical flags


def _is_local(context: Context, variable: ast.Variable) -> bool:
    """Return whether a variable is local data of its routine; a signal has no data of its own."""
    found = context.found(variable.name)
    return (
        found is not None
        and found.symbol.access is Access.ROUTINE
        and found.symbol.kind is not Kind.SIGNAL
    )


def _cyclical_flag(context: Context, node: ast.Assignment) -> Iterator[Diagnostic]:
    target = root_variable(node.target)
    if target is None or target.name.key != "$CYCFLAG":
        return
    for inner in walk(node.value):
        if isinstance(inner, ast.Call):
            message = f"a cyclical flag that depends on the function {inner.name.text}"
            yield context.finding("cycflag-function", inner, message)
        elif isinstance(inner, ast.Variable) and _is_local(context, inner):
            message = f"a cyclical flag that depends on {inner.name.text}, local data"
            yield context.finding("cycflag-local", inner, message)
