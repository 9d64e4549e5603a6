"""Expressions in a debugger: conditions of breakpoints, watches and evaluated input.

They are parsed as KRL and evaluated with its operators, over the variables that are visible where a
program has stopped. Calls are rejected, so that an evaluation has no side effects.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NoReturn

from grammar.semantics.types import Structure
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.walk import left_chain
from interp.port.executor import Reader
from interp.port.inspection import RELATIONS, Guard, InspectedValue
from interp.port.requests import Path, path_text
from interp.program.literals import LITERALS, known_enumeration
from interp.values.faults import LinkError, RuntimeFailure
from interp.values.operators import apply, apply_unary
from interp.values.values import (
    EnumValue,
    StructureValue,
    Value,
    constant,
    converted,
    empty,
    index,
    known,
    position_type,
)


@cache
def parsed(text: str) -> ast.Expression:
    """Return the syntax tree of an expression; raise `LinkError` if the text is not one."""
    module = read_module(f"DEF A()\nA={text}\nEND\n")
    if isinstance(module, ast.Module) and isinstance(module.content, ast.Program):
        match module.content.routines[0].body:
            case (ast.Assignment(value=value),) if len(module.content.routines) == 1:
                return value
    raise LinkError(f"{text}: this is no expression")


def guard_of(text: str) -> Guard | None:
    """Return a condition in the simple form that an executor can evaluate itself, else ``None``."""
    try:
        match parsed(text):
            case ast.Binary(operator=relation, left=left, right=right) if relation in RELATIONS:
                name = path_text(Evaluation(_refused, _refused, _refused).steps(left))
                match right:
                    case ast.IntegerLiteral(value=number) if number < 2**31:
                        return Guard(name, relation, number)
                    case ast.BoolLiteral(value=truth):
                        return Guard(name, relation, truth)
                    case ast.EnumConstant():
                        return Guard(name, relation, right.name.key)
    except RuntimeFailure:
        pass
    return None


def _refused(_name: object) -> NoReturn:
    raise LinkError("no constant")


def root_of(node: ast.Expression) -> str | None:
    """Return the variable with which a designator begins, in upper case; else ``None``."""
    while isinstance(node, ast.Subscript | ast.Member | ast.Parenthesised):
        node = node.inner if isinstance(node, ast.Parenthesised) else node.base
    return node.name.key if isinstance(node, ast.Variable) else None


@dataclass(frozen=True, slots=True)
class Evaluation:
    """Evaluates expressions.

    ``look`` finds variables of the program, ``read`` those of the controller, ``signal`` the first
    and the last variable that a signal denotes, by its name.
    """

    look: Callable[[str], InspectedValue | None]
    read: Reader
    signal: Callable[[str], tuple[ast.Expression, ast.Expression | None] | None]

    def place(self, node: ast.Expression) -> str | Path:
        """Return the target of an assignment: a variable as text, or a path for the controller."""
        steps = self.steps(node)
        path = self.system_path(steps)
        return path_text(steps) if path is None else path

    def value(self, node: ast.Expression, wanted: object = None) -> Value:
        """Return the value of an expression.

        ``wanted`` is the type of the context, which an enumeration constant needs. Raises
        `interp.values.faults.Fault` as the program would, and `LinkError` for unknown names.
        """
        match node:
            case ast.Parenthesised():
                return self.value(node.inner, wanted)
            case ast.Aggregate():
                return self._aggregate(node, wanted)
            case ast.Unary():
                return apply_unary(node.operator, self.value(node.operand))
            case ast.Binary():
                return self._binary(node)
            case ast.Variable() | ast.Subscript() | ast.Member():
                return self._variable(node)
            case ast.EnumConstant():
                return constant(known_enumeration(node, wanted), node.name.key)
        if (rule := LITERALS.get(type(node))) is not None:
            return rule(node)
        raise LinkError("only variables, constants and operators can be looked at")

    def _aggregate(self, node: ast.Aggregate, wanted: object) -> Value:
        names = frozenset(one.name.key for one in node.components)
        type_ = wanted if isinstance(wanted, Structure) else position_type(names)
        if type_ is None:
            raise LinkError("the structure is unknown")
        made = empty(type_)
        assert isinstance(made, StructureValue), "of a structure"
        for one in node.components:
            member = type_.member(one.name.key)
            if member is None or one.indices:
                raise LinkError(f"{one.name.text} is no member that can be given here")
            made.set(one.name.key, converted(self.value(one.value, member), member))
        return made

    def _binary(self, node: ast.Binary) -> Value:
        chain = left_chain(node)
        first = chain[0].left
        wanted = None
        if isinstance(first, ast.EnumConstant):
            wanted = getattr(self.value(chain[0].right), "type", None)
        left = self.value(first, wanted)
        for each in chain:
            wanted = left.type if isinstance(left, EnumValue) else None
            left = apply(each.operator, left, self.value(each.right, wanted))
        return left

    def _variable(self, node: ast.Expression) -> Value:
        steps = self.steps(node)
        path = self.system_path(steps)
        if path is not None:
            asked: Value = self.read(path)
            return asked
        text = path_text(steps)
        seen = self.look(text)
        if seen is None:
            raise LinkError(f"{text} is not known here")
        return known(seen.value)

    def system_path(self, steps: Path) -> Path | None:
        """Return the path of a system variable or of a signal; ``None`` for other variables."""
        if str(steps[0]).startswith("$"):
            return steps
        stands_for = self.signal(str(steps[0])) if len(steps) == 1 else None
        if stands_for is None:
            return None
        first, last = stands_for
        path = self.steps(first)
        return path if last is None else (*path, "TO", *self.steps(last)[1:])

    def steps(self, node: ast.Expression) -> Path:
        """Return a designator as a path with evaluated indices; omitted indices are left out."""
        match node:
            case ast.Variable():
                return (node.name.key,)
            case ast.Parenthesised():
                return self.steps(node.inner)
            case ast.Member():
                return (*self.steps(node.base), node.name.key)
            case ast.Subscript():
                given = [index(self.value(one)) for one in node.indices if one is not None]
                return (*self.steps(node.base), *given)
        raise LinkError("only a variable has parts")
