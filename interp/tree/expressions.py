"""Expressions: their values, the places they name, and calls.

Everything is a generator, as any variable may be one of the world's, and any call may move the arm
(see `interp.tree.run`). Operands, indices and arguments are evaluated from left to right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

from grammar import ast
from grammar.predefined import System
from grammar.scopes import Found
from grammar.symbols import Kind, SignalSymbol, Space
from grammar.types import (
    BOOL,
    INT,
    REAL,
    UNKNOWN,
    Aggregate,
    Enumeration,
    Structure,
    Type,
)
from interp.builtins import BUILTINS, WORLD, Surroundings, call, reads_text
from interp.faults import LinkError, fault
from interp.inspection import Seen
from interp.operators import apply, apply_unary
from interp.phrases import is_variable
from interp.requests import At, Invoke, Read, StopAdvance, Write
from interp.tree.names import find_text
from interp.tree.places import (
    Local,
    Place,
    Remote,
    element,
    fresh,
    is_left_out,
    member,
    of_type,
    sized,
)
from interp.tree.run import Call, Frame, Run, Steps
from interp.values import (
    EnumValue,
    Value,
    constant,
    converted,
    copied,
    empty,
    index,
    integer,
    known,
    letters,
    position_type,
    single,
)
from interp.variables import (
    is_complete,
    is_complete_parameter,
    is_referable,
    mismatched,
    untyped,
    untyped_parameter,
    untyped_result,
    untyped_value,
)

__all__ = ["Expressions"]

_MOST_SIGNALS = 8


class Expressions:
    """What expressions are in one frame."""

    def __init__(self, run: Run, frame: Frame) -> None:
        self.run = run
        self.frame = frame

    def at(self) -> At:
        """Where the statement stands that began last."""
        return self.run.at(self.frame)

    # ----------------------------------------------------------------------- values

    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Steps[Value]:
        """The value of an expression, for a place of type ``wanted``; never without a value.

        A structure or array is the variable's own: who keeps it copies it.
        """
        rule = _VALUES.get(type(node))
        if rule is not None:
            return (yield from rule(self, node, wanted))
        return known((yield from self.read((yield from self.place(node)))))

    def truth(self, node: ast.Expression) -> Steps[bool]:
        """A condition."""
        found = yield from self.value(node, BOOL)
        if not isinstance(found, bool):
            raise fault("operand")
        return found

    def integer(self, node: ast.Expression) -> Steps[int]:
        """A number as INT."""
        found = converted((yield from self.value(node, INT)), INT)
        assert isinstance(found, int), "converted"
        return found

    def real(self, node: ast.Expression) -> Steps[float]:
        """A number as REAL."""
        found = converted((yield from self.value(node, REAL)), REAL)
        assert isinstance(found, float), "converted"
        return found

    def _literal(self, node: Any, _wanted: Type) -> Steps[Value]:
        return _LITERALS[type(node)](node)
        yield  # a generator as all are

    def _constant(self, node: ast.EnumConstant, wanted: Type) -> Steps[Value]:
        type_ = self.frame.unit.checked.enumerations.get(node, wanted)
        if not isinstance(type_, Enumeration):
            raise LinkError(f"nothing tells which enumeration #{node.name.text} is of")
        return constant(type_, node.name.key)
        yield

    def _parenthesised(self, node: ast.Parenthesised, wanted: Type) -> Steps[Value]:
        return (yield from self.value(node.inner, wanted))

    def _unary(self, node: ast.Unary, _wanted: Type) -> Steps[Value]:
        return apply_unary(node.operator, (yield from self.value(node.operand)))

    def _binary(self, node: ast.Binary, _wanted: Type) -> Steps[Value]:
        left = yield from self.value(node.left)
        wanted = left.type if isinstance(left, EnumValue) else UNKNOWN
        return apply(node.operator, left, (yield from self.value(node.right, wanted)))

    def _aggregate(self, node: ast.Aggregate, wanted: Type) -> Steps[Value]:
        type_ = self._structure(node, wanted)
        made = empty(type_)
        whole = Local([made], 0, type_, ())
        for component in node.components:
            place = member(whole, component.name.text)
            if component.indices:
                place = yield from self._element(place, component.indices)
            assert isinstance(place, Local), "a part of what was made here"
            place.set((yield from self.value(component.value, place.type)))
        return known(made)

    def _structure(self, node: ast.Aggregate, wanted: Type) -> Structure:
        type_: Type | None = self.frame.unit.checked.types.get(node, UNKNOWN)
        if isinstance(type_, Aggregate):
            type_ = type_.structure
        if not isinstance(type_, Structure):
            names = frozenset(component.name.key for component in node.components)
            type_ = wanted if isinstance(wanted, Structure) else position_type(names)
        if type_ is None:
            raise LinkError("nothing tells which structure an aggregate is")
        return type_

    # ----------------------------------------------------------------------- places

    def place(self, node: ast.Expression) -> Steps[Place]:
        """Where an expression has its value; one that is no variable has a place of its own."""
        match node:
            case ast.Variable():
                found = self.frame.unit.found(node.name)
                if found is not None and found.symbol.kind is Kind.IMPORT:
                    yield StopAdvance(self.at())
                return self.variable(node.name)
            case ast.Parenthesised():
                return (yield from self.place(node.inner))
            case ast.Member():
                return member((yield from self.place(node.base)), node.name.text)
            case ast.Subscript():
                base = yield from self.place(node.base)
                return (yield from self._element(base, node.indices))
        return Local([(yield from self.value(node))], 0, UNKNOWN, ())

    def _element(self, base: Place, nodes: tuple[ast.Expression | None, ...]) -> Steps[Place]:
        """An element; an index left out, and all behind it, mean the rest of the array."""
        indices: list[int] = []
        for node in nodes:
            if node is None:
                break
            indices.append(index((yield from self.value(node))))
        return element(base, indices) if indices else base

    def variable(self, name: ast.Name) -> Place:
        """The place of a variable; raises `LinkError` where nothing declares it."""
        found = self.frame.unit.found(name)
        if found is None:
            if name.key.startswith("$"):  # another release may have it
                return Remote((name.key,), UNKNOWN)
            raise LinkError(f"{name.text} is declared nowhere")
        return self.declared(found)

    def declared(self, found: Found, signals: int = 0) -> Place:
        """The place of what a name means: of a frame, of a data list, or of the world."""
        found = self.run.program.declaration(found)
        symbol = found.symbol
        if found.scope.routine is not None and not isinstance(symbol, SignalSymbol):
            if symbol in self.frame.variables:
                return self.frame.variables[symbol]
            if not is_complete_parameter(self.run.program.type_of(found)):
                raise untyped(symbol.name)
            raise fault("uninitialised")  # its routine has ended
        if found.module is None or symbol.key.startswith("$"):
            return Remote((symbol.key,), self.run.program.type_of(found))
        if isinstance(symbol, SignalSymbol):
            if signals == _MOST_SIGNALS:
                raise LinkError(f"the signal {symbol.name} leads nowhere")
            return self._signal(symbol, found, signals)
        if symbol not in self.run.data:
            if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
                raise untyped(symbol.name)
            raise LinkError(f"{symbol.name} is no variable")
        return self.run.data[symbol]

    def _signal(self, symbol: SignalSymbol, found: Found, signals: int) -> Remote:
        """What a signal stands for; several bits are ``("$IN", 1, "TO", 8)``, an INT [IOT-03]."""
        assert found.module is not None, "the controller's signals are variables"
        unit = self.run.program.units[found.module]
        ends: list[Remote] = []
        for node in (symbol.first, symbol.last):
            match node:
                case ast.Variable():
                    root, numbers = node, []
                case ast.Subscript(
                    base=ast.Variable() as root, indices=(ast.IntegerLiteral() as number,)
                ):
                    numbers = [number.value]
                case _:
                    continue
            means = unit.found(root.name)
            place = (
                self.declared(means, signals + 1) if means else Remote((root.name.key,), UNKNOWN)
            )
            place = element(place, numbers) if numbers else place
            if isinstance(place, Remote):
                ends.append(place)
        if not ends:
            return Remote((symbol.key,), BOOL)  # connected to nothing
        if symbol.last is None:
            return replace(ends[0], is_indexed=False)
        return Remote((*ends[0].path, "TO", ends[-1].path[-1]), INT)

    def read(self, place: Place) -> Steps[Value | None]:
        """What a place has, if anything."""
        if isinstance(place, Local):
            return place.get()
        if not is_complete(place.type):
            raise untyped_value(place.path)
        found: Value | None = yield Read(self.at(), place.path)
        return found

    def store(self, place: Place, value: Value) -> Steps[None]:
        """Assign a value to a place."""
        if isinstance(place, Remote):
            yield Write(self.at(), place.path, of_type(place.type, value))
            return
        place.set(value)
        if self.run.assignments is not None:
            self.run.assignments.assign(self.at(), place.path, copied(place.get()))

    # ----------------------------------------------------------------------- calls

    def _called(self, node: ast.Call, _wanted: Type) -> Steps[Value]:
        """The value of a function."""
        value = yield from self.call(node, is_value=True)
        if value is None:
            raise LinkError(f"{node.name.text} gives no value")
        return value

    def call(self, node: ast.Call, *, is_value: bool) -> Steps[Value | None]:
        """Call a routine; a procedure gives ``None``."""
        found = self.frame.unit.found(node.name)
        if found is None:
            raise LinkError(f"{node.name.text} is declared nowhere")
        if found.module is None:
            given: Value | None = yield from self._predefined(node, is_value=is_value)
            return given
        routine = self.run.program.routines.get(found.symbol)
        if routine is None:
            raise LinkError(f"{node.name.text} is a routine that no file has")
        result_type = self.run.program.result_of(routine)
        if result_type is not None and not is_complete(result_type):
            raise untyped_result(routine.name)
        variables = {}
        for number, parameter in enumerate(routine.node.parameters):
            argument = node.arguments[number] if number < len(node.arguments) else None
            means = routine.scope.own(Space.VALUE, parameter.name.key)
            assert means is not None, "a routine's table has its parameters"
            if not is_complete_parameter(self.run.program.type_of(means)):
                raise untyped_parameter(means.symbol.name, routine.name)
            is_in = parameter.mode == "IN"
            variables[means.symbol] = yield from self._passed(means, argument, is_in=is_in)
        result: Value | None = yield Call(routine, variables)
        return result

    def _passed(
        self, parameter: Found, argument: ast.Expression | None, *, is_in: bool
    ) -> Steps[Place]:
        """A parameter: what is no variable is passed :IN, whatever is declared [SCO-06]."""
        type_, name = self.run.program.type_of(parameter), parameter.symbol.key
        if argument is None:
            return fresh(type_, name)
        if not is_in and is_variable(self.frame.unit, argument):
            place = yield from self.place(argument)
            if isinstance(place, Remote):
                return place
            if not is_referable(type_, place.type):
                raise mismatched(type_)
            return Local(place.parts, place.at, place.type, (name,))
        value = yield from self.value(argument, type_)
        made = fresh(sized(type_, value), name)
        made.set(value)
        return made

    def _predefined(self, node: ast.Call, *, is_value: bool) -> Steps[Any]:
        """Call what the controller brings along; what is passed :OUT is assigned afterwards."""
        name = node.name.key
        parameters = System.load().functions[name].parameters
        places: list[Place | None] = []
        values: list[Value | None] = []
        for number, argument in enumerate(node.arguments):
            place, value = None, None
            if number < len(parameters):
                is_out, type_ = parameters[number].is_out, parameters[number].type
            else:
                is_out, type_ = name in WORLD or BUILTINS[name].changes_more, UNKNOWN
            if argument is not None and is_out and is_variable(self.frame.unit, argument):
                place = yield from self.place(argument)
                value = yield from self.read(place)
                if value is None and is_left_out(place):
                    raise fault("uninitialised")
            elif argument is not None and name in BUILTINS and reads_text(type_):
                value = yield from self._text(argument, type_)
            elif argument is not None:
                value = yield from self.value(argument, type_)
            places.append(place)
            values.append(value)
        if is_value and System.load().functions[name].result == UNKNOWN:
            raise untyped_result(name)
        if name in BUILTINS:
            reply = call(name, values, Surroundings(self.run.random, self._find))
            result, after = reply.result, reply.arguments
        else:
            values = [copied(value) for value in values]
            paths = [place.path if isinstance(place, Remote) else None for place in places]
            result, after = yield Invoke(self.at(), name, tuple(values), tuple(paths))
        for place, before, value in zip(places, values, after, strict=True):
            if place is not None and value is not None and value is not before:
                yield from self.store(place, value)
        return result

    def _text(self, node: ast.Expression, wanted: Type) -> Steps[Value]:
        """A text passed :IN to a predefined function; see `interp.builtins.reads_text`."""
        if not is_variable(self.frame.unit, node):
            return (yield from self.value(node, wanted))
        place = yield from self.place(node)
        value = yield from self.read(place)
        is_empty = value is None and is_left_out(place) and reads_text(place.type)
        return "" if is_empty else known(value)

    def look(self, text: str) -> Seen | None:
        """A variable of the program or a part of one, as `interp.inspection` has it."""
        found = self._find(text)
        answer = self.frame.scope.find(
            Space.VALUE, text.partition("[")[0].partition(".")[0].upper()
        )
        if found is None or not isinstance(answer, Found):
            return None
        whole = self.run.program.declaration(answer)
        if whole.scope.routine is not None or whole.module is None:
            return Seen(found[0], copied(found[1]), "")
        module = PurePosixPath(whole.module.path).stem.upper()
        return Seen(found[0], copied(found[1]), f"{module}.{whole.symbol.key}")

    def _find(self, text: str) -> tuple[Type, Value | None] | None:
        """A variable of the program by what it is called here [TYP-18]."""
        return find_text(text, self._named)

    def _named(self, key: str) -> Place | None:
        answer = self.frame.scope.find(Space.VALUE, key)
        return self.declared(answer) if isinstance(answer, Found) else None


def _bits(node: ast.BitLiteral) -> int:
    """32 bits as a number with sign [TYP-04]."""
    return integer(node.value - 2**32 if node.value >= 2**31 else node.value)


_LITERALS: Mapping[type[Any], Callable[[Any], Value]] = {
    ast.IntegerLiteral: lambda node: integer(node.value),
    ast.RealLiteral: lambda node: single(node.value),
    ast.BoolLiteral: lambda node: node.value,
    ast.BitLiteral: _bits,
    ast.StringLiteral: lambda node: letters(node.text),
    ast.ChannelName: lambda node: letters(node.name.key),
}
_Rule = Callable[[Expressions, Any, Type], Steps[Value]]
_VALUES: Mapping[type[Any], _Rule] = {
    **dict.fromkeys(_LITERALS, Expressions._literal),
    ast.EnumConstant: Expressions._constant,
    ast.Parenthesised: Expressions._parenthesised,
    ast.Unary: Expressions._unary,
    ast.Binary: Expressions._binary,
    ast.Aggregate: Expressions._aggregate,
    ast.Call: Expressions._called,
}
