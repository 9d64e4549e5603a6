"""Ways of writing KRL: what controllers of a generation write, and what people make of it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum

from grammar.generation.cells.chance import Chance, Weighted

__all__ = ["Dialect", "Generation", "Letters", "a_dialect", "a_way_to_store"]


class Generation(Enum):
    """Of the controller; the value is the release that its inline forms name."""

    KRC1 = "4.1.5"
    KRC2 = "5.4.27"
    KRC4 = "8.3.48"
    KRC4_SPLINE = "8.6.6"

    @property
    def is_krc4(self) -> bool:
        """Whether it has KSS 8."""
        return self in (Generation.KRC4, Generation.KRC4_SPLINE)


class Letters(Enum):
    """How words are written."""

    UPPER = "WHILE"
    LOWER = "while"
    MIXED = "While"


@dataclass(frozen=True, slots=True)
class Dialect:
    """How the programs of a cell are written, and how a file is stored.

    ``gap`` stands around operators, ``eq`` is the equals sign of an assignment, ``before`` stands
    before the parenthesis of a call, ``language`` is that of comments and names.
    """

    generation: Generation
    letters: Letters
    language: str
    indent: str
    eq: str
    gap: str
    comma: str
    before: str
    inline_forms: bool
    newline: str = "\r\n"
    encoding: str = "cp1252"

    def call(self, name: str, arguments: Iterable[str]) -> str:
        """A call as a statement or as part of an expression."""
        return f"{name}{self.before}({self.comma.join(arguments)})"

    def stored(self, text: str) -> bytes:
        """The bytes of a file with this text, whose lines end with a line feed."""
        if self.letters is Letters.LOWER:
            text = _PIECES.sub(_lowered, text)
        elif self.letters is Letters.MIXED:
            text = _WORDS.sub(_capitalised, text)
        if self.newline != "\n":
            text = text.replace("\n", self.newline)
        return text.encode(self.encoding)


_KEYWORDS = """
    BOOL BRAKE CASE CHAR CONST CONTINUE C_DIS C_PTP DECL DEF DEFAULT DEFDAT DEFFCT DO ELSE END
    ENDDAT ENDFCT ENDFOR ENDIF ENDLOOP ENDSWITCH ENDWHILE ENUM EXIT EXT FALSE FOR FRAME GLOBAL GOTO
    HALT IF INT INTERRUPT LIN LIN_REL LOOP PTP PUBLIC REAL REPEAT RETURN SIGNAL STRUC SWITCH THEN
    TO TRIGGER TRUE UNTIL WAIT WHEN WHILE
"""
# Comments, texts and header lines keep their letters, and so do system variables and constants.
_PIECES = re.compile(r'"[^"\n]*"|;[^\n]*|&[^\n]*|[^";&]+')
_WORDS = re.compile(
    rf'"[^"\n]*"|;[^\n]*|&[^\n]*|[$#]\w+|\b(?P<word>{"|".join(_KEYWORDS.split())})\b'
)


def _lowered(found: re.Match[str]) -> str:
    piece = found[0]
    return piece if piece[0] in '";&' else piece.lower()


def _capitalised(found: re.Match[str]) -> str:
    return found["word"].capitalize() if found["word"] else found[0]


_GENERATIONS = Weighted(
    [
        (0.10, Generation.KRC1),
        (0.25, Generation.KRC2),
        (0.40, Generation.KRC4),
        (0.25, Generation.KRC4_SPLINE),
    ]
)
_LETTERS = Weighted([(0.89, Letters.UPPER), (0.08, Letters.LOWER), (0.03, Letters.MIXED)])
_INDENTS = Weighted([(0.2, ""), (0.3, "  "), (0.35, "   "), (0.1, "    "), (0.05, "\t")])
_NEWLINES = Weighted([(0.82, "\r\n"), (0.16, "\n"), (0.02, "\r")])
_ENCODINGS = Weighted([(0.6, "cp1252"), (0.25, "utf-8"), (0.15, "utf-8-sig")])


def a_dialect(chance: Chance) -> Dialect:
    """How one cell is written."""
    generation = chance.draw(_GENERATIONS)
    letters = Letters.UPPER if generation is Generation.KRC1 else chance.draw(_LETTERS)
    spaced = chance.real() < 0.35 and generation is not Generation.KRC1
    return Dialect(
        generation=generation,
        letters=letters,
        language="de" if chance.real() < 0.35 else "en",
        indent=chance.draw(_INDENTS),
        eq=" = " if spaced else "=",
        gap=" " if spaced else "",
        comma=", " if spaced or chance.real() < 0.2 else ",",
        before="" if chance.real() < 0.6 else " ",
        # programs in small letters are typed, forms come from the panel
        inline_forms=letters is Letters.UPPER and chance.real() < 0.85,
    )


def a_way_to_store(dialect: Dialect, chance: Chance) -> Dialect:
    """The same with line ends and an encoding for a single file, as it came to the backup."""
    return replace(dialect, newline=chance.draw(_NEWLINES), encoding=chance.draw(_ENCODINGS))
