"""Declarations, and the text of routines: heads, parameters, local data, initial values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from grammar.generation.choices import Choices
from grammar.generation.code import Code, Naming, Style
from grammar.generation.literals import declarator, type_name
from grammar.generation.scope import Parameter, Routine, Scope, Variable
from grammar.semantics.types import Array, Enumeration, Structure, Type

#: The parameter of a recursive routine that limits the remaining depth.
DEPTH: Final = "N"
#: Types that can also be declared without DECL [TYP-06].
_WITHOUT_DECL: Final = frozenset(
    "INT REAL BOOL CHAR FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split()
)


# ------------------------------------------------------------------------- data lists


def decl(choices: Choices, style: Style, type_: Type, *, is_global: bool = False) -> str:
    """Return the text before a declarator: DECL unless it is left out, GLOBAL, the type."""
    name = type_name(type_)
    is_short = name in _WITHOUT_DECL and choices.chance(style.short_declaration_share)
    return f"{'' if is_short else 'DECL '}{'GLOBAL ' if is_global else ''}{name}"


def datum(
    choices: Choices, style: Style, scope: Scope, type_: Type, name: str, *, is_global: bool
) -> list[str]:
    """Return the lines of a variable in a data list, nearly always with initial values [TYP-10]."""
    has_value = not choices.chance(style.bare_share)
    first = f"{decl(choices, style, type_, is_global=is_global)} {declarator(type_, name)}"
    scope.add(Variable(name, type_, is_local=False, has_value=has_value))
    if not has_value:
        return [first]
    values = style.literals.initialisation(choices, type_, name)
    if isinstance(type_, Array):
        return [first, *(f"{target}{style.layout.eq}{value}" for target, value in values)]
    return [f"{first}{style.layout.eq}{values[0][1]}"]


def constant_datum(
    choices: Choices, style: Style, scope: Scope, type_: Type, name: str, *, is_global: bool
) -> str:
    """Return the declaration of a named constant [TYP-07]."""
    scope.add(Variable(name, type_, is_writable=False, is_local=False))
    word = "GLOBAL " if is_global else ""
    value = style.literals.constant(choices, type_)
    return f"DECL {word}CONST {type_name(type_)} {name}{style.layout.eq}{value}"


def enumeration(type_: Enumeration, *, is_global: bool, comma: str = ",") -> str:
    """Return the definition of an enumeration."""
    return f"{'GLOBAL ' if is_global else ''}ENUM {type_.name} {comma.join(type_.constants)}"


def structure_definition(
    choices: Choices, type_: Structure, *, is_global: bool, comma: str = ","
) -> str:
    """Return the definition of a structure; members of one type may share its name."""
    groups: list[str] = []
    before = ""
    for member in type_.members:
        name, written = type_name(member.type), declarator(member.type, member.name)
        groups.append(written if name == before and choices.chance(50) else f"{name} {written}")
        before = name
    return f"{'GLOBAL ' if is_global else ''}STRUC {type_.name} {comma.join(groups)}"


# ------------------------------------------------------------------------- routines


def parameters(
    choices: Choices, style: Style, names: Naming, count: int, *, has_arrays: bool = True
) -> list[Parameter]:
    """Return formal parameters of the style's types; those of interrupt routines are no arrays."""
    drawn = [style.parameter(choices, has_arrays) for _ in range(count)]
    return [replace(one, name=names.variable(one.type, "P")) for one in drawn]


def declare_parameters(code: Code, given: Sequence[Parameter]) -> None:
    """Declare the parameters; the one that limits recursion is not writable."""
    for one in given:
        first = decl(code.choices, code.style, one.type)
        code.line(f"{first} {declarator(one.type, one.name, is_open=True)}")
        code.scope.add(Variable(one.name, one.type, is_writable=one.name != DEPTH))


def declare(code: Code, types: Sequence[Type], name_of: Callable[[Type], str]) -> list[Variable]:
    """Declare local variables and return them; they have no value yet."""
    found: list[Variable] = []
    for type_ in types:
        name, style = name_of(type_), code.style
        is_joined = style.group_share and found and type_name(found[-1].type) == type_name(type_)
        if is_joined and code.choices.chance(style.group_share):
            code.lines[-1] += f"{style.layout.comma}{declarator(type_, name)}"
        else:
            code.line(f"{decl(code.choices, style, type_)} {declarator(type_, name)}")
        has_value = not code.choices.chance(style.bare_local_share)
        found.append(Variable(name, type_, has_value=has_value))
        code.scope.add(found[-1])
    return found


def begin(code: Code, variables: Sequence[Variable], most: int) -> None:
    """Write initial values of local variables, at most ``most`` parts of each."""
    for variable in variables:
        if variable.has_value:
            values = code.style.literals.initialisation(code.choices, variable.type, variable.name)
            for target, value in values[:most]:
                code.spend()
                code.set(target, value)


def routine_text(
    code: Code, routine: Routine, *, is_global: bool = False, close: str = ")"
) -> list[str]:
    """Return the lines of a routine with its first and last one."""
    layout = code.layout
    formal = []
    for one in routine.parameters:
        rank = len(one.type.sizes) if isinstance(one.type, Array) else 0
        index = f"[{',' * (rank - 1)}]" if rank else ""
        mode = (":OUT" if one.is_out else ":IN") if one.is_explicit else ""
        formal.append(f"{one.name}{index}{mode}")
    word, given = "GLOBAL " if is_global else "", layout.comma.join(formal)
    name = f"{routine.name}{layout.before}({given}{close}"
    if routine.result is None:
        return [f"{word}DEF {name}", *code.lines, "END"]
    size = f"[{routine.result.sizes[0]}]" if isinstance(routine.result, Array) else ""
    return [f"{word}DEFFCT {type_name(routine.result)}{size} {name}", *code.lines, "ENDFCT"]
