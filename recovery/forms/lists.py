"""Lists: items with commas between them become one symbol of a line."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from recovery.forms.symbols import Symbol, texts
from recovery.tuning import ITEMS_BEHIND_THE_FIRST

#: The text of the symbol that stands for a list.
LIST = "…"
COMMA = "','"
#: So many items are more than a short list has.
LONG_LIST = ITEMS_BEHIND_THE_FIRST + 2
_EQUALS = "'='"


@dataclass(frozen=True, slots=True)
class FoldedLists:
    """Lines with each list as one symbol, the first items of the lists, and all other items."""

    lines: list[tuple[Symbol, ...]]
    firsts: list[tuple[Symbol, ...]]
    others: list[tuple[Symbol, ...]]


def fold_lists(lines: Sequence[tuple[Symbol, ...]]) -> FoldedLists | None:
    """Return the lines with their lists folded; ``None`` if no line has a comma."""
    cut = [split_at_commas(line) for line in lines]
    others = [piece for _, *behind in cut for piece in behind]
    if not others:
        return None
    items = _Items(others)
    folded = FoldedLists([], [], others)
    for line, (ahead, *behind) in zip(lines, cut, strict=True):
        start = len(ahead) - items.size_at_end(ahead)
        if start == len(ahead) and not behind:  # no list, rather than one without items
            folded.lines.append(line)
        else:
            folded.lines.append((*ahead[:start], Symbol(LIST)))
            folded.firsts.append(ahead[start:])
    return folded


def split_at_commas(line: Sequence[Symbol]) -> list[tuple[Symbol, ...]]:
    """Return the pieces of a line between its commas, at least one."""
    pieces: list[list[Symbol]] = [[]]
    for symbol in line:
        if symbol.text == COMMA:
            pieces.append([])
        else:
            pieces[-1].append(symbol)
    return [tuple(piece) for piece in pieces]


class _Items:
    """The items of lists that are certain because a comma is ahead of them."""

    def __init__(self, items: Iterable[Sequence[Symbol]]) -> None:
        self._known = {texts(item) for item in items}
        self._outlines = {_outline(item) for item in self._known}
        self._texts = {text for item in self._known for text in item}
        self._longest = max(map(len, self._known))
        self._are_set = all(item[:2] == ("", _EQUALS) for item in self._known)

    def size_at_end(self, ahead: Sequence[Symbol]) -> int:
        """Return how many symbols at the end of what is ahead of a comma are the first item."""
        found = texts(ahead)
        if _outline(found) in self._outlines:
            return len(found)
        if len(found) <= self._longest and self._texts.issuperset(found):
            return len(found)
        for size in range(min(self._longest, len(found)), 0, -1):
            if found[len(found) - size :] in self._known:
                # what a single operand is set to belongs to the item
                return 3 if size == 1 and found[-3:-1] == ("", _EQUALS) else size
        # an operand that is set to nothing is an item if those of all other items are set
        is_unset = len(found) > 1 and not found[-1] and _EQUALS not in found
        return int(self._are_set and is_unset)


def _outline(item: Iterable[str]) -> tuple[str, ...]:
    """Return the texts of an item with all words equal, and without what only follows operands."""
    return tuple("word" if text.isupper() else text for text in item if not text.islower())
