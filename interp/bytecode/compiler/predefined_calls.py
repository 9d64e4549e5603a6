"""Code for calls of predefined functions: pure ones, and ones that the controller executes.

A variable that is passed :OUT is passed by reference and assigned afterwards. There are no
references to system variables; a copy is passed instead and written back.
"""

from __future__ import annotations

from grammar.semantics.assignability import assignable
from grammar.semantics.predefined import PredefinedParameter, System
from grammar.semantics.types import CHAR, REAL, UNKNOWN, Type
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.compiler.expressions import CodeMaker
from interp.bytecode.compiler.locations import (
    FrameCells,
    Location,
    Pushed,
    PushedView,
    Reference,
    ReferenceParameter,
    Scalar,
    SystemVariable,
    Text,
    Value,
    ViewParameter,
    is_view_of,
)
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
from interp.bytecode.verifier.signatures import call_mismatch
from interp.program.reads import is_variable
from interp.program.variables import untyped_result
from interp.values.builtins import BUILTINS, FUNCTIONS, WORLD, reads_text
from interp.values.values import letters

#: Functions that take the name of a variable as a text [TYP-18].
BY_TEXT = frozenset({"VARSTATE", "VARTYPE"})


class PredefinedCalls(CodeMaker):
    """Generates code for calls of predefined functions."""

    def predefined(self, node: ast.Call, *, is_value: bool) -> Value | None:
        """Generate a call; return its result, or ``None`` if it has none."""
        name = node.name.key
        function = System.load().functions[name]
        is_builtin = name in BUILTINS
        if is_builtin and function.stops:
            self._emitter.ask("StopAdvance")
        parts = [
            self._argument(name, argument, function.parameter(place), is_builtin=is_builtin)
            for place, argument in enumerate(node.arguments)
        ]
        result = function.result
        if result == UNKNOWN and is_value:
            raise self._emitter.refuse(str(untyped_result(name)))
        if is_builtin and not function.takes(len(node.arguments)):
            raise self._emitter.fail("argument")
        closed = None if result is None or result == UNKNOWN else self._emitter.closed(result)
        number = None if closed is None else self._emitter.number(closed)
        op, entry = self._entry(name, tuple(parts), number, is_builtin=is_builtin)
        if closed is None:
            self._emit(op, entry)
            return None
        return self._memory.answered(op, entry, closed)

    def _entry(
        self, name: str, parts: tuple[Argument, ...], result: int | None, *, is_builtin: bool
    ) -> tuple[Op, int]:
        """Return the instruction for a call, and its entry in a table."""
        tables = self._context.tables
        if not is_builtin:
            assert name in WORLD, "what does not compute needs the world"
            return Op.ASK, tables.ask(Ask("Invoke", (Constant(name), Items(parts)), result))
        builtin = Builtin(name, parts, result)
        if call_mismatch(Program(tuple(tables.types), (), (), (), (), (), ()), builtin):
            raise self._emitter.fail("argument")
        return Op.BUILTIN, tables.builtin(builtin)

    def _argument(
        self,
        name: str,
        argument: ast.Expression | None,
        parameter: PredefinedParameter | None,
        *,
        is_builtin: bool,
    ) -> Argument:
        """Push an argument; a variable that is passed :OUT is assigned after the call."""
        if argument is None:
            return Constant(None)
        if parameter is not None:
            is_out, type_ = parameter.is_out, parameter.type
        else:
            is_out, type_ = not is_builtin, UNKNOWN
        if is_out and is_variable(self._context.unit, argument):
            return self._changed(self._designators.place(argument))
        if name in BY_TEXT and isinstance(argument, ast.StringLiteral):
            return self._memory.handed(Text(letters(argument.text)))
        value = self._given(argument, type_, is_builtin=is_builtin)
        if (
            name in FUNCTIONS
            and type_ == REAL
            and isinstance(value, Scalar)
            and assignable(REAL, value.type).is_fine
        ):
            self._memory.convert(value, REAL)
            value = Scalar(REAL)
        return self._memory.handed(value)

    def _given(self, argument: ast.Expression, type_: Type, *, is_builtin: bool) -> Value:
        """Generate an :IN argument; for texts see `interp.values.builtins.reads_text`."""
        if not (is_builtin and reads_text(type_) and is_variable(self._context.unit, argument)):
            return self._expressions.value(argument, type_)
        place = self._designators.place(argument)
        if isinstance(place, ViewParameter) and is_view_of(place, CHAR, 1):
            return self._memory.view(place, may_be_missing=True)
        return self._memory.load(place)

    def _changed(self, place: Location) -> Argument:
        if isinstance(place, SystemVariable):
            return self._changed_remote(place)
        through: int | None = None
        if isinstance(place, ReferenceParameter | ViewParameter):
            through = place.offset
        elif isinstance(place, Pushed | PushedView):
            through = place.through
        if isinstance(place, ViewParameter | PushedView):
            given = self._memory.handed(self._memory.view(place))
        else:
            self._memory.refer(place)
            given = self._memory.handed(Reference(place.type))
        assert isinstance(given, Input), "it is on the stack"
        return Changed(given, through)

    def _changed_remote(self, place: SystemVariable) -> Argument:
        """Push a copy of a system variable, which is written back if it has changed."""
        behind = self._writer.here
        value = self._memory.read(place)
        if isinstance(value, Scalar):
            kept = FrameCells(self._writer.temporary(value.type), value.type)
            self._emit(Op.STORE_LOCAL, kept.offset)
        else:
            kept = self._memory.kept(value, behind)
        path = self._memory.pushed_path(place)
        self._memory.refer(kept)
        return Changed(Input(Mode.REF, self._emitter.number(value.type)), None, path)
