"""The lines of a corpus, each distinct one once, with the files and origins that have it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from grammar.parser.lexer import EOF, SKIPPED, Lexer
from support.files.decode import decode, digest
from support.files.discovery import Skipped, discover, read

__all__ = ["CorpusFile", "CorpusLines", "held_out", "read_files"]


@dataclass(frozen=True, slots=True)
class CorpusFile:
    """A distinct content: the first of its places, its text, and the origins it comes from."""

    path: str
    text: str
    origins: frozenset[str]


def read_files(roots: Sequence[Path]) -> tuple[CorpusFile, ...]:
    """All KRL source below ``roots``, each content once, in the order of discovery.

    What cannot be read or is no KRL is left out. Raises
    `support.files.discovery.IngestError` where there is nothing.
    """
    places: dict[str, tuple[str, str, set[str]]] = {}
    for found in discover(roots):
        data = found if isinstance(found, Skipped) else read(found)
        if isinstance(data, Skipped):
            continue
        source = decode(data)
        if not isinstance(source, str):
            place = places.setdefault(digest(data), (found.path, source.text, set()))
            place[2].add(found.origin)
    return tuple(CorpusFile(path, text, frozenset(o)) for path, text, o in places.values())


def held_out(
    files: Sequence[CorpusFile], fraction: float, seed: int
) -> tuple[tuple[CorpusFile, ...], tuple[CorpusFile, ...], tuple[str, ...]]:
    """The files shown, those held out, and the origins held out: a fraction, drawn by a seed.

    What an origin that is shown has too is shown.
    """
    origins = sorted({origin for file in files for origin in file.origins})
    Random(seed).shuffle(origins)
    kept = frozenset(origins[: round(len(origins) * fraction)])
    shown = tuple(file for file in files if not file.origins <= kept)
    held = tuple(file for file in files if file.origins <= kept)
    return shown, held, tuple(sorted(kept))


class CorpusLines:
    """Lines as lexemes in upper case, blanks, comments and line ends left out, empty lines too.

    ``of_file[n]`` are the numbers of the lines of file ``n``, in order.
    """

    def __init__(self, files: Sequence[CorpusFile], lexer: Lexer) -> None:
        self.files = files
        self.lines: list[tuple[str, ...]] = []
        self.of_file: list[list[int]] = []
        numbers: dict[tuple[str, ...], int] = {}
        having: dict[int, set[int]] = defaultdict(set)
        for place, file in enumerate(files):
            found = []
            for line in _lines(file.text, lexer):
                number = numbers.setdefault(line, len(numbers))
                if number == len(self.lines):
                    self.lines.append(line)
                having[number].add(place)
                found.append(number)
            self.of_file.append(found)
        self.counts = [len(having[n]) for n in range(len(self.lines))]
        self.origins = [
            frozenset[str]().union(*(files[place].origins for place in having[n]))
            for n in range(len(self.lines))
        ]


def _lines(text: str, lexer: Lexer) -> Iterable[tuple[str, ...]]:
    end = lexer.kind_of.get("NEWLINE", EOF)
    line: list[str] = []
    for lexeme in lexer.lexemes(text):
        kind = lexer.kinds[lexeme]
        if kind == end:
            if line:
                yield tuple(line)
            line = []
        elif kind != SKIPPED:
            line.append(lexeme.upper())
    if line:
        yield tuple(line)
