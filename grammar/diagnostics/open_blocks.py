"""Blocks that are open at a line, found from the first words of the lines.

A program with syntax errors has no tree, and the place of a block that was never closed is often
what its author needs to know.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

_COUNTER = re.compile(r"[ \t]*FOR[ \t]+(\w+)", re.IGNORECASE)
_LEAD = re.compile(r"[ \t]*(?:GLOBAL[ \t]+)?([A-Za-z_]+)", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True, slots=True, eq=False)
class OpenBlock:
    """An open block: its first word, its line from 1, and the block around it."""

    word: str
    line: int
    outer: OpenBlock | None

    @property
    def closer(self) -> str:
        """The word that closes the block."""
        return BLOCKS[self.word].closer


def lead(line: str) -> str:
    """Return the word that tells the kind of a line, in upper case; empty if there is none."""
    found = _LEAD.match(line)
    return found[1].upper() if found else ""


def open_blocks(source: Source, lines: Iterable[int]) -> dict[int, OpenBlock | None]:
    """Return the innermost block that is open before each of these lines, which count from 1."""
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
            while block is not None and not is_closed:  # also ends unclosed blocks inside it
                is_closed = block.word in CLOSERS[word]
                opened[block.word] -= 1
                block = block.outer
    return found | {number: block for number in wanted if number > len(source.lines)}


def most_likely(source: Source, block: OpenBlock, end: int) -> tuple[OpenBlock, int]:
    """Return the block that should have been closed before line ``end``, and the line for it.

    The first words only show that a block of this kind is open. If closing words are indented like
    the lines that they close, indentation shows which block it is. The block then ends before the
    first line that is indented less than its body. A FOR ends before another one with its counter.
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
    """Return the first line after the body of a block, judged by indentation; else ``end``."""
    indent = _indent(source, block.line)
    if counter := _counter(source, block.line):
        later = range(block.line + 1, end)
        end = next((number for number in later if _counter(source, number) == counter), end)
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


def _counter(source: Source, line: int) -> str:
    """Return the counter of the FOR on a line, in upper case; empty if there is none."""
    found = _COUNTER.match(source.line(line))
    return found[1].upper() if found else ""


def _indent(source: Source, line: int) -> int:
    text = source.line(line).expandtabs(4)
    return len(text) - len(text.lstrip())


def innermost(block: OpenBlock | None, words: Iterable[str]) -> OpenBlock | None:
    """Return the innermost open block whose first word is one of ``words``."""
    wanted = set(words)
    while block is not None and block.word not in wanted:
        block = block.outer
    return block
