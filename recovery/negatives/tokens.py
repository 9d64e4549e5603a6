"""A tokenizer for KRL that is independent of any grammar.

It recognises strings, comments, numbers and words, and knows which words are never names.
Everything else is left to the caller.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

#: Words that are never names.
RESERVED = frozenset(
    "AND OR EXOR NOT B_AND B_OR B_EXOR B_NOT IF THEN ELSE ENDIF FOR ENDFOR WHILE ENDWHILE UNTIL "
    "SWITCH CASE ENDSWITCH ENDLOOP DECL DEF DEFFCT ENDFCT DEFDAT ENDDAT GOTO RETURN".split()
)
#: Words that are never names where a line begins; elsewhere they may be (``TIME_BLOCK END=3``).
RESERVED_FIRST = frozenset("END REPEAT LOOP DEFAULT EXIT HALT RESUME".split())

_TOKEN = re.compile(
    r"""(?P<blank>\s+|;.*)
    |(?P<string>"[^"]*")
    |(?P<bits>'[BH][\s0-9A-F]*')
    |(?P<enum>\#\s*[A-Z_$][\w$]*)
    |(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?:E[+-]?\d+)?)
    |(?P<word>[A-Z_$][\w$]*)
    |(?P<sign>==|<>|<=|>=|=>|=<|[-+*/=<>()\[\]{},.:])
    |(?P<other>.)""",
    re.VERBOSE | re.IGNORECASE | re.ASCII,
)
_BEFORE_LEAD = frozenset({"GLOBAL", "DECL"})
_KINDS = dict.fromkeys(("TRUE", "FALSE"), "truth") | dict.fromkeys(
    ("INT", "REAL", "BOOL", "CHAR"), "type"
)
# Constants of an ENUM and members of a STRUC may have any word as their name.
_NAMING = frozenset({"ENUM", "STRUC"})
_LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True, slots=True)
class SourceToken:
    """A token and its position in its line.

    ``kind`` is ``name``, ``number``, ``string``, ``bits``, ``enum``, ``truth``, ``type`` (a
    predefined one), ``other``, the sign itself, or a reserved word in upper case. A word that can
    be a name where it is used has the kind ``name``.
    """

    kind: str
    text: str
    start: int
    end: int

    @property
    def word(self) -> str:
        """The text in upper case."""
        return self.text.upper()


@dataclass(frozen=True, slots=True)
class SourceLine:
    """A line of a file; comments and header lines (``&ACCESS`` …) have no tokens.

    ``lead`` is the word that tells the kind of the line, in upper case: the first one after
    ``GLOBAL`` and ``DECL``, empty if the line begins with something else.
    """

    text: str
    tokens: tuple[SourceToken, ...]
    lead: str

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of the tokens."""
        return tuple(token.kind for token in self.tokens)


def lines(text: str) -> list[SourceLine]:
    """Return the lines of a file with any line ends."""
    return [line(piece) for piece in _LINE_END.split(text)]


@lru_cache(maxsize=1 << 15)
def line(text: str) -> SourceLine:
    """Return one line, given without its line end."""
    if text.lstrip().startswith("&"):
        return SourceLine(text, (), "")
    tokens: list[SourceToken] = []
    lead: str | None = None
    braces = 0
    for found in _TOKEN.finditer(text):
        kind, lexeme = found.lastgroup or "other", found[0]
        if kind == "blank":
            continue
        word = lexeme.upper() if kind == "word" else ""
        if kind == "sign":
            kind = lexeme
            braces += (kind == "{") - (kind == "}")
        elif kind == "word":
            before = tokens[-1].kind if tokens else ""
            is_name = before == "." or lead in _NAMING or (braces and before in ("{", ",", ":"))
            kind = "name" if is_name else _kind(word, is_first=not tokens)
        if lead is None and word not in _BEFORE_LEAD:
            lead = word
        tokens.append(SourceToken(kind, lexeme, found.start(), found.end()))
    return SourceLine(text, tuple(tokens), lead or "")


def _kind(word: str, *, is_first: bool) -> str:
    if word in _KINDS:
        return _KINDS[word]
    if word in RESERVED or (is_first and word in RESERVED_FIRST):
        return word
    return "name"
