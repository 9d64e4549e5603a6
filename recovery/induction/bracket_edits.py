"""Edits of the contents of brackets in a rule, inferred from all contents that it does not read."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from grammar.notation.edits import Edit, Insert, Replace
from grammar.notation.model import Element, Reference, walk
from recovery.brackets import BRACKETS
from recovery.forms.lists import split_at_commas
from recovery.forms.operand_rules import bracket_pairs
from recovery.forms.samples import samples_of
from recovery.forms.symbols import Symbol
from recovery.induction.line_symbols import LineSymbols
from recovery.induction.operand_edits import OperandEdits
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms, optional
from recovery.tuning import MISSING_RUN, SEVERAL_ORIGINS


class BracketEdits:
    """Infers contents of brackets, if the missing part is not an operator."""

    def __init__(self, at: LineSymbols, forms: SupportedForms, operands: OperandEdits) -> None:
        self.at = at
        self.forms = forms
        self._operands = operands

    def edits(self) -> Iterator[InferredStep]:
        """Yield edits of the contents of brackets, from all contents that a rule does not read."""
        found: dict[tuple[str, str], dict[tuple[Symbol, ...], list[int]]] = defaultdict(
            lambda: defaultdict(list)
        )
        for number, tokens, index in self.at.failures:
            for sign, inside in _groups(self.at.symbols[number]):
                rule = self.at.rules.bracketed.get(sign)
                if rule and not any(s.text in self._operands.operators for s in inside):
                    found[rule, sign][self.at.known_groups(inside)].append(number)
            opened = self.at.opened(tokens, index)
            if opened is None or number in self._operands.operator_lines:
                continue
            sign = self.at.shown(tokens[opened])
            close = self.at.reader.closer(tokens, opened)
            rule = self.at.writing(number, sign)
            bracketed = self.at.rules.bracketed
            if close is not None and rule is not None and rule not in bracketed.values():
                inside = self.at.reader.symbols(tokens[opened + 1 : close])
                if not any(sign in bracketed for sign, _ in _groups(inside)):
                    found[rule, sign][inside].append(number)
        for (rule, sign), contents in found.items():
            members = tuple(dict.fromkeys(n for numbers in contents.values() for n in numbers))
            title = f"between {sign} and {BRACKETS[sign]} of {rule}"
            for edits in self._between(rule, sign, contents):
                yield InferredStep(title, edits, members)

    def _between(
        self, rule: str, sign: str, contents: dict[tuple[Symbol, ...], list[int]]
    ) -> Iterator[tuple[Edit, ...]]:
        """Yield edits for contents of brackets: parts left out, then new forms."""
        source_of = self.at.grammar.by_name[rule].source_of
        # operands are everywhere: one of several origins shows too little
        least = SEVERAL_ORIGINS if rule in self.at.rules.bracketed.values() else 1
        for number, alternative in enumerate(self.at.grammar.by_name[rule].alternatives, 1):
            for opening, start, end in bracket_pairs(alternative):
                if opening != sign:
                    continue
                old = alternative.elements[start + 1 : end]
                for first, count in _runs(len(old)):
                    text = optional(" ".join(map(source_of, old[first : first + count])))
                    yield (Replace(rule, (number, start + 2 + first), text, count),)
                yield from self._of_items(old, contents, least)
                for text in self.forms.of(contents, samples_of(self.at.rules, old), least):
                    at, count = (number, start + 2), len(old)
                    edit = Replace(rule, at, text, count) if count else Insert(rule, at, text)
                    yield (*self.forms.reserving(text), edit)

    def _of_items(
        self,
        old: Sequence[Element],
        contents: dict[tuple[Symbol, ...], list[int]],
        least: int,
    ) -> Iterator[tuple[Edit, ...]]:
        """Yield edits of the rule that reads the items of a list and nothing else."""
        called = {e.name for o in old for e in walk(o) if isinstance(e, Reference)}
        for name in sorted(called & self.at.rules.reaches.keys()):
            first, *others = self.at.grammar.by_name[name].alternatives
            if others or not self.at.rules.is_part(name):
                continue
            items: dict[tuple[Symbol, ...], list[int]] = defaultdict(list)
            for inside, numbers in contents.items():
                for item in split_at_commas(inside)[1:]:  # ahead of the first one there may be more
                    items[item] += numbers
            known = samples_of(self.at.rules, first.elements)
            for text in self.forms.of(items, known, least) if items else ():
                edit = Replace(name, (1, 1), text, len(first.elements))
                yield (*self.forms.reserving(text), edit)


def _groups(symbols: Sequence[Symbol]) -> Iterator[tuple[str, tuple[Symbol, ...]]]:
    """Groups in brackets at any depth that no rule has read: the opening sign and the inside."""
    for symbol in symbols:
        if symbol.inside is not None:
            yield symbol.text.strip("'"), symbol.inside
            yield from _groups(symbol.inside)


def _runs(count: int) -> Iterator[tuple[int, int]]:
    """Yield all proper runs of consecutive elements as first index and length."""
    for length in range(1, min(MISSING_RUN, count - 1) + 1):
        yield from ((start, length) for start in range(count - length + 1))
