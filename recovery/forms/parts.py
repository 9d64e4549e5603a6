"""The parts of a sequence as a rule writes it."""

from __future__ import annotations

import re

_PIECES = re.compile(r"'(?:[^'\\]|\\.)*'|[()]|\s+|[^\s'()]+")


def parts(text: str) -> list[str]:
    """Return the parts of a text, split at blanks outside of parentheses and quotes.

    ``LIN target ('.' NAME)*`` has three parts.
    """
    out = [""]
    depth = 0
    for piece in _PIECES.findall(text):
        depth += (piece == "(") - (piece == ")")
        if piece.isspace() and not depth:
            out.append("")
        else:
            out[-1] += piece
    return [part for part in out if part]
