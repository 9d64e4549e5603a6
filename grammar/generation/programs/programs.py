"""Whole programs: files, data lists, routines that call one another without end being in doubt.

Routines are made before those that call them, so that what a call costs is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from grammar.generation.programs.choices import Choices, SeededChoices
from grammar.generation.programs.code import Part, Size
from grammar.generation.programs.kinds import (
    AXIS_TYPES,
    COLOUR,
    MODE,
    POINT,
    POSES,
    RECORD,
    STATE,
    WITHOUT_DECL,
    constant,
    declared,
    initialisation,
)
from grammar.generation.programs.scope import Parameter, Routine, Scope, Variable
from grammar.generation.programs.statements import Statements
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

__all__ = ["Sample", "generate", "seeded"]


@dataclass(frozen=True, slots=True)
class Sample:
    """A program: its files by path, the first being the one to begin with."""

    files: tuple[tuple[str, str], ...]

    @property
    def main(self) -> str:
        """The path of the file to begin with."""
        return self.files[0][0]


def seeded(seed: int, number: int, size: Size | None = None) -> Sample:
    """The program of a number under a seed, always the same."""
    return generate(SeededChoices(f"{seed}/{number}"), size)


def generate(choices: Choices, size: Size | None = None) -> Sample:
    """A program that the checker finds no error in, and that ends; most are small."""
    return _Programs(choices, size or choices.weighted(_SIZES)).sample()


_SIZES: Final = (
    (12, Size(budget=150, others=40, statements=2, routines=1, data=1)),
    (6, Size(budget=250, others=60, statements=3, routines=2)),
    (2, Size()),
)
_TABLES: Final[tuple[Type, ...]] = (
    Array(INT, (4,)),
    Array(INT, (2, 3)),
    Array(INT, (2, 2, 3)),
    Array(REAL, (3,)),
    Array(REAL, (3, 2)),
    Array(BOOL, (3,)),
    Array(COLOUR, (2,)),
    Array(POINT, (2,)),
    Array(POSES[0], (2,)),
    Array(CHAR, (8,)),
    Array(CHAR, (12,)),
    Array(CHAR, (3, 5)),
    Array(CHAR, (2, 2, 4)),
)
_PLAIN: Final[tuple[Type, ...]] = (INT, INT, REAL, REAL, BOOL, CHAR, COLOUR)
_STRUCTURED: Final[tuple[Type, ...]] = (
    *(MODE, POINT, RECORD, STATE),
    *POSES,
    *AXIS_TYPES,
)
_DEEPEST: Final = 80


class _Programs:
    """Makes one program."""

    def __init__(self, choices: Choices, size: Size) -> None:
        self.choices = choices
        self.size = size
        self.risk = choices.pick((3, 6, 12)) if choices.chance(size.risky) else 0
        self.variables = 0

    # ----------------------------------------------------------------------- files

    def sample(self) -> Sample:
        """All files."""
        choices = self.choices
        shared = Scope()
        files: list[tuple[str, str]] = []
        config = self._data_list("$CONFIG", shared, self._types(), is_public=True)
        if choices.chance(30):
            files += self._library(shared)
        own = shared.inner()
        data = ["INT COUNT=0", *(self._signals(own) if choices.chance(40) else [])]
        if choices.chance(15):
            data.append("CHANNEL :SER_1 :SER_1 $PSER_1")
        if choices.chance(25):
            data += self._imported(own, files)
        listed = self._data_list("PROG", own, data, is_public=False)
        program = self._source("PROG", own, choices.between(1, self.size.routines))
        return Sample(
            (("PROG.SRC", program), ("PROG.DAT", listed), ("$CONFIG.DAT", config), *files)
        )

    def _types(self) -> list[str]:
        """The types of the user, for all to see."""
        choices = self.choices
        found = [f"GLOBAL ENUM {one.name} {','.join(one.constants)}" for one in (COLOUR, MODE)]
        for structure in (POINT, RECORD):
            groups: list[str] = []
            before = ""
            for member in structure.members:
                name, written = declared(member.type, member.name)
                groups.append(
                    written if name == before and choices.chance(50) else f"{name} {written}"
                )
                before = name
            found.append(f"GLOBAL STRUC {structure.name} {','.join(groups)}")
        return found

    def _signals(self, scope: Scope) -> list[str]:
        """Names for inputs and outputs [IOT-03]."""
        rows: tuple[tuple[str, Type, str, bool], ...] = (
            ("SIG_IN", BOOL, "$IN[5]", False),
            ("SIG_OUT", BOOL, "$OUT[6]", True),
            ("GRP_IN", INT, "$IN[9] TO $IN[12]", False),
            ("GRP_OUT", INT, "$OUT[17] TO $OUT[24]", True),
        )
        for name, type_, _, is_writable in rows:
            scope.add(Variable(name, type_, is_writable=is_writable, is_local=False))
        return [f"SIGNAL {name} {means}" for name, _, means, _ in rows]

    def _imported(self, scope: Scope, files: Sequence[tuple[str, str]]) -> list[str]:
        """A variable of another data list under a name of its own [ADV-05]."""
        if not files:
            return []
        scope.add(Variable("THEIRS", INT, is_local=False))
        return ["IMPORT INT THEIRS IS /R1/LIB..KEPT"]

    def _data_list(
        self, name: str, scope: Scope, definitions: Sequence[str], *, is_public: bool
    ) -> str:
        choices = self.choices
        lines = [f"DEFDAT {name}{' PUBLIC' if is_public else ''}", *definitions]
        word = "GLOBAL " if is_public else ""
        most = self.size.data
        for type_ in (*self._some(_PLAIN, most + 1), *self._some(_STRUCTURED, (most + 1) // 2)):
            lines += self._datum(scope, type_, word)
        tables = self._some(_TABLES, most)
        if is_public and not scope.arrays(CHAR, 1):
            tables.append(Array(CHAR, (12,)))
        for type_ in tables:
            lines += self._datum(scope, type_, word)
        for type_ in self._some((INT, REAL, CHAR, COLOUR, BOOL), most):
            constant_name = self._name("K")
            lines.append(
                f"DECL {word}CONST {declared(type_, constant_name)[0]} {constant_name}"
                f"={constant(choices, type_)}"
            )
            scope.add(Variable(constant_name, type_, is_writable=False, is_local=False))
        return "\n".join([*lines, "ENDDAT", ""])

    def _some(self, items: Sequence[Type], most: int) -> list[Type]:
        return [self.choices.pick(items) for _ in range(self.choices.below(most + 1))]

    def _name(self, letter: str) -> str:
        self.variables += 1
        return f"{letter}{self.variables}"

    def _datum(self, scope: Scope, type_: Type, word: str) -> list[str]:
        """A variable of a data list, with initial values nearly always [TYP-10]."""
        choices = self.choices
        name = self._name("D")
        has_value = not choices.chance(4)
        type_name, declarator = declared(type_, name)
        first = f"{self._decl(type_name)}{word}{type_name} {declarator}"
        if word and not first.startswith("DECL"):
            first = f"{word}{type_name} {declarator}"
        scope.add(Variable(name, type_, is_local=False, has_value=has_value))
        if not has_value:
            return [first]
        values = initialisation(choices, type_, name)
        if isinstance(type_, Array):
            return [first, *(f"{target}={value}" for target, value in values)]
        return [f"{first}={values[0][1]}"]

    def _decl(self, type_name: str) -> str:
        return "" if type_name in WITHOUT_DECL and self.choices.chance(40) else "DECL "

    def _library(self, shared: Scope) -> list[tuple[str, str]]:
        """A module of its own, with what others can call and see."""
        inner = shared.inner()
        kept = ["GLOBAL INT KEPT=7", "DECL GLOBAL REAL RATIO=0.75"]
        inner.add(Variable("KEPT", INT, is_local=False))
        inner.add(Variable("RATIO", REAL, is_local=False))
        data = self._data_list("LIB", inner, kept, is_public=True)
        for variable in inner.variables():
            shared.add(variable)
        before = len(inner.routines)
        text = self._source("LIB", inner, self.choices.between(1, 2), is_library=True)
        shared.routines += inner.routines[before:]
        return [("LIB.SRC", text), ("LIB.DAT", data)]

    # ----------------------------------------------------------------------- routines

    def _source(self, name: str, scope: Scope, count: int, *, is_library: bool = False) -> str:
        """A source file; the first routine is made last, as it may call all others."""
        written: list[str] = []
        for number in range(count):
            routine_name = f"{name}_R{number}"
            way = self.choices.below(10)
            if way < 2:
                text, routine = self._recursive(routine_name, scope, is_library=is_library)
            elif way < 5 and not is_library:
                text, routine = self._routine(routine_name, scope, is_for_interrupts=True)
            else:
                text, routine = self._routine(routine_name, scope, is_global=is_library)
            written.append(text)
            scope.routines.append(routine)
        if is_library:
            text, routine = self._routine(name, scope)
            scope.routines.append(routine)
        else:
            text = self._main(name, scope)
        return "\n".join([text, *written])

    def _main(self, name: str, scope: Scope) -> str:
        code = self._code(scope, self.size.budget, Part(is_main=True))
        head = self._declare(code, [])
        code.passes.append("COUNT")  # of the data list; no other routine counts with it
        self._begin(code)
        if self.choices.chance(10):
            code.channel()
        code.statements()
        if self.size.routines > 1:
            code.statements()
        return "\n".join([f"DEF {name}()", *head, *code.lines, "END", ""])

    def _routine(
        self, name: str, scope: Scope, *, is_for_interrupts: bool = False, is_global: bool = False
    ) -> tuple[str, Routine]:
        choices = self.choices
        result: Type | None = None
        if not is_for_interrupts and choices.chance(60):
            result = choices.weighted(_RESULTS)
        parameters = self._parameters(is_short=is_for_interrupts)
        part = Part(is_for_interrupts=is_for_interrupts, result=result)
        code = self._code(scope, self.size.others, part)
        head = self._declare(code, parameters)
        if not choices.chance(4):
            self._begin(code)
            code.statements(min(self.size.statements, 4))
        if is_for_interrupts and choices.chance(25):
            code.write("RESUME")
        if result is not None and not choices.chance(4):
            code.spend()
            code.returned()
        cost = code.spent + 2
        text = _written(name, parameters, result, [*head, *code.lines], is_global=is_global)
        return text, Routine(name, tuple(parameters), result, cost, is_for_interrupts)

    def _recursive(self, name: str, scope: Scope, *, is_library: bool) -> tuple[str, Routine]:
        """A routine that calls itself as often as its first parameter tells."""
        choices = self.choices
        result = choices.pick((INT, REAL, None))
        parameters = [Parameter("N", INT, is_out=False)]
        if choices.chance(50):
            parameters.append(Parameter("P1", choices.pick((INT, REAL)), is_out=True))
        if choices.chance(40):
            parameters.append(Parameter("P2", _TEXT, is_out=choices.chance(30)))
        code = self._code(scope, 25, Part(result=result))
        head = self._declare(code, parameters)
        self._begin(code, are_few=True)
        code.spend(4)
        code.write("IF N<=0 THEN")
        code.write("  RETURN 1" if result is not None else "  RETURN")
        code.write("ENDIF")
        for one in parameters[1:]:
            if one.type == _TEXT and choices.chance(50):
                code.spend()
                code.write(f"P2[{choices.between(1, 2)}]={constant(choices, CHAR)}")
        passed = (f", {one.name}{'[]' * (one.type == _TEXT)}" for one in parameters[1:])
        more = "".join(passed)
        if result is None:
            code.write(f"{name}(N-1{more})")
            code.statements(1)
        else:
            sign = choices.pick(("+ 1", "- N", "* 1", "/ 2"))
            code.write(f"RETURN {name}(N-1{more}) {sign}")
        text = _written(name, parameters, result, [*head, *code.lines], is_global=is_library)
        routine = Routine(name, tuple(parameters), result, code.spent + 2, deepest=_DEEPEST)
        return text, routine

    def _parameters(self, *, is_short: bool) -> list[Parameter]:
        choices = self.choices
        found = []
        for number in range(choices.below(2 if is_short else 4)):
            if not is_short and choices.chance(40):
                array = choices.pick(_OPEN)
                is_in = array == _TEXT and choices.chance(50)  # no other array is [SCO-07]
                found.append(Parameter(f"P{number}", array, is_out=not is_in))
            else:
                type_ = choices.pick((*_PLAIN, POINT, POSES[0], POSES[3], AXIS_TYPES[2]))
                is_out = choices.chance(50)
                found.append(
                    Parameter(f"P{number}", type_, is_out, not is_out or choices.chance(60))
                )
        return found

    def _code(self, scope: Scope, budget: int, part: Part) -> Statements:
        return Statements(self.choices, self.size, scope.inner(), budget, self.risk, part)

    def _declare(self, code: Statements, parameters: Sequence[Parameter]) -> list[str]:
        """Declarations of parameters and of what is local; nothing local has a value yet."""
        choices = self.choices
        lines = []
        for one in parameters:
            type_name, declarator = declared(one.type, one.name, is_open=True)
            lines.append(f"  {self._decl(type_name)}{type_name} {declarator}")
            code.scope.add(Variable(one.name, one.type, is_writable=one.name != "N"))
        count = 5 if code.part.is_main else 3
        code.passes = [f"W{number}" for number in range(1, count + 1)]
        lines.append(f"  INT {','.join(code.passes)}")
        if code.part.is_main and choices.chance(10):
            lines.append("  EXTFCT REAL ELSEWHERE(INT:IN,CHAR[]:OUT)")
        wanted = [*self._some(_PLAIN, 2), *self._some(_STRUCTURED, 1), *self._some(_TABLES, 1)]
        if code.part.is_main:
            wanted += [INT, REAL, BOOL, CHAR]
        for type_ in wanted:
            name = self._local_name(code)
            type_name, declarator = declared(type_, name)
            lines.append(f"  {self._decl(type_name)}{type_name} {declarator}")
            code.scope.add(Variable(name, type_, has_value=not choices.chance(5)))
        return lines

    def _local_name(self, code: Statements) -> str:
        """A new name, or now and then that of a datum, which is hidden then [SCO-05]."""
        hidden = [
            one.name for one in code.scope.variables() if not one.is_local and one.name[0] == "D"
        ]
        if hidden and self.choices.chance(5):
            return self.choices.pick(hidden)
        return self._name("V")

    def _begin(self, code: Statements, *, are_few: bool = False) -> None:
        """Give local variables their first values."""
        code.write(f"{code.passes[0]}=0")
        code.spend()
        for variable in list(code.scope.variables()):
            if not variable.is_local or not variable.has_value or variable.name[0] != "V":
                continue
            values = initialisation(self.choices, variable.type, variable.name)
            del values[4 if are_few else 12 :]
            for target, value in values:
                code.spend()
                code.write(f"{target}={value}")


_TEXT: Final = Array(CHAR, (None,))
_OPEN: Final[tuple[Type, ...]] = (
    Array(INT, (None,)),
    _TEXT,
    Array(INT, (None, None)),
    Array(REAL, (None,)),
    _TEXT,
    Array(CHAR, (None, None)),
    Array(POINT, (None,)),
    Array(INT, (None, None, None)),
)
_RESULTS: Final[tuple[tuple[int, Type], ...]] = (
    (5, INT),
    (4, REAL),
    (4, BOOL),
    (2, CHAR),
    (2, COLOUR),
    (2, POINT),
    (2, POSES[0]),
    (1, POSES[3]),
    (2, Array(CHAR, (8,))),
)


def _written(
    name: str,
    parameters: Sequence[Parameter],
    result: Type | None,
    lines: Sequence[str],
    *,
    is_global: bool,
) -> str:
    formal = []
    for one in parameters:
        rank = len(one.type.sizes) if isinstance(one.type, Array) else 0
        index = f"[{',' * (rank - 1)}]" if rank else ""
        mode = (":OUT" if one.is_out else ":IN") if one.is_explicit else ""
        formal.append(f"{one.name}{index}{mode}")
    word = "GLOBAL " if is_global else ""
    if result is None:
        return "\n".join([f"{word}DEF {name}({','.join(formal)})", *lines, "END", ""])
    type_name, _ = declared(result, "")
    size = f"[{result.sizes[0]}]" if isinstance(result, Array) else ""
    head = f"{word}DEFFCT {type_name}{size} {name}({','.join(formal)})"
    return "\n".join([head, *lines, "ENDFCT", ""])
