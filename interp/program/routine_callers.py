"""Callers for routines with parameters, so that each routine can be run by itself.

A program cannot begin with a routine that has parameters. So another one declares a variable for
each parameter, assigns values to these variables, and calls the routine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from itertools import chain, count, islice, product
from typing import Any, Final

from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    Array,
    Enumeration,
    Scalar,
    Structure,
    Type,
    is_position,
)
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from grammar.syntax.walk import walk
from interp.program.load import CheckedProgram, Routine, with_main
from interp.program.variables import is_complete, is_complete_parameter
from interp.robot.models.stand_in import Places
from interp.standins.completion import StandIn
from interp.standins.default_values import DefaultValues

#: The size of an array if the parameter has none.
_LENGTH: Final = 8
#: The largest number of assignments to one variable.
_MOST_VALUES: Final = 200
#: A value for each scalar type, as source; the INT 1 is an index of every array.
_VALUES: Final[Mapping[Type, str]] = {INT: "1", REAL: "1.0", BOOL: "TRUE", CHAR: '"A"'}
_PREFIX: Final = "KRL_CALLS_"

#: Returns a value of a structure type as source, for a variable of that name; ``""`` if its members
#: are to be assigned one by one.
_MakeValue = Callable[[Structure, str], str]


@dataclass(frozen=True, slots=True)
class Callers:
    """The main file of a program with callers appended, and the routine that each of them calls."""

    source: Source
    called: Mapping[str, str]


def with_callers(program: CheckedProgram) -> Callers:
    """Append callers to the main file of a program, one for each routine that needs one."""
    made = _callers(program, lambda one: not program.can_begin(one))
    source = program.main.source
    lines = chain.from_iterable(lines for _, lines in made.values())
    return Callers(
        replace(source, text="\n".join([source.text, *lines, ""])) if made else source,
        {name: called for name, (called, _) in made.items()},
    )


def with_caller(program: CheckedProgram, name: str | None = None) -> CheckedProgram:
    """Return a program that can begin with a routine of its main file, by default the first one.

    All that its caller does takes place at the name of the routine: the file itself is as it was.
    A parameter gets the constant that a call in the project passes for it, or the first value that
    a SWITCH of the routine compares it with; points get places within reach. All of them are listed
    as stand-ins. A program is returned unchanged if it can begin without a caller, or if its
    parameters have unknown types.
    """
    found = program.routines_of(program.main)
    if name is not None:
        found = tuple(one for one in found if one.node.name.key == name.upper())
    if not found or program.can_begin(found[0]):
        return program
    routine, unit = found[0], program.main
    places = Places([one.source for one in program.units.values()])
    defaults = DefaultValues(places)

    def point(type_: Structure, name: str) -> str:
        return defaults.usable(type_, name) if is_position(type_) else ""

    made = _callers(
        program, lambda one: one.node is routine.node, _constants(program, routine), point
    )
    if not made:
        return program
    ((name, (_, lines)),) = made.items()
    module, added = unit.module.syntax, read_module("\n".join([*lines, ""]))
    assert module is not None, "only what can be read is loaded"
    assert isinstance(module.content, ast.Program), "it has a routine"
    assert isinstance(added, ast.Module), "callers can be read"
    assert isinstance(added.content, ast.Program), "a routine"
    caller = _placed_at(routine.node.name.span, added.content.routines[0])
    content = replace(module.content, routines=(*module.content.routines, caller))
    stand_ins = tuple(
        StandIn(one.name.text, "variable", "argument", unit.module.path, unit.line(routine.node))
        for one in routine.node.parameters
    )
    return replace(
        with_main(program, replace(module, content=content)),
        stand_ins=(*program.stand_ins, *stand_ins),
        callers={routine.node.name.key: name},
    )


def _placed_at(span: ast.Span, part: Any) -> Any:
    """Return a part of a syntax tree as if all of it stood at one place: the file has no more."""
    if isinstance(part, tuple):
        return tuple(_placed_at(span, one) for one in part)
    if not isinstance(part, ast.Node):
        return part
    inner = {one.name: _placed_at(span, getattr(part, one.name)) for one in fields(part)}
    return replace(part, **(inner | {"span": span}))


def _constants(program: CheckedProgram, routine: Routine) -> Mapping[str, str]:
    """Return the constants that parameters are known to receive, by their names in upper case."""
    names = [one.name.key for one in routine.node.parameters]
    known: dict[str, str] = {}
    for unit in program.units.values():
        assert unit.module.syntax is not None, "only what can be read is loaded"
        for node in walk(unit.module.syntax):
            if isinstance(node, ast.Call) and node.name.key == routine.node.name.key:
                for name, argument in zip(names, node.arguments, strict=False):
                    if isinstance(argument, ast.Literal):
                        known.setdefault(name, unit.source.text[slice(*argument.span)])
    for node in walk(routine.node):
        if isinstance(node, ast.Switch) and isinstance(node.selector, ast.Variable):
            for value in (value for branch in node.branches for value in branch.values):
                if isinstance(value, ast.Literal):
                    text = routine.unit.source.text[slice(*value.span)]
                    known.setdefault(node.selector.name.key, text)
    return known


def _callers(
    program: CheckedProgram,
    is_called: Callable[[Routine], bool],
    known: Mapping[str, str] | None = None,
    point: _MakeValue = lambda _type, _name: "",
) -> dict[str, tuple[str, list[str]]]:
    """Return callers by name: the routine that each calls, and its lines.

    ``known`` are values of parameters.
    """
    found = {}
    routines = program.routines_of(program.main)
    taken = {routine.node.name.key for routine in routines}
    names = (name for number in count() if (name := f"{_PREFIX}{number}") not in taken)
    for name, routine in zip(names, routines, strict=False):
        if is_called(routine):
            lines = _caller_lines(program, routine, name, known or {}, point)
            if lines is not None:
                found[name] = routine.name, lines
    return found


def _caller_lines(
    program: CheckedProgram,
    routine: Routine,
    name: str,
    known: Mapping[str, str],
    point: _MakeValue,
) -> list[str] | None:
    declared, given, arguments = [], list[str](), []
    for number, parameter in enumerate(routine.node.parameters, start=1):
        found = routine.scope.own(Space.VALUE, parameter.name.key)
        type_ = None if found is None else program.type_of(found)
        if type_ is None or not is_complete_parameter(type_):
            return None
        declared.append(_declaration(f"P{number}", type_))
        value = known.get(parameter.name.key)
        if value is not None and isinstance(type_, Scalar | Enumeration):
            given.append(f"P{number}={value}")
        else:
            given += islice(_assignments(f"P{number}", type_, point), _MOST_VALUES)
        arguments.append(f"P{number}{_brackets(type_)}")
    call = f"{routine.name}({','.join(arguments)})"
    result = program.result_of(routine)
    if result is not None:
        if not is_complete(result):
            return None
        declared.append(_declaration("R", result))
        call = f"R{_brackets(result)}={call}"
    return [f"DEF {name}()", *declared, *given, call, "END"]


def _declaration(name: str, type_: Type) -> str:
    if isinstance(type_, Array):
        return f"DECL {type_.element} {name}[{','.join(map(str, _sizes(type_)))}]"
    return f"DECL {type_} {name}"


def _brackets(type_: Type) -> str:
    return f"[{',' * (len(type_.sizes) - 1)}]" if isinstance(type_, Array) else ""


def _sizes(type_: Array) -> list[int]:
    return [size or _LENGTH for size in type_.sizes]


def _assignments(place: str, type_: Type, point: _MakeValue) -> Iterator[str]:
    """Yield assignments that give every part of a variable a value."""
    match type_:
        case Array(element=element) if element == CHAR and len(type_.sizes) == 1:
            yield f'{place}[]="A"'
        case Array(element=element):
            for indices in product(*(range(1, size + 1) for size in _sizes(type_))):
                yield from _assignments(f"{place}[{','.join(map(str, indices))}]", element, point)
        case Structure(members=members):
            value = point(type_, place)
            if value:
                yield f"{place}={value}"
            for member in members if not value else ():
                yield from _assignments(f"{place}.{member.name}", member.type, point)
        case Enumeration(constants=constants):
            yield f"{place}=#{constants[0]}"
        case _:
            yield f"{place}={_VALUES[type_]}"
