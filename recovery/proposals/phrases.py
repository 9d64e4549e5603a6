"""The rules that a phrase can have in place of operands, and how much each accepts.

The same tokens can be written as they are (``STEP 2``), or with rules in place of operands (``STEP
literal``, ``STEP expression``). The first is the most restrictive. Corpus and negatives decide
which is right, so all of them are proposed. `recovery.proposals.alignment` writes the phrases.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from functools import cached_property

from grammar.notation.model import Repeat, walk
from recovery import tuning
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import Token
from recovery.proposals.bracket_groups import BracketGroups
from recovery.proposals.collocations import Before, Collocations, symbols_in
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.segmentation import Segmenter


class Phraser:
    """Chooses the rules of one grammar for phrases."""

    def __init__(self, profile: GrammarProfile) -> None:
        self.profile = profile
        self.recognizer = recognizer = profile.recognizer
        self.collocations = Collocations(recognizer)
        self.matcher = RuleMatcher(recognizer)
        self.segmenter = Segmenter(self.matcher)
        self.groups = BracketGroups(self.matcher)
        self._breadths: dict[tuple[str, ...], int] = {}
        self._known_levels: dict[tuple[frozenset[str], frozenset[str]], tuple[str, ...]] = {}

    def _is_one_level(self, rule: str) -> bool:
        """Return whether a rule is only an intermediate level of its callers (``product``).

        One of many alternatives of a rule is no such level.
        """
        callers = self.profile.callers[rule] - {rule}
        return len(callers) == 1 and all(
            rule in self._wider[caller] and not self.profile.is_hub(caller) for caller in callers
        )

    @cached_property
    def _uses(self) -> dict[str, int]:
        """The number of calls of each rule: the more, the more general its role."""
        network = self.recognizer.network
        counts = dict.fromkeys(network.entry, 0)
        for calls in network.calls:
            for entry, _ in calls:
                counts[network.rule[entry]] += 1
        return counts

    @cached_property
    def _wider(self) -> dict[str, frozenset[str]]:
        """For each rule the rules that it can consist of alone (``literal`` for ``expression``).

        A line end behind them does not count.
        """
        network = self.recognizer.network

        def is_end(position: int) -> bool:
            behind = {network.rule[callee] for callee, _ in network.calls[position]}
            return network.final[position] or (bool(behind) and behind <= self.profile.line_ends)

        direct = {
            rule: {network.rule[callee] for callee, back in network.calls[entry] if is_end(back)}
            - self.profile.line_ends
            for rule, entry in network.entry.items()
        }
        out: dict[str, frozenset[str]] = {}

        def closed(rule: str) -> frozenset[str]:
            if rule not in out:
                out[rule] = frozenset(direct[rule]).union(*(closed(r) for r in direct[rule]))
            return out[rule]

        for rule in direct:
            closed(rule)
        return out

    def reads(self, rule: str, other: str) -> bool:
        """Return whether a rule can consist of another rule or token alone."""
        kind = self.recognizer.lexer.kind_of.get(other)
        return other in self._wider.get(rule, ()) or (
            kind is not None and rule in self.matcher.rules_for((kind,))
        )

    def would_be_read_twice(self, rule: str, symbol: str) -> bool:
        """Return whether a rule that can consist of ``rule`` alone already reads the keyword.

        Rules that read almost any keyword do not count.
        """
        kind = self.recognizer.lexer.kind_of.get(symbol)
        if kind is None:
            return False
        found = self.matcher.rules_for((kind,)) - self.matcher.keyword_lists
        return any(rule in self._wider[reader] for reader in found)

    def breadth(self, symbols: Sequence[str]) -> int:
        """Return how much a phrase accepts: nothing for tokens, more for more general rules.

        A rule that is usual at such a place (`recovery.proposals.collocations`) counts little; a
        narrower rule gets a penalty, because it is unlikely to be meant.
        """
        key = tuple(symbols)
        found = self._breadths.get(key)
        if found is None:
            found = sum(self._cost(before, symbol) for before, symbol in symbols_in(symbols))
            self._breadths[key] = found
        return found

    def _cost(self, before: Before, symbol: str) -> int:
        rule = self.collocations.written_by.get(symbol, symbol)
        if rule not in self._wider:
            return 0
        cost = (
            1
            + len(self._wider[rule])
            + (rule != symbol)
            + tuning.REPEATED_COST * self._repeats(rule)
        )
        usual = self.collocations.usual(before)
        if 2 * usual.get(symbol, 0) > sum(usual.values()):
            return min(cost, tuning.USUAL_RULE_COST)
        is_narrower = symbol not in usual and any(
            rule == u or rule in self._wider.get(u, ()) for u in usual
        )
        return cost + (tuning.NARROWER_RULE_COST if is_narrower else 0)

    def _repeats(self, rule: str) -> bool:
        """Return whether a rule repeats a part."""
        elements = walk(self.profile.grammar.by_name[rule])
        return any(isinstance(e, Repeat) and e.operator != "?" for e in elements)

    def stands_for_a_rule(self, span: Sequence[Token], *, is_listed: bool) -> bool:
        """Return whether some rule reads the span by itself (``TRUE`` is a literal too).

        A rule that reads almost any keyword does not count, unless the keyword is an item of a
        list.
        """
        if any(keyword is not None for _, keyword in span):
            return False
        kinds = tuple(kind for kind, _ in span)
        return (
            bool(self.matcher.rules_for(kinds))
            if is_listed
            else self.matcher.is_more_than_a_name(kinds)
        )

    def rules_for_all(
        self, spans: Sequence[tuple[Token, ...]], near: frozenset[str] = frozenset()
    ) -> tuple[str, ...]:
        """Return rules that read each of the spans, from the narrowest to the widest."""
        if any(keyword is not None or kind < 0 for span in spans for kind, keyword in span):
            return ()
        kinds = {tuple(kind for kind, _ in span) for span in spans}
        rules = frozenset.intersection(*map(self.matcher.rules_for, kinds))
        token = self.matcher.text(spans[0][0]) if len(kinds) == 1 and len(spans[0]) == 1 else None
        if not rules:
            return (token,) if token else ()
        levels = self._levels_of(rules, near)
        name = self.recognizer.lexer.name
        plain = self._fitted(name, kinds) if name else None
        return tuple(dict.fromkeys((plain, *levels))) if plain else levels

    def alone(self, words: Sequence[Token]) -> Iterator[tuple[str, ...]]:
        """Yield the words as tokens, then rules that read them, those that nothing calls first.

        Such a rule was probably written for this purpose. An operand may be any of the most used.
        """
        tokens = tuple(filter(None, map(self.matcher.text, words)))
        if len(tokens) == len(words):
            yield tokens
        if not any(keyword for _, keyword in words):
            rules = self.matcher.rules_for(tuple(kind for kind, _ in words))
            ordered = sorted(rules, key=lambda r: (self._uses[r] > 0, -self._uses[r], r))
            is_operand = len(self.segmenter.parts(words) or ()) == 1
            for rule in ordered[: tuning.MOST_OPERAND_RULES]:
                if is_operand or not self._uses[rule]:
                    yield (rule,)

    def usual_for(self, spans: Sequence[tuple[Token, ...]], before: Before) -> str | None:
        """Return what is usual at such a place if it reads all the spans, or ``None``."""
        if any(keyword is not None for span in spans for _, keyword in span):
            return None
        kinds = {tuple(kind for kind, _ in span) for span in spans}
        usual = self.collocations.usual(before)
        fitting = {symbol: self._fitted(symbol, kinds) for symbol in usual}
        best = min(
            (symbol for symbol in usual if fitting[symbol]),
            key=lambda s: (-usual[s], len(self._wider.get(s, ())), s),
            default=None,
        )
        return best and fitting[best]

    def _fitted(self, symbol: str, spans: Collection[tuple[int, ...]]) -> str | None:
        """Return the rule or token if it reads all the spans, a token with the groups behind it."""
        if symbol in self._wider:
            return symbol if self._reads_all(symbol, spans) else None
        kind = self.recognizer.lexer.kind_of.get(symbol)
        if any(span[0] != kind for span in spans):
            return None
        groups = {span[1:] for span in spans}
        rules = self.groups.rules.values()
        behind = [rule for rule in rules if self._reads_all(rule, groups - {()})]
        symbol = self.collocations.written_by.get(symbol, symbol)
        if groups == {()}:
            return symbol
        return f"{symbol} {behind[0]}{'?' if () in groups else ''}" if behind else None

    def _reads_all(self, rule: str, spans: Collection[tuple[int, ...]]) -> bool:
        return all(rule in self.matcher.rules_for(span) for span in spans)

    def _levels_of(self, rules: frozenset[str], near: frozenset[str]) -> tuple[str, ...]:
        found = self._known_levels.get((rules, near))
        if found is None:
            found = self._known_levels[rules, near] = self._narrow_to_wide(rules, near)
        return found

    def _narrow_to_wide(self, rules: frozenset[str], near: frozenset[str]) -> tuple[str, ...]:
        close = sorted(rules & near)[: tuning.MOST_NEAR_RULES]
        rules = frozenset(r for r in rules if not self._is_one_level(r)) or rules
        # an unused rule was probably written for this purpose, so it comes first
        narrow = min(
            rules, key=lambda r: (self._uses[r] > 0, len(self._wider[r]), -self._uses[r], r)
        )
        wide = max(rules, key=lambda r: (self._uses[r], len(self._wider[r] & rules), r))
        return tuple(dict.fromkeys((narrow, *close, wide)))
