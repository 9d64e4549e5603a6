"""Unreserved keywords: keywords that a grammar lacks and reads as names, without a failure.

Remove ``TRUE`` from a grammar and every program still parses, because the word becomes a variable.
No failure shows it, but its uses do: programs of several origins read it, and none declares,
assigns, calls or indexes it. A real variable is bound somewhere.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

from grammar.parser.lexer import Lexer
from recovery.tuning import UNRESERVED_FILES, UNRESERVED_ORIGINS


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

    def __init__(self) -> None:
        self._readers: dict[str, Counter[str]] = {}
        self._bound: set[str] = set()
        self._origins: set[str] = set()

    def add(self, origin: str, used: NameUse) -> None:
        """Count the names of one program."""
        self._origins.add(origin)
        for word in used.bound:
            self._bound.add(word)
            self._readers.pop(word, None)
        for word in used.read:
            if word not in self._bound and not word.startswith("$"):
                self._readers.setdefault(word, Counter())[origin] += 1

    def found(self) -> tuple[UnreservedKeyword, ...]:
        """Return the suspected keywords, the most widely used first."""
        needed = UNRESERVED_ORIGINS if len(self._origins) > 1 else 1
        found = [
            UnreservedKeyword(word, readers.total(), len(readers))
            for word, readers in self._readers.items()
            if readers.total() >= UNRESERVED_FILES and len(readers) >= needed
        ]
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
