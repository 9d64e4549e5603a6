"""The first line of a statement that spans several: where a finding about it points."""

from __future__ import annotations

from grammar.syntax.ast import Node, Span
from grammar.syntax.source import Source


def head(source: Source, node: Node) -> Span:
    """The span of a node as far as it lies on its first line, its comment left out."""
    start, end = node.span
    line, column = source.place(start)
    shown = source.line(line)
    comment = source.comment(line)
    if comment is not None:
        shown = shown[: comment.column - 1]
    return start, max(start + 1, min(end, start - column + 1 + len(shown.rstrip())))


def line_of(source: Source, node: Node) -> int:
    """The line that a node begins on, from 1."""
    return source.place(node.span[0])[0]
