"""The reason of a failing line: what failures of one cause share, wherever in a program they are.

One lack shows in a statement, a block, a header and a data list, and with each word of a kind. What
stays the same is the word that the grammar lacks, that a keyword was left out, that a reserved word
stands for a name, that a line begins as none of its place does, or which sign comes in which
brackets.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

from grammar.parser.failures import FailureContext, Form
from grammar.parser.recognizer import Frames, Recognizer, State
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.keywords import Vocabulary
from recovery.proposals.rule_matcher import RuleMatcher
from recovery.survey.failing_line import FailingLine
from recovery.survey.signature import Signature
from recovery.tuning import LEAST_STEM

#: Words and kinds of token; means nothing but that equal ones are one reason.
Reason = tuple[str, ...]

#: A reserved word stands where a name may.
AS_NAME: Reason = ("name",)
#: What the reason of a line begins with that lacks a keyword; the keyword follows.
LEFT_OUT = "without"
_OPERAND = "an operand"
_ELLIPSIS = "…"


class ReasonFinder:
    """Finds the reasons of lines that fail under one grammar."""

    def __init__(
        self, recognizer: Recognizer, failures: Iterable[tuple[FailingLine, Form]] = ()
    ) -> None:
        """``failures`` are all failing lines, from which is learnt what follows which keyword."""
        self._recognizer = recognizer
        self._lexer = lexer = recognizer.lexer
        self._kind_of_word = Vocabulary(recognizer).kinds_of_words
        self._matcher = RuleMatcher(recognizer)
        self._keywords = frozenset(filter(lexer.is_keyword, lexer.kind_of.values()))
        words = (lexer.display[kind] for kind in self._keywords)
        self._longest_first = sorted(words, key=lambda word: (-len(word), word))
        self._followers: set[tuple[int, str]] = set()
        self._read: set[str] = set()  # words behind a keyword, where the line can be read on
        places: set[Frames] = set()
        for failed, form in failures:
            places.add(form.before)
            pairs = zip(form.kinds, failed.words[1:], strict=False)
            for place, (kind, word) in enumerate(pairs, 1):
                if lexer.is_keyword(kind):
                    self._followers.add((kind, word))
                    if form.kinds[place] == lexer.name_kind and place + 1 < form.index:
                        self._read.add(word)
        #: The kinds of token that begin lines where some line fails.
        self._beginnings = frozenset[int]().union(
            *(recognizer.expected(recognizer.restore(before)) for before in places)
        )

    def reason(self, line: LinePattern, signature: Signature, context: FailureContext) -> Reason:
        """The reason why a line of that signature fails in that context."""
        lexer, index = self._lexer, line.form.index
        left_out = self._left_out(line)
        if left_out:
            return (LEFT_OUT, left_out)
        new = {at: word for at, word in line.keywords if not at or word not in self._read}
        place = index if index in new else index - 1
        while place - 1 in new:
            place -= 1
        if place in new:
            return ("word", self._stem(new[place]))
        kind = line.form.kinds[index]
        offender = lexer.names[kind] if kind >= 0 else ""
        offender = self._kind_of_word.get(offender, offender)
        lead = self._kind_of_word.get(signature.lead, signature.lead)
        is_word = lexer.is_keyword(kind)
        if index and is_word and lexer.name in context.expected and offender == lexer.names[kind]:
            return AS_NAME
        if index == 0:
            return ("begins", offender)
        if (lead or signature.bracket) and self._begins_operand(kind):
            return (signature.bracket or lead, _OPERAND)
        if signature.bracket or not (is_word or kind == lexer.line_kind):
            ahead = "a name" if index == 1 and not lead else ""
            return ("sign", ahead or signature.bracket, offender)
        return (lead, offender)

    def _left_out(self, line: LinePattern) -> str:
        """The one keyword that the line lacks at its beginning to be read further on.

        A word that the grammar does not know has to be seen behind that keyword elsewhere.
        """
        form = line.form
        if form.index > 1 or line.is_enormous:
            return ""
        first = dict(line.keywords).get(0)
        start = self._recognizer.restore(form.before)
        known = self._lexer.is_keyword(form.kinds[0])
        found = [
            kind
            for kind in self._recognizer.expected(start) & self._keywords
            if (known or (kind, first) in self._followers)
            and self._reads(start, (kind, *form.kinds)) > form.index + 2
        ]
        if known and not found and form.kinds[0] not in self._beginnings:
            found = list(self._ahead.get(form.kinds[0], ()))
        return self._lexer.display[found[0]] if len(found) == 1 else ""

    @cached_property
    def _ahead(self) -> Mapping[int, frozenset[int]]:
        """For each kind of token the keywords that the grammar has ahead of it."""
        network = self._recognizer.network
        found: dict[int, set[int]] = defaultdict(set)
        for shifts in network.shifts:
            for keyword in self._keywords & shifts.keys():
                for kind in network.reach(shifts[keyword]).first:
                    found[kind].add(keyword)
        return {kind: frozenset(some) for kind, some in found.items()}

    def _reads(self, start: State, kinds: Sequence[int]) -> int:
        """How many of the tokens can be read."""
        failed = self._recognizer.run(start, kinds)[1]
        return len(kinds) + 1 if failed is None else failed

    def _stem(self, word: str) -> str:
        """What a new word has besides a keyword: of ``DEFFCT`` and ``ENDFCT`` ``FCT``; or all.

        What is too short to be a word itself shows on which side it is: of ``B_AND`` ``B_…``.
        """
        for known in self._longest_first:
            left = word.replace(known, _ELLIPSIS, 1)
            rest = left.removeprefix(_ELLIPSIS).removesuffix(_ELLIPSIS)
            is_part = rest not in ("", word) and _ELLIPSIS not in rest
            if is_part and ("_" in rest or len(known) >= LEAST_STEM):
                return rest if len(rest) >= LEAST_STEM else left
        return word

    def _begins_operand(self, kind: int) -> bool:
        return kind > 0 and bool(self._matcher.begun_by((kind,)) & self._matcher.value_rules)
