"""Calls: of routines of the program, and of what the controller brings along.

A routine is compiled for the way it is called. What is passed :OUT and is a variable is a
reference, an array a view, so that it has the sizes of the actual argument. A system variable
cannot be referred to: it becomes part of the routine, which is compiled once more for it, with
parameters for its indices only.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from grammar import ast
from grammar.predefined import Parameter, System
from grammar.scopes import Found
from grammar.symbols import Kind, Space
from grammar.types import CHAR, REAL, UNKNOWN, Array, Type
from grammar.walk import walk
from interp.builtins import BUILTINS, FUNCTIONS, WORLD, reads_text
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import Plain
from interp.bytecode.compiler.expressions import Expressions
from interp.bytecode.compiler.places import (
    Block,
    Cells,
    Formal,
    FormalView,
    Hole,
    Place,
    Pushed,
    PushedView,
    Remote,
    Scalar,
    Text,
    Value,
    View,
)
from interp.bytecode.compiler.rooms import Bound
from interp.bytecode.crossing import unlike
from interp.bytecode.program import (
    Argument,
    Ask,
    Builtin,
    Changed,
    Constant,
    Input,
    Items,
    Mode,
    Program,
)
from interp.faults import LinkError
from interp.phrases import is_variable
from interp.program import Routine
from interp.values import letters
from interp.variables import (
    MOST_CELLS,
    cells_of_routine,
    is_complete,
    is_complete_parameter,
    mismatched,
    untyped_parameter,
    untyped_result,
)

__all__ = ["BY_TEXT", "Binding", "Calls", "Formals", "formals_of"]

#: Functions that are given the name of a variable as a text [TYP-18].
BY_TEXT = frozenset({"VARSTATE", "VARTYPE"})

#: What stands for a system variable in a routine: its path, ``None`` for each index.
Binding = tuple[tuple[str | int | None, ...], Type] | None


@dataclass(frozen=True, slots=True)
class Formals:
    """The parameters of a routine as declared: what each is, its type, and whether it is :IN."""

    found: tuple[Found, ...]
    types: tuple[Type, ...]
    is_in: tuple[bool, ...]


def formals_of(routine: Routine, type_of: object) -> Formals:
    """The parameters of a routine."""
    found = []
    for parameter in routine.node.parameters:
        means = routine.scope.own(Space.VALUE, parameter.name.key)
        assert means is not None, "a routine's table has its parameters"
        found.append(means)
    assert callable(type_of), "gives the type of what a name means"
    types = tuple(type_of(one) for one in found)
    is_in = tuple(parameter.mode == "IN" for parameter in routine.node.parameters)
    return Formals(tuple(found), types, is_in)


class Calls(Expressions):
    """Makes the code of calls."""

    def call(self, node: ast.Call, _wanted: Type) -> Value:
        """The value of a function."""
        value = self.called(node, is_value=True)
        if value is None:
            raise self.unlinked(f"{node.name.text} gives no value")
        return value

    def called(self, node: ast.Call, *, is_value: bool) -> Value | None:
        """Call a routine; gives its result, ``None`` where it has none."""
        found = self.context.unit.found(node.name)
        if found is None:
            raise self.unlinked(f"{node.name.text} is declared nowhere")
        if found.module is None:
            return self._predefined(node, is_value=is_value)
        routine = self.context.program.routines.get(found.symbol)
        if routine is None:
            raise self.unlinked(f"{node.name.text} is a routine that no file has")
        return self._routine(node, routine)

    # ----------------------------------------------------------------------- routines

    def _routine(self, node: ast.Call, routine: Routine) -> Value | None:
        program = self.context.program
        formals = formals_of(routine, program.type_of)
        result = program.result_of(routine)
        kept: Cells | None = None
        if result is not None and not is_complete(result):
            raise self.refuse(str(untyped_result(routine.name)))
        if result is not None:
            result = self.closed(result)
            if not isinstance(result, Plain):
                kept = Cells(self.writer.temporary(result), result)
                self.refer(kept)
        bindings: list[Binding] = []
        bounds: list[Bound | None] = []
        for place, type_ in enumerate(formals.types):
            argument = node.arguments[place] if place < len(node.arguments) else None
            later = node.arguments[place + 1 :]
            if not is_complete_parameter(type_):
                name = formals.found[place].symbol.name
                raise self.refuse(str(untyped_parameter(name, routine.name)))
            binding, bound = self._passed(type_, argument, formals.is_in[place], later)
            bindings.append(binding)
            bounds.append(bound)
        if self.context.tables.cells + cells_of_routine(program, routine) > MOST_CELLS:
            raise self.fail("stack")
        number = self.context.project.code_of(routine, tuple(bindings))
        for place, bound in enumerate(bounds):
            if bound is not None:
                self.context.project.sizes.receives((number, place), bound)
        self.emit(Op.CALL, number)
        if kept is not None:
            self.refer(kept)
            return Block(kept.type)
        return None if result is None else Scalar(result)

    def _passed(
        self,
        type_: Type,
        argument: ast.Expression | None,
        is_in: bool,
        later: Sequence[ast.Expression | None],
    ) -> tuple[Binding, Bound | None]:
        """Push an argument, or what is left of it when it is a system variable.

        Gives what stands for a system variable, and how many elements an array has at most.
        """
        is_view = isinstance(type_, Array) and (not is_in or None in type_.sizes)
        if argument is None:
            return None, self._left_out(type_, is_in, is_view)
        if not is_in and is_variable(self.context.unit, argument):
            place = self.place(argument)
            if isinstance(place, Remote):
                return self._bound(place), None
            return None, self._referred(place, type_, is_view)
        if is_view:
            return None, self._copied_view(type_, argument)
        if is_in and isinstance(self.closed(type_), Plain):
            self.convert(self.value(argument, type_), self.closed(type_))
        else:
            self._copied(self.closed(type_), argument, is_in and not _calls(later))
        return None, None

    def _bound(self, place: Remote) -> Binding:
        """Push the indices of a system variable; its path becomes part of the routine."""
        self.pushed_path(place)
        path = tuple(None if isinstance(step, Hole) else step for step in place.path)
        return path, place.type

    def _left_out(self, type_: Type, is_in: bool, is_view: bool) -> Bound | None:
        if isinstance(type_, Array) and is_view and None in type_.sizes:
            self.emit(Op.PUSH_NO_VIEW, self.number(type_.element), len(type_.sizes))
            return None
        closed = self.closed(type_)
        if is_in and isinstance(closed, Plain):
            self.emit(Op.PUSH_NOTHING)
            return None
        kept = Cells(self.writer.temporary(closed), closed)
        self.refer(kept)
        self.emit(Op.CLEAR, self.number(closed))
        self.refer(kept)
        return self.as_view(Block(closed)).most if is_view else None

    def _referred(self, place: Place, type_: Type, is_view: bool) -> Bound | None:
        """Push a reference to a variable, or a view of an array.

        An array parameter that was left out is passed on as one [SCO-13].
        """
        assert not isinstance(place, Remote), "it is bound"
        given: Block | View
        if isinstance(place, FormalView | PushedView):
            given = self.view(place, may_be_missing=True)
        else:
            self.refer(place)
            given = Block(place.type)
        if isinstance(type_, Array) and is_view:
            is_array = isinstance(given, View) or isinstance(given.type, Array)
            view = self.as_view(given) if is_array else None
            if view is not None and _is_of(view, self.closed(type_.element), len(type_.sizes)):
                return view.most
        elif given == Block(self.closed(type_)):
            return None
        raise self.unlinked(str(mismatched(type_)))

    def _copied(self, type_: Type, argument: ast.Expression, is_copied_by_call: bool) -> None:
        """Push a reference to a value; the call copies it, unless something comes between."""
        kept = Cells(self.writer.temporary(type_), type_)
        behind = self.writer.here
        value = self.value(argument, type_)
        if value == Block(type_) and is_copied_by_call:
            return
        if isinstance(type_, Plain):
            self.convert(value, type_)
            self.emit(Op.STORE_LOCAL, kept.offset)
            self.refer(kept)
            return
        self.writer.insert(behind, *self._reference(kept))
        self.store_block(type_, value, behind + 1)
        self.refer(kept)

    def _reference(self, kept: Cells) -> tuple[Op, int, int]:
        return Op.REF_LOCAL, kept.offset, self.number(kept.type)

    def _copied_view(self, type_: Type, argument: ast.Expression) -> Bound:
        """Push a view of a copy of a value."""
        assert isinstance(type_, Array), "only arrays are views"
        behind = self.writer.here
        value = self.value(argument, type_)
        if isinstance(value, View) and None in type_.sizes:
            return self._copied_to_room(type_, value)
        made: Type = type_
        if None in type_.sizes:
            match value:
                case Text(text):
                    made = Array(CHAR, (max(1, len(text)),))
                case Block(Array() as made):
                    pass
                case _:
                    raise self.refuse(_other_type(type_))
        made = self.closed(made)
        assert isinstance(made, Array), "made of one"
        if (made.element, len(made.sizes)) != (self.closed(type_.element), len(type_.sizes)):
            raise self.refuse(_other_type(type_))
        kept = Cells(self.writer.temporary(made), made)
        self.writer.insert(behind, *self._reference(kept))
        self.store_block(made, value, behind + 1)
        self.refer(kept)
        return self.as_view(Block(made)).most

    def _copied_to_room(self, type_: Array, value: View) -> Bound:
        """Make of the view on top one of a copy of the array, whose size only running tells."""
        if not _is_of(value, self.closed(type_.element), len(type_.sizes)):
            raise self.refuse(_other_type(type_))
        room = self.writer.room(value.element, value.dimensions, value.most)
        self.emit(Op.COPY_VIEW, room.offset, room.type)
        return value.most

    # ----------------------------------------------------------------------- the controller's

    def _predefined(self, node: ast.Call, *, is_value: bool) -> Value | None:
        name = node.name.key
        function = System.load().functions[name]
        is_builtin = name in BUILTINS
        parts = [
            self._argument(name, argument, parameter, is_builtin=is_builtin)
            for argument, parameter in _paired(node.arguments, function.parameters)
        ]
        result = function.result
        if result == UNKNOWN and is_value:
            raise self.refuse(str(untyped_result(name)))
        if is_builtin and not _fits(node, function.parameters, function.has_more):
            raise self.fail("argument")
        if result is None or result == UNKNOWN:
            self._cross(name, parts, None, is_builtin=is_builtin)
            return None
        closed = self.closed(result)
        number = self.number(closed)
        if isinstance(closed, Plain):
            self._cross(name, parts, number, is_builtin=is_builtin)
            return Scalar(closed)
        kept = Cells(self.writer.temporary(closed), closed)
        self.refer(kept)
        self._cross(name, parts, number, is_builtin=is_builtin)
        self.refer(kept)
        return Block(closed)

    def _cross(
        self, name: str, parts: list[Argument], result: int | None, *, is_builtin: bool
    ) -> None:
        tables = self.context.tables
        if not is_builtin:
            assert name in WORLD, "what does not compute needs the world"
            ask = Ask("Invoke", (Constant(name), Items(tuple(parts))), result)
            self.emit(Op.ASK, tables.ask(ask))
            return
        builtin = Builtin(name, tuple(parts), result)
        reason = unlike(Program(tuple(tables.types), (), (), (), (), (), ()), builtin)
        if reason is not None:
            raise self.refuse(f"{name}: {reason}")
        self.emit(Op.BUILTIN, tables.builtin(builtin))

    def _argument(
        self,
        name: str,
        argument: ast.Expression | None,
        parameter: Parameter | None,
        *,
        is_builtin: bool,
    ) -> Argument:
        """Push an argument; what is passed :OUT and is a variable is assigned afterwards."""
        if argument is None:
            return Constant(None)
        if parameter is not None:
            is_out, type_ = parameter.is_out, parameter.type
        else:
            is_out, type_ = not is_builtin or BUILTINS[name].changes_more, UNKNOWN
        if is_out and is_variable(self.context.unit, argument):
            return self._changed(self.place(argument))
        if name in BY_TEXT and isinstance(argument, ast.StringLiteral):
            return self.handed(Text(letters(self._name_to_find(argument.text))))
        value = self._given(argument, type_, is_builtin=is_builtin)
        if name in FUNCTIONS and type_ == REAL and isinstance(value, Scalar):
            self.convert(value, REAL)
            value = Scalar(REAL)
        return self.handed(value)

    def _name_to_find(self, text: str) -> str:
        """A name as the machine finds it, which knows no IMPORT: what it stands for [ADV-05].

        Where the name of that means something else here, the text stays, and finds nothing.
        """
        root = text.partition("[")[0].partition(".")[0].strip()
        answer = self.context.scope.find(Space.VALUE, root.upper())
        if not isinstance(answer, Found) or answer.symbol.kind is not Kind.IMPORT:
            return text
        try:
            meant = self.context.program.declaration(answer).symbol
        except LinkError:
            return text
        places, data = list(self.context.places), self.context.tables.data
        if meant not in places or any(one.key == meant.key for one in self.context.variables):
            return text
        same = [number for number, one in enumerate(data) if one.name.upper() == meant.key]
        module = PurePosixPath(self.context.unit.module.path).stem.upper()
        own = [number for number in same if data[number].module.upper() == module]
        seen = own or [number for number in same if data[number].is_global]
        return text.replace(root, meant.name, 1) if seen[:1] == [places.index(meant)] else text

    def _given(self, argument: ast.Expression, type_: Type, *, is_builtin: bool) -> Value:
        """The value of an argument :IN; for a text see `interp.builtins.reads_text`."""
        if not (is_builtin and reads_text(type_) and is_variable(self.context.unit, argument)):
            return self.value(argument, type_)
        place = self.place(argument)
        if isinstance(place, FormalView) and _is_of(place, CHAR, 1):
            return self.view(place, may_be_missing=True)
        return self.load(place)

    def _changed(self, place: Place) -> Argument:
        if isinstance(place, Remote):
            return self._changed_remote(place)
        through: int | None = None
        if isinstance(place, Formal | FormalView):
            through = place.offset
        elif isinstance(place, Pushed | PushedView):
            through = place.through
        if isinstance(place, FormalView | PushedView):
            given = self.handed(self.view(place))
        else:
            self.refer(place)
            given = self.handed(Block(place.type))
        assert isinstance(given, Input), "it is on the stack"
        return Changed(given, through)

    def _changed_remote(self, place: Remote) -> Argument:
        """A copy of a system variable, which is written back if it has changed."""
        behind = self.writer.here
        value = self.read(place)
        assert isinstance(value, Scalar | Block), "what is read has a known type"
        kept = Cells(self.writer.temporary(value.type), value.type)
        if isinstance(value, Scalar):
            self.emit(Op.STORE_LOCAL, kept.offset)
        else:
            self.writer.insert(behind, *self._reference(kept))
            self.emit(*self._copy(value.type))
        path = self.pushed_path(place)
        self.refer(kept)
        return Changed(Input(Mode.REF, self.number(value.type)), None, path)

    def _copy(self, type_: Type) -> tuple[Op, int]:
        return Op.COPY, self.number(type_)


def _is_of(view: View | FormalView, element: Type, dimensions: int) -> bool:
    return (view.element, view.dimensions) == (element, dimensions)


def _other_type(type_: Type) -> str:
    return f"an argument of another type than {type_}"


def _paired(
    arguments: Sequence[ast.Expression | None], parameters: Sequence[Parameter]
) -> Iterator[tuple[ast.Expression | None, Parameter | None]]:
    for place, argument in enumerate(arguments):
        yield argument, parameters[place] if place < len(parameters) else None


def _fits(node: ast.Call, parameters: Sequence[Parameter], has_more: bool) -> bool:
    count = len(node.arguments)
    return count >= len(parameters) and (count == len(parameters) or has_more)


def _calls(nodes: Sequence[ast.Expression | None]) -> bool:
    """Whether something is called, and so may be changed, when these are evaluated."""
    return any(
        isinstance(inner, ast.Call) for node in nodes if node is not None for inner in walk(node)
    )
