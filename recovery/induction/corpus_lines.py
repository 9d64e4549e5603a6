"""The distinct lines of a corpus, each with the files and origins that contain it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from random import Random

from grammar.parser.lexer import Lexer
from recovery.induction.language import CorpusFile
from recovery.proposals.blocks import lines_of


def drawn_origins(files: Sequence[CorpusFile], part: float, seed: int) -> tuple[str, ...]:
    """Return the origins to hold out, drawn by a seed and sorted.

    ``part`` is a share of the origins, or from 1 on how many files to hold out at least.
    """
    sizes = Counter(origin for file in files for origin in file.origins)
    origins = sorted(sizes)
    Random(seed).shuffle(origins)
    held = origins[: round(len(origins) * part)] if part < 1 else []
    left = len(files) - part
    for origin in origins if part >= 1 else ():
        if sizes[origin] > left:
            held.append(origin)
        else:
            left -= sizes[origin]
    return tuple(sorted(held))


def held_out(
    files: Sequence[CorpusFile], origins: Iterable[str]
) -> tuple[tuple[CorpusFile, ...], tuple[CorpusFile, ...]]:
    """Return the shown files and those of the held-out ``origins``.

    A content that also occurs in a shown origin is shown.
    """
    kept = frozenset(origins)
    shown = tuple(file for file in files if not file.origins <= kept)
    held = tuple(file for file in files if file.origins <= kept)
    return shown, held


class CorpusLines:
    """Lines as upper-case lexemes without blanks, comments and line ends; empty lines are left out.

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
            for lexemes in lines_of(file.text, lexer):
                line = tuple(map(str.upper, lexemes))
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
