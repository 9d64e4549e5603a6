"""Variables as every executor sees them: their possible types, and what data lists declare.

A variable has no storage unless its type is known completely. A statement that uses a variable
without storage ends the program with a `LinkError` when it is reached. The same holds for reading a
system variable of unknown type, and for passing a variable :OUT as another type.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.semantics.types import Array, Enumeration, Scalar, Structure, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from interp.program.load import CheckedProgram, Routine, Unit
from interp.values.faults import LinkError

#: The largest number of scalars in all variables of a program together.
MOST_CELLS = 1 << 20

#: The number of types whose answers are kept, far more than a program has.
_REMEMBERED = 1 << 14


@lru_cache(_REMEMBERED)
def is_complete(type_: Type) -> bool:
    """Return whether a variable can have a type: all its members and array sizes are known."""
    match type_:
        case Scalar():
            return True
        case Enumeration(constants=names):
            return _are_distinct(names)
        case Structure(members=members):
            is_known = all(is_complete(one.type) for one in members)
            return is_known and _are_distinct([one.name for one in members])
        case Array(element=element, sizes=sizes):
            is_known = 1 <= len(sizes) <= 3 and all(size is not None and size > 0 for size in sizes)
            return is_known and is_complete(element) and not isinstance(element, Array)
    return False


def _are_distinct(names: Sequence[str]) -> bool:
    return bool(names) and len({name.upper() for name in names}) == len(names)


def is_complete_parameter(type_: Type) -> bool:
    """Return whether a parameter can have a type; an array takes its sizes from the argument."""
    return is_complete(
        Array(type_.element, (1,) * len(type_.sizes)) if isinstance(type_, Array) else type_
    )


@lru_cache(_REMEMBERED)
def cells(type_: Type) -> int:
    """Return the number of scalars in a variable; a part of unknown type or size counts as 1."""
    match type_:
        case Structure():
            return sum(cells(one.type) for one in type_.members)
        case Array():
            return cells(type_.element) * math.prod(size or 1 for size in type_.sizes)
    return 1


def cells_of_routine(program: CheckedProgram, routine: Routine) -> int:
    """Return the number of scalars in the parameters and local data of a routine."""
    found = (
        routine.scope.own(space, symbol.key)
        for space, symbol in routine.table.table.symbols()
        if space is Space.VALUE
    )
    return sum(cells(program.type_of(one)) for one in found if one is not None)


def too_large(routine: Routine) -> LinkError:
    """Return the error for a routine whose variables exceed `MOST_CELLS`."""
    return LinkError(f"the variables of {routine.name} are too large")


def is_referable(parameter: Type, variable: Type) -> bool:
    """Return whether a variable can be passed :OUT: only array sizes may differ [SCO-06]."""
    if isinstance(parameter, Array) and isinstance(variable, Array):
        is_alike = len(parameter.sizes) == len(variable.sizes)
        return is_alike and parameter.element == variable.element
    return parameter == variable


# --------------------------------------------------------------------------------- what fails


def untyped(name: str) -> LinkError:
    """Return the error for a variable, or a part of one, of unknown type."""
    return LinkError(f"the type of {name} is not known")


def untyped_parameter(name: str, routine: str) -> LinkError:
    """Return the error for a call of a routine with a parameter of unknown type."""
    return LinkError(f"the type of {name}, a parameter of {routine}, is not known")


def untyped_result(routine: str) -> LinkError:
    """Return the error for a call of a function with a result of unknown type."""
    return LinkError(f"the type that {routine} gives is not known")


def untyped_value(path: Sequence[str | int]) -> LinkError:
    """Return the error for reading a system variable, or a part of one, of unknown type."""
    return untyped(str(path[0]) if len(path) == 1 else f"a part of {path[0]}")


def mismatched(parameter: Type) -> LinkError:
    """Return the error for an argument that has to be `is_referable` and is not."""
    return LinkError(f"an argument of another type than {parameter}")


# --------------------------------------------------------------------------------- data lists


def data_lists(program: CheckedProgram) -> Iterator[tuple[Unit, ast.DataList]]:
    """Yield the data lists of a program, in the order of its files."""
    for unit in program.units.values():
        content = unit.module.syntax.content if unit.module.syntax else None
        if isinstance(content, ast.DataList):
            yield unit, content


def data_variables(program: CheckedProgram, unit: Unit) -> Iterator[tuple[Found, Type]]:
    """Yield the variables that a data list declares, with their types, unless a type is unknown.

    System variables that the list declares are included, because the initial values of other
    variables may depend on theirs. When the program runs, the controller holds them.
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
    """Yield the assignments that initialise a data list, as (line, target, value)."""
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
    """Yield the first and the last variable of a signal, each with the index of its element if any.

    An end that is neither a variable nor an element, which the check rejects, is left out [IOT-03].
    """
    for node in (symbol.first, symbol.last):
        match node:
            case ast.Variable(name=name):
                yield name, []
            case ast.Subscript(
                base=ast.Variable(name=name), indices=(ast.IntegerLiteral(value=number),)
            ):
                yield name, [number]
