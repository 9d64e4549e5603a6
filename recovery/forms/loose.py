"""Forms that are too loose: they can be read with fewer operands than any line they come from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set

from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Element, Group, Reference, Repeat
from recovery.forms.lists import split_at_commas
from recovery.forms.symbols import Symbol, all_texts


def is_loose(form: str, lines: Sequence[Sequence[Symbol]]) -> bool:
    """Return whether a form allows fewer operands than any of its lines, with shortest lists.

    Parts that exclude each other can then all be left out.
    """
    words = frozenset[str]().union(*map(all_texts, lines))
    return _fewest(read_rule(f"form : {form} ;").alternatives, words) < min(map(_operands, lines))


def _operands(line: Sequence[Symbol]) -> int:
    """Return the number of operands up to the first comma of a line, and of groups in brackets."""
    first = split_at_commas(line)[0]
    return sum(s.is_operand if s.inside is None else _operands(s.inside) for s in first)


def _fewest(alternatives: Iterable[Alternative], words: Set[str]) -> int:
    """Return the number of operands in the alternative with the fewest; ``words`` are none."""
    return min(sum(_fewest_of(e, words) for e in a.elements) for a in alternatives)


def _fewest_of(element: Element, words: Set[str]) -> int:
    match element:
        case Repeat(item=item, operator="+"):
            return _fewest_of(item, words)
        case Group(alternatives=alternatives):
            return _fewest(alternatives, words)
        case Reference(name=name):
            return int(name not in words)
        case _:
            return 0
