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


def choices(word: str) -> list[str]:
    """Return the words of a choice in parentheses, or the single word."""
    return word[1:-1].split(" | ") if word[0] == "(" and word[-1] == ")" else [word]


def unwrapped(text: str) -> str:
    """Return a text without its suffix, and without its parentheses unless these are a choice."""
    core = text.rstrip("?*+")
    inner = core[1:-1] if core[0] == "(" else core
    return core if "|" in parts(inner) else inner
