"""Declarations, and the text of routines: heads, parameters, local data, initial values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from grammar.generation.choices import Choices
from grammar.generation.literals import constant, declarator, initialisation, type_name
from grammar.generation.routine_writer import Names, RoutineWriter
from grammar.generation.scope import Parameter, Routine, Scope, Variable
from grammar.generation.types import AXIS_TYPES, COLOUR, POINT, POSES, TEXT
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type

#: The parameter of a recursive routine that limits the remaining depth.
DEPTH: Final = "N"
PLAIN: Final[tuple[Type, ...]] = (INT, INT, REAL, REAL, BOOL, CHAR, COLOUR)
_ARRAYS: Final[tuple[Array, ...]] = (
    Array(INT, (None,)),
    TEXT,
    Array(INT, (None, None)),
    Array(REAL, (None,)),
    TEXT,
    Array(CHAR, (None, None)),
    Array(POINT, (None,)),
    Array(INT, (None, None, None)),
)
#: Types that can also be declared without DECL [TYP-06].
_WITHOUT_DECL: Final = frozenset(
    "INT REAL BOOL CHAR FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split()
)


# ------------------------------------------------------------------------- data lists


def _decl(choices: Choices, type_: Type, *, is_global: bool = False) -> str:
    """Return the text before a declarator: DECL unless it is left out, GLOBAL, the type."""
    name = type_name(type_)
    is_short = name in _WITHOUT_DECL and choices.chance(40)
    return f"{'' if is_short else 'DECL '}{'GLOBAL ' if is_global else ''}{name}"


def datum(choices: Choices, scope: Scope, type_: Type, name: str, *, is_global: bool) -> list[str]:
    """Return the lines of a variable in a data list, nearly always with initial values [TYP-10]."""
    has_value = not choices.chance(4)
    first = f"{_decl(choices, type_, is_global=is_global)} {declarator(type_, name)}"
    scope.add(Variable(name, type_, is_local=False, has_value=has_value))
    if not has_value:
        return [first]
    values = initialisation(choices, type_, name)
    if isinstance(type_, Array):
        return [first, *(f"{target}={value}" for target, value in values)]
    return [f"{first}={values[0][1]}"]


def constant_datum(
    choices: Choices, scope: Scope, type_: Type, name: str, *, is_global: bool
) -> str:
    """Return the declaration of a named constant [TYP-07]."""
    scope.add(Variable(name, type_, is_writable=False, is_local=False))
    word = "GLOBAL " if is_global else ""
    value = constant(choices, type_)
    return f"DECL {word}CONST {type_name(type_)} {name}={value}"


def enumeration(type_: Enumeration) -> str:
    """Return the definition of a global enumeration."""
    return f"GLOBAL ENUM {type_.name} {','.join(type_.constants)}"


def structure_definition(choices: Choices, type_: Structure) -> str:
    """Return the definition of a global structure; members of one type may share its name."""
    groups: list[str] = []
    before = ""
    for member in type_.members:
        name, written = type_name(member.type), declarator(member.type, member.name)
        groups.append(written if name == before and choices.chance(50) else f"{name} {written}")
        before = name
    return f"GLOBAL STRUC {type_.name} {','.join(groups)}"


# ------------------------------------------------------------------------- routines


def parameters(choices: Choices, names: Names, count: int, *, has_arrays: bool) -> list[Parameter]:
    """Return formal parameters; those of interrupt routines are no arrays."""
    drawn = [_parameter(choices, has_arrays) for _ in range(count)]
    return [replace(one, name=names.new("P")) for one in drawn]


def _parameter(choices: Choices, has_arrays: bool) -> Parameter:
    if has_arrays and choices.chance(40):
        array = choices.pick(_ARRAYS)
        is_in = array == TEXT and choices.chance(50)  # no other array is [SCO-07]
        return Parameter("", array, is_out=not is_in)
    type_ = choices.pick((*PLAIN, POINT, POSES[0], POSES[3], AXIS_TYPES[2]))
    is_out = choices.chance(50)
    return Parameter("", type_, is_out, not is_out or choices.chance(60))


def declare_parameters(code: RoutineWriter, given: Sequence[Parameter]) -> None:
    """Declare the parameters; the one that limits recursion is not writable."""
    for one in given:
        first = _decl(code.choices, one.type)
        code.line(f"{first} {declarator(one.type, one.name, is_open=True)}")
        code.scope.add(Variable(one.name, one.type, is_writable=one.name != DEPTH))


def declare(
    code: RoutineWriter, types: Sequence[Type], new_name: Callable[[], str]
) -> list[Variable]:
    """Declare local variables and return them; they have no value yet."""
    found: list[Variable] = []
    for type_ in types:
        name = new_name()
        code.line(f"{_decl(code.choices, type_)} {declarator(type_, name)}")
        has_value = not code.choices.chance(5)
        found.append(Variable(name, type_, has_value=has_value))
        code.scope.add(found[-1])
    return found


def begin(code: RoutineWriter, variables: Sequence[Variable], most: int) -> None:
    """Write initial values of local variables, at most ``most`` parts of each."""
    for variable in variables:
        if variable.has_value:
            values = initialisation(code.choices, variable.type, variable.name)
            for target, value in values[:most]:
                code.spend()
                code.set(target, value)


def routine_text(code: RoutineWriter, routine: Routine, *, is_global: bool = False) -> list[str]:
    """Return the lines of a routine with its first and last one."""
    formal = []
    for one in routine.parameters:
        rank = len(one.type.sizes) if isinstance(one.type, Array) else 0
        index = f"[{',' * (rank - 1)}]" if rank else ""
        mode = (":OUT" if one.is_out else ":IN") if one.is_explicit else ""
        formal.append(f"{one.name}{index}{mode}")
    word, given = "GLOBAL " if is_global else "", ", ".join(formal)
    name = f"{routine.name}({given})"
    if routine.result is None:
        return [f"{word}DEF {name}", *code.lines, "END"]
    size = f"[{routine.result.sizes[0]}]" if isinstance(routine.result, Array) else ""
    return [f"{word}DEFFCT {type_name(routine.result)}{size} {name}", *code.lines, "ENDFCT"]
