"""Unreserved keywords: words that a grammar lacks and reads as names without any failure.

Take ``TRUE`` out of a grammar and every program still parses: the word becomes a variable. No
failure shows it, but its uses do: programs of several origins read it, and none declares it,
assigns it, calls it or indexes it. Real variables are bound somewhere.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from grammar.parser.lexer import Lexer
from recovery.tuning import UNRESERVED_FILES, UNRESERVED_ORIGINS


@dataclass(frozen=True, slots=True)
class UnreservedKeyword:
    """A word that is read everywhere and bound nowhere; ``files`` and ``origins`` count readers."""

    word: str
    files: int
    origins: int


def unreserved_keywords(
    programs: Iterable[tuple[str, str]], lexer: Lexer
) -> list[UnreservedKeyword]:
    """Suspected keywords in programs given as (origin, text), the most read first."""
    name = lexer.name_kind
    files: dict[str, int] = defaultdict(int)
    origins: dict[str, set[str]] = defaultdict(set)
    bound: set[str] = set()
    every: set[str] = set()
    for origin, text in programs:
        every.add(origin)
        lexemes = [lexeme for lexeme in lexer.lexemes(text) if lexeme]
        kinds = [lexer.kinds[lexeme] for lexeme in lexemes]
        read = set()
        for place, kind in enumerate(kinds):
            if kind != name:
                continue
            word = lexemes[place].upper()
            before = lexemes[place - 1] if place else "\n"
            after = lexemes[place + 1] if place + 1 < len(lexemes) else "\n"
            if _is_read(before, after, place == 0 or kinds[place - 1] == name):
                read.add(word)
            else:
                bound.add(word)
        for word in read:
            files[word] += 1
            origins[word].add(origin)
    needed = UNRESERVED_ORIGINS if len(every) > 1 else 1
    found = [
        UnreservedKeyword(word, count, len(origins[word]))
        for word, count in files.items()
        if count >= UNRESERVED_FILES
        and len(origins[word]) >= needed
        and word not in bound
        and not word.startswith("$")
    ]
    return sorted(found, key=lambda s: (-s.origins, -s.files, s.word))


def _is_read(before: str, after: str, behind_name: bool) -> bool:
    """Whether a name is used as a value: behind an operator, a bracket or a word like WHEN.

    A name at the start of a line, behind a type, a dot or DECL, or before ``=``, ``(``, ``[`` or a
    dot is bound there, or part of something that is.
    """
    if behind_name or not before.strip() or before in (".", ":", "{"):
        return False
    if after in ("(", "[", ".", "=", ":"):
        return False
    return not before[-1].isalnum() or before.upper() in _VALUE_FOLLOWS


_VALUE_FOLLOWS = frozenset(
    {"AND", "OR", "EXOR", "NOT", "IF", "WHILE", "UNTIL", "FOR", "TO", "SEC", "RETURN", "CASE"}
)
