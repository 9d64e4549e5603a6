"""Forms that are too loose: they can be read with fewer operands than any line they come from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set

from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Element, Group, Literal, Reference, Repeat
from recovery.forms.lists import split_at_commas
from recovery.forms.symbols import Symbol, all_texts


def is_loose(form: str, lines: Sequence[Sequence[Symbol]], *, counts_words: bool = False) -> bool:
    """Return whether a form allows fewer operands than any of its lines, with shortest lists.

    Parts that exclude each other can then all be left out. With ``counts_words`` words and signs
    count like operands.
    """
    words = None if counts_words else frozenset[str]().union(*map(all_texts, lines))
    fewest = _fewest(read_rule(f"form : {form} ;").alternatives, words)
    return fewest < min(_operands(line, counts_words=counts_words) for line in lines)


def _operands(line: Sequence[Symbol], *, counts_words: bool) -> int:
    """Return the number of operands up to the first comma of a line, and of groups in brackets."""
    return sum(
        counts_words or s.is_operand
        if s.inside is None
        else _operands(s.inside, counts_words=counts_words) + 2 * counts_words
        for s in split_at_commas(line)[0]
    )


def _fewest(alternatives: Iterable[Alternative], words: Set[str] | None) -> int:
    """Return the number of operands in the alternative with the fewest; ``words`` are none.

    Without ``words``, everything counts.
    """
    return min(sum(_fewest_of(e, words) for e in a.elements) for a in alternatives)


def _fewest_of(element: Element, words: Set[str] | None) -> int:
    match element:
        case Repeat(item=item, operator="+"):
            return _fewest_of(item, words)
        case Group(alternatives=alternatives):
            return _fewest(alternatives, words)
        case Reference(name=name):
            return int(words is None or name not in words)
        case Literal():
            return int(words is None)
        case _:
            return 0
