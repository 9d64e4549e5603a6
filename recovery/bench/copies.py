"""Copies of programs, for benches that need more text than there is; never evidence.

A copy keeps the layout, the comments and every kind of token of its program. Its names get a suffix
and its numbers other digits, and some of its routines are left out: no two copies are equal, and
nothing cached for one saves work on another. Lines that fail keep their names, so that a larger
corpus has no other causes of failure.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count, pairwise
from pathlib import Path, PurePosixPath

from grammar.blocks import BLOCKS
from grammar.parser.failures import FailureFinder
from recovery.ledger.evidence import place
from recovery.survey.failing_line import source_lines
from support.files.discovery import SourceFile

# What may hold digits or words that are no numbers and no names comes first, and stays as it is.
_PIECE = re.compile(
    r"""[;&].* | "[^"]*"? | '[^']*'? | [$\#]\w+ | (?P<name>[A-Za-z_][\w$]*) | (?P<number>[0-9]+)""",
    re.VERBOSE,
)
# In a template, characters that no text uses mark what differs from copy to copy.
_DIGIT = 0xE000  # to 0xE009
_SUFFIX = 0xE00A
_TO_PLACES = {ord("0") + digit: _DIGIT + digit for digit in range(10)}
_BLOCK_WORDS = frozenset(BLOCKS).union(*(block.words for block in BLOCKS.values()))
_ROUTINE = re.compile(r"^[ \t]*(?:GLOBAL[ \t]+)?DEF(?:FCT)?[ \t]", re.IGNORECASE | re.MULTILINE)
_LEFT_OUT = 0.1  # of the routines after the first


@dataclass(frozen=True, slots=True)
class Template:
    """A program with places for what differs from copy to copy.

    ``path`` begins with the folder of its origin. ``parts`` are what precedes the first routine,
    and the routines.
    """

    path: PurePosixPath
    parts: tuple[str, ...]

    def copy(self, digits: Sequence[str], suffix: str, chance: random.Random) -> str:
        """Return the program with ``digits[d]`` for digit ``d``, and ``suffix`` behind its names.

        Some routines after the first are left out, as ``chance`` has it.
        """
        text = "".join(
            part
            for number, part in enumerate(self.parts)
            if number < 2 or chance.random() >= _LEFT_OUT
        )
        return text.translate(
            {_SUFFIX: suffix, **{_DIGIT + digit: new for digit, new in enumerate(digits)}}
        )


def templates(files: Iterable[SourceFile], finder: FailureFinder) -> Iterator[Template]:
    """Yield a template for each program that has a name; without one, copies could be the same.

    Words that the grammar or the language reserves keep their spelling.
    """
    lexer = finder.recognizer.lexer

    def placed(found: re.Match[str]) -> str:
        piece = found[0]
        if found["number"]:
            return piece.translate(_TO_PLACES)
        if not found["name"] or piece.upper() in _BLOCK_WORDS:
            return piece
        return piece if lexer.is_keyword(lexer.kinds[piece]) else piece + chr(_SUFFIX)

    for file in files:
        failing = {failure.line for failure in finder.find(file.text)}
        lines = source_lines(file.text)
        text = "\n".join(
            line if number in failing else _PIECE.sub(placed, line)
            for number, line in enumerate(lines, 1)
        )
        if chr(_SUFFIX) in text:
            cuts = [0, *(found.start() for found in _ROUTINE.finditer(text)), len(text)]
            parts = tuple(text[start:end] for start, end in pairwise(cuts))
            yield Template(PurePosixPath(place(file.path, file.found.origin)), parts)


def write_copies(chosen: Sequence[Template], folder: Path, size: int, seed: int) -> None:
    """Write copies below ``folder`` until they have ``size`` bytes or a little more.

    Each origin is copied as a whole, so that files which belong together stay together. The same
    templates, size and seed give the same files. Raises ValueError without templates.
    """
    if not chosen:
        raise ValueError("there is no name in them")
    written = 0
    for number in count(1):
        chance = random.Random(f"{seed} {number}")
        digits = list("0123456789")
        chance.shuffle(digits)
        for template in chosen:
            origin, *folders = template.path.parent.parts
            stem = template.path.stem
            stem = stem if stem.startswith("$") else f"{stem}_{number}"  # as in the text
            name = stem + template.path.suffix
            file = folder.joinpath(f"{origin}_{number}", *folders, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            data = template.copy(digits, f"_{number}", chance).encode()
            file.write_bytes(data)
            written += len(data)
            if written >= size:
                return
