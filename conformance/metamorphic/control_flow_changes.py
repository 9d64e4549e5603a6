"""Laws about control flow and expressions: equivalent statements."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import count
from random import Random
from typing import Final

from conformance.metamorphic.comparison import same_effects, same_trace
from conformance.metamorphic.law import Law
from conformance.metamorphic.subject import Program
from conformance.metamorphic.tree_rewriting import (
    MADE,
    Change,
    calls_of,
    integer,
    name,
    names_of,
    negated,
    parenthesised,
    rewritten,
    routines,
    with_routines,
)
from grammar.syntax import ast
from grammar.syntax.walk import children, walk

Statements = tuple[ast.Statement, ...]
_MOST_FOLDED: Final = 1_000


def _in_all_routines(change: Change) -> Callable[[Program, Random], Program | None]:
    return lambda program, _random: program.rewritten(lambda _routine: change)


def _if(condition: ast.Expression, *body: ast.Statement) -> ast.If:
    return ast.If(MADE, condition, body, None)


# ------------------------------------------------------------------------------------ loops


def _for_to_while(node: ast.Node) -> ast.Node | tuple[ast.Node, ...]:
    """Replace a FOR whose last value and step are literals, so that no pass can change them."""
    if not isinstance(node, ast.For) or _is_negative(node.last) is None:
        return node
    step = node.step or integer(1)
    is_down, counter = _is_negative(step), ast.Variable(MADE, node.counter)
    if is_down is None:
        return node
    test = ast.Binary(MADE, ">=" if is_down else "<=", counter, node.last)
    following = ast.Binary(MADE, "+", counter, parenthesised(step))
    body = (*node.body, ast.Assignment(MADE, counter, following))
    return ast.Assignment(MADE, counter, node.first), ast.While(MADE, test, body)


def _is_negative(number: ast.Expression) -> bool | None:
    """Return whether a number is negative; ``None`` if the expression is no literal."""
    is_down = isinstance(number, ast.Unary) and number.operator == "-"
    digits = number.operand if isinstance(number, ast.Unary) else number
    return is_down if isinstance(digits, ast.IntegerLiteral) else None


def _has_labels(body: Statements) -> bool:
    return any(isinstance(one, ast.Label) for each in body for one in walk(each))


def _with_goto(program: Program, _random: Random) -> Program | None:
    """Replace WHILE, REPEAT and LOOP by labels and GOTO; EXIT becomes a GOTO to after the loop."""
    numbers = count(1)

    def change(node: ast.Node) -> ast.Node | tuple[ast.Node, ...]:
        if not isinstance(node, ast.While | ast.Repeat | ast.Loop) or _has_labels(node.body):
            return node
        number = next(numbers)
        start_label, end_label = name(f"AGAIN{number}_"), name(f"BEHIND{number}_")
        body = tuple(_without_exit(one, end_label) for one in node.body)
        back = ast.Goto(MADE, start_label)
        top, bottom = ast.Label(MADE, start_label), ast.Label(MADE, end_label)
        match node:
            case ast.While():
                leave = _if(negated(node.condition), ast.Goto(MADE, end_label))
                return (top, leave, *body, back, bottom)
            case ast.Repeat():
                return (top, *body, _if(negated(node.condition), back), bottom)
        return (top, *body, back, bottom)

    def make(routine: ast.Routine) -> Change:
        # inner loops stay: no GOTO from outside may enter the labels that they would become
        inner = {id(one) for loop in walk(routine) if _is_loop(loop) for one in _below(loop)}
        return lambda node: node if id(node) in inner else change(node)

    return program.rewritten(make)


def _is_loop(node: ast.Node) -> bool:
    return isinstance(node, ast.While | ast.Repeat | ast.Loop | ast.For)


def _below(node: ast.Node) -> Iterator[ast.Node]:
    for child in children(node):
        yield from walk(child)


def _without_exit(node: ast.Statement, label: ast.Name) -> ast.Statement:
    """Replace EXIT of this loop, but not of inner loops, by a GOTO."""
    if isinstance(node, ast.Exit):
        return ast.Goto(MADE, label)
    if isinstance(node, ast.If):
        otherwise = node.otherwise
        return replace(
            node,
            body=tuple(_without_exit(one, label) for one in node.body),
            otherwise=None
            if otherwise is None
            else tuple(_without_exit(one, label) for one in otherwise),
        )
    if isinstance(node, ast.Switch):
        default = node.default
        return replace(
            node,
            branches=tuple(
                replace(one, body=tuple(_without_exit(each, label) for each in one.body))
                for one in node.branches
            ),
            default=None
            if default is None
            else tuple(_without_exit(one, label) for one in default),
        )
    return node


# ------------------------------------------------------------------------------------ branches


def _switch_to_if(node: ast.Node) -> ast.Node:
    """Replace a SWITCH by a chain of IF, if its selector can be evaluated repeatedly."""
    if not isinstance(node, ast.Switch) or not isinstance(node.selector, ast.Variable):
        return node
    if node.selector.name.text.startswith("$"):
        return node
    chain: Statements | None = node.default
    for branch in reversed(node.branches):
        tests: list[ast.Expression] = [
            parenthesised(ast.Binary(MADE, "==", node.selector, value)) for value in branch.values
        ]
        condition = tests[0]
        for test in tests[1:]:
            condition = ast.Binary(MADE, "OR", condition, test)
        chain = (ast.If(MADE, condition, branch.body, chain),)
    return chain[0] if chain and isinstance(chain[0], ast.If) else node


# ------------------------------------------------------------------------------------ routines


_BOUND: Final = (
    ast.Definition,
    ast.Return,
    ast.Goto,
    ast.Label,
    ast.InterruptDeclaration,
    ast.Resume,
    ast.Trigger,
    ast.Continue,
    ast.OnErrorProceed,
)


def _inlined(program: Program, _random: Random) -> Program | None:
    """Replace calls by the body of the routine, if it has no parameters and no data of its own."""
    modules = program.modules or {}
    every = [one for module in modules.values() for one in walk(module)]
    if any(isinstance(one, ast.Resume | ast.InterruptDeclaration) for one in every):
        return None  # the depth of the routine that declares an interrupt matters
    changed, is_other = {}, False
    for path, module in modules.items():
        bodies = {one.name.key: one.body for one in routines(module)[1:] if _may_be_inlined(one)}
        hidden = {key for one in routines(module) for key in _own_names(one)}
        bodies = {
            key: body
            for key, body in bodies.items()
            if not hidden & {each for one in body for each in names_of(one)}
        }
        found = []
        for routine in routines(module):
            new = rewritten(routine, _inlining(bodies))
            is_other = is_other or new is not routine
            found.append(new)
        changed[path] = with_routines(module, found) if found else module
    return program.written(changed) if is_other else None


def _may_be_inlined(routine: ast.Routine) -> bool:
    if routine.parameters or routine.result is not None or not routine.body:
        return False
    below = [one for each in routine.body for one in walk(each)]
    return not any(isinstance(one, _BOUND) for one in below) and not any(
        calls_of(each) for each in routine.body
    )


def _own_names(routine: ast.Routine) -> set[str]:
    """Return the names that a routine declares, which could hide names in an inlined body."""
    declared = {
        declarator.name.key
        for one in routine.body
        if isinstance(one, ast.VariableDeclaration)
        for declarator in one.declarators
    }
    return declared | {one.name.key for one in routine.parameters}


def _inlining(bodies: dict[str, Statements]) -> Change:
    def change(node: ast.Node) -> ast.Node | tuple[ast.Node, ...]:
        for field in ("body", "otherwise", "default"):
            block = getattr(node, field, None)
            if not isinstance(block, tuple):
                continue
            new: list[ast.Statement] = []
            for place, one in enumerate(block):
                key = one.call.name.key if isinstance(one, ast.CallStatement) else ""
                before = block[place - 1] if place else None
                is_bound = isinstance(before, ast.OnErrorProceed | ast.Continue | ast.Trigger)
                new += bodies[key] if key in bodies and not is_bound else (one,)
            if len(new) != len(block) or any(a is not b for a, b in zip(new, block, strict=True)):
                node = replace(node, **{field: tuple(new)})  # type: ignore[arg-type]
        return node

    return change


# ------------------------------------------------------------------------------------ constants


def _unfolded(program: Program, random: Random) -> Program | None:
    """Replace numbers that are assigned or compared by computations with the same result."""

    def operand(node: ast.Expression) -> ast.Expression:
        if isinstance(node, ast.IntegerLiteral) and 0 < node.value < _MOST_FOLDED:
            less = random.randint(0, node.value)
            return parenthesised(ast.Binary(MADE, "+", integer(node.value - less), integer(less)))
        if isinstance(node, ast.RealLiteral) and math.isfinite(node.value):
            return parenthesised(ast.Binary(MADE, "*", node, ast.RealLiteral(MADE, "1.0")))
        return node

    def change(node: ast.Node) -> ast.Node:
        match node:
            case ast.Assignment(value=value) if (found := operand(value)) is not value:
                return replace(node, value=found)
            case ast.Binary(left=left, right=right):
                new = operand(left), operand(right)
                if new != (left, right):
                    return replace(node, left=new[0], right=new[1])
        return node

    def make(routine: ast.Routine) -> Change:
        fixed = {
            id(each)
            for one in walk(routine)
            if isinstance(one, ast.Definition | ast.CaseBranch | ast.Trigger | ast.Motion)
            for each in _below(one)
        }
        return lambda node: node if id(node) in fixed else change(node)

    return program.rewritten(make)


LAWS: Final[Sequence[Law]] = (
    Law(
        "FOR as WHILE",
        "FOR counts by its step, with a test before each pass",
        ("CTL-01", "CTL-05"),
        same_effects,
        _in_all_routines(_for_to_while),
    ),
    Law(
        "GOTO in place of a loop",
        "a loop is a label, a test, and a GOTO back",
        ("CTL-01", "CTL-07"),
        same_effects,
        _with_goto,
    ),
    Law(
        "SWITCH as IF",
        "SWITCH is a chain of IF in the order of its cases",
        ("CTL-03", "CTL-04"),
        same_effects,
        _in_all_routines(_switch_to_if),
    ),
    Law(
        "inlining",
        "a routine without parameters and data may stand where it is called",
        ("SCO-01", "SCO-05"),
        same_effects,
        _inlined,
    ),
    Law(
        "constant folding",
        "a number is the same as the sum or product that gives it",
        ("ARI-01", "ARI-05"),
        same_trace,
        _unfolded,
    ),
)
