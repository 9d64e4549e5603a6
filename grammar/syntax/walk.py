"""Walks over the syntax tree: what lies below a node, what an expression is made of, equality."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields

from grammar.syntax import ast
from grammar.syntax.ast import Node

_NAMES: dict[type, tuple[str, ...]] = {}


def _names(node: Node) -> tuple[str, ...]:
    """What a node holds besides its span."""
    kind = type(node)
    if kind not in _NAMES:
        _NAMES[kind] = tuple(field.name for field in fields(node) if field.name != "span")
    return _NAMES[kind]


def children(node: Node) -> Sequence[Node]:
    """The nodes directly below a node, in the order of the text where that has a meaning."""
    names = _INNER[type(node)]
    if not names:
        return ()
    found: list[Node] = []
    for name in names:
        value = getattr(node, name)
        if type(value) is tuple:
            found += [item for item in value if isinstance(item, Node)]
        elif isinstance(value, Node):
            found.append(value)
    return found


_PLAIN = frozenset({"Span", "str", "int", "bool", "str | None", "int | None", "bool | None"})
#: The fields of each kind of node that may hold nodes.
_INNER: Mapping[type[Node], tuple[str, ...]] = {
    kind: tuple(field.name for field in fields(kind) if field.type not in _PLAIN)
    for kind in Node.__subclasses__()
}
#: The kinds of node that nothing can lie below.
LEAVES = frozenset(kind for kind, names in _INNER.items() if not names)


#: The fields of each kind of block that hold nodes on lines of their own, in the order of the text.
BODIES: Mapping[type[Node], tuple[str, ...]] = {
    kind: names
    for kind, lines in ast.TEMPLATES.items()
    if (names := tuple(line.strip(" <>") for line in lines if line.lstrip().startswith("<<")))
}


def bodies(node: Node) -> Iterator[tuple[ast.Statement, ...]]:
    """The lists of statements directly in a block, in the order of the text; none of others."""
    for name in BODIES.get(type(node), ()):
        body = getattr(node, name)
        if body and type(body[0]) is ast.CaseBranch:
            for branch in body:
                yield branch.body
        elif body is not None:
            yield body


def walk(node: Node) -> Iterator[Node]:
    """A node and all below it, each before what is below it; does not recurse."""
    todo = [node]
    while todo:
        here = todo.pop()
        yield here
        todo += children(here)[::-1]


def same(left: Node, right: Node) -> bool:
    """Whether two trees say the same, letter case of names included, spans left aside."""
    todo: list[tuple[object, object]] = [(left, right)]
    while todo:
        one, other = todo.pop()
        if isinstance(one, Node) and type(one) is type(other):
            names = _names(one)
            todo += [(getattr(one, name), getattr(other, name)) for name in names]
        elif isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
            todo += zip(one, other, strict=True)
        elif isinstance(one, Node | tuple) or one != other:
            return False
    return True


def left_chain(node: ast.Binary) -> list[ast.Binary]:
    """An operation and those that its left operands are, the innermost first; sums of any length.

    Whoever recurses into right operands and into the left one of the first goes no deeper than
    `grammar.syntax.node_plans.MAX_DEPTH`.
    """
    chain = [node]
    while type(left := chain[-1].left) is ast.Binary:
        chain.append(left)
    return chain[::-1]


def without_parentheses(node: ast.Expression) -> ast.Expression:
    """What stands in the parentheses."""
    while type(node) is ast.Parenthesised:
        node = node.inner
    return node


#: The kinds of node that say a place in memory.
PLACES = frozenset({ast.Variable, ast.Subscript, ast.Member})


def root_variable(node: ast.Expression) -> ast.Variable | None:
    """What indices and components are taken of: the variable ``a`` of ``a.b[1].c``."""
    while type(node) is ast.Subscript or type(node) is ast.Member:
        node = node.base
    return node if type(node) is ast.Variable else None
