"""The types of expressions, and where operands do not fit.

A `Typer` goes through the expressions of one file, each once, and notes what it finds out in the
context: types, and the enumerations that constants belong to, which follow from where they stand
[TYP-16]. What does not fit is told once: its type is `UNKNOWN` from there on.

Recursion goes as deep as an expression, which `grammar.syntax.node_plans.MAX_DEPTH` limits.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from grammar.check.aggregates import aggregate
from grammar.check.calls import call
from grammar.check.constant_folding import integer_of
from grammar.check.context import Context
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, Fix
from grammar.semantics.assignability import assignable, index
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
from grammar.semantics.scopes import Found, Scope, SystemScope
from grammar.semantics.symbols import Kind, Symbol
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
    Verdict,
    is_number,
    without_index,
)
from grammar.syntax import ast
from grammar.syntax.ast import Node, Span

__all__ = ["Judge", "Typer", "root_of", "stripped"]

#: Whether a place of one type can receive a value of another.
Judge = Callable[[Type, Type], Verdict]

_LOGICAL = LOGICAL | BITWISE
_RELATIONS = EQUALITY | ORDER
_BITS = 2**32 - 1
#: An array that is named so has neither an index nor the brackets of a whole array.
_NAMES = frozenset({ast.Variable, ast.Member})
#: The message of the controller for a constant that an enumeration does not have.
_NO_CONSTANT = 2296


def stripped(node: ast.Expression) -> ast.Expression:
    """What stands in the parentheses."""
    while isinstance(node, ast.Parenthesised):
        node = node.inner
    return node


def root_of(node: ast.Expression) -> ast.Expression:
    """What indices and components are taken of: the variable ``a`` of ``a.b[1].c``."""
    while isinstance(node, ast.Subscript | ast.Member):
        node = node.base
    return node


class Typer:
    """Types the expressions of one file; ``found`` is what it has to tell."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.found: list[Diagnostic] = []
        self._types = context.types
        self._answers = context.resolution.answers
        self._declared = context.project.types
        self._of: dict[Found, Type] = {}
        self._rules: Mapping[type[Any], Callable[[Any], Type]] = {
            ast.IntegerLiteral: self._integer,
            ast.RealLiteral: lambda _node: REAL,
            ast.BoolLiteral: lambda _node: BOOL,
            ast.BitLiteral: self._bits,
            ast.StringLiteral: lambda node: Text(len(node.text)),
            ast.EnumConstant: lambda node: Constant(node.name.text),
            ast.Variable: self._variable,
            ast.Subscript: self._subscript,
            ast.Member: self._member,
            ast.ChannelName: lambda _node: UNKNOWN,
            ast.Call: lambda node: call(self, node, is_value=True),
            ast.Unary: self._unary,
            ast.Binary: self._binary,
            ast.Parenthesised: lambda node: self.type(node.inner),
            ast.Aggregate: lambda node: aggregate(self, node, None),
        }

    # ----------------------------------------------------------------------- telling

    def tell(self, slug: str, where: Node | Span, message: str, **more: Any) -> None:
        """Note a finding; see `Context.finding`."""
        self.found.append(self.context.finding(slug, where, message, **more))

    def refuse(
        self,
        slug: str,
        where: Node | Span,
        verdict: Verdict,
        fix: Fix | None = None,
        *,
        is_unconfirmed: bool = False,
    ) -> None:
        """Note a finding from a bad verdict; see `Context.refusal`."""
        self.found.append(
            self.context.refusal(slug, where, verdict, fix=fix, is_unconfirmed=is_unconfirmed)
        )

    # ------------------------------------------------------------------------- names

    def of(self, found: Found) -> Type:
        """The type of what a name means.

        Data of $CONFIG that no file declares have no certain type: another one may declare them
        otherwise.
        """
        known = self._of.get(found)
        if known is None:
            known = self._declared.of(found)
            if isinstance(found.scope, SystemScope) and found.symbol.kind is Kind.VARIABLE:
                entry = found.scope.system.variables[found.symbol.name]
                known = UNKNOWN if entry.file else known
            self._of[found] = known
        return known

    def of_symbol(self, symbol: Symbol, scope: Scope) -> Type:
        """The type of a symbol that a scope declares."""
        return self._declared.of(Found(symbol, scope))

    def root(self, node: ast.Expression) -> Symbol | None:
        """The symbol that an expression reads or changes, if it is a known variable."""
        variable = root_of(node)
        found = self.context.found(variable.name) if isinstance(variable, ast.Variable) else None
        return found.symbol if found else None

    # ------------------------------------------------------------------------- types

    def type(self, node: ast.Expression) -> Type:
        """The type of an expression, whatever is wanted of it."""
        made = self._types[node] = self._rules[type(node)](node)
        return made

    def target(self, node: ast.Expression) -> Type:
        """The type of what is written to; a whole array has brackets [TYP-11, TYP-20]."""
        made = self.type(node)
        if isinstance(made, Array) and not isinstance(node, ast.Subscript):
            self.refuse("array-without-index", node, without_index(made))
            return UNKNOWN
        return made

    def fit(
        self,
        to: Type,
        node: ast.Expression,
        judge: Judge = assignable,
        slug: str = "wrong-value",
        *,
        is_unconfirmed: bool = False,
    ) -> None:
        """Type a value that a place of type ``to`` receives, and tell where that does not fit."""
        if type(node) is ast.Aggregate:
            value = aggregate(self, node, to if isinstance(to, Structure) else None)
        else:
            value = self.type(node)
        if value is to:
            return
        if type(value) is Array and type(node) in _NAMES:
            brackets = Fix("write empty brackets where the whole array is meant")
            self.refuse("array-without-index", node, without_index(value), brackets)
            return
        verdict = judge(to, value)
        if not verdict:
            if verdict.message == _NO_CONSTANT:
                is_unconfirmed |= not self._is_described(to)
            fix = self._meant(to, value)
            self.refuse(_slug(verdict, slug), node, verdict, fix, is_unconfirmed=is_unconfirmed)
        elif not verdict.is_lossless:
            self._tell_lossy(to, node, verdict)
        elif isinstance(value, Constant):
            self.settle(node, to)
        elif to is REAL and value is INT:
            self._tell_quotient(node)

    def settle(self, node: ast.Expression, to: Type) -> None:
        """Note the enumeration of a constant, which is that of its place [TYP-16]."""
        node = stripped(node)
        if isinstance(node, ast.EnumConstant) and isinstance(to, Enumeration):
            self.context.enumerations[node] = to

    def _tell_lossy(self, to: Type, node: ast.Expression, verdict: Verdict) -> None:
        if "TYP-11" in verdict.rules:
            self.tell("text-too-long", node, verdict.reason, rules=verdict.rules)
        elif to is INT:
            literal = stripped(node)
            if not (isinstance(literal, ast.RealLiteral) and literal.value.is_integer()):
                self.tell("rounded", node, verdict.reason, rules=verdict.rules)

    def _tell_quotient(self, node: ast.Expression) -> None:
        """An INT divided by an INT has dropped its fraction before a REAL receives it [ARI-02]."""
        node = stripped(node)
        if not (isinstance(node, ast.Binary) and node.operator == "/"):
            return
        left, right = (integer_of(self.context, side) for side in (node.left, node.right))
        is_known = left is not None and right is not None
        if left is not None and right and left % right == 0:
            return
        message = "the quotient of two INT has no fraction, and a REAL receives it"
        fix = Fix("write one of the numbers with a decimal point")
        severity: Severity = "warning" if is_known else "note"
        self.tell("integer-division", node, message, fix=fix, severity=severity)

    def refuse_part(self, where: Node, verdict: Verdict, type_: Type, fix: Fix | None) -> None:
        """What a type of the controller lacks that one release alone describes may be elsewhere."""
        is_unconfirmed = not self._is_described(type_)
        self.refuse("no-such-component", where, verdict, fix, is_unconfirmed=is_unconfirmed)

    def _meant(self, to: Type, value: Type) -> Fix | None:
        """What a constant may have been meant to be."""
        if isinstance(to, Enumeration) and isinstance(value, Constant):
            return self.context.hints.meant(value.name, to.constants, mark="#")
        return None

    def _is_described(self, type_: Type) -> bool:
        return self.context.system.is_described(type_)

    # ---------------------------------------------------------------------- literals

    def _integer(self, node: ast.IntegerLiteral) -> Type:
        if node.value > INT_MAX:
            self._tell_too_large(node)
        return INT

    def _bits(self, node: ast.BitLiteral) -> Type:
        if node.value > _BITS:
            self._tell_too_large(node)
        return INT

    def _tell_too_large(self, node: ast.Expression) -> None:
        self.tell("integer-too-large", node, "this number does not fit into the 32 bits of an INT")

    # --------------------------------------------------------------------- variables

    def _variable(self, node: ast.Variable) -> Type:
        answer = self._answers.get(node.name)
        return self.of(answer) if type(answer) is Found else UNKNOWN

    def _subscript(self, node: ast.Subscript) -> Type:
        base = self.type(node.base)
        for given in node.indices:
            if given is not None:
                verdict = index(self.type(given))
                if not verdict:
                    self.refuse("not-a-number-here", given, verdict)
        typed = subscript(base, [given is not None for given in node.indices])
        if not typed.verdict:
            self.refuse("wrong-indices", node, typed.verdict)
        elif isinstance(base, Array):
            self._check_range(node, base)
        return typed.type

    def _check_range(self, node: ast.Subscript, array: Array) -> None:
        """Constant indices lie within the array [TYP-09].

        How large an array of the controller is differs between releases.
        """
        for size, given in zip(array.sizes, node.indices, strict=True):
            place = integer_of(self.context, given)
            if given is None or place is None or (place >= 1 and (size is None or place <= size)):
                continue
            root = root_of(node)
            found = self.context.found(root.name) if isinstance(root, ast.Variable) else None
            is_given = place >= 1 and (found is None or found.module is None)
            reach = f"to {size}" if size is not None else "upwards"
            message = f"the index {place} lies outside the array, which reaches from 1 {reach}"
            self.tell("index-out-of-range", given, message, is_unconfirmed=is_given)

    def _member(self, node: ast.Member) -> Type:
        base = self.type(node.base)
        if type(base) is Structure:
            known = base.member(node.name.text)
            if known is not None:
                return known
        typed = component(base, node.name.text)
        if not typed.verdict:
            names = [member.name for member in base.members] if isinstance(base, Structure) else []
            fix = self.context.hints.meant(node.name.text, names)
            self.refuse_part(node.name, typed.verdict, base, fix)
        return typed.type

    # --------------------------------------------------------------------- operators

    def _unary(self, node: ast.Unary) -> Type:
        operand, operator = node.operand, node.operator
        if operator == "-" and type(operand) is ast.IntegerLiteral:
            if operand.value > INT_MAX + 1:
                self._tell_too_large(node)
            self._types[operand] = INT
            return INT
        inner = self.type(operand)
        if operator in "+-" and is_number(inner):
            return inner
        typed = unary(operator, inner)
        if not typed.verdict:
            self.refuse(_of_operator(operator), operand, typed.verdict)
        return typed.type

    def _binary(self, node: ast.Binary) -> Type:
        operator = node.operator
        if operator in _RELATIONS and (_is_logical(node.left) or _is_logical(node.right)):
            return self._mixed(node)
        return self._joined(node)

    def _joined(self, node: ast.Binary) -> Type:
        operator = node.operator
        left, right = self.type(node.left), self.type(node.right)
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
            is_elsewhere = typed.verdict.message == _NO_CONSTANT and not self._is_described(
                enumeration
            )
            self.refuse(
                _of_operator(operator),
                where,
                typed.verdict,
                self._meant(enumeration, constant),
                is_unconfirmed=is_elsewhere,
            )
        elif operator in EQUALITY:
            self.settle(node.right, left)
            self.settle(node.left, right)
        return typed.type

    def _mixed(self, node: ast.Binary) -> Type:
        """Relations bind weakest, so ``A == 1 AND B == 2`` is ``(A == (1 AND B)) == 2`` [ARI-05].

        Nobody means that. As the order of operators is recollection, what comes of it is told as
        one warning.
        """
        before = len(self.found)
        made = self._joined(node)
        if any(found.severity == "error" for found in self.found[before:]):
            del self.found[before:]
            message = "relations bind weaker than AND, OR, EXOR and NOT, so this does not fit"
            fix = Fix("put each comparison into parentheses")
            self.tell("parentheses-missing", node, message, fix=fix)
            return UNKNOWN
        return made


def _is_logical(node: ast.Expression) -> bool:
    """Whether an operand would belong to something else if relations bound tighter."""
    if isinstance(node, ast.Binary):
        return node.operator in _LOGICAL
    return isinstance(node, ast.Unary) and node.operator in {"NOT", "B_NOT"}


def _of_operator(operator: str) -> str:
    """The code for an operand that does not fit."""
    if operator in LOGICAL or operator == "NOT":
        return "not-a-truth-value"
    if operator in BITWISE or operator == "B_NOT":
        return "not-an-integer"
    if operator == ":":
        return "not-a-frame"
    return "not-comparable" if operator in _RELATIONS else "not-a-number"


def _slug(verdict: Verdict, slug: str) -> str:
    return "several-letters" if "TYP-03" in verdict.rules else slug
