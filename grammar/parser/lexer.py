"""The lexer, built from the lexer rules of a grammar with the semantics of ANTLR.

The longest match wins, then the first rule; a character that no rule matches is an ``ERROR`` token.
To be fast in plain Python, one compiled pattern cuts the text into lexemes, and each distinct
lexeme is classified once and cached.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from functools import cached_property
from itertools import accumulate, compress

from grammar.notation.model import (
    CharSet,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
)
from grammar.parser.lexer_automaton import (
    CharAutomaton,
    automaton_of,
    both_cases,
    class_of,
    first_characters,
    overlap,
    pattern_of,
)

#: Kinds below zero are not tokens of the grammar.
SKIPPED = -1
ERROR = -2
#: Stands for a token that a lexer does not have; no lexeme is of this kind.
ABSENT = -99
#: The end of the file, in every lexer.
EOF = 0

# The cache stays bounded on corpora of any size: long lexemes (strings) are not cached, and the
# cache is emptied when tables of points have filled it with numbers.
_LONGEST_REMEMBERED = 48
_MOST_REMEMBERED = 20_000
# ``re`` keeps some 100 bytes for each skipped lexeme of a row, to backtrack; a row is cut here.
_LONGEST_ROW = 50_000


#: Index of the rule, and kind: if two rules match the same text, the first one wins.
_Ranked = tuple[int, int]


class _Others:
    """The rules that are no literals: which of them a whole lexeme is.

    Patterns made of automata never backtrack. A rule may have none; then its automaton is run.
    """

    def __init__(self, grammar: Grammar, ranked: Sequence[tuple[Rule, _Ranked]]) -> None:
        automata = [automaton_of(grammar, [rule]) for rule, _ in ranked]
        patterns = [pattern_of(automaton) for automaton in automata]
        self._ranks = [rank for _, rank in ranked]
        self._automata = automata if None in patterns else []
        # the empty pattern is that of a rule that matches nothing but the empty text
        self._pattern = re.compile("|".join(f"({one or '(?!)'})" for one in patterns) or "(?!)")

    def kind(self, lexeme: str) -> _Ranked | None:
        """Return the rank of the first rule that matches, or ``None``."""
        if not self._automata:
            found = self._pattern.fullmatch(lexeme)
            return self._ranks[found.lastindex - 1] if found and found.lastindex else None
        length = len(lexeme)
        return next(
            (
                rank
                for rank, automaton in zip(self._ranks, self._automata, strict=True)
                if automaton.longest(lexeme, 0) == length
            ),
            None,
        )


class _Kinds(dict[str, int]):
    """Token kind by lexeme, filled on demand."""

    __slots__ = ("fold", "literals", "others")

    def __init__(
        self,
        literals: Mapping[str, _Ranked],
        others: _Others,
        fold: Callable[[str], str],
    ) -> None:
        self.literals = literals
        self.others = others
        self.fold = fold

    def __missing__(self, lexeme: str) -> int:
        kind = self._classify(lexeme)
        if len(lexeme) <= _LONGEST_REMEMBERED:
            if len(self) >= _MOST_REMEMBERED:
                self.clear()
            self[lexeme] = kind
        return kind

    def unreserved(self, lexeme: str) -> list[_Ranked]:
        """Return the kind of a lexeme if literals are left aside, as a list of at most one."""
        found = self.others.kind(lexeme)
        return [found] if found else []

    def _classify(self, lexeme: str) -> int:
        if not lexeme:
            return SKIPPED
        ways = self.unreserved(lexeme)
        # literals are ASCII or exact: str.upper would also fold letters that ANTLR keeps apart
        literal = self.literals.get(self.fold(lexeme) if lexeme.isascii() else lexeme)
        if literal is not None:
            ways.append(literal)
        return min(ways)[1] if ways else ERROR


class Lexer:
    """Cuts text into tokens.

    ``names[kind]`` is the name of a token; kind 0 is ``EOF``. ``display[kind]`` is the token as
    people read it in an expected set: its text for punctuation and keywords, otherwise its name.
    """

    def __init__(self, grammar: Grammar) -> None:
        rules = [r for r in grammar.rules if r.is_lexer and not r.is_fragment]
        self.names: tuple[str, ...] = ("EOF", *(r.name for r in rules))
        self.kind_of = {name: kind for kind, name in enumerate(self.names)}
        texts = {name: text for text, name in grammar.literal_tokens.items()}
        self.display = tuple(texts.get(name, name) for name in self.names)
        self._wider: dict[str, Lexer] = {}
        self._keywords = frozenset(
            self.kind_of[name] for name, text in texts.items() if text[0].isalpha()
        )
        self._signs = frozenset(map(self.kind_of.__getitem__, texts)) - self._keywords
        literals = {
            text: self._ranked(grammar.by_name[name])
            for text, name in grammar.literal_tokens.items()
        }
        names_of_literals = set(grammar.literal_tokens.values())
        others = [r for r in rules if r.name not in names_of_literals]
        classify = _Others(grammar, [(rule, self._ranked(rule)) for rule in others])
        fold: Callable[[str], str] = str.upper if grammar.case_insensitive else str
        self.kinds = _Kinds(literals, classify, fold)

        # A keyword that also matches as a name does not change where tokens end; without it the
        # automaton stays small.
        def is_other(rule: Rule) -> bool:
            found = classify.kind(_only_literal(rule))
            return found is not None and found[1] != SKIPPED

        cutting = [
            r for r in rules if r.is_skipped or r.name not in names_of_literals or not is_other(r)
        ]
        self._leaves_out_skipped = not any(r.is_skipped for r in rules)
        self._located: re.Pattern[str] | None = None
        self._pattern = self._pattern_for(grammar, cutting)

    def _ranked(self, rule: Rule) -> _Ranked:
        kind = self.kind_of[rule.name]
        return kind, SKIPPED if rule.is_skipped else kind

    def _pattern_for(self, grammar: Grammar, rules: list[Rule]) -> re.Pattern[str] | CharAutomaton:
        """Return the pattern that cuts lexemes; it also skips what the parser never sees if it can.

        Returns the automaton itself if no pattern is equivalent to it (`pattern_of`).
        """
        skipped = [r for r in rules if r.is_skipped]
        tokens = [r for r in rules if not r.is_skipped]
        if skipped and tokens:
            skip, token = automaton_of(grammar, skipped), automaton_of(grammar, tokens)
            if not overlap(first_characters(skip), first_characters(token)):
                skip_pattern, token_pattern = pattern_of(skip), pattern_of(token)
                if skip_pattern and token_pattern:
                    self._leaves_out_skipped = True
                    # The rest matches anywhere, so there is no backtracking. The group is not
                    # possessive, because Python 3.11.2 loses the position of one that fails.
                    gap = f"(?:{skip_pattern}){{0,{_LONGEST_ROW}}}"
                    lexeme = f"({token_pattern}|(?={skip_pattern})|[\\s\\S]|\\Z)"
                    self._located = re.compile(f"({gap}){lexeme}")
                    return re.compile(f"{gap}{lexeme}")
        automaton = automaton_of(grammar, rules)
        everything = pattern_of(automaton)
        return re.compile(f"({everything}|[\\s\\S])") if everything else automaton

    def with_keyword(self, word: str) -> Lexer:
        """Return the lexer with one more keyword; the kinds of all tokens keep their numbers.

        ``word`` has to be a name to this lexer, so that reserving it changes no token boundary.
        """
        known = self._wider.get(word)
        if known is not None:
            return known
        wider = self._wider[word] = copy(self)
        wider._wider = {}
        kind = len(self.names)
        wider.names = (*self.names, word)
        wider.display = (*self.display, word)
        wider.kind_of = {**self.kind_of, word: kind}
        wider._keywords = self._keywords | {kind}
        old = self.kinds
        wider.kinds = _Kinds({**old.literals, word: (0, kind)}, old.others, old.fold)
        return wider

    def is_keyword(self, kind: int) -> bool:
        """Return whether the kind is a reserved word."""
        return kind in self._keywords

    def is_sign(self, kind: int) -> bool:
        """Return whether the tokens of the kind have one text, which is no word."""
        return kind in self._signs

    def has_value(self, kind: int) -> bool:
        """Return whether the tokens of the kind have many texts: names, numbers, strings."""
        return not (self.is_sign(kind) or self.is_keyword(kind))

    def spelled(self, kind: int) -> str:
        """Return a token as it is written in a rule: by name, or quoted if it is a sign."""
        return f"'{self.display[kind]}'" if self.is_sign(kind) else self.names[kind]

    @cached_property
    def line_kind(self) -> int:
        """The kind of line ends; `ABSENT` if they are skipped or no token."""
        kind = self.kinds["\n"]
        return kind if kind > 0 else ABSENT

    @cached_property
    def name_kind(self) -> int:
        """The kind of names, or `ABSENT`: what most keywords would be if they were not reserved."""
        words = [*(self.display[kind] for kind in sorted(self._keywords)), "A", "a"]
        kinds = Counter(kind for word in words for _, kind in self.kinds.unreserved(word))
        return max((kind for kind in kinds if kind > 0), key=kinds.__getitem__, default=ABSENT)

    @cached_property
    def line_end(self) -> str:
        """The name of the line-end token; empty if there is none."""
        return "" if self.line_kind == ABSENT else self.names[self.line_kind]

    @cached_property
    def name(self) -> str:
        """The name of the token of names; empty if there is none."""
        return "" if self.name_kind == ABSENT else self.names[self.name_kind]

    @property
    def leaves_out_skipped(self) -> bool:
        """Whether `lexemes` returns tokens only."""
        return self._leaves_out_skipped

    def lexemes(self, text: str) -> list[str]:
        """Return the texts of the tokens in order, and skipped ones unless `leaves_out_skipped`."""
        if isinstance(self._pattern, CharAutomaton):
            return [text[start:end] for start, end in _spans(self._pattern, text)]
        found: list[str] = self._pattern.findall(text)
        while found and not found[-1]:  # skipped text at the end of the file
            found.pop()
        if len(text) > _LONGEST_ROW and "" in found:  # a row that was cut
            return list(filter(None, found))
        return found

    def offsets(self, text: str, start: int = 0) -> Iterator[int]:
        """Yield the offset in ``text`` of each of the `lexemes` from ``start`` on."""
        if isinstance(self._pattern, CharAutomaton):
            return (begin for begin, _ in _spans(self._pattern, text, start))
        matches = self._pattern.finditer(text, start)
        return (found.start(1) for found in matches if found[1])

    def located(self, text: str) -> tuple[list[str], list[int]]:
        """Return the text of each token and its offset, in less time than one after the other."""
        if self._located is None:
            pairs = zip(self.lexemes(text), self.offsets(text), strict=True)
            tokens = [pair for pair in pairs if self.kinds[pair[0]] != SKIPPED]
            return [lexeme for lexeme, _ in tokens], [offset for _, offset in tokens]
        pieces = self._located.split(text)  # in threes: nothing, what is skipped, the token
        del pieces[::3]
        ends = list(accumulate(map(len, pieces)))
        offsets, lexemes = ends[::2], pieces[1::2]
        while lexemes and not lexemes[-1]:  # skipped text at the end of the file
            offsets.pop()
            lexemes.pop()
        if len(text) > _LONGEST_ROW and "" in lexemes:  # a row that was cut
            offsets = list(compress(offsets, lexemes))
            lexemes = list(filter(None, lexemes))
        return lexemes, offsets


def _spans(automaton: CharAutomaton, text: str, start: int = 0) -> Iterator[tuple[int, int]]:
    """Yield the spans of lexemes by running the automaton, for lexers without a pattern."""
    while start < len(text):
        end = max(automaton.longest(text, start), start + 1)
        yield start, end
        start = end


def _only_literal(rule: Rule) -> str:
    element = rule.alternatives[0].elements[0]
    assert isinstance(element, Literal)
    return element.text


def regex_of(grammar: Grammar, rule: Rule) -> str:
    """Return a pattern for ``re`` that accepts the language of a lexer rule, for `fullmatch`."""

    def sequence(elements: tuple[Element, ...]) -> str:
        return "".join(map(element, elements))

    def element(node: Element) -> str:
        match node:
            case Literal(text=text):
                return "".join(character(((ord(c), ord(c)),)) for c in text)
            case CharSet(ranges=ranges):
                return character(ranges)
            case Reference(name=name):
                inner = grammar.by_name[name].alternatives
                return f"(?:{'|'.join(sequence(a.elements) for a in inner)})"
            case Group(alternatives=alternatives):
                return f"(?:{'|'.join(sequence(a.elements) for a in alternatives)})"
            case Repeat(item=item, operator=operator):
                return f"(?:{element(item)}){operator}"

    def character(ranges: tuple[tuple[int, int], ...]) -> str:
        return class_of(both_cases(ranges) if grammar.case_insensitive else ranges)

    return "|".join(sequence(a.elements) for a in rule.alternatives)


_lexers: dict[tuple[str, ...], Lexer] = {}


def lexer_of(grammar: Grammar) -> Lexer:
    """Return the lexer of a grammar; grammars with the same lexer rules share one."""
    key = (str(grammar.case_insensitive), *(r.text for r in grammar.rules if r.is_lexer))
    lexer = _lexers.get(key)
    if lexer is None:
        if len(_lexers) >= 64:
            _lexers.clear()
        lexer = _lexers[key] = Lexer(grammar)
    return lexer
