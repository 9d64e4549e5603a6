"""The data list of a module: types and variables, each named in the scope of its programs."""

from __future__ import annotations

from collections.abc import Callable

from grammar.generation.cells.chance import Chance, Weighted
from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.expressions import constant_of
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import pose
from grammar.generation.cells.scope import Enumeration, Scope, Structure

__all__ = ["Data"]


class Data:
    """Declarations for a data list, written while they are made.

    ``is_global`` makes them known outside the module, which needs a data list that is PUBLIC.
    """

    def __init__(
        self, chance: Chance, dialect: Dialect, names: Names, scope: Scope, *, is_global: bool
    ) -> None:
        self.lines: list[str] = []
        self._chance = chance
        self._dialect = dialect
        self._names = names
        self._scope = scope
        self._global = "GLOBAL " if is_global else ""

    def some(self, count: int) -> None:
        """So many declarations of any kind."""
        for _ in range(count):
            self._chance.draw(_DECLARATIONS)(self)

    def _declare(self, kind: str, text: str) -> None:
        """A declaration; DECL may be missing before predefined types [TYP-06]."""
        is_short = kind in _PREDEFINED and self._chance.real() < 0.27
        self.lines.append(f"{'' if is_short else 'DECL '}{self._global}{kind} {text}")

    # -------------------------------------------------------------------------- variables

    def variable(self, kind: str) -> str:
        """A variable with its first value."""
        chance, names, eq = self._chance, self._names, self._dialect.eq
        name = names.variable(kind)
        text = f"{name}{eq}{self._first(kind)}"
        if kind in ("INT", "REAL", "BOOL") and chance.real() < 0.15:
            other = names.variable(kind)
            text += f",{other}{eq}{self._first(kind)}"
            self._scope.add_variable(kind, other, lasting=True)
        if chance.real() < 0.12:
            text += f" ;{names.remark()}"
        self._declare(kind, text)
        self._scope.add_variable(kind, name, lasting=True)
        return name

    def _first(self, kind: str) -> str:
        chance = self._chance
        if kind == "INT":
            return str(chance.below(100)) if chance.real() < 0.97 else f"'B{chance.below(16):04b}'"
        if kind == "REAL":
            sign = "-" if chance.real() < 0.15 else ""
            return f"{sign}{chance.below(5000) / 10}"
        if kind == "BOOL":
            return "TRUE" if chance.real() < 0.3 else "FALSE"
        if kind == "CHAR":
            return constant_of(kind)
        if kind == "E6AXIS":
            angles = ",".join(f"A{n} {180 * chance.real() - 90:.3f}" for n in range(1, 7))
            return f"{{{angles},E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}}"
        x, y, z, a, b, c = pose(chance, (400.0, 0.0, 300.0), 900.0)
        place = f"X {x:.3f},Y {y:.3f},Z {z:.3f},A {a:.3f},B {b:.3f},C {c:.3f}"
        return f"{{{place}}}" if kind == "FRAME" else f"{{{place},S 2,T 2,{_NO_EXTERNAL_AXES}}}"

    def constant(self) -> None:
        """A named constant [TYP-07]."""
        kind = self._chance.pick(("INT", "INT", "REAL"))
        name = self._names.variable(kind)
        self.lines.append(
            f"DECL {self._global}CONST {kind} {name}{self._dialect.eq}{self._first(kind)}"
        )
        self._scope.reads[kind].append(name)

    def text(self) -> None:
        """A text with its first value."""
        name, size = self._names.variable("CHAR"), self._chance.pick((12, 24, 32, 40, 80))
        self._declare("CHAR", f"{name}[{size}]")
        self.lines.append(f'{name}[]{self._dialect.eq}"{self._chance.pick((" ", "-", "none"))}"')
        self._scope.texts.append((name, size))

    def array(self) -> None:
        """An array, its elements initialised in ascending order [TYP-09, TYP-10] or not at all."""
        chance = self._chance
        kind = chance.pick(("INT", "INT", "REAL", "BOOL"))
        name, size = self._names.variable(kind), chance.between(3, 24)
        self._declare(kind, f"{name}[{size}]")
        if chance.real() < 0.8:
            eq = self._dialect.eq
            self.lines += [f"{name}[{n}]{eq}{self._first(kind)}" for n in range(1, size + 1)]
        self._scope.arrays[kind].append((name, size))

    def matrix(self) -> None:
        """Numbers in rows and columns."""
        name, eq = self._names.variable("REAL"), self._dialect.eq
        rows, columns = self._chance.between(2, 6), self._chance.between(2, 6)
        self._declare("REAL", f"{name}[{rows},{columns}]")
        self.lines += [
            f"{name}[{row},{column}]{eq}{self._first('REAL')}"
            for row in range(1, rows + 1)
            for column in range(1, columns + 1)
        ]
        self._scope.matrices.append((name, rows, columns))

    def names_of_things(self) -> None:
        """A table of texts, a row each [TYP-11]."""
        names, eq = self._names, self._dialect.eq
        name, rows = names.variable("CHAR"), self._chance.between(2, 8)
        self._declare("CHAR", f"{name}[{rows},24]")
        things = names.vocabulary.things
        self.lines += [
            f'{name}[{row},]{eq}"{self._chance.pick(things)} {row}"' for row in range(1, rows + 1)
        ]

    def places(self) -> None:
        """An array of positions."""
        chance, eq = self._chance, self._dialect.eq
        name, size = self._names.variable("E6POS"), chance.between(3, 20)
        self._declare("E6POS", f"{name}[{size}]")
        self.lines += [f"{name}[{n}]{eq}{self._first('E6POS')}" for n in range(1, size + 1)]
        self._scope.arrays["E6POS"].append((name, size))

    # ------------------------------------------------------------------------------ types

    def enumeration(self) -> Enumeration:
        """An enumeration and a variable of it."""
        chance, names = self._chance, self._names
        word = chance.pick(names.vocabulary.stations)
        states = names.vocabulary.states
        constants = chance.few(states, chance.between(3, len(states)))
        name = names.take(names.joined((word, "state", "t")))
        found = Enumeration(name, tuple(constant.upper() for constant in constants))
        self.lines.append(f"{self._global}ENUM {name} {self._dialect.comma.join(found.constants)}")
        self.state(found)
        return found

    def state(self, enumeration: Enumeration) -> None:
        """A variable of an enumeration."""
        names = self._names
        name = names.variable("ENUM")
        value = f"#{self._chance.pick(enumeration.constants)}"
        self.lines.append(f"DECL {self._global}{enumeration.name} {name}{self._dialect.eq}{value}")
        self._scope.enumerations.append((name, enumeration))

    def structure(self) -> None:
        """A structure, and either a record or a table of them."""
        chance, names = self._chance, self._names
        words = names.vocabulary
        inner = names.inner()
        name = names.take(names.joined((chance.pick(words.things), "data", "t")))
        members = [
            (inner.variable(kind), kind)
            for kind in ("INT", "REAL", "BOOL")
            for _ in range(chance.between(1, 4))
        ]
        # words of statements are names of members too [TYP-05]
        members += [
            (name, "INT") for name in chance.few(("STEP", "PART", "DELAY"), 3)[: chance.below(3)]
        ]
        texts = [(inner.variable("CHAR"), chance.pick((12, 24, 40)))] * (chance.real() < 0.4)
        groups = [
            f"{kind} {self._dialect.comma.join(one for one, its in members if its == kind)}"
            for kind in ("INT", "REAL", "BOOL")
        ] + [f"CHAR {one}[{size}]" for one, size in texts]
        self.lines.append(f"{self._global}STRUC {name} {self._dialect.comma.join(groups)}")
        found = Structure(name, tuple(members), tuple(texts))
        if chance.real() < 0.5:
            self.table(found)
        else:
            record = names.variable("STRUC")
            self.lines.append(
                f"DECL {self._global}{name} {record}{self._dialect.eq}{self._aggregate(found)}"
            )
            self._scope.records.append((record, found))

    def table(self, structure: Structure) -> None:
        """An array of records."""
        chance, eq = self._chance, self._dialect.eq
        name, size = self._names.variable("STRUC"), chance.between(3, 20)
        self.lines.append(f"DECL {self._global}{structure.name} {name}[{size}]")
        self.lines += [f"{name}[{n}]{eq}{self._aggregate(structure)}" for n in range(1, size + 1)]
        self._scope.tables.append((name, size, structure))

    def _aggregate(self, structure: Structure) -> str:
        values = [f"{member} {self._first(kind)}" for member, kind in structure.members]
        values += [f'{member}[] "{self._chance.pick(_CONTENTS)}"' for member, _ in structure.texts]
        prefix = f"{structure.name}: " if self._chance.real() < 0.05 else ""
        return f"{{{prefix}{self._dialect.comma.join(values)}}}"


_NO_EXTERNAL_AXES = "E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0"
_PREDEFINED = frozenset(("INT", "REAL", "BOOL", "CHAR", "FRAME", "E6POS", "E6AXIS"))
_CONTENTS = ("none", " ", "A 100", "type 7; left", "0815", "blank", "left", "right", "-")
_DECLARATIONS: Weighted[Callable[[Data], object]] = Weighted(
    [
        (30.0, lambda data: data.variable("INT")),
        (22.0, lambda data: data.variable("REAL")),
        (22.0, lambda data: data.variable("BOOL")),
        (1.0, lambda data: data.variable("CHAR")),
        (8.0, lambda data: data.variable("FRAME")),
        (8.0, lambda data: data.variable("E6POS")),
        (3.0, lambda data: data.variable("E6AXIS")),
        (5.0, Data.constant),
        (6.0, Data.text),
        (6.0, Data.array),
        (4.0, Data.matrix),
        (1.5, Data.names_of_things),
        (3.0, Data.places),
        (2.5, Data.enumeration),
        (3.5, Data.structure),
    ]
)
