"""Dialects: release, letter case, layout, language and encoding of a cell; no statements."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum

from grammar.generation.choices import Choices, Weighted
from grammar.generation.layout import Layout


class Generation(Enum):
    """A controller generation; the value is the release that its inline forms name."""

    KRC1 = "4.1.5"
    KRC2 = "5.4.27"
    KRC4 = "8.3.48"
    KRC4_SPLINE = "8.6.6"

    @property
    def is_krc4(self) -> bool:
        """Whether its software is KSS 8."""
        return self in (Generation.KRC4, Generation.KRC4_SPLINE)


class Letters(Enum):
    """The letter case of keywords."""

    UPPER = "WHILE"
    LOWER = "while"
    MIXED = "While"


@dataclass(frozen=True, slots=True)
class Dialect(Layout):
    """How the programs of a cell are written, and how its files are stored.

    ``language`` is the language of comments and names.
    """

    generation: Generation = Generation.KRC2
    letters: Letters = Letters.UPPER
    language: str = "en"
    inline_forms: bool = True
    newline: str = "\r\n"
    encoding: str = "cp1252"

    def stored(self, text: str) -> bytes:
        """Return the bytes of a file with this text, whose lines end with a line feed."""
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
    (2, Generation.KRC1), (5, Generation.KRC2), (8, Generation.KRC4), (5, Generation.KRC4_SPLINE)
)
_LETTERS = Weighted((89, Letters.UPPER), (8, Letters.LOWER), (3, Letters.MIXED))
_INDENTS = Weighted((4, ""), (6, "  "), (7, "   "), (2, "    "), (1, "\t"))
_NEWLINES = Weighted((41, "\r\n"), (8, "\n"), (1, "\r"))
_ENCODINGS = Weighted((12, "cp1252"), (5, "utf-8"), (3, "utf-8-sig"))


def a_dialect(choices: Choices) -> Dialect:
    """Return a random dialect for a cell."""
    generation = choices.weighted(_GENERATIONS)
    letters = Letters.UPPER if generation is Generation.KRC1 else choices.weighted(_LETTERS)
    is_spaced = choices.chance(35) and generation is not Generation.KRC1
    return Dialect(
        generation=generation,
        letters=letters,
        language="de" if choices.chance(35) else "en",
        indent=choices.weighted(_INDENTS),
        eq=" = " if is_spaced else "=",
        gap=" " if is_spaced else "",
        comma=", " if is_spaced or choices.chance(20) else ",",
        before=" " if choices.chance(40) else "",
        # programs in small letters are typed, forms come from the panel
        inline_forms=letters is Letters.UPPER and choices.chance(85),
    )


def a_way_to_store(dialect: Dialect, choices: Choices) -> Dialect:
    """Return the dialect with random line ends and encoding, for one file of a backup."""
    return replace(
        dialect, newline=choices.weighted(_NEWLINES), encoding=choices.weighted(_ENCODINGS)
    )
