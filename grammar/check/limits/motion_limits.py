"""Velocities, accelerations and approximation beyond the limits of the robot or beyond 100 %.

The limits are in the machine data: ``$VEL_MA`` and ``$ACC_MA`` of the project's own $MACHINE list.
Without these, only values that no robot can reach are reported: m/s written as mm/s. BAS reduces
excessive values [MOT-03, MOT-04], the variables do not, and the resulting message is not
documented; therefore these are warnings.
"""

from __future__ import annotations

from typing import Any

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.type_checker import TypeChecker
from grammar.semantics.scopes import Found
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import without_parentheses

#: The machine data for each component that a program sets.
_MAXIMA = {"$VEL": "$VEL_MA", "$ACC": "$ACC_MA"}
#: m/s and m/s² that no robot reaches.
_FASTEST = {("$VEL", "CP"): 10.0, ("$ACC", "CP"): 100.0}
_PERCENT = frozenset({"$VEL_AXIS", "$ACC_AXIS", "$VEL_EXTAX", "$ACC_EXTAX"})
_PERCENT_OF = frozenset({("$APO", "CPTP"), ("$APO", "CVEL")})


def check_motion_limit(checker: TypeChecker, node: ast.Assignment) -> None:
    """Judge a value that is known before the program runs."""
    shown = checker.context.source.text[slice(*node.target.span)]
    value = without_parentheses(node.value)
    if isinstance(node.target, ast.Variable) and isinstance(value, ast.Aggregate):
        for part in value.components:
            limits = _limits_of_part(checker, node.target.name.key, part.name.key)
            _judge(checker, part.value, f"{shown}.{part.name.text}", limits)
    else:
        _judge(checker, node.value, shown, _limits(checker, node.target))


def _judge(
    checker: TypeChecker,
    node: ast.Expression,
    shown: str,
    limits: tuple[float, float, str] | None,
) -> None:
    if limits is None:
        return
    low, high, reason = limits
    message = f"{shown} must be between {low:g} and {high:g}"
    rules = ("MOT-02", "MOT-04", "ARI-11")
    check_range(checker, node, message, low, high, reason=reason, rules=rules, is_unconfirmed=True)


def check_range(
    checker: TypeChecker,
    node: ast.Expression,
    message: str,
    low: float,
    high: float,
    **more: Any,
) -> None:
    """Check a value that a system variable receives, or note what a parameter may be there."""
    value = constant(checker.context, node)
    if value is None:
        use = f"assigns it, and {message}"
        checker.context.note_bound(node, "invalid-system-value", use, low, high)
    elif not isinstance(value, bool | str) and not low <= value <= high:
        checker.report("invalid-system-value", node, message, **more)


def _limits(checker: TypeChecker, node: ast.Expression) -> tuple[float, float, str] | None:
    """Return the minimum and maximum value, and the machine data that determine them."""
    match node:
        case ast.Subscript(base=ast.Variable(name=name)) if name.key in _PERCENT:
            return 0, 100, "it is a percentage"
        case ast.Subscript(base=ast.Variable(name=name)) if name.key == "$ANOUT":
            return -1, 1, "1 stands for 10 V"
        case ast.Member(base=ast.Variable(name=name), name=part):
            return _limits_of_part(checker, name.key, part.key)
    return None


def _limits_of_part(
    checker: TypeChecker, variable: str, part: str
) -> tuple[float, float, str] | None:
    place = variable, part
    if place in _PERCENT_OF:
        return 0, 100, "it is a percentage"
    most = _most(checker, variable, part)
    if most is not None:
        return 0, most, f"so says {_MAXIMA[variable]} in the machine data"
    if place in _FASTEST:
        return 0, _FASTEST[place], "its unit is based on metres"
    return None


def _most(checker: TypeChecker, variable: str, part: str) -> float | None:
    """Return the limit of a component in the machine data of the project."""
    if variable not in _MAXIMA:
        return None
    found = checker.context.scope.find(Space.VALUE, _MAXIMA[variable])
    if not isinstance(found, Found) or not isinstance(found.symbol.value, ast.Aggregate):
        return None
    for component in found.symbol.value.components:
        if component.name.key == part:
            value = without_parentheses(component.value)
            if isinstance(value, ast.IntegerLiteral | ast.RealLiteral):
                return float(value.value)
    return None
