"""Expected tokens in words: forty tokens become "a value".

The expected set of the recogniser is exact and long. Groups of tokens with a common name are
replaced by it, and the rest is listed. The members of a group are the FIRST sets of rules of the
grammar.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from functools import cache

from grammar.syntax.build import builder

_Words = frozenset[str]
_WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)


@cache
def _first(rule: str) -> _Words:
    """Return the tokens with which a rule can begin, as they appear in expected sets."""
    recognizer = builder().parser.recognizer
    network, display = recognizer.network, recognizer.lexer.display
    return frozenset(display[kind] for kind in network.reach(network.entry[rule]).first)


def names() -> _Words:
    """Return NAME and the keywords that can also be names."""
    return _first("name")


def is_reserved(word: str) -> bool:
    """Return whether a word in upper case is a keyword that cannot be a name."""
    lexer = builder().parser.recognizer.lexer
    kind = lexer.kinds[word] if _WORD.fullmatch(word) else None
    return kind is not None and lexer.is_keyword(kind) and lexer.names[kind] not in names()


def is_in_place_of_name(word: str, expected: Collection[str]) -> bool:
    """Return whether a token in upper case is a keyword where only a name was expected."""
    is_name = "NAME" in expected and "INTEGER" not in expected and "HALT" not in expected
    return is_name and is_reserved(word)


def statements() -> _Words:
    """Return the keywords that begin a statement but no declaration."""
    return _first("statement") - _first("declaration") - names()


@cache
def _groups() -> tuple[tuple[_Words, _Words, str], ...]:
    """Return triples of the tokens that indicate a group, its members, and its name."""
    criteria = _first("approximation")
    declarations = (_first("declaration") | _first("initialisation")) - names() | {"CONST"}
    line = names() | {"NEWLINE"}
    groups: tuple[tuple[str, Iterable[str], str], ...] = (
        ("NAME THEN ENDIF LIN", (), "a name"),
        ("LIN HALT", statements() | declarations | line, "a statement"),
        ("STRUC SIGNAL DECL", declarations | line, "a declaration"),
        ("INTEGER NAME", _first("expression"), "a value"),
        ("INTEGER STRING", _first("expression"), "a constant"),
        ("NAME ( {", names() | {"(", "{"}, "a position"),
        ("INT NAME", _first("type"), "a type"),
        ("INT", _first("predefinedType"), "a predefined type"),
        ("NAME", names(), "a name"),
        ("* ==", _OPERATORS, "an operator"),
        (" ".join(criteria), criteria, "an approximation such as C_DIS"),
    )
    return tuple((frozenset(signs.split()), frozenset(of), word) for signs, of, word in groups)


_OPERATORS = "+ - * / : == <> < > AT_MOST AT_LEAST AND OR EXOR B_AND B_OR B_EXOR".split()
_WORDS = {
    "NEWLINE": "the end of the line",
    "EOF": "the end of the file",
    "INTEGER": "a number",
    "REAL_NUMBER": "a number",
    "STRING": "a text",
    "BIT_STRING": "a number",
    "ENUM_CONSTANT": "a constant such as #BASE",
    "AT_MOST": '"<="',
    "AT_LEAST": '">="',
}
_LAST = ("NEWLINE", "EOF")
# Longer lists do not help and are cut.
_MOST = 8


@cache
def in_words(expected: tuple[str, ...]) -> str:
    """Return the expected tokens as people say it; empty if there are none."""
    left = dict.fromkeys(expected)
    left.pop("HEADER", None)
    words = []
    for signs, members, word in _groups():
        if signs <= left.keys():
            left = {t: None for t in left if not _is_member(t, members)}
            words.append(word)
    last = [token for token in _LAST if token in left]
    listed = [token for token in left if token not in _LAST]
    return _joined([*map(_word, listed), *words, *map(_word, last)])


def _is_member(token: str, members: frozenset[str]) -> bool:
    """Return whether a token belongs to a group; a group without members has all words."""
    return token in members if members else token[0].isalpha()


def _word(token: str) -> str:
    return _WORDS.get(token) or (token if token[0].isalpha() else f'"{token}"')


def _joined(words: Iterable[str]) -> str:
    each = list(dict.fromkeys(words))
    if len(each) > _MOST:
        return ", ".join(each[:_MOST]) + " …"
    return " or ".join(filter(None, (", ".join(each[:-1]), each[-1]))) if each else ""
