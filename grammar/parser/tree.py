"""Parse trees: what the rules of a grammar make of a text.

A tree is kept in two halves. An `Outline` is a tree without its text: a rule and what it consists
of. What lies on one line and is built alike shares its outline, in one file and across files, so
that a megabyte needs few of them and is parsed in a fraction of a second. The `Tree` adds the
tokens. `ParseNode` and `Token` are views of both, made when they are asked for; two views of the
same place are equal. Work that depends on the rules alone can be done once for each outline and
remembered, and chains of rules (`Outline.inner`) cost nothing to pass.

Every token of the text is in the tree, and what the lexer skips (comments, folds, blanks) lies in
the gaps between tokens: gaps and tokens in turn are the text.
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
    """A rule and its children: outlines of rules, and kinds of tokens. Not to be changed.

    ``width`` is the number of tokens in it. Expressions are chains of rules with one child each for
    the most part, which `inner` passes.
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
        # not itself: what refers to itself stays until garbage is collected
        self._inner: Outline | None = only.inner if isinstance(only, Outline) else None

    @property
    def inner(self) -> Outline:
        """The first outline from here inwards that is more than a rule whose only child is one."""
        return self._inner or self

    def __repr__(self) -> str:
        return f"Outline({self.rule!r}, {self.symbols!r})"

    @property
    def symbols(self) -> tuple[str | int, ...]:
        """What the rule consists of: names of rules and kinds of tokens."""
        return tuple(c.rule if isinstance(c, Outline) else c for c in self.children)


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a tree, by its index among the tokens of the text."""

    tree: Tree = field(repr=False)
    index: int

    @property
    def kind(self) -> str:
        """Its name in the grammar; ``EOF`` at the end of the file."""
        return self.tree.lexer.names[self.tree.kinds[self.index]]

    @property
    def text(self) -> str:
        """As written; empty at the end of the file."""
        return self.tree.lexemes[self.index]

    @property
    def offset(self) -> int:
        """Characters before it in the text."""
        return self.tree.offsets[self.index]

    @property
    def line(self) -> int:
        """From 1."""
        return self.tree.place(self.offset)[0]

    @property
    def column(self) -> int:
        """From 1, in characters."""
        return self.tree.place(self.offset)[1]


@dataclass(frozen=True, slots=True)
class ParseNode:
    """A rule in a tree: its outline, and the index of its first token.

    The tokens from ``first`` to before ``stop`` are its own; a rule that read nothing has none, and
    ``first`` is then the index of the token that comes next.
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
        """Index of the token after its last one."""
        return self.first + self.outline.width

    @property
    def inner(self) -> ParseNode:
        """The node behind a chain of rules that have one rule and nothing else in them."""
        outline = self.outline.inner
        return self if outline is self.outline else ParseNode(self.tree, outline, self.first)

    @property
    def children(self) -> list[ParseNode | Token]:
        """What the rule consists of, in order; made anew whenever it is asked for."""
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
        """Offsets of its first character and of the one after its last."""
        return self.tree.span(self.first, self.stop)

    @property
    def text(self) -> str:
        """Its text as written, comments within included."""
        start, end = self.span
        return self.tree.text[start:end]

    def walk(self) -> Iterator[ParseNode | Token]:
        """The node and everything below it, in the order of the text."""
        todo: list[ParseNode | Token] = [self]
        while todo:
            here = todo.pop()
            yield here
            if isinstance(here, ParseNode):
                todo += reversed(here.children)


@dataclass(frozen=True, eq=False, repr=False)
class Tree:
    """A parsed text.

    ``kinds`` and ``lexemes`` are kind and text of each token, the end of the file (with no text)
    the last. ``is_unique`` means that no second reading was met: see `grammar.parser.derivation`.
    """

    text: str
    lexer: Lexer
    kinds: Sequence[int]
    lexemes: Sequence[str]
    outline: Outline
    is_unique: bool

    @property
    def root(self) -> ParseNode:
        """The start rule."""
        return ParseNode(self, self.outline, 0)

    @property
    def tokens(self) -> list[Token]:
        """Every token, end of file included."""
        return [Token(self, index) for index in range(len(self.kinds))]

    @cached_property
    def offsets(self) -> Sequence[int]:
        """Where each token begins, in characters from the start of the text."""
        return [*self.lexer.offsets_of_tokens(self.text), len(self.text)]

    def gap(self, index: int) -> str:
        """What was skipped before the token ``index``: blanks, comments."""
        start = self.offsets[index - 1] + len(self.lexemes[index - 1]) if index else 0
        return self.text[start : self.offsets[index]]

    def span(self, first: int, stop: int) -> tuple[int, int]:
        """From the first character of the tokens ``first`` to before ``stop`` to behind their last.

        As offsets; no tokens lie where the next one begins.
        """
        start = self.offsets[first]
        end = self.offsets[stop - 1] + len(self.lexemes[stop - 1]) if stop > first else start
        return start, end

    def place(self, offset: int) -> tuple[int, int]:
        """Line and column of a character, both from 1."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    @cached_property
    def _lines(self) -> Sequence[int]:
        """Where each line begins."""
        return [0, *(found.end() for found in _LINE_END.finditer(self.text))]
