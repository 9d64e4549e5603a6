"""The reason of a failing line: what failures of one cause share at different places.

One gap in the grammar shows in a statement, a block, a header and a data list, and with each word
of a kind. Common to all of them is the keyword that the grammar lacks, a keyword in the place of a
name, a first word that no line has there, a word that only lists of words have, or a sign inside a
kind of brackets.
"""

from __future__ import annotations

from grammar.notation.model import reached
from grammar.parser.failures import FailureContext
from grammar.parser.network import Network
from grammar.parser.recognizer import Recognizer
from recovery.forms.keywords import Vocabulary
from recovery.forms.rule_matcher import RuleMatcher
from recovery.proposals.edit_site import LinePattern
from recovery.survey.signature import Signature

#: Words and token kinds; only equality has a meaning.
Reason = tuple[str, ...]

#: A keyword stands where a name can be.
AS_NAME: Reason = ("name",)
_OPERAND = "an operand"


class ReasonFinder:
    """Finds the reasons of lines that fail under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self._lexer = recognizer.lexer
        self._vocabulary = Vocabulary(recognizer)
        self._kind_of_word = self._vocabulary.kinds_of_words
        self._matcher = RuleMatcher(recognizer)
        self._read = self._kinds_read(recognizer.network, recognizer.grammar.start)

    def reason(self, line: LinePattern, signature: Signature, context: FailureContext) -> Reason:
        """Return the reason why a line with this signature fails in this context."""
        lexer, index = self._lexer, line.form.index
        new = [word for place, word in line.keywords if place <= index]
        if new:
            return ("word", new[0])
        kind = line.form.kinds[index]
        offender = lexer.names[kind] if kind >= 0 else ""
        is_word = lexer.is_keyword(kind)
        is_orphan = is_word and not self._vocabulary.is_written(offender)
        offender = self._kind_of_word.get(offender, offender)
        if is_word and lexer.name in context.expected and offender == lexer.names[kind]:
            return AS_NAME
        if is_orphan:
            return ("begins", offender)
        lead = self._kind_of_word.get(signature.lead, signature.lead)
        if kind >= 0 and not is_word and kind not in self._read:
            return ("unread",)
        if lexer.has_value(kind) and lexer.name in context.expected:
            return ("value",)
        if index == 0:
            return ("begins", offender)
        if lead and not signature.bracket and self._begins_operand(kind):
            return (lead, _OPERAND)
        if signature.bracket or not (is_word or kind == lexer.line_kind):
            return ("sign", signature.bracket, offender)
        return (lead, offender)

    @staticmethod
    def _kinds_read(network: Network, start: str) -> frozenset[int]:
        """Return the kinds of token that some rule reads which programs have."""
        calls: dict[str, set[str]] = {rule: set() for rule in network.entry}
        for position, called in enumerate(network.calls):
            calls[network.rule[position]].update(network.rule[entry] for entry, _ in called)
        rules = {start, *reached(calls, start)}
        return frozenset(
            kind
            for position, shifts in enumerate(network.shifts)
            if network.rule[position] in rules
            for kind in shifts
        )

    def _begins_operand(self, kind: int) -> bool:
        return kind > 0 and bool(self._matcher.begun_by((kind,)) & self._matcher.value_rules)
