"""Spacing of tokens: the blanks before and after each, and its letter case.

If the style has no rule, the spacing stays as it was written, except that runs of blanks become
one. In declarations, data lists and heads of routines nothing changes between tokens: these are
often laid out as tables, or by templates of the controller.

The style follows real programs: in 583 public files nearly every ``DELAY=0`` has no blanks and most
comparisons have them, while parentheses, calls and products occur in both ways.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import Enum
from typing import NamedTuple

from grammar.parser.lexer import Lexer
from grammar.parser.tree import Outline

# Bounds of the cache.
_MOST_REMEMBERED = 200_000
_WIDEST_REMEMBERED = 1_000


class Gap(Enum):
    """The spacing that a token needs on one of its sides."""

    AS_WRITTEN = "as written"
    NONE = "none"
    ONE = "one"
    FREE = "one or none, as written"
    EVEN = "one or none, the same on both sides"


class Setting(NamedTuple):
    """The spacing of a token; ``is_upper`` if it is a keyword."""

    before: Gap
    after: Gap
    is_upper: bool


_OPERATORS = frozenset("OR B_OR EXOR B_EXOR AND B_AND".split())
# Rules whose keywords are values, types, parameter modes, signs or names.
_OPERANDS = frozenset(
    "literal type predefinedType positionType parameterMode factor name keyword".split()
)
_LISTED = frozenset("place trigger splineItem cyclicSignal".split())


def _gaps(rule: str, above: str, token: str, is_keyword: bool) -> tuple[Gap, Gap]:
    """Return the spacing of a token before and after; ``rule`` is its rule, ``above`` the next."""
    match token:
        case "COMMA":
            return Gap.NONE, Gap.FREE
        case "DOT":
            return Gap.NONE, Gap.NONE
        case "ASSIGN" if rule in _LISTED:
            return Gap.NONE, Gap.NONE
        case "ASSIGN" if rule == "forStatement" or above == "simpleStatement":
            return Gap.ONE, Gap.ONE
        case "PLUS" | "MINUS" if rule in ("factor", "constant"):
            return Gap.FREE, Gap.NONE
    if rule == "relation" or token in _OPERATORS or (is_keyword and rule not in _OPERANDS):
        return Gap.ONE, Gap.ONE
    if rule in ("sum", "product"):
        return Gap.EVEN, Gap.EVEN
    return Gap.FREE, Gap.FREE


class Spacing:
    """Spacing of the tokens of a line, cached for each outline."""

    def __init__(self, lexer: Lexer) -> None:
        self._lexer = lexer
        self._known: dict[tuple[Outline, bool], tuple[Setting, ...]] = {}

    def line(self, outline: Outline, *, as_written: bool) -> tuple[Setting, ...]:
        """Return the spacing of the tokens of a rule within a line; ``as_written`` for tables."""
        found = self._known.get((outline, as_written))
        if found is None:
            found = tuple(self._walk(outline, as_written))
            if outline.width <= _WIDEST_REMEMBERED:
                if len(self._known) >= _MOST_REMEMBERED:
                    self._known.clear()
                self._known[outline, as_written] = found
        return found

    def token(
        self, kind: int, rule: str, above: str = "", beyond: str = "", *, as_written: bool = False
    ) -> Setting:
        """Return the spacing of a token, given the rules around it from the innermost outwards."""
        is_keyword = self._lexer.is_keyword(kind)
        is_upper = is_keyword and rule not in ("name", "keyword")
        if rule == "positionType" and above == "name":  # a type by its place, or a plain name
            is_upper = beyond == "type"
        if as_written:
            return Setting(Gap.AS_WRITTEN, Gap.AS_WRITTEN, is_upper)
        return Setting(*_gaps(rule, above, self._lexer.names[kind], is_keyword), is_upper)

    def _walk(self, outline: Outline, as_written: bool) -> Iterator[Setting]:
        todo: list[tuple[Outline | int, str, str, str]] = [(outline, "", "", "")]
        while todo:
            here, rule, above, beyond = todo.pop()
            if isinstance(here, Outline):
                todo += [(child, here.rule, rule, above) for child in reversed(here.children)]
            else:
                yield self.token(here, rule, above, beyond, as_written=as_written)


def set_line(lexemes: Sequence[str], settings: Sequence[Setting], written: Sequence[str]) -> str:
    """Return the text of a line with its spacing; ``written`` are the blanks before each token."""
    out: list[str] = []
    evened = ""
    for place, (lexeme, setting) in enumerate(zip(lexemes, settings, strict=True)):
        if place:
            asked = settings[place - 1].after, setting.before
            if setting.before is Gap.EVEN:
                evened = " " if written[place] or written[place + 1] else ""
            out.append(_gap(asked, written[place], evened))
        out.append(lexeme.upper() if setting.is_upper else lexeme)
    return "".join(out)


def _gap(asked: tuple[Gap, Gap], written: str, evened: str) -> str:
    """Return the blanks between two tokens; ``evened`` are those around a balanced operator."""
    if Gap.AS_WRITTEN in asked:
        return written
    if Gap.NONE in asked:
        return ""
    if Gap.ONE in asked:
        return " "
    if Gap.EVEN in asked:
        return evened
    return " " if written else ""
