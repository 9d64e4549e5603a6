"""Forms that enough origins show, and their cost for a grammar."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from grammar.notation.edits import AddAlternative, AddToken, Edit
from recovery.brackets import CLOSING
from recovery.forms.loose import is_loose
from recovery.forms.symbols import UNKNOWN, Symbol, all_texts, operands_of
from recovery.forms.writer import FormWriter
from recovery.induction.line_symbols import WORD, LineSymbols
from recovery.tuning import WORD_LIST_ALTERNATIVES


class SupportedForms:
    """Writes forms of failing lines in which every pair of neighbours occurs in enough origins."""

    def __init__(self, at: LineSymbols, origins: Sequence[Collection[str]], least: int = 1) -> None:
        """``origins[n]`` are those that have line ``n``.

        Each pair of neighbours in a form has to be in lines of ``least`` of them.
        """
        self.at = at
        self._origins = origins
        self._least = least
        self.writer = FormWriter(at.reader, operands_of(at.symbols))

    def of(
        self,
        shapes: dict[tuple[Symbol, ...], list[int]],
        old: Sequence[tuple[Symbol, ...]] = (),
        least: int = 1,
    ) -> Iterator[str]:
        """Yield forms of ``old`` shapes and these: of all, of recurring ones, of recurring words.

        One odd line must not spoil a form, nor one origin: pairs of neighbours must occur in
        ``least`` origins, if that is more than all forms need and as many origins have the shapes.
        """
        having = {shape: self.origins_of(numbers) for shape, numbers in shapes.items()}
        least = min(least, len(frozenset[str]().union(*having.values())))
        known = self.supported(having, old, max(least, self._least))
        # what has a character that begins no token has no form
        shapes = {shape: shapes[shape] for shape in known if UNKNOWN not in all_texts(shape)}
        lines = Counter(text for shape in shapes for text in {symbol.text for symbol in shape})
        choices = [
            [shape for shape, numbers in shapes.items() if len(numbers) >= least]
            for least in (1, 2, 4)
        ]
        choices += [
            [shape for shape in shapes if all(lines[symbol.text] >= least for symbol in shape)]
            for least in (2, 4)
        ]
        found = [(self.writer.form(some), some) for c in choices if c for some in [[*old, *c]]]
        yield from dict.fromkeys(t for t, some in found if t and not is_loose(t, some))

    def origins_of(self, numbers: Iterable[int]) -> frozenset[str]:
        """Return the origins that have one of some lines."""
        return frozenset[str]().union(*(self._origins[n] for n in numbers))

    def supported(
        self,
        shapes: Mapping[tuple[Symbol, ...], Collection[str]],
        old: Sequence[tuple[Symbol, ...]] = (),
        least: int = 0,
    ) -> list[tuple[Symbol, ...]]:
        """Return shapes whose neighbours all occur in enough origins, or in an ``old`` shape.

        ``shapes`` come with the origins that have them.
        """
        pairs = {shape: frozenset(self.pairs(shape)) for shape in shapes}
        known = {pair for shape in old for pair in self.pairs(shape)}
        having: dict[tuple[str, ...], set[str]] = defaultdict(set)
        for shape, origins in shapes.items():
            for pair in pairs[shape]:
                having[pair].update(origins)
        least = least or self._least
        enough = known | {pair for pair, found in having.items() if len(found) >= least}
        return [shape for shape in shapes if pairs[shape] <= enough]

    def pairs(self, symbols: Sequence[Symbol], group: str = "") -> Iterator[tuple[str, ...]]:
        """Yield adjacent symbols, including those in brackets; operands by their sort."""
        for left, right in pairwise(["", *map(self.finer_sort, symbols), ""]):
            yield group, left, right
        for symbol in symbols:
            if symbol.inside is not None:
                yield from self.pairs(symbol.inside, f"{group}{symbol.text}")

    def sort(self, symbol: Symbol) -> str:
        """Return the sort of a symbol: its text, or for an operand the bracket at its end."""
        kinds = symbol.operand.kinds if symbol.operand else ()
        shown = self.at.shown((kinds[-1], None)) if kinds else ""
        return symbol.text or (shown if shown in CLOSING else "_")

    def finer_sort(self, symbol: Symbol) -> str:
        """Return a finer sort: operands by their rule, and whether they begin with a name."""
        if symbol.operand is None or symbol.operand.rule:
            return symbol.text or (symbol.operand.rule if symbol.operand else "")
        first = symbol.operand.kinds[0]
        is_name = first == self.at.lexer.name_kind or self.at.rules.matcher.may_be_a_name(first)
        return "name" if is_name else self.sort(symbol)

    def reserving(self, *texts: str) -> tuple[Edit, ...]:
        """Return the edits that reserve the words in texts of rules that the grammar lacks."""
        found = {w for text in texts for w in WORD.findall(re.sub(r"'[^']*'", " ", text))}
        words = sorted(w for w in found if w not in self.at.grammar.by_name)
        lists = [
            rule
            for rule in self.at.profile.vocabulary.word_lists
            if len(self.at.grammar.by_name[rule].alternatives) >= WORD_LIST_ALTERNATIVES
        ]
        entered = (AddAlternative(rule, word) for word in words for rule in lists)
        return (*map(AddToken, words), *entered)


def optional(text: str) -> str:
    """Return a text as optional; unchanged if it is optional already."""
    if not re.fullmatch(r"\S+", text):
        return f"({text})?"
    if text[-1] == "+":
        return f"{text[:-1]}*"
    return text if text[-1] in "?*" else f"{text}?"
