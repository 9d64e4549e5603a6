"""Motions, triggers, interrupts and cyclic signals: statements that only make requests.

Conditions and actions for later are passed as a `interp.port.requests.CodeHandle`.
"""

from __future__ import annotations

from grammar.syntax import ast
from interp.port.requests import (
    DeclareInterrupt,
    Move,
    MoveEmily,
    MoveSpline,
    Path,
    SetTrigger,
    SplineItem,
    SplineRange,
    SplineStop,
    SwitchInterrupt,
    SwitchSignal,
)
from interp.program.reads import is_constant_output, signal_name
from interp.tree.calls import Calls
from interp.tree.places import SystemPlace, of_type
from interp.tree.run import Steps
from interp.values.faults import LinkError
from interp.values.values import Value, copied, text_of


class Motions(Calls):
    """The execution of statements that make requests to the controller."""

    # ----------------------------------------------------------------------- motions

    def motion(self, node: ast.Motion) -> Steps[None]:
        """Request a motion: PTP, LIN, CIRC and all other kinds."""
        yield (yield from self._move(node))

    def _move(self, node: ast.Motion) -> Steps[Move]:
        auxiliary: Value | None = None
        if node.auxiliary is not None:
            auxiliary = copied((yield from self.value(node.auxiliary)))
        target = copied((yield from self.value(node.target)))
        return Move(
            self.at(),
            node.kind,
            target,
            auxiliary,
            (yield from self._optional(node.angle)),
            (yield from self._values(node.values)),
            node.criteria,
            None if node.reference is None else node.reference.name.key,
        )

    def _optional(self, node: ast.Expression | None) -> Steps[float | None]:
        return None if node is None else (yield from self.real(node))

    def _values(self, nodes: tuple[ast.Assignment, ...]) -> Steps[tuple[tuple[Path, Value], ...]]:
        """Return the assignments after WITH [SPL-08]."""
        found = []
        for node in nodes:
            place = yield from self.place(node.target)
            value = of_type(place.type, (yield from self.value(node.value, place.type)))
            if not isinstance(place, SystemPlace):
                raise LinkError("WITH gives a value to what is no system variable")
            found.append((place.path, value))
        return tuple(found)

    def emily_motion(self, node: ast.EmilyMotion) -> Steps[None]:
        """Request the motion of MOVE_EMI."""
        device = text_of((yield from self.value(node.device)))
        action = text_of((yield from self.value(node.action)))
        number = yield from self._optional(node.number)
        yield MoveEmily(self.at(), device, action, number)

    def spline_block(self, node: ast.SplineBlock) -> Steps[None]:
        """Evaluate all items of a spline block, then request it as one motion [SPL-01]."""
        values = yield from self._values(node.values)
        first, items = self.frame.line, []
        for item in node.items:
            self.frame.line = self.frame.unit.line(item)
            items.append((yield from self._item(item)))
        self.frame.line = first
        yield MoveSpline(self.at(), node.keyword, values, tuple(items), node.is_approximated)

    def _item(
        self, node: ast.Motion | ast.Trigger | ast.ConstantVelocity | ast.TimeBlock | ast.StopWhen
    ) -> Steps[SplineItem]:
        match node:
            case ast.Motion():
                return (yield from self._move(node))
            case ast.Trigger():
                return (yield from self._set_trigger(node))
            case ast.ConstantVelocity():
                place = yield from self.real(node.place)
                return SplineRange("CONST_VEL", node.edge, place, node.on_start)
            case ast.TimeBlock():
                value = yield from self._optional(node.value)
                return SplineRange("TIME_BLOCK", node.edge, value, on_start=False)
        place = yield from self.real(node.place)
        return SplineStop(place, node.on_start, self.run.defer(node.condition, self.frame))

    # ----------------------------------------------------------------------- triggers

    def trigger(self, node: ast.Trigger) -> Steps[None]:
        """Set a trigger of the next motion."""
        yield (yield from self._set_trigger(node))

    def _set_trigger(self, node: ast.Trigger) -> Steps[SetTrigger]:
        place = yield from self.real(node.place)
        delay = yield from self.real(node.delay)
        output = yield from self._output(node.action)
        priority = None if node.priority is None else (yield from self.integer(node.priority))
        action = self.run.defer(node.action, self.frame)
        return SetTrigger(
            *(self.at(), node.place_kind, place, node.on_start, delay, action, output, priority)
        )

    def _output(
        self, action: ast.Assignment | ast.CallStatement
    ) -> Steps[tuple[Path, Value] | None]:
        """Return the action as (path, value) if it assigns a constant to a system variable.

        The indices of the target must be literals too. Return ``None`` for any other action.
        """
        if not isinstance(action, ast.Assignment) or not is_constant_output(action):
            return None
        place = yield from self.place(action.target)
        if not isinstance(place, SystemPlace):
            return None
        value = yield from self.value(action.value, place.type)
        return place.path, of_type(place.type, value)

    # ----------------------------------------------------------------------- interrupts

    def interrupt_declaration(self, node: ast.InterruptDeclaration) -> Steps[None]:
        """Declare an interrupt [INT-01]."""
        number = yield from self.integer(node.number)
        condition = self.run.defer(node.condition, self.frame)
        action = self.run.defer(node.action, self.frame)
        yield DeclareInterrupt(self.at(), number, node.is_global, condition, action)

    def interrupt_switch(self, node: ast.InterruptSwitch) -> Steps[None]:
        """Switch interrupts: ON, OFF, ENABLE, DISABLE [INT-07]."""
        number = None if node.number is None else (yield from self.integer(node.number))
        yield SwitchInterrupt(self.at(), node.action, number)

    # ----------------------------------------------------------------------- cyclic signals

    def signal_on(self, node: ast.SignalOn) -> Steps[None]:
        """Execute ANIN ON, ANOUT ON or DIGIN ON [IOT-05, IOT-09]."""
        source = node.assignment.target if node.keyword == "ANOUT" else node.assignment.value
        name = self._signal_name(source)
        delay = yield from self._optional(node.delay)
        minimum = yield from self._optional(node.minimum)
        maximum = yield from self._optional(node.maximum)
        cycle = self.run.defer(node.assignment, self.frame)
        yield SwitchSignal(*(self.at(), node.keyword, True, name, cycle, delay, minimum, maximum))

    def signal_off(self, node: ast.SignalOff) -> Steps[None]:
        """Execute ANIN OFF, ANOUT OFF or DIGIN OFF."""
        name = self._signal_name(node.variable)
        yield SwitchSignal(*(self.at(), node.keyword, False, name, None, None, None, None))

    def _signal_name(self, node: ast.Expression) -> str:
        """Return the name of the signal in an expression, as it is in this file."""
        name = signal_name(self.frame.unit, node)
        if name is None:
            raise LinkError("nothing says which signal is meant")
        return name
