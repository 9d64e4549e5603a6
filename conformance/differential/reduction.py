"""Test case reduction: programs are made as small as possible while a property holds.

First, lines are blanked: routines, halves of blocks, statements, the frames of blocks, branches,
declarations. Blank lines keep the numbers of all other lines, so that places remain valid during a
whole pass. When no line can be removed any more, expressions are replaced by their parts and by
constants. The idea is that of delta debugging (ddmin), guided by the syntax tree.
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

#: A set of lines, counted from 1, in the file with an index.
_Unit = tuple[int, frozenset[int]]


@dataclass(frozen=True, slots=True)
class Reduced:
    """A reduced program, with its number of statements."""

    files: Files
    statements: int


def reduce_program(files: Files, holds: Callable[[Files], bool], most: int = 1_500) -> Reduced:
    """Return the smallest program found for which ``holds`` is true, as it is for ``files``.

    ``holds`` is called at most ``most`` times, also with programs that do not parse.
    """
    search = _Search(files, holds, most)
    has_changed = True
    while has_changed:
        has_changed = False
        while search.blank_lines():
            has_changed = True
        while search.simplify():
            has_changed = True
    search.tidy()
    return Reduced(search.files, statement_count(search.files))


def statement_count(files: Files) -> int:
    """Return the number of statements, without declarations."""
    return sum(
        isinstance(node, ast.Statement) and not isinstance(node, ast.Definition)
        for path, text in files
        for module in [read_module(text, path)]
        if isinstance(module, ast.Module) and isinstance(module.content, ast.Program)
        for routine in module.content.routines
        for node in _statements(routine)
    )


def _statements(routine: ast.Routine) -> Iterator[ast.Node]:
    """Yield all statements, including those in blocks, but no assignments after WITH."""
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

    def _try(self, files: Files) -> bool:
        """Replace the files if the property holds for the new ones; return whether it does."""
        if self.tried >= self._most or files == self.files:
            return False
        self.tried += 1
        if not self._holds(files):
            return False
        self.files = files
        return True

    # ----------------------------------------------------------------------- lines

    def blank_lines(self) -> bool:
        """Try to blank everything removable, large units first; return whether anything was."""
        before = self.files
        for number in range(len(self.files) - 1, 0, -1):
            self._try(self.files[:number] + self.files[number + 1 :])
        for number, lines in _units(self.files):
            path, text = self.files[number]
            rows = text.split("\n")
            if any(rows[line - 1].strip() for line in lines):
                kept = ("" if n in lines else row for n, row in enumerate(rows, start=1))
                self._try(_with_text(self.files, number, path, "\n".join(kept)))
        return self.files != before

    def tidy(self) -> None:
        """Remove blank lines, if the property still holds without them."""
        self._most += 1
        files = tuple(
            (path, "\n".join(row for row in text.split("\n") if row.strip()) + "\n")
            for path, text in self.files
        )
        self._try(files)

    # ----------------------------------------------------------------------- expressions

    def simplify(self) -> bool:
        """Simplify one expression, large ones first; return whether there was one."""
        before = self.files
        for number, (path, text) in enumerate(before):
            for first, end, simpler in _replacements(text, path):
                # The spans are valid only for the text in which they were found.
                if self._try(_with_text(before, number, path, text[:first] + simpler + text[end:])):
                    return True
        return False


def _with_text(files: Files, number: int, path: str, text: str) -> Files:
    return (*files[:number], (path, text), *files[number + 1 :])


# --------------------------------------------------------------------------------- what can go


def _units(files: Files) -> list[_Unit]:
    """Return all sets of lines that may be removed together, the largest first."""
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
    """Yield the lines of all nodes, of halves, quarters and so on, down to single nodes."""
    lines = [_lines(source, node) for node in nodes]
    size = len(lines)
    while size:
        for first in range(0, len(lines), size):
            yield frozenset().union(*lines[first : first + size])
        size = size // 2 if size > 1 else 0


def _frames(source: Source, block: ast.Node, inner: Sequence[ast.Node]) -> Iterator[frozenset[int]]:
    """Yield the lines that frame a block, and each of its branches but the first."""
    whole = _lines(source, block)
    covered = frozenset().union(*(_lines(source, node) for node in inner))
    frame = sorted(whole - covered)
    yield frozenset(frame)
    for first, end in pairwise(frame[1:]):
        yield frozenset(range(first, end))


# --------------------------------------------------------------------------------- expressions

_CONSTANTS = ("0", "1", "TRUE", "FALSE", "1.0", '"A"')


def _replacements(text: str, path: str) -> Iterator[tuple[int, int, str]]:
    """Yield the spans of expressions, each with a shorter text to replace it."""
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
