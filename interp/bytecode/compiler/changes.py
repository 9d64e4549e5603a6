"""Whether a routine may change one of its parameters.

A formal array ``X[]`` that is passed on :IN cannot be copied: nothing tells its size before the
program runs. Where the routine that receives it changes nothing of it, it needs no copy.
"""

from __future__ import annotations

from grammar import ast
from grammar.predefined import System
from grammar.symbols import RoutineSymbol, Symbol
from grammar.walk import walk
from interp.program import Routine

__all__ = ["may_change"]


def may_change(routine: Routine, parameter: Symbol) -> bool:
    """Whether the parameter is assigned, or passed :OUT, anywhere in the routine."""
    for statement in routine.node.body:
        for node in walk(statement):
            match node:
                case ast.Assignment(target=target) if _is_of(target, routine, parameter):
                    return True
                case ast.Call() if _is_passed_out(node, routine, parameter):
                    return True
    return False


def _is_passed_out(call: ast.Call, routine: Routine, parameter: Symbol) -> bool:
    found = routine.unit.found(call.name)
    for number, argument in enumerate(call.arguments):
        if argument is None or not _is_of(argument, routine, parameter):
            continue
        if found is None:
            return True
        if found.module is None:
            places = System.load().functions[call.name.key].parameters
            if number >= len(places) or places[number].is_out:
                return True
            continue
        symbol = found.symbol
        given = symbol.parameters if isinstance(symbol, RoutineSymbol) else ()
        if number >= len(given) or given[number].mode != "IN":
            return True
    return False


def _is_of(node: ast.Expression, routine: Routine, parameter: Symbol) -> bool:
    """Whether it is the parameter or a part of it."""
    while isinstance(node, ast.Subscript | ast.Member):
        node = node.base
    if not isinstance(node, ast.Variable):
        return False
    found = routine.unit.found(node.name)
    return found is not None and found.symbol is parameter
