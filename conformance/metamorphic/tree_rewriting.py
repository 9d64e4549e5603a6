"""Rewriting of syntax trees, bottom-up; a statement can be replaced by several.

Not where ON_ERROR_PROCEED is about that statement.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from grammar.syntax import ast
from grammar.syntax.walk import left_chain, walk

#: The span of a generated node, which has no place in a source.
MADE = (0, 0)

#: Returns the same node or another one; or several nodes, if the node is in a sequence.
Change = Callable[[ast.Node], ast.Node | tuple[ast.Node, ...]]
_Any = TypeVar("_Any", bound=ast.Node)


def rewritten(node: _Any, change: Change) -> _Any:
    """Return a node after applying ``change`` to everything below it, then to itself."""
    found = _changed(node, change)
    if not isinstance(found, type(node)):
        raise TypeError(f"{type(node).__name__} became {type(found).__name__}")
    return found


def _changed(node: ast.Node, change: Change) -> ast.Node | tuple[ast.Node, ...]:
    if not isinstance(node, ast.Binary):
        return _with_changed(node, change)
    first, *others = left_chain(node)
    found = _with_changed(first, change)
    for each in others:
        found = _with_changed(each, change, left=found)
    return found


def _with_changed(
    node: ast.Node, change: Change, **changed: Any
) -> ast.Node | tuple[ast.Node, ...]:
    """Return ``change`` of a node with changed fields; those in ``changed`` are already given."""
    values: dict[str, Any] = {}
    for field in node.__dataclass_fields__:
        before = getattr(node, field)
        after = before
        if field in changed:
            after = changed[field]
        elif isinstance(before, ast.Node):
            after = _changed(before, change)
        elif field != "span" and isinstance(before, tuple):
            after = tuple(_sequence(before, change))
        if after is not before and after != before:
            values[field] = after
    return change(replace(node, **values) if values else node)


def _sequence(items: Sequence[Any], change: Change) -> Iterator[Any]:
    before = None
    for item in items:
        found = _changed(item, change) if isinstance(item, ast.Node) else item
        # of several statements only the first would be under an ON_ERROR_PROCEED
        if isinstance(found, tuple) and isinstance(before, ast.OnErrorProceed):
            yield item
        elif isinstance(found, tuple):
            yield from found
        else:
            yield found
        before = item


# ---------------------------------------------------------------------------------- generated nodes


def name(text: str) -> ast.Name:
    """Return a name for a changed program."""
    return ast.Name(MADE, text)


def variable(text: str) -> ast.Variable:
    """Return a variable for a changed program."""
    return ast.Variable(MADE, name(text))


def integer(value: int) -> ast.IntegerLiteral:
    """Return an INT literal for a changed program; the number is not negative."""
    return ast.IntegerLiteral(MADE, value)


def parenthesised(inner: ast.Expression) -> ast.Parenthesised:
    """Return an expression in parentheses."""
    return ast.Parenthesised(MADE, inner)


def negated(condition: ast.Expression) -> ast.Unary:
    """Return ``NOT (condition)``."""
    return ast.Unary(MADE, "NOT", parenthesised(condition))


# ------------------------------------------------------------------------------------ queries


def routines(module: ast.Module) -> tuple[ast.Routine, ...]:
    """Return the routines of a module; a data list has none."""
    return module.content.routines if isinstance(module.content, ast.Program) else ()


def with_routines(module: ast.Module, found: Sequence[ast.Routine]) -> ast.Module:
    """Return the module with other routines."""
    assert isinstance(module.content, ast.Program), "the caller looked"
    return replace(module, content=replace(module.content, routines=tuple(found)))


def names_of(node: ast.Node) -> frozenset[str]:
    """Return all names below a node, in upper case."""
    return frozenset(one.key for one in walk(node) if isinstance(one, ast.Name))


def calls_of(node: ast.Node) -> frozenset[str]:
    """Return the names of all calls below a node, in upper case."""
    return frozenset(one.name.key for one in walk(node) if isinstance(one, ast.Call))
