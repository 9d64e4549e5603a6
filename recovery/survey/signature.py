"""Signatures: the shape of a failing line, in readable words.

Real source has thousands of failing lines and few causes. A signature keeps what distinguishes
causes (the first word of the line, the offending token, the rule being read) and drops the rest
(names, numbers, the position in the file). A word that the grammar does not know is a name to its
lexer. That it is meant as a keyword shows in its neighbours: different operands without a sign
between, in several files, and rarely as a plain name.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from grammar.parser.failures import FailureContext, Form
from grammar.parser.lexer import EOF, ERROR, Lexer
from recovery.survey.failing_line import FailingLine
from recovery.tuning import (
    KEYWORD_ALONE,
    KEYWORD_CHOICE,
    KEYWORD_FILES,
    KEYWORD_NEIGHBOURS,
    KEYWORD_SHARE,
)

_ELLIPSIS = "…"
# Signs that can follow a keyword, but no plain name at the beginning of a line.
_BEGINS_OPERAND = frozenset("{-+")


@dataclass(frozen=True, slots=True)
class Signature:
    """What distinguishes one kind of failure from another.

    ``lead`` is the keyword or would-be keyword with which the line begins, empty if it begins with
    a plain name. ``offender`` is the offending token: a word, a sign or a token kind. ``bracket``
    is the innermost open bracket, and ``is_first`` says that the offending token follows it
    directly; this is shown in the text, but is not compared.
    """

    rule: str
    lead: str
    bracket: str
    offender: str
    is_first: bool = field(default=False, compare=False)

    @property
    def text(self) -> str:
        """``TRIGGER … ONSTART``, ``… [ … ,`` or ``… [ ,``: the source of cluster IDs."""
        parts = [self.lead] if self.lead else []
        if self.bracket:
            parts += [_ELLIPSIS, self.bracket]
        if self.offender == self.lead:
            return f"{self.lead} {_ELLIPSIS}"
        if self.bracket and self.is_first:
            return " ".join((*parts, self.offender))
        if not parts or parts[-1] != _ELLIPSIS:
            parts.append(_ELLIPSIS)
        return " ".join((*parts, self.offender))


class SignatureBuilder:
    """Builds signatures; it needs all failures at first, to learn the would-be keywords."""

    def __init__(self, lexer: Lexer, failures: Iterable[tuple[str, FailingLine, Form]]) -> None:
        """Create it; ``failures`` are given with the digest of their file."""
        self.lexer = lexer
        self._name = lexer.name_kind
        self._signs = frozenset(
            kind
            for kind, text in enumerate(lexer.display)
            if text != lexer.names[kind] and not lexer.is_keyword(kind)
        )
        beside: Counter[str] = Counter()
        plain: Counter[str] = Counter()
        files: dict[str, set[str]] = defaultdict(set)
        neighbours: dict[tuple[str, int], set[str]] = defaultdict(set)
        alone: Counter[str] = Counter()
        led: dict[str, set[str]] = defaultdict(set)  # files with lines it leads
        ends: dict[tuple[int, ...], Counter[str]] = defaultdict(Counter)
        failures = list(failures)
        for _, failed, form in failures:
            if not 0 < form.index < len(failed.words):
                continue
            before, kind = form.kinds[form.index - 1 : form.index + 1]
            if kind == self._name and self.lexer.is_keyword(before):
                ends[form.kinds[: form.index]][failed.words[form.index]] += 1
        self._sole = frozenset(
            word
            for words in ends.values()
            if len(words) <= KEYWORD_CHOICE
            for word, count in words.items()
            if count >= KEYWORD_NEIGHBOURS
        )
        for digest, failed, form in failures:
            for place, word in self._names(failed, form):
                if not self._stands_out(form, place, word):
                    plain[word] += 1
                    continue
                beside[word] += 1
                files[word].add(digest)
                sides = [s for s in (-1, 1) if self._is_operand_at(form.kinds, place + s)]
                alone[word] += not sides
                if place == 0 and sides:
                    led[word].add(digest)
                for side in sides:
                    if place + side < len(failed.words):
                        neighbours[word, side].add(failed.words[place + side])
        self._keywords = frozenset(
            word
            for word, count in beside.items()
            if not word.startswith("$")
            and len(files[word]) >= KEYWORD_FILES
            and (
                max(len(neighbours[word, -1]), len(neighbours[word, 1])) >= KEYWORD_NEIGHBOURS
                or alone[word] >= KEYWORD_ALONE
                or (len(led[word]) >= KEYWORD_FILES and len(neighbours[word, 1]) > 1)
                or word in self._sole
            )
            and count >= KEYWORD_SHARE * (count + plain[word])
        )

    def _names(self, failed: FailingLine, form: Form) -> Iterator[tuple[int, str]]:
        """Yield the names on a line, except in braces, where values follow names anyway."""
        depth = 0
        for place, (kind, word) in enumerate(zip(form.kinds, failed.words, strict=False)):
            if word == "{":
                depth += 1
            elif word == "}":
                depth -= 1
            elif kind == self._name and not depth:
                yield place, word

    def _stands_out(self, form: Form, place: int, word: str) -> bool:
        """Return whether a name is used like a keyword.

        It stands without signs around it, or where other lines never have a different name.
        """
        is_sole = place == form.index and word in self._sole
        return is_sole or self._stands_alone(form.kinds, place)

    def _stands_alone(self, kinds: tuple[int, ...], place: int) -> bool:
        """Return whether a name lacks the sign that a name in an expression has beside it.

        A plain name begins a line only before a sign; elsewhere it follows a sign or a keyword. A
        name directly before or after an operand is one word too many.
        """
        before = kinds[place - 1] if place else None
        after = kinds[place + 1] if place + 1 < len(kinds) else None
        if before is None:
            return after not in self._signs or self.lexer.display[after] in _BEGINS_OPERAND
        return self._is_operand(before) or self._is_operand(after) or self._is_sign(before, ":")

    def _is_operand_at(self, kinds: tuple[int, ...], place: int) -> bool:
        return 0 <= place < len(kinds) and self._is_operand(kinds[place])

    def _is_operand(self, kind: int | None) -> bool:
        if kind is None or kind <= 0 or kind == self.lexer.line_kind:
            return False
        text = self.lexer.display[kind]
        return (kind not in self._signs and not self.lexer.is_keyword(kind)) or text in "])}"

    def _is_sign(self, kind: int, text: str) -> bool:
        return kind > 0 and self.lexer.display[kind] == text

    def keywords(self, failed: FailingLine, form: Form) -> tuple[tuple[int, str], ...]:
        """Return the would-be keywords on a failing line, with their indices."""
        return tuple(
            (place, word)
            for place, word in self._names(failed, form)
            if word in self._keywords and self._stands_out(form, place, word)
        )

    def signature(self, failed: FailingLine, form: Form, context: FailureContext) -> Signature:
        """Return the signature of a failure.

        A name that is meant as a keyword is shown as that word.
        """
        kinds, index = form.kinds, form.index
        meant = dict(self.keywords(failed, form))
        lead = meant.get(0, "")
        if self.lexer.is_keyword(kinds[0]):
            lead = self.lexer.display[kinds[0]]
        offender = meant.get(index) or self._display(kinds[index])
        if 0 in meant and index == 1:
            offender = lead  # the line fails after its first word because of that word
        bracket = self._open_bracket(kinds[:index])
        is_first = index > 0 and self._display(kinds[index - 1]) == bracket
        return Signature(context.rule, lead, bracket, offender, is_first)

    def _display(self, kind: int) -> str:
        if kind == ERROR:
            return "unknown character"
        known = {self.lexer.line_kind: "end of line", EOF: "end of file", self._name: "name"}
        return known.get(kind) or self.lexer.display[kind]

    def _open_bracket(self, kinds: tuple[int, ...]) -> str:
        """Return the innermost bracket that is open before the offending token."""
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
