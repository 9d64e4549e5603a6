"""Calls of routines of the program, and of the functions and routines that KRL predefines.

Arguments are evaluated from left to right.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from grammar.semantics.assignability import assignable
from grammar.semantics.predefined import PredefinedFunction, PredefinedParameter, System
from grammar.semantics.scopes import Found
from grammar.semantics.types import UNKNOWN, Enumeration, Scalar, Text, Type, is_same
from grammar.syntax import ast
from grammar.syntax.references import Space
from interp.port.requests import Invoke, StopAdvance
from interp.program.reads import is_input, is_variable
from interp.program.variables import (
    is_complete,
    is_complete_parameter,
    is_referable,
    mismatched,
    untyped_parameter,
    untyped_result,
)
from interp.tree.expressions import Expressions
from interp.tree.places import LocalPlace, Place, SystemPlace, fresh, is_left_out, sized
from interp.tree.program_state import Call, Steps
from interp.values.builtins import BUILTINS, WORLD, Surroundings, call, reads_text
from interp.values.faults import LinkError, fault
from interp.values.values import Value, copied, known, type_of


class Calls(Expressions):
    """The execution of calls in one frame."""

    def called(self, node: ast.Call) -> Steps[Value]:
        """Call a function and return its value."""
        value = yield from self.call(node, is_value=True)
        if value is None:
            raise LinkError(f"{node.name.text} gives no value")
        return value

    def call(self, node: ast.Call, *, is_value: bool) -> Steps[Value | None]:
        """Call a routine or function; return its result, or ``None`` for a procedure."""
        found = self.frame.unit.found(node.name)
        if found is None:
            raise LinkError(self.frame.unit.undeclared(node.name))
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
        """Bind an argument to a parameter and return the place of the parameter.

        An argument that is not a variable is passed :IN, whatever the declaration says [SCO-06].
        """
        type_, name = self.run.program.type_of(parameter), parameter.symbol.key
        if argument is None:
            return fresh(type_, name)
        if not is_in and is_variable(self.frame.unit, argument):
            place = yield from self.place(argument)
            if isinstance(place, SystemPlace):
                return place
            if not is_referable(type_, place.type):
                raise mismatched(type_)
            return LocalPlace(place.parts, place.type, (name,), place.at)
        if is_input(self.frame.unit, argument):  # left out, it stays so [SCO-13]
            place = yield from self.place(argument)
            is_empty = isinstance(place, LocalPlace) and place.get() is None
            if is_empty and place.type == type_ and isinstance(type_, Scalar | Enumeration):
                return fresh(type_, name)
        value = yield from self.value(argument, type_)
        made = fresh(sized(type_, value), name)
        made.set(value)
        return made

    def _predefined(self, node: ast.Call, *, is_value: bool) -> Steps[Any]:
        """Call a predefined function or routine, then assign the arguments passed :OUT."""
        name = node.name.key
        function = System.load().functions[name]
        if name in BUILTINS and function.stops:
            yield StopAdvance(self.at())
        places, values = yield from self._evaluate_arguments(node, function)
        if is_value and function.result == UNKNOWN:
            raise untyped_result(name)
        if name in BUILTINS:
            _check_arguments(zip(function.parameters, node.arguments, places, values, strict=False))
            result, changes = call(name, values, Surroundings(self.run.random, self.find))
            self.run.charge(name)
        else:
            values = [copied(value) for value in values]
            paths = [place.path if isinstance(place, SystemPlace) else None for place in places]
            result, changes = yield Invoke(self.at(), name, tuple(values), tuple(paths))
        for number, place in enumerate(places):
            if place is not None and number in changes:
                yield from self.store(place, changes[number])
        return result

    def _evaluate_arguments(
        self, node: ast.Call, function: PredefinedFunction
    ) -> Steps[tuple[list[Place | None], list[Value | None]]]:
        """Return the places of the arguments passed :OUT, and the values of all arguments."""
        name = node.name.key
        places: list[Place | None] = []
        values: list[Value | None] = []
        for number, argument in enumerate(node.arguments):
            place, value = None, None
            parameter = function.parameter(number)
            is_out = parameter.is_out if parameter is not None else name in WORLD
            type_ = parameter.type if parameter is not None else UNKNOWN
            if argument is not None and is_out and is_variable(self.frame.unit, argument):
                place = yield from self.place(argument)
                if isinstance(place, SystemPlace):
                    value = yield from self.read(place)
                if is_left_out(place):
                    raise fault("uninitialised")
            elif argument is not None and name in BUILTINS and reads_text(type_):
                value = yield from self._text(argument, type_)
            elif argument is not None:
                value = yield from self.value(argument, type_)
            places.append(place)
            values.append(value)
        # Only now, as another argument may call a function that changes such a variable.
        for number, place in enumerate(places):
            if isinstance(place, LocalPlace):
                values[number] = place.get()
        return places, values

    def _text(self, node: ast.Expression, wanted: Type) -> Steps[Value]:
        """Return a text passed :IN to a predefined function.

        See `interp.values.builtins.reads_text` for an omitted text.
        """
        if not is_variable(self.frame.unit, node):
            return (yield from self.value(node, wanted))
        place = yield from self.place(node)
        value = yield from self.read(place)
        return "" if is_left_out(place) and reads_text(place.type) else known(value)


_Argument = tuple[PredefinedParameter, ast.Expression | None, Place | None, Value | None]


def _check_arguments(given: Iterable[_Argument]) -> None:
    """Fault ``argument`` if a predefined function does not accept one of its arguments [ARI-04].

    An argument passed by reference must have exactly the parameter's type; others are converted.
    """
    for parameter, argument, place, value in given:
        if place is not None:
            fits = is_same(parameter.type, place.type)
        elif isinstance(argument, ast.StringLiteral):
            fits = assignable(parameter.type, Text(len(argument.text))).is_fine
        else:
            fits = value is None or assignable(parameter.type, type_of(value)).is_fine
        if not fits:
            raise fault("argument")
