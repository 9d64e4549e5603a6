"""Signatures: the shape of a failing line, in readable words.

Real source has thousands of failing lines and few causes. A signature keeps what distinguishes
causes (the first word of the line, the offending token, the rule being read) and drops the rest
(names, numbers, the position in the file).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from grammar.parser.failures import FailureContext, Form
from grammar.parser.lexer import EOF, ERROR, Lexer
from recovery.brackets import left_open

_ELLIPSIS = "…"


@dataclass(frozen=True, slots=True)
class Signature:
    """What distinguishes one kind of failure from another.

    ``lead`` is the keyword or suspected keyword with which the line begins, empty if it begins with
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


def signature_of(
    lexer: Lexer, form: Form, keywords: Iterable[tuple[int, str]], context: FailureContext
) -> Signature:
    """Return the signature of a failure.

    Names that are suspected ``keywords`` are shown as these words; they come with their indices.
    """
    kinds, index = form.kinds, form.index
    meant = dict(keywords)
    lead = meant.get(0, "")
    if lexer.is_keyword(kinds[0]):
        lead = lexer.display[kinds[0]]
    offender = meant.get(index) or _shown(lexer, kinds[index])
    if 0 in meant and index == 1:
        offender = lead  # the line fails after its first word because of that word
    place = left_open([_shown(lexer, kind) for kind in kinds[:index]])
    bracket = "" if place is None else _shown(lexer, kinds[place])
    return Signature(context.rule, lead, bracket, offender, place == index - 1)


def _shown(lexer: Lexer, kind: int) -> str:
    if kind == ERROR:
        return "unknown character"
    known = {lexer.line_kind: "end of line", EOF: "end of file", lexer.name_kind: "name"}
    return known.get(kind) or lexer.display[kind]
