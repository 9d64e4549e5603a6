"""The site of a syntax error: the tokens of its line, its block, and edits of the line."""

from __future__ import annotations

import re
from functools import cached_property

from grammar.diagnostics.diagnostic import Fix, Region
from grammar.diagnostics.open_blocks import OpenBlock
from grammar.syntax.build import SyntaxFailure
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

# Of a longer line only the part up to this many characters after the failure is examined.
_LONGEST_LINE = 2_000
_TOKEN = re.compile(r'"[^"]*"|[$#]?\w+|:=|==|<>|!=|<=|>=|=<|=>|&&|\|\||//|\S')


@dataclass(frozen=True, eq=False)
class ErrorSite:
    """A failure with its source and the block in which it lies."""

    failure: SyntaxFailure
    source: Source
    block: OpenBlock | None

    @cached_property
    def code(self) -> str:
        """The line without its comment, up to a limit after the failure."""
        line = self.source.line(self.failure.line)
        comment = self.source.comment(self.failure.line)
        line = line if comment is None else line[: comment.column - 1]
        return line[: self.failure.column + _LONGEST_LINE].rstrip()

    @cached_property
    def tokens(self) -> list[re.Match[str]]:
        """The tokens of the line, roughly: operators of other languages are tokens too."""
        return list(_TOKEN.finditer(self.code))

    @cached_property
    def words(self) -> list[str]:
        """The texts of the tokens in upper case."""
        return [token[0].upper() for token in self.tokens]

    @cached_property
    def place(self) -> int:
        """The index of the offending token, or the number of tokens if the line ends too early."""
        column = self.failure.column - 1
        for number, token in enumerate(self.tokens):
            if token.end() > column:
                return number
        return len(self.tokens)

    @property
    def text(self) -> str:
        """The offending token in upper case."""
        return self.word(self.place)

    def word(self, place: int) -> str:
        """Return a token of the line in upper case; empty if there is none with this index."""
        return self.words[place] if 0 <= place < len(self.words) else ""

    @property
    def is_at_end(self) -> bool:
        """Whether the line ends too early."""
        return self.place == len(self.tokens)

    def expects(self, *tokens: str) -> bool:
        """Return whether all of these tokens were expected at the failure."""
        return all(token in self.failure.expected for token in tokens)

    def region(self, first: int, last: int | None = None) -> Region:
        """Return the region of a token, or of the tokens from ``first`` to ``last``."""
        line = self.failure.line
        start = self.tokens[first].start()
        end = self.tokens[first if last is None else last].end()
        return Region(line, start + 1, line, end + 1)

    def swap(self, replacement: str, first: int, last: int | None = None) -> Fix:
        """Return a fix that replaces some tokens."""
        region = self.region(first, last)
        if replacement:
            return Fix(f"write {replacement.strip()}", region, replacement)
        around = self.code[region.column - 2 : region.end_column]  # words must not run together
        gap = " " if around[:1].isalnum() and around[-1:].isalnum() else ""
        return Fix(f"leave {self.tokens[first][0]} out", region, gap)

    def append(self, replacement: str) -> Fix:
        """Return a fix that appends a text to the line."""
        line, column = self.failure.line, len(self.code) + 1
        return Fix(f"write {replacement.strip()}", Region(line, column, line, column), replacement)
