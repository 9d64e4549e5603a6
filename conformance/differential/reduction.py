"""Reduction: programs made as small as possible while a property holds.

First lines are made blank: routines, halves of blocks, statements, the frames of blocks, branches,
declarations. Blank lines keep the numbers of all others, so that places found once hold for a whole
pass. When no line can go any more, expressions are replaced by their own parts and by constants.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

from conformance.differential.divergence import Files
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.walk import BODIES, bodies, children, walk

#: A set of lines, counted from 1, of a file by its place among the files.
_Unit = tuple[int, frozenset[int]]


@dataclass(frozen=True, slots=True)
class Reduced:
    """A program that was made small."""

    files: Files
    statements: int


def reduce_program(files: Files, holds: Callable[[Files], bool], most: int = 1_500) -> Reduced:
    """The smallest program found for which ``holds`` is true, as it is for ``files``.

    ``holds`` is asked ``most`` times at most, about programs that may not even parse.
    """
    search = _Search(files, holds, most)
    goes_on = True
    while goes_on:
        goes_on = False
        while search.blank_lines():
            goes_on = True
        while search.simplify():
            goes_on = True
    search.tidy()
    return Reduced(search.files, statements_of(search.files))


def statements_of(files: Files) -> int:
    """How many statements there are that do something."""
    return sum(
        isinstance(node, ast.Statement) and not isinstance(node, ast.Definition)
        for path, text in files
        for module in [read_module(text, path)]
        if isinstance(module, ast.Module) and isinstance(module.content, ast.Program)
        for routine in module.content.routines
        for node in _below(routine)
    )


def _below(routine: ast.Routine) -> Iterator[ast.Node]:
    """All statements, those within blocks too; not the assignments behind WITH and the like."""
    todo: list[ast.Node] = list(routine.body)
    while todo:
        node = todo.pop()
        yield node
        todo += chain.from_iterable(bodies(node))


class _Search:
    def __init__(self, files: Files, holds: Callable[[Files], bool], most: int) -> None:
        self.files = files
        self.tried = 0
        self._holds = holds
        self._most = most

    def _takes(self, files: Files) -> bool:
        """Whether to continue with these files instead."""
        if self.tried >= self._most or files == self.files:
            return False
        self.tried += 1
        if not self._holds(files):
            return False
        self.files = files
        return True

    # ----------------------------------------------------------------------- lines

    def blank_lines(self) -> bool:
        """One pass over all that can go, large things first; whether anything went."""
        before = self.files
        for number in range(len(self.files) - 1, 0, -1):
            self._takes(self.files[:number] + self.files[number + 1 :])
        for number, lines in _units(self.files):
            path, text = self.files[number]
            rows = text.split("\n")
            if any(rows[line - 1].strip() for line in lines):
                kept = ("" if n in lines else row for n, row in enumerate(rows, start=1))
                self._takes(_with(self.files, number, path, "\n".join(kept)))
        return self.files != before

    def tidy(self) -> None:
        """Take blank lines out, where what holds does not hang on them."""
        self._most += 1
        files = tuple(
            (path, "\n".join(row for row in text.split("\n") if row.strip()) + "\n")
            for path, text in self.files
        )
        self._takes(files)

    # ----------------------------------------------------------------------- expressions

    def simplify(self) -> bool:
        """One pass over expressions, large ones first; whether any became simpler."""
        before = self.files
        for number, (path, text) in enumerate(before):
            for first, end, simpler in _replacements(text, path):
                # Places in the text hold only as long as it is the one they were found in.
                if self._takes(_with(before, number, path, text[:first] + simpler + text[end:])):
                    return True
        return False


def _with(files: Files, number: int, path: str, text: str) -> Files:
    return (*files[:number], (path, text), *files[number + 1 :])


# --------------------------------------------------------------------------------- what can go


def _units(files: Files) -> list[_Unit]:
    """All sets of lines that may go together, the largest first."""
    found: list[_Unit] = []
    for number, (path, text) in enumerate(files):
        module = read_module(text, path)
        if not isinstance(module, ast.Module):
            continue
        source, content = Source(text, path), module.content
        if isinstance(content, ast.DataList):
            found += [(number, lines) for lines in _groups(source, content.items)]
            continue
        for place, routine in enumerate(content.routines):
            if place or number:
                found.append((number, _lines(source, routine)))
            found += [(number, lines) for lines in _in_body(source, routine.body)]
    return sorted(found, key=lambda one: -len(one[1]))


def _in_body(source: Source, body: Sequence[ast.Node]) -> Iterator[frozenset[int]]:
    todo = [body]
    while todo:
        block = todo.pop()
        yield from _groups(source, block)
        for node in block:
            inner = list(chain.from_iterable(bodies(node)))
            if type(node) in BODIES:
                yield from _frames(source, node, inner)
                todo.append(inner)


def _lines(source: Source, node: ast.Node) -> frozenset[int]:
    first, last = source.place(node.span[0])[0], source.place(max(node.span[1] - 1, 0))[0]
    return frozenset(range(first, last + 1))


def _groups(source: Source, nodes: Sequence[ast.Node]) -> Iterator[frozenset[int]]:
    """All of them, halves, quarters and so on, down to each alone."""
    lines = [_lines(source, node) for node in nodes]
    size = len(lines)
    while size:
        for first in range(0, len(lines), size):
            yield frozenset().union(*lines[first : first + size])
        size = size // 2 if size > 1 else 0


def _frames(source: Source, block: ast.Node, inner: Sequence[ast.Node]) -> Iterator[frozenset[int]]:
    """The lines of a block that hold it together, and each branch but the first."""
    whole = _lines(source, block)
    covered = frozenset().union(*(_lines(source, node) for node in inner))
    frame = sorted(whole - covered)
    yield frozenset(frame)
    for first, end in pairwise(frame[1:]):
        yield frozenset(range(first, end))


# --------------------------------------------------------------------------------- expressions

_CONSTANTS = ("0", "1", "TRUE", "FALSE", "1.0", '"A"')


def _replacements(text: str, path: str) -> Iterator[tuple[int, int, str]]:
    """Spans of expressions with shorter texts in their place."""
    module = read_module(text, path)
    if not isinstance(module, ast.Module):
        return
    nodes = [node for node in walk(module) if isinstance(node, ast.Expression)]
    for node in sorted(nodes, key=lambda one: one.span[0] - one.span[1]):
        first, end = node.span
        if isinstance(node, ast.ChannelName):
            continue
        simpler = [
            text[inner.span[0] : inner.span[1]]
            for inner in children(node)
            if isinstance(inner, ast.Expression)
        ]
        if isinstance(node, ast.Parenthesised | ast.Unary | ast.Binary | ast.Call | ast.Subscript):
            simpler += _CONSTANTS
        elif isinstance(node, ast.Variable | ast.Member):
            simpler += [one for one in _CONSTANTS if len(one) < end - first]
        elif isinstance(node, ast.IntegerLiteral):
            simpler += [one for one in ("0", "1", "2") if one != text[first:end] > one]
        for one in simpler:
            if len(one) < end - first or one in ("0", "1", "2"):
                yield first, end, one
