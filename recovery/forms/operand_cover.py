"""What to write for operands already found: names, or the narrowest rules that read all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Set
from functools import cached_property
from itertools import combinations

from grammar.notation.model import Reference
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import Operand
from recovery.tuning import READ_TOGETHER_SHARE


class NoRuleError(Exception):
    """No rule reads an operand, so there is no form."""


class OperandCover:
    """Chooses rules for operands.

    The fewer distinct operands of the corpus a rule reads, the narrower it is.
    """

    def __init__(self, reader: SymbolReader, corpus: Iterable[tuple[int, ...]]) -> None:
        """Count what each rule reads of the operands of the ``corpus``, given as kinds of token."""
        self.reader = reader
        self.rules = reader.rules
        self.lexer = reader.lexer
        matcher = self.rules.matcher
        self._counts = Counter(rule for kinds in corpus for rule in matcher.rules_for(kinds))
        self._name = self.rules.names or self.lexer.name

    def texts(self, operands: Iterable[Operand]) -> list[str]:
        """Return the texts of a choice that reads the operands; raise `NoRuleError` without one."""
        wanted = frozenset(operands)
        if names := self._names(wanted) or self._names_with_operators(wanted):
            return [names]
        return self._names_and_words(wanted) or self._rules(wanted)

    def reserved_word(self, operand: Operand | None) -> str:
        """Return the reserved word that an operand is; empty if it is none."""
        kinds = operand.kinds if operand else ()
        is_word = len(kinds) == 1 and self.lexer.is_keyword(kinds[0])
        return self.lexer.names[kinds[0]] if is_word else ""

    # ------------------------------------------------------------------------------------- names

    def _names(self, operands: Set[Operand]) -> str | None:
        """Return the text for names, some with an index; ``None`` if there are other operands."""
        name_kind, rules_for = self.lexer.name_kind, self.rules.matcher.rules_for
        if operands == {Operand((name_kind,))}:
            return self._name
        indices = set[str]()
        for operand in operands - {Operand((), self._name)}:
            first, rest = operand.kinds[:1], operand.kinds[1:]
            if first != (name_kind,) and self._name not in rules_for(first):
                return None
            if rest:
                index = self.rules.following.get(rest[0], "")
                if index not in rules_for(rest):
                    return None
                indices.add(index)
        return f"{self._name} {indices.pop()}?" if len(indices) == 1 else None

    def _names_with_operators(self, operands: Set[Operand]) -> str | None:
        """Return names with signs between, if no other operand than such a one is met."""
        kinds = next(iter(operands)).kinds if len(operands) == 1 else ()
        tokens = [(kind, None) for kind in kinds]
        is_of_names = set(kinds[::2]) == {self.lexer.name_kind}
        if not is_of_names or len(self.reader.symbols(tokens, atoms=True)) == 1:
            return None
        texts = {self.lexer.name_kind: self._name}
        return " ".join(texts.get(kind) or self.reader.text(kind) for kind in kinds)

    def _names_and_words(self, operands: Set[Operand]) -> list[str] | None:
        """Return the text for names, then reserved words that are no types.

        A single word beside names, or several that are no values, say nothing of other values.
        """
        words = {o.kinds[0]: word for o in operands if (word := self.reserved_word(o))}
        if len(words) > 1 and any(map(self.reader.is_value, words)):
            return None
        if not words or not self.rules.type_kinds.isdisjoint(words):
            return None
        names = self._names({o for o in operands if words.keys().isdisjoint(o.kinds[:1])})
        return [names, *sorted(words.values())] if names else None

    # ------------------------------------------------------------------------------------- rules

    def _rules(self, operands: Set[Operand]) -> list[str]:
        """Return one rule or two that read all operands, or else as many as it takes."""
        rules = self.rules
        having = {
            o: rules.including(o.rule) if o.rule else rules.matcher.rules_for(o.kinds)
            for o in operands
        }
        reads = {rule: {o for o in operands if rule in having[o]} for rule in rules.usual}
        whole = [rule for rule, read in reads.items() if read == operands]
        if whole:
            rule = min(whole, key=self._breadth)
            found = self._narrower(rule, reads, operands) or [rule]
        else:
            found, left = self._most_first(reads, operands)
            if any(len(operand.kinds) != 1 for operand in left):
                raise NoRuleError
            if left:
                return [*found, *sorted(self.lexer.names[o.kinds[0]] for o in left)]
        if len(found) > 1 and self.variable:  # names among values are variables
            return [self.variable if rule == self._name else rule for rule in found]
        return found

    def _most_first(
        self, reads: Mapping[str, Set[Operand]], operands: Set[Operand]
    ) -> tuple[list[str], Set[Operand]]:
        """Return rules, each of which reads most of what is left, and the operands of no rule."""
        found: list[str] = []
        left = operands
        while left:
            best = max(reads, key=lambda r: (len(reads[r] & left), [-n for n in self._breadth(r)]))
            if reads[best].isdisjoint(left):
                break
            left = left - reads[best]
            found.append(best)
        return found, left

    def _narrower(
        self, wide: str, reads: Mapping[str, Set[Operand]], operands: Set[Operand]
    ) -> list[str] | None:
        """Return two rules for a wide one, if that reads names and they do not, or much more."""
        usual = [rule for rule in reads if reads[rule] and not self.rules.includes(rule, wide)]
        pairs = [
            (self._counts[one] + self._counts[other], usual.index(one), usual.index(other))
            for one, other in combinations(sorted(usual), 2)
            if reads[one] | reads[other] == operands
        ]
        if not pairs:
            return None
        count, first, second = min(pairs)
        found = [usual[first], usual[second]]
        named = self.rules.matcher.rules_for((self.lexer.name_kind,))
        is_constant = wide in named and named.isdisjoint(found)
        return found if is_constant or count <= READ_TOGETHER_SHARE * self._counts[wide] else None

    def _breadth(self, rule: str) -> tuple[int, ...]:
        """Return what a rule reads: operands of the corpus first, then how many other rules."""
        usual = self.rules.usual
        inner = sum(self.rules.includes(rule, other) for other in usual)
        return self._counts[rule], inner, -self.rules.uses[rule], usual.index(rule)

    @cached_property
    def variable(self) -> str | None:
        """The narrowest rule of names with what may follow them, and of no other value."""
        matcher, name_kind = self.rules.matcher, self.lexer.name_kind
        values = {*filter(self.lexer.has_value, self.lexer.kind_of.values())} - {name_kind}
        examples = [(name_kind,), *(o.kinds for o in self.rules.followed.values())]
        having = frozenset(self.rules.usual).intersection(*map(matcher.rules_for, examples))
        fitting = having.difference({self._name}, *(matcher.rules_for((k,)) for k in values))
        return min(fitting, key=self._breadth, default=None) if self.rules.followed else None

    def is_read_by(self, text: str, others: Collection[str]) -> bool:
        """Return whether a text is a rule for a choice of words that one of the others reads."""
        rule = self.rules.grammar.by_name.get(text)
        every = [a.elements for a in rule.alternatives] if rule and not rule.is_lexer else [()]
        words = {e[0].name for e in every if len(e) == 1 and isinstance(e[0], Reference)}
        kind_of, rules_for = self.lexer.kind_of, self.rules.matcher.rules_for
        if len(words) < len(every) or not words <= kind_of.keys():
            return False
        return bool(({*others} - {text}).intersection(*(rules_for((kind_of[w],)) for w in words)))
