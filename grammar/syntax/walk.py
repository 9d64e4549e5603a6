"""Walks over the syntax tree: children, statements of blocks, operands, structural equality."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields

from grammar.syntax import ast
from grammar.syntax.ast import Node

_NAMES: dict[type, tuple[str, ...]] = {}


def _names(node: Node) -> tuple[str, ...]:
    """Return the fields of a node except its span."""
    kind = type(node)
    if kind not in _NAMES:
        _NAMES[kind] = tuple(field.name for field in fields(node) if field.name != "span")
    return _NAMES[kind]


def children(node: Node) -> Sequence[Node]:
    """Return the direct children of a node, in the order of the text where that matters."""
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


_PLAIN = frozenset(
    {"Span", "str", "int", "bool", "str | None", "int | None", "bool | None", "frozenset[str]"}
)
#: The fields of each kind of node that may hold nodes.
_INNER: Mapping[type[Node], tuple[str, ...]] = {
    kind: tuple(field.name for field in fields(kind) if field.type not in _PLAIN)
    for kind in Node.__subclasses__()
}
#: The kinds of node that cannot have children.
LEAVES = frozenset(kind for kind, names in _INNER.items() if not names)


#: For each kind of block the fields whose nodes have lines of their own, in the order of the text.
BODIES: Mapping[type[Node], tuple[str, ...]] = {
    kind: names
    for kind, lines in ast.TEMPLATES.items()
    if (names := tuple(line.strip(" <>") for line in lines if line.lstrip().startswith("<<")))
}


def bodies(node: Node) -> Iterator[tuple[ast.Statement, ...]]:
    """Yield the statement lists directly in a block, in the order of the text.

    Yields nothing for a node that is no block.
    """
    for name in BODIES.get(type(node), ()):
        body = getattr(node, name)
        if body and type(body[0]) is ast.CaseBranch:
            for branch in body:
                yield branch.body
        elif body is not None:
            yield body


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all nodes below it, parents first; does not recurse."""
    todo = [node]
    while todo:
        here = todo.pop()
        yield here
        todo += children(here)[::-1]


def same(left: Node, right: Node) -> bool:
    """Return whether two trees are equal except for spans; letter case of names counts."""
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
    """Return an operation and the chain of its left operands, the innermost first.

    The chain of a long sum may have any length. Code that recurses into the right operands, and
    into the left operand of the first, goes no deeper than `grammar.syntax.node_plans.MAX_DEPTH`.
    """
    chain = [node]
    while type(left := chain[-1].left) is ast.Binary:
        chain.append(left)
    return chain[::-1]


def without_parentheses(node: ast.Expression) -> ast.Expression:
    """Return the expression inside parentheses."""
    while type(node) is ast.Parenthesised:
        node = node.inner
    return node


#: The kinds of node that denote a place in memory.
PLACES = frozenset({ast.Variable, ast.Subscript, ast.Member})


def root_variable(node: ast.Expression) -> ast.Variable | None:
    """Return the variable ``a`` of ``a.b[1].c``, or ``None`` if the base is no variable."""
    while type(node) is ast.Subscript or type(node) is ast.Member:
        node = node.base
    return node if type(node) is ast.Variable else None
