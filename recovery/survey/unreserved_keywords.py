"""Unreserved keywords: keywords that a grammar lacks and reads as names, without a failure.

Remove ``TRUE`` from a grammar and every program still parses, because the word becomes a variable.
No failure shows it, but its uses do: programs of several origins read it, and none declares,
assigns, calls or indexes it. A real variable is bound somewhere.
"""

from __future__ import annotations

import sqlite3
from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

from grammar.parser.lexer import Lexer
from recovery.tuning import SEVERAL_FILES, SEVERAL_ORIGINS


@dataclass(frozen=True, slots=True)
class UnreservedKeyword:
    """A word that is read but never bound; ``files`` and ``origins`` count where it is read."""

    word: str
    files: int
    origins: int


class NameUse(NamedTuple):
    """The names of a program that parses, in upper case: those only read, and those bound."""

    read: tuple[str, ...] = ()
    bound: tuple[str, ...] = ()


def names_used(text: str, lexer: Lexer) -> NameUse:
    """Return how a program that parses uses its names."""
    name = lexer.name_kind
    lexemes = [lexeme for lexeme in lexer.lexemes(text) if lexeme]
    kinds = [lexer.kinds[lexeme] for lexeme in lexemes]
    read: set[str] = set()
    bound: set[str] = set()
    for place, kind in enumerate(kinds):
        if kind == name:
            before = lexemes[place - 1] if place else "\n"
            after = lexemes[place + 1] if place + 1 < len(lexemes) else "\n"
            is_read = _is_read(before, after, place == 0 or kinds[place - 1] == name)
            (read if is_read else bound).add(lexemes[place].upper())
    return NameUse(tuple(sorted(read - bound)), tuple(sorted(bound)))


class UnreservedKeywords:
    """Counts how programs use names, and lists those that are read and never bound."""

    #: Uses that are counted in memory before they are added to those on disk.
    MOST_IN_MEMORY = 50_000
    #: Stands for an origin: the word is bound somewhere.
    BOUND = 0

    def __init__(self) -> None:
        self._origins: dict[str, int] = {}
        self._recent: Counter[tuple[str, int]] = Counter()
        self._base = sqlite3.connect("")  # a temporary file, once it is large
        self._base.executescript(
            """
            PRAGMA journal_mode = OFF;
            CREATE TABLE used (word BLOB, origin INTEGER, files INTEGER,
                PRIMARY KEY (word, origin)) WITHOUT ROWID;
            """
        )

    def add(self, origin: str, used: NameUse) -> None:
        """Count the names of one program."""
        number = self._origins.setdefault(origin, len(self._origins) + 1)
        self._recent.update([(word, self.BOUND) for word in used.bound])
        self._recent.update([(word, number) for word in used.read if not word.startswith("$")])
        if len(self._recent) > self.MOST_IN_MEMORY:
            self._move_to_disk()

    def _move_to_disk(self) -> None:
        self._base.executemany(
            "INSERT INTO used VALUES (?, ?, ?)"
            " ON CONFLICT DO UPDATE SET files = files + excluded.files",
            sorted(
                (word.encode("utf-8", "surrogatepass"), origin, files)
                for (word, origin), files in self._recent.items()
            ),
        )
        self._recent.clear()

    def found(self) -> tuple[UnreservedKeyword, ...]:
        """Return the suspected keywords, the most widely used first; nothing can be added then."""
        self._move_to_disk()
        needed = SEVERAL_ORIGINS if len(self._origins) > 1 else 1
        rows = self._base.execute(
            "SELECT word, SUM(files), COUNT(*) FROM used GROUP BY word"
            f" HAVING MIN(origin) > {self.BOUND} AND SUM(files) >= ? AND COUNT(*) >= ?",
            (SEVERAL_FILES, needed),
        )
        found = [
            UnreservedKeyword(word.decode("utf-8", "surrogatepass"), files, origins)
            for word, files, origins in rows
        ]
        self._base.close()
        return tuple(sorted(found, key=lambda s: (-s.origins, -s.files, s.word)))


def _is_read(before: str, after: str, behind_name: bool) -> bool:
    """Return whether a name is used as a value: after an operator, a bracket or a word like WHEN.

    A name at the start of a line, after a type, a dot or DECL, or before ``=``, ``(``, ``[`` or a
    dot is bound, or part of something that is.
    """
    if behind_name or not before.strip() or before in (".", ":", "{"):
        return False
    if after in ("(", "[", ".", "=", ":"):
        return False
    return not before[-1].isalnum() or before.upper() in _VALUE_FOLLOWS


_VALUE_FOLLOWS = frozenset(
    {"AND", "OR", "EXOR", "NOT", "IF", "WHILE", "UNTIL", "FOR", "TO", "SEC", "RETURN", "CASE"}
)
