"""Generation of data lists: types and variables, which become visible in a scope."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from grammar.generation.cells.names import Names
from grammar.generation.cells.style import E6AXIS, E6POS, FRAME
from grammar.generation.choices import Choices, Weighted
from grammar.generation.code import Style
from grammar.generation.routines import constant_datum, datum, enumeration, structure_definition
from grammar.generation.scope import Scope
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    Array,
    Enumeration,
    Member,
    Structure,
    Type,
)


class Data:
    """The declarations of a data list while they are generated.

    ``is_global`` makes them visible outside the module; the data list then has to be PUBLIC.
    """

    def __init__(
        self, choices: Choices, style: Style, names: Names, scope: Scope, *, is_global: bool
    ) -> None:
        self.lines: list[str] = []
        self.choices = choices
        self.names = names
        self._style = style
        self._scope = scope
        self._is_global = is_global

    def some(self, count: int) -> None:
        """Add ``count`` declarations of random kinds."""
        for _ in range(count):
            found = self.choices.weighted(_DECLARATIONS)(self)
            if found is not None:
                self.variable(found)

    def variable(self, type_: Type) -> None:
        """Add a variable with its initial value."""
        self.lines += datum(
            self.choices,
            self._style,
            self._scope,
            type_,
            self.names.variable(type_),
            is_global=self._is_global,
        )

    def constant(self) -> None:
        """Add a named constant [TYP-07]."""
        type_ = self.choices.pick((INT, INT, REAL))
        name = self.names.variable(type_)
        self.lines.append(
            constant_datum(
                self.choices, self._style, self._scope, type_, name, is_global=self._is_global
            )
        )

    def enumeration(self) -> Enumeration:
        """Add an enumeration and return it."""
        choices, names = self.choices, self.names
        states = names.vocabulary.states
        constants = choices.few(states, choices.between(3, len(states)))
        name = names.take(names.joined((choices.pick(names.vocabulary.stations), "state", "t")))
        found = Enumeration(name, tuple(constant.upper() for constant in constants))
        self.lines.append(
            enumeration(found, is_global=self._is_global, comma=self._style.layout.comma)
        )
        return found

    def structure(self) -> Type:
        """Add a structure and return it, or an array type of it."""
        choices, names = self.choices, self.names
        inner = names.inner()
        name = names.take(names.joined((choices.pick(names.vocabulary.things), "data", "t")))
        members = [
            Member(inner.variable(type_), type_)
            for type_ in (INT, REAL, BOOL)
            for _ in range(choices.between(1, 4))
        ]
        # words of statements are names of members too [TYP-05]
        words = choices.few(("STEP", "PART", "DELAY"), 3)[: choices.below(3)]
        members += [Member(word, INT) for word in words]
        if choices.chance(40):
            text = Array(CHAR, (choices.pick((12, 24, 40)),))
            members.append(Member(inner.variable(CHAR), text))
        found = Structure(name, tuple(members))
        self.lines.append(
            structure_definition(
                choices, found, is_global=self._is_global, comma=self._style.layout.comma
            )
        )
        return Array(found, (choices.between(3, 20),)) if choices.chance(50) else found


def _array(*elements: Type) -> Callable[[Data], Type]:
    return lambda data: Array(data.choices.pick(elements), (data.choices.between(3, 24),))


def _is(type_: Type) -> Callable[[Data], Type]:
    return lambda _data: type_


_DECLARATIONS: Final = Weighted[Callable[[Data], Type | None]](
    (60, _is(INT)),
    (44, _is(REAL)),
    (44, _is(BOOL)),
    (2, _is(CHAR)),
    (16, _is(FRAME)),
    (16, _is(E6POS)),
    (6, _is(E6AXIS)),
    (10, Data.constant),
    (12, lambda data: Array(CHAR, (data.choices.pick((12, 24, 32, 40, 80)),))),
    (12, _array(INT, INT, REAL, BOOL)),
    (8, lambda data: Array(REAL, (data.choices.between(2, 6), data.choices.between(2, 6)))),
    (3, lambda data: Array(CHAR, (data.choices.between(2, 8), 24))),
    (6, _array(E6POS)),
    (5, Data.enumeration),
    (7, Data.structure),
)
