"""Alignment of phrases for a proposal: one phrase that reads several.

Lines of one construct differ in their operands and in their optional parts. They are aligned by
keywords and signs, as a multiple sequence alignment. A column of operands becomes a rule that reads
all of them. Parts that only some lines have become optional, and differing parts become a choice.
``LIN A`` and ``LIN {X 1} C_DIS`` give ``LIN target C_DIS?``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field

from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.collocations import last_two
from recovery.proposals.phrases import Phraser

_Span = tuple[Token, ...]
_Phrases = tuple[tuple[Token, ...], ...]


#: The key of a list of phrases: ``A : IN , B : OUT``.
_LIST = "list"


@dataclass(frozen=True, slots=True)
class _Part:
    """A keyword or sign, whose text is ``key``; or an operand, a list of operands or of phrases.

    ``spans`` are its tokens, of each item of a list.
    """

    key: str
    spans: tuple[_Span, ...]

    @property
    def is_operand(self) -> bool:
        return not self.key


@dataclass(slots=True)
class _Column:
    """Parts of the same kind, by row."""

    key: str
    cells: dict[int, _Part] = field(default_factory=dict)


class Aligner:
    """Aligns phrases under one grammar; caches its results."""

    def __init__(self, phraser: Phraser) -> None:
        self._phraser = phraser
        self._rows: dict[tuple[Token, ...], tuple[_Part, ...]] = {}
        self._columns: dict[_Phrases, tuple[Sequence[_Column], int]] = {}
        self._known: dict[tuple[_Phrases, frozenset[str]], list[tuple[str, ...]]] = {}

    def common_phrases(
        self, phrases: Sequence[Sequence[Token]], near: frozenset[str] = frozenset()
    ) -> list[tuple[str, ...]]:
        """Return phrases of symbols that read all of ``phrases``, the most restrictive first.

        Returns none if the phrases have too little in common.
        """
        key = tuple(map(tuple, phrases))
        found = self._known.get((key, near))
        if found is None:
            if len(self._known) >= tuning.MOST_ALIGNMENTS_KEPT:
                self._known.clear()
                self._columns.clear()
                self._rows.clear()
            if key not in self._columns:
                self._columns[key] = self._aligned(phrases)
            found = list(dict.fromkeys(self._spelled(*self._columns[key], near)))
            self._known[key, near] = found
        return found

    def _spelled(
        self, columns: Sequence[_Column], rows: int, near: frozenset[str]
    ) -> Iterator[tuple[str, ...]]:
        for level in range(tuning.PHRASE_LEVELS if columns else 0):
            narrow = [self._written(column, level, near) for column in columns]
            if all(narrow):
                for written in (_as_usual(self._phraser, columns, narrow, rows), narrow):
                    yield tuple(_grouped(self._phraser, columns, written, rows))

    def _aligned(self, phrases: Sequence[Sequence[Token]]) -> tuple[Sequence[_Column], int]:
        """Return the columns of the phrases and the number of rows; none if they do not align."""
        whole = {self._row(tuple(p)) for p in phrases} - {()}
        if any(part.key == "'('" for row in whole for part in row):
            whole = {tuple(self._opened(row)) for row in whole}
        units = {unit for row in whole for unit in _units(self._kinds(row))}
        cut = {self._with_lists(row, units) for row in whole}
        rows = sorted(cut, key=_by_length)[: tuning.MOST_ALIGNED]
        columns = _columns(self._phraser, rows)
        are_alike = len(set(map(self._kinds, rows))) == 1 or _belong_together(columns, len(rows))
        if len(columns) > tuning.MOST_COLUMNS or not (columns and are_alike):
            return (), 0
        return columns, len(rows)

    def _written(self, column: _Column, level: int, near: frozenset[str]) -> tuple[str, ...]:
        """Return a column as symbols; empty if nothing fits."""
        if column.key != _LIST:
            return _written(self._phraser, column, level, near)
        items = self.common_phrases(_spans(column), near)
        if not items:
            return ()
        item = items[min(level, len(items) - 1)]
        is_long = any(len(part.spans) > 1 for part in column.cells.values())
        return (*item, f"(',' {' '.join(item)})*") if is_long else item

    def _kinds(self, row: Sequence[_Part]) -> tuple[str, ...]:
        """Return what each part is, as items of a list are compared: a sign, a word, an operand."""
        return tuple(
            part.key if part.key[:1] == "'" else "" if self._is_like_a_name(part) else "word"
            for part in row
        )

    def _is_like_a_name(self, part: _Part) -> bool:
        """Return whether a part is an operand, or a word where some rule reads a name too."""
        matcher = self._phraser.matcher
        kind, keyword = part.spans[0][0]
        name = self._phraser.recognizer.lexer.name_kind
        shared = matcher.rules_for((kind,)) & matcher.rules_for((name,))
        return part.is_operand or (keyword is None and bool(shared))

    def _opened(self, row: Sequence[_Part]) -> Iterator[_Part]:
        """Yield the parts of a row; a call becomes a name and its operands in brackets.

        So it is compared with lines that have more in these brackets than a call.
        """
        display = self._phraser.recognizer.lexer.display
        for part in row:
            span = part.spans[0]
            place = next((i for i, (kind, _) in enumerate(span) if display[kind] == "("), 0)
            if len(part.spans) > 1 or not place or display[span[-1][0]] != ")":
                yield part
                continue
            yield _Part("", (span[:place],))
            yield _Part("'('", (span[place : place + 1],))
            yield from self._row(span[place + 1 : -1]) if place + 2 < len(span) else ()
            yield _Part("')'", (span[-1:],))

    def _with_lists(
        self, row: tuple[_Part, ...], units: Collection[tuple[str, ...]]
    ) -> tuple[_Part, ...]:
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
                    folded = (*row[:first], _Part(_LIST, tuple(items)), *row[end:])
                    return self._with_lists(folded, units)
        return row

    def _row(self, words: tuple[Token, ...]) -> tuple[_Part, ...]:
        """Return the parts of a phrase, cached."""
        if words not in self._rows:
            self._rows[words] = tuple(_row(self._phraser, words))
        return self._rows[words]


def _belong_together(columns: Sequence[_Column], rows: int) -> bool:
    """Return whether most columns are in all rows, or the rows are few forms of one first word."""
    in_all = [len(column.cells) == rows for column in columns]
    if 2 * sum(in_all) >= len(columns):
        return True
    forms = {frozenset(column.cells) for column in columns}
    return bool(columns[0].key and in_all[0]) and len(forms) <= tuning.MOST_LINE_SHAPES


def _by_length(row: tuple[_Part, ...]) -> tuple[int, str]:
    return -len(row), str([(p.key, p.spans) for p in row])


def _row(phraser: Phraser, words: Sequence[Token]) -> list[_Part]:
    """Return the parts of a phrase; a list such as ``a , a , a`` is one part."""
    out: list[_Part] = []
    spans = phraser.segmenter.parts(words) or []
    signs = [phraser.matcher.sign(span[0]) if len(span) == 1 else None for span in spans]
    for place, (span, sign) in enumerate(zip(spans, signs, strict=True)):
        # a keyword may be an operand (TRUE is a literal); a comma is none
        is_listed = "','" in signs[max(0, place - 1) : place + 2]
        is_word = bool(out) and sign is not None and sign[0] != "'"
        if is_word and phraser.stands_for_a_rule(span, is_listed=is_listed):
            part = _Part("", (span,))
        else:
            part = _Part(sign or "", (span,))
        if part.is_operand and len(out) > 1 and out[-1].key == "','" and out[-2].is_operand:
            out[-2:] = [_Part("", (*out[-2].spans, span))]
        else:
            out.append(part)
    return out


def _units(kinds: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Yield the kinds of items of several parts that come side by side with commas."""
    for comma in (place for place, kind in enumerate(kinds) if kind == "','"):
        for size in range(2, min(comma, len(kinds) - comma - 1) + 1):
            unit = tuple(kinds[comma - size : comma])
            if "','" not in unit and tuple(kinds[comma + 1 : comma + 1 + size]) == unit:
                yield unit
                break


def _columns(phraser: Phraser, rows: Sequence[tuple[_Part, ...]]) -> list[_Column]:
    """Return the rows aligned in columns; the longest row gives the order."""

    def fits(column: _Column, part: _Part) -> bool:
        """Return whether a part fits a column: the same sign, or operands that one rule reads."""
        if column.key or part.key:
            return column.key == part.key
        spans = {span for cell in column.cells.values() for span in cell.spans}
        return bool(phraser.rules_for_all(sorted({*spans, *part.spans}, key=str)))

    columns: list[_Column] = []
    for number, row in enumerate(rows):
        merged: list[_Column] = []
        place = used = 0
        for here, there in _matches(columns, row, fits):
            merged += columns[used:here]
            merged += [_Column(p.key, {number: p}) for p in row[place:there]]
            columns[here].cells[number] = row[there]
            merged.append(columns[here])
            used, place = here + 1, there + 1
        merged += columns[used:]
        merged += [_Column(p.key, {number: p}) for p in row[place:]]
        columns = merged
    return columns


def _matches(
    columns: Sequence[_Column], row: Sequence[_Part], fits: Callable[[_Column, _Part], bool]
) -> list[tuple[int, int]]:
    """Return the index pairs of a longest common subsequence."""
    same = [[fits(column, part) for part in row] for column in columns]
    best = [[0] * (len(row) + 1) for _ in range(len(columns) + 1)]
    for i in range(len(columns) - 1, -1, -1):
        for j in range(len(row) - 1, -1, -1):
            best[i][j] = max(best[i + 1][j], best[i][j + 1], same[i][j] + best[i + 1][j + 1])
    out = []
    i = j = 0
    while i < len(columns) and j < len(row):
        if same[i][j] and best[i][j] == 1 + best[i + 1][j + 1]:
            out.append((i, j))
            i, j = i + 1, j + 1
        elif best[i][j] == best[i + 1][j]:
            i += 1
        else:
            j += 1
    return out


def _written(
    phraser: Phraser, column: _Column, level: int, near: frozenset[str]
) -> tuple[str, ...]:
    """Return a column as symbols: a sign, a rule for all cells, or a choice; empty if none fits."""
    if column.key:
        return (column.key,)
    spans = _spans(column)
    chosen = phraser.rules_for_all(spans, near)
    if chosen:
        symbol = chosen[min(level, len(chosen) - 1)]
    else:
        several = _cover(phraser, spans)
        if several is None:
            return ()
        symbol = f"({' | '.join(several)})" if len(several) > 1 else several[0]
    return _listed(symbol, listed=any(len(part.spans) > 1 for part in column.cells.values()))


def _as_usual(
    phraser: Phraser,
    columns: Sequence[_Column],
    written: Sequence[tuple[str, ...]],
    rows: int,
) -> list[tuple[str, ...]]:
    """Return the columns with the rules that the grammar usually has there, if they fit."""
    out: list[tuple[str, ...]] = []
    always: list[str] = []  # the symbols so far, without optional ones
    for column, symbols in zip(columns, written, strict=True):
        before = last_two(always)
        usual = None if column.key else phraser.usual_for(_spans(column), before)
        listed = any(len(part.spans) > 1 for part in column.cells.values())
        out.append(_listed(usual, listed=listed) if usual else symbols)
        if len(column.cells) == rows:
            always += out[-1]
    return out


def _spans(column: _Column) -> list[_Span]:
    return sorted({span for part in column.cells.values() for span in part.spans}, key=str)


def _listed(symbol: str, *, listed: bool) -> tuple[str, ...]:
    return (symbol, f"(',' {symbol})*") if listed else (symbol,)


def _cover(phraser: Phraser, spans: Sequence[_Span]) -> list[str] | None:
    """Return a few rules or tokens that together read all the spans (greedy set cover)."""
    left = list(spans)
    out: list[str] = []
    while left and len(out) < tuning.MOST_CHOICES:
        reads: dict[str, list[_Span]] = {}
        for span in left:
            for rule in phraser.rules_for_all([span]):
                reads.setdefault(rule, []).append(span)
        if not reads:
            return None
        best = min(reads, key=lambda rule: (-len(reads[rule]), phraser.breadth([rule]), rule))
        out.append(best)
        left = [span for span in left if span not in reads[best]]
    return None if left else sorted(out)


def _grouped(
    phraser: Phraser, columns: Sequence[_Column], written: Sequence[tuple[str, ...]], rows: int
) -> Iterator[str]:
    """Yield the symbols of all columns; those not in every row become optional or a choice.

    A choice that a rule reads is written as this rule.
    """
    runs: list[tuple[frozenset[int], list[str], list[_Column]]] = []
    for column, symbols in zip(columns, written, strict=True):
        present = frozenset(column.cells)
        if not runs or runs[-1][0] != present:
            runs.append((present, [], []))
        runs[-1][1].extend(symbols)
        runs[-1][2].append(column)
    place = 0
    while place < len(runs):
        present, body, having = runs[place]
        place += 1
        if len(present) == rows:
            yield from body
            continue
        choice = [" ".join(body)]
        while place < len(runs) and not present & runs[place][0]:
            present |= runs[place][0]
            choice.append(" ".join(runs[place][1]))
            having = having + runs[place][2]
            place += 1
        if len(having) == len(choice) > 1:
            spans = sorted({span for column in having for span in _spans(column)}, key=str)
            rule = phraser.rules_for_all(spans)
            choice = [rule[0]] if rule else choice
        text = " | ".join(choice)
        if len(present) == rows:
            yield f"({text})" if len(choice) > 1 else text
        else:
            yield f"{text}?" if len(choice) == 1 and _is_one([text]) else f"({text})?"


def _is_one(symbols: Sequence[str]) -> bool:
    """Return whether the symbols are a single one without a suffix."""
    return len(symbols) == 1 and " " not in symbols[0] and symbols[0][-1] not in "?*+"
