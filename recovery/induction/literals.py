"""Forms of literals that the lexer splits: ``1.5E-3`` read as a number, a name, a sign.

Two operands are never adjacent without a blank. If a literal and a name are, they are one literal;
its characters by class form a chain as the symbols of a line do. A text in quotes that a token
reads but for its blanks is one of that token.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from grammar.notation.edits import AddAlternative, Replace, apply
from grammar.notation.model import Alternative, CharSet, Element, Grammar, Literal, Repeat
from grammar.parser.lexer import ERROR, Lexer, lexer_of
from recovery.forms.chain import Factor, chain_of

_SIGNS = frozenset("+-")
#: A class of characters and the last character before it that is no digit and no sign.
_Class = tuple[str, str]


def split_literals(
    lines: Iterable[tuple[str, int]], lexer: Lexer
) -> tuple[AddAlternative, frozenset[int], tuple[str, ...]] | None:
    """Return the alternative that reads split literals of lines, the files with any, the literals.

    Each of ``lines`` comes with the number of its file. The result is ``None`` without split
    literals.
    """
    files: set[int] = set()
    owners: Mapping[str, list[str]] = defaultdict(list)
    for line, file in lines:
        for text, owner in _touching(line, lexer):
            files.add(file)
            owners[owner].append(text)
    if not files:
        return None
    # the token with the longest beginning of its own: of 1.5E-3 that of 1.5, not that of 1
    owner = max(owners, key=lambda o: (len(set(owners[o])), o))
    texts = tuple(dict.fromkeys(owners[owner]))
    text = " ".join(map(_written, chain_of(map(_classes, texts))))
    return AddAlternative(owner, text), frozenset(files), texts


def spaced_literals(grammar: Grammar, texts: Sequence[str]) -> tuple[Replace, ...]:
    """Return the blanks that let tokens read texts in quotes; none if they do not read them all."""

    def read(*edits: Replace) -> set[str]:
        lexer = lexer_of(apply(grammar, edits))
        return {text for text in texts if lexer.kinds[text] != ERROR}

    found = tuple(edit for edit in blanks_between_quotes(grammar) if read(edit))
    return found if len(read(*found)) == len(set(texts)) else ()


def blanks_between_quotes(grammar: Grammar) -> Iterator[Replace]:
    """Yield blanks for each token that has a row of the same characters, but none, in quotes."""
    for rule in grammar.rules:
        quoted = ((n, a) for n, a in enumerate(rule.alternatives, 1) if is_quoted(a))
        for number, alternative in quoted if rule.is_lexer else ():
            for place, element in enumerate(alternative.elements, 1):
                match element:
                    case Repeat(item=CharSet() as some, operator="+") if not has_blank(some):
                        one = rule.source_of(some)
                        yield Replace(rule.name, (number, place), f"' '* {one} ({one} | ' ')*")


def is_quoted(alternative: Alternative) -> bool:
    """Return whether a token begins and ends with the same sign."""
    match alternative.elements:
        case (Literal(text=first), *_, Literal(text=last)):
            return first[0] == last and not last.isalnum()
    return False


def has_blank(element: Element) -> bool:
    """Return whether an element is a set of characters with the blank."""
    return isinstance(element, CharSet) and any(a <= ord(" ") <= b for a, b in element.ranges)


def _touching(line: str, lexer: Lexer) -> Iterable[tuple[str, str]]:
    """Yield literals that are cut apart, with the token that their beginning was taken for."""
    lexemes = lexer.lexemes(line)
    kinds = [lexer.kinds[lexeme] for lexeme in lexemes]
    name = lexer.name_kind
    ends = []
    at = 0
    for lexeme in lexemes:  # where tokens are left out by the lexer they are missing here
        start = line.find(lexeme, at)
        at = start + len(lexeme)
        ends.append((start, at))
    for place in range(len(lexemes) - 1):
        if kinds[place] <= 0 or not lexemes[place][:1].isdigit() or kinds[place + 1] != name:
            continue
        if ends[place][1] != ends[place + 1][0] or not lexemes[place + 1].isalnum():
            continue
        last = place + 1
        has_exponent = (
            place + 3 < len(lexemes)
            and lexemes[last + 1] in _SIGNS
            and lexemes[last + 2].isdigit()
            and ends[last][1] == ends[last + 1][0]
            and ends[last + 1][1] == ends[last + 2][0]
        )
        last += 2 * has_exponent
        yield line[ends[place][0] : ends[last][1]].upper(), lexer.names[kinds[place]]


def _classes(text: str) -> list[_Class]:
    out: list[_Class] = []
    behind = ""
    for character in text:
        sort = "digit" if character.isdigit() else "sign" if character in _SIGNS else character
        if not out or out[-1][0] != sort:
            out.append((sort, behind))
        if sort not in ("digit", "sign"):
            behind = character
    return out


def _written(factor: Factor[_Class]) -> str:
    sorts = [sort for sort, _ in factor.symbols]
    texts = {"digit": "[0-9]+", "sign": "[+\\-]"}
    text = " | ".join(texts.get(s, f"[{s}]" if s.isalpha() else f"'{s}'") for s in sorts)
    text = text if len(sorts) == 1 and not (factor.often and "+" in text[-1:]) else f"({text})"
    return f"{text}{factor.often}"
