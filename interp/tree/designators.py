"""Designators: variables, members and elements, the places that they name, and access to these.

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
from interp.port.inspection import Seen
from interp.port.requests import At, Read, StopAdvance, Write
from interp.program.variables import (
    is_complete,
    is_complete_parameter,
    signal_ends,
    untyped,
    untyped_value,
)
from interp.tree.names import find_text
from interp.tree.places import LocalPlace, Place, SystemPlace, element, member, of_type
from interp.tree.run import Frame, ProgramState, Steps
from interp.values.faults import LinkError, fault
from interp.values.values import ArrayValue, StructureValue, Value, copied, index

_MOST_SIGNALS = 8


class Designators(ABC):
    """What designators mean in one frame."""

    def __init__(self, run: ProgramState, frame: Frame) -> None:
        self.run = run
        self.frame = frame

    def at(self) -> At:
        """Where the statement stands that began last."""
        return self.run.at(self.frame)

    @abstractmethod
    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Steps[Value]:
        """The value of an expression, for a place of type ``wanted``; never without a value."""

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
                return (yield from self.element(base, node.indices))
        return LocalPlace([(yield from self.value(node))], UNKNOWN, ())

    def element(self, base: Place, nodes: tuple[ast.Expression | None, ...]) -> Steps[Place]:
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
                return SystemPlace((name.key,), UNKNOWN)
            raise LinkError(self.frame.unit.undeclared(name))
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
            return SystemPlace((symbol.key,), self.run.program.type_of(found))
        if isinstance(symbol, SignalSymbol):
            if signals == _MOST_SIGNALS:
                raise LinkError(f"the signal {symbol.name} leads nowhere")
            return self._signal(symbol, found, signals)
        if symbol not in self.run.data:
            if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
                raise untyped(symbol.name)
            raise LinkError(f"{symbol.name} is no variable")
        return self.run.data[symbol]

    def _signal(self, symbol: SignalSymbol, found: Found, signals: int) -> SystemPlace:
        """What a signal stands for; several bits are ``("$IN", 1, "TO", 8)``, an INT [IOT-03]."""
        assert found.module is not None, "the controller's signals are variables"
        unit = self.run.program.units[found.module]
        ends: list[SystemPlace] = []
        for name, numbers in signal_ends(symbol):
            means = unit.found(name)
            place = (
                self.declared(means, signals + 1) if means else SystemPlace((name.key,), UNKNOWN)
            )
            place = element(place, numbers) if numbers else place
            if isinstance(place, SystemPlace):
                ends.append(place)
        if not ends:
            return SystemPlace((symbol.key,), BOOL)  # connected to nothing
        if symbol.last is None:
            return replace(ends[0], is_indexed=False)
        return SystemPlace((*ends[0].path, "TO", ends[-1].path[-1]), INT)

    # ----------------------------------------------------------------------- access

    def read(self, place: Place) -> Steps[Value | None]:
        """What a place has, if anything."""
        if isinstance(place, LocalPlace):
            return place.get()
        if not is_complete(place.type):
            raise untyped_value(place.path)
        found: Value | None = yield Read(self.at(), place.path)
        return found

    def store(self, place: Place, value: Value) -> Steps[None]:
        """Assign a value to a place."""
        if isinstance(place, SystemPlace):
            yield Write(self.at(), place.path, of_type(place.type, value))
            return
        old = place.get()
        place.set(value)
        new = place.get()
        # As text: the numbers 1, 1.0 and TRUE are equal, and so are both zeros.
        if isinstance(new, StructureValue | ArrayValue) or repr(old) != repr(new):
            self.run.changes += 1
        if self.run.assignments is not None:
            self.run.assignments.assign(self.at(), place.path, copied(place.get()))

    # ----------------------------------------------------------------------- by text

    def look(self, text: str) -> Seen | None:
        """A variable of the program or a part of one, as `interp.port.inspection` has it."""
        found = self.find(text)
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

    def find(self, text: str) -> tuple[Type, Value | None] | None:
        """A variable of the program by what it is called here [TYP-18]."""
        place = self.place_of(text)
        return None if place is None else (place.type, place.get())

    def place_of(self, text: str) -> LocalPlace | None:
        """The place of a variable of the program by what it is called here."""
        return find_text(text, self._named)

    def _named(self, key: str) -> Place | None:
        answer = self.frame.scope.find(Space.VALUE, key)
        return self.declared(answer) if isinstance(answer, Found) else None
