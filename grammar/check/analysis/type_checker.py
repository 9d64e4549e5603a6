"""Bidirectional type checking of expressions: `TypeChecker.infer` and `TypeChecker.check`.

The type of an expression follows from the rule for its node, which infers the operands. The rules
are passed in (`types.expressions` has the table), so that they can be in separate modules. Types,
and the enumerations of constants, which follow from the context [TYP-16], are stored in the
context. A mismatch is reported once; the type is `UNKNOWN` from then on.

The recursion is as deep as expressions are nested, which `grammar.syntax.node_plans.MAX_DEPTH`
limits.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from grammar.check.analysis.constant_folding import integer_of
from grammar.check.analysis.context import Context
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region
from grammar.semantics.assignability import assignable
from grammar.semantics.scopes import Found, Scope
from grammar.semantics.symbols import Kind, Symbol
from grammar.semantics.system_scope import SystemScope
from grammar.semantics.types import (
    INT,
    REAL,
    UNKNOWN,
    Array,
    Constant,
    Enumeration,
    Structure,
    Type,
    Verdict,
    without_index,
)
from grammar.syntax import ast
from grammar.syntax.ast import Node, Span
from grammar.syntax.walk import root_variable, without_parentheses

#: Whether a place of one type accepts a value of another.
Accepts = Callable[[Type, Type], Verdict]
#: The type of a node; the last argument is that of its place, `UNKNOWN` where it may be anything.
Rule = Callable[["TypeChecker", Any, Type], Type]

#: An array that is named so has neither an index nor the brackets of a whole array.
_NAMES = frozenset({ast.Variable, ast.Member})


class TypeChecker:
    """Infers the types of the expressions of one file; ``diagnostics`` are the mismatches."""

    def __init__(self, context: Context, rules: Mapping[type[Any], Rule]) -> None:
        self.context = context
        self.diagnostics: list[Diagnostic] = []
        self._rules = rules
        self._types = context.types
        self._declared = context.project.types
        self._type_of: dict[Found, Type] = {}

    # ----------------------------------------------------------------------- findings

    def report(self, slug: str, where: Node | Span, message: str, **more: Any) -> None:
        """Note a finding; see `Context.finding`."""
        self.diagnostics.append(self.context.finding(slug, where, message, **more))

    def reject(self, slug: str, where: Node | Span, verdict: Verdict, **more: Any) -> None:
        """Note a finding from a bad verdict; see `Context.refusal`."""
        self.diagnostics.append(self.context.refusal(slug, where, verdict, **more))

    # ------------------------------------------------------------------------- names

    def type_of(self, found: Found) -> Type:
        """Return the type of a declared name.

        Data of $CONFIG that no file declares have no certain type, because the actual declaration
        may differ. The same holds for a data list of a program that is missing, and for a name that
        one scope declares with two types: that is one mistake, and not one at each use.
        """
        known = self._type_of.get(found)
        if known is None:
            known = UNKNOWN if found.is_disputed else self._declared.of(found)
            if isinstance(found.scope, SystemScope) and found.symbol.kind is Kind.VARIABLE:
                entry = found.scope.system.variables[found.symbol.name]
                known = UNKNOWN if entry.file else known
            elif self.context.is_lacking and found.symbol.kind is Kind.VARIABLE:
                is_other = found.module is not None and not self.context.declares(found)
                known = UNKNOWN if is_other else known
            self._type_of[found] = known
        return known

    def type_of_symbol(self, symbol: Symbol, scope: Scope) -> Type:
        """Return the type of a symbol that a scope declares."""
        return self._declared.of(Found(symbol, scope))

    def root_symbol(self, node: ast.Expression) -> Symbol | None:
        """Return the variable that an expression reads or changes, if it is known."""
        variable = root_variable(node)
        found = self.context.found(variable.name) if variable else None
        return found.symbol if found else None

    # ------------------------------------------------------------------------- types

    def infer(self, node: ast.Expression, expected: Type = UNKNOWN) -> Type:
        """Return the type of an expression; ``expected`` is that of its place, as a hint.

        The type is stored, unless the rule has stored another: an aggregate gets the type of its
        place.
        """
        inferred = self._rules[type(node)](self, node, expected)
        self._types.setdefault(node, inferred)
        return inferred

    def infer_target(self, node: ast.Expression) -> Type:
        """Return the type of an assignment target; a whole array has brackets [TYP-11, TYP-20]."""
        inferred = self.infer(node)
        if isinstance(inferred, Array) and not isinstance(node, ast.Subscript):
            self.reject("array-without-index", node, without_index(inferred))
            return UNKNOWN
        return inferred

    def check(
        self,
        to: Type,
        node: ast.Expression,
        accepts: Accepts = assignable,
        slug: str = "wrong-value",
        *,
        is_unconfirmed: bool = False,
    ) -> None:
        """Infer the type of a value that a place of type ``to`` receives; report a misfit."""
        value = self.infer(node, to)
        if value is to:
            return
        if isinstance(to, Enumeration) and isinstance(node, ast.Variable):
            self._note_constant(to, node.name)
        if type(value) is Array and type(node) in _NAMES:
            brackets = self._brackets(to, value, node)
            self.reject("array-without-index", node, without_index(value), fix=brackets)
            return
        verdict = accepts(to, value)
        if not verdict:
            slug = _slug(verdict, slug)
            if isinstance(to, Enumeration) and isinstance(value, Constant):
                self.reject_constant(slug, node, verdict, to, value, is_unconfirmed=is_unconfirmed)
            else:
                self.reject(slug, node, verdict, is_unconfirmed=is_unconfirmed)
        elif not verdict.is_lossless:
            self._report_loss(to, node, verdict)
        elif isinstance(value, Constant):
            self.settle(node, to)
        elif to is REAL and value is INT:
            self._report_quotient(node)

    def check_assignment(self, node: ast.Assignment, accepts: Accepts = assignable) -> None:
        """Check the target of an assignment, and whether it can receive the value.

        Whatever type a variable has, it takes a text only as a whole array, with brackets.
        """
        before, value = len(self.diagnostics), without_parentheses(node.value)
        to = self.infer_target(node.target)
        self.check(to, node.value, accepts)
        is_text = isinstance(value, ast.StringLiteral) and len(value.text) > 1
        is_whole = isinstance(node.target, ast.Subscript) and None in node.target.indices
        if to == UNKNOWN and is_text and not is_whole and len(self.diagnostics) == before:
            self.report("wrong-value", value, "only a whole array, NAME[], takes a text")

    def _brackets(self, to: Type, array: Array, node: ast.Expression) -> Fix:
        """Return the fix that passes an array as a whole; an edit where one is wanted."""
        text = "write empty brackets where the whole array is meant"
        if not isinstance(to, Array) or len(to.sizes) != len(array.sizes):
            return Fix(text)
        end = Region.of(self.context.source, (node.span[1], node.span[1]))
        return Fix(text, end, f"[{',' * (len(array.sizes) - 1)}]")

    def _note_constant(self, to: Enumeration, name: ast.Name) -> None:
        """Record that an undeclared name may be an enumeration constant without its # [TYP-16]."""
        meant = next((one for one in to.constants if one.upper() == name.key), None)
        if meant is not None and self.context.found(name) is None:
            self.context.constants[name] = f"#{meant}"

    def settle(self, node: ast.Expression, to: Type) -> None:
        """Note the enumeration of a constant, which is that of its place [TYP-16]."""
        node = without_parentheses(node)
        if isinstance(node, ast.EnumConstant) and isinstance(to, Enumeration):
            self.context.enumerations[node] = to

    def _report_loss(self, to: Type, node: ast.Expression, verdict: Verdict) -> None:
        if "TYP-11" in verdict.rules:
            self.report("text-too-long", node, verdict.reason, rules=verdict.rules)
        elif to is INT:
            literal = without_parentheses(node)
            if not (isinstance(literal, ast.RealLiteral) and literal.value.is_integer()):
                self.report("rounded", node, verdict.reason, rules=verdict.rules)

    def _report_quotient(self, node: ast.Expression) -> None:
        """Report an INT quotient assigned to a REAL: the fraction is lost before [ARI-02]."""
        node = without_parentheses(node)
        if not (isinstance(node, ast.Binary) and node.operator == "/"):
            return
        left, right = (integer_of(self.context, side) for side in (node.left, node.right))
        is_known = left is not None and right is not None
        if left is not None and right and left % right == 0:
            return
        message = "the quotient of two INT has no fraction, and a REAL receives it"
        fix = Fix("write one of the numbers with a decimal point")
        severity: Severity = "warning" if is_known else "note"
        self.report("integer-division", node, message, fix=fix, severity=severity)

    def reject_part(self, name: ast.Name, verdict: Verdict, type_: Type, fix: Fix | None) -> None:
        """Note a component that a type lacks, which may have a slip where it is declared.

        What a type of the controller lacks that one release alone describes may be elsewhere.
        """
        is_unconfirmed = not self.is_described(type_)
        self.reject("no-such-component", name, verdict, fix=fix, is_unconfirmed=is_unconfirmed)
        if isinstance(type_, Structure):
            self.context.lacking.append((type_, name.text, self.diagnostics[-1]))

    def reject_constant(
        self,
        slug: str,
        where: Node,
        verdict: Verdict,
        to: Enumeration,
        constant: Constant,
        *,
        is_unconfirmed: bool = False,
    ) -> None:
        """Note a constant that an enumeration lacks, which may have a slip where it is declared."""
        is_unconfirmed |= not self.is_described(to)
        fix = self.context.suggestions.suggest(constant.name, to.constants, mark="#")
        self.reject(slug, where, verdict, fix=fix, is_unconfirmed=is_unconfirmed)
        self.context.lacking.append((to, constant.name, self.diagnostics[-1]))

    def is_described(self, type_: Type) -> bool:
        """Return whether more than one release describes a type of the controller."""
        return self.context.system.is_described(type_)


def _slug(verdict: Verdict, slug: str) -> str:
    return "several-letters" if "TYP-03" in verdict.rules else slug
