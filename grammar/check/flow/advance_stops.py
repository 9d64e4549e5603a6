"""Stops of the advance run, and approximations that are lost because of them.

The advance run is ahead of the robot. A statement that must be synchronous with the robot stops it
[ADV-04 to ADV-07]; the robot then stops exactly at the point before, even if that motion has an
approximation. CONTINUE cancels the stop of the next line [ADV-08].

All of this is valid, so it is reported as notes, and only on request.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.accesses import address_of
from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode
from grammar.check.flow.advance_stop_reasons import HARMLESS, AdvanceStop, is_known_call, stop_of
from grammar.check.flow.routine_summaries import ITSELF, STOPS, Clause, Fact, Summaries, Suspect
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region
from grammar.syntax import ast
from grammar.syntax.walk import walk
from support.lazy_dataclass import dataclass

#: So many statements behind an approximated motion are looked at.
_FARTHEST_LOOK = 200
_EXACT_STOP = "{}, and the robot stops exactly at this point (message 1442 or 1123)"
_MOTIONS = ast.Motion | ast.SplineBlock | ast.EmilyMotion


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield notes about all routines of a file; submit programs have no advance run."""
    if context.module.suffix == ".sub":
        return
    for routine in context.routines:
        yield from _Routine(context, routine).notes()


def add_stops(context: Context, made: Summaries) -> None:
    """Add to the summaries of a file the routines that stop the advance run before they move.

    A blend is lost before a call of such a routine.
    """
    for routine in context.routines if context.module.suffix != ".sub" else ():
        notes = _Routine(context, routine)
        made.clauses.update(dict.fromkeys(notes.clauses()))
        made.suspects.extend(notes.suspects())


@dataclass(frozen=True, slots=True)
class _Ahead:
    """What may come between a motion and the next one: stops, and whether the end is possible."""

    stops: tuple[FlowNode, ...]
    calls: tuple[Fact, ...]
    is_open: bool


class _Routine:
    """One routine; ``_spent`` are the lines after a CONTINUE."""

    def __init__(self, context: Context, routine: RoutineBody) -> None:
        self._context = context
        self._routine = routine
        self._statements = [placed.statement for placed in routine.statements]
        self._continues = [node for node in self._statements if isinstance(node, ast.Continue)]
        self._spent = {context.line(node) + 1 for node in self._continues}
        self._ways = routine.ways
        self._known: dict[tuple[ast.Node, bool], AdvanceStop | None] = {}

    def notes(self) -> Iterator[Diagnostic]:
        for node in self._statements:
            yield from self._stops(node, is_test=False)
            if isinstance(node, ast.Repeat):
                yield from self._stops(node, is_test=True)
        for step, _, _ in self._ways.steps:
            if _criteria(step.statement):
                yield from self._blend(step)
        yield from self._lost_continues()
        yield from self._without_advance()

    # ------------------------------------------------------------------------------ stops

    def _stop(self, node: ast.Node | None, is_test: bool) -> AdvanceStop | None:
        """Return why a statement stops the advance run, regardless of CONTINUE."""
        if node is None:
            return None
        key = node, is_test
        if key not in self._known:
            self._known[key] = stop_of(self._context, node, is_test)
        return self._known[key]

    def _is_taken_back(self, stop: AdvanceStop) -> bool:
        return self._context.line(stop.where) in self._spent

    def _stops(self, node: ast.Node, is_test: bool) -> Iterator[Diagnostic]:
        stop = self._stop(node, is_test)
        if stop is None or self._is_taken_back(stop):
            return
        fix = Fix("CONTINUE on the line before would let it be done ahead of the robot")
        yield self._context.finding(
            "stops-advance-run",
            self._context.head(stop.where),
            f"{stop.what} stops the advance run",
            reason=stop.reason,
            rules=stop.rules,
            fix=fix if stop.can_go_ahead else None,
        )

    # ------------------------------------------------------------------------------ calls

    def clauses(self) -> Iterator[Clause]:
        """Yield what has to be true for the routine to stop the advance run before it moves."""
        ahead = self._ahead(self._ways.start)
        if not ahead.is_open and (ahead.stops or ahead.calls):
            name = self._routine.node.name.key
            yield (STOPS, self._context.module.path, name, ITSELF), ahead.calls

    def suspects(self) -> Iterator[Suspect]:
        """Yield the approximated motions behind which only routines are called that may stop."""
        source = self._context.source
        for step, _, _ in self._ways.steps:
            criteria = _criteria(step.statement)
            ahead = self._ahead(step) if criteria else None
            if step.statement is None or ahead is None or ahead.is_open or ahead.stops:
                continue
            names = list(dict.fromkeys(name for _, _, name, _ in ahead.calls))
            said = f"{' and '.join(names)} stop{'s' * (len(names) == 1)} the advance run"
            yield Suspect(
                "no-blend",
                Region.of(source, self._context.head(step.statement)),
                f"{criteria} is lost: {said}",
                _EXACT_STOP.format("before the next motion"),
                ahead.calls,
            )

    # ------------------------------------------------------------------------------ blends

    def _blend(self, motion: FlowNode) -> Iterator[Diagnostic]:
        """Report an approximated motion if the advance run stops before the next motion."""
        ahead = self._ahead(motion)
        if not ahead.stops:
            return
        assert motion.statement is not None
        stopping = [self._stop(step.statement, step.is_test) for step in ahead.stops]
        lines = sorted({self._context.line(stop.where) for stop in stopping if stop})
        shown = ", ".join(map(str, lines[:3])) + (" …" if len(lines) > 3 else "")
        where = f"line{'s' * (len(lines) > 1)} {shown}"
        criteria = _criteria(motion.statement)
        is_open = ahead.is_open or bool(ahead.calls)
        how = "where the way leads there" if is_open else "before the next motion"
        yield self._context.finding(
            "no-blend",
            self._context.head(motion.statement),
            f"{criteria} is lost: {where} stop{'s' * (len(lines) == 1)} the advance run",
            reason=_EXACT_STOP.format(how),
        )

    def _ahead(self, motion: FlowNode) -> _Ahead:
        found: list[FlowNode] = []
        calls: dict[Fact, None] = {}
        is_open = False
        seen = {motion}
        todo = [motion]
        while todo:
            for step in self._ways.after[todo.pop()]:
                if step in seen:
                    is_open = is_open or step is motion
                    continue
                seen.add(step)
                stop = self._stop(step.statement, step.is_test)
                if stop is not None and not self._is_taken_back(stop):
                    found.append(step)
                elif (called := self._called(step)) is not None:
                    calls[STOPS, *called, ITSELF] = None
                elif self._is_boundary(step) or len(seen) > _FARTHEST_LOOK:
                    is_open = True
                else:
                    todo.append(step)
        return _Ahead(tuple(found), tuple(calls), is_open)

    def _called(self, step: FlowNode) -> tuple[str, str] | None:
        """Return the routine that a statement calls, if it is the only one and at hand."""
        node = step.statement
        if not isinstance(node, ast.CallStatement) or node.call.name.key in HARMLESS:
            return None
        if any(isinstance(inner, ast.Call) and inner is not node.call for inner in walk(node)):
            return None
        return address_of(self._context.found(node.call.name))

    def _is_boundary(self, step: FlowNode) -> bool:
        """Return whether the next motion begins here, or may begin in a called routine."""
        if step is self._ways.end or isinstance(step.statement, _MOTIONS | ast.Return):
            return True
        return step.statement is not None and not is_known_call(
            self._context, step.statement, step.is_test
        )

    # -------------------------------------------------------------------- CONTINUE, $ADVANCE

    def _lost_continues(self) -> Iterator[Diagnostic]:
        """Yield CONTINUE before a blank line or a comment."""
        source = self._context.source
        for node in self._continues:
            following = self._context.line(node) + 1
            text = source.line(following).strip()
            if not text or text.startswith(";"):
                what = "a comment" if text else "an empty line"
                message = f"CONTINUE is spent on {what}"
                yield self._context.finding("continue-lost", node, message)

    def _without_advance(self) -> Iterator[Diagnostic]:
        """Yield approximated motions that $ADVANCE=0 leads to."""
        steps = [step for step, _, _ in self._ways.steps]
        advances = {step: _advance(self._context, step.statement) for step in steps}
        todo = [step for step, value in advances.items() if value == 0]
        seen = set(todo)
        found: list[ast.Node] = []
        while todo:
            for step in self._ways.after[todo.pop()]:
                if step in seen or advances.get(step) is not None:
                    continue
                seen.add(step)
                statement = step.statement
                if statement is not None:
                    if _criteria(statement):
                        found.append(statement)
                    if not is_known_call(self._context, statement, step.is_test):
                        continue
                    call = statement.call if isinstance(statement, ast.CallStatement) else None
                    if call and call.name.key == "BAS":
                        continue  # it may set $ADVANCE
                todo.append(step)
        for node in found:
            message = f"{_criteria(node)} is lost: $ADVANCE is 0"
            yield self._context.finding("no-advance", self._context.head(node), message)


def _criteria(node: ast.Node | None) -> str:
    """Return the approximation criteria of a motion; empty without approximation."""
    match node:
        case ast.Motion(criteria=criteria):
            return " ".join(criteria)
        case ast.SplineBlock(is_approximated=True):
            return "C_SPL"
    return ""


def _advance(context: Context, node: ast.Node | None) -> float | None:
    """Return the value assigned to $ADVANCE; -1 if unknown, ``None`` if it is not assigned."""
    match node:
        case ast.Assignment(target=ast.Variable(name=name), value=value):
            if name.key == "$ADVANCE":
                known = constant(context, value)
                return known if isinstance(known, int) else -1
    return None
