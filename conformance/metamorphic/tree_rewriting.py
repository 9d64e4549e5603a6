"""Rewriting of syntax trees: nodes replaced from the inside out, statements by several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from grammar.syntax import ast
from grammar.syntax.walk import left_chain, walk

#: The span of a node that was made and stands nowhere.
MADE = (0, 0)

#: A node, the same or another one; or several in its place, where it stands in a sequence.
Change = Callable[[ast.Node], ast.Node | tuple[ast.Node, ...]]
_Any = TypeVar("_Any", bound=ast.Node)


def rewritten(node: _Any, change: Change) -> _Any:
    """A node in which all below it, and then it itself, went through ``change``."""
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
    """A node whose fields are changed, but for those that are, and then itself."""
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
    for item in items:
        found = _changed(item, change) if isinstance(item, ast.Node) else item
        if isinstance(found, tuple):
            yield from found
        else:
            yield found


# ------------------------------------------------------------------------------------ made by hand


def name(text: str) -> ast.Name:
    """A name."""
    return ast.Name(MADE, text)


def variable(text: str) -> ast.Variable:
    """A variable."""
    return ast.Variable(MADE, name(text))


def integer(value: int) -> ast.IntegerLiteral:
    """A number that is not negative."""
    return ast.IntegerLiteral(MADE, value)


def parenthesised(inner: ast.Expression) -> ast.Parenthesised:
    """An expression in parentheses."""
    return ast.Parenthesised(MADE, inner)


def negated(condition: ast.Expression) -> ast.Unary:
    """``NOT (condition)``."""
    return ast.Unary(MADE, "NOT", parenthesised(condition))


# ------------------------------------------------------------------------------------ looked at


def routines(module: ast.Module) -> tuple[ast.Routine, ...]:
    """The routines of a module; none of a data list."""
    return module.content.routines if isinstance(module.content, ast.Program) else ()


def with_routines(module: ast.Module, found: Sequence[ast.Routine]) -> ast.Module:
    """The module with other routines."""
    assert isinstance(module.content, ast.Program), "the caller looked"
    return replace(module, content=replace(module.content, routines=tuple(found)))


def names_of(node: ast.Node) -> frozenset[str]:
    """All names below a node, in upper case."""
    return frozenset(one.key for one in walk(node) if isinstance(one, ast.Name))


def calls_of(node: ast.Node) -> frozenset[str]:
    """The names of what is called below a node, in upper case."""
    return frozenset(one.name.key for one in walk(node) if isinstance(one, ast.Call))
