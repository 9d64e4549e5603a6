"""A source text with what its syntax tree leaves out: lines, comments, folds, path.

Comments are no tokens. They lie in the gaps between tokens, each at the end of a line, so they can
be found in the text alone: a semicolon begins one unless it is in a string or after the ``&`` of a
header line. So a text with syntax errors has its comments all the same.

A *fold* is a pair of comments, ``;FOLD`` and ``;ENDFOLD``, which an editor shows as one line. Folds
nest and mean nothing to the controller. The teach pendant writes folds of its own for inline forms
and initialisation. Their parameters follow ``;%{`` and, in newer releases, are in a ``;Params``
line below; the pendant reads both.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import PurePosixPath

from support.lazy_dataclass import dataclass

_LINE_END = re.compile(r"\r\n|\r|\n")
# The quotation mark of an unclosed string is a token of its own, so it hides no comment.
_COMMENT = re.compile(r'"[^"\r\n]*"|&[^\r\n]*|(;[^\r\n]*)')
# FOLD with the title of the fold, or ENDFOLD.
_MARK = re.compile(
    r";[ \t]*(?:FOLD(?:[ \t]+|(?=[;\r\n])|\Z)([^\r\n]*)|ENDFOLD\b)", re.IGNORECASE | re.ASCII
)
_PARAMETERS = re.compile(r";[ \t]*%\{")
_WORD = re.compile(r";[^\r\n]*|([A-Z_$][A-Z0-9_$]*)")
_PARAMETER_LINE = re.compile(r";[ \t]*PARAMS[ \t]", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment with its semicolon.

    ``line`` and ``column`` count from 1, ``offset`` from 0.
    """

    line: int
    column: int
    offset: int
    text: str


@dataclass(frozen=True, slots=True)
class Fold:
    """Lines that an editor shows as one.

    ``first`` is the line of FOLD, ``last`` that of ENDFOLD, ``None`` if it is missing.
    ``parameters`` are those of the teach pendant, on the line of FOLD and in the ``Params`` line
    below, as written; ``None`` for folds of users.
    """

    title: str
    first: int
    last: int | None
    parameters: str | None


@dataclass(frozen=True, eq=False, repr=False)
class Source:
    """A text and the path with which it is shown, with ``/``; line ends are preserved."""

    text: str
    path: str = ""

    @property
    def name(self) -> str:
        """The name of the module, which is the file name without its suffix."""
        return PurePosixPath(self.path).stem

    @property
    def kind(self) -> str:
        """``src``, ``dat``, ``sub`` or any other suffix of the file, in lower case."""
        return PurePosixPath(self.path).suffix[1:].lower()

    # ----------------------------------------------------------------------------- lines

    @cached_property
    def starts(self) -> tuple[int, ...]:
        """The offset of each line; a line end at the end of the text begins another line."""
        return (0, *(found.end() for found in _LINE_END.finditer(self.text)))

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """Every line without its line end."""
        return tuple(_LINE_END.split(self.text))

    @cached_property
    def line_ends(self) -> tuple[str, ...]:
        """Every line end as it was; one fewer than there are lines."""
        return tuple(_LINE_END.findall(self.text))

    def line(self, number: int) -> str:
        """Return a line by its number, from 1, without its line end; empty if there is none."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def place(self, offset: int) -> tuple[int, int]:
        """Return the line and column of a character, both from 1."""
        line = bisect_right(self.starts, offset)
        return line, offset - self.starts[line - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and column: the inverse of `place`."""
        return self.starts[line - 1] + column - 1

    # -------------------------------------------------------------------------- comments

    @cached_property
    def comments(self) -> tuple[Comment, ...]:
        """All comments, in order."""
        return tuple(self._comments())

    def _comments(self) -> Iterator[Comment]:
        for found in _COMMENT.finditer(self.text):
            if found.group(1) is not None:
                offset = found.start()
                line, column = self.place(offset)
                yield Comment(line, column, offset, found.group(1))

    @cached_property
    def _comment_of_line(self) -> Mapping[int, Comment]:
        return {comment.line: comment for comment in self.comments}

    def comment(self, line: int) -> Comment | None:
        """Return the comment of a line, whether after code or alone; a line has at most one."""
        return self._comment_of_line.get(line)

    # ----------------------------------------------------------------------------- folds

    @cached_property
    def folds(self) -> tuple[Fold, ...]:
        """All folds in the order of their first lines, including those that are never closed."""
        return tuple(sorted(self._folds(), key=lambda fold: fold.first))

    @cached_property
    def unbalanced_folds(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """The lines of ``;FOLD`` without an end, and of ``;ENDFOLD`` without a begin."""
        opened, stray = [], []
        for line, title in self._fold_marks():
            if title is not None:
                opened.append(line)
            elif opened:
                opened.pop()
            else:
                stray.append(line)
        return tuple(opened), tuple(stray)

    def _fold_marks(self) -> Iterator[tuple[int, str | None]]:
        """Yield the lines that begin or end a fold, with the title or ``None``."""
        last = 0
        for found in _MARK.finditer(self.text):
            line, column = self.place(found.start())
            before = self.text[found.start() - column + 1 : found.start()] if line != last else ";"
            if not before.strip(" \t"):
                yield line, found[1]
            last = line

    def _folds(self) -> Iterator[Fold]:
        opened: list[tuple[int, str]] = []

        def fold(last: int | None) -> Fold:
            first, title = opened.pop()
            shown, mark, hidden = _split(title)
            below = self.comment(first + 1)
            more = below.text if below and _PARAMETER_LINE.match(below.text) else ""
            parameters = f"{hidden}{more}" if mark or more else None
            return Fold(shown.strip(), first, last, parameters)

        for line, title in self._fold_marks():
            if title is not None:
                opened.append((line, title))
            elif opened:
                yield fold(line)
        while opened:
            yield fold(None)


def names_in_text(text: str) -> frozenset[str]:
    """Return the names in a text outside comments, in upper case; it can declare no others."""
    return frozenset(_WORD.findall(text.upper())) - {""}


def _split(title: str) -> tuple[str, bool, str]:
    """Return the title of a FOLD line, whether it has parameters, and the parameters."""
    found = _PARAMETERS.search(title)
    if found is None:
        return title, False, ""
    return title[: found.start()], True, title[found.start() + 1 :].lstrip(" \t")
