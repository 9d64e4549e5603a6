"""Whole programs under an edit: how far past its first failure can a file be read?

A line can be read and the file still not: the edit may have let it in at the wrong place, once
where it comes again, or without what belongs to it on later lines. So the best edits for a line
are tried on some of the files that fail there first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from grammar.recognizer import Recognizer

__all__ = ["WholeFiles"]

_MOST_FILES = 12
_MOST_TOKENS = 6_000


class WholeFiles:
    """Files by the line that fails first in them; read when they are first asked for."""

    def __init__(
        self, recognizer: Recognizer, starting: Mapping[int, Sequence[Callable[[], str]]]
    ) -> None:
        """``starting`` has for the number of a line what gives the texts that fail there first."""
        self._recognizer = recognizer
        self._starting = starting
        self._texts: dict[int, list[tuple[str, list[int], int]]] = {}

    def texts(self, lines: Iterable[int]) -> list[str]:
        """Some of the texts that fail first at one of the lines."""
        return [text for text, _, _ in self._of(lines)]

    def share(self, wider: Recognizer, lines: Iterable[int]) -> float:
        """How much can be read of what lies behind first failures, on average; from 0 to 1.

        1 where there are no files to be tried.
        """
        shares = []
        for text, kinds, failed in self._of(lines):
            same = wider.lexer is self._recognizer.lexer
            _, index = wider.run(wider.start, kinds if same else wider.kinds(text))
            read = len(kinds) if index is None else index
            shares.append(max(0, read - failed) / (len(kinds) - failed))
        return sum(shares) / len(shares) if shares else 1.0

    def _of(self, lines: Iterable[int]) -> list[tuple[str, list[int], int]]:
        out: list[tuple[str, list[int], int]] = []
        for line in lines:
            if line not in self._texts:
                self._texts[line] = [
                    entry for give in self._starting.get(line, ()) for entry in self._read(give())
                ]
            out += self._texts[line]
            if len(out) >= _MOST_FILES:
                break
        return out[:_MOST_FILES]

    def _read(self, text: str) -> list[tuple[str, list[int], int]]:
        """The text with its kinds and where it fails; nothing where it is too long to be tried."""
        kinds = self._recognizer.kinds(text)
        if len(kinds) > _MOST_TOKENS:
            return []
        _, failed = self._recognizer.run(self._recognizer.start, kinds)
        return [] if failed is None else [(text, kinds, failed)]
