"""Data lists: whether initial values have the right type, form and place.

This check infers the types of expressions in a data list. Elements of an array get their values on
the lines immediately after the declaration, in ascending order, with the last index running fastest
[TYP-09, TYP-10]. All of some 16,800 elements in public data lists follow their declaration in
ascending order; in 11 places, most of them in files of KUKA, a blank line comes between. A blank
line is therefore a note at most.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.constant_folding import integer_of
from grammar.check.analysis.context import Context
from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.types.expressions import type_checker
from grammar.diagnostics.diagnostic import Diagnostic, Fix
from grammar.semantics.assignability import initial
from grammar.semantics.types import CHAR, Array
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import root_variable


def check(context: Context) -> Iterator[Diagnostic]:
    """Type the initial values of a data list and look at their places."""
    data = context.data
    if data is None:
        return
    values = _Values(type_checker(context))
    for item in data.items:
        if type(item) is ast.VariableDeclaration:
            values.declaration(item)
        elif type(item) is ast.Assignment:
            values.element(item)
        else:
            values.awaited = frozenset()
        values.end = item.span[1]
    yield from values.checker.diagnostics


class _Values:
    """Visits the items of a data list.

    ``awaited`` are the variables whose elements may follow, ``last`` the indices of the last
    element, ``end`` the end of that item.
    """

    def __init__(self, checker: TypeChecker) -> None:
        self.checker = checker
        self.awaited: frozenset[str] = frozenset()
        self.last: tuple[str, tuple[int, ...]] = "", ()
        self.end = 0

    def declaration(self, node: ast.VariableDeclaration) -> None:
        """Check a declaration and its initial values."""
        for declarator in node.declarators:
            if declarator.value is None:
                continue
            found = self.checker.context.found(declarator.name)
            if found is not None and found.symbol.span == declarator.name.span:
                self.checker.check(self.checker.type_of(found), declarator.value, initial)
            else:  # declared twice
                self.checker.infer(declarator.value)
        self.awaited = frozenset(declarator.name.key for declarator in node.declarators)
        self.last = "", ()

    def element(self, node: ast.Assignment) -> None:
        """Check the initial value of an element, or of an array of CHAR."""
        before = len(self.checker.diagnostics)
        self.checker.check_assignment(node, initial)
        is_outside = any(one.code == "KSS1444" for one in self.checker.diagnostics[before:])
        root = root_variable(node.target)
        if root is None:
            return
        if isinstance(node.target, ast.Subscript):
            self._check_place(root.name, node)
            if not is_outside:  # its place is unknown
                self._check_order(root, node.target)
        else:
            message = f"a data list cannot assign to {root.name.text}"
            fix = Fix("give the initial value in the declaration")
            self.checker.report("misplaced-instruction", node, message, fix=fix)

    def _check_place(self, name: ast.Name, node: ast.Assignment) -> None:
        context = self.checker.context
        if context.scope.own(Space.VALUE, name.key) is None:
            return
        if name.key not in self.awaited:
            message = f"the initial values of {name.text} belong directly behind its declaration"
            self.checker.report("initial-not-adjacent", node.target, message)
            self.awaited = frozenset({name.key})
        elif _has_blank_line(context.source.text[self.end : node.span[0]]):
            message = f"a blank line separates {name.text} from its initial values"
            self.checker.report("initial-not-adjacent", node.target, message, severity="note")

    def _check_order(self, root: ast.Variable, target: ast.Expression) -> None:
        if not (isinstance(target, ast.Subscript) and target.base is root):
            return
        places = [integer_of(self.checker.context, index) for index in target.indices]
        here = tuple(place for place in places if place is not None)
        name, before = self.last
        if len(here) < len(places):
            here = ()
        elif name == root.name.key and len(before) == len(here) and here < before:
            message = "the elements of an array get their initial values in ascending order"
            self.checker.report("initial-order", target, message)
        elif self._is_gap(root.name, before if name == root.name.key else (), here):
            message = f"the letter before this one has no value in {root.name.text}"
            self.checker.report("initial-gap", target, message)
        self.last = root.name.key, here

    def _is_gap(self, name: ast.Name, before: tuple[int, ...], here: tuple[int, ...]) -> bool:
        """Return whether a letter of a text is missing; its value would be undefined."""
        found = self.checker.context.found(name)
        type_ = self.checker.type_of(found) if found else None
        if not here or not isinstance(type_, Array) or type_.element != CHAR:
            return False
        return here[-1] > (before[-1] if before and before[:-1] == here[:-1] else 0) + 1


def _has_blank_line(between: str) -> bool:
    _, *lines = between.replace("\r\n", "\n").replace("\r", "\n").split("\n")[:-1] or [""]
    return any(not line.strip() for line in lines)
