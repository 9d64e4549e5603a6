"""Which blocks are open at a line, known from the words that lines begin with.

A failing program has no tree, and what people have to know about it is often the place of a block
that was never closed.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from grammar.blocks import BLOCKS, CLOSERS
from grammar.syntax.source import Source

__all__ = ["OpenBlock", "innermost", "lead", "open_blocks"]

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


def innermost(block: OpenBlock | None, words: Iterable[str]) -> OpenBlock | None:
    """The innermost open block of one of some kinds."""
    wanted = set(words)
    while block is not None and block.word not in wanted:
        block = block.outer
    return block
