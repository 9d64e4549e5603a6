"""Copies of programs, for benches that need more text than there is; never evidence.

A copy keeps the layout, the comments and every kind of token of its program, so reading it is as
much work. Its names get a suffix and its numbers other digits: no two copies are equal, and nothing
cached for one saves work on another.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count, repeat
from pathlib import Path

from grammar.blocks import BLOCKS
from grammar.parser.lexer import Lexer

# What may hold digits or words that are no numbers and no names comes first, and stays as it is.
_PIECE = re.compile(
    r"""[;&][^\r\n]* | "[^"\r\n]*"? | '[^'\r\n]*'? | [$\#]\w+
      | (?P<name>[A-Za-z_][\w$]*) | (?P<number>[0-9]+)""",
    re.VERBOSE,
)
# In a template, characters that no text uses mark what differs from copy to copy.
_DIGIT = 0xE000  # to 0xE009
_SUFFIX = 0xE00A
_TO_PLACES = {ord("0") + digit: _DIGIT + digit for digit in range(10)}
_BLOCK_WORDS = frozenset(BLOCKS).union(*(block.words for block in BLOCKS.values()))
_FILES_A_FOLDER = 500


@dataclass(frozen=True, slots=True)
class Template:
    """A program with places for what differs from copy to copy."""

    text: str

    def copy(self, digits: Sequence[str], suffix: str) -> str:
        """The program with digit ``d`` of a number as ``digits[d]`` and ``suffix`` on its names."""
        return self.text.translate(
            {_SUFFIX: suffix, **{_DIGIT + digit: new for digit, new in enumerate(digits)}}
        )


@dataclass(frozen=True, slots=True)
class Written:
    """How much was written."""

    files: int
    bytes: int


def templates(texts: Iterable[str], lexer: Lexer) -> Iterator[Template]:
    """A template for each program that has a name; without one, copies could be the same.

    Words that ``lexer`` or the language reserves keep their spelling.
    """

    def place(found: re.Match[str]) -> str:
        piece = found[0]
        if found["number"]:
            return piece.translate(_TO_PLACES)
        if not found["name"] or piece.upper() in _BLOCK_WORDS:
            return piece
        return piece if lexer.is_keyword(lexer.kinds[piece]) else piece + chr(_SUFFIX)

    for text in texts:
        template = _PIECE.sub(place, text)
        if chr(_SUFFIX) in template:
            yield Template(template)


def spread(texts: Iterable[str]) -> list[str]:
    """The texts in an order of which every beginning has small and large ones as the whole has."""
    ordered = sorted(texts, key=lambda text: (len(text), text))
    bits = len(ordered).bit_length()
    # the bits of the places read backwards: halves first, then quarters, then eighths
    places = sorted(range(len(ordered)), key=lambda place: int(f"{place:0{bits}b}"[::-1], 2))
    return [ordered[place] for place in places]


def write_corpus(chosen: Sequence[Template], folder: Path, size: int, seed: int = 1) -> Written:
    """Write copies below ``folder`` until they have ``size`` bytes or a little more.

    The same templates, size and seed give the same files. Raises ValueError without templates.
    """
    if not chosen:
        raise ValueError("there is no name in them")
    files = written = 0
    for template, (digits, suffix) in _variants(chosen, seed):
        name = f"{files // _FILES_A_FOLDER:04}/p{files:06}.src"
        files += 1
        data = template.copy(digits, suffix).encode("utf-8")
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)
        written += len(data)
        if written >= size:
            break
    return Written(files, written)


def _variants(
    chosen: Sequence[Template], seed: int
) -> Iterator[tuple[Template, tuple[list[str], str]]]:
    """Every template with the first digits and suffix, then with the next, without end."""
    for number in count(1):
        digits = list("0123456789")
        random.Random(f"{seed} {number}").shuffle(digits)
        yield from zip(chosen, repeat((digits, f"_{number}")), strict=False)
