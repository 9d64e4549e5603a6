"""The accesses of statements to variables: reads, assignments, arguments.

For a block only its head counts: its condition, its bounds. The later actions of interrupts and
triggers count as arguments, since the time at which they run is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Enum
from typing import Any

from grammar.check.analysis.context import Context
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind, RoutineSymbol
from grammar.syntax import ast
from grammar.syntax.walk import BODIES, LEAVES, PLACES, children, left_chain
from support.lazy_dataclass import node

#: A parameter of a routine: the path of its file, its name in upper case, an index from 0.
Parameter = tuple[str, str, int]


class Use(Enum):
    """What a statement does to a variable."""

    READ = "read"
    WRITTEN = "written"
    #: To a routine that may read it, assign to it, or both.
    PASSED = "passed"


@node
class Access:
    """An access to a variable in a statement, with the node of its name.

    ``key`` is the name in upper case, ``place`` the accessed expression with indices and
    components. ``to`` is the parameter that receives it, if it is an argument of a routine of the
    project.
    """

    name: ast.Name
    key: str
    use: Use
    place: ast.Expression | None = None
    to: Parameter | None = None


def accesses(context: Context, node: ast.Node) -> Sequence[Access]:
    """Return the accesses of a statement, in order of execution where that matters."""
    known: Sequence[Access] | None = context.accesses.get(node)
    if known is None:
        found: list[Access] = []
        _add(context, node, found)
        known = context.accesses[node] = found
    return known


def _add(context: Context, node: ast.Node, found: list[Access]) -> None:
    rule = _RULES.get(type(node))
    if rule is not None:
        rule(context, node, found)
        return
    for part in own_parts(node):
        if type(part) not in LEAVES:
            _add(context, part, found)


def _assignment(context: Context, node: ast.Assignment, found: list[Access]) -> None:
    _add(context, node.value, found)
    _add_place(context, node.target, Use.WRITTEN, found)


def _binary(context: Context, node: ast.Binary, found: list[Access]) -> None:
    chain = left_chain(node)
    for operand in (chain[0].left, *(each.right for each in chain)):
        _add(context, operand, found)


def _loop(context: Context, node: ast.For, found: list[Access]) -> None:
    for bound in (node.first, node.last, node.step):
        if bound is not None:
            _add(context, bound, found)
    found.append(Access(node.counter, node.counter.key, Use.WRITTEN))


def _later(
    context: Context, node: ast.InterruptDeclaration | ast.Trigger, found: list[Access]
) -> None:
    inner: list[Access] = []
    for part in children(node):
        _add(context, part, inner)
    found += [Access(one.name, one.key, Use.PASSED, one.place) for one in inner]


def own_parts(node: ast.Node) -> Sequence[ast.Node]:
    """Return the children of a node without nested statements, but with the values of CASE."""
    below = children(node)
    inner = BODIES.get(type(node))
    if inner is None:
        return below
    held = {id(one) for name in inner for one in getattr(node, name) or ()}
    found: list[ast.Node] = []
    for child in below:
        if id(child) not in held:
            found.append(child)
        elif isinstance(child, ast.CaseBranch):
            found += child.values
    return found


def parts_of(node: ast.Node) -> Sequence[ast.Node]:
    """Return a statement and its descendants, without the statements of a block."""
    found: list[ast.Node] = [node]
    for here in found:  # grows while it is walked
        if type(here) not in LEAVES:
            found += own_parts(here)
    return found


def calls_of(node: ast.Node) -> Iterator[ast.Call]:
    """Yield the calls in a statement, without those in nested statements."""
    return (part for part in parts_of(node) if isinstance(part, ast.Call))


def _add_place(context: Context, node: ast.Expression, use: Use, found: list[Access]) -> None:
    """Add the variable of which an expression is a part, after the reads of its indices."""
    whole = node
    while type(node) is ast.Subscript or type(node) is ast.Member:
        if type(node) is ast.Subscript:
            for index in node.indices:
                if index is not None:
                    _add(context, index, found)
        node = node.base
    if type(node) is ast.Variable:
        found.append(Access(node.name, node.name.key, use, whole))
    else:
        _add(context, node, found)


def _call(context: Context, node: ast.Call, found: list[Access]) -> None:
    """Add the arguments of a call: those passed :IN are read, the use of others is unknown."""
    called = context.found(node.name)
    symbol = called.symbol if called else None
    for index, argument in enumerate(node.arguments):
        if argument is None:
            continue
        _add(context, argument, found)
        if type(argument) in PLACES and found[-1].place is argument:
            known = symbol.parameter(index) if isinstance(symbol, RoutineSymbol) else None
            is_read = known is not None and known.mode == "IN"
            use = Use.READ if is_read else Use.PASSED
            routine = address_of(called) if known is not None else None
            to = (*routine, index) if routine else None
            found[-1] = Access(found[-1].name, found[-1].key, use, argument, to)


def address_of(called: Found | None) -> tuple[str, str] | None:
    """Return the file and the upper-case name of a routine; ``None`` if its body is missing."""
    if called is None or called.module is None or called.symbol.kind is not Kind.ROUTINE:
        return None
    if called.module.is_head_unread(called.symbol.key):
        return None
    return called.module.path, called.symbol.key


_RULES: Mapping[type[Any], Callable[[Context, Any, list[Access]], object]] = {
    ast.Assignment: _assignment,
    ast.Binary: _binary,
    ast.Call: _call,
    ast.For: _loop,
    ast.InterruptDeclaration: _later,
    ast.Trigger: _later,
    **dict.fromkeys(
        (ast.Variable, ast.Subscript, ast.Member),
        lambda context, node, found: _add_place(context, node, Use.READ, found),
    ),
    **dict.fromkeys(
        (ast.VariableDeclaration, ast.Signal, ast.Structure, ast.Enumeration),
        lambda *_: None,
    ),
}
