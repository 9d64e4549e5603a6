"""Mutation operators: the small changes of a module's syntax tree that mutants are drawn from.

============ ==================================================================
comparison   a boundary moved (``<`` to ``<=``), or the opposite (``<`` to ``>=``)
arithmetic   ``+`` and ``-``, ``*`` and ``/``, ``&`` and ``|`` … exchanged, a sign left out
connective   ``and`` and ``or`` exchanged, ``not`` left out
condition    that of an ``if``, a loop, a filter or a guard negated
constant     a number more or less by one, or doubled, a truth value inverted
statement    a call, an assignment to a part, ``raise``, ``break``, ``continue`` left out
============ ==================================================================

A ``raise`` is left out where a program of KRL that a controller selects can come to it. What tells
a caller in Python of a mistake, or who wrote machine data, a profile or a program of which parts
are missing, is left as it is, and so is the condition of an ``if`` that does nothing else. So are
texts, annotations, assertions, ``strict`` of a zip among them, defaults of parameters, class
bodies, and what stands behind a ``return`` or ``raise``: they decide nothing, or what they have
decided cannot be replaced in a module that is loaded. A boundary is not moved where a number that
is not whole is compared: what is equal to it is so by chance. Where a factor is within a
ten-thousandth of 1, division for multiplication changes what rounding does.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal

Operator = Literal["comparison", "arithmetic", "connective", "condition", "constant", "statement"]

_BOUNDARY: Final[Mapping[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
}
_OPPOSITE: Final[Mapping[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
_ARITHMETIC: Final[Mapping[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
#: A number from here on is doubled instead: one more or less would be lost in rounding.
_LARGE: Final = 100.0
#: A factor as near to 1 keeps off the errors of rounding.
_ROUNDING: Final = 1e-4
_COMPOUND: Final = (ast.If, ast.While, ast.For, ast.With, ast.Try, ast.Match)
#: Exceptions that report a mistake to a caller in Python, or who wrote machine data, a profile or a
#: program with names that nothing declares: a controller would not select it.
_OWN_MISTAKE: Final = re.compile(
    r"(?:Value|Type|Key|Index|Command|Assertion|NotImplemented|MachineData|Profile|Link)Error\b"
    r"|(?:untyped\w*|mismatched)\("
)
#: Fields that are not searched for changes.
_LEFT_OUT: Final = frozenset({"decorator_list", "annotation", "returns", "ctx"})


@dataclass(frozen=True, slots=True)
class Change:
    """A change that can be made to the tree it was found in.

    ``function`` is the qualified name of the function it lies in, or the name that a module-level
    assignment gives a value to. ``lines``, first and last, are those of the statement or of its
    condition; within a lambda those of the lambda, negative, as it is run at another time than the
    statement that it stands in. ``assignment`` is the module-level statement, ``None`` within
    functions.
    """

    operator: Operator
    function: str
    line: int
    lines: tuple[int, int]
    parent: ast.AST
    name: str
    index: int | None
    old: ast.AST
    new: ast.AST
    assignment: ast.Assign | ast.AnnAssign | None = None

    @property
    def was(self) -> str:
        """The changed code, as source on one line."""
        return " ".join(ast.unparse(self.old).split())

    @property
    def now(self) -> str:
        """The code after the change."""
        return " ".join(ast.unparse(self.new).split())

    def make(self) -> None:
        """Change the tree."""
        if self.index is None:
            setattr(self.parent, self.name, self.new)
        else:
            getattr(self.parent, self.name)[self.index] = self.new


@dataclass(frozen=True, slots=True)
class _Scope:
    """The place of a node: names of enclosing functions and classes, lines of its statement.

    ``reals`` are the names of module constants that are not whole numbers, and these numbers.
    """

    names: tuple[str, ...] = ()
    lines: tuple[int, int] = (0, 0)
    assignment: ast.Assign | ast.AnnAssign | None = None
    reals: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_function(self) -> bool:
        return bool(self.names) and self.names[-1] == "<locals>"

    @property
    def function(self) -> str:
        return ".".join(self.names[:-1] if self.is_function else self.names)


def changes(tree: ast.Module) -> Iterator[Change]:
    """Yield all changes of a module, in the order of its source."""
    scope = _Scope(reals=_reals(tree))
    for statement in tree.body:
        match statement:
            case ast.FunctionDef() | ast.ClassDef():
                yield from _of_definition(statement, scope)
            case ast.Assign(targets=[ast.Name(id=name)]) if not name.startswith("__"):
                yield from _of_value(statement, name)
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr()):
                yield from _of_value(statement, name)


def _reals(tree: ast.Module) -> dict[str, float]:
    found = {}
    for statement in tree.body:
        if isinstance(statement, ast.Assign | ast.AnnAssign) and _is_real(statement.value, ()):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            value = _value(statement.value, {})
            found.update({one.id: value for one in targets if isinstance(one, ast.Name)})
    return found


def _value(node: ast.AST | None, reals: Mapping[str, float]) -> float:
    """Return the value of a constant expression, or NaN."""
    match node:
        case ast.Constant(float(value)):
            return value
        case ast.Name(name):
            return reals.get(name, math.nan)
        case ast.BinOp(left, ast.Sub(), right):
            return _value(left, reals) - _value(right, reals)
    return math.nan


def _is_real(node: ast.AST | None, reals: Collection[str]) -> bool:
    """Return whether a number is not whole, is the name of such a number, or computed from one."""
    return node is not None and any(
        (isinstance(one, ast.Constant) and isinstance(one.value, float) and one.value % 1.0 != 0.0)
        or (isinstance(one, ast.Name) and one.id in reals)
        for one in ast.walk(node)
    )


def _of_value(statement: ast.Assign | ast.AnnAssign, name: str) -> Iterator[Change]:
    scope = _Scope((name,), span(statement), statement)
    assert statement.value is not None, "only those with a value come here"
    yield from _of_place(statement, "value", None, statement.value, scope)


def _of_definition(node: ast.FunctionDef | ast.ClassDef, scope: _Scope) -> Iterator[Change]:
    if isinstance(node, ast.ClassDef):
        inner = replace(scope, names=(*scope.names, node.name))
        for statement in node.body:
            if isinstance(statement, ast.FunctionDef | ast.ClassDef):
                yield from _of_definition(statement, inner)
        return
    if node.name in ("__repr__", "__str__"):
        return
    inner = replace(scope, names=(*scope.names, node.name, "<locals>"))
    yield from _of_parts(node, inner)


def _of_statement(
    parent: ast.AST, name: str, index: int, node: ast.stmt, scope: _Scope
) -> Iterator[Change]:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        yield from _of_definition(node, scope)
        return
    if isinstance(node, ast.Assert):
        return
    if isinstance(node, ast.If) and (
        "TYPE_CHECKING" in ast.unparse(node.test)
        or (not node.orelse and all(map(_is_own_mistake, node.body)))
    ):
        return
    inner = replace(scope, lines=span(node), assignment=None)
    if _is_droppable(node):
        yield _change("statement", parent, name, index, node, ast.Pass(), inner)
    yield from _of_parts(node, inner)


def _of_parts(node: ast.AST, scope: _Scope) -> Iterator[Change]:
    for name, value in ast.iter_fields(node):
        if name in _LEFT_OUT or isinstance(value, ast.arguments):
            continue
        if isinstance(value, ast.AST):
            yield from _of_place(node, name, None, value, scope)
        elif isinstance(value, list):
            for index, one in enumerate(value):
                if index and isinstance(value[index - 1], ast.Return | ast.Raise):
                    break  # what makes a generator of a function that raises
                if isinstance(one, ast.stmt):
                    yield from _of_statement(node, name, index, one, scope)
                elif isinstance(one, ast.AST):
                    yield from _of_place(node, name, index, one, scope)


def _of_place(
    parent: ast.AST, name: str, index: int | None, node: ast.AST, scope: _Scope
) -> Iterator[Change]:
    if isinstance(node, ast.JoinedStr) or _is_type_test(parent, name, index):
        return
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return
    for operator, new in _others(parent, name, node, scope.reals):
        yield _change(operator, parent, name, index, node, new, scope)
    if isinstance(node, ast.Lambda):  # a function, of which the code can be exchanged
        lines = -(node.end_lineno or node.lineno), -node.lineno
        scope = replace(scope, assignment=None, lines=lines)
    yield from _of_parts(node, scope)


def _others(
    parent: ast.AST, name: str, node: ast.AST, reals: Mapping[str, float]
) -> Iterator[tuple[Operator, ast.expr]]:
    """Yield the replacements of an expression."""
    if _is_condition(parent, name) and isinstance(node, ast.expr) and not _has_opposite(node):
        yield "condition", ast.UnaryOp(ast.Not(), node)
    match node:
        case ast.Compare(left, operators, comparators):
            by_chance = any(_is_real(side, reals) for side in (left, *comparators))
            for place, one in enumerate(operators):
                for table in (_OPPOSITE,) if by_chance else (_BOUNDARY, _OPPOSITE):
                    if type(one) in table:
                        new = [*operators]
                        new[place] = table[type(one)]()
                        yield "comparison", ast.Compare(left, new, comparators)
        case ast.BinOp(left, one, right) if type(one) in _ARITHMETIC and not (
            _is_no_number(left, right) or abs(_value(right, reals) - 1.0) < _ROUNDING
        ):
            yield "arithmetic", ast.BinOp(left, _ARITHMETIC[type(one)](), right)
        case ast.UnaryOp(ast.USub(), operand):
            yield "arithmetic", operand
        case ast.UnaryOp(ast.Not(), operand):
            yield "connective", operand
        case ast.BoolOp(one, values):
            yield (
                "connective",
                ast.BoolOp(ast.And() if isinstance(one, ast.Or) else ast.Or(), values),
            )
        case ast.Constant(value):
            for other in _other_constants(value):
                yield "constant", ast.Constant(other)


def _other_constants(value: object) -> tuple[bool | int | float, ...]:
    if isinstance(value, bool):
        return (not value,)
    if isinstance(value, int | float):
        return (value * 2,) if abs(value) >= _LARGE else (value + 1, value - 1)
    return ()


def _is_condition(parent: ast.AST, name: str) -> bool:
    if name == "ifs":
        return isinstance(parent, ast.comprehension)
    if name == "guard":
        return isinstance(parent, ast.match_case)
    return name == "test" and isinstance(parent, ast.If | ast.While | ast.IfExp)


def _has_opposite(node: ast.expr) -> bool:
    """Return whether another operator negates the whole expression."""
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.Not)
    return isinstance(node, ast.Compare) and len(node.ops) == 1


def _is_no_number(*operands: ast.expr) -> bool:
    """Return whether ``+`` joins texts or lists, or ``|`` a type and None, if that is visible."""
    kinds = (ast.JoinedStr, ast.List, ast.Tuple)
    return any(
        isinstance(one, kinds)
        or (isinstance(one, ast.Constant) and isinstance(one.value, str | None))
        for one in operands
    )


def _is_type_test(parent: ast.AST, name: str, index: int | None) -> bool:
    """Return whether an argument is a type: the second of ``isinstance``, the first of ``cast``."""
    if not isinstance(parent, ast.Call) or name != "args" or not isinstance(parent.func, ast.Name):
        return False
    return (parent.func.id, index) in (("isinstance", 1), ("cast", 0))


def _is_droppable(node: ast.stmt) -> bool:
    match node:
        case ast.Expr(value):
            return isinstance(value, ast.Call | ast.Yield | ast.YieldFrom)
        case ast.AugAssign() | ast.Break() | ast.Continue() | ast.Delete():
            return True
        case ast.Raise():
            return not _is_own_mistake(node)
        case ast.Assign(targets):
            parts = [part for one in targets for part in _parts(one)]
            return all(isinstance(part, ast.Attribute | ast.Subscript) for part in parts)
    return False


def _is_own_mistake(node: ast.stmt) -> bool:
    """Return whether a statement reports a mistake that no program of KRL can make."""
    if not isinstance(node, ast.Raise) or node.exc is None:
        return False
    return _OWN_MISTAKE.match(ast.unparse(node.exc)) is not None


def _parts(target: ast.expr) -> list[ast.expr]:
    return [*target.elts] if isinstance(target, ast.Tuple) else [target]


def span(node: ast.stmt) -> tuple[int, int]:
    """First and last line of a statement, without the statements within it."""
    if isinstance(node, _COMPOUND):
        first = min(
            (one.lineno for one in ast.walk(node) if isinstance(one, ast.stmt) and one is not node),
            default=node.lineno + 1,
        )
        return node.lineno, max(node.lineno, first - 1)
    return node.lineno, node.end_lineno or node.lineno


def _change(
    operator: Operator,
    parent: ast.AST,
    name: str,
    index: int | None,
    node: ast.AST,
    new: ast.AST,
    scope: _Scope,
) -> Change:
    placed = ast.fix_missing_locations(ast.copy_location(new, node))
    return Change(
        operator,
        scope.function,
        getattr(node, "lineno", scope.lines[0]),
        scope.lines,
        parent,
        name,
        index,
        node,
        placed,
        scope.assignment,
    )
