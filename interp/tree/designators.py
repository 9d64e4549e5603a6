"""Designators: variables, members and elements, the places that they denote, and access to these.

Indices are evaluated from left to right.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from pathlib import PurePosixPath

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.semantics.types import BOOL, INT, UNKNOWN, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from interp.port.inspection import InspectedValue
from interp.port.requests import At, Read, StopAdvance, Write, path_of
from interp.program.variables import (
    is_complete,
    is_complete_parameter,
    signal_ends,
    untyped,
    untyped_value,
)
from interp.tree.places import LocalPlace, Place, SystemPlace, element, member, of_type
from interp.tree.program_state import Frame, ProgramState, Steps
from interp.values.faults import Fault, LinkError, fault
from interp.values.values import Value, copied, index


class Designators(ABC):
    """The evaluation of designators in one frame."""

    def __init__(self, run: ProgramState, frame: Frame) -> None:
        self.run = run
        self.frame = frame

    def at(self) -> At:
        """Return the place in the source of the statement that began last."""
        return self.run.at(self.frame)

    @abstractmethod
    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Steps[Value]:
        """Return the value of an expression in a context of type ``wanted``; it is never ``None``.

        Faults ``uninitialised`` if there is no value.
        """

    def place(self, node: ast.Expression) -> Steps[Place]:
        """Return the place of an expression; a value that is no variable gets a temporary place."""
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
                return (yield from self.element(base, node.indices))
        return LocalPlace([(yield from self.value(node))], UNKNOWN, ())

    def element(self, base: Place, nodes: tuple[ast.Expression | None, ...]) -> Steps[Place]:
        """Return an element of an array; an omitted index and those after it select the rest."""
        indices: list[int] = []
        for node in nodes:
            if node is None:
                break
            indices.append(index((yield from self.value(node))))
        return element(base, indices) if indices else base

    def variable(self, name: ast.Name) -> Place:
        """Return the place of a variable; raise `LinkError` if it is not declared.

        An undeclared name that begins with ``$`` is a system variable of unknown type.
        """
        found = self.frame.unit.found(name)
        if found is None:
            if name.key.startswith("$"):  # another release of KSS may have it
                return SystemPlace((name.key,), UNKNOWN)
            raise LinkError(self.frame.unit.undeclared(name))
        return self.declared(found)

    def declared(self, found: Found, signals: tuple[SignalSymbol, ...] = ()) -> Place:
        """Return the place of a declared variable, in a frame, a data list or the controller.

        ``signals`` are the signals on the way here, to detect a cycle.
        """
        found = self.run.program.declaration(found)
        symbol = found.symbol
        if found.scope.routine is not None and not isinstance(symbol, SignalSymbol):
            if symbol in self.frame.variables:
                return self.frame.variables[symbol]
            if not is_complete_parameter(self.run.program.type_of(found)):
                raise untyped(symbol.name)
            raise fault("uninitialised")  # its routine has ended
        if found.module is None or symbol.key.startswith("$"):
            return SystemPlace((symbol.key,), self.run.program.type_of(found))
        if isinstance(symbol, SignalSymbol):
            if symbol in signals:
                raise LinkError(f"the signal {symbol.name} leads nowhere")
            return self._signal(symbol, found, (*signals, symbol))
        if symbol not in self.run.data:
            if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
                raise untyped(symbol.name)
            raise LinkError(f"{symbol.name} is no variable")
        return self.run.data[symbol]

    def _signal(
        self, symbol: SignalSymbol, found: Found, signals: tuple[SignalSymbol, ...]
    ) -> SystemPlace:
        """Return the place that a signal denotes.

        A signal of several bits has a path such as ``("$IN", 1, "TO", 8)`` and is an INT [IOT-03].
        """
        assert found.module is not None, "the controller's signals are variables"
        unit = self.run.program.units[found.module]
        ends: list[SystemPlace] = []
        for name, numbers in signal_ends(symbol):
            means = unit.found(name)
            place = self.declared(means, signals) if means else SystemPlace((name.key,), UNKNOWN)
            place = element(place, numbers) if numbers else place
            if isinstance(place, SystemPlace):
                ends.append(place)
        if not ends:
            return SystemPlace((symbol.key,), BOOL)  # neither end denotes a system variable
        if symbol.last is None:
            return replace(ends[0], is_indexed=False)
        return SystemPlace((*ends[0].path, "TO", ends[-1].path[-1]), INT)

    # ----------------------------------------------------------------------- access

    def read(self, place: Place) -> Steps[Value | None]:
        """Return the value at a place, or ``None`` if it has none."""
        if isinstance(place, LocalPlace):
            return place.get()
        if not is_complete(place.type):
            raise untyped_value(place.path)
        found: Value | None = yield Read(self.at(), place.path)
        return found

    def store(self, place: Place, value: Value) -> Steps[None]:
        """Assign a value to a place, and report the assignment."""
        if isinstance(place, SystemPlace):
            yield Write(self.at(), place.path, of_type(place.type, value))
            return
        old = place.get()
        place.set(value)
        self.run.stored(old, place.get())
        if self.run.assignments is not None:
            self.run.assignments.assign(self.at(), place.path, copied(place.get()))

    # ----------------------------------------------------------------------- by text

    def look(self, text: str) -> InspectedValue | None:
        """Look up a variable of the program, as `interp.port.inspection.Inspectable.look` does."""
        found = self.find(text)
        answer = self.frame.scope.find(
            Space.VALUE, text.partition("[")[0].partition(".")[0].upper()
        )
        if found is None or not isinstance(answer, Found):
            return None
        whole = self.run.program.declaration(answer)
        if whole.scope.routine is not None or whole.module is None:
            return InspectedValue(found[0], copied(found[1]), "")
        module = PurePosixPath(whole.module.path).stem.upper()
        return InspectedValue(found[0], copied(found[1]), f"{module}.{whole.symbol.key}")

    def find(self, text: str) -> tuple[Type, Value | None] | None:
        """Return type and value of the variable with this name in the frame [TYP-18].

        Return ``None`` if there is none in the program; system variables are not looked up.
        """
        place = self.place_of(text)
        return None if place is None else (place.type, place.get())

    def place_of(self, text: str) -> LocalPlace | None:
        """Return the place of the variable with this name in the frame, as `find` does."""
        root, *steps = path_of(text) or ("",)
        answer = self.frame.scope.find(Space.VALUE, str(root))
        try:
            place = self.declared(answer) if isinstance(answer, Found) else None
            for step in steps:
                if not isinstance(place, LocalPlace):
                    break
                place = element(place, [step]) if isinstance(step, int) else member(place, step)
        except (Fault, LinkError):  # there is no such part
            return None
        return place if isinstance(place, LocalPlace) else None
