"""What a statement does to variables: reads them, assigns to them, or passes them on.

A block counts with its head alone: its condition, its bounds. What an interrupt or a trigger will
do later is passed on, as nobody knows when it happens.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from grammar.check.context import Context
from grammar.semantics.symbols import RoutineSymbol
from grammar.syntax import ast
from grammar.syntax.walk import BODIES, children

__all__ = ["Access", "Use", "accesses", "calls_of", "parts_of"]


class Use(Enum):
    """What is done to a variable."""

    READ = "read"
    WRITTEN = "written"
    #: To a routine that may read it, assign to it, or both.
    PASSED = "passed"


@dataclass(frozen=True, slots=True)
class Access:
    """A variable in a statement, by the node of its name.

    ``place`` is the whole of what is accessed, with indices and components.
    """

    name: ast.Name
    use: Use
    place: ast.Expression | None = None


def accesses(context: Context, node: ast.Node) -> Iterator[Access]:
    """The accesses of a statement, in the order in which they happen as far as that matters."""
    rule = _RULES.get(type(node))
    if rule is not None:
        yield from rule(context, node)
        return
    for part in own_parts(node):
        yield from accesses(context, part)


def _assignment(context: Context, node: ast.Assignment) -> Iterator[Access]:
    yield from accesses(context, node.value)
    yield from _place(context, node.target, Use.WRITTEN)


def _loop(context: Context, node: ast.For) -> Iterator[Access]:
    for bound in (node.first, node.last, node.step):
        if bound is not None:
            yield from accesses(context, bound)
    yield Access(node.counter, Use.WRITTEN)


def _later(context: Context, node: ast.InterruptDeclaration | ast.Trigger) -> Iterator[Access]:
    for part in children(node):
        for access in accesses(context, part):
            yield Access(access.name, Use.PASSED, access.place)


def own_parts(node: ast.Node) -> Iterator[ast.Node]:
    """The nodes directly below one, without the statements of a block; the values of each CASE."""
    inner = BODIES.get(type(node))
    if inner is None:
        yield from children(node)
        return
    held = {id(one) for name in inner for one in getattr(node, name) or ()}
    for child in children(node):
        if id(child) not in held:
            yield child
        elif isinstance(child, ast.CaseBranch):
            yield from child.values


def parts_of(node: ast.Node) -> Iterator[ast.Node]:
    """A statement and all below it, without the statements in a block."""
    todo = [node]
    while todo:
        here = todo.pop()
        yield here
        todo.extend(own_parts(here))


def calls_of(node: ast.Node) -> Iterator[ast.Call]:
    """The calls in a statement, not those of the statements in a block."""
    return (part for part in parts_of(node) if isinstance(part, ast.Call))


def _place(context: Context, node: ast.Expression, use: Use) -> Iterator[Access]:
    """The variable that something is part of, behind what its indices read."""
    whole = node
    while isinstance(node, ast.Subscript | ast.Member):
        if isinstance(node, ast.Subscript):
            for index in node.indices:
                if index is not None:
                    yield from accesses(context, index)
        node = node.base
    if isinstance(node, ast.Variable):
        yield Access(node.name, use, whole)
    else:
        yield from accesses(context, node)


def _call(context: Context, node: ast.Call) -> Iterator[Access]:
    """The arguments: those passed :IN are read, of all others nobody knows."""
    found = context.found(node.name)
    symbol = found.symbol if found else None
    known = symbol.parameters if isinstance(symbol, RoutineSymbol) else ()
    for index, argument in enumerate(node.arguments):
        if argument is None:
            continue
        is_read = index < len(known) and known[index].mode == "IN"
        if is_read or not isinstance(argument, ast.Variable | ast.Subscript | ast.Member):
            yield from accesses(context, argument)
        else:
            for access in accesses(context, argument):
                is_it = access.place is argument
                yield Access(access.name, Use.PASSED, argument) if is_it else access


_RULES: Mapping[type[Any], Callable[[Context, Any], Iterable[Access]]] = {
    ast.Assignment: _assignment,
    ast.Call: _call,
    ast.For: _loop,
    ast.InterruptDeclaration: _later,
    ast.Trigger: _later,
    **dict.fromkeys(
        (ast.Variable, ast.Subscript, ast.Member),
        lambda context, node: _place(context, node, Use.READ),
    ),
    **dict.fromkeys(
        (ast.VariableDeclaration, ast.Signal, ast.Structure, ast.Enumeration),
        lambda *_: (),
    ),
}
