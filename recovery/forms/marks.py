"""Marks: which symbols of different lines stand in the same place of a form.

A chain has each symbol once, so equal symbols of a line are told apart by what is ahead of them:
the operand after ``TO`` from the one after ``STEP``. Words that other lines lack in the same place
do not count as ahead of anything.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass, replace
from itertools import takewhile

from recovery.forms.lists import LIST
from recovery.forms.symbols import Symbol, texts
from recovery.tuning import LONGEST_SIGNS_AHEAD


@dataclass(frozen=True, slots=True)
class Mark:
    """What identifies a symbol within its line.

    ``text`` is its text, empty for an operand. ``after`` is what is ahead of an operand or sign:
    the last word and the signs behind it. ``number`` counts equal words up to this one, and the
    operands directly behind an operand.
    """

    text: str
    after: str = ""
    number: int = 0


#: A line: its symbols with their marks.
MarkedLine = Sequence[tuple[Mark, Symbol]]


def marked(
    lines: Sequence[Sequence[Symbol]], is_type: Callable[[Symbol], bool]
) -> list[MarkedLine]:
    """Return the lines with marks; ``is_type`` tells which operands are types."""
    optional = _optional_words(lines)
    return _types_first([_marked(line, optional) for line in lines], is_type)


def _optional_words(lines: Sequence[Sequence[Symbol]]) -> set[str]:
    """Return the words without which some line is the same as another one.

    A word ahead of two operands is one, too, if its predecessor is ahead of two in another line.
    """
    shapes = {texts(line) for line in lines}
    # a word with two operands behind it; the lines may end otherwise
    declared = {s[i : i + 3] for s in shapes for i in range(len(s)) if s[i + 1 : i + 3] == ("", "")}
    return {
        text
        for shape in shapes
        for place, text in enumerate(shape)
        if text and text != LIST and not text.startswith("'")
        if (*shape[:place], *shape[place + 1 :]) in shapes
        or (place and (shape[place - 1], *shape[place + 1 : place + 3]) in declared)
    }


def _marked(line: Sequence[Symbol], optional: Set[str]) -> MarkedLine:
    found = []
    after = ""
    counts: Counter[str] = Counter()
    for place, symbol in enumerate(line):
        text = symbol.text
        if symbol.is_operand:
            # of operands side by side the last one is what is always there
            behind = (s for s in line[place + 1 :] if s.text not in optional)
            mark = Mark("", after, sum(1 for _ in takewhile(lambda s: s.is_operand, behind)))
        elif text in optional or text == LIST:
            mark = Mark(text)
        elif text.startswith("'"):
            mark = Mark(text, after)
            after = f"{after} {text}"[-LONGEST_SIGNS_AHEAD:]
        else:
            counts[text] += 1
            mark = Mark(text, number=counts[text])
            after = f"{text}{counts[text]}"
        found.append((mark, symbol))
    return found


def _types_first(
    lines: Sequence[MarkedLine], is_type: Callable[[Symbol], bool]
) -> list[MarkedLine]:
    """Return the lines with operands that stand alone as the first of two, if some are types.

    ``INT :IN`` beside ``INT A :IN`` lacks the name, and not the type.
    """
    double = {mark.after for line in lines for mark, _ in line if mark.number and not mark.text}
    lone = [_lone(line, double) for line in lines]
    typed = {
        mark.after
        for line, marks in zip(lines, lone, strict=True)
        for mark, symbol in line
        if mark in marks and is_type(symbol)
    }
    return [
        [(replace(m, number=1) if m in marks and m.after in typed else m, s) for m, s in line]
        for line, marks in zip(lines, lone, strict=True)
    ]


def _lone(line: MarkedLine, double: Set[str]) -> set[Mark]:
    """Return the operands that stand alone where others are ``double``."""
    operands = {mark for mark, _ in line if not mark.text and mark.after in double}
    counts = Counter(mark.after for mark in operands)
    return {mark for mark in operands if not mark.number and counts[mark.after] == 1}
