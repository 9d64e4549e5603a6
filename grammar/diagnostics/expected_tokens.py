"""What could have stood at a failure, in words: forty tokens are told as "a value".

The expected set of the recogniser is exact and long. What people call by one word gets that word;
what is left is listed.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

__all__ = ["NAMES", "STATEMENTS", "in_words"]

_TYPES = "INT REAL BOOL CHAR".split()
_POSITION_TYPES = "FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split()
#: Tokens that are names: NAME, and keywords that mean something in one place only.
NAMES = frozenset(
    "NAME DELAY DISTANCE SEC IN OUT IS STEP ENABLE DISABLE F FF PRIO PATH ONSTART MINIMUM MAXIMUM "
    "CA START PART STOP FLT".split()
) | frozenset(_POSITION_TYPES)
_VALUES = NAMES | frozenset(
    "INTEGER REAL_NUMBER BIT_STRING STRING ENUM_CONSTANT TRUE FALSE ( { + - NOT B_NOT".split()
)
_OPERATORS = frozenset("+ - * / : == <> < > AT_MOST AT_LEAST AND OR EXOR B_AND B_OR B_EXOR".split())
_CRITERIA = frozenset("C_PTP C_DIS C_ORI C_VEL".split())
_DECLARATIONS = frozenset(
    "DECL GLOBAL ENUM STRUC SIGNAL EXT EXTP EXTFCT EXTFCTP CHANNEL IMPORT CONST".split()
) | frozenset(_TYPES)
#: The words that open a statement of a routine.
STATEMENTS = frozenset(
    "ANIN ANOUT ASYPTP BRAKE CIRC CIRC_REL CONFIRM CONTINUE DIGIN EXIT FOR GOTO HALT IF INTERRUPT "
    "LIN LIN_REL LOOP MOVE_EMI ON_ERROR_PROCEED PTP PTP_REL PTP_SPLINE REPEAT RESUME RETURN SCIRC "
    "SCIRC_REL SLIN SLIN_REL SPL SPLINE SPL_REL SPTP SPTP_REL SWITCH TRIGGER WAIT WHILE".split()
)
#: Which words tell that a group is meant, what belongs to it, and what it is called, in the order
#: in which they are tried.
_GROUPS: tuple[tuple[frozenset[str], frozenset[str], str], ...] = (
    (frozenset({"NAME", "THEN", "ENDIF", "LIN"}), frozenset(), "a name"),
    (
        frozenset({"LIN", "HALT"}),
        STATEMENTS | _DECLARATIONS | NAMES | {"NEWLINE"},
        "a statement",
    ),
    (
        frozenset({"STRUC", "SIGNAL", "DECL"}),
        _DECLARATIONS | NAMES | {"NEWLINE"},
        "a declaration",
    ),
    (frozenset({"INTEGER", "NAME"}), _VALUES, "a value"),
    (frozenset({"INTEGER", "STRING"}), _VALUES, "a constant"),
    (frozenset({"NAME", "(", "{"}), NAMES | {"(", "{"}, "a position"),
    (frozenset({"INT", "NAME"}), frozenset(_TYPES) | NAMES, "a type"),
    (frozenset({"INT"}), frozenset(_TYPES) | frozenset(_POSITION_TYPES), "a predefined type"),
    (frozenset({"NAME"}), NAMES, "a name"),
    (frozenset({"*", "=="}), _OPERATORS, "an operator"),
    (_CRITERIA, _CRITERIA, "an approximation such as C_DIS"),
)
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
# Longer lists help nobody.
_MOST = 8


@cache
def in_words(expected: tuple[str, ...]) -> str:
    """The tokens that could have come, as people say it; empty where there are none."""
    left = dict.fromkeys(expected)
    left.pop("HEADER", None)
    words = []
    for signs, members, word in _GROUPS:
        if signs <= left.keys():
            left = {t: None for t in left if not _is_member(t, members)}
            words.append(word)
    last = [token for token in _LAST if token in left]
    listed = [token for token in left if token not in _LAST]
    return _joined([*map(_word, listed), *words, *map(_word, last)])


def _is_member(token: str, members: frozenset[str]) -> bool:
    """Whether a token belongs to a group; one without members has all words."""
    return token in members if members else token[0].isalpha()


def _word(token: str) -> str:
    return _WORDS.get(token) or (token if token[0].isalpha() else f'"{token}"')


def _joined(words: Iterable[str]) -> str:
    each = list(dict.fromkeys(words))
    if len(each) > _MOST:
        return ", ".join(each[:_MOST]) + " …"
    return " or ".join(filter(None, (", ".join(each[:-1]), each[-1]))) if each else ""
