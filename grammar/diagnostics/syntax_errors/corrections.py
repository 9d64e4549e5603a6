"""One token that is misspelt, repeated or missing, found by parsing the line without the mistake.

The line is parsed alone, in a routine or data list that is otherwise valid.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from grammar.blocks import BLOCKS, BRANCHES, CLOSERS, OUTERMOST
from grammar.diagnostics.diagnostic import Fix
from grammar.diagnostics.did_you_mean import edit_distance, nearest
from grammar.diagnostics.open_blocks import lead
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake
from grammar.parser.tree import Tree
from grammar.syntax.build import builder

# Longer lines are data, and every attempt parses the whole line.
_LONGEST = 1_000
#: The opening bracket of each closing one.
BRACKETS = {")": "(", "]": "[", "}": "{"}
#: Signs to insert before the failure, the likeliest first.
_SIGNS = ("=", ",", ".", "(", "[")
#: Signs that are written without blanks around them.
_CLOSE = ")]}.,([{"
_SHORTEST_WORD = 3


def misspelt_keyword(site: ErrorSite) -> Mistake | None:
    """Return the mistake of one misspelt keyword near the failure."""
    closer = site.block.closer if site.block else ""
    for place in (site.place, site.place - 1, site.place - 2, 0):
        word = site.word(place)
        shortest = 2 if len(site.words) == 1 else _SHORTEST_WORD
        if len(word) < shortest or not word.isidentifier() or word in _keywords():
            continue
        for meant in dict.fromkeys((closer, *nearest(word, _keywords()))):
            if edit_distance(word, meant, 1) == 1 and _reads(site, meant, place, place + 1):
                wrong, region = site.tokens[place][0], site.region(place)
                fix = Fix(f"did you mean {meant}?", region, meant)
                return Mistake(f"{wrong} is not a word of KRL", fix, region=region)
    return None


def repeated_token(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a token that is repeated near the failure."""
    for place in (site.place, site.place - 1):
        is_repeated = place > 0 and site.word(place) == site.word(place - 1) != ""
        if is_repeated and _reads(site, "", place, place + 1):
            message = f"{site.tokens[place][0]} stands twice"
            return Mistake(message, site.swap("", place), region=site.region(place))
    return None


def missing_bracket(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a missing closing bracket."""
    end = len(site.words)
    places = dict.fromkeys([*range(site.place, min(end, site.place + 4)), end])
    for closer, opener in BRACKETS.items():
        if site.words.count(opener) > site.words.count(closer):
            for place in places:
                if _reads(site, closer, place):
                    return _missing(site, closer, place)
    return None


def missing_sign(site: ErrorSite) -> Mistake | None:
    """Return the mistake of a missing sign before the failure."""
    if site.is_at_end:
        return None
    tokens, place = site.tokens, site.place
    is_apart = place > 0 and tokens[place - 1].end() < tokens[place].start()
    for sign in _SIGNS:
        if sign == "." and is_apart:  # two separate words lack an operator, not a dot
            continue
        if _reads(site, sign, place):
            return _missing(site, sign, place)
    return None


def _missing(site: ErrorSite, sign: str, place: int) -> Mistake:
    """Return the mistake of a missing sign, inserted before a token or at the end of the line."""
    message = f"{sign} is missing"
    if place >= len(site.tokens):
        return Mistake(message, site.append(sign))
    gap = site.gap(place)
    text = sign if sign in _CLOSE else f" {sign} "
    fix = Fix(f"write {sign} before {site.tokens[place][0]}", gap, text)
    return Mistake(message, fix, region=gap)


@cache
def _keywords() -> tuple[str, ...]:
    lexer = builder().parser.recognizer.lexer
    words = (lexer.display[kind] for kind in range(len(lexer.names)) if lexer.is_keyword(kind))
    return tuple(word for word in words if len(word) > 1)


def _reads(site: ErrorSite, text: str, first: int, stop: int = 0) -> bool:
    """Return whether the line can be parsed with a text for its tokens from ``first`` to ``stop``.

    Without ``stop`` the text is inserted.
    """
    if len(site.code) > _LONGEST:
        return False
    start = site.tokens[first].start() if first < len(site.tokens) else len(site.code)
    end = site.tokens[stop - 1].end() if stop else start
    line = f"{site.code[:start]} {text} {site.code[end:]}"
    return any(isinstance(builder().parser.parse(p), Tree) for p in _programs(site, line))


def _programs(site: ErrorSite, line: str) -> Iterator[str]:
    """Yield the shortest files in which the line can stand."""
    word = lead(line)
    if word in OUTERMOST:
        yield _lines(line, BLOCKS[word].closer)
    elif word in _MODULES:
        yield _lines(_MODULES[word], line)
    elif site.is_in_data_list:
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


_MODULES = {"END": "DEF A()", "ENDFCT": "DEFFCT INT A()", "ENDDAT": "DEFDAT A"}
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
