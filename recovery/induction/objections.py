"""Objections to edits: they conflict, or accept programs that must be rejected.

These programs are written negatives, and readable lines with one token lost or doubled: an edit
must not accept more of those than lines have shown, as broken files suggest such forms.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from grammar.notation.edits import Edit, apply
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.wellformed import problem
from grammar.parser.recognizer import Recognizer, State
from recovery.clustering.edit_trial import edited
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.survey.failing_line import source_lines
from recovery.tuning import GAIN_PER_NEGATIVE


@dataclass(frozen=True)  # without slots, as it keeps what its recogniser reads
class EditReview:
    """Reviews edits of a recogniser's grammar with the negatives that are ``rejected``.

    ``reserved_in`` returns the words of a line that cannot be names (`Language` in
    `recovery.induction.language`), ``texts`` are programs that the recogniser reads.
    """

    recognizer: Recognizer
    rejected: NegativeSet
    reserved_in: Callable[[str], frozenset[str]]
    texts: Sequence[str] = ()

    def objection(
        self,
        grammar: Grammar,
        edits: Sequence[Edit],
        alone: Sequence[Edit],
        gain: float = 0.0,
        most_damaged: float = math.inf,
    ) -> str:
        """Return why edits must not be accepted; empty without an objection.

        ``grammar`` contains later edits, so some of the edits tried ``alone`` may be gone; an edit
        with more ``gain`` may accept more negatives. Of the lines of the texts with one token lost
        or doubled, it may accept ``most_damaged`` more.
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
        accepted = self.newly_accepted(wider)
        if len(accepted) > gain / GAIN_PER_NEGATIVE:
            return f"accepts {len(accepted)} programs that must be rejected: {accepted[0].reason}"
        if most_damaged < math.inf:
            damaged = self._damaged_read(wider) - self._read_so_far
            if len(damaged) > most_damaged:
                return f"accepts {len(damaged)} lines that have lost or doubled a token"
        return ""

    def newly_accepted(self, wider: Recognizer) -> list[Negative]:
        """Return the negatives that a wider grammar accepts and whose wrong line could be read."""
        return [n for n in self.rejected.accepted(wider) if self._is_read_anew(wider, n)]

    @cached_property
    def _read_so_far(self) -> frozenset[tuple[int, int, int, bool]]:
        return self._damaged_read(self.recognizer)

    @cached_property
    def _examined(self) -> frozenset[tuple[int, int]]:
        """The lines of the texts, by number, that no other line is like."""
        found: dict[tuple[State, tuple[int, ...]], tuple[int, int]] = {}
        for number, text in enumerate(self.texts):
            for place, (state, line) in enumerate(_lines(self.recognizer, text)):
                found.setdefault((state, tuple(line)), (number, place))
        return frozenset(found.values())

    def _damaged_read(self, recognizer: Recognizer) -> frozenset[tuple[int, int, int, bool]]:
        """Which lines of the texts are read without one of their tokens, or with it twice."""
        found = set()
        for number, text in enumerate(self.texts):
            for at, (state, line) in enumerate(_lines(recognizer, text)):
                for place in range(len(line) - 1) if (number, at) in self._examined else ():
                    for is_twice in (False, True):
                        damaged = line[: place + is_twice] + line[place + 1 - is_twice :]
                        if recognizer.run(state, damaged)[1] is None:
                            found.add((number, at, place, is_twice))
        return frozenset(found)

    def _is_read_anew(self, wider: Recognizer, negative: Negative) -> bool:
        """Return whether a negative was rejected at its wrong line, with all words of it known.

        A negative that was rejected at another line says nothing about the wrong line yet; nor does
        one that misuses a word which both grammars read as a name.
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


def _lines(recognizer: Recognizer, text: str) -> Iterator[tuple[State, list[int]]]:
    """Yield the tokens of each line, with the state before it, as far as they can be read."""
    kinds, state, begin = recognizer.kinds(text), recognizer.start, 0
    for end in (n for n, kind in enumerate(kinds) if kind == recognizer.line_kind):
        line = kinds[begin : end + 1]
        yield state, line
        state, failed = recognizer.run(state, line)
        if failed is not None:
            return
        begin = end + 1
