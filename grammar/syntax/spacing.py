"""Spacing of tokens: the blank before and after each, and its letter case.

What the style says nothing about stays as its author wrote it, but for runs of blanks, which become
one. In declarations, data lists and heads of routines nothing changes between tokens: they are
often set as tables, or by the templates of the controller.

How real programs are written decided: in 583 public files nearly every ``DELAY=0`` is set tight and
most comparisons are not, while parentheses, calls and products are set in both ways.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import Enum
from typing import NamedTuple

from grammar.parser.lexer import Lexer
from grammar.parser.tree import Outline

# Memory stays flat on corpora of any size.
_MOST_REMEMBERED = 200_000
_WIDEST_REMEMBERED = 1_000


class Gap(Enum):
    """What a token asks for on one of its sides."""

    AS_WRITTEN = "as written"
    NONE = "none"
    ONE = "one"
    FREE = "one or none, as written"
    EVEN = "one or none, the same on both sides"


class Setting(NamedTuple):
    """How a token is set; ``is_upper`` where it is a keyword."""

    before: Gap
    after: Gap
    is_upper: bool


_OPERATORS = frozenset("OR B_OR EXOR B_EXOR AND B_AND".split())
# Keywords that stand for a value, a type, a way to pass a parameter, or a sign.
_OPERANDS = frozenset(
    "literal type predefinedType positionType parameterMode factor name keyword".split()
)
_LISTED = frozenset("place trigger splineItem cyclicSignal".split())


def _gaps(rule: str, above: str, token: str, is_keyword: bool) -> tuple[Gap, Gap]:
    """What a token of ``rule``, itself part of the rule ``above``, asks for on either side."""
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
        """How the tokens of a rule within a line are set; ``as_written`` for tables."""
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
        """How a token is set, given the rules that it lies in from the inside out."""
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
    """The tokens of a line as they are to be set; ``written`` are the blanks before each."""
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
    """The blanks between two tokens; ``evened`` are those of an operator with both sides alike."""
    if Gap.AS_WRITTEN in asked:
        return written
    if Gap.NONE in asked:
        return ""
    if Gap.ONE in asked:
        return " "
    if Gap.EVEN in asked:
        return evened
    return " " if written else ""
