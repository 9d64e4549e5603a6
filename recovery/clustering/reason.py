"""The reason of a failing line: what failures of one cause share, wherever in a program they are.

One lack shows in a statement, a block, a header and a data list, and with each word of a kind. What
stays the same is the word that the grammar lacks, that a reserved word stands for a name, that a
line begins as none of its place does, or which sign comes in which brackets.
"""

from __future__ import annotations

from grammar.parser.failures import FailureContext
from grammar.parser.recognizer import Recognizer
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.keywords import Vocabulary
from recovery.proposals.rule_matcher import RuleMatcher
from recovery.survey.signature import Signature

#: Words and kinds of token; means nothing but that equal ones are one reason.
Reason = tuple[str, ...]

#: A reserved word stands where a name may.
AS_NAME: Reason = ("name",)
_OPERAND = "an operand"


class ReasonFinder:
    """Finds the reasons of lines that fail under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self._lexer = recognizer.lexer
        self._kind_of_word = Vocabulary(recognizer).kinds_of_words
        self._matcher = RuleMatcher(recognizer)

    def reason(self, line: LinePattern, signature: Signature, context: FailureContext) -> Reason:
        """The reason why a line of that signature fails in that context."""
        lexer, index = self._lexer, line.form.index
        new = [word for place, word in line.keywords if place <= index]
        if new:
            return ("word", new[0])
        kind = line.form.kinds[index]
        offender = lexer.names[kind] if kind >= 0 else ""
        offender = self._kind_of_word.get(offender, offender)
        lead = self._kind_of_word.get(signature.lead, signature.lead)
        is_word = lexer.is_keyword(kind)
        if is_word and lexer.name in context.expected and offender == lexer.names[kind]:
            return AS_NAME
        if index == 0:
            return ("begins", offender)
        if lead and not signature.bracket and self._begins_operand(kind):
            return (lead, _OPERAND)
        if signature.bracket or not (is_word or kind == lexer.line_kind):
            return ("sign", signature.bracket, offender)
        return (lead, offender)

    def _begins_operand(self, kind: int) -> bool:
        return kind > 0 and bool(self._matcher.begun_by((kind,)) & self._matcher.value_rules)
