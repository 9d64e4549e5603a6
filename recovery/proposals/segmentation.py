"""Segmentation: the tokens of a line cut into operands and single words or signs.

``STEP A + 1`` is the word ``STEP`` and one operand, because some rule reads ``A + 1`` as a whole.
The cheapest segmentation is found by dynamic programming; of equal ones the first found is kept.
"""

from __future__ import annotations

from collections.abc import Sequence

from recovery import tuning
from recovery.brackets import BRACKETS, CLOSING
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import Token


class Segmenter:
    """Cuts lines into parts under one grammar."""

    def __init__(self, matcher: RuleMatcher) -> None:
        self.matcher = matcher
        self._cuts: dict[tuple[Token, ...], list[tuple[Token, ...]] | None] = {}

    def parts(self, words: Sequence[Token]) -> list[tuple[Token, ...]] | None:
        """Return the words cut into the fewest operands and single tokens; ``None`` if too many."""
        if len(words) > tuning.LONGEST_SEGMENTED:
            return None
        key = tuple(words)
        if key not in self._cuts:
            if len(self._cuts) >= tuning.MOST_ANSWERS_KEPT:
                self._cuts.clear()
            self._cuts[key] = self._cut(key)
        return self._cuts[key]

    def _cut(self, words: tuple[Token, ...]) -> list[tuple[Token, ...]] | None:
        count = len(words)
        best: list[tuple[int, list[tuple[Token, ...]]] | None] = [None] * count + [(0, [])]
        lexer = self.matcher.recognizer.lexer
        for start in range(count - 1, -1, -1):
            # a word right behind a value is not the name with which an operand begins
            is_word = lexer.is_keyword(words[start][0])
            squeezed = start > 0 and is_word and lexer.has_value(words[start - 1][0])
            for end in range(start + 1, count + 1):
                rest, part = best[end], words[start:end]
                if not self._may_go_on(part):
                    break
                if rest is None or not self._can_be_written(part):
                    continue
                cost = rest[0] + (
                    tuning.TOKEN_COST
                    if len(part) == 1
                    else tuning.OPERAND_COST + tuning.SEAM_COST * (self._seams(part) + squeezed)
                )
                known = best[start]
                if known is None or cost < known[0]:
                    best[start] = (cost, [part, *rest[1]])
        return best[0][1] if best[0] else None

    def _seams(self, part: tuple[Token, ...]) -> int:
        """Return the number of places at which a part could be split into operands.

        These are commas outside of brackets, and the boundaries between values.
        """
        depth = seams = 0
        was_value = False
        matcher, lexer = self.matcher, self.matcher.recognizer.lexer
        first = part[0][0]
        if lexer.is_keyword(first):  # the tokens after a keyword belong to it
            kinds = tuple(kind for kind, _ in part)
            is_operand = not matcher.value_rules.isdisjoint(matcher.rules_for(kinds))
            is_a_name = not matcher.value_rules.isdisjoint(matcher.rules_for((first,)))
            if not (is_operand and is_a_name):
                return int(not is_operand and not matcher.is_more_than_a_name(kinds))
        for kind, _ in part:
            text = lexer.display[kind]
            depth += (text in BRACKETS) - (text in CLOSING)
            is_value = depth == 0 and (lexer.has_value(kind) or matcher.may_be_a_name(kind))
            seams += (depth == 0 and text == ",") + (is_value and was_value)
            was_value = is_value
        return seams

    def _may_go_on(self, part: tuple[Token, ...]) -> bool:
        """Return whether a part is one token, or some rule begins with it."""
        if len(part) == 1:
            return True
        is_new = any(keyword is not None or kind < 0 for kind, keyword in part)
        return not is_new and bool(self.matcher.begun_by(tuple(kind for kind, _ in part)))

    def _can_be_written(self, part: tuple[Token, ...]) -> bool:
        """Return whether a part is one token, or some rule reads it."""
        if len(part) == 1:
            return part[0][1] is not None or part[0][0] >= 0
        return bool(self.matcher.rules_for(tuple(kind for kind, _ in part)))
