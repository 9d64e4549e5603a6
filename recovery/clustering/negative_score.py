"""Scoring an edit on negatives: how many programs it would wrongly accept.

A program that is newly accepted must use the text that the edit writes, and so contains every token
that this text always has. Therefore only a few of thousands of negatives have to be read.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence, Set
from functools import cache
from typing import Protocol

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    GrammarError,
    Group,
    Literal,
    Reference,
    Repeat,
)
from grammar.parser.recognizer import Recognizer
from recovery.clustering.detours import rule_of
from recovery.clustering.edit_trial import changed_rules, edited
from recovery.clustering.joint_trial import DetourReader, Path
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.tuning import GENERATED_NEGATIVES, MOST_CONFIGURATIONS_KEPT, NEGATIVES_SEED

#: Edits that compete with others for the same lines.
Rivals = Collection[tuple[Edit, ...]]


class NegativeCounter(Protocol):
    """Counts negatives: programs that must stay rejected."""

    def __call__(self, edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        """Return how many negatives the grammar would accept with the edits.

        Those that one of the ``rivals`` accepts also count if the edits read the line at which they
        fail: what leaves a block open accepts no program with it, and is no better for that.
        """
        ...


def no_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
    """Return 0: the `NegativeCounter` for a survey without negatives."""
    del edits, rivals
    return 0


def negative_counter(grammar: Grammar, negatives: Iterable[Negative]) -> NegativeCounter:
    """Return a function that counts the negatives that edits of ``grammar`` newly accept.

    They are ``negatives`` and a fixed sample of generated ones (`recovery.negatives.generate`),
    without those that the grammar accepts already.
    """
    recognizer = Recognizer(grammar)
    rejected = NegativeSet((*negatives, *_generated())).rejected_by(recognizer)
    programs = _Programs(recognizer, rejected)
    known: dict[tuple[Edit, ...], frozenset[int]] = {}
    nothing = frozenset[int]()

    def accepted(edits: tuple[Edit, ...]) -> frozenset[int]:
        if edits not in known:
            known[edits] = programs.accepted(edits)
        return known[edits]

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        own = accepted(tuple(edits))
        others = nothing.union(*map(accepted, rivals)) - own
        return len(own) + programs.count_read(edits, others)

    return count_negatives


class _Programs:
    """Negatives prepared for reading with edits of a grammar that rejects them."""

    def __init__(self, recognizer: Recognizer, negatives: NegativeSet) -> None:
        self._recognizer = recognizer
        self._negatives = negatives
        self._begin()

    def _begin(self) -> None:
        self._reader = DetourReader(self._recognizer.grammar, self._recognizer.network)
        self._paths: dict[tuple[int, ...], Path] = {}
        self._kinds: dict[frozenset[str], list[tuple[tuple[int, ...], frozenset[int]]]] = {}
        self._having: dict[tuple[frozenset[str], frozenset[int]], dict[int, Path]] = {}

    def accepted(self, edits: Sequence[Edit]) -> frozenset[int]:
        """Return the numbers of the negatives that the edits accept."""
        found = self._read(edits)
        if found is not None:
            return frozenset(number for number, _, failed in found if failed is None)
        wider = edited(self._recognizer, edits)
        tokens = wider and required_tokens(edits, self._recognizer.grammar, wider.lexer.kind_of)
        accepted = set(self._negatives.accepted(wider, tokens)) if wider and tokens else set()
        every = enumerate(self._negatives.negatives)
        return frozenset(number for number, negative in every if negative in accepted)

    def count_read(self, edits: Sequence[Edit], among: Set[int]) -> int:
        """Return how many of some negatives can be read beyond the line at which they fail.

        None is counted for edits that are no detours.
        """
        found = (self._read(edits) if among else None) or ()
        end = self._recognizer.lexer.line_kind
        return sum(
            failed is None or end in path.kinds[len(path.states) - 1 : failed]
            for number, path, failed in found
            if number in among
        )

    def _read(self, edits: Sequence[Edit]) -> list[tuple[int, Path, int | None]] | None:
        """Return the negatives that may be read further, with their path and where they fail.

        That is ``None`` if the edits are no detours, and none if they do not fit the grammar.
        """
        if self._reader.recognizer.configurations > MOST_CONFIGURATIONS_KEPT:
            self._reader.recognizer.release()
            self._begin()
        reader = self._reader
        try:
            detours = reader.detours(edits)
        except GrammarError:
            return []
        if detours is None:
            return None
        kind_of = {**self._recognizer.lexer.kind_of, **{w: reader.kind(w) for w in detours.words}}
        paths: dict[int, Path] = {}
        for tokens in required_tokens(edits, self._recognizer.grammar, kind_of):
            key = detours.words, tokens
            if key not in self._having:
                self._having[key] = {
                    number: self._path(kinds)
                    for number, (kinds, met) in enumerate(self._cut(detours.words, kind_of))
                    if tokens <= met
                }
            paths |= self._having[key]
        failed = reader.read(detours, paths.values())
        return [
            (number, path, at) for (number, path), at in zip(paths.items(), failed, strict=True)
        ]

    def _path(self, kinds: tuple[int, ...]) -> Path:
        if kinds not in self._paths:
            self._paths[kinds] = self._reader.path(kinds)
        return self._paths[kinds]

    def _cut(
        self, words: frozenset[str], kind_of: Mapping[str, int]
    ) -> list[tuple[tuple[int, ...], frozenset[int]]]:
        """Return the token kinds of each program, as list and as set, with the words reserved."""
        if words not in self._kinds:
            lexer = self._recognizer.lexer
            for word in sorted(words):
                lexer = lexer.with_keyword(word)
            kind_here = [kind_of[name] for name in lexer.names]
            programs = [
                tuple(kind_here[kind] if kind > 0 else kind for kind in program)
                for program in self._negatives.kinds(lexer)
            ]
            self._kinds[words] = [(program, frozenset(program)) for program in programs]
        return self._kinds[words]


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))


# ------------------------------------------------------------------------------ required tokens


def required_tokens(
    edits: Sequence[Edit], grammar: Grammar, kind_of: Mapping[str, int]
) -> list[frozenset[int]]:
    """Return, for each place the edits change, the token kinds that every new sentence has.

    ``grammar`` is the one that is edited; ``kind_of`` includes the words they reserve.
    """
    tokens = _Tokens(grammar, kind_of, changed_rules(edits))
    changes = [edit for edit in edits if not isinstance(edit, AddToken)]
    return list(dict.fromkeys(_of_edit(edit, tokens) for edit in changes))


def _of_edit(edit: Edit, tokens: _Tokens) -> frozenset[int]:
    if not isinstance(edit, Insert | Widen | AddAlternative):
        return frozenset()  # to leave something out needs no token
    return tokens.of_text(edit.text)


class _Tokens:
    """The tokens that every sentence of a rule or a text has."""

    def __init__(
        self, grammar: Grammar, kind_of: Mapping[str, int], changed: Iterable[str]
    ) -> None:
        self._grammar = grammar
        self._kind_of = kind_of
        #: Nothing is required of a ``changed`` rule.
        self._of_rule: dict[str, frozenset[int]] = dict.fromkeys(changed, frozenset())

    def of_text(self, text: str) -> frozenset[int]:
        """Return the tokens in every sentence of a text, the empty one left aside."""
        alternatives = rule_of(text).alternatives
        while (inner := _only(alternatives)) is not None:
            alternatives = inner
        return self._of_choice(alternatives)

    def _of_choice(self, alternatives: Iterable[Alternative]) -> frozenset[int]:
        found = (frozenset().union(*map(self._of, a.elements)) for a in alternatives)
        return frozenset.intersection(*found)

    def _of(self, element: Element) -> frozenset[int]:
        match element:
            case Repeat(item=item, operator=operator):
                return self._of(item) if operator == "+" else frozenset()
            case Group(alternatives=alternatives):
                return self._of_choice(alternatives)
            case Reference(name=name, is_token=False):
                if name not in self._of_rule:
                    self._of_rule[name] = frozenset()  # ends the recursion of recursive rules
                    self._of_rule[name] = self._of_choice(self._grammar.by_name[name].alternatives)
                return self._of_rule[name]
            case Reference() | Literal():
                return frozenset([self._kind_of[self._grammar.token_of(element)]])
            case _:
                return frozenset()


def _only(alternatives: Sequence[Alternative]) -> tuple[Alternative, ...] | None:
    """Return the content of a text that is one group, or one repeated or optional element."""
    if len(alternatives) != 1 or len(alternatives[0].elements) != 1:
        return None
    match alternatives[0].elements[0]:
        case Group(alternatives=inner):
            return inner
        case Repeat(item=item):
            return (Alternative((item,), None, item.span),)
        case _:
            return None
