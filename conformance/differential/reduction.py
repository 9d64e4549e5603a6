"""Test case reduction: programs are made as small as possible while a property holds.

First, files and lines are left out by delta debugging (`recovery.reproducer.ddmin`). When none can
be removed any more, expressions are replaced by their parts and by constants.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import chain

from conformance.differential.divergence import Files
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.walk import bodies, children, walk
from recovery.reproducer.ddmin import minimized


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
        while search.drop_lines():
            has_changed = True
        while search.simplify():
            has_changed = True
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
        self._tried = {files}
        self._holds = holds
        self._most = most

    def _try(self, files: Files) -> bool:
        """Replace the files if the property holds for the new ones; return whether it does."""
        if len(self._tried) > self._most or files in self._tried:
            return False
        self._tried.add(files)
        if not self._holds(files):
            return False
        self.files = files
        return True

    # ----------------------------------------------------------------------- lines

    def drop_lines(self) -> bool:
        """Try to leave out files and lines; return whether anything was."""
        before = self.files
        for number in range(len(self.files) - 1, 0, -1):
            self._try(self.files[:number] + self.files[number + 1 :])
        for number, (path, text) in enumerate(self.files):
            minimized(text.splitlines(keepends=True), partial(self._has_lines, number, path))
        return self.files != before

    def _has_lines(self, number: int, path: str, lines: list[str]) -> bool:
        return self._try(_with_text(self.files, number, path, "".join(lines)))

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
