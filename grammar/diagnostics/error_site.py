"""A line that cannot be read: its tokens, its block, and edits of it."""

from __future__ import annotations

import re
from functools import cached_property

from grammar.diagnostics.diagnostic import Fix, Region
from grammar.diagnostics.open_blocks import OpenBlock
from grammar.syntax.build import SyntaxFailure
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

# Of a longer line only what is near the failure is looked at.
_LONGEST_LINE = 2_000
_TOKEN = re.compile(r'"[^"]*"|[$#]?\w+|:=|==|<>|!=|<=|>=|=<|=>|&&|\|\||//|\S')


@dataclass(frozen=True, eq=False)
class ErrorSite:
    """A failure, and what stands around it."""

    failure: SyntaxFailure
    source: Source
    block: OpenBlock | None

    @cached_property
    def code(self) -> str:
        """The line without its comment, so far as it is near the failure."""
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
        """Their texts in upper case."""
        return [token[0].upper() for token in self.tokens]

    @cached_property
    def place(self) -> int:
        """The number of the offending token among them; that of the end where there is none."""
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
        """A token of the line in upper case, empty where there is none."""
        return self.words[place] if 0 <= place < len(self.words) else ""

    @property
    def is_at_end(self) -> bool:
        """Whether the line ends too early."""
        return self.place == len(self.tokens)

    def expects(self, *tokens: str) -> bool:
        """Whether all of some tokens could have come."""
        return all(token in self.failure.expected for token in tokens)

    def region(self, first: int, last: int | None = None) -> Region:
        """The region of a token, or from one to another."""
        line = self.failure.line
        start = self.tokens[first].start()
        end = self.tokens[first if last is None else last].end()
        return Region(line, start + 1, line, end + 1)

    def swap(self, replacement: str, first: int, last: int | None = None) -> Fix:
        """A fix that writes something else in place of some tokens."""
        region = self.region(first, last)
        if replacement:
            return Fix(f"write {replacement.strip()}", region, replacement)
        around = self.code[region.column - 2 : region.end_column]  # words must not run together
        gap = " " if around[:1].isalnum() and around[-1:].isalnum() else ""
        return Fix(f"leave {self.tokens[first][0]} out", region, gap)

    def append(self, replacement: str) -> Fix:
        """A fix that writes something at the end of the line."""
        line, column = self.failure.line, len(self.code) + 1
        return Fix(f"write {replacement.strip()}", Region(line, column, line, column), replacement)
