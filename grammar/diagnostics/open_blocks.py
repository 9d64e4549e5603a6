"""Blocks open at a line, derived from the words that lines begin with.

A failing program has no tree, and what people have to know about it is often the place of a block
that was never closed.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

_LEAD = re.compile(r"[ \t]*(?:GLOBAL[ \t]+)?([A-Za-z_]+)", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True, slots=True, eq=False)
class OpenBlock:
    """A block that is open: its word, its line from 1, and the block around it."""

    word: str
    line: int
    outer: OpenBlock | None

    @property
    def closer(self) -> str:
        """What would close it."""
        return BLOCKS[self.word].closer


def lead(line: str) -> str:
    """The word that says what a line is, in upper case; empty where there is none."""
    found = _LEAD.match(line)
    return found[1].upper() if found else ""


def open_blocks(source: Source, lines: Iterable[int]) -> dict[int, OpenBlock | None]:
    """The innermost block that is open before each of some lines, from 1."""
    wanted = set(lines)
    last = max(wanted, default=0)
    found: dict[int, OpenBlock | None] = {}
    block: OpenBlock | None = None
    opened: Counter[str] = Counter()
    for number, text in enumerate(source.lines[:last], 1):
        if number in wanted:
            found[number] = block
        word = lead(text)
        if word in BLOCKS:
            block = OpenBlock(word, number, block)
            opened[word] += 1
        elif any(opened[opener] for opener in CLOSERS.get(word, ())):
            is_closed = False
            while block is not None and not is_closed:  # what is not closed by itself as well
                is_closed = block.word in CLOSERS[word]
                opened[block.word] -= 1
                block = block.outer
    return found | {number: block for number in wanted if number > len(source.lines)}


def most_likely(source: Source, block: OpenBlock, end: int) -> tuple[OpenBlock, int]:
    """The block that was meant to be closed before line ``end``, and the line before which.

    Words alone show that a block like this one is open. Where closers are indented as what they
    close, that shows which one, and the lines in it are indented more than the block itself.
    """
    inside = source.lines[block.line - 1 : end - 1]
    opened: list[tuple[str, int]] = []
    unclosed: list[tuple[str, int]] = []
    for number, text in enumerate(inside, block.line):
        word = lead(text)
        if word in BLOCKS:
            opened.append((word, number))
        elif word in CLOSERS:
            fit = [one for one in opened if one[0] in CLOSERS[word]]
            depth = _indent(source, number)
            alike = [one for one in fit if _indent(source, one[1]) == depth] or fit
            meant = alike[-1] if alike else None
            while meant is not None and opened.pop() != meant:
                pass
            unclosed += [one for one in fit if meant is not None and one[1] > meant[1]]
    unclosed += [one for one in opened if one[0] == block.word]
    lines = [line for word, line in unclosed if word == block.word]
    if len(lines) == 1 and lines[0] != block.line:
        block = OpenBlock(block.word, lines[0], block)
    return block, _end_by_indent(source, block, end)


def _end_by_indent(source: Source, block: OpenBlock, end: int) -> int:
    """The first line in a block that is indented as the block is, if those before are more."""
    indent = _indent(source, block.line)
    is_indented = False
    for number in range(block.line + 1, end):
        text = source.line(number).lstrip()
        depth = _indent(source, number)
        if text and depth > indent:
            is_indented = True
        elif not text or text[0] == ";":
            continue
        elif depth < indent or BRANCHES.get(lead(text)) != block.word:
            return number if is_indented else end
    return end


def _indent(source: Source, line: int) -> int:
    text = source.line(line).expandtabs(4)
    return len(text) - len(text.lstrip())


def innermost(block: OpenBlock | None, words: Iterable[str]) -> OpenBlock | None:
    """The innermost open block of one of some kinds."""
    wanted = set(words)
    while block is not None and block.word not in wanted:
        block = block.outer
    return block
