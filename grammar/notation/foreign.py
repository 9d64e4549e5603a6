"""Grammars in another style of ANTLR 4 than ours, written anew in ours.

What comes out reads the same texts: actions and labels change nothing of what is read, tokens that
parser rules only quote get a rule, and left recursion becomes a level of operators each. Words that
are spelt by fragments of letters become keywords of a grammar that ignores case.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from itertools import count
from string import ascii_lowercase, ascii_uppercase

from grammar.notation.g4 import checked, unchecked
from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    Literal,
    Reference,
    Repeat,
    Rule,
    Span,
    characters_of,
    walk,
)
from grammar.notation.unsupported import without_decoration

#: What is spliced into a text: from where, up to where, and what.
_Splice = tuple[int, int, str]


def read_foreign(text: str, *, source: str = "grammar") -> Grammar:
    """Read a grammar in any style that can be written anew in ours.

    One that is in ours stays as it is. Raises `grammar.notation.model.GrammarError` with what is
    not understood; lines are those of the text, but for a rule that was written anew.
    """
    text = without_decoration(text)
    for rewritten in (_with_keywords, _without_ends, _with_tokens, _with_levels):
        text = rewritten(unchecked(text, source))
    return checked(unchecked(text, source), source)


def _with_keywords(grammar: Grammar) -> str:
    """Words spelt by fragments that read a letter in either case as quoted words."""
    letters = {r.name: letter for r in grammar.rules if r.is_fragment and (letter := _letter(r))}
    changed: dict[str, list[_Splice]] = {}
    for rule in grammar.rules:
        for alternative in rule.alternatives if rule.is_lexer and not rule.is_fragment else ():
            word = _spelt(alternative, letters)
            if word:
                changed.setdefault(rule.name, []).append((*alternative.span, f"'{word}'"))
    if not changed or grammar.case_insensitive:
        return _spliced(grammar, changed)
    head = re.sub(
        r"(?m)((?:^|\*/)\s*grammar\s+\w+\s*;)(\s*options\s*\{)?",
        lambda found: (
            f"{found[1]}{found[2] or ' options {'} caseInsensitive = true; "
            + ("" if found[2] else "}")
        ),
        grammar.gaps[0],
        count=1,
    )
    return head + _spliced(grammar, changed).removeprefix(grammar.gaps[0])


def _letter(rule: Rule) -> str:
    """The letter that a fragment reads in either case; empty where it reads anything else."""
    alternatives = rule.alternatives
    found = [characters_of(e) for a in alternatives for e in a.elements if len(a.elements) == 1]
    codes = {code for ranges in found for low, high in ranges or () for code in (low, high)}
    text = "".join(map(chr, sorted(codes)))
    pairs = map("".join, zip(ascii_uppercase, ascii_lowercase, strict=True))
    return text[:1] if len(found) == len(alternatives) and text in pairs else ""


def _spelt(alternative: Alternative, letters: Mapping[str, str]) -> str:
    """The word of an alternative of letters and other characters; empty where it is none."""
    parts = [
        letters.get(e.name, "") if isinstance(e, Reference) else getattr(e, "text", "")
        for e in alternative.elements
    ]
    is_word = all(parts) and any(isinstance(e, Reference) for e in alternative.elements)
    word = "".join(parts)
    return word if is_word and re.fullmatch(r"\w{2,}", word) else ""


def _without_ends(grammar: Grammar) -> str:
    """Tokens that may end with the file may end anywhere: the longest match continues as before."""
    return _spliced(
        grammar,
        {
            rule.name: [
                (*e.span, "")
                for a in rule.alternatives
                for repeated in [_repeated(a)]
                for e in walk(a)
                if e.span not in repeated and _is_end(e)
            ]
            for rule in grammar.rules
            if rule.is_lexer
        },
    )


def _is_end(element: Element) -> bool:
    """Whether an element is the end of the file, as often as may be."""
    item = element.item if isinstance(element, Repeat) else element
    return isinstance(item, Reference) and item.name == "EOF"


def _repeated(alternative: Alternative) -> set[Span]:
    """Where elements stand that are left out with their repetition."""
    return {e.item.span for e in walk(alternative) if isinstance(e, Repeat)}


def _with_tokens(grammar: Grammar) -> str:
    """Words and signs that parser rules quote and no token is defined as get a token each."""
    known = {grammar.fold(text): name for text, name in grammar.literal_tokens.items()}
    taken = set(grammar.by_name)
    rules = []
    for element in _elements(grammar):
        if isinstance(element, Literal) and grammar.fold(element.text) not in known:
            name = next(n for n in _names(element.text) if n not in taken)
            taken.add(name)
            known[grammar.fold(element.text)] = name
            quoted = element.text.replace("\\", r"\\").replace("'", r"\'")
            rules.append(f"{name} : '{quoted}' ;\n")
    lexer = next((n for n, rule in enumerate(grammar.rules) if rule.is_lexer), len(grammar.rules))
    pairs = zip(grammar.gaps[:lexer], grammar.rules[:lexer], strict=True)
    ahead = sum(len(gap) + len(rule.text) for gap, rule in pairs) + len(grammar.gaps[lexer])
    text = grammar.text
    return text[:ahead].rstrip() + "\n\n" + "".join(rules) + text[ahead:] if rules else text


def _elements(grammar: Grammar) -> Iterator[Element]:
    for rule in grammar.rules:
        if not rule.is_lexer:
            yield from (e for alternative in rule.alternatives for e in walk(alternative))


def _names(text: str) -> Iterator[str]:
    """Names for the token of a text, the one to be preferred first."""
    signs = (
        c if c.isascii() and (c.isalnum() or c == "_") else f"_{unicodedata.name(c, 'SIGN')}_"
        for c in text
    )
    name = re.sub(r"\W|_{2,}", "_", "".join(signs)).strip("_").upper().removesuffix("_SIGN")
    name = name if name[:1].isalpha() and name.isascii() else f"SIGN_{name}".rstrip("_")
    return (f"{name}{number}" if number else name for number in count())


def _with_levels(grammar: Grammar) -> str:
    """Rules that begin with themselves as levels of operators, the tightest at the bottom."""
    changed: dict[str, list[_Splice]] = {}
    for rule in grammar.rules:
        is_led = any(_is(rule, a.elements[:1]) for a in rule.alternatives if len(a.elements) > 1)
        if not rule.is_lexer and is_led:
            changed[rule.name] = [(0, len(rule.text), _levels(grammar, rule))]
    return _spliced(grammar, changed)


def _is(rule: Rule, elements: tuple[Element, ...]) -> bool:
    return bool(elements) and isinstance(e := elements[0], Reference) and e.name == rule.name


def _levels(grammar: Grammar, rule: Rule) -> str:
    """The text of the rules; ANTLR lets the first of several alternatives bind tightest."""
    binary: list[str] = []
    prefixes: list[str] = []
    suffixes: list[str] = []
    others: list[str] = []
    kinds = {(True, True): binary, (False, True): prefixes, (True, False): suffixes}
    for alternative in rule.alternatives:
        elements = alternative.elements
        first, last = _is(rule, elements[:1]), len(elements) > 1 and _is(rule, elements[-1:])
        some = elements[first : len(elements) - last]
        text = rule.text[some[0].span[0] : some[-1].span[1]] if some else ""
        kinds.get((first, last), others).append(text)
    if not others:  # nothing that it ends with: reported as any other left recursion
        return rule.text
    fresh = (n for k in count(2) if (n := f"{rule.name}{k}") not in grammar.by_name)
    name, texts = rule.name, []
    for operator in reversed(binary):
        lower = next(fresh)
        texts.append(f"{name}\n    : {lower} ({operator} {lower})*\n    ;")
        name = lower
    if prefixes:
        lower = next(fresh)
        texts.append(_choice(name, [*(f"{prefix} {name}" for prefix in prefixes), lower]))
        name = lower
    if suffixes:
        lower = next(fresh)
        texts.append(f"{name}\n    : {lower} ({' | '.join(suffixes)})*\n    ;")
        name = lower
    return "\n\n".join([*texts, _choice(name, others)])


def _choice(name: str, alternatives: list[str]) -> str:
    return f"{name}\n    : " + "\n    | ".join(alternatives) + "\n    ;"


def _spliced(grammar: Grammar, changed: Mapping[str, list[_Splice]]) -> str:
    """The text of a grammar with parts of rules replaced."""
    pieces = [grammar.gaps[0]]
    for rule, gap in zip(grammar.rules, grammar.gaps[1:], strict=True):
        text = rule.text
        for start, end, new in sorted(changed.get(rule.name, ()), reverse=True):
            text = text[:start] + new + text[end:]
        pieces += (text, gap)
    return "".join(pieces)
