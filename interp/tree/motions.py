"""Motions, triggers, interrupts and cyclic signals: statements that only make requests.

Conditions and actions for later are passed as a `interp.port.requests.CodeHandle`.
"""

from __future__ import annotations

from typing import Any

from grammar.semantics.types import Scalar
from grammar.syntax import ast
from interp.port.requests import BaseRequest, Move, MoveSpline, Path, SplineItem
from interp.program.reads import is_constant_output, signal_name
from interp.program.statement_requests import STATEMENT_REQUESTS, Fixed, Part
from interp.tree.calls import Calls
from interp.tree.places import SystemPlace, of_type
from interp.tree.program_state import Steps
from interp.values.faults import LinkError
from interp.values.values import Value, converted, copied, text_of


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
            None if node.angle is None else (yield from self.real(node.angle)),
            (yield from self._values(node.values)),
            node.criteria,
            None if node.reference is None else node.reference.name.key,
        )

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

    def spline_block(self, node: ast.SplineBlock) -> Steps[None]:
        """Evaluate all items of a spline block, then request it as one motion [SPL-01]."""
        values = yield from self._values(node.values)
        first, items = self.frame.line, list[SplineItem]()
        for item in node.items:
            self.frame.line = self.frame.unit.line(item)
            if isinstance(item, ast.Motion):
                items.append((yield from self._move(item)))
            else:
                items.append((yield from self.requested(item)))
        self.frame.line = first
        yield MoveSpline(self.at(), node.keyword, values, tuple(items), node.is_approximated)

    # ----------------------------------------------------------------------- other requests

    def requested(self, node: ast.Node) -> Steps[Any]:
        """Evaluate a statement of `STATEMENT_REQUESTS`, and return its request."""
        made = STATEMENT_REQUESTS[type(node)]
        parts: list[Any] = [self.at()] if issubclass(made.request, BaseRequest) else []
        for part in made.parts:
            if isinstance(part, Part):
                parts.append((yield from self._part(node, getattr(node, part.field), part.kind)))
            else:
                parts.append(part.value if isinstance(part, Fixed) else getattr(node, part))
        return made.request(*parts)

    def _part(self, node: Any, value: Any, kind: object) -> Steps[Any]:
        match kind:
            case Scalar():
                if value is None:
                    return None
                return converted((yield from self.value(value, kind)), kind)
            case "text":
                return text_of((yield from self.value(value)))
            case "output":
                return (yield from self._output(value))
            case "signal":
                return signal_name(self.frame.unit, node)
        return self.run.defer(value, self.frame)

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
