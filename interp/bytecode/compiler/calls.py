"""Code for calls of routines of the program.

A routine is compiled for the way in which it is called. A variable that is passed :OUT becomes a
reference, an array becomes a view with the sizes of the argument. There are no references to system
variables: the routine is compiled again for the system variable that it is given, with parameters
for its indices only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grammar.semantics.scopes import Found
from grammar.semantics.types import CHAR, Array, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import walk
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain
from interp.bytecode.compiler.buffer_sizes import Bound
from interp.bytecode.compiler.context import Binding
from interp.bytecode.compiler.emitter import Emitter
from interp.bytecode.compiler.expressions import CodeMaker, Expressions
from interp.bytecode.compiler.locations import (
    FrameCells,
    IndexCell,
    Location,
    PushedView,
    Reference,
    Scalar,
    SystemVariable,
    Text,
    Value,
    View,
    ViewParameter,
    is_view_of,
)
from interp.bytecode.compiler.predefined_calls import PredefinedCalls
from interp.program.load import Routine
from interp.program.reads import is_input, is_variable
from interp.program.variables import (
    MOST_CELLS,
    cells_of_routine,
    is_complete,
    is_complete_parameter,
    mismatched,
    untyped_parameter,
    untyped_result,
)


@dataclass(frozen=True, slots=True)
class Formals:
    """The declared parameters of a routine: symbols, types, and whether each is :IN."""

    found: tuple[Found, ...]
    types: tuple[Type, ...]
    is_in: tuple[bool, ...]


def formals_of(routine: Routine, type_of: Callable[[Found], Type]) -> Formals:
    """Return the declared parameters of a routine."""
    found = []
    for parameter in routine.node.parameters:
        means = routine.scope.own(Space.VALUE, parameter.name.key)
        assert means is not None, "a routine's table has its parameters"
        found.append(means)
    types = tuple(type_of(one) for one in found)
    is_in = tuple(parameter.mode == "IN" for parameter in routine.node.parameters)
    return Formals(tuple(found), types, is_in)


class Calls(CodeMaker):
    """Generates code for calls; its ``expressions`` generate code for expressions with calls."""

    def __init__(self, emitter: Emitter) -> None:
        super().__init__(Expressions(emitter, self.call))
        self.expressions = self._expressions
        self._predefined = PredefinedCalls(self.expressions)

    def call(self, node: ast.Call) -> Value:
        """Generate a call of a function; return what it leaves on the stack."""
        value = self.called(node, is_value=True)
        if value is None:
            raise self._emitter.unlinked(f"{node.name.text} gives no value")
        return value

    def called(self, node: ast.Call, *, is_value: bool) -> Value | None:
        """Generate a call of a routine; return its result, or ``None`` if it has none."""
        found = self._context.unit.found(node.name)
        if found is None:
            raise self._emitter.unlinked(self._context.unit.undeclared(node.name))
        if found.module is None:
            return self._predefined.predefined(node, is_value=is_value)
        routine = self._context.program.routines.get(found.symbol)
        if routine is None:
            raise self._emitter.unlinked(f"{node.name.text} is a routine that no file has")
        return self._routine(node, routine)

    def _routine(self, node: ast.Call, routine: Routine) -> Value | None:
        program = self._context.program
        formals = formals_of(routine, program.type_of)
        result = program.result_of(routine)
        kept: FrameCells | None = None
        if result is not None and not is_complete(result):
            raise self._emitter.refuse(str(untyped_result(routine.name)))
        if result is not None:
            result = self._emitter.closed(result)
            if not isinstance(result, Plain):
                kept = FrameCells(self._writer.temporary(result), result)
                self._memory.refer(kept)
        bindings: list[Binding] = []
        bounds: list[Bound | None] = []
        for place, type_ in enumerate(formals.types):
            argument = node.arguments[place] if place < len(node.arguments) else None
            later = node.arguments[place + 1 :]
            if not is_complete_parameter(type_):
                name = formals.found[place].symbol.name
                raise self._emitter.refuse(str(untyped_parameter(name, routine.name)))
            binding, bound = self._passed(type_, argument, formals.is_in[place], later)
            bindings.append(binding)
            bounds.append(bound)
        if self._context.tables.cells + cells_of_routine(program, routine) > MOST_CELLS:
            raise self._emitter.fail("stack")
        number = self._context.shared.codes.code_of(routine, tuple(bindings))
        for place, bound in enumerate(bounds):
            if bound is not None:
                self._context.shared.sizes.receives((number, place), bound)
        self._emit(Op.CALL, number)
        if kept is not None:
            self._memory.refer(kept)
            return Reference(kept.type)
        return None if result is None else Scalar(result)

    def _passed(
        self,
        type_: Type,
        argument: ast.Expression | None,
        is_in: bool,
        later: Sequence[ast.Expression | None],
    ) -> tuple[Binding, Bound | None]:
        """Push an argument, or the indices of an argument that is a system variable.

        Return the binding for a system variable, and the maximum number of elements of an array.
        """
        is_view = isinstance(type_, Array) and (not is_in or None in type_.sizes)
        if argument is None:
            return None, self._left_out(type_, is_in, is_view)
        if not is_in and is_variable(self._context.unit, argument):
            place = self._designators.place(argument)
            if isinstance(place, SystemVariable):
                return self._bound(place), None
            return None, self._referred(place, type_, is_view)
        if is_view:
            return None, self._copied_view(type_, argument)
        closed = self._emitter.closed(type_)
        if not is_in or not isinstance(closed, Plain):
            self._copied(closed, argument, is_in and not _calls(later))
        elif not self._is_handed_on(closed, argument):
            self._memory.convert(self._expressions.value(argument, type_), closed)
        return None, None

    def _is_handed_on(self, type_: Plain, argument: ast.Expression) -> bool:
        """Push a parameter :IN of the same type, which may have been left out [SCO-13]."""
        if not is_input(self._context.unit, argument):
            return False
        place = self._designators.place(argument)
        if not isinstance(place, FrameCells) or place.type != type_:
            return False
        self._emit(Op.PASS_LOCAL, place.offset)
        return True

    def _bound(self, place: SystemVariable) -> Binding:
        """Push the indices of a system variable; return its path, to compile the routine for."""
        self._memory.pushed_path(place)
        path = tuple(None if isinstance(step, IndexCell) else step for step in place.path)
        return path, place.type

    def _left_out(self, type_: Type, is_in: bool, is_view: bool) -> Bound | None:
        if isinstance(type_, Array) and is_view and None in type_.sizes:
            self._emit(Op.PUSH_NO_VIEW, self._emitter.number(type_.element), len(type_.sizes))
            return None
        closed = self._emitter.closed(type_)
        if is_in and isinstance(closed, Plain):
            self._emit(Op.PUSH_NOTHING)
            return None
        kept = FrameCells(self._writer.temporary(closed), closed)
        self._memory.refer(kept)
        self._emit(Op.CLEAR, self._emitter.number(closed))
        self._memory.refer(kept)
        return self._memory.as_view(Reference(closed)).most if is_view else None

    def _referred(self, place: Location, type_: Type, is_view: bool) -> Bound | None:
        """Push a reference to a variable, or a view of an array.

        An array parameter that was left out is passed on as left out [SCO-13].
        """
        assert not isinstance(place, SystemVariable), "it is bound"
        given: Reference | View
        if isinstance(place, ViewParameter | PushedView):
            given = self._memory.view(place, may_be_missing=True)
        else:
            self._memory.refer(place)
            given = Reference(place.type)
        if isinstance(type_, Array) and is_view:
            is_array = isinstance(given, View) or isinstance(given.type, Array)
            view = self._memory.as_view(given) if is_array else None
            if view is not None and is_view_of(
                view, self._emitter.closed(type_.element), len(type_.sizes)
            ):
                return view.most
        elif given == Reference(self._emitter.closed(type_)):
            return None
        raise self._emitter.unlinked(str(mismatched(type_)))

    def _copied(self, type_: Type, argument: ast.Expression, is_copied_by_call: bool) -> None:
        """Push a reference to a value, copied first unless the call copies it in time."""
        kept = FrameCells(self._writer.temporary(type_), type_)
        behind = self._writer.here
        value = self._expressions.value(argument, type_)
        if value == Reference(type_) and is_copied_by_call:
            return
        if isinstance(type_, Plain):
            self._memory.convert(value, type_)
            self._emit(Op.STORE_LOCAL, kept.offset)
            self._memory.refer(kept)
            return
        self._memory.converted_below(kept, value, behind)

    def _copied_view(self, type_: Type, argument: ast.Expression) -> Bound:
        """Push a view of a copy of a value."""
        assert isinstance(type_, Array), "only arrays are views"
        behind = self._writer.here
        value = self._expressions.value(argument, type_)
        if isinstance(value, View) and None in type_.sizes:
            return self._copied_to_buffer(type_, value)
        made: Type = type_
        if None in type_.sizes:
            match value:
                case Text(text):
                    made = Array(CHAR, (max(1, len(text)),))
                case Reference(Array() as made):
                    pass
                case _:
                    raise self._emitter.unlinked(str(mismatched(type_)))
        made = self._emitter.closed(made)
        assert isinstance(made, Array), "made of one"
        if (made.element, len(made.sizes)) != (
            self._emitter.closed(type_.element),
            len(type_.sizes),
        ):
            raise self._emitter.unlinked(str(mismatched(type_)))
        kept = FrameCells(self._writer.temporary(made), made)
        self._memory.converted_below(kept, value, behind)
        return self._memory.as_view(Reference(made)).most

    def _copied_to_buffer(self, type_: Array, value: View) -> Bound:
        """Replace the view on top by one of a copy of the array; its size is not constant."""
        if not is_view_of(value, self._emitter.closed(type_.element), len(type_.sizes)):
            raise self._emitter.unlinked(str(mismatched(type_)))
        buffer = self._writer.copy_buffer(value.element, value.dimensions, value.most)
        self._emit(Op.COPY_VIEW, buffer.offset, buffer.type)
        return value.most


def _calls(nodes: Sequence[ast.Expression | None]) -> bool:
    """Return whether the evaluation of expressions calls something that may change variables."""
    return any(
        isinstance(inner, ast.Call) for node in nodes if node is not None for inner in walk(node)
    )
