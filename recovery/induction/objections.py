"""What speaks against edits: they do not fit, or accept a program that must stay rejected."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grammar.notation.edits import Edit, apply
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.wellformed import problem
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.survey.failing_line import source_lines
from recovery.tuning import GAIN_PER_NEGATIVE


@dataclass(frozen=True, slots=True)
class Judge:
    """Judges edits of the grammar of a recogniser by the negatives that are ``rejected``.

    ``reserved_in`` gives the words of a line that cannot be names (`recovery.language.Language`).
    """

    recognizer: Recognizer
    rejected: NegativeSet
    reserved_in: Callable[[str], frozenset[str]]

    def objection(
        self, grammar: Grammar, edits: Sequence[Edit], alone: Sequence[Edit], gain: float = 0.0
    ) -> str:
        """Why edits are not to be taken; empty where nothing speaks against them.

        ``grammar`` has edits since, so that not all of those that were tried ``alone`` are left; an
        edit of more ``gain`` may accept more.
        """
        try:
            after = apply(grammar, edits)
        except GrammarError as error:
            return str(error)
        if after.rules == grammar.rules:
            return "changes nothing"
        if wrong := problem(after):
            return f"the grammar would be ill formed: line {wrong}"
        wider = edited(self.recognizer, alone)
        if wider is None:
            return "does not fit the grammar"
        accepted = [n for n in self.rejected.accepted(wider) if self._is_read_anew(wider, n)]
        if len(accepted) > gain / GAIN_PER_NEGATIVE:
            return f"accepts {len(accepted)} programs that must be rejected: {accepted[0].reason}"
        return ""

    def _is_read_anew(self, wider: Recognizer, negative: Negative) -> bool:
        """Whether a negative was rejected at the line that is wrong, all words of it known.

        One that was rejected at another line has told nothing about the wrong one so far; nor has
        one that misuses a word which both grammars take for a name.
        """
        if negative.line is None:
            return True
        wrong = source_lines(negative.text)[negative.line - 1]
        if not self.reserved_in(wrong) <= wider.lexer.kind_of.keys():
            return False
        recognizer = self.recognizer
        kinds = recognizer.kinds(negative.text)
        _, failed = recognizer.run(recognizer.start, kinds)
        return failed is None or kinds[:failed].count(recognizer.line_kind) + 1 == negative.line
