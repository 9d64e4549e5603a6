"""The parts of phrases as they are aligned: words and signs, operands, and lists."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from recovery.forms.symbols import Token
from recovery.proposals.phrases import Phraser

Span = tuple[Token, ...]

#: The key of a list of phrases: ``A : IN , B : OUT``.
LIST = "list"


@dataclass(frozen=True, slots=True)
class Part:
    """A keyword or sign, whose text is ``key``; or an operand, a list of operands or of phrases.

    ``spans`` are its tokens, of each item of a list.
    """

    key: str
    spans: tuple[Span, ...]

    @property
    def is_operand(self) -> bool:
        """Whether it is an operand, or a list of them."""
        return not self.key


Row = tuple[Part, ...]


class PartReader:
    """Cuts phrases into parts under one grammar."""

    def __init__(self, phraser: Phraser) -> None:
        self._phraser = phraser
        self._matcher = phraser.matcher
        self._lexer = phraser.recognizer.lexer

    def rows(self, phrases: Collection[Span]) -> list[Row]:
        """Return the distinct phrases as parts, the longest first; none of no part."""
        whole = {self._row(phrase) for phrase in phrases} - {()}
        if any(part.key == "'('" for row in whole for part in row):
            whole = {tuple(self._opened(row)) for row in whole}
        units = {unit for row in whole for unit in _units(self._kinds(row))}
        rows = {self._with_lists(row, units) for row in whole}
        return sorted(rows, key=lambda row: (-len(row), str([(p.key, p.spans) for p in row])))

    def are_alike(self, rows: Sequence[Row]) -> bool:
        """Return whether all rows have the same kinds of parts in the same order."""
        return len(set(map(self._kinds, rows))) == 1

    def _row(self, words: Span) -> Row:
        """Return the parts of a phrase; a list such as ``a , a , a`` is one part."""
        out: list[Part] = []
        spans = self._phraser.segmenter.parts(words) or []
        signs = [self._matcher.sign(span[0]) if len(span) == 1 else None for span in spans]
        for place, (span, sign) in enumerate(zip(spans, signs, strict=True)):
            # a keyword may be an operand (TRUE is a literal); a comma is none
            is_listed = "','" in signs[max(0, place - 1) : place + 2]
            is_word = bool(out) and sign is not None and sign[0] != "'"
            is_operand = is_word and self._phraser.stands_for_a_rule(span, is_listed=is_listed)
            part = Part("" if is_operand else sign or "", (span,))
            if part.is_operand and len(out) > 1 and out[-1].key == "','" and out[-2].is_operand:
                out[-2:] = [Part("", (*out[-2].spans, span))]
            else:
                out.append(part)
        return tuple(out)

    def _opened(self, row: Row) -> Iterator[Part]:
        """Yield the parts of a row; a call becomes a name and its operands in brackets.

        So it is compared with lines that have more in these brackets than a call.
        """
        display = self._lexer.display
        for part in row:
            span = part.spans[0]
            place = next((i for i, (kind, _) in enumerate(span) if display[kind] == "("), 0)
            if len(part.spans) > 1 or not place or display[span[-1][0]] != ")":
                yield part
                continue
            yield Part("", (span[:place],))
            yield Part("'('", (span[place : place + 1],))
            yield from self._row(span[place + 1 : -1]) if place + 2 < len(span) else ()
            yield Part("')'", (span[-1:],))

    def _kinds(self, row: Row) -> tuple[str, ...]:
        """Return what each part is, as items of a list are compared: a sign, a word, an operand."""
        return tuple(
            part.key if part.key[:1] == "'" else "" if self._is_like_a_name(part) else "word"
            for part in row
        )

    def _is_like_a_name(self, part: Part) -> bool:
        """Return whether a part is an operand, or a word where some rule reads a name too."""
        kind, keyword = part.spans[0][0]
        rules_for = self._matcher.rules_for
        shared = rules_for((kind,)) & rules_for((self._lexer.name_kind,))
        return part.is_operand or (keyword is None and bool(shared))

    def _with_lists(self, row: Row, units: Collection[tuple[str, ...]]) -> Row:
        """Return a row in which items of these kinds, and lists of them, are one part."""
        kinds = self._kinds(row)
        for unit in sorted(units, key=lambda unit: (-len(unit), unit)):
            for first in range(len(row) - len(unit) + 1):
                items, end = [], first
                while kinds[end : end + len(unit)] == unit:
                    item = row[end : end + len(unit)]
                    items.append(tuple(token for part in item for token in part.spans[0]))
                    end += len(unit)
                    if kinds[end : end + 1 + len(unit)] != ("','", *unit):
                        break
                    end += 1
                if items:
                    folded = (*row[:first], Part(LIST, tuple(items)), *row[end:])
                    return self._with_lists(folded, units)
        return row


def _units(kinds: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Yield the kinds of items of several parts that come side by side with commas."""
    for comma in (place for place, kind in enumerate(kinds) if kind == "','"):
        for size in range(2, min(comma, len(kinds) - comma - 1) + 1):
            unit = tuple(kinds[comma - size : comma])
            if "','" not in unit and tuple(kinds[comma + 1 : comma + 1 + size]) == unit:
                yield unit
                break
