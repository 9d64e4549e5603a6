"""Shapes: what a failing line looks like, in words a person uses.

Real source has thousands of failing lines and few causes. A shape keeps what tells causes apart
(the word a line begins with, the token that could not come, the rule at work) and drops what does
not (names, numbers, the place in the file). Words that the grammar does not know yet are names to
its lexer; that such a word is meant as a keyword shows in how often it stands in the same spot.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from grammar.failures import Context, Form
from grammar.lexer import ERROR, Lexer
from recovery.survey import Failed

__all__ = ["Shape", "Shaper"]

_ELLIPSIS = "…"
# A name is taken for a keyword when the same word stands in the same spot on so many lines, and
# they are so large a part of the lines with any name in that spot.
_WORD_LINES = 3
_WORD_SHARE = 0.02


@dataclass(frozen=True, slots=True)
class Shape:
    """What tells one kind of failure from another.

    ``lead`` is the keyword or would-be keyword the line begins with, empty where it begins with a
    plain name; ``offender`` the token that could not come: a word, a sign or a kind of token.
    """

    rule: str
    lead: str
    offender: str
    bracket: str

    @property
    def title(self) -> str:
        """A short name for a person: ``TRIGGER … ONSTART``, ``… [ … , …``, ``SWITCH …``."""
        parts = [self.lead] if self.lead else []
        if self.bracket:
            parts += [_ELLIPSIS, self.bracket]
        if self.offender != self.lead:
            if not parts or parts[-1] != _ELLIPSIS:
                parts.append(_ELLIPSIS)
            parts.append(self.offender)
        elif len(parts) == 1:
            parts.append(_ELLIPSIS)
        return " ".join(parts)


class Shaper:
    """Gives failures their shapes; has to see all of them first, to learn the words."""

    def __init__(self, lexer: Lexer, failures: Iterable[tuple[Failed, Form, Context]]) -> None:
        self.lexer = lexer
        self._name = lexer.kind_of.get("NAME", ERROR)
        spots: Counter[tuple[str, str]] = Counter()
        words: Counter[tuple[str, str, str]] = Counter()
        for failed, form, context in failures:
            for spot, word in self._names(failed, form):
                spots[spot, context.rule] += 1
                words[spot, context.rule, word] += 1
        self._words = {
            key
            for key, count in words.items()
            if count >= _WORD_LINES and count >= _WORD_SHARE * spots[key[0], key[1]]
        }

    def _names(self, failed: Failed, form: Form) -> Iterable[tuple[str, str]]:
        """Names on the line that may be meant as keywords, with the spot they stand in."""
        kinds, index = form.kinds, form.index
        if kinds[0] == self._name and self._is_opener(form):
            yield "lead", failed.words[0]
        if 0 < index < len(kinds) and kinds[index] == self._name:
            yield "offender", failed.words[2]

    def _is_opener(self, form: Form) -> bool:
        """Whether the first name is followed by what never follows a plain name."""
        following = form.kinds[1] if len(form.kinds) > 1 else ERROR
        text = self.lexer.display[following] if following > 0 else ""
        return form.index <= 1 and text not in ("=", "[", "(", ".", ":", ",")

    def shape(self, failed: Failed, form: Form, context: Context) -> Shape:
        """The shape of a failure."""
        kinds, index = form.kinds, form.index
        names = dict(self._names(failed, form))
        lead = ""
        if self._is_keyword(kinds[0]):
            lead = self.lexer.display[kinds[0]]
        elif "lead" in names and ("lead", context.rule, names["lead"]) in self._words:
            lead = names["lead"]
        offender = self._display(kinds[index])
        if "offender" in names and ("offender", context.rule, names["offender"]) in self._words:
            offender = names["offender"]
        if lead and index == 1 and not self._is_keyword(kinds[0]):
            offender = lead  # the line fails after its first word because of that word
        return Shape(context.rule, lead, offender, self._open_bracket(kinds[:index]))

    def _is_keyword(self, kind: int) -> bool:
        return kind > 0 and self.lexer.is_keyword(kind)

    def _display(self, kind: int) -> str:
        if kind == ERROR:
            return "unknown character"
        return {"NEWLINE": "end of line", "EOF": "end of file"}.get(
            self.lexer.names[kind], self.lexer.display[kind]
        )

    def _open_bracket(self, kinds: tuple[int, ...]) -> str:
        """The innermost bracket that is open before the offending token."""
        closed = 0
        for kind in reversed(kinds):
            text = self.lexer.display[kind] if kind > 0 else ""
            if text in (")", "]", "}"):
                closed += 1
            elif text in ("(", "[", "{"):
                if not closed:
                    return text
                closed -= 1
        return ""
