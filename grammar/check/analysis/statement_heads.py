"""The first line of a statement that spans several: the region of a finding about it."""

from __future__ import annotations

from grammar.syntax.ast import Node, Span
from grammar.syntax.source import Source


def head(source: Source, node: Node) -> Span:
    """Return the part of a node's span in its first line, without a comment."""
    start, end = node.span
    line, column = source.place(start)
    shown = source.line(line)
    comment = source.comment(line)
    if comment is not None:
        shown = shown[: comment.column - 1]
    return start, max(start + 1, min(end, start - column + 1 + len(shown.rstrip())))


def line_of(source: Source, node: Node) -> int:
    """Return the line on which a node begins, counted from 1."""
    return source.place(node.span[0])[0]
