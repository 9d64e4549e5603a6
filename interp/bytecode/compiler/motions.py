"""Code for motions, triggers, interrupts and cyclic signals, which consist of requests only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from grammar.semantics.types import REAL, UNKNOWN, Array, Type
from grammar.semantics.types import Scalar as Number
from grammar.syntax import ast
from grammar.syntax.walk import walk
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.context import Deferred
from interp.bytecode.compiler.expressions import CodeMaker
from interp.bytecode.compiler.locations import (
    FrameCells,
    Location,
    Pushed,
    PushedView,
    Reference,
    Scalar,
    SystemVariable,
    Value,
)
from interp.bytecode.program import (
    Argument,
    Choice,
    CodeKind,
    Constant,
    Handle,
    Input,
    Items,
    Mode,
    Record,
)
from interp.port.requests import BaseRequest
from interp.program.literals import literal_value
from interp.program.reads import is_constant_output, signal_name
from interp.program.statement_requests import STATEMENT_REQUESTS, Fixed, Part
from interp.values.faults import Fault, LinkError
from interp.values.values import EnumValue, converted
from interp.values.values import Value as Known


class Motions(CodeMaker):
    """Generates code for statements that make the controller do something."""

    # ----------------------------------------------------------------------- motions

    def motion(self, node: ast.Motion) -> None:
        """Generate PTP, LIN, CIRC and all other motions."""
        self._emitter.ask("Move", *self._move(node))

    def _move(self, node: ast.Motion, *, is_early: bool = False) -> tuple[Argument, ...]:
        """Return the parts of a motion; ``is_early`` if variables may change before the request."""
        auxiliary: FrameCells | None = None
        if node.auxiliary is not None:
            auxiliary = self._kept(node.auxiliary)
        target = self._memory.handed(self._target(node, is_early=is_early))
        parts: list[Argument] = [Constant(node.kind), target, Constant(None)]
        if auxiliary is not None:
            self._memory.refer(auxiliary)
            parts[2] = self._memory.handed(Reference(auxiliary.type))
        parts.append(self._optional(node.angle, REAL))
        parts.append(self._values(node.values, is_early=is_early))
        parts.append(Items(tuple(Constant(one) for one in node.criteria)))
        parts.append(Constant(None if node.reference is None else node.reference.name.key))
        return tuple(parts)

    def _target(self, node: ast.Motion, *, is_early: bool) -> Value:
        """Generate the target; a copy of it if it could change before the request is made."""
        if is_early or self._disturbs((*_parts_of_values(node.values), node.angle)):
            return self._memory.load(self._kept(node.target))
        return self._expressions.value(node.target)

    def _disturbs(self, nodes: Iterable[ast.Expression | None]) -> bool:
        """Return whether variables may change while these expressions are evaluated.

        Called functions can change them. So can an action that is entered while a request is
        answered.
        """
        named = [inner for node in nodes if node is not None for inner in walk(node)]
        return any(
            isinstance(one, ast.Call) or (isinstance(one, ast.Variable) and self._is_asked(one))
            for one in named
        )

    def _is_asked(self, node: ast.Variable) -> bool:
        """Return whether a variable may be read by a request."""
        found = self._context.unit.found(node.name)
        if found is None:
            return True
        place = self._context.variables.get(found.symbol)
        return isinstance(place, SystemVariable) or (
            place is None and found.symbol not in self._context.tables.places
        )

    def _kept(self, node: ast.Expression) -> FrameCells:
        """Generate a copy of a value in the frame."""
        behind = self._writer.here
        value = self._expressions.value(node)
        if not isinstance(value, Reference | Scalar):
            raise self._emitter.refuse("a motion goes to what is no position")
        return self._memory.kept(value, behind)

    def _optional(self, node: ast.Expression | None, type_: Type) -> Argument:
        if node is None:
            return Constant(None)
        self._expressions.number(node, type_)
        return Input(Mode.IN, self._emitter.number(type_))

    def _values(self, nodes: tuple[ast.Assignment, ...], *, is_early: bool = False) -> Items:
        """Generate the assignments after WITH [SPL-08]; ``is_early`` as in `_move`."""
        found: list[Argument] = []
        for number, node in enumerate(nodes, 1):
            place = self._designators.place(node.target)
            if not isinstance(place, SystemVariable):
                raise self._emitter.unlinked("WITH gives a value to what is no system variable")
            path = self._memory.pushed_path(place)
            behind = self._writer.here
            value = self._expressions.value(node.value, place.type)
            if isinstance(value, Reference) and (
                is_early or self._disturbs(_parts_of_values(nodes[number:]))
            ):
                kept = self._memory.kept(value, behind)
                behind = self._writer.here
                self._memory.refer(kept)
            found.append(Items((path, self._memory.remote_value(place.type, value, behind))))
        return Items(tuple(found))

    def _word(self, node: ast.Expression) -> Argument:
        value = self._expressions.value(node)
        if isinstance(value, Reference):
            value = self._memory.as_view(value)
        if isinstance(value, Scalar):
            raise self._emitter.fail("argument")
        return self._memory.handed(value)

    # ----------------------------------------------------------------------- spline blocks

    def spline_block(self, node: ast.SplineBlock, end: Label) -> None:
        """Generate SPLINE: its items are evaluated first, then planned as one motion [SPL-01]."""
        places = enumerate(node.items, 1)
        last = max((at for at, one in places if self._disturbs(_parts_of(one))), default=0)
        values = self._values(node.values, is_early=last > 0)
        first, items = self._context.line, []
        for at, item in enumerate(node.items, 1):
            self._go_on_at(self._context.unit.line(item), end)
            if isinstance(item, ast.Motion):
                parts = self._move(item, is_early=at < last)
                items.append(Record("Move", self._context.line, parts))
            else:
                items.append(self._record(item))
        self._go_on_at(first, end)
        is_approximated = Constant(node.is_approximated)
        self._emitter.ask(
            "MoveSpline", Constant(node.keyword), values, Items(tuple(items)), is_approximated
        )

    def _go_on_at(self, line: int, end: Label) -> None:
        if line != self._context.line:
            self._context.line = line
            self._emit(Op.AT, line, end)

    def _record(self, node: ast.Node) -> Record:
        request = STATEMENT_REQUESTS[type(node)].request
        line = self._context.line if issubclass(request, BaseRequest) else 0
        return Record(request.__name__, line, self.parts(node))

    # ----------------------------------------------------------------------- other requests

    def parts(self, node: ast.Node) -> tuple[Argument, ...]:
        """Generate the parts of a statement of `STATEMENT_REQUESTS`."""
        return tuple(self._part(node, part) for part in STATEMENT_REQUESTS[type(node)].parts)

    def _part(self, node: Any, part: str | Part | Fixed) -> Argument:
        if not isinstance(part, Part):
            return Constant(part.value if isinstance(part, Fixed) else getattr(node, part))
        value = getattr(node, part.field)
        match part.kind:
            case "text":
                return self._word(value)
            case "output":
                return self._output(value)
            case "signal":
                try:
                    return Constant(signal_name(self._context.unit, node))
                except LinkError as error:
                    raise self._emitter.unlinked(str(error)) from None
            case "condition" | "action" as kind:
                return self.deferred(value, CodeKind(kind))
        return self._optional(value, part.kind)

    def deferred(self, node: Deferred, kind: CodeKind) -> Handle:
        """Return an action or a condition as a part of a request."""
        return Handle(self._context.shared.codes.deferred(self._context, node, kind))

    def _output(self, action: ast.Assignment | ast.CallStatement) -> Argument:
        """Return the assignment as a constant output, if it is one: literal value and indices."""
        if not isinstance(action, ast.Assignment) or not is_constant_output(action):
            return Constant(None)
        before = self._writer.here
        place = self._designators.place(action.target)
        if not isinstance(place, SystemVariable):
            self._forget(place, before)
            return Constant(None)
        value = self._known(action.value, place.type)
        path = self._memory.pushed_path(place)
        return Items((path, self._as_part(value)))

    def _forget(self, place: Location, behind: int) -> None:
        """Remove an unused location from the stack; its index may still be out of range."""
        if isinstance(place, Pushed):
            self._memory.kept(Reference(place.type), behind)
        elif isinstance(place, PushedView):
            self._writer.cut(behind)

    def _known(self, node: ast.Expression, type_: Type) -> Known:
        """Return the value of a literal converted to the type of a system variable."""
        try:
            value = literal_value(self._context.unit, node, type_)
            is_open = type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes)
            return value if is_open else converted(value, type_)
        except Fault as error:
            raise self._emitter.fail(error.slug) from None
        except LinkError as error:
            raise self._emitter.unlinked(str(error)) from None

    def _as_part(self, value: Known) -> Argument:
        if isinstance(value, EnumValue):
            return Choice(self._emitter.number(value.type), value.index)
        if isinstance(value, int | float | str):
            return Constant(value)
        raise self._emitter.refuse("a text is the output of a trigger")


def _parts_of_values(nodes: Iterable[ast.Assignment]) -> Iterator[ast.Expression | None]:
    """Yield the expressions in assignments after WITH: values, and indices of targets."""
    for node in nodes:
        for inner in walk(node.target):
            if isinstance(inner, ast.Subscript):
                yield from inner.indices
        yield node.value


def _parts_of(node: ast.Node) -> Iterator[ast.Expression | None]:
    """Yield the expressions in a spline item that are evaluated before the request of the block."""
    if isinstance(node, ast.Motion):
        yield from (node.target, node.auxiliary, *_parts_of_values(node.values), node.angle)
        return
    for part in STATEMENT_REQUESTS[type(node)].parts:
        if isinstance(part, Part) and isinstance(part.kind, Number):
            yield getattr(node, part.field)
