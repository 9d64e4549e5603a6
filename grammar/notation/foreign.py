"""Grammars written in another style of ANTLR 4, rewritten in the style of this project.

The result accepts the same texts. Actions and labels are dropped because they do not change what is
accepted. Literals that only parser rules quote get a lexer rule. Parser rules quote signs and name
the tokens of words, whichever way they were written. Rows of lines and brackets behind operands
have rules. A left-recursive rule becomes one for each level of precedence. Where no rule reads EOF,
a new start rule does. Keywords spelt with a fragment for each letter (``I F``) become literals of a
grammar that ignores case.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from itertools import count
from string import ascii_lowercase, ascii_uppercase

from grammar.notation.bracket_style import with_rules_of_brackets
from grammar.notation.g4 import checked, unchecked
from grammar.notation.line_style import with_ends_of_lines, with_rules_of_lines
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
from grammar.notation.splices import Splice, spliced
from grammar.notation.unsupported import without_decoration


def read_foreign(text: str, *, source: str = "grammar") -> Grammar:
    """Return the grammar in ``text``, rewritten if it is in another style.

    A grammar that is in the style already stays as it is. Raises
    `grammar.notation.model.GrammarError` for what is not supported. Line numbers are those of
    ``text``, except for a rule that was rewritten.
    """
    text = without_decoration(text)
    for rewritten in (
        _with_end,
        _with_keywords,
        _without_ends,
        _with_tokens,
        _with_quoted_signs,
        _with_levels,
        with_ends_of_lines,
        with_rules_of_lines,
        with_rules_of_brackets,
    ):
        text = rewritten(unchecked(text, source))
    return checked(unchecked(text, source), source)


def _with_end(grammar: Grammar) -> str:
    """Return the text with a start rule that reads to the end of the file, if no rule does."""
    is_ended = any(isinstance(e, Reference) and e.name == "EOF" for e in _elements(grammar))
    first = next(iter(grammar.parser_rules), None)
    if is_ended or first is None:
        return grammar.text
    name = next(n for k in count() if (n := f"file{k or ''}") not in grammar.by_name)
    return spliced(grammar, {first.name: [(0, 0, f"{name} : {first.name} EOF ; ")]})


def _with_keywords(grammar: Grammar) -> str:
    """Return the text with words spelt by one-letter fragments replaced by literals."""
    letters = {r.name: letter for r in grammar.rules if r.is_fragment and (letter := _letter(r))}
    changed: dict[str, list[Splice]] = {}
    for rule in grammar.rules:
        for alternative in rule.alternatives if rule.is_lexer and not rule.is_fragment else ():
            word = _spelt(alternative, letters)
            if word:
                changed.setdefault(rule.name, []).append((*alternative.span, f"'{word}'"))
    if not changed or grammar.case_insensitive:
        return spliced(grammar, changed)
    head = re.sub(
        r"(?m)((?:^|\*/)\s*grammar\s+\w+\s*;)(\s*options\s*\{)?",
        lambda found: (
            f"{found[1]}{found[2] or ' options {'} caseInsensitive = true; "
            + ("" if found[2] else "}")
        ),
        grammar.gaps[0],
        count=1,
    )
    return head + spliced(grammar, changed).removeprefix(grammar.gaps[0])


def _letter(rule: Rule) -> str:
    """Return the letter that a fragment reads in either case; empty if it reads anything else."""
    alternatives = rule.alternatives
    found = [characters_of(e) for a in alternatives for e in a.elements if len(a.elements) == 1]
    codes = {code for ranges in found for low, high in ranges or () for code in (low, high)}
    text = "".join(map(chr, sorted(codes)))
    pairs = map("".join, zip(ascii_uppercase, ascii_lowercase, strict=True))
    return text[:1] if len(found) == len(alternatives) and text in pairs else ""


def _spelt(alternative: Alternative, letters: Mapping[str, str]) -> str:
    """Return the word that an alternative of letter fragments spells, or an empty text."""
    parts = [
        letters.get(e.name, "") if isinstance(e, Reference) else getattr(e, "text", "")
        for e in alternative.elements
    ]
    is_word = all(parts) and any(isinstance(e, Reference) for e in alternative.elements)
    word = "".join(parts)
    return word if is_word and re.fullmatch(r"\w{2,}", word) else ""


def _without_ends(grammar: Grammar) -> str:
    """Return the text without EOF in lexer rules.

    The lexer takes the longest match, so such a token still ends with the file.
    """
    return spliced(
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
    """Return whether an element is EOF, with or without a suffix."""
    item = element.item if isinstance(element, Repeat) else element
    return isinstance(item, Reference) and item.name == "EOF"


def _repeated(alternative: Alternative) -> set[Span]:
    """Return the spans of items inside repetitions, which are removed together with these."""
    return {e.item.span for e in walk(alternative) if isinstance(e, Repeat)}


def _with_tokens(grammar: Grammar) -> str:
    """Return the text with a lexer rule for each literal that only parser rules have."""
    known = {grammar.fold(text): name for text, name in grammar.literal_tokens.items()}
    taken = set(grammar.by_name)
    rules = []
    for element in _elements(grammar):
        if isinstance(element, Literal) and grammar.fold(element.text) not in known:
            name = next(n for n in _names(element.text) if n not in taken)
            taken.add(name)
            known[grammar.fold(element.text)] = name
            rules.append(f"{name} : {_quoted(element.text)} ;\n")
    lexer = next((n for n, rule in enumerate(grammar.rules) if rule.is_lexer), len(grammar.rules))
    pairs = zip(grammar.gaps[:lexer], grammar.rules[:lexer], strict=True)
    ahead = sum(len(gap) + len(rule.text) for gap, rule in pairs) + len(grammar.gaps[lexer])
    text = grammar.text
    return text[:ahead].rstrip() + "\n\n" + "".join(rules) + text[ahead:] if rules else text


def _with_quoted_signs(grammar: Grammar) -> str:
    """Return the text with signs quoted in parser rules, and words written as their tokens."""
    texts = {
        n: text for text, n in grammar.literal_tokens.items() if not set(text) & set(" \t\r\n")
    }
    names = {grammar.fold(text): name for name, text in texts.items()}
    changed: dict[str, list[Splice]] = {}
    for rule in grammar.parser_rules:
        found = changed[rule.name] = []
        for element in walk(rule):
            match element:
                case Reference(name=name) if name in texts and not _is_word(texts[name]):
                    found.append((*element.span, _quoted(texts[name])))
                case Literal(text=text) if _is_word(text) and grammar.fold(text) in names:
                    found.append((*element.span, names[grammar.fold(text)]))
    return spliced(grammar, changed)


def _is_word(text: str) -> bool:
    return re.fullmatch(r"\w+", text) is not None


def _quoted(text: str) -> str:
    return "'" + text.replace("\\", r"\\").replace("'", r"\'") + "'"


def _elements(grammar: Grammar) -> Iterator[Element]:
    for rule in grammar.parser_rules:
        yield from walk(rule)


def _names(text: str) -> Iterator[str]:
    """Yield names for the token of a literal, the preferred one first."""
    signs = (
        c if c.isascii() and (c.isalnum() or c == "_") else f"_{unicodedata.name(c, 'SIGN')}_"
        for c in text
    )
    name = re.sub(r"\W|_{2,}", "_", "".join(signs)).strip("_").upper().removesuffix("_SIGN")
    name = name if name[:1].isalpha() and name.isascii() else f"SIGN_{name}".rstrip("_")
    return (f"{name}{number}" if number else name for number in count())


def _with_levels(grammar: Grammar) -> str:
    """Return the text with left-recursive rules replaced by levels of operators."""
    changed: dict[str, list[Splice]] = {}
    for rule in grammar.rules:
        is_led = any(_is(rule, a.elements[:1]) for a in rule.alternatives if len(a.elements) > 1)
        if not rule.is_lexer and is_led:
            changed[rule.name] = [(0, len(rule.text), _levels(grammar, rule))]
    return spliced(grammar, changed)


def _is(rule: Rule, elements: tuple[Element, ...]) -> bool:
    return bool(elements) and isinstance(e := elements[0], Reference) and e.name == rule.name


def _levels(grammar: Grammar, rule: Rule) -> str:
    """Return the rules that replace a left-recursive one; operators bind tighter further down.

    As in ANTLR, the first of several alternatives binds tightest.
    """
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
    if not others:  # no alternative ends the recursion: reported like any other left recursion
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
