"""Grammars of which parts of the text are replaced."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from grammar.notation.model import Grammar

#: A replacement in the text of a rule: start, end, new text.
Splice = tuple[int, int, str]


def spliced(grammar: Grammar, changed: Mapping[str, Sequence[Splice]]) -> str:
    """Return the text of a grammar with parts of the named rules replaced."""
    pieces = [grammar.gaps[0]]
    for rule, gap in zip(grammar.rules, grammar.gaps[1:], strict=True):
        text = rule.text
        for start, end, new in sorted(changed.get(rule.name, ()), reverse=True):
            text = text[:start] + new + text[end:]
        pieces += (text, gap)
    return "".join(pieces)
