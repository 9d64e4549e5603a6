"""The smallest edit with which a failing line becomes valid: what was probably meant.

One token of the line is replaced, removed or inserted, and the line is parsed alone in a routine or
data list that is otherwise valid. The first edit with which it can be parsed is reported.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS, OUTERMOST
from grammar.diagnostics.did_you_mean import nearest
from grammar.diagnostics.error_site import ErrorSite
from grammar.diagnostics.open_blocks import innermost, lead
from grammar.parser.tree import Tree
from grammar.syntax.build import builder
from support.lazy_dataclass import dataclass

# Longer lines are data, and every attempt parses the whole line.
_LONGEST = 1_000
#: The opening bracket of each closing one.
BRACKETS = {")": "(", "]": "[", "}": "{"}
#: Signs to insert before the failure, the likeliest first.
_SIGNS = ("=", ",", ".", "(", "[")
_SHORTEST_WORD = 3


@dataclass(frozen=True, slots=True)
class LineEdit:
    """An edit of a line: ``text`` replaces its tokens from ``first`` up to before ``stop``."""

    first: int
    stop: int
    text: str


def keyword(site: ErrorSite) -> LineEdit | None:
    """Return the edit that corrects one misspelt keyword near the failure, or ``None``."""
    closer = site.block.closer if site.block else ""
    for place in (site.place, site.place - 1, site.place - 2, 0):
        word = site.word(place)
        shortest = 2 if len(site.words) == 1 else _SHORTEST_WORD
        if len(word) < shortest or not word.isidentifier() or word in _keywords():
            continue
        for meant in dict.fromkeys((closer, *nearest(word, _keywords()))):
            if is_one_slip(word, meant) and _reads(site, LineEdit(place, place + 1, meant)):
                return LineEdit(place, place + 1, meant)
    return None


def doubled(site: ErrorSite) -> LineEdit | None:
    """Return the edit that removes a token repeated near the failure, or ``None``."""
    for place in (site.place, site.place - 1):
        if place > 0 and site.word(place) and site.word(place) == site.word(place - 1):
            edit = LineEdit(place, place + 1, "")
            if _reads(site, edit):
                return edit
    return None


def bracket(site: ErrorSite) -> LineEdit | None:
    """Return the edit that inserts a missing closing bracket, or ``None``."""
    missing = [
        closer
        for closer, opener in BRACKETS.items()
        if site.words.count(opener) > site.words.count(closer)
    ]
    end = len(site.words)
    places = dict.fromkeys([*range(site.place, min(end, site.place + 4)), end])
    for closer in missing:
        for place in places:
            edit = LineEdit(place, place, closer)
            if _reads(site, edit):
                return edit
    return None


def left_out(site: ErrorSite) -> LineEdit | None:
    """Return the edit that inserts a missing sign before the failure, or ``None``."""
    if site.is_at_end:
        return None
    tokens = site.tokens
    is_apart = site.place > 0 and tokens[site.place - 1].end() < tokens[site.place].start()
    for sign in _SIGNS:
        if sign == "." and is_apart:  # two separate words lack an operator, not a dot
            continue
        edit = LineEdit(site.place, site.place, sign)
        if _reads(site, edit):
            return edit
    return None


def is_one_slip(word: str, meant: str) -> bool:
    """Return whether two words differ by one letter (changed, added or missing) or by a swap."""
    if abs(len(word) - len(meant)) > 1:
        return False
    if len(word) != len(meant):
        longer, shorter = (word, meant) if len(word) > len(meant) else (meant, word)
        return any(longer[:i] + longer[i + 1 :] == shorter for i in range(len(longer)))
    wrong = [i for i, (a, b) in enumerate(zip(word, meant, strict=True)) if a != b]
    if len(wrong) == 1:
        return True
    return len(wrong) == 2 and sorted(word[wrong[0] : wrong[1] + 1]) == sorted(
        meant[wrong[0] : wrong[1] + 1]
    )


@cache
def _keywords() -> tuple[str, ...]:
    lexer = builder().parser.recognizer.lexer
    words = (lexer.display[kind] for kind in range(len(lexer.names)) if lexer.is_keyword(kind))
    return tuple(word for word in words if len(word) > 1)


# ----------------------------------------------------------------------------------- the trial


def _reads(site: ErrorSite, edit: LineEdit) -> bool:
    """Return whether the line can be parsed after the edit."""
    if len(site.code) > _LONGEST:
        return False
    line = _edited(site, edit)
    return any(isinstance(builder().parser.parse(text), Tree) for text in _programs(site, line))


def _edited(site: ErrorSite, edit: LineEdit) -> str:
    tokens = site.tokens
    start = tokens[edit.first].start() if edit.first < len(tokens) else len(site.code)
    end = tokens[edit.stop - 1].end() if edit.stop > edit.first else start
    return f"{site.code[:start]} {edit.text} {site.code[end:]}"


def _programs(site: ErrorSite, line: str) -> Iterator[str]:
    """Yield the shortest files in which the line can stand."""
    word = lead(line)
    if word in OUTERMOST:
        yield _lines(line, BLOCKS[word].closer)
    elif word in ("END", "ENDFCT", "ENDDAT"):
        yield _lines(
            {"END": "DEF A()", "ENDFCT": "DEFFCT INT A()", "ENDDAT": "DEFDAT A"}[word], line
        )
    elif innermost(site.block, ("DEFDAT",)) is not None:
        yield _lines("DEFDAT A PUBLIC", line, "ENDDAT")
    else:
        yield _lines("DEF A()", *_block(word, line), "END")


def _block(word: str, line: str) -> Sequence[str]:
    """Return the line with the lines around it that its kind of statement needs."""
    opener = CLOSERS.get(word, (BRANCHES.get(word, ""),))[0]
    if opener:
        head = _HEADS[opener]
        return (*head, line) if word in CLOSERS else (*head, line, *_TAILS[opener])
    return (line, *_TAILS.get(word, ()))


_HEADS = {
    "IF": ("IF TRUE THEN",),
    "FOR": ("FOR I = 1 TO 2",),
    "WHILE": ("WHILE TRUE",),
    "REPEAT": ("REPEAT",),
    "LOOP": ("LOOP",),
    "SWITCH": ("SWITCH I", "CASE 1"),
    "SPLINE": ("SPLINE",),
    "PTP_SPLINE": ("PTP_SPLINE",),
}
_TAILS = {word: (BLOCKS[word].closer,) for word in _HEADS} | {
    "REPEAT": ("UNTIL TRUE",),
    "SWITCH": ("CASE 1", "ENDSWITCH"),
}


def _lines(*lines: str) -> str:
    return "\n".join((*lines, ""))
