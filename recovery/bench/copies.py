"""Synthetic corpora: copies of programs, for more text than there is; never evidence.

A copy keeps the layout, the comments and every kind of token of its program. Its names get a suffix
and its numbers other digits behind the point, and some of its routines are left out: no two copies
are equal, and nothing cached for one saves work on another. Names of components and constants stay,
so a copy is as valid as its program. Lines that fail keep their names, so that a larger corpus has
no other causes of failure.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle, pairwise
from pathlib import Path, PurePosixPath

from grammar.blocks import BLOCKS
from grammar.generation.synthetic_corpus import Written, write_cells
from grammar.notation.krl_grammar import krl_grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from grammar.semantics.predefined import System
from recovery.ledger.evidence import place
from recovery.survey.failing_line import source_lines
from support.files.atomic_write import naming
from support.files.discovery import SourceFile, source_files
from support.parallel.progress import Progress, no_progress

# What may hold digits or words that are no numbers and no names comes first, and stays as it is. So
# do components and constants, and lines that declare them.
_BRACES = r"\{ (?: [^{}] | \{ (?: [^{}] | \{ [^{}]* \} )* \} )* \}"
_PIECE = re.compile(
    rf"""[;&].* | "[^"]*"? | '[^']*'? | (?:[$\#]|(?<!\.)\.[ \t]*)[A-Za-z_]\w*
    | (?P<braces>{_BRACES}) | ^(?=[^;]*\b(?:STRUC|ENUM)\b).* | (?P<name>[A-Za-z_][\w$]*)
    | [0-9]+(?P<fraction>\.[0-9]+)?(?:[Ee][+-]?[0-9]+)?""",
    re.VERBOSE | re.IGNORECASE,
)
_FRACTION = re.compile(r"(?<=[0-9]\.)[0-9]+")
_TYPE = re.compile(r"^[^;\n]*\b(?:STRUC|ENUM)[ \t]+(\w+)", re.IGNORECASE | re.MULTILINE)
# In a template, characters that no text uses mark what differs from copy to copy.
_DIGIT = 0xE000  # to 0xE009
_SUFFIX = 0xE00A
_TO_PLACES = {ord("0") + digit: _DIGIT + digit for digit in range(1, 10)}
_LONGEST = 20  # letters of a name that leave room for a suffix [TYP-05]
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

    Words that the grammar, the language or the controller reserves keep their spelling.
    """
    lexer = finder.recognizer.lexer
    system = System.load()
    programs = list(files)
    types = {name.upper() for file in programs for name in _TYPE.findall(file.text)}
    fixed = types.union(_BLOCK_WORDS, system.functions, system.types)

    def placed(found: re.Match[str]) -> str:
        piece = found[0]
        if found["fraction"] or found["braces"]:
            return _FRACTION.sub(lambda digits: digits[0].translate(_TO_PLACES), piece)
        if not found["name"] or piece.upper() in fixed or len(piece) > _LONGEST:
            return piece
        return piece if lexer.is_keyword(lexer.kinds[piece]) else piece + chr(_SUFFIX)

    for file in programs:
        failing = {failure.line for failure in finder.find(file.text)}
        lines = source_lines(file.text)
        text = "\n".join(
            line if number in failing else _PIECE.sub(placed, line)
            for number, line in enumerate(lines, 1)
        )
        if chr(_SUFFIX) in text:
            cuts = [0, *(found.start() for found in _ROUTINE.finditer(text)), len(text)]
            parts = tuple(text[start:end] for start, end in pairwise(cuts))
            path = PurePosixPath(place(file.path, file.found.origin))
            yield Template(path.with_stem(_PIECE.sub(placed, path.stem)), parts)


def write_corpus(
    roots: Sequence[Path],
    folder: Path,
    size: int,
    seed: int = 1,
    on_bytes: Progress = no_progress,
) -> Written:
    """Write ``size`` bytes below a folder: copies of programs, and a tenth random programs.

    Without ``roots`` all are random. The same programs, size and seed give the same files.
    ``on_bytes`` is called with the size of each file. Raises `IngestError` for a program that
    cannot be read, `ValueError` as `write_copies`, and `OSError`.
    """
    if not roots:
        return write_cells(folder, size, seed, on_bytes)
    chosen = templates(source_files(roots), FailureFinder(Recognizer(krl_grammar())))
    copies = write_copies(chosen, folder, size - size // 10, seed, on_bytes)
    if copies.bytes >= size:
        return copies
    others = write_cells(folder, size - copies.bytes, seed, on_bytes)
    return Written(
        copies.cells + others.cells, copies.files + others.files, copies.bytes + others.bytes
    )


def write_copies(
    chosen: Iterable[Template],
    folder: Path,
    size: int,
    seed: int,
    on_bytes: Progress = no_progress,
) -> Written:
    """Write copies below ``folder`` until they have ``size`` bytes or a little more.

    Each origin is copied as a whole, as a cell, so that files which belong together stay together.
    The same templates, size and seed give the same files. Raises ValueError without templates.
    """
    number = files = written = 0
    cells = set()
    for place_in_round, template in cycle(enumerate(chosen)):
        if place_in_round == 0:
            number += 1
            chance = random.Random(f"{seed} {number}")
            digits = ["0", *chance.sample("123456789", 9)]
        origin, *folders = template.path.parent.parts
        cell = folder / f"{origin}_{number}"
        file = cell.joinpath(*folders, template.path.name.replace(chr(_SUFFIX), f"_{number}"))
        file.parent.mkdir(parents=True, exist_ok=True)
        data = template.copy(digits, f"_{number}", chance).encode()
        with naming(file):
            file.write_bytes(data)
        cells.add(cell)
        files += 1
        written += len(data)
        on_bytes(len(data))
        if written >= size:
            break
    if not files:
        raise ValueError("there is no name in them")
    return Written(len(cells), files, written)
