"""Lines as symbols: words and signs, operands as one symbol each, and groups in brackets.

`recovery.forms.symbol_reader` reads them from tokens; `recovery.forms.operand_rules` says
which rules of a grammar read operands.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from recovery.brackets import BRACKETS

#: A token of a line: its kind, and the word it is meant as where the grammar lacks that.
Token = tuple[int, str | None]
#: The text of what is no token.
UNKNOWN = "?"
#: The closing bracket of each opening one, as a rule writes them.
CLOSERS: Mapping[str, str] = {
    f"'{opening}'": f"'{closing}'" for opening, closing in BRACKETS.items()
}


@dataclass(frozen=True, slots=True)
class Operand:
    """The tokens that were read as an operand, or a rule that the grammar has at that place."""

    kinds: tuple[int, ...] = ()
    rule: str = ""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A word or sign with its ``text`` in a rule, an operand, or a group in brackets.

    For a group, ``inside`` are the symbols between its brackets, and ``text`` is the opening one.
    """

    text: str
    operand: Operand | None = None
    inside: tuple[Symbol, ...] | None = None

    @property
    def is_operand(self) -> bool:
        """Whether it is an operand."""
        return self.operand is not None


def texts(line: Iterable[Symbol]) -> tuple[str, ...]:
    """Return the texts of a line's symbols, in order."""
    return tuple(symbol.text for symbol in line)


def all_texts(line: Iterable[Symbol]) -> frozenset[str]:
    """Return the texts of a line's symbols, including those in brackets."""
    return frozenset(texts(_walk(line)))


def _walk(line: Iterable[Symbol]) -> Iterator[Symbol]:
    """Yield the symbols of a line, each group before the symbols in it."""
    for symbol in line:
        yield symbol
        yield from _walk(symbol.inside or ())


def operands_of(lines: Iterable[tuple[Symbol, ...]]) -> list[tuple[int, ...]]:
    """Return the distinct operands of lines and of their groups, as kinds of token."""
    operands = (symbol.operand for line in lines for symbol in _walk(line))
    return list(dict.fromkeys(operand.kinds for operand in operands if operand))
