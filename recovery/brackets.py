"""Brackets: which signs come in pairs, and which of them belong together in a line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

#: The closing bracket of each opening one.
BRACKETS: Mapping[str, str] = {"(": ")", "[": "]", "{": "}"}
CLOSING = frozenset(BRACKETS.values())


def closer_of(texts: Iterable[str], brackets: Mapping[str, str] = BRACKETS) -> int | None:
    """Return the index of the bracket that closes the first text; ``None`` without one.

    ``brackets`` maps each opening bracket to the closing one.
    """
    texts = iter(texts)
    opening = next(texts)
    closing = brackets.get(opening)
    if closing is None:
        return None
    depth = 1
    for place, text in enumerate(texts, 1):
        depth += (text == opening) - (text == closing)
        if not depth:
            return place
    return None


def left_open(texts: Sequence[str]) -> int | None:
    """Return the index of the innermost bracket that is open behind texts; ``None`` without one."""
    closed = 0
    for place in range(len(texts) - 1, -1, -1):
        if texts[place] in CLOSING:
            closed += 1
        elif texts[place] in BRACKETS:
            if not closed:
                return place
            closed -= 1
    return None
