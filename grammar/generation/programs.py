"""Whole programs: files, data lists, and routines that call one another and terminate.

A routine is generated before its callers, so the cost of a call is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from grammar.generation.choices import Choices, SeededChoices, Weighted
from grammar.generation.control_flow import returned, statements
from grammar.generation.literals import constant
from grammar.generation.routine_writer import Names, Part, RoutineWriter, Size
from grammar.generation.routines import (
    DEPTH,
    PLAIN,
    begin,
    constant_datum,
    datum,
    declare,
    declare_parameters,
    enumeration,
    parameters,
    routine_text,
    structure_definition,
)
from grammar.generation.scope import Parameter, Routine, Scope, Variable
from grammar.generation.statements import channel
from grammar.generation.style import STYLE
from grammar.generation.types import AXIS_TYPES, COLOUR, MODE, POINT, POSES, RECORD, STATE, TEXT
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type


@dataclass(frozen=True, slots=True)
class Sample:
    """A program: its files by path; the first one has the main routine."""

    files: tuple[tuple[str, str], ...]

    @property
    def main(self) -> str:
        """The path of the file with the main routine."""
        return self.files[0][0]


def seeded(seed: int, number: int) -> Sample:
    """Return the program with this number under a seed; it is always the same."""
    return generate(SeededChoices(f"{seed}/{number}"))


def generate(choices: Choices, size: Size | None = None, suffix: str = "") -> Sample:
    """Return a program that has no error and terminates; most are small.

    ``suffix`` ends the names of its variables.
    """
    return _Programs(choices, size or choices.weighted(_SIZES), suffix).sample()


_SIZES: Final = Weighted(
    (12, Size(budget=150, others=40, statements=2, routines=1, data=1)),
    (6, Size(budget=250, others=60, statements=3, routines=2)),
    (2, Size()),
)
_RESULTS: Final = Weighted[Type](
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
_STRUCTURED: Final[tuple[Type, ...]] = (MODE, POINT, RECORD, STATE, *POSES, *AXIS_TYPES)
_SIGNALS: Final[tuple[tuple[str, Type, str, bool], ...]] = (
    ("SIG_IN", BOOL, "$IN[5]", False),
    ("SIG_OUT", BOOL, "$OUT[6]", True),
    ("GRP_IN", INT, "$IN[9] TO $IN[12]", False),
    ("GRP_OUT", INT, "$OUT[17] TO $OUT[24]", True),
)
#: Greatest depth of recursion of a routine.
_DEEPEST: Final = 80
#: How many parts of a local variable a routine initialises at most.
_MOST_FIRST_VALUES, _FEW_FIRST_VALUES = 12, 4


class _Programs:
    """Generates one program."""

    def __init__(self, choices: Choices, size: Size, suffix: str) -> None:
        self.choices = choices
        self.size = size
        self.risk = choices.pick((3, 6, 12)) if choices.chance(size.risky) else 0
        self.names = Names(suffix)
        self.has_channel = choices.chance(15)

    # ----------------------------------------------------------------------- files

    def sample(self) -> Sample:
        """Return the files of the program."""
        choices = self.choices
        shared = Scope()
        files: list[tuple[str, str]] = []
        config = self._data_list("$CONFIG", shared, self._types(), is_public=True)
        if choices.chance(30):
            files += self._library(shared)
        own = shared.inner()
        data = ["INT COUNT=0"]
        if choices.chance(40):
            data += [f"SIGNAL {name} {means}" for name, _, means, _ in _SIGNALS]
            for name, type_, _, is_writable in _SIGNALS:
                own.add(Variable(name, type_, is_writable=is_writable, is_local=False))
        if self.has_channel:
            data.append("CHANNEL :SER_1 :SER_1 $PSER_1")
        if choices.chance(25) and files:  # of another data list, under a name of its own [ADV-05]
            own.add(Variable("THEIRS", INT, is_local=False))
            data.append("IMPORT INT THEIRS IS /R1/LIB..KEPT")
        listed = self._data_list("PROG", own, data, is_public=False)
        program = self._source("PROG", own, choices.between(1, self.size.routines))
        return Sample(
            (("PROG.SRC", program), ("PROG.DAT", listed), ("$CONFIG.DAT", config), *files)
        )

    def _types(self) -> list[str]:
        """Return the declarations of global types."""
        return [
            *(enumeration(one) for one in (COLOUR, MODE)),
            *(structure_definition(self.choices, one) for one in (POINT, RECORD)),
        ]

    def _data_list(
        self, name: str, scope: Scope, definitions: Sequence[str], *, is_public: bool
    ) -> str:
        choices, most = self.choices, self.size.data
        lines = [f"DEFDAT {name}{' PUBLIC' if is_public else ''}", *definitions]

        def declare_all(types: Sequence[Type]) -> None:
            for type_ in types:
                name = self.names.new("D")
                lines.extend(datum(choices, scope, type_, name, is_global=is_public))

        declare_all([*self._some(PLAIN, most + 1), *self._some(_STRUCTURED, (most + 1) // 2)])
        tables = self._some(_TABLES, most)
        if is_public and not scope.arrays(CHAR, 1):
            tables.append(Array(CHAR, (12,)))
        declare_all(tables)
        for type_ in self._some((INT, REAL, CHAR, COLOUR, BOOL), most):
            name = self.names.new("K")
            lines.append(constant_datum(choices, scope, type_, name, is_global=is_public))
        return "\n".join([*lines, "ENDDAT", ""])

    def _some(self, items: Sequence[Type], most: int) -> list[Type]:
        return [self.choices.pick(items) for _ in range(self.choices.below(most + 1))]

    def _library(self, shared: Scope) -> list[tuple[str, str]]:
        """Return the files of a library module, whose declarations go into ``shared``."""
        inner = shared.inner()
        kept = ["GLOBAL INT KEPT=7", "DECL GLOBAL REAL RATIO=0.75"]
        inner.add(Variable("KEPT", INT, is_local=False))
        inner.add(Variable("RATIO", REAL, is_local=False))
        data = self._data_list("LIB", inner, kept, is_public=True)
        shared.extend(inner.variables())
        before = len(inner.routines())
        text = self._source("LIB", inner, self.choices.between(1, 2), is_library=True)
        for routine in inner.routines()[before:]:
            shared.add_routine(routine)
        return [("LIB.SRC", text), ("LIB.DAT", data)]

    # ----------------------------------------------------------------------- routines

    def _source(self, name: str, scope: Scope, count: int, *, is_library: bool = False) -> str:
        """Return a source file; its main routine is generated last, as it may call all others."""
        written: list[str] = []
        for number in range(count):
            routine_name = f"{name}_R{number}"
            way = self.choices.below(10)
            if way < 2:
                written += self._recursive(routine_name, scope, is_library=is_library)
            elif way < 5 and not is_library:
                written += self._routine(routine_name, scope, is_action=True)
            else:
                written += self._routine(routine_name, scope, is_global=is_library)
        main = self._routine(name, scope) if is_library else self._main(name, scope)
        return "\n".join([*main, *written, ""])

    def _main(self, name: str, scope: Scope) -> list[str]:
        code = self._code(scope, self.size.budget, Part(is_main=True))
        variables = self._declare(code, [])
        code.passes.append("COUNT")  # of the data list; no other routine counts with it
        self._begin(code, variables, _MOST_FIRST_VALUES)
        if self.has_channel:
            channel(code)
        statements(code)
        if self.size.routines > 1:
            statements(code)
        return routine_text(code, Routine(name))

    def _routine(
        self, name: str, scope: Scope, *, is_action: bool = False, is_global: bool = False
    ) -> list[str]:
        choices = self.choices
        result: Type | None = None
        if not is_action and choices.chance(60):
            result = choices.weighted(_RESULTS)
        count = choices.below(2 if is_action else 4)
        given = parameters(choices, self.names, count, has_arrays=not is_action)
        code = self._code(scope, self.size.others, Part(is_action=is_action, result=result))
        variables = self._declare(code, given)
        if not choices.chance(4):
            self._begin(code, variables, _MOST_FIRST_VALUES)
            statements(code, min(self.size.statements, 4))
        if is_action and choices.chance(25):
            code.line("RESUME")
        if result is not None and not choices.chance(4):
            code.spend()
            returned(code)
        routine = Routine(name, tuple(given), result, code.spent + 2, is_action)
        scope.add_routine(routine)
        return routine_text(code, routine, is_global=is_global)

    def _recursive(self, name: str, scope: Scope, *, is_library: bool) -> list[str]:
        """Return a recursive routine; its first parameter limits the depth."""
        choices = self.choices
        result = choices.pick((INT, REAL, None))
        given = [Parameter(DEPTH, INT, is_out=False)]
        if choices.chance(50):
            given.append(Parameter("P1", choices.pick((INT, REAL)), is_out=True))
        if choices.chance(40):
            given.append(Parameter("P2", TEXT, is_out=choices.chance(30)))
        code = self._code(scope, 25, Part(result=result))
        self._begin(code, self._declare(code, given), _FEW_FIRST_VALUES)
        code.spend(4)
        code.guarded(f"{DEPTH}<=0", "RETURN" if result is None else "RETURN 1")
        for one in given[1:]:
            if one.type == TEXT and choices.chance(50):
                code.spend()
                code.line(f"P2[{choices.between(1, 2)}]={constant(choices, CHAR)}")
        more = "".join(f", {one.name}{'[]' * (one.type == TEXT)}" for one in given[1:])
        if result is None:
            code.line(f"{name}({DEPTH}-1{more})")
            statements(code, 1)
        else:
            sign = choices.pick(("+ 1", f"- {DEPTH}", "* 1", "/ 2"))
            code.line(f"RETURN {name}({DEPTH}-1{more}) {sign}")
        routine = Routine(name, tuple(given), result, code.spent + 2, deepest=_DEEPEST)
        scope.add_routine(routine)
        return routine_text(code, routine, is_global=is_library)

    def _code(self, scope: Scope, budget: int, part: Part) -> RoutineWriter:
        return RoutineWriter(
            self.choices,
            STYLE,
            self.names,
            scope.inner(),
            size=self.size,
            budget=budget,
            risk=self.risk,
            part=part,
        )

    def _declare(self, code: RoutineWriter, given: Sequence[Parameter]) -> list[Variable]:
        """Declare the parameters and local variables, and return the local variables.

        None of them has a value yet.
        """
        declare_parameters(code, given)
        code.passes = [f"W{number}" for number in range(1, 6 if code.part.is_main else 4)]
        code.line(f"INT {','.join(code.passes)}")
        if code.part.is_main and self.choices.chance(10):
            code.line("EXTFCT REAL ELSEWHERE(INT:IN,CHAR[]:OUT)")
        wanted = [*self._some(PLAIN, 2), *self._some(_STRUCTURED, 1), *self._some(_TABLES, 1)]
        if code.part.is_main:
            wanted += [INT, REAL, BOOL, CHAR]

        def name() -> str:
            """Return a new name, or now and then that of a datum, which is hidden then [SCO-05]."""
            data = [one.name for one in code.scope.variables() if _can_be_hidden(one)]
            if data and self.choices.chance(5):
                return self.choices.pick(data)
            return self.names.new()

        return declare(code, wanted, name)

    def _begin(self, code: RoutineWriter, variables: Sequence[Variable], most: int) -> None:
        """Write the initial values of local variables, at most ``most`` parts of each."""
        code.line(f"{code.passes[0]}=0")
        code.spend()
        begin(code, variables, most)


def _can_be_hidden(variable: Variable) -> bool:
    return not variable.is_local and variable.name[0] == "D"
