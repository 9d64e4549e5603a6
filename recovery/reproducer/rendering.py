"""Rendering: abstract tokens as the text of a readable program.

Names and numbers do not matter to a failure, so they become short ones; words that are meant as
keywords stay. Blocks are indented, and blanks are put as people put them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import NamedTuple

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS, PREFIXES, SIGNATURES
from grammar.parser.lexer import EOF, Lexer
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Speller
from recovery.brackets import BRACKETS
from recovery.proposals.edit_site import LinePattern
from recovery.tuning import MOST_NAMES

#: The name of tokens around a failing line; names from a line itself are in upper case.
FRAME = "frame"

_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
# Forms of names, numbers and texts; for each kind the first one that the lexer accepts is used.
_FORMS = ("{letter}", "{number}", "{number}.0", '"{letter}"', "#{letter}")
_UNKNOWN = "?!@^~`|\\"
_INDENT = "  "


class AbstractToken(NamedTuple):
    """A token without its final text.

    ``name`` distinguishes tokens of one kind: equal names get the same text. For an unknown
    character it is the text itself. ``meant`` is the keyword that a name is meant as.
    """

    kind: int
    name: str
    meant: str | None = None


class TokenRenderer:
    """Spells the tokens of one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.lexer = recognizer.lexer
        self._speller = Speller(recognizer.grammar)
        self._name = self.lexer.name_kind
        self._fixed: dict[int, str] = {}
        self._forms: dict[int, str] = {}
        for kind, name in enumerate(self.lexer.names):
            self._learn(kind, name)

    def _learn(self, kind: int, name: str) -> None:
        display = self.lexer.display[kind]
        if self.lexer.is_keyword(kind) or display != name:
            self._fixed[kind] = display
            return
        for form in _FORMS:
            if self.lexer.kinds[form.format(letter="A", number=1)] == kind:
                self._forms[kind] = form
                return
        self._fixed[kind] = self._speller.samples.get(name, "")

    # -------------------------------------------------------------------------- its tokens

    def tokens(self, line: LinePattern, words: Sequence[str]) -> list[AbstractToken]:
        """Return the tokens of a failing line without the end of file; ``words`` may be fewer."""
        meant = dict(line.keywords)
        return [
            AbstractToken(kind, words[i] if i < len(words) else f"word {i}", meant.get(i))
            for i, kind in enumerate(line.form.kinds)
            if kind != EOF
        ]

    def frame(
        self, kinds: Iterable[int], wider: Recognizer | None = None, *, name: str = FRAME
    ) -> list[AbstractToken]:
        """Return tokens around the line; a kind of the wider grammar alone is a keyword there."""
        own = len(self.lexer.names)
        names = () if wider is None else wider.lexer.names
        return [
            AbstractToken(kind, name)
            if kind < own
            else AbstractToken(self._name, name, names[kind])
            for kind in kinds
        ]

    # --------------------------------------------------------------------------- its text

    def text(self, tokens: Sequence[AbstractToken], wider: Recognizer | None = None) -> str | None:
        """Return the program, or ``None`` if no text gives these tokens.

        The lexer of the wider grammar must take exactly the meant words for keywords.
        """
        texts = self._texts(tokens, [self.lexer, *([wider.lexer] if wider else [])])
        if texts is None:
            return None
        kinds = [*(token.kind for token in tokens), EOF]
        for closely in (True, False):
            text = self._laid_out(tokens, texts, closely=closely)
            if self.recognizer.kinds(text) == kinds:
                return text
        return None

    def _texts(self, tokens: Sequence[AbstractToken], lexers: Sequence[Lexer]) -> list[str] | None:
        found: dict[tuple[int, str], str] = {}
        pools: dict[int, Iterator[str]] = {}
        for kind, name, meant in tokens:
            if meant is not None or (kind, name) in found:
                continue
            pool: Iterable[str]
            if kind < 0:
                pool = (*(name if len(name) == 1 else ""), *_UNKNOWN)
            elif kind in self._fixed:
                pool = (self._fixed[kind],)
            else:
                pool = pools.setdefault(kind, _formed(self._forms[kind]))
            fitting = (t for t in pool if all(lexer.kinds[t] == kind for lexer in lexers))
            text = next(fitting, None)
            if text is None:
                return None
            found[kind, name] = text
        return [meant or found[kind, name] for kind, name, meant in tokens]

    def _laid_out(
        self, tokens: Sequence[AbstractToken], texts: Sequence[str], *, closely: bool
    ) -> str:
        lines: list[str] = []
        blocks = _Blocks()
        start = 0
        for end in [
            *(i for i, token in enumerate(tokens) if token.kind == self.recognizer.line_kind),
            len(tokens),
        ]:
            words = texts[start:end]
            line = "".join(self._spaced(tokens[start:end], words)) if closely else " ".join(words)
            lines.append(blocks.indent(words) * bool(words) + line)
            start = end + 1
        return "\n".join(lines)

    def _spaced(self, tokens: Sequence[AbstractToken], texts: Sequence[str]) -> Iterator[str]:
        """Yield the texts of a line with blanks between them, as people put them."""
        inside: list[str] = []  # open brackets
        # the mode of a parameter is written as in ``DEF A(B :IN)``
        declares = not SIGNATURES.isdisjoint(texts[:2])
        signed = False  # after a sign that belongs to the number behind it
        for i, text in enumerate(texts):
            last = texts[i - 1] if i else ""
            operand_before = bool(last) and (last in ")]}" or self._is_operand(tokens[i - 1]))
            in_braces = inside[-1:] == ["{"]
            attached = (
                not last
                or signed
                or last in ("(", "[", "{", ".")
                or text in (")", "]", "}", ",", ".")
                or (text == "(" and operand_before)
                or (text == "[" and (operand_before or last[-1].isalnum()))
                or (text == ":" and (in_braces or i == 1))
                or (last == ":" and declares)
            )
            if not attached:
                yield " "
            yield text
            signed = text in ("-", "+") and (
                not operand_before or (in_braces and last not in ")]}")
            )
            if text in BRACKETS:
                inside.append(text)
            elif inside and text == BRACKETS[inside[-1]]:
                inside.pop()

    def _is_operand(self, token: AbstractToken) -> bool:
        return token.kind in self._forms and token.meant is None


def _formed(form: str) -> Iterator[str]:
    """Yield new texts of a form."""
    names = (f"{letter}{number or ''}" for number, letter in product(range(MOST_NAMES), _LETTERS))
    return (form.format(letter=name, number=number) for number, name in enumerate(names, 1))


class _Blocks:
    """The nesting depth of lines, which are passed in order."""

    def __init__(self) -> None:
        self._closers: list[frozenset[str]] = []

    def indent(self, words: Sequence[str]) -> str:
        lead = next((word for word in words if word not in PREFIXES), "")
        level = next(
            (i for i in range(len(self._closers) - 1, -1, -1) if lead in self._closers[i]), None
        )
        if level is not None and lead in BRANCHES:
            return _INDENT * level
        if level is not None and lead in CLOSERS:
            del self._closers[level:]
        depth = len(self._closers)
        if lead in BLOCKS:
            self._closers.append(BLOCKS[lead].words)
        return _INDENT * depth
