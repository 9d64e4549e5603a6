"""Tokens for characters of failing lines that the lexer has in none: signs, and texts in quotes."""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, count, pairwise
from math import comb
from os.path import commonprefix
from statistics import mean

from grammar.parser.lexer import ERROR, Lexer
from recovery.brackets import BRACKETS, CLOSING
from recovery.tuning import INFERRED_SHARE, QUOTED_SIGNS, SEVERAL, UNLIKELY

#: Signs that are part of no other one, and those that stand ahead of operands too.
_NOT_BESIDE = frozenset({*BRACKETS, *CLOSING, ",", "'", '"'})
_AHEAD = frozenset("+-")


@dataclass(frozen=True, slots=True)
class UnknownToken:
    """A token that a lexer lacks: its name, the text of its rule, and whether it is a value.

    ``files`` are the numbers of the files that have it, ``seen`` its distinct texts there.
    """

    name: str
    rule: str
    is_value: bool
    files: frozenset[int]
    seen: tuple[str, ...]


def unknown_tokens(
    lines: Iterable[tuple[str, int]],
    lexer: Lexer,
    known: Collection[str],
    operators: Collection[str] = (),
) -> Iterator[UnknownToken]:
    """Yield the unknown tokens of lines: quotes first, those of most files first.

    Each of ``lines`` comes with the number of its file. A character that nearly all lines have in
    pairs with no operand against the outside is a quote. Other ones that are always side by side
    are one sign. No token has one of the ``known`` names. ``operators`` are signs that the grammar
    reads between operands, so that lines in which they stand alone may be none of these.
    """
    having: dict[str, set[int]] = defaultdict(set)
    paired: dict[str, list[bool]] = defaultdict(list)
    every = list(dict.fromkeys(lines))
    unknown = {c for c in set("".join(line for line, _ in every)) if _is_sign(c, lexer)}
    for line, file in every:
        for sign in () if unknown.isdisjoint(line) else _signs(line, lexer):
            having[sign].add(file)
            for part in set(sign):
                paired[part].append(_inside(line, part) is not None)
    single = {sign for sign in having if len(sign) == 1}
    for sign in [s for s in having if len(s) > 1 and single.issuperset(s)]:
        for part in sign:
            having[part] |= having[sign]
        del having[sign]
    quotes = {sign for sign in single if mean(paired[sign]) >= INFERRED_SHARE}
    for sign in sorted(having, key=lambda s: (s in quotes, len(having[s]), s), reverse=True):
        if sign in quotes:
            yield from _texts_in_quotes(every, sign, lexer, f"{_name(sign)}_TEXT", known)
        else:
            yield _token(_name(sign), _written(sign), known, False, having[sign], [sign])
    yield from _compound_signs(every, lexer, known, operators)


def _compound_signs(
    lines: Iterable[tuple[str, int]],
    lexer: Lexer,
    known: Collection[str],
    operators: Collection[str],
) -> Iterator[UnknownToken]:
    """Yield signs that the lexer takes for two: operands around them and no blank between.

    The second one stands alone between operands elsewhere: it is not what an operand begins with.
    """
    touching: dict[str, list[bool]] = defaultdict(list)
    having: dict[str, set[int]] = defaultdict(set)
    between = set(operators)
    for line, file in lines:
        lexemes, offsets = lexer.located(line)
        found = [(t, at) for t, at in zip(lexemes, offsets, strict=True) if not t.isspace()]
        sorts = "".join(
            "s" if _is_operator(t) else "x" if t in _NOT_BESIDE else "_" for t, _ in found
        )
        between |= {found[at.start() + 1][0] for at in re.finditer("(?=_s_)", sorts)}
        for place in (at.start() + 1 for at in re.finditer("(?=_ss_)", sorts)):
            (left, start), (right, end) = found[place : place + 2]
            touching[left + right].append(start + len(left) == end)
            having[left + right].add(file)
    for sign in sorted(having, key=lambda s: (-len(having[s]), s)):
        if mean(touching[sign]) >= INFERRED_SHARE and sign[-1] in between - _AHEAD:
            yield _token(_name(sign), _written(sign), known, False, having[sign], [sign])


def _is_operator(lexeme: str) -> bool:
    """Return whether a lexeme is one character that may be an operator, or part of one."""
    is_sign = lexeme.isprintable() and not lexeme.isalnum() and lexeme not in _NOT_BESIDE
    return len(lexeme) == 1 and is_sign and lexeme not in "_$"


def _texts_in_quotes(
    lines: Iterable[tuple[str, int]], quote: str, lexer: Lexer, name: str, known: Collection[str]
) -> Iterator[UnknownToken]:
    """Yield tokens for what lines have between quotes, by the kind of its first character.

    Texts that begin otherwise are something else: a number to base 2 is no character.
    """
    groups: dict[str, list[tuple[str, int]]] = defaultdict(list)
    for line, file in lines:
        for text in _inside(line, quote) or ():
            groups[_beginning(text)].append((text, file))
    written = _written(quote)
    found = []
    for group in groups.values():
        content = _content([text for text, _ in group], quote)
        quoted = [(f"{quote}{text}{quote}", file) for text, file in group]
        new = [(text, file) for text, file in quoted if lexer.kinds[text] == ERROR]
        files = {file for _, file in new}
        seen = [text for text, _ in new]
        found.append(_token(name, f"{written} {content} {written}", known, True, files, seen))
    yield from sorted((one for one in found if one.files), key=lambda one: -len(one.files))


def _name(sign: str) -> str:
    """Return a name for the token of a sign."""
    return re.sub(r"\W", "_", "_".join(unicodedata.name(c, "sign") for c in sign)).upper()


def _written(sign: str) -> str:
    return "'{}'".format(_escaped(sign, "'"))


def _token(
    name: str,
    written: str,
    known: Collection[str],
    is_value: bool,
    files: Iterable[int],
    seen: Iterable[str],
) -> UnknownToken:
    name = next(n for n in chain([name], (f"{name}_{n}" for n in count(2))) if n not in known)
    texts = tuple(dict.fromkeys(seen))
    return UnknownToken(name, f"{name} : {written} ;", is_value, frozenset(files), texts)


def _signs(line: str, lexer: Lexer) -> Iterator[str]:
    """Yield the runs of unknown characters of a line that could be signs."""
    lexemes, offsets = lexer.located(line)
    found, end = "", 0
    for lexeme, start in zip(lexemes, offsets, strict=True):
        is_sign = _is_sign(lexeme, lexer)
        if found and not (is_sign and start == end):
            yield found
            found = ""
        found += lexeme if is_sign else ""
        end = start + len(lexeme)
    if found:
        yield found


def _is_sign(lexeme: str, lexer: Lexer) -> bool:
    """Return whether a lexeme is a character that no token has, and could be a sign."""
    return lexer.kinds[lexeme] == ERROR and lexeme.isprintable() and not lexeme.isalnum()


def _inside(line: str, quote: str) -> list[str] | None:
    """Return what a line has between quotes; ``None`` if the character is no quote there.

    Then it touches an operand from the outside, or what would be quoted has one on either side.
    """
    outside, inside = (line.split(quote)[n::2] for n in (0, 1))
    if len(outside) == len(inside):
        return None
    for left, right in pairwise(outside):
        if left[-1:].isalnum() or right[:1].isalnum():
            return None
        if left.rstrip()[-1:].isalnum() and right.lstrip()[:1].isalnum():
            return None
    return inside


def _content(texts: Sequence[str], quote: str) -> str:
    """Return what a lexer rule writes for texts between quotes, which begin with the same kind.

    Several texts that begin alike have that beginning. Digits that are unlikely to be missing by
    chance are left out: a binary number has no 2.
    """
    several = set(texts)
    begun = commonprefix([*several]) if len(several) >= SEVERAL else ""  # noqa: RUF071 - texts
    rest = [text.removeprefix(begun) for text in texts]
    characters = "".join(rest)
    signs = sorted({c for c in characters if not (c.isascii() and c.isalnum())})
    if len(signs) > QUOTED_SIGNS:
        return f"~[{_escaped(quote, ']-')}\\r\\n]*"
    digits = [c for c in characters if "0" <= c <= "9"]
    some = "".join(sorted(set(digits)))
    is_part = comb(10, len(some)) * (len(some) / 10) ** len(digits) < UNLIKELY
    letters = "A-Za-z" if any(map(str.isalpha, characters)) else ""
    numerals = some if is_part else "0-9" if digits else ""
    blank = _escaped("".join(signs), "]-")
    inner = f"[{letters}{numerals}{blank}]"
    firsts = {"letter": letters, "digit": numerals}.get(_beginning(texts[0]))
    if firsts and not begun:
        return f"[{firsts}] {inner}*"
    written = [begun and "'{}'".format(_escaped(begun, "'"))]
    if signs and (letters or numerals):  # no text has signs and blanks alone
        first = f"[{blank}]* " if any(not text[:1].isalnum() for text in rest if text) else ""
        some = f"{first}[{letters}{numerals}] {inner}*"
        written.append(f"({some})?" if "" in rest else some)
    else:
        written.append(f"{inner}{'*' if '' in rest else '+'}")
    return " ".join(filter(None, written))


def _beginning(text: str) -> str:
    """Return with what a text begins: "letter", "digit" or "other"."""
    first = text[:1] if text.isascii() else ""
    return "letter" if first.isalpha() else "digit" if first.isdigit() else "other"


def _escaped(text: str, special: str) -> str:
    """Return the text as a lexer rule writes it, where some characters are special."""
    return "".join(f"\\{c}" if c in f"\\{special}" else c for c in text)
