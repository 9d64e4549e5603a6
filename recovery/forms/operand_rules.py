"""Which rules of a grammar read operands, which list types, and what only follows operands."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property
from itertools import pairwise

from grammar.notation.addresses import Address, sequences
from grammar.notation.model import (
    Alternative,
    Element,
    Group,
    Literal,
    Reference,
    Repeat,
    reached,
    referred,
    walk,
)
from grammar.parser.lexer import ABSENT
from grammar.parser.recognizer import Recognizer
from recovery.brackets import BRACKETS
from recovery.forms.keywords import Vocabulary
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import Operand
from recovery.tuning import TYPE_LIST_PART


class OperandRules:
    """The rules of a grammar that read operands."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.grammar = recognizer.grammar
        self.recognizer = recognizer
        self.lexer = recognizer.lexer
        self.matcher = RuleMatcher(recognizer)
        self._called = {rule.name: referred(rule) for rule in self.grammar.parser_rules}
        self.reaches = {name: frozenset(reached(self._called, name)) for name in self._called}

    @cached_property
    def names(self) -> str | None:
        """The rule of all names, if there is one: the only rule with the token of names."""
        having = [name for name, called in self._called.items() if self.lexer.name in called]
        return having[0] if len(having) == 1 else None

    @cached_property
    def type_rules(self) -> Mapping[str, frozenset[str]]:
        """Rules that list types, each with its words: words and names, but not most keywords.

        Not `Vocabulary.word_lists`, the rules of nearly all keywords.
        """
        vocabulary = Vocabulary(self.recognizer)
        within = [n for n in self._called if n in self.within_lines and n != self.names]
        found = {name: vocabulary.words_of(name) for name in within}
        lexer = self.lexer
        words = frozenset(w for w, kind in lexer.kind_of.items() if lexer.is_keyword(kind))
        return {
            name: words & some - self.named_words
            for name, some in found.items()
            # a list of most words says nothing of their kind
            if lexer.name in some and TYPE_LIST_PART * len(words & some) <= len(words)
        }

    @cached_property
    def named_words(self) -> frozenset[str]:
        """The tokens that are names: the token of names, and words in the rule of names."""
        words = Vocabulary(self.recognizer).words_of(self.names) if self.names else frozenset()
        return words | {self.lexer.name}

    @cached_property
    def type_words(self) -> frozenset[str]:
        """The words that some rule offers as an alternative to names."""
        return frozenset[str]().union(*self.type_rules.values())

    @cached_property
    def type_kinds(self) -> frozenset[int]:
        """The kinds of token of `type_words`."""
        return frozenset(map(self.lexer.kind_of.__getitem__, self.type_words))

    @cached_property
    def within_lines(self) -> frozenset[str]:
        """Rules that read nothing with a line end in it."""
        end = self.lexer.line_end
        return frozenset(n for n, called in self.reaches.items() if end not in called)

    @cached_property
    def recursive(self) -> frozenset[str]:
        """The largest set of mutually recursive rules within a line: those of expressions.

        Where no rule calls itself, those that read a name or another value, but no list of names.
        """
        groups = {
            frozenset(o for o in called & self.within_lines if name in self.reaches[o])
            for name, called in self.reaches.items()
            if name in called and name in self.within_lines
        }
        kind_of, name = self.lexer.kind_of, self.lexer.name_kind
        comma = kind_of.get(self.grammar.literal_tokens.get(",", ""), ABSENT)
        listing = self.matcher.rules_for((name, comma, name))
        values = (self.matcher.value_rules & self.within_lines) - listing
        return max(groups, key=lambda g: (len(g), sorted(g)), default=values)

    @cached_property
    def widest(self) -> str | None:
        """The rule of all operands: the recursive rule that other rules use most."""
        uses = {
            name: sum(
                name in called
                for rule, called in self._called.items()
                if rule not in self.recursive
            )
            for name in self.recursive
        }
        used = [name for name in sorted(uses) if uses[name]]
        held = {name: sum(self.includes(name, other) for other in uses) for name in used}
        return max(used, key=lambda name: (held[name], uses[name]), default=None)

    @cached_property
    def ladder(self) -> tuple[str, ...]:
        """The rules that alone can be an operand, from the widest down: the levels of operators."""
        found: list[str] = [self.widest] if self.widest else []
        for name in found:
            found += [n for n in self.alone(name) if n not in found]
        return tuple(found)

    def operators(self, rule: str) -> Iterator[tuple[Address, Element]]:
        """Yield the operators of a rule that repeats operands behind one, with their addresses."""
        for number, alternative in enumerate(self.grammar.by_name[rule].alternatives, 1):
            for place, element in enumerate(alternative.elements, 1):
                if isinstance(element, Repeat) and isinstance(element.item, Group):
                    inner = element.item.alternatives[0].elements
                    if len(inner) == 2:
                        yield (number, place, 1, 1), inner[0]

    @cached_property
    def signs_between(self) -> frozenset[str]:
        """The signs that operators are."""
        operators = (operator for rule in self.ladder for _, operator in self.operators(rule))
        return frozenset(e.text for o in operators for e in walk(o) if isinstance(e, Literal))

    @cached_property
    def values(self) -> str | None:
        """The level with most tokens that have a value: that of literals."""
        kind_of, has_value = self.lexer.kind_of, self.lexer.has_value

        def count(rule: str) -> int:
            every = [a.elements for a in self.grammar.by_name[rule].alternatives]
            single = [e[0] for e in every if len(e) == 1]
            names = {e.name for e in single if isinstance(e, Reference) and e.is_token}
            return sum(has_value(kind_of[name]) for name in names)

        return max(self.ladder, key=count, default=None)

    def alone(self, name: str) -> Iterator[str]:
        """Yield rules that a rule may consist of, nothing beside them."""
        for alternative in self.grammar.by_name[name].alternatives:
            needed = [e for e in alternative.elements if not is_optional(e)]
            if len(needed) == 1 and isinstance(needed[0], Reference) and not needed[0].is_token:
                yield needed[0].name

    def gathers(self, name: str, some: Collection[str]) -> bool:
        """Return whether the operand levels that a rule calls are exactly some, one each."""
        for alternative in self.grammar.by_name[name].alternatives:
            levels = referred(alternative).intersection(self.ladder)
            is_alone = [type(e) for e in alternative.elements] == [Reference]
            if levels and not (is_alone and levels.issubset(some)):
                return False
        return True

    def includes(self, wide: str, narrow: str) -> bool:
        """Return whether a rule may consist of another one."""
        return narrow == wide or narrow in self._consisting.get(wide, ())

    @cached_property
    def _consisting(self) -> Mapping[str, frozenset[str]]:
        """The rules of which each rule may consist."""
        alone = {name: set(self.alone(name)) for name in self._called}
        return {name: frozenset(reached(alone, name)) for name in alone}

    def including(self, rule: str) -> frozenset[str]:
        """Return rules that may consist of a rule, itself too."""
        return frozenset(name for name in self._called if self.includes(name, rule))

    @cached_property
    def usual(self) -> tuple[str, ...]:
        """The rules that may be written for an operand: those that are used elsewhere, in order.

        Rules that begin with a reserved word which is neither a value nor a type are statements and
        are left out.
        """
        inner = self.recursive - {self.widest}
        begun = [
            self.matcher.begun_by((kind,))
            for kind in range(1, len(self.lexer.names))
            if self.lexer.is_keyword(kind) and kind not in self.type_kinds
        ]
        led = frozenset[str]().union(*(some for some in begun if self.widest not in some))
        return tuple(
            rule.name
            for rule in self.grammar.rules
            if rule.name in self.within_lines
            and (rule.name not in inner or self.uses[rule.name])
            and rule.name not in led
        )

    @cached_property
    def uses(self) -> Mapping[str, int]:
        """The number of rules that use a rule, not counting levels of operators."""
        return {
            name: sum(
                name in called for rule, called in self._called.items() if rule not in self.ladder
            )
            for name in self.within_lines
        }

    @cached_property
    def bracketed(self) -> Mapping[str, str]:
        """The rules that are a pair of brackets with contents, by opening bracket."""
        found: dict[str, str] = {}
        for name in self._called:  # in the order of the grammar
            if name in self.within_lines and len(self.grammar.by_name[name].alternatives) == 1:
                (alternative,) = self.grammar.by_name[name].alternatives
                pair = bracket_pairs(alternative)
                if pair and pair[0][1:] == (0, len(alternative.elements) - 1):
                    found[pair[0][0]] = name
        return found

    @cached_property
    def following(self) -> Mapping[int, str]:
        """Rules in brackets that only follow operands, as an index does, by the opening token."""
        display = self.recognizer.lexer.display
        return {
            kind: rule
            for kind, sign in enumerate(display)
            if (rule := self.bracketed.get(sign)) and rule in self.recursive - {*self.ladder}
        }

    @cached_property
    def followed(self) -> Mapping[str, Operand]:
        """Examples of a name with each rule of ``following``, by the rule and by its sign."""
        lexer = self.recognizer.lexer
        found: dict[str, Operand] = {}
        for opening, rule in self.following.items():
            sign = lexer.display[opening]
            closing = lexer.display.index(BRACKETS[sign])
            example = Operand((self.lexer.name_kind, opening, self.lexer.name_kind, closing))
            if rule in self.matcher.rules_for(example.kinds[1:]):
                found |= {rule: example, f"'{sign}'": example}
        return found

    @cached_property
    def words_in_brackets(self) -> Mapping[int, frozenset[int]]:
        """Reserved words that rules of no operands write in brackets, by the opening token.

        What they have as names, or in operands, is left out.
        """
        skipped = {*self.recursive, *self.ladder, self.names, *self.type_rules}
        called = {name: some for name, some in self._called.items() if name not in skipped}
        kind_of, found = self.lexer.kind_of, defaultdict[int, set[int]](set)
        for _, sequence in (s for r in called for s in sequences(self.grammar.by_name[r])):
            for sign, start, end in bracket_pairs(sequence):
                inner = [e for part in sequence.elements[start + 1 : end] for e in walk(part)]
                names = {e.name for e in inner if isinstance(e, Reference)} - skipped
                names.update(*(reached(called, name) for name in names))
                words = {kind_of[name] for name in names & kind_of.keys()}
                found[self.lexer.display.index(sign)] |= set(filter(self.lexer.is_keyword, words))
        return {opening: frozenset(kinds) for opening, kinds in found.items()}

    def is_part(self, rule: str) -> bool:
        """Return whether a rule is used by one other rule only."""
        return rule not in self.ladder and sum(rule in c for c in self._called.values()) == 1

    @cached_property
    def beside(self) -> frozenset[tuple[str, str]]:
        """Signs with the reserved words that some rule writes right behind them."""
        found: set[tuple[str, str]] = set()
        for rule in self.grammar.parser_rules:
            for _, sequence in sequences(rule):
                for left, right in pairwise(sequence.elements):
                    if isinstance(left, Literal):
                        words = (e.name for e in walk(right) if isinstance(e, Reference))
                        found.update((left.text, word) for word in words if word[0].isupper())
        return frozenset(found)


def is_optional(element: Element) -> bool:
    """Return whether an element may be missing."""
    return isinstance(element, Repeat) and element.operator != "+"


def bracket_pairs(sequence: Alternative) -> list[tuple[str, int, int]]:
    """Return pairs of brackets that a sequence writes: the opening one, and the indices of both."""
    out = []
    elements = sequence.elements
    for start, element in enumerate(elements):
        if isinstance(element, Literal) and element.text in BRACKETS:
            for end in range(start + 1, len(elements)):
                other = elements[end]
                if isinstance(other, Literal) and other.text == BRACKETS[element.text]:
                    out.append((element.text, start, end))
                    break
    return out
