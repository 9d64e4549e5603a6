"""Damage at one place of a program: slips in a line, lines lost or exchanged, drawn at random."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from grammar.blocks import BLOCKS, CLOSERS, SIGNATURES
from grammar.parser.lexer import Lexer
from grammar.syntax.build import builder
from grammar.syntax.source import Source

#: What can be damaged, by what one wants to know: mistakes of programmers, names alone, arguments
#: alone, a token of any sort, or whole lines and the signs that hold them together.
KINDS: Final[Mapping[str, tuple[str, ...]]] = {
    "mistakes": (
        "name misspelt",
        "keyword misspelt",
        "token dropped",
        "token doubled",
        "argument added",
        "literal of another type",
        "words swapped",
        "number out of range",
        "end of a block dropped",
    ),
    "names": ("name misspelt",),
    "arguments": ("argument dropped",),
    "tokens": ("token dropped", "token doubled", "token exchanged"),
    "lines": (
        "line lost",
        "lines swapped",
        "head of a block dropped",
        "end of a block dropped",
        "end of a line lost",
        "line end lost",
        "comment sign lost",
        "quote lost",
    ),
}
#: From where to where in a text, and what stands there instead.
Exchange = tuple[int, int, str]
_DECLARING = frozenset("DECL GLOBAL CONST STRUC ENUM CHAR INT REAL BOOL SIGNAL".split())
_CLOSING = CLOSERS.keys() - {"ENDDAT"}
_OPENING = BLOCKS.keys() - {"DEFDAT"}
_LETTERS = "abcdefghijklmnopqrstuvwxyz"
_LITERALS = {"INT": ("TRUE", '"x"'), "REAL": ("TRUE", '"x"'), "BOOL": ("1.5", '"x"')}


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a line: its kind in the grammar, its place in the text, and the text itself."""

    kind: str
    start: int
    text: str
    is_keyword: bool

    @property
    def end(self) -> int:
        """The end of the token in the text of the file."""
        return self.start + len(self.text)


def damaged(
    kind: str, source: Source, lines: Sequence[Sequence[Token]], chance: random.Random
) -> Exchange | None:
    """Return damage of a kind in a text of these ``lines``, at a place drawn by chance.

    ``None`` where the line that is drawn has no place for it.
    """
    if kind == "comment sign lost":
        comments = [one for one in source.comments if one.text.strip(" ;")]
        start = chance.choice(comments).offset if comments else 0
        return (start, start + 1, "") if comments else None
    if kind == "token exchanged":
        old, new = (chance.choice(chance.choice(lines)) for _ in range(2))
        return None if new.text.upper() == old.text.upper() else (old.start, old.end, new.text)
    if kind not in ("lines swapped", "line end lost"):
        return slip(kind, chance.choice(lines), chance)
    if len(lines) < 2:
        return None
    index = chance.randrange(len(lines) - 1)
    (start, end), (first, last) = ((one[0].start, one[-1].end) for one in lines[index : index + 2])
    text = source.text
    if kind == "line end lost":
        between = text[end:first]  # goes behind both, so that what follows keeps its lines
        return None if ";" in between else (end, last, f" {text[first:last]}{between}")
    return start, last, f"{text[first:last]}{text[end:first]}{text[start:end]}"


def slip(kind: str, tokens: Sequence[Token], chance: random.Random) -> Exchange | None:
    """Return damage of a kind in a line; ``None`` where it has no place for it."""
    match kind:
        case "name misspelt":
            return _misspelt([t for t in tokens if t.kind == "NAME" and len(t.text) > 3], chance)
        case "keyword misspelt":
            return _misspelt([t for t in tokens if t.is_keyword and len(t.text) > 1], chance)
        case "token dropped" | "token doubled":
            token = chance.choice(tokens)
            return token.start, token.end, "" if kind == "token dropped" else f"{token.text} " * 2
        case "line lost":
            return tokens[0].start, tokens[-1].end, ""
        case "end of a line lost":
            start = chance.choice(tokens[1:]).start if len(tokens) > 1 else 0
            return (start, tokens[-1].end, "") if start else None
        case "argument added" | "argument dropped":
            return _arguments(tokens, chance, is_more=kind == "argument added")
        case "words swapped":
            return _swapped(tokens, chance)
        case "number out of range":
            return _too_large(tokens, chance)
        case "end of a block dropped" | "head of a block dropped":
            words = _CLOSING if kind == "end of a block dropped" else _OPENING
            found = any(token.text.upper() in words for token in tokens[:2])
            return (tokens[0].start, tokens[-1].end, "") if found else None
        case "quote lost":
            ends = [end for t in tokens if t.text[0] == '"' for end in (t.start, t.end - 1)]
            at = chance.choice(ends) if ends else 0
            return (at, at + 1, "") if ends else None
        case _:
            literals = [t for t in tokens if _type_of(t)]
            if not literals:
                return None
            token = chance.choice(literals)
            return token.start, token.end, chance.choice(_LITERALS[_type_of(token)])


def _type_of(token: Token) -> str:
    """Return the type of a literal; ``""`` for other tokens."""
    if token.text.upper() in ("TRUE", "FALSE"):
        return "BOOL"
    if token.text.isdecimal():
        return "INT"
    return "REAL" if token.text.replace(".", "", 1).isdecimal() else ""


def _misspelt(words: Sequence[Token], chance: random.Random) -> Exchange | None:
    """Return a slip in one of some words."""
    if not words:
        return None
    token = chance.choice(words)
    text, at = token.text, chance.randrange(len(token.text))
    slips = [text[:at] + text[at + 1 :], text[:at] + text[at] + text[at:]]
    slips.append(text[:at] + chance.choice(_LETTERS) + text[at + 1 :])
    if at + 1 < len(text):
        slips.append(text[:at] + text[at + 1] + text[at] + text[at + 2 :])
    wrong = chance.choice([slip for slip in slips if slip.upper() != text.upper()] or [text + "x"])
    return token.start, token.end, wrong


def _arguments(tokens: Sequence[Token], chance: random.Random, *, is_more: bool) -> Exchange | None:
    """Return a call with one more argument at its end, or without its last one."""
    calls = []
    declares = any(token.text.upper() in SIGNATURES for token in tokens[:2])
    for index, token in enumerate(() if declares else tokens[:-1]):
        if token.kind == "NAME" and tokens[index + 1].text == "(":
            depth = 0
            start = tokens[index + 1].end
            for other in tokens[index + 1 :]:
                depth += (other.text in "([{") - (other.text in ")]}")
                if depth == 1 and other.text == ",":
                    start = other.start
                if depth == 0:
                    calls.append((start, other.start, other is tokens[index + 2]))
                    break
    if not is_more:
        calls = [one for one in calls if not one[2]]
    if not calls:
        return None
    start, end, is_empty = chance.choice(calls)
    return (end, end, "0" if is_empty else ", 0") if is_more else (start, end, "")


def _swapped(tokens: Sequence[Token], chance: random.Random) -> Exchange | None:
    """Two words or signs beside one another change places; of operands, the operator stays."""
    places = [
        (left, right)
        for left, right in itertools.pairwise(tokens)
        if left.text.upper() != right.text.upper()
    ]
    if not places:
        return None
    left, right = chance.choice(places)
    return left.start, right.end, f"{right.text} {left.text}"


def _too_large(tokens: Sequence[Token], chance: random.Random) -> Exchange | None:
    """Return an index or interrupt number far beyond all limits."""
    numbers = [
        token
        for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False)
        if token.text.isdecimal()
        and (before.text == "[" or after.text == "]" or before.text.upper() == "DECL")
    ]
    is_declared = tokens[0].text.upper() in _DECLARING
    if (
        not numbers
        or is_declared
        or tokens[1].kind == "NAME"
        or any(token.text == "{" for token in tokens)
    ):
        return None
    token = chance.choice(numbers)
    return token.start, token.end, chance.choice(("99999", "0"))


def cut(text: str, chance: random.Random) -> str:
    """Return a text that ends early, like a file that was not copied completely."""
    return text[: chance.randrange(len(text) // 4, len(text))] if text else ""


def lines_of_tokens(source: Source) -> Iterator[list[Token]]:
    """Yield the tokens of each line that has some."""
    lexer: Lexer = builder().failures.recognizer.lexer
    line: list[Token] = []
    for lexeme, start in zip(*lexer.located(source.text), strict=True):
        kind = lexer.kinds[lexeme]
        if kind < 0:
            continue
        if "\n" in lexeme or "\r" in lexeme:
            if line and line[0].text[0] != "&":  # header lines are for KUKA's tools
                yield line
            line = []
        else:
            line.append(Token(lexer.names[kind], start, lexeme, lexer.is_keyword(kind)))
    if line:
        yield line
