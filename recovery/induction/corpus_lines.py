"""The distinct lines of a corpus, each with the files and origins that contain it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from functools import cached_property
from random import Random

from grammar.parser.lexer import Lexer
from recovery.induction.language import CorpusFile
from recovery.proposals.blocks import lines_of
from recovery.tuning import INNER_SHARE


def drawn_origins(files: Sequence[CorpusFile], fraction: float, seed: int) -> tuple[str, ...]:
    """Return the origins to hold out, drawn by a seed and sorted."""
    origins = sorted({origin for file in files for origin in file.origins})
    Random(seed).shuffle(origins)
    return tuple(sorted(origins[: round(len(origins) * fraction)]))


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

    @cached_property
    def inner_words(self) -> frozenset[str]:
        """Lexemes that often stand behind the first one of a line, as names of types do."""
        first = Counter(line[0] for line in self.lines)
        later = Counter(word for line in self.lines for word in line[1:])
        return frozenset(word for word in first if later[word] >= INNER_SHARE * first[word])
