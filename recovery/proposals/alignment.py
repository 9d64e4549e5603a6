"""Alignment of phrases for a proposal: one phrase that reads one or several.

Lines of one construct differ in their operands and in their optional parts. They are aligned by
keywords and signs, as a multiple sequence alignment. A column of operands becomes a rule that reads
all of them. Parts that only some lines have become optional, and differing parts become a choice.
``LIN A`` and ``LIN {X 1} C_DIS`` give ``LIN target C_DIS?``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.collocations import last_two
from recovery.proposals.phrase_parts import LIST, Part, PartReader, Row, Span
from recovery.proposals.phrases import Phraser

_Symbols = tuple[str, ...]


@dataclass(slots=True)
class _Column:
    """Parts of the same kind, by row."""

    key: str
    cells: dict[int, Part] = field(default_factory=dict)

    @property
    def spans(self) -> list[Span]:
        """The distinct tokens of its parts."""
        return sorted({span for part in self.cells.values() for span in part.spans}, key=str)

    @property
    def has_lists(self) -> bool:
        """Whether one of its parts has several items."""
        return any(len(part.spans) > 1 for part in self.cells.values())


@dataclass(frozen=True, slots=True)
class _Alignment:
    """The columns of a number of rows; no columns if the rows have too little in common."""

    columns: Sequence[_Column]
    rows: int


class Aligner:
    """Aligns phrases under one grammar; caches its results."""

    def __init__(self, phraser: Phraser) -> None:
        self._phraser = phraser
        self._reader = PartReader(phraser)
        self._alignments: dict[tuple[Span, ...], _Alignment] = {}
        self._known: dict[tuple[tuple[Span, ...], frozenset[str]], list[_Symbols]] = {}

    def common_phrases(
        self, phrases: Sequence[Sequence[Token]], near: frozenset[str] = frozenset()
    ) -> list[_Symbols]:
        """Return phrases of symbols that read all of ``phrases``, the most restrictive first.

        Returns none if the phrases have too little in common.
        """
        key = tuple(map(tuple, phrases))
        found = self._known.get((key, near))
        if found is None:
            if len(self._known) >= tuning.MOST_ALIGNMENTS_KEPT:
                self._known.clear()
                self._alignments.clear()
            if key not in self._alignments:
                self._alignments[key] = self._aligned(key)
            found = list(dict.fromkeys(self._spelled(self._alignments[key], near)))
            self._known[key, near] = found
        return found

    # ------------------------------------------------------------------------------ columns

    def _aligned(self, phrases: tuple[Span, ...]) -> _Alignment:
        rows = self._reader.rows(phrases)[: tuning.MOST_ALIGNED]
        columns = self._columns(rows)
        if not columns or len(columns) > tuning.MOST_COLUMNS:
            return _Alignment((), 0)
        if self._reader.are_alike(rows) or _belong_together(columns, len(rows)):
            return _Alignment(columns, len(rows))
        return _Alignment((), 0)

    def _columns(self, rows: Sequence[Row]) -> list[_Column]:
        """Return the rows aligned in columns; the longest row gives the order."""
        columns: list[_Column] = []
        for number, row in enumerate(rows):
            merged: list[_Column] = []
            place = used = 0
            for here, there in _matches(columns, row, self._fits):
                merged += columns[used:here]
                merged += [_Column(p.key, {number: p}) for p in row[place:there]]
                columns[here].cells[number] = row[there]
                merged.append(columns[here])
                used, place = here + 1, there + 1
            merged += columns[used:]
            merged += [_Column(p.key, {number: p}) for p in row[place:]]
            columns = merged
        return columns

    def _fits(self, column: _Column, part: Part) -> bool:
        """Return whether a part fits a column: the same sign, or operands that one rule reads."""
        if column.key or part.key:
            return column.key == part.key
        spans = sorted({*column.spans, *part.spans}, key=str)
        return bool(self._phraser.rules_for_all(spans))

    # ------------------------------------------------------------------------------ symbols

    def _spelled(self, found: _Alignment, near: frozenset[str]) -> Iterator[_Symbols]:
        """Yield the columns as symbols, with narrow rules for operands, then with wider ones."""
        for level in range(tuning.PHRASE_LEVELS if found.columns else 0):
            narrow = [self._written(column, level, near) for column in found.columns]
            if all(narrow):
                for written in (self._as_usual(found, narrow), narrow):
                    yield tuple(self._grouped(found, written))

    def _written(self, column: _Column, level: int, near: frozenset[str]) -> _Symbols:
        """Return a column as symbols: a sign, a rule for all cells, or a choice; empty if none."""
        if column.key == LIST:
            items = self.common_phrases(column.spans, near)
            if not items:
                return ()
            item = items[min(level, len(items) - 1)]
            return (*item, f"(',' {' '.join(item)})*") if column.has_lists else item
        if column.key:
            return (column.key,)
        chosen = self._phraser.rules_for_all(column.spans, near)
        symbol = chosen[min(level, len(chosen) - 1)] if chosen else self._cover(column.spans)
        return _listed(symbol, column) if symbol else ()

    def _cover(self, spans: Sequence[Span]) -> str:
        """Return a choice of a few rules or tokens that together read all the spans, or nothing.

        It is a greedy set cover.
        """
        left = list(spans)
        out: list[str] = []
        while left and len(out) < tuning.MOST_CHOICES:
            reads: dict[str, list[Span]] = {}
            for span in left:
                for rule in self._phraser.rules_for_all([span]):
                    reads.setdefault(rule, []).append(span)
            if not reads:
                return ""
            breadth = self._phraser.breadth
            best = min(reads, key=lambda rule: (-len(reads[rule]), breadth([rule]), rule))
            out.append(best)
            left = [span for span in left if span not in reads[best]]
        return "" if left else f"({' | '.join(sorted(out))})" if len(out) > 1 else out[0]

    def _as_usual(self, found: _Alignment, written: Sequence[_Symbols]) -> list[_Symbols]:
        """Return the columns with the rules that the grammar usually has there, if they fit."""
        out: list[_Symbols] = []
        always: list[str] = []  # the symbols so far, without optional ones
        for column, symbols in zip(found.columns, written, strict=True):
            before = last_two(always)
            usual = None if column.key else self._phraser.usual_for(column.spans, before)
            out.append(_listed(usual, column) if usual else symbols)
            if len(column.cells) == found.rows:
                always += out[-1]
        return out

    def _grouped(self, found: _Alignment, written: Sequence[_Symbols]) -> Iterator[str]:
        """Yield the symbols of all columns; those not in every row become optional or a choice."""
        runs = _runs(found.columns, written)
        while runs:
            present, columns, body = runs.pop(0)
            if len(present) == found.rows:
                yield from body
                continue
            choice = [" ".join(body)]
            while runs and not present & runs[0][0]:
                more, others, symbols = runs.pop(0)
                present |= more
                columns = columns + others
                choice.append(" ".join(symbols))
            if len(columns) == len(choice) > 1:
                # a choice that a rule reads is written as this rule
                spans = sorted({span for column in columns for span in column.spans}, key=str)
                choice = [*self._phraser.rules_for_all(spans)[:1]] or choice
            text = " | ".join(choice)
            if len(present) == found.rows:
                yield f"({text})" if len(choice) > 1 else text
            else:
                is_one = len(choice) == 1 and " " not in text and text[-1] not in "?*+"
                yield f"{text}?" if is_one else f"({text})?"


def _belong_together(columns: Sequence[_Column], rows: int) -> bool:
    """Return whether most columns are in all rows, or the rows are few forms of one first word."""
    in_all = [len(column.cells) == rows for column in columns]
    if 2 * sum(in_all) >= len(columns):
        return True
    forms = {frozenset(column.cells) for column in columns}
    return bool(columns[0].key and in_all[0]) and len(forms) <= tuning.MOST_LINE_SHAPES


def _matches(
    columns: Sequence[_Column], row: Row, fits: Callable[[_Column, Part], bool]
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


def _runs(
    columns: Sequence[_Column], written: Sequence[_Symbols]
) -> list[tuple[frozenset[int], list[_Column], list[str]]]:
    """Return columns side by side that the same rows have, as rows, columns and symbols."""
    runs: list[tuple[frozenset[int], list[_Column], list[str]]] = []
    for column, symbols in zip(columns, written, strict=True):
        present = frozenset(column.cells)
        if not runs or runs[-1][0] != present:
            runs.append((present, [], []))
        runs[-1][1].append(column)
        runs[-1][2].extend(symbols)
    return runs


def _listed(symbol: str, column: _Column) -> _Symbols:
    """Return the symbol, or a list of such where the column has lists."""
    return (symbol, f"(',' {symbol})*") if column.has_lists else (symbol,)
