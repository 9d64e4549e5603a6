"""The profile of a grammar: what kind each rule is, by which edits are ranked.

It covers how many rules lead to a rule, which rules are choices of statements or operands, which
end with a line end or are blocks, and what they contain elsewhere.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator
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
    Rule,
    reached,
    referred,
    walk,
)
from grammar.parser.recognizer import Recognizer
from recovery.forms.keywords import Vocabulary
from recovery.forms.symbols import Token
from recovery.tuning import HUB_ALTERNATIVES, SAME_TEXT_BONUS, WIDTH_PER_DOUBLING

_NAMES = re.compile(r"\w+")


class GrammarProfile:
    """Properties of the rules of one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.grammar = recognizer.grammar
        self.vocabulary = Vocabulary(recognizer)
        self._sequences: dict[str, dict[Address, Alternative]] = {}

    def sequence(self, rule: str, address: Address) -> Alternative:
        """Return the alternative at an address of a rule."""
        known = self._sequences.get(rule)
        if known is None:
            known = self._sequences[rule] = dict(sequences(self.grammar.by_name[rule]))
        return known[address]

    def alternatives(self, rule: str) -> frozenset[str]:
        """Return the alternatives of a rule, as written."""
        return self._alternatives[rule]

    @cached_property
    def _alternatives(self) -> dict[str, frozenset[str]]:
        return {
            rule.name: frozenset(map(rule.in_line, rule.alternatives))
            for rule in self.grammar.parser_rules
        }

    def closing(self, rule: str) -> str | None:
        """Return the line end with which every alternative of a rule ends, or ``None``.

        An alternative that is a rule with such an end counts too.
        """
        return self.line_end if rule in self._closed else None

    @cached_property
    def _closed(self) -> frozenset[str]:
        """Rules whose alternatives end with a line end that they write themselves."""
        found: set[str] = set()
        for _ in range(2):  # a rule that is only another rule is at most one level deep
            for rule in self.grammar.parser_rules:
                ends = [
                    end
                    for a in rule.alternatives
                    # the end of a block tells nothing about lines
                    if (end := self._last(rule, a)) or not self._is_block(rule, a)
                ]
                if self.line_end in ends and all(e == self.line_end or e in found for e in ends):
                    found.add(rule.name)
        return frozenset(found)

    def _is_block(self, rule: Rule, alternative: Alternative) -> bool:
        """Return whether there is a line end inside an alternative."""
        return self.line_end in map(rule.source_of, alternative.elements[:-1])

    def _last(self, rule: Rule, alternative: Alternative) -> str:
        """Return the last element of an alternative if it is a line end or the only element."""
        elements = alternative.elements
        text = rule.source_of(elements[-1]) if elements else ""
        return text if text == self.line_end or len(elements) == 1 else ""

    @cached_property
    def choices_of_lines(self) -> frozenset[str]:
        """Rules whose alternatives end with a line end, or are all blocks."""
        ending = {rule.name for rule in self.grammar.rules if self.closing(rule.name)}
        return self.choices_of_blocks.union(ending) - self.line_ends

    @cached_property
    def choices_of_blocks(self) -> frozenset[str]:
        """Rules whose alternatives are all blocks."""
        return frozenset(
            rule.name
            for rule in self.grammar.parser_rules
            if all(
                len(a.elements) == 1
                and isinstance(e := a.elements[0], Reference)
                and e.name in self.blocks
                for a in rule.alternatives
            )
        )

    def unused_in(self, text: str) -> frozenset[str]:
        """Return the rules in a text that nothing in the grammar calls."""
        return self._unused.intersection(_NAMES.findall(text))

    def is_free(self, name: str) -> bool:
        """Return whether a name is that of an uncalled rule, or of no rule."""
        return name in self._unused or name not in self.recognizer.network.entry

    def same_text_bonus(self, text: str) -> int:
        """Return the bonus for a text that some rule has as an optional or repeated part.

        A rule that nothing calls was probably written for what is missing, too.
        """
        is_known = "".join(text.split()) in self._element_texts or bool(self.unused_in(text))
        return SAME_TEXT_BONUS if is_known else 0

    def usual_place(self, rule: str, at: Address, text: str) -> Address | None:
        """Return where a part belongs, judged by its neighbours in other sequences.

        After optional parts a line does not show the order. Returns ``None`` if there is no
        evidence for a place before ``at``.
        """
        elements = self.sequence(rule, at[:-1]).elements
        source = self.grammar.by_name[rule].source_of
        said = ["", *("".join(source(e).split()) for e in elements), ""]
        new = "".join(text.split())

        def alike(place: int) -> int:
            return ((said[place - 1], new) in self._beside) + ((new, said[place]) in self._beside)

        first = at[-1]
        while first > 1 and isinstance(e := elements[first - 2], Repeat) and e.operator != "+":
            first -= 1
        best = max(range(first, at[-1] + 1), key=lambda place: (alike(place), place))
        return (*at[:-1], best) if best < at[-1] else None

    @cached_property
    def _beside(self) -> frozenset[tuple[str, str]]:
        """Pairs of element texts that are neighbours in some sequence."""
        found: set[tuple[str, str]] = set()
        for rule in self.grammar.parser_rules:
            for _, sequence in sequences(rule):
                said = ["", *("".join(rule.source_of(e).split()) for e in sequence.elements), ""]
                found |= set(pairwise(said))
        return frozenset(found)

    @cached_property
    def _element_texts(self) -> frozenset[str]:
        return frozenset(
            "".join(rule.source_of(element).split())
            for rule in self.grammar.parser_rules
            for element in walk(rule)
            if isinstance(element, Repeat)
        )

    @cached_property
    def _unused(self) -> frozenset[str]:
        network = self.recognizer.network
        used = {network.rule[entry] for calls in network.calls for entry, _ in calls}
        return frozenset(network.entry) - used - {self.grammar.start}

    def operands(self, text: str) -> frozenset[str]:
        """Return the names in a text without keywords; none for a text with a keyword."""
        names = frozenset(_NAMES.findall(text))
        lexer = self.recognizer.lexer
        known = self.grammar.by_name
        words = (n for n in names if n not in known or lexer.is_keyword(lexer.kind_of.get(n, 0)))
        return frozenset() if any(words) else names & known.keys()

    def is_single_reference(self, rule: str) -> bool:
        """Return whether a rule consists of another rule only."""
        alternatives = self.grammar.by_name[rule].alternatives
        elements = [e for a in alternatives for e in a.elements]
        return (
            len(elements) == 1 and isinstance(elements[0], Reference) and not (elements[0].is_token)
        )

    def is_hub(self, rule: str) -> bool:
        """Return whether a rule is a choice between many alternatives."""
        return len(self.grammar.by_name[rule].alternatives) >= HUB_ALTERNATIVES

    def has_choice(self, rule: str) -> bool:
        """Return whether a rule has more than one alternative."""
        return len(self.grammar.by_name[rule].alternatives) > 1

    def near(self, rule: str) -> frozenset[str]:
        """Return the rules that a rule refers to."""
        return frozenset(n for n in referred(self.grammar.by_name[rule]) if not n[0].isupper())

    def width(self, rule: str) -> int:
        """Return how far an edit of a rule reaches: the more rules lead to it, the further."""
        return self._ancestors[rule]

    @cached_property
    def _ancestors(self) -> dict[str, int]:
        return {
            name: round(WIDTH_PER_DOUBLING * math.log2(1 + len(reached(self.callers, name))))
            for name in self.callers
        }

    @cached_property
    def callers(self) -> dict[str, set[str]]:
        """The callers of each rule."""
        network = self.recognizer.network
        callers: dict[str, set[str]] = {name: set() for name in network.entry}
        for position, calls in enumerate(network.calls):
            for entry, _ in calls:
                callers[network.rule[entry]].add(network.rule[position])
        return callers

    @cached_property
    def blocks(self) -> frozenset[str]:
        """Rules of several lines: with a line end that is not their last element."""
        return frozenset(
            rule.name
            for rule in self.grammar.parser_rules
            if any(
                isinstance(e, Reference)
                and e.name in {*self.line_ends, self.recognizer.lexer.line_end}
                for a in rule.alternatives
                for e in a.elements[:-1]
            )
        )

    def has_only_blocks(self, rule: str) -> bool:
        """Return whether each alternative of a rule is a block that it writes: a line is none."""
        found = self.grammar.by_name[rule]
        return all(self._is_block(found, a) for a in found.alternatives)

    @cached_property
    def openers(self) -> frozenset[str]:
        """Keywords with which blocks begin and nothing else: what else does is no block."""
        first = [
            (rule.name in self.blocks, rule.source_of(a.elements[0]))
            for rule in self.grammar.parser_rules
            for a in rule.alternatives
            if a.elements and self.vocabulary.is_keyword(a.elements[0])
        ]
        others = {word for is_block, word in first if not is_block}
        return frozenset(word for is_block, word in first if is_block) - others

    @cached_property
    def line_ends(self) -> frozenset[str]:
        """Rules that consist only of line ends."""
        return frozenset(
            rule.name
            for rule in self.grammar.parser_rules
            if all(
                isinstance(e, Reference) and e.name == self.recognizer.lexer.line_end
                for e in walk(rule)
                if not isinstance(e, Repeat | Group)
            )
        )

    @cached_property
    def line_end(self) -> str:
        """The symbol that a rule writes for a line end."""
        return min(self.line_ends, default=self.recognizer.lexer.line_end)

    def ends_a_line(self, element: Element) -> bool:
        """Return whether an element is a line end, or lines in a row."""
        item = element.item if isinstance(element, Repeat) else element
        if not isinstance(item, Reference):
            return False
        ends = {*self.line_ends, self.recognizer.lexer.line_end}
        return item.name in ends or (item is not element and self.closing(item.name) is not None)

    def is_new_word(self, token: Token) -> bool:
        """Return whether a token is a keyword that no rule uses."""
        kind, keyword = token
        lexer = self.recognizer.lexer
        return keyword is not None or (
            lexer.is_keyword(kind) and not self.vocabulary.is_written(lexer.names[kind])
        )

    @cached_property
    def loops(self) -> frozenset[str]:
        """Rules that some rule repeats."""
        return frozenset(
            e.item.name
            for rule in self.grammar.parser_rules
            for e in walk(rule)
            if isinstance(e, Repeat) and e.operator != "?" and isinstance(e.item, Reference)
        )

    @cached_property
    def bodies(self) -> list[tuple[str, ...]]:
        """The bodies of blocks in the grammar, the most frequent first."""
        found: Counter[tuple[str, ...]] = Counter()
        for rule in self.grammar.parser_rules:
            for _, sequence in sequences(rule):
                body: list[str] = []
                within = False
                for element in sequence.elements:
                    text = rule.source_of(element)
                    if text == self.line_end:
                        within, body = True, []
                    elif within and isinstance(element, Repeat) and text in self._line_loops:
                        body.append(text)
                    elif within and body:
                        found[tuple(body)] += 1
                        within = False
                if within and body:
                    found[tuple(body)] += 1
        return sorted(found, key=lambda body: (-found[body], body))

    @cached_property
    def _line_loops(self) -> frozenset[str]:
        return frozenset(f"{name}*" for name in self.loops - self.line_ends)

    # ------------------------------------------------------------------------------- elements

    def first(self, sequence: Alternative, number: int) -> frozenset[int]:
        """Return the tokens with which the element at a place begins.

        Rules are only expanded if they are a choice of keywords.
        """
        if number > len(sequence.elements):
            return frozenset()
        return frozenset(self._tokens(sequence.elements[number - 1]))

    def _tokens(self, element: Element) -> Iterator[int]:
        lexer = self.recognizer.lexer
        if isinstance(element, Repeat):
            yield from self._tokens(element.item)
        elif isinstance(element, Group):
            for alternative in element.alternatives:
                if alternative.elements:
                    yield from self._tokens(alternative.elements[0])
        elif isinstance(element, Literal) or (isinstance(element, Reference) and element.is_token):
            yield lexer.kind_of[self.grammar.token_of(element)]
        elif isinstance(element, Reference):
            kinds = {lexer.kind_of[word] for word in self.vocabulary.words_of(element.name)}
            if all(map(lexer.is_keyword, kinds)):
                yield from kinds

    def is_at_start(self, rule: str, at: Address) -> bool:
        """Return whether a place can be reached before the rule has read a token."""
        network = self.recognizer.network
        entry = network.entry[rule]
        places = network.automata[rule].places
        return any(
            not returns and at in places[position - entry]
            for position, returns in network.reach(entry).sites
            if network.rule[position] == rule
        )
