"""The direction of a signal: input, output, or neither."""

from __future__ import annotations

from typing import Literal

from grammar.check.analysis.context import Context
from grammar.semantics.symbols import SignalSymbol
from grammar.syntax import ast
from grammar.syntax.walk import root_variable

Side = Literal["inputs", "outputs"]

_SIDES: dict[str, Side] = {
    "$IN": "inputs",
    "$ANIN": "inputs",
    "$OUT": "outputs",
    "$OUT_C": "outputs",
    "$ANOUT": "outputs",
}


def written_side(node: ast.Expression) -> Side | None:
    """Return the direction of an expression such as ``$IN[5]``, from its name."""
    root = root_variable(node)
    return _SIDES.get(root.name.key) if root else None


def side_of(context: Context, node: ast.Expression) -> Side | None:
    """Return the direction of an input, an output, or a signal that denotes some."""
    side = written_side(node)
    if side is None and isinstance(node, ast.Variable):
        found = context.found(node.name)
        if found is not None and isinstance(found.symbol, SignalSymbol):
            return written_side(found.symbol.first)
    return side
