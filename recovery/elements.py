"""The text of an alternative as elements, and what is written where texts differ."""

from __future__ import annotations

import re

__all__ = ["bare", "choices", "elements", "is_word", "wider"]

_PIECES = re.compile(r"'(?:[^'\\]|\\.)*'[?*+]?|\(|\)[?*+]?|[^\s()]+")
_SUFFIXES = "?*+"


def elements(text: str) -> list[str]:
    """The elements of a text, each group in brackets taken for one."""
    out: list[str] = []
    depth = 0
    for piece in _PIECES.findall(text):
        if not depth:
            out.append(piece)
        else:
            is_glued = out[-1].endswith("(") or piece[0] == ")"
            out[-1] += piece if is_glued else f" {piece}"
        depth += (piece == "(") - (piece[0] == ")")
    return out


def choices(element: str) -> list[str]:
    """The words of a choice, or the one word that is none."""
    is_choice = element[0] == "(" and element[-1] == ")"
    return element[1:-1].split(" | ") if is_choice else [element]


def is_word(text: str) -> bool:
    """Whether a text is a word that the grammar has, or might have, as a keyword."""
    return text.isidentifier() and text.isupper() and text != "NAME"


def bare(element: str) -> str:
    """An element without what says how often it may come."""
    return element.rstrip(_SUFFIXES)


def wider(one: str, other: str) -> str:
    """Of elements that differ in how often they may come, one that may come as often as both."""
    signs = {e[-1] if e[-1] in _SUFFIXES else "" for e in (one, other)}
    if len(signs) == 1:
        return one
    if "*" in signs or signs == {"+", "?"}:
        return f"{bare(one)}*"
    return f"{bare(one)}+" if "+" in signs else f"{bare(one)}?"
