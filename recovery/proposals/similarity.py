"""How similar an alternative is to those of a rule, to choose the rule that gets it.

A rule that is a choice of statements may get one more; a rule of a single form should not.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from difflib import SequenceMatcher
from functools import cached_property
from typing import NamedTuple

from grammar.notation.model import Alternative, Element, Group, Reference, Repeat, Rule
from recovery import tuning
from recovery.forms.parts import choices
from recovery.proposals.grammar_profile import GrammarProfile

_NAMES = re.compile(r"\w+")


class _Alternatives(NamedTuple):
    """The alternatives of a rule: the elements of each, the classes of these, their symbols."""

    written: list[list[str]]
    classes: list[list[str]]
    names: list[list[str]]


class Similarity:
    """Compares alternatives under one grammar."""

    def __init__(self, profile: GrammarProfile) -> None:
        self.profile = profile
        self.vocabulary = profile.vocabulary
        self._known: dict[str, _Alternatives] = {}
        self._leading_words: dict[str, frozenset[str]] = {}

    def dissimilarity(self, rule: str, symbols: Sequence[str]) -> int:
        """Return a penalty for an alternative of a rule; negative if the rule has a similar one.

        A rule with many alternatives takes more of them easily, a rule with one does not.
        """
        if self.profile.is_single_reference(rule):
            return 0
        if len(symbols) == 1 and self._is_one_of_words(rule):
            return (
                -tuning.STRONGEST_SIMILARITY_STEPS
                if self._begins_alike(rule, symbols)
                else -tuning.SIMILARITY_STEPS
            )
        if self.gathers(rule):
            return self._gathered_steps(rule, symbols)
        leads = self._leads(rule)
        if not leads.isdisjoint(choices(symbols[0])):
            # what goes on alike is another form of the same, which an edit of that shows better
            alike = any(some[1:2] == list(symbols[1:2]) for some in self._read(rule).written)
            return 0 if alike else -tuning.STRONG_SIMILARITY_STEPS
        if len(leads) == 1 and "" not in leads:
            return tuning.STRONG_SIMILARITY_STEPS
        return self._form_steps(rule, symbols)

    def _gathered_steps(self, rule: str, symbols: Sequence[str]) -> int:
        """Return the penalty for an alternative of a rule that gathers single rules."""
        if not self._is_single(symbols):
            return (
                tuning.STRONG_SIMILARITY_STEPS
                if self._is_known_by(rule, symbols[0])
                else tuning.LOOSE_GATHERING_COST
            )
        if not self.profile.is_free(symbols[0]):
            # it has its place already, beside some of these alternatives or others
            return -tuning.SIMILARITY_STEPS - self._shared(rule, symbols[0])
        return (
            -tuning.STRONGEST_SIMILARITY_STEPS
            if self._begins_alike(rule, symbols)
            else -tuning.STRONG_SIMILARITY_STEPS
        )

    def _form_steps(self, rule: str, symbols: Sequence[str]) -> int:
        """Return the penalty for an alternative by the most similar one of the rule.

        They are compared as sequences of symbol classes, where all keywords are one class, and by
        the symbols themselves.
        """
        known = self._read(rule)
        best = _likeness(list(map(self._class_of, symbols)), known.classes)
        if best >= tuning.SIMILAR_RATIO and len(known.classes) > 1:
            same = _likeness(_NAMES.findall(" ".join(symbols)), known.names)
            return -round(tuning.SIMILARITY_STEPS * (best + same))
        return tuning.NEW_FORM_COST + max(0, tuning.MANY_FORMS - len(known.classes))

    def _begins_alike(self, rule: str, symbols: Sequence[str]) -> bool:
        """Return whether an alternative of a rule begins with the same class of symbol."""
        kinds = {_kind(classes[0]) for classes in self._read(rule).classes if classes}
        return _kind(self._class_of(symbols[0])) in kinds

    def _read(self, rule: str) -> _Alternatives:
        """Return the alternatives of a rule as they are compared."""
        known = self._known.get(rule)
        if known is None:
            found = self.profile.grammar.by_name[rule]
            written = [list(map(found.source_of, a.elements)) for a in found.alternatives]
            classes = [list(map(self._class_of, some)) for some in written]
            names = [_NAMES.findall(" ".join(some)) for some in written]
            known = self._known[rule] = _Alternatives(written, classes, names)
        return known

    def _shared(self, rule: str, symbol: str) -> int:
        """Return how many alternatives a rule shares with one that has the symbol as another."""
        own = self.profile.alternatives(rule)
        rules = (r.name for r in self.profile.grammar.parser_rules)
        others = (self.profile.alternatives(r) for r in rules if r != rule)
        return max((len(own & o) for o in others if symbol in o), default=0)

    def _is_one_of_words(self, rule: str) -> bool:
        """Return whether a rule is a choice of words."""
        return self.profile.has_choice(rule) and self.vocabulary.is_set_of_words(rule)

    def _is_known_by(self, rule: str, word: str) -> bool:
        """Return whether a word begins one of the rules between which a rule chooses."""
        return any(
            rule in gathering and name in self.profile.callers and word in self._leads(name)
            for name, gathering in self._gathered.items()
        )

    def repeats_sibling(self, rule: str, symbols: Sequence[str]) -> bool:
        """Return whether the symbols begin with another alternative of the same choices.

        What can follow that rule belongs into it.
        """
        return len(symbols) > 1 and bool(
            self._gathered.get(rule, frozenset()) & self._gathered.get(symbols[0], frozenset())
        )

    def extends(self, rule: str, symbols: Sequence[str]) -> bool:
        """Return whether the symbols are an existing alternative with more before or after it.

        The addition is then an optional part of that alternative. So is a word before a rule that
        is a kind of statement.
        """
        found = self.profile.grammar.by_name[rule]
        for alternative in found.alternatives:
            known = [found.source_of(e) for e in alternative.elements]
            count = len(known)
            if 0 < count < len(symbols) and known in (
                list(symbols[:count]),
                list(symbols[-count:]),
            ):
                return True
        inner = symbols[1:-1] if symbols[-1] == self.profile.line_end else symbols[1:]
        is_kind = len(inner) == 1 and inner[0] in self._gathered
        return (
            is_kind and "" not in self._leads(inner[0]) and not self.vocabulary.words_of(inner[0])
        )

    def is_foreign(self, rule: str, symbols: Sequence[str]) -> bool:
        """Return whether a rule is one kind of statement, and the symbols are another kind.

        To a choice of words no phrase is added.
        """
        leads = self._leads(rule)
        if len(symbols) > 1 and self.profile.has_choice(rule) and self.vocabulary.words_of(rule):
            return True
        another_word = len(symbols) == 1 and self._is_one_of_words(rule)
        same_words = leads.issuperset(choices(symbols[0]))
        known = "" in leads or same_words or len(leads) >= tuning.HUB_ALTERNATIVES
        return rule in self._gathered and not (known or another_word)

    @cached_property
    def _gathered(self) -> dict[str, frozenset[str]]:
        """For each rule the rules that have it as an alternative."""
        found: dict[str, set[str]] = defaultdict(set)
        for rule in self.profile.grammar.parser_rules:
            if self.gathers(rule.name):
                for alternative in rule.alternatives:
                    only = self._only(rule, alternative)
                    if only is not None:
                        found[only.name].add(rule.name)
        return {name: frozenset(rules) for name, rules in found.items()}

    def gathers(self, rule: str) -> bool:
        """Return whether most alternatives of a rule are a single rule or token."""
        found = self.profile.grammar.by_name[rule]
        single = sum(self._only(found, a) is not None for a in found.alternatives)
        return len(found.alternatives) > 2 and 2 * single >= len(found.alternatives)

    def _only(self, rule: Rule, alternative: Alternative) -> Reference | None:
        """Return the single rule or token of an alternative, a line end after it ignored."""
        elements = alternative.elements
        if len(elements) == 2 and rule.source_of(elements[1]) == self.profile.line_end:
            elements = elements[:1]
        first = elements[0] if len(elements) == 1 else None
        return first if isinstance(first, Reference) else None

    def _is_single(self, symbols: Sequence[str]) -> bool:
        """Return whether the symbols are one rule or keyword, a line end after it ignored."""
        if len(symbols) == 2 and symbols[1] == self.profile.line_end:
            symbols = symbols[:1]
        if len(symbols) != 1:
            return False
        known = self.profile.grammar.by_name.get(symbols[0])
        is_rule = known is not None and not known.is_lexer
        return is_rule or self._class_of(symbols[0]) != symbols[0]

    def _leads(self, rule: str) -> frozenset[str]:
        """Return the keywords with which alternatives begin; an empty one for those without."""
        found = self._leading_words.get(rule)
        if found is None:
            alternatives = self.profile.grammar.by_name[rule].alternatives
            words = (self._words_of(a.elements) for a in alternatives)
            found = self._leading_words[rule] = frozenset(word for some in words for word in some)
        return found

    def _words_of(self, elements: Sequence[Element]) -> list[str]:
        """Return the keywords with which a sequence begins, optional elements skipped."""
        for element in elements:
            if not isinstance(element, Repeat) or element.operator == "+":
                return self._words(element)
        return [""]

    def _words(self, element: Element) -> list[str]:
        """Return the keyword or choice of keywords of an element; else an empty one."""
        if isinstance(element, Reference) and self.vocabulary.is_keyword(element):
            return [element.name]
        if isinstance(element, Group) and self.vocabulary.is_keyword(element):
            return [w for a in element.alternatives for w in self._words(a.elements[0])]
        return [""]

    def _class_of(self, symbol: str) -> str:
        words = choices(symbol)
        classes = set(map(self._class_of, words)) if len(words) > 1 else set()
        if len(classes) == 1:
            return classes.pop()
        suffix = symbol[-1] if symbol[-1] in "?*+" else ""
        name = symbol.rstrip("?*+")
        if name in self.profile.grammar.by_name and not name[0].isupper():
            if len(self.profile.callers[name]) > 1 or name in self.profile.line_ends:
                return symbol
            return ("block" if name in self.profile.blocks else "kind") + suffix
        lexer = self.profile.recognizer.lexer
        kind = lexer.kind_of.get(name)
        if name.isidentifier() and (kind is None or lexer.is_keyword(kind)):
            return "keyword" + suffix
        return symbol


def _likeness(new: Sequence[str], known: Sequence[Sequence[str]]) -> float:
    """Return how like a sequence is to the most similar one, 0 to 1."""
    matcher = SequenceMatcher(None, b=new, autojunk=False)
    best = 0.0
    for old in known:
        matcher.set_seq1(old)
        best = max(best, matcher.ratio())
    return best


def _kind(symbol: str) -> str:
    """Return the symbol, with all signs as one kind."""
    return "sign" if symbol[0] == "'" else symbol
