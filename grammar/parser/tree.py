"""Parse trees.

A tree is kept in two halves. An `Outline` is a tree without its text: a rule and its children.
Parts that lie on one line and have the same structure share their outline, within a file and across
files, so a megabyte needs few of them. The `Tree` adds the tokens. `ParseNode` and `Token` are
views of both, created on demand; two views of the same place are equal. A result that depends on
the rules alone can be cached for each outline, and chains of rules with one child cost nothing
(`Outline.inner`).

A tree is lossless: every token of the text is in it, and what the lexer skips (comments, folds,
blanks) is in the gaps between tokens. Gaps and tokens in turn give the text.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cached_property

from grammar.parser.lexer import Lexer
from support.lazy_dataclass import dataclass

_LINE_END = re.compile(r"\r\n|\r|\n")


class Outline:
    """A rule and its children: outlines of rules, and token kinds. Immutable by convention.

    ``width`` is the number of tokens in it. Most expressions are chains of rules with one child
    each; `inner` skips such a chain.
    """

    __slots__ = ("_inner", "children", "rule", "width")

    def __init__(self, rule: str, children: tuple[Outline | int, ...]) -> None:
        self.rule = rule
        self.children = children
        width = 0
        for child in children:
            width += child.width if isinstance(child, Outline) else 1
        self.width: int = width
        only = children[0] if len(children) == 1 else None
        # None rather than self: a reference cycle would only be freed by the garbage collector
        self._inner: Outline | None = only.inner if isinstance(only, Outline) else None

    @property
    def inner(self) -> Outline:
        """The first outline, from this one inwards, whose children are not just one rule."""
        return self._inner or self

    def __repr__(self) -> str:
        return f"Outline({self.rule!r}, {self.symbols!r})"

    @property
    def symbols(self) -> tuple[str | int, ...]:
        """The children as names of rules and kinds of tokens."""
        return tuple(c.rule if isinstance(c, Outline) else c for c in self.children)


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a tree, by its index among the tokens of the text."""

    tree: Tree = field(repr=False)
    index: int

    @property
    def kind(self) -> str:
        """Name of the token in the grammar; ``EOF`` at the end of the file."""
        return self.tree.lexer.names[self.tree.kinds[self.index]]

    @property
    def text(self) -> str:
        """The token as written; empty at the end of the file."""
        return self.tree.lexemes[self.index]

    @property
    def offset(self) -> int:
        """Offset of the token in the text, in characters."""
        return self.tree.offsets[self.index]

    @property
    def line(self) -> int:
        """Line of the token, from 1."""
        return self.tree.place(self.offset)[0]

    @property
    def column(self) -> int:
        """Column of the token, from 1, in characters."""
        return self.tree.place(self.offset)[1]


@dataclass(frozen=True, slots=True)
class ParseNode:
    """A rule in a tree: its outline, and the index of its first token.

    It consists of the tokens from ``first`` up to ``stop``, which is excluded. For a rule that read
    nothing, ``first`` is the index of the next token.
    """

    tree: Tree = field(repr=False)
    outline: Outline
    first: int

    @property
    def rule(self) -> str:
        """Name of the rule."""
        return self.outline.rule

    @property
    def stop(self) -> int:
        """Index of the token after the last one of the node."""
        return self.first + self.outline.width

    @property
    def inner(self) -> ParseNode:
        """The node at the end of a chain of rules with one rule as their only child."""
        outline = self.outline.inner
        return self if outline is self.outline else ParseNode(self.tree, outline, self.first)

    @property
    def children(self) -> list[ParseNode | Token]:
        """The children in order; a new list on each access."""
        tree, at = self.tree, self.first
        found: list[ParseNode | Token] = []
        for child in self.outline.children:
            if isinstance(child, Outline):
                found.append(ParseNode(tree, child, at))
                at += child.width
            else:
                found.append(Token(tree, at))
                at += 1
        return found

    @property
    def span(self) -> tuple[int, int]:
        """Offsets of the first character and of the one after the last."""
        return self.tree.span(self.first, self.stop)

    @property
    def text(self) -> str:
        """The text as written, comments between tokens included."""
        start, end = self.span
        return self.tree.text[start:end]

    def walk(self) -> Iterator[ParseNode | Token]:
        """Yield the node and everything below it, in the order of the text."""
        todo: list[ParseNode | Token] = [self]
        while todo:
            here = todo.pop()
            yield here
            if isinstance(here, ParseNode):
                todo += reversed(here.children)


@dataclass(frozen=True, eq=False, repr=False)
class Tree:
    """The parse tree of a text.

    ``kinds``, ``lexemes`` and ``offsets`` are the kind and text of each token and where it begins,
    in characters; the last one is the end of the file, with an empty text. ``is_unique`` means that
    no second reading was met: see `grammar.parser.derivation`.
    """

    text: str
    lexer: Lexer
    kinds: Sequence[int]
    lexemes: Sequence[str]
    offsets: Sequence[int]
    outline: Outline
    is_unique: bool

    @property
    def root(self) -> ParseNode:
        """The node of the start rule."""
        return ParseNode(self, self.outline, 0)

    @property
    def tokens(self) -> list[Token]:
        """Every token, end of file included."""
        return [Token(self, index) for index in range(len(self.kinds))]

    def gap(self, index: int) -> str:
        """Return the skipped text before the token ``index``: blanks and comments."""
        start = self.offsets[index - 1] + len(self.lexemes[index - 1]) if index else 0
        return self.text[start : self.offsets[index]]

    def span(self, first: int, stop: int) -> tuple[int, int]:
        """Return the offsets of the tokens from ``first`` up to ``stop``, which is excluded.

        An empty range lies where the next token begins.
        """
        start = self.offsets[first]
        end = self.offsets[stop - 1] + len(self.lexemes[stop - 1]) if stop > first else start
        return start, end

    def place(self, offset: int) -> tuple[int, int]:
        """Return the line and column of an offset, both from 1."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    @cached_property
    def _lines(self) -> Sequence[int]:
        """The offset at which each line begins."""
        return [0, *(found.end() for found in _LINE_END.finditer(self.text))]
