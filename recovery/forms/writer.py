"""Writes the form of lines, for induction: the text of a rule that reads all of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

from recovery.forms.chain import Factor, chain_of
from recovery.forms.chain_text import FactorText, chain_text
from recovery.forms.lists import COMMA, LIST, FoldedLists, fold_lists
from recovery.forms.marks import Mark, MarkedLine, marked
from recovery.forms.operand_cover import NoRuleError, OperandCover
from recovery.forms.operand_splits import split_operands
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import CLOSERS, Operand, Symbol, texts
from recovery.tuning import MANY_LISTS


class FormWriter:
    """Writes forms for one grammar; ``operands`` of the corpus define which rules are narrow."""

    def __init__(self, reader: SymbolReader, operands: Iterable[tuple[int, ...]]) -> None:
        self.reader = reader
        self.rules = reader.rules
        self.cover = OperandCover(reader, operands)

    def form(self, lines: Iterable[Sequence[Symbol]]) -> str | None:
        """Return the text of a rule that reads all lines; ``None`` if an operand has no rule."""
        try:
            return self._form([tuple(line) for line in lines])
        except NoRuleError:
            return None

    def _form(self, lines: Sequence[tuple[Symbol, ...]]) -> str:
        filled = [line for line in lines if line]
        if len(filled) < len(lines):
            return f"({self._form(filled)})?" if filled else ""
        lines = split_operands(self.reader, lines)
        folded = fold_lists(lines)
        items = self._list(folded) if folded else ""
        return self._chain(marked(folded.lines if folded else lines, self._is_type), items)

    def _is_type(self, symbol: Symbol) -> bool:
        """Return whether an operand is a reserved word for a type, or the rule of types."""
        operand = symbol.operand or Operand()
        is_rule = operand.rule in self.rules.type_rules
        return is_rule or self.cover.reserved_word(operand) in self.rules.type_words

    # ------------------------------------------------------------------------------------- lists

    def _list(self, folded: FoldedLists) -> str:
        """Return the text of a list."""
        items = [*folded.others, *folded.firsts]
        filled = [item for item in items if item]
        if not any(folded.others):
            return f"{COMMA}*"
        item = self._form(filled)
        if len(filled) == len(items):
            return f"{self._first_item(folded) or item} ({COMMA} {item})*"
        item = f"({item})" if " " in item else item
        if item[-1] in "?*":
            raise NoRuleError
        return f"{item}? ({COMMA} {item}?)*"

    def _first_item(self, folded: FoldedLists) -> str | None:
        """Return the form of a first item, if many lists begin with what only some continue."""
        firsts = set(map(texts, folded.firsts))
        if len(folded.firsts) < MANY_LISTS or not firsts < set(map(texts, folded.others)):
            return None
        return self.form(i for i in (*folded.firsts, *folded.others) if texts(i) in firsts)

    # ------------------------------------------------------------------------------------- chains

    def _chain(self, lines: Sequence[MarkedLine], items: str) -> str:
        """Return the chain of the lines as text; ``items`` is the text of a list."""
        symbols: dict[Mark, list[Symbol]] = defaultdict(list)
        having: dict[Mark, set[int]] = defaultdict(set)
        for number, line in enumerate(lines):
            for mark, symbol in line:
                symbols[mark].append(symbol)
                having[mark].add(number)
        found: list[FactorText] = []
        for factor in chain_of([[mark for mark, _ in line] for line in lines]):
            choices = self._choices({mark: symbols[mark] for mark in factor.symbols}, items)
            if rest := self._ended_by_words(factor, choices, lines, items):
                return f"{chain_text(found, len(lines))} {rest}".strip()
            numbers = frozenset[int]().union(*(having[mark] for mark in factor.symbols))
            found.append(FactorText(choices, numbers, factor.often in ("+", "*")))
        return chain_text(found, len(lines))

    def _choices(self, symbols: Mapping[Mark, Sequence[Symbol]], items: str) -> list[str]:
        """Return the texts of the symbols with some marks, operands last, each once."""
        found, operands = [], list[Operand]()
        for mark, some in symbols.items():
            if mark.text == LIST:
                found.append(items)
            elif some[0].inside is not None:
                inside = self._form([symbol.inside or () for symbol in some])
                found.append(" ".join(filter(None, (mark.text, inside, CLOSERS[mark.text]))))
            elif some[0].operand is not None:
                operands += [symbol.operand for symbol in some if symbol.operand]
            else:
                found.append(mark.text)
        found += self.cover.texts(operands) if operands else []
        found = list(dict.fromkeys(found))
        return [text for text in found if not self.cover.is_read_by(text, found)]

    def _ended_by_words(
        self, factor: Factor[Mark], choices: list[str], lines: Sequence[MarkedLine], items: str
    ) -> str | None:
        """Return the text from a factor on, if some lines end there with a word for an operand.

        Then what follows other operands does not follow the word. The result is ``None`` if a line
        continues after such a word, which is then an ordinary operand.
        """
        mark = factor.symbols[0]
        if factor.often or len(factor.symbols) > 1 or mark.text:
            return None
        words, others, rests = set[str](), list[Symbol](), list[MarkedLine]()
        for line in lines:
            place = [other for other, _ in line].index(mark)
            symbol, rest = line[place][1], line[place + 1 :]
            word = self.cover.reserved_word(symbol.operand)
            if not word:
                others.append(symbol)
                rests.append(rest)
            elif rest:
                return None
            else:
                words.add(word)
        if not words or not any(rests) or choices[1:] != sorted(words):
            return None
        if choices[:1] != self._choices({mark: others}, items):
            return None
        return f"({choices[0]} {self._chain(rests, items)} | {' | '.join(choices[1:])})"
