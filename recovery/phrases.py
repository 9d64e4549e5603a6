"""Phrases: from the tokens a grammar did not expect to the words of a rule that would.

The same tokens can be written into a rule as they are (``STEP 2``), or with rules in place of
operands (``STEP literal``, ``STEP expression``). The first is the most restrictive; which is right
is for the corpus and the negatives to tell, so all are proposed.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import islice, product

from grammar.lexer import ERROR
from grammar.recognizer import Recognizer, State
from recovery.habits import Before, Habits, symbols_in
from recovery.layout import HUB

__all__ = ["Phraser", "Word"]

#: A token of a line: its kind and, where it is a name meant as a keyword, that keyword.
Word = tuple[int, str | None]

_LONGEST_PHRASE = 24
_LONGEST_CUT = 120  # words; the cost grows with the cube, and no statement has so many parts
_MOST_SYMBOLS = 8
_MOST_SPELLINGS = 12
_MOST_REMEMBERED = 200_000
_NAMES = re.compile(r"\w+")
_OPENING, _CLOSING = frozenset("([{"), frozenset(")]}")
# What a rule that reads several operands in a row costs for each seam: more than writing them out.
_LOOSE = 30
# What a rule costs at most where it usually stands, and what it costs more to be narrower than it.
_USUAL = 2
_UNUSUAL = 5


class Phraser:
    """Writes phrases with the rules of one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.habits = Habits(recognizer)
        self._cuts: dict[tuple[Word, ...], list[tuple[Word, ...]] | None] = {}
        self._begun: dict[tuple[int, ...], Mapping[str, State]] = {}
        self._spans: dict[tuple[int, ...], frozenset[str]] = {}
        self._a_name = (recognizer.lexer.kind_of.get("NAME", ERROR),)

    @cached_property
    def _entries(self) -> dict[str, State]:
        """A state at the start of each rule that stands for part of a line."""
        network = self.recognizer.network
        return {
            rule: self.recognizer.at_rule(rule)
            for rule in network.entry
            if rule != self.recognizer.grammar.start
        }

    @cached_property
    def _callers(self) -> dict[str, frozenset[str]]:
        """For each rule the other rules that call it."""
        network = self.recognizer.network
        callers: dict[str, set[str]] = {name: set() for name in network.entry}
        for position, calls in enumerate(network.calls):
            for entry, _ in calls:
                callers[network.rule[entry]].add(network.rule[position])
        return {name: frozenset(found - {name}) for name, found in callers.items()}

    def _is_one_level(self, rule: str) -> bool:
        """Whether a rule is only a step within another that stands for it alone.

        One of many kinds that a rule gathers is no step.
        """
        known = self.recognizer.grammar.by_name
        return len(self._callers[rule]) == 1 and all(
            rule in self._wider[caller] and len(known[caller].alternatives) < HUB
            for caller in self._callers[rule]
        )

    @cached_property
    def _uses(self) -> dict[str, int]:
        """How often each rule is called: the more, the more general its role."""
        network = self.recognizer.network
        counts = dict.fromkeys(network.entry, 0)
        for calls in network.calls:
            for entry, _ in calls:
                counts[network.rule[entry]] += 1
        return counts

    @cached_property
    def _wider(self) -> dict[str, frozenset[str]]:
        """For each rule the rules it stands for alone (``expression`` for ``literal``)."""
        network = self.recognizer.network
        direct = {
            rule: {
                network.rule[callee] for callee, back in network.calls[entry] if network.final[back]
            }
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

    def would_be_read_twice(self, rule: str, symbol: str) -> bool:
        """Whether what stands for a rule alone reads a keyword that the rule would read too.

        That a list of almost all keywords has it says nothing.
        """
        kind = self.recognizer.lexer.kind_of.get(symbol)
        readers = self.rules_for((kind,)) - self._careless if kind is not None else frozenset()
        return any(rule in self._wider[reader] for reader in readers)

    def is_unused(self, rule: str) -> bool:
        """Whether nothing calls a rule."""
        return not self._uses[rule]

    def opened_by(self, kinds: Sequence[int]) -> list[str]:
        """Rules that go on over the end of a line which begins them so."""
        ends = self.recognizer.ends
        return [rule for rule, state in self._read(tuple(kinds)).items() if not ends(state)]

    def rules_for(self, kinds: tuple[int, ...]) -> frozenset[str]:
        """Rules of which these tokens are a whole sentence."""
        found = self._spans.get(kinds)
        if found is None:
            if len(self._spans) >= _MOST_REMEMBERED:
                self._spans.clear()
            ends = self.recognizer.ends
            read = self._read(kinds).items()
            found = self._spans[kinds] = frozenset(rule for rule, state in read if ends(state))
        return found

    def _read(self, kinds: tuple[int, ...]) -> Mapping[str, State]:
        """Rules that can begin with these tokens, with the state behind them.

        Phrases are asked for with all that they begin with, so each is read one token further.
        """
        known = len(kinds)
        while known and kinds[:known] not in self._begun:
            known -= 1
        states = self._begun[kinds[:known]] if known else self._entries
        for count in range(known, len(kinds)):
            following = {rule: self.recognizer.step(s, kinds[count]) for rule, s in states.items()}
            states = {rule: state for rule, state in following.items() if state is not None}
            if count < _LONGEST_PHRASE:
                if len(self._begun) >= _MOST_REMEMBERED:
                    self._begun.clear()
                self._begun[kinds[: count + 1]] = states
        return states

    def breadth(self, symbols: Sequence[str]) -> int:
        """How much a phrase lets in: nothing for tokens, more for rules that stand for more.

        What the grammar usually writes in such a place (`recovery.habits`) counts little; what is
        narrower than that counts as unlikely to be all that is meant.
        """
        return sum(self._cost(before, symbol) for before, symbol in symbols_in(symbols))

    def _cost(self, before: Before, symbol: str) -> int:
        rule = self.habits.written_by.get(symbol, symbol)
        if rule not in self._wider:
            return 0
        cost = 1 + len(self._wider[rule]) + (rule != symbol)
        usual = self.habits.usual(before)
        if 2 * usual.get(symbol, 0) > sum(usual.values()):
            return min(cost, _USUAL)
        is_narrower = symbol not in usual and any(
            rule == u or rule in self._wider.get(u, ()) for u in usual
        )
        return cost + (_UNUSUAL if is_narrower else 0)

    def sign(self, span: Sequence[Word]) -> str | None:
        """The text of a keyword or sign; ``None`` for what carries a value."""
        if len(span) != 1 or (span[0][1] is None and self._is_operand(span[0][0])):
            return None
        return self._token(span[0])

    def stands_for_a_rule(self, span: Sequence[Word], *, is_listed: bool) -> bool:
        """Whether some rule reads the span by itself (``TRUE`` is a literal too).

        That a rule which reads almost any keyword reads this one says nothing, unless the keyword
        is an item of a list.
        """
        if any(keyword is not None for _, keyword in span):
            return False
        kinds = tuple(kind for kind, _ in span)
        return bool(self.rules_for(kinds)) if is_listed else self._means_more(kinds)

    def _means_more(self, kinds: tuple[int, ...]) -> bool:
        """Whether some rule reads the tokens that would not with any name for the first of them."""
        rules = self.rules_for(kinds) - self._careless
        lexer = self.recognizer.lexer
        if rules and lexer.is_keyword(kinds[0]):
            rules -= self.rules_for((*self._a_name, *kinds[1:]))
        return bool(rules)

    @cached_property
    def _careless(self) -> frozenset[str]:
        """Rules that read many keywords by themselves."""
        lexer = self.recognizer.lexer
        keywords = [kind for kind in lexer.kind_of.values() if lexer.is_keyword(kind)]
        counts = Counter(rule for kind in keywords for rule in self.rules_for((kind,)))
        return frozenset(rule for rule, count in counts.items() if 4 * count > len(keywords))

    def rules_for_all(
        self, spans: Sequence[tuple[Word, ...]], near: frozenset[str] = frozenset()
    ) -> tuple[str, ...]:
        """What can stand for each of the spans, from the narrowest to the widest."""
        if any(keyword is not None or kind < 0 for span in spans for kind, keyword in span):
            return ()
        kinds = {tuple(kind for kind, _ in span) for span in spans}
        rules = frozenset.intersection(*map(self.rules_for, kinds))
        token = self._token(spans[0][0]) if len(kinds) == 1 and len(spans[0]) == 1 else None
        if not rules:
            return (token,) if token else ()
        return self._levels_of(rules, near)

    def phrases(
        self, words: Sequence[Word], near: frozenset[str] = frozenset()
    ) -> Iterator[tuple[str, ...]]:
        """Symbols for the words, the most restrictive first; none where they are too many.

        ``near`` names rules that stand close by in the grammar: they are tried for operands too.
        """
        if not words or len(words) > _LONGEST_PHRASE:
            return
        seen: set[tuple[str, ...]] = set()
        for symbols in self._spellings(words, near):
            for shape in (symbols, as_list(symbols)):
                if len(shape) <= _MOST_SYMBOLS and shape not in seen:
                    seen.add(shape)
                    yield shape

    def _spellings(self, words: Sequence[Word], near: frozenset[str]) -> Iterator[tuple[str, ...]]:
        """The words as they are, then with rules for their operands, narrow ones first."""
        parts = self.parts(words)
        if parts is None:
            return
        plain = [self._token(word) for word in words]
        if all(plain):
            tokens = tuple(token for token in plain if token)
            yield tokens
            yield tuple(self.habits.written_by.get(token, token) for token in tokens)
        choices = [self._levels(part, near) for part in parts]
        if all(choices):
            for level in (0, -1):
                yield self._as_usual(parts, [levels[level] for levels in choices])
            yield from islice(product(*choices), _MOST_SPELLINGS)

    def _as_usual(self, parts: Sequence[tuple[Word, ...]], symbols: list[str]) -> tuple[str, ...]:
        """The symbols, with what the grammar usually writes where that reads the parts."""
        before = ("", "")
        for place, part in enumerate(parts):
            symbols[place] = self.usual_for([part], before) or symbols[place]
            before = (before[1], symbols[place])
        return tuple(symbols)

    def usual_for(self, spans: Sequence[tuple[Word, ...]], before: Before) -> str | None:
        """The rule that usually stands in such a place, where it reads all the spans."""
        if any(keyword is not None for span in spans for _, keyword in span):
            return None
        kinds = {tuple(kind for kind, _ in span) for span in spans}
        usual = self.habits.usual(before)
        fitting = [
            rule
            for rule in usual
            if rule in self._wider and all(rule in self.rules_for(k) for k in kinds)
        ]
        return min(fitting, key=lambda r: (-usual[r], len(self._wider[r]), r), default=None)

    def parts(self, words: Sequence[Word]) -> list[tuple[Word, ...]] | None:
        """The words cut into the fewest operands and single tokens, unless they are too many."""
        if len(words) > _LONGEST_CUT:
            return None
        key = tuple(words)
        if key not in self._cuts:
            if len(self._cuts) >= _MOST_REMEMBERED:
                self._cuts.clear()
            self._cuts[key] = self._cut(key)
        return self._cuts[key]

    def _cut(self, words: tuple[Word, ...]) -> list[tuple[Word, ...]] | None:
        count = len(words)
        best: list[tuple[int, list[tuple[Word, ...]]] | None] = [None] * count + [(0, [])]
        for start in range(count - 1, -1, -1):
            for end in range(start + 1, count + 1):
                rest, part = best[end], words[start:end]
                if rest is None or not self._can_be_written(part):
                    continue
                cost = rest[0] + (10 if len(part) == 1 else 9 + _LOOSE * self._seams(part))
                known = best[start]
                if known is None or cost < known[0]:
                    best[start] = (cost, [part, *rest[1]])
        return best[0][1] if best[0] else None

    def _seams(self, part: tuple[Word, ...]) -> int:
        """Where a part could fall into operands: at commas outside of brackets, between values."""
        depth = seams = 0
        was_value = False
        first = part[0][0]
        if self.recognizer.lexer.is_keyword(first):  # what follows a word belongs to it
            kinds = tuple(kind for kind, _ in part)
            is_operand = not self._of_values.isdisjoint(self.rules_for(kinds))
            is_a_name = not self._of_values.isdisjoint(self.rules_for((first,)))
            if not (is_operand and is_a_name):
                return int(not is_operand and not self._means_more(kinds))
        for kind, _ in part:
            text = self.recognizer.lexer.display[kind]
            depth += (text in _OPENING) - (text in _CLOSING)
            is_value = depth == 0 and (self._is_operand(kind) or self._may_be_a_name(kind))
            seams += (depth == 0 and text == ",") + (is_value and was_value)
            was_value = is_value
        return seams

    @cached_property
    def _of_values(self) -> frozenset[str]:
        """Rules that read a name as well as values of other kinds."""
        kinds = [(k,) for k in self.recognizer.lexer.kind_of.values() if self._is_operand(k)]
        others = frozenset[str]().union(*(self.rules_for(k) for k in kinds if k != self._a_name))
        return self.rules_for(self._a_name) & others

    def _may_be_a_name(self, kind: int) -> bool:
        """Whether a token is a reserved word that some rules read as any other name."""
        is_word = self.recognizer.lexer.is_keyword(kind)
        return is_word and bool(self.rules_for((kind,)) - self._careless)

    def _can_be_written(self, part: tuple[Word, ...]) -> bool:
        """Whether a part is one token, or what some rule reads."""
        if len(part) == 1:
            return part[0][1] is not None or part[0][0] >= 0
        if any(keyword is not None or kind < 0 for kind, keyword in part):
            return False
        return bool(self.rules_for(tuple(kind for kind, _ in part)))

    def _levels(
        self, part: tuple[Word, ...], near: frozenset[str] = frozenset()
    ) -> tuple[str, ...]:
        """What can stand for a part: its token, or rules from the narrowest to the widest."""
        if len(part) == 1:
            token = self._token(part[0])
            if token is None or part[0][1] is not None:
                return () if token is None else (token,)
            if not self._is_operand(part[0][0]):
                if not self.recognizer.lexer.is_keyword(part[0][0]):
                    return (token,)
                kinds = (part[0][0],)
                rules = self.rules_for(kinds) - self._careless if self._means_more(kinds) else ()
                return (token, *(self._levels_of(frozenset(rules), near) if rules else ()))
        elif any(keyword is not None or kind < 0 for kind, keyword in part):
            return ()
        rules = self.rules_for(tuple(kind for kind, _ in part))
        if not rules:
            token = self._token(part[0])
            return (token,) if len(part) == 1 and token else ()
        return self._levels_of(rules, near)

    def _levels_of(self, rules: frozenset[str], near: frozenset[str]) -> tuple[str, ...]:
        close = sorted(rules & near)[:2]
        rules = frozenset(r for r in rules if not self._is_one_level(r)) or rules
        # a rule that nothing uses waits to be used: it comes first
        narrow = min(
            rules, key=lambda r: (self._uses[r] > 0, len(self._wider[r]), -self._uses[r], r)
        )
        wide = max(rules, key=lambda r: (self._uses[r], len(self._wider[r] & rules), r))
        return tuple(dict.fromkeys((narrow, *close, wide)))

    def _token(self, word: Word) -> str | None:
        kind, keyword = word
        if keyword is not None:
            return keyword
        return None if kind < 0 else self.spelled(kind)

    def _is_operand(self, kind: int) -> bool:
        """Whether a token carries a value of its own: a name, a number, a string."""
        display = self.recognizer.lexer.display[kind]
        return display == self.recognizer.lexer.names[kind] and not (
            self.recognizer.lexer.is_keyword(kind)
        )

    def spelled(self, kind: int) -> str:
        """A token as a rule writes it: keywords and kinds by name, signs quoted."""
        lexer = self.recognizer.lexer
        if lexer.is_keyword(kind) or lexer.display[kind] == lexer.names[kind]:
            return lexer.names[kind]
        return f"'{lexer.display[kind]}'"


def repeated(symbols: tuple[str, ...]) -> tuple[str, ...] | None:
    """The shortest unit that the symbols repeat, where they are more than one of it."""
    for size in range(1, len(symbols) // 2 + 1):
        unit = symbols[:size]
        if len(symbols) % size == 0 and unit * (len(symbols) // size) == symbols:
            return unit
    return None


def as_list(symbols: tuple[str, ...]) -> tuple[str, ...]:
    """``x a , a , a`` as ``x a (',' a)*``; other symbols as they are."""
    commas = [place for place, symbol in enumerate(symbols) if symbol == "','"]
    if not commas:
        return symbols
    size = (commas[1] if len(commas) > 1 else len(symbols)) - commas[0] - 1
    unit, lead = symbols[commas[0] - size : commas[0]], symbols[: commas[0]]
    if not 0 < size <= commas[0] or symbols[commas[0] :] != ("','", *unit) * len(commas):
        return symbols
    return (*lead, f"(',' {' '.join(unit)})*")
