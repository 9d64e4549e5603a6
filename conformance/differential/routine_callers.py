"""Programs for routines with parameters, so that each routine can be tried by itself.

A program cannot begin with a routine that has parameters. So a routine is added behind its file
that declares a variable for each of them, gives these values and calls it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product
from typing import Final

from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from interp.program.load import CheckedProgram, Routine
from interp.program.variables import is_complete, is_complete_parameter

#: What an array has where a parameter does not tell its size.
_LENGTH: Final = 8
#: So many values at most are given to one variable.
_MOST_VALUES: Final = 200
#: A letter, a number, a truth value for each scalar; 1 is an index of any array.
_VALUES: Final[Mapping[Type, str]] = {INT: "1", REAL: "1.0", BOOL: "TRUE", CHAR: '"A"'}
_PREFIX: Final = "KRL_CALLS_"


@dataclass(frozen=True, slots=True)
class Callers:
    """The file of a program with routines added, and which of them calls which routine."""

    source: Source
    called: Mapping[str, str]


def with_callers(program: CheckedProgram) -> Callers:
    """Add routines to the first file of a program that call those with parameters."""
    unit = program.main
    parts, called = [unit.source.text], {}
    for number, routine in enumerate(program.routines_of(unit)):
        if program.can_begin(routine):
            continue
        name = f"{_PREFIX}{number}"
        lines = _lines(program, routine, name)
        if lines is not None:
            parts += lines
            called[name] = routine.name
    source = replace(unit.source, text="\n".join([*parts, ""])) if called else unit.source
    return Callers(source, called)


def _lines(program: CheckedProgram, routine: Routine, name: str) -> list[str] | None:
    declared, given, arguments = [], list[str](), []
    for number, parameter in enumerate(routine.node.parameters, start=1):
        found = routine.scope.own(Space.VALUE, parameter.name.key)
        type_ = None if found is None else program.type_of(found)
        if type_ is None or not is_complete_parameter(type_):
            return None
        declared.append(_declared(f"P{number}", type_))
        given += islice(_given(f"P{number}", type_), _MOST_VALUES)
        arguments.append(f"P{number}{_whole(type_)}")
    call = f"{routine.name}({','.join(arguments)})"
    result = program.result_of(routine)
    if result is not None:
        if not is_complete(result):
            return None
        declared.append(_declared("R", result))
        call = f"R{_whole(result)}={call}"
    return [f"DEF {name}()", *declared, *given, call, "END"]


def _declared(name: str, type_: Type) -> str:
    if isinstance(type_, Array):
        return f"DECL {type_.element} {name}[{','.join(map(str, _sizes(type_)))}]"
    return f"DECL {type_} {name}"


def _whole(type_: Type) -> str:
    return f"[{',' * (len(type_.sizes) - 1)}]" if isinstance(type_, Array) else ""


def _sizes(type_: Array) -> list[int]:
    return [size or _LENGTH for size in type_.sizes]


def _given(place: str, type_: Type) -> Iterator[str]:
    """Assignments of a value to every part."""
    match type_:
        case Array(element=element) if element == CHAR and len(type_.sizes) == 1:
            yield f'{place}[]="A"'
        case Array(element=element):
            for indices in product(*(range(1, size + 1) for size in _sizes(type_))):
                yield from _given(f"{place}[{','.join(map(str, indices))}]", element)
        case Structure(members=members):
            for member in members:
                yield from _given(f"{place}.{member.name}", member.type)
        case Enumeration(constants=constants):
            yield f"{place}=#{constants[0]}"
        case _:
            yield f"{place}={_VALUES[type_]}"
