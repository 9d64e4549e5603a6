"""Trial of an edit on whole files: how far they can be read, and which failures disappear.

A line may be readable and its file still not: the edit may accept it at the wrong place, only once
although it is repeated, or without the lines that belong to it. So the best edits for a line are
tried on some files that fail there first. Conversely, a line that fails only because an earlier
line was not understood can be read once that one is; it then has the same cause.
"""

from __future__ import annotations

from array import array
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery import tuning


@dataclass(frozen=True, slots=True)
class FailingFile:
    """A file with failing lines.

    ``at`` are the lines that fail by themselves, in order, by their number in the file (from 1),
    and ``lines`` the numbers of these failing lines. ``text`` returns the text when it is needed.
    """

    digest: str
    size: int
    text: Callable[[], str]
    at: Sequence[int]
    lines: Sequence[int]

    @property
    def failing(self) -> Iterator[tuple[int, int]]:
        """The failing lines, each with its number in the file."""
        return zip(self.at, self.lines, strict=True)


class FileTrial:
    """Tries edits on the files in which lines fail; a file is read when it is needed."""

    def __init__(self, recognizer: Recognizer, files: Iterable[FailingFile] = ()) -> None:
        self._recognizer = recognizer
        self._files = sorted(files, key=lambda file: (file.size, file.digest))
        self._texts: dict[int, list[tuple[str, list[int], int]]] = {}
        # of each line the indices of its files and its numbers in them, by turns
        self._occurrences: dict[int, array[int]] = defaultdict(partial(array, "l"))
        self._starting: dict[int, list[int]] = defaultdict(list)
        for place, file in enumerate(self._files):
            self._starting[file.lines[0]].append(place)
            for at, line in file.failing:
                self._occurrences[line].extend((place, at))

    def texts(self, lines: Iterable[int]) -> list[str]:
        """Return some of the texts whose first failure is one of the lines."""
        return [text for text, _, _ in self._of(lines)]

    def readable_share(self, wider: Recognizer, lines: Iterable[int]) -> float:
        """Return the average share of the text after the first failure that can be read, 0 to 1.

        Returns 1 if there are no files to try.
        """
        shares = []
        for text, kinds, failed in self._of(lines):
            same = wider.lexer is self._recognizer.lexer
            _, index = wider.run(wider.start, kinds if same else wider.kinds(text))
            read = len(kinds) if index is None else index
            shares.append(max(0, read - failed) / (len(kinds) - failed))
        return sum(shares) / len(shares) if shares else 1.0

    def entailed(
        self, wider: Recognizer, mended: Iterable[int], others: Collection[int]
    ) -> frozenset[int]:
        """Return those of the ``others`` that fail only because of lines that ``wider`` repairs.

        They always come after such a line, and no longer fail. Lines in files that are too many or
        too long to be read again are left out.
        """
        first = self._first(mended)
        behind = self.behind(mended, others)
        wanted: dict[int, list[tuple[int, int]]] = {}
        for place in first:
            found = [(at, line) for at, line in self._files[place].failing if line in behind]
            if found:
                wanted[place] = found
        gone: set[int] = set()
        left: set[int] = set()
        finder = FailureFinder(wider)
        length = 0
        for place in sorted(wanted)[: tuning.MOST_REREAD]:
            text = self._files[place].text()
            length += len(text)
            if length > tuning.MOST_REREAD_TEXT or wider.size > tuning.MOST_CORES:
                break
            # the file was removed after the survey, or cannot change the result any more
            if not text or left.issuperset(line for _, line in wanted[place]):
                continue
            failing = {failure.line for failure in finder.find(text)}
            for at, line in wanted[place]:
                (left if at in failing else gone).add(line)
        return frozenset(gone - left)

    def behind(self, mended: Iterable[int], others: Collection[int]) -> frozenset[int]:
        """Return those of the ``others`` that always come after a line that is ``mended``."""
        first = self._first(mended)
        near = {line for place in first for line in self._files[place].lines}
        return frozenset(
            line
            for line in near.intersection(others)
            if all(first.get(place, at) < at for place, at in self._occurrences_of(line))
        )

    def _first(self, lines: Iterable[int]) -> dict[int, int]:
        """Return the files in which the lines occur, with the number of the first one in each."""
        first: dict[int, int] = {}
        for line in lines:
            for place, at in self._occurrences_of(line):
                first[place] = min(at, first.get(place, at))
        return first

    def _occurrences_of(self, line: int) -> Iterator[tuple[int, int]]:
        """Yield the index of a file and the number in it for each place where a line fails."""
        turns = iter(self._occurrences[line])
        return zip(turns, turns, strict=True)

    def _of(self, lines: Iterable[int]) -> list[tuple[str, list[int], int]]:
        out: list[tuple[str, list[int], int]] = []
        for line in lines:
            if line not in self._texts:
                places = self._starting.get(line, ())[: tuning.FILES_PER_LINE]
                texts = [self._files[place].text() for place in places]
                self._texts[line] = [entry for text in texts for entry in self._read(text)]
            out += self._texts[line]
            if len(out) >= tuning.MOST_FILES:
                break
        return out[: tuning.MOST_FILES]

    def _read(self, text: str) -> Sequence[tuple[str, list[int], int]]:
        """Return the text with its token kinds and first failure; nothing if it is too long."""
        kinds = self._recognizer.kinds(text)
        if len(kinds) > tuning.MOST_FILE_TOKENS:
            return []
        _, failed = self._recognizer.run(self._recognizer.start, kinds)
        return [] if failed is None else [(text, kinds, failed)]
