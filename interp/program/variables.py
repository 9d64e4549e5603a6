"""Variables as every executor has them: which types they can be of, and what data lists declare.

A variable whose type is not known in every part has no place: what is written in terms of it ends
the program with a `LinkError` when it is reached. So have all that is read of the world without a
type, and a variable passed :OUT as another type.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cache

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.semantics.types import Array, Enumeration, Scalar, Structure, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from interp.program.load import CheckedProgram, Routine, Unit
from interp.values.faults import LinkError

#: All variables of a program together hold at most so many scalars.
MOST_CELLS = 1 << 20


@cache
def is_complete(type_: Type) -> bool:
    """Whether a variable can be of a type: all its parts and sizes are known."""
    match type_:
        case Scalar():
            return True
        case Enumeration(constants=names):
            return _are_distinct(names)
        case Structure(members=members):
            is_known = all(is_complete(one.type) for one in members)
            return is_known and _are_distinct([one.name for one in members])
        case Array(element=element, sizes=sizes):
            is_known = 1 <= len(sizes) <= 3 and all(size for size in sizes)
            return is_known and is_complete(element) and not isinstance(element, Array)
    return False


def _are_distinct(names: Sequence[str]) -> bool:
    return bool(names) and len({name.upper() for name in names}) == len(names)


def is_complete_parameter(type_: Type) -> bool:
    """Whether a parameter can be of a type: a formal array has its sizes from what it receives."""
    return is_complete(
        Array(type_.element, (1,) * len(type_.sizes)) if isinstance(type_, Array) else type_
    )


@cache
def cells(type_: Type) -> int:
    """How many scalars a variable holds; what has no known type or size counts as 1."""
    match type_:
        case Structure():
            return sum(cells(one.type) for one in type_.members)
        case Array():
            return cells(type_.element) * math.prod(size or 1 for size in type_.sizes)
    return 1


def cells_of_routine(program: CheckedProgram, routine: Routine) -> int:
    """How many scalars the parameters and local data of a routine hold."""
    found = (
        routine.scope.own(space, symbol.key)
        for space, symbol in routine.table.table.symbols()
        if space is Space.VALUE
    )
    return sum(cells(program.type_of(one)) for one in found if one is not None)


def too_large(routine: Routine) -> LinkError:
    """A program begins with a routine that has more variables than fit."""
    return LinkError(f"the variables of {routine.name} are too large")


def is_referable(parameter: Type, variable: Type) -> bool:
    """Whether a variable can be passed :OUT: only the sizes of arrays may differ [SCO-06]."""
    if isinstance(parameter, Array) and isinstance(variable, Array):
        is_alike = len(parameter.sizes) == len(variable.sizes)
        return is_alike and parameter.element == variable.element
    return parameter == variable


# --------------------------------------------------------------------------------- what fails


def untyped(name: str) -> LinkError:
    """A variable, or a part of one, is needed of which no type is known."""
    return LinkError(f"the type of {name} is not known")


def untyped_parameter(name: str, routine: str) -> LinkError:
    """A routine is called that has a parameter of no known type."""
    return LinkError(f"the type of {name}, a parameter of {routine}, is not known")


def untyped_result(routine: str) -> LinkError:
    """A function is called whose result is unknown."""
    return LinkError(f"the type that {routine} gives is not known")


def untyped_value(path: Sequence[str | int]) -> LinkError:
    """A system variable, or a part of one, is read of which no type is known."""
    return untyped(str(path[0]) if len(path) == 1 else f"a part of {path[0]}")


def mismatched(parameter: Type) -> LinkError:
    """A variable is passed :OUT that is not `is_referable`."""
    return LinkError(f"an argument :OUT of another type than {parameter}")


# --------------------------------------------------------------------------------- data lists


def data_lists(program: CheckedProgram) -> Iterator[tuple[Unit, ast.DataList]]:
    """The data lists of a program, in the order of its files."""
    for unit in program.units.values():
        content = unit.module.syntax.content if unit.module.syntax else None
        if isinstance(content, ast.DataList):
            yield unit, content


def data_variables(program: CheckedProgram, unit: Unit) -> Iterator[tuple[Found, Type]]:
    """The variables that a data list declares, but those of no known type.

    The controller's own are among them, because others may begin with their values; it is the world
    that has them when the program runs.
    """
    scope = program.project.scope(unit.module)
    assert unit.module.table is not None, "it was checked"
    for space, symbol in unit.module.table.table.symbols():
        is_variable = symbol.kind in (Kind.VARIABLE, Kind.CONSTANT)
        if space is Space.VALUE and is_variable and not isinstance(symbol, SignalSymbol):
            found = scope.own(space, symbol.key)
            assert found is not None, "a scope has what its table has"
            type_ = program.type_of(found)
            if is_complete(type_):
                yield found, type_


def first_values(
    unit: Unit, content: ast.DataList
) -> Iterator[tuple[int, ast.Expression, ast.Expression]]:
    """The assignments that fill a data list: line, target, value."""
    for item in content.items:
        line = unit.line(item)
        match item:
            case ast.VariableDeclaration():
                for declarator in item.declarators:
                    if declarator.value is not None:
                        yield line, ast.Variable(declarator.span, declarator.name), declarator.value
            case ast.Assignment():
                yield line, item.target, item.value


def signal_ends(symbol: SignalSymbol) -> Iterator[tuple[ast.Name, list[int]]]:
    """What a signal begins and ends with: the name of a variable, and the index of an element.

    What is neither, which the check refuses, is left out [IOT-03].
    """
    for node in (symbol.first, symbol.last):
        match node:
            case ast.Variable(name=name):
                yield name, []
            case ast.Subscript(
                base=ast.Variable(name=name), indices=(ast.IntegerLiteral(value=number),)
            ):
                yield name, [number]
