"""The formatter behind `krl format`.

It changes the indentation of lines, by the depth of their block; the blanks between tokens
(`grammar.syntax.spacing`); keywords, to upper case; and blanks at the end of lines of code. It
never changes lines, line ends and their number; comments, strings, numbers; the letters of names;
header lines; and the lines of a fold that the teach pendant wrote, because the pendant reads them.

- A block is indented by two blanks. Folds and data lists are not indented. The body of a routine is
  indented if its first statement was, because both styles are usual. A label has the indentation of
  its routine.
- A comment alone on its line is indented like the next line of code. Before a line that ends a
  block or a branch, it is indented like the body if it was indented more than that line. ENDFOLD is
  indented like its FOLD.
- A comment after code keeps its column, counted from the begin of the line, if there is room;
  otherwise it follows the code after one blank.

Formatting is idempotent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from operator import add

from grammar.blocks import BLOCKS, BRANCHES
from grammar.parser.lexer import EOF
from grammar.parser.tree import Outline, Tree
from grammar.syntax.build import BLOCK_RULES, Builder, SyntaxFailure, builder
from grammar.syntax.source import Source
from grammar.syntax.spacing import Gap, Setting, Spacing, set_line
from grammar.syntax.unparse import indent
from grammar.syntax.walk import same

_ROUTINES = frozenset({"procedure", "function"})
# Set as tables, or by the controller's own templates: nothing between their tokens changes.
_AS_WRITTEN = _ROUTINES | {"dataList", "declaration", "initialisation"}
#: Rules whose tokens are set one by one; any other is set as a whole.
_IN_PARTS = BLOCK_RULES | _AS_WRITTEN
_INSIDE = frozenset({"statement", "caseBranch", "defaultBranch", "splineItem"})
#: What ends a block or a branch, and how much deeper the lines before it may lie.
_ENDS = dict.fromkeys(BRANCHES, 1) | {block.closer: block.depth for block in BLOCKS.values()}
_PLAIN = Setting(Gap.FREE, Gap.FREE, False)
_BLANKS = " \t"


class FormatterDefect(Exception):
    """Formatting would change more than the layout of a text: a defect of the formatter."""


@cache
def formatter() -> Formatter:
    """Return the formatter for the current grammar; created once in each process."""
    return Formatter(builder())


class Formatter:
    """Formats texts; caches the spacing of lines."""

    def __init__(self, reader: Builder) -> None:
        self._reader = reader
        self._lexer = reader.parser.recognizer.lexer
        self._ends = {EOF, self._lexer.kind_of["NEWLINE"]}
        self._header = self._lexer.kind_of["HEADER"]
        self._spacing = Spacing(self._lexer)

    def layout(self, text: str, path: str = "") -> str | list[SyntaxFailure]:
        """Return the formatted text, or its syntax failures.

        Raises `FormatterDefect` instead of returning a text with another meaning.
        """
        tree = self._reader.parser.parse(text)
        if isinstance(tree, Tree):
            laid_out = self.set_out(tree)
            if laid_out == text:
                return text
        before = self._reader.read(text, path)
        if isinstance(before, list):
            return before
        after = self._reader.read(laid_out, path)
        if isinstance(after, list) or not same(before, after) or _rest(text) != _rest(laid_out):
            raise FormatterDefect(f"{path}: setting it out would change what it says")
        return laid_out

    def set_out(self, tree: Tree) -> str:
        """Return the formatted text of a tree, unchecked."""
        source = Source(tree.text)
        kept = _kept(source)
        marks = self._marks(tree, source, kept)
        lines = list(source.lines)
        stops = [index for index, kind in enumerate(tree.kinds) if kind in self._ends]
        depth = column = inside = 0  # of the next line of code below the current line
        for number in range(len(lines), 0, -1):
            written = lines[number - 1]
            start = stops[number - 2] + 1 if number > 1 else 0
            stop = stops[number - 1]
            if start < stop:
                depth, column = marks.depths[start], _column(written)
                inside = 0 if number in kept else marks.insides.get(start, 0)
                if number not in kept and tree.kinds[start] != self._header:
                    lines[number - 1] = _set_code(tree, start, stop, marks, written)
            elif number not in kept:
                comment = written.lstrip(_BLANKS)
                deeper = inside if _column(written) > column else 0
                lines[number - 1] = indent(depth + deeper) + comment if comment else ""
        _set_ends_of_folds(source, kept, lines)
        return "".join(map(add, lines, [*source.line_ends, ""]))

    def _marks(self, tree: Tree, source: Source, kept: frozenset[int]) -> _Marks:
        """Return the spacing and the indentation of the tokens of a tree."""
        marks = _Marks([_PLAIN] * len(tree.kinds), [0] * len(tree.kinds), {})
        names = self._lexer.names
        todo: list[tuple[Outline, int, int]] = [(tree.outline, 0, 0)]
        while todo:
            block, at, depth = todo.pop()
            rule, as_written = block.rule, block.rule in _AS_WRITTEN
            more = 1
            if rule in _ROUTINES:
                more = _indents_body(block, at, tree, source, kept)
            for child in block.children:
                if not isinstance(child, Outline):
                    marks.settings[at] = self._spacing.token(child, rule, as_written=as_written)
                    marks.depths[at] = depth
                    if names[child] in _ENDS:
                        marks.insides[at] = more * _ENDS[names[child]]
                    at += 1
                    continue
                inside = depth + (more if child.rule in _INSIDE else 0)
                if child.rule in _IN_PARTS:
                    todo.append((child, at, inside))
                elif child.rule != "eol":
                    found = self._spacing.line(child, as_written=as_written)
                    marks.settings[at : at + child.width] = found
                    marks.depths[at] = 0 if child.inner.rule == "label" else inside
                at += child.width
        return marks


@dataclass(frozen=True, slots=True)
class _Marks:
    """The spacing of each token and, for the first token of a line, the depth of its block.

    ``insides`` is, for a token that ends a block, how much more the lines in the block are
    indented.
    """

    settings: list[Setting]
    depths: list[int]
    insides: dict[int, int]


def _indents_body(
    routine: Outline, at: int, tree: Tree, source: Source, kept: frozenset[int]
) -> int:
    """Return 1 if the body of a routine is indented, else 0.

    Its first statement outside the pendant's folds decides.
    """
    for child in routine.children:
        if isinstance(child, Outline):
            if child.rule == "statement" and not _is_label(child):
                line = source.place(tree.offsets[at])[0]
                if line not in kept:
                    return min(1, _column(source.lines[line - 1]))
            at += child.width
        else:
            at += 1
    return 0


def _is_label(statement: Outline) -> bool:
    first = statement.children[0]
    return isinstance(first, Outline) and first.inner.rule == "label"


def _set_code(tree: Tree, start: int, stop: int, marks: _Marks, written: str) -> str:
    """Return the formatted line of the tokens from ``start`` up to, not including, ``stop``."""
    gaps = [tree.gap(index) for index in range(start, stop)]
    blanks = indent(marks.depths[start])
    code = blanks + set_line(tree.lexemes[start:stop], marks.settings[start:stop], gaps)
    behind = tree.gap(stop)
    comment = behind.lstrip(_BLANKS)
    if not comment:
        return code
    before = written[: len(written) - len(comment)]
    if "\t" in before:  # its column depends on the editor
        return f"{code}{behind[: -len(comment)] or ' '}{comment}"
    place = len(before) - _column(written) + len(blanks)
    return f"{code.ljust(max(place, len(code) + 1))}{comment}"


def _set_ends_of_folds(source: Source, kept: frozenset[int], lines: list[str]) -> None:
    """Indent each ENDFOLD like its FOLD."""
    for fold in source.folds:
        if fold.last is not None and fold.last not in kept:
            first = lines[fold.first - 1]
            blanks = first[: len(first) - len(first.lstrip(_BLANKS))]
            lines[fold.last - 1] = blanks + lines[fold.last - 1].lstrip(_BLANKS)


def _kept(source: Source) -> frozenset[int]:
    """Return the line numbers of folds that the teach pendant wrote."""
    kept: set[int] = set()
    for fold in source.folds:
        if fold.parameters is not None:
            kept.update(range(fold.first, (fold.last or fold.first) + 1))
    return frozenset(kept)


def _column(line: str) -> int:
    """Return the indentation of a line in columns."""
    return len(line[: len(line) - len(line.lstrip(_BLANKS))].expandtabs())


def _rest(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the parts of a text that are not in its tree: comments and line ends."""
    source = Source(text)
    return tuple(comment.text for comment in source.comments), source.line_ends
