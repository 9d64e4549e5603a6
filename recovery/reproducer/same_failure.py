"""The test of delta debugging: whether a program fails in the same way as a line, and only so.

A failure is the same if the offending token and the context in the grammar are the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from grammar.parser.failures import FailureContext, FailureFinder
from grammar.parser.lexer import EOF
from grammar.parser.recognizer import Recognizer
from recovery.reproducer.rendering import FRAME, AbstractToken, TokenRenderer
from recovery.tuning import LONGEST_GAP, MOST_TOKENS_READ, TEST_COST


class FailureMode(NamedTuple):
    """What makes two failures equal: the offending token and the context in the grammar.

    ``kind`` is the kind of the offending token. ``meant``, ``before`` and ``lead`` are the keywords
    meant by it, by the token before it and by the first one of the line. ``opening`` is the kind of
    the first token if the line could have ended; then the statement as a whole does not continue.
    """

    kind: int
    meant: str | None
    before: str | None
    lead: str | None
    opening: int | None
    rule: str
    expected: tuple[str, ...]


def failure_mode(
    recognizer: Recognizer,
    kinds: Sequence[int],
    meant: Sequence[str | None],
    index: int,
    context: FailureContext,
) -> FailureMode:
    """Return how the line of these tokens fails at ``index``."""
    line_kind = recognizer.line_kind
    could_end = line_kind > 0 and recognizer.lexer.display[line_kind] in context.expected
    return FailureMode(
        kinds[index],
        meant[index],
        meant[index - 1] if index else None,
        meant[0],
        kinds[0] if could_end or not index else None,
        context.rule,
        context.expected,
    )


def line_at(recognizer: Recognizer, kinds: Sequence[int], index: int) -> tuple[int, int]:
    """Return the range of the line with a token; the end of the file is a line of its own."""
    last, line_kind = len(kinds) - 1, recognizer.line_kind
    if index == last:
        return last, len(kinds)
    first = next((i + 1 for i in range(index - 1, -1, -1) if kinds[i] == line_kind), 0)
    end = next((i + 1 for i in range(index, last) if kinds[i] == line_kind), last)
    return first, end


class SameFailure:
    """Tests whether a program fails in a given way, and only so."""

    def __init__(
        self,
        finder: FailureFinder,
        spelling: TokenRenderer,
        way: FailureMode,
        wider: Recognizer | None,
        may_follow: bool,
    ) -> None:
        self.recognizer = finder.recognizer
        self.wider = wider
        self._finder = finder
        self._spelling = spelling
        self._way = way
        self._may_follow = may_follow
        self._left = MOST_TOKENS_READ

    def passes(self, tokens: list[AbstractToken]) -> bool:
        """Return whether the program passes; always ``False`` once the allowed work is done."""
        self._left -= len(tokens) + TEST_COST
        if self._left < 0:
            return False
        recognizer, wider = self.recognizer, self.wider
        kinds = [*(t.kind for t in tokens), EOF]
        state, index = recognizer.run(recognizer.start, kinds)
        if index is None or kinds[index] != self._way.kind:
            return False
        first, end = line_at(recognizer, kinds, index)
        meant = [*(t.meant for t in tokens[first:end]), None]
        context = self._finder.context(state)
        if failure_mode(recognizer, kinds[first:end], meant, index - first, context) != self._way:
            return False
        if any(t.name == FRAME and t.kind != recognizer.line_kind for t in tokens[index + 1 : end]):
            return False  # the completion must not be a line of its own
        if wider is not None:
            if wider.run(wider.start, [*kinds_in(wider, tokens), EOF])[1] is not None:
                return False
        elif not self._may_follow and not self._is_right_without(kinds, first, index, end):
            return False
        return self._fails_once(tokens)

    def _is_right_without(self, kinds: list[int], first: int, index: int, end: int) -> bool:
        """Return whether it is valid without the failing line, or without tokens at the failure."""
        cuts = [(first, end), (max(0, first - 1), end)]
        cuts += [(index, index + gap) for gap in range(1, min(end - index, LONGEST_GAP + 1))]
        run, start = self.recognizer.run, self.recognizer.start
        return any(run(start, kinds[:i] + kinds[j:])[1] is None for i, j in cuts)

    def _fails_once(self, tokens: list[AbstractToken]) -> bool:
        text = self._spelling.text(tokens, self.wider)
        if text is None:
            return False
        failures = self._finder.find(text)
        return len(failures) == 1 or (
            self._may_follow and all(failure.follows for failure in failures[1:])
        )


def kinds_in(recognizer: Recognizer, tokens: list[AbstractToken]) -> list[int]:
    """Return the kinds of the tokens where names that are meant as keywords may be keywords."""
    kind_of = recognizer.lexer.kind_of
    return [t.kind if t.meant is None else kind_of.get(t.meant, t.kind) for t in tokens]
