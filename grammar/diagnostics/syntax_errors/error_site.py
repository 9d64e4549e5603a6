"""The site of a syntax error, with the tokens and the block of its line, and the mistake there.

Its rule and the expected tokens come from `grammar.parser.failures`.
"""

from __future__ import annotations

import re
from functools import cached_property

from grammar.diagnostics.diagnostic import Fix, Region
from grammar.diagnostics.expected_tokens import is_reserved
from grammar.diagnostics.open_blocks import OpenBlock, innermost
from grammar.syntax.build import SyntaxFailure
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

#: Characters of a token that a message shows.
LONGEST_TOKEN = 60
# Of a longer line only the part up to this many characters after the failure is examined.
_LONGEST_LINE = 2_000
_WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_TOKEN = re.compile(r'"[^"]*"|[$#]?\w+|:=|==|<>|!=|<=|>=|=<|=>|&&|\|\||//|\S')


@dataclass(frozen=True, slots=True)
class Mistake:
    """A recognised mistake: its message, and its region if that is not the offending token.

    ``is_unconfirmed`` marks code that occurs in real programs; that proves neither that it is KRL
    nor that it is not.
    """

    message: str
    fix: Fix | None = None
    reason: str = ""
    slug: str = "syntax"
    region: Region | None = None
    is_unconfirmed: bool = False


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

    @property
    def shown(self) -> str:
        """The offending token as a message shows it, cut if it is long."""
        text = self.failure.text.strip()
        cut = f"{text[:LONGEST_TOKEN]}…" if len(text) > LONGEST_TOKEN else text
        return cut if cut[:1].isalnum() or cut[:1] in '"$#_' else f'"{cut}"'

    def word(self, place: int) -> str:
        """Return a token of the line in upper case; empty if there is none with this index."""
        return self.words[place] if 0 <= place < len(self.words) else ""

    @property
    def is_word(self) -> bool:
        """Whether the offending token is a name, a keyword or a system variable."""
        return re.match(r"[$A-Z_]", self.text) is not None

    def is_name(self, place: int) -> bool:
        """Return whether a token of the line can be a name."""
        word = self.word(place)
        return _WORD.fullmatch(word) is not None and not is_reserved(word)

    @property
    def is_in_data_list(self) -> bool:
        """Whether the line is in a data list."""
        return innermost(self.block, ("DEFDAT",)) is not None

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

    def gap(self, place: int) -> Region:
        """Return the empty region ahead of a token: at the end of the one before it, if any."""
        at = self.tokens[place - 1].end() if place else self.tokens[0].start()
        return Region.empty(self.failure.line, at + 1)

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
        end = Region.empty(self.failure.line, len(self.code) + 1)
        return Fix(f"write {replacement.strip()}", end, replacement)
