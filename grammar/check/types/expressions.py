"""Findings about literals, variables and operators; `grammar.semantics.operations` has the rules.

Calls and aggregates have modules of their own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from grammar.check.analysis.constant_folding import constant, integer_of
from grammar.check.analysis.context import Context
from grammar.check.analysis.type_checker import Rule, TypeChecker
from grammar.check.types.aggregates import aggregate
from grammar.check.types.calls import call
from grammar.diagnostics.diagnostic import Fix
from grammar.semantics.assignability import index
from grammar.semantics.operations import (
    BITWISE,
    EQUALITY,
    LOGICAL,
    ORDER,
    binary,
    component,
    subscript,
    unary,
)
from grammar.semantics.scopes import Found
from grammar.semantics.types import (
    BOOL,
    INT,
    INT_MAX,
    REAL,
    UNKNOWN,
    Array,
    Constant,
    Enumeration,
    Structure,
    Text,
    Type,
    is_number,
)
from grammar.syntax import ast
from grammar.syntax.ast import Node
from grammar.syntax.walk import left_chain, root_variable

_LOGICAL = LOGICAL | BITWISE
_RELATIONS = EQUALITY | ORDER
_BITS = 2**32 - 1


def type_checker(context: Context) -> TypeChecker:
    """Return a type checker for one file."""
    return TypeChecker(context, _RULES)


# ----------------------------------------------------------------------------------------- literals


def _integer(checker: TypeChecker, node: ast.IntegerLiteral, _expected: Type) -> Type:
    if node.value > INT_MAX:
        _report_too_large(checker, node)
    return INT


def _bits(checker: TypeChecker, node: ast.BitLiteral, _expected: Type) -> Type:
    if node.value > _BITS:
        _report_too_large(checker, node)
    return INT


def _report_too_large(checker: TypeChecker, node: ast.Expression) -> None:
    checker.report("integer-too-large", node, "this number does not fit into the 32 bits of an INT")


# ---------------------------------------------------------------------------------------- variables


def _variable(checker: TypeChecker, node: ast.Variable, _expected: Type) -> Type:
    answer = checker.context.resolution.answers.get(node.name)
    return checker.type_of(answer) if type(answer) is Found else UNKNOWN


def _subscript(checker: TypeChecker, node: ast.Subscript, _expected: Type) -> Type:
    base = checker.infer(node.base)
    for given in node.indices:
        if given is not None:
            kind = checker.infer(given)
            verdict = index(kind)
            if not verdict:
                checker.reject("not-a-number-here", given, verdict)
            elif kind is REAL:
                checker.report("real-index", given, "an index is an INT, and this is a REAL")
    typed = subscript(base, [given is not None for given in node.indices])
    if not typed.verdict:
        checker.reject("wrong-indices", node, typed.verdict)
    elif isinstance(base, Array):
        _check_range(checker, node, base)
    elif base == UNKNOWN:
        _check_range(checker, node, Array(UNKNOWN, (None,) * len(node.indices)))
    return typed.type


def _check_range(checker: TypeChecker, node: ast.Subscript, array: Array) -> None:
    """Constant indices lie within the array [TYP-09].

    How large an array of the controller is differs between releases.
    """
    for size, given in zip(array.sizes, node.indices, strict=True):
        place = integer_of(checker.context, given)
        if given is not None and place is None:
            most = math.inf if size is None else size
            reach = "" if size is None else f" to {size}"
            use = f"uses it as an index from 1{reach}"
            checker.context.note_bound(given, "index-out-of-range", use, 1, most)
        if given is None or place is None or (place >= 1 and (size is None or place <= size)):
            continue
        root = root_variable(node)
        found = checker.context.found(root.name) if root else None
        is_given = array.element == UNKNOWN or (
            place >= 1 and (found is None or found.module is None)
        )
        reach = "begins at 1" if place < 1 else f"ends at {size}"
        message = f"index {place} is outside the array, which {reach}"
        checker.report("index-out-of-range", given, message, is_unconfirmed=is_given)


def _member(checker: TypeChecker, node: ast.Member, _expected: Type) -> Type:
    base = checker.infer(node.base)
    if type(base) is Structure:
        known = base.member(node.name.text)
        if known is not None:
            return known
    typed = component(base, node.name.text)
    if not typed.verdict:
        names = [member.name for member in base.members] if isinstance(base, Structure) else []
        fix = checker.context.suggestions.suggest(node.name.text, names)
        checker.reject_part(node.name, typed.verdict, base, fix)
    return typed.type


# ---------------------------------------------------------------------------------------- operators


def _unary(checker: TypeChecker, node: ast.Unary, _expected: Type) -> Type:
    operand, operator = node.operand, node.operator
    if operator == "-" and type(operand) is ast.IntegerLiteral:
        if operand.value > INT_MAX + 1:
            _report_too_large(checker, node)
        checker.context.types[operand] = INT
        return INT
    inner = checker.infer(operand)
    if operator in "+-" and is_number(inner):
        return inner
    typed = unary(operator, inner)
    if not typed.verdict:
        checker.reject(_of_operator(operator), operand, typed.verdict)
    return typed.type


def _binary(checker: TypeChecker, node: ast.Binary, _expected: Type) -> Type:
    chain = left_chain(node)
    before = len(checker.diagnostics)
    left = checker.infer(chain[0].left)
    for each in chain:
        joined = _joined(checker, each, left)
        if each.operator in _RELATIONS and (_is_logical(each.left) or _is_logical(each.right)):
            joined = _mixed(checker, each, joined, before)
        left = checker.context.types.setdefault(each, joined)
    return left


def _joined(checker: TypeChecker, node: ast.Binary, left: Type) -> Type:
    operator = node.operator
    right = checker.infer(node.right)
    if operator == "/":
        _check_divisor(checker, node.right)
    if left is INT is right and operator in "+-*/":
        return INT
    typed = binary(operator, left, right)
    if not typed.verdict:
        where: Node = node
        if not binary(operator, left, UNKNOWN).verdict:
            where = node.left
        elif not binary(operator, UNKNOWN, right).verdict:
            where = node.right
        enumeration = left if isinstance(left, Enumeration) else right
        constant = right if isinstance(left, Enumeration) else left
        slug = _of_operator(operator)
        if isinstance(enumeration, Enumeration) and isinstance(constant, Constant):
            checker.reject_constant(slug, where, typed.verdict, enumeration, constant)
        else:
            checker.reject(slug, where, typed.verdict)
    elif operator in EQUALITY:
        checker.settle(node.right, left)
        checker.settle(node.left, right)
    return typed.type


def _check_divisor(checker: TypeChecker, node: ast.Expression) -> None:
    value = constant(checker.context, node)
    if value is None:
        checker.context.note_bound(node, "division-by-zero", "divides by it")
    elif value == 0 and type(value) is not bool:
        checker.report("division-by-zero", node, "the divisor is zero")


def _mixed(checker: TypeChecker, node: ast.Binary, made: Type, before: int) -> Type:
    """Relations bind weakest, so ``A == 1 AND B == 2`` is ``(A == (1 AND B)) == 2`` [ARI-05].

    That is never meant. As the order of operators is recollection, what comes of it is reported as
    one warning. ``before`` is the number of findings before this one.
    """
    if any(found.severity == "error" for found in checker.diagnostics[before:]):
        del checker.diagnostics[before:]
        message = "relations bind weaker than AND, OR, EXOR and NOT, so this does not fit"
        fix = Fix("put each comparison into parentheses")
        checker.report("parentheses-missing", node, message, fix=fix)
        return UNKNOWN
    return made


def _is_logical(node: ast.Expression) -> bool:
    """Return whether an operand would have another parent if relations bound tighter."""
    if isinstance(node, ast.Binary):
        return node.operator in _LOGICAL
    return isinstance(node, ast.Unary) and node.operator in {"NOT", "B_NOT"}


def _of_operator(operator: str) -> str:
    """Return the code of a finding for a wrong operand."""
    if operator in LOGICAL or operator == "NOT":
        return "not-a-truth-value"
    if operator in BITWISE or operator == "B_NOT":
        return "not-an-integer"
    if operator == ":":
        return "not-a-frame"
    return "not-comparable" if operator in _RELATIONS else "not-a-number"


_RULES: Mapping[type[Any], Rule] = {
    ast.IntegerLiteral: _integer,
    ast.RealLiteral: lambda *_: REAL,
    ast.BoolLiteral: lambda *_: BOOL,
    ast.BitLiteral: _bits,
    ast.StringLiteral: lambda _checker, node, _expected: Text(len(node.text)),
    ast.EnumConstant: lambda _checker, node, _expected: Constant(node.name.text),
    ast.Variable: _variable,
    ast.Subscript: _subscript,
    ast.Member: _member,
    ast.ChannelName: lambda *_: UNKNOWN,
    ast.Call: lambda checker, node, _expected: call(checker, node, is_value=True),
    ast.Unary: _unary,
    ast.Binary: _binary,
    ast.Parenthesised: lambda checker, node, _expected: checker.infer(node.inner),
    ast.Aggregate: aggregate,
}
