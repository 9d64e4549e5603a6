"""Calls: the number and types of arguments, and whether there is a result.

An :IN argument is converted if that loses at most a fraction; a variable passed :OUT must have the
type of its parameter [ARI-04, SCO-06]. Arguments may be left out [SCO-13]; functions of the
controller and of option packages are known to need them.
"""

from __future__ import annotations

from dataclasses import replace

from grammar.check.analysis.signal_direction import side_of
from grammar.check.analysis.type_checker import TypeChecker
from grammar.semantics.assignability import passable
from grammar.semantics.package_scope import PackageScope
from grammar.semantics.scopes import Found, Scope
from grammar.semantics.symbols import Kind, ParameterSymbol, RoutineSymbol
from grammar.semantics.system_scope import SystemScope
from grammar.semantics.types import UNKNOWN, Array, Type, Verdict
from grammar.syntax import ast


def call(checker: TypeChecker, node: ast.Call, *, is_value: bool) -> Type:
    """Return the type of a call's result, or `UNKNOWN` without a result; check its arguments."""
    found = checker.context.found(node.name)
    if found is None or not isinstance(found.symbol, RoutineSymbol) or found.is_open:
        for argument in node.arguments:
            if argument is not None:
                checker.infer(argument)
        value: Type = UNKNOWN
    else:
        _check_arguments(checker, node, found.symbol, found.scope)
        value = _value(checker, node, found, is_value=is_value)
    checker.context.types[node] = value
    return value


def _is_uncertain(symbol: RoutineSymbol, scope: Scope) -> bool:
    """Return whether the parameters are from recollection, or those of an option package."""
    if isinstance(scope, PackageScope):
        return True
    if not isinstance(scope, SystemScope):
        return False
    return scope.system.functions[symbol.name].is_unconfirmed


def _value(checker: TypeChecker, node: ast.Call, found: Found, *, is_value: bool) -> Type:
    symbol = found.symbol
    if symbol.type is not None or symbol.given is not None:
        if not is_value:
            message = f"the value of {symbol.name} is dropped"
            checker.report("value-unused", node.name, message)
        return checker.type_of(found)
    if is_value:
        message = f"{symbol.name} has no value"
        reason = "" if isinstance(found.scope, SystemScope) else "it is a DEF and no DEFFCT"
        checker.report("no-value", node, message, reason=reason)
    return UNKNOWN


def _check_arguments(
    checker: TypeChecker, node: ast.Call, symbol: RoutineSymbol, scope: Scope
) -> None:
    given, wanted = node.arguments, symbol.parameters
    is_uncertain = _is_uncertain(symbol, scope)
    has_more = len(given) > len(wanted) and symbol.more is None
    if has_more:
        many = "no arguments" if not wanted else counted(len(wanted))
        message = f"{symbol.name} takes {many}, and this is one more"
        if len(given) > len(wanted) + 1:
            message = f"{symbol.name} takes {many}, and these are {len(given)}"
        first = next(filter(None, given[len(wanted) :]), node)
        checker.report("too-many-arguments", first, message, is_unconfirmed=is_uncertain)
    if isinstance(scope, SystemScope | PackageScope):
        _check_missing(checker, node, symbol, is_uncertain=is_uncertain)
    for place, argument in enumerate(given):
        parameter = symbol.parameter(place)
        # too many may be those of another routine, so their types say nothing
        if argument is not None and parameter is not None and not has_more:
            _check(checker, symbol, parameter, scope, argument, is_uncertain=is_uncertain)
        elif argument is not None:
            checker.infer(argument)
    _check_output(checker, node, symbol, scope)


def counted(number: int) -> str:
    """Return a number of arguments in words."""
    return "one argument" if number == 1 else f"{number} arguments"


def _check_missing(
    checker: TypeChecker, node: ast.Call, symbol: RoutineSymbol, *, is_uncertain: bool
) -> None:
    """Report missing arguments of a function of the controller or of an option package.

    KUKA's own programs leave some arguments empty, but never end a list early.
    """
    needed = [one for one in symbol.parameters if not one.is_optional]
    missing = [one.name for one in symbol.parameters[len(node.arguments) :] if one in needed]
    if missing:
        message = f"{symbol.name} needs {counted(len(needed))}"
        reason = f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        checker.report(
            "argument-missing", node, message, reason=reason, is_unconfirmed=is_uncertain
        )


def _check(
    checker: TypeChecker,
    symbol: RoutineSymbol,
    parameter: ParameterSymbol,
    scope: Scope,
    argument: ast.Expression,
    *,
    is_uncertain: bool,
) -> None:
    wanted = checker.type_of_symbol(parameter, scope)
    is_out = parameter.mode == "OUT"
    is_variable = isinstance(argument, ast.Variable | ast.Subscript | ast.Member)
    if is_variable and is_out:
        root = checker.root_symbol(argument)
        is_variable = root is None or root.kind is not Kind.CONSTANT

    def accepts(to: Type, value: Type) -> Verdict:
        verdict = passable(to, value, is_out=is_out, is_variable=is_variable)
        if not verdict.is_misfit:
            return verdict
        what = f"the parameter {parameter.name} of {symbol.name} is {to}"
        return replace(verdict, reason=f"{what}, and this argument is {value}")

    checker.check(wanted, argument, accepts, "wrong-argument", is_unconfirmed=is_uncertain)
    # arrays are passed :OUT only [SCO-07], so texts have no other way
    is_text = isinstance(argument, ast.StringLiteral) and isinstance(wanted, Array)
    is_known = checker.context.types[argument] != UNKNOWN
    if is_out and is_known and not is_variable and not is_text:
        message = f"the parameter {parameter.name} is :OUT, so it needs a variable here"
        checker.report("nothing-to-change", argument, message)


def _check_output(
    checker: TypeChecker, node: ast.Call, symbol: RoutineSymbol, scope: Scope
) -> None:
    """PULSE acts on an output [IOT-07]."""
    if symbol.name != "PULSE" or not isinstance(scope, SystemScope) or not node.arguments:
        return
    output = node.arguments[0]
    if output is not None and side_of(checker.context, output) == "inputs":
        checker.report("not-an-output", output, "PULSE acts on an output, and this is an input")
