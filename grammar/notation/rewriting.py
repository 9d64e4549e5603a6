"""Changes of the text of a rule or grammar in one place, for `grammar.notation.edits`.

Functions that take a rule return its new text; functions that take a grammar return the new
grammar. All raise `GrammarError` if the place does not exist or the change does not fit.
"""

from __future__ import annotations

import re
from dataclasses import replace

from grammar.notation.addresses import Address, element_at, sequence_at, spelled
from grammar.notation.g4 import read_rule
from grammar.notation.model import Grammar, GrammarError, Group, Repeat, Rule


def with_optional(rule: Rule, at: Address, count: int) -> str:
    """Return the text with the ``count`` elements from an address on made optional."""
    first = element_at(rule, at)
    last = element_at(rule, (*at[:-1], at[-1] + count - 1))
    old = rule.text[first.span[0] : last.span[1]]
    if count == 1 and isinstance(first, Repeat):
        new = old[:-1] + "*" if first.operator == "+" else old
    elif count == 1:
        new = f"{old}?"
    else:
        new = f"({old})?"
    return _spliced(rule, (first.span[0], last.span[1]), new)


def widened(rule: Rule, at: Address, text: str) -> str:
    """Return the text with one more alternative for an element.

    It goes inside the element's parentheses and suffix.
    """
    element = element_at(rule, at)
    item, suffix = (
        (element.item, element.operator) if isinstance(element, Repeat) else (element, "")
    )
    old = rule.source_of(item)
    inner = old[1:-1] if isinstance(item, Group) else old
    return _spliced(rule, element.span, f"({inner} | {text}){suffix}")


def replaced(rule: Rule, at: Address, count: int, text: str) -> str:
    """Return the text with the ``count`` elements from an address on replaced."""
    last = element_at(rule, (*at[:-1], at[-1] + count - 1))
    return _spliced(rule, (element_at(rule, at).span[0], last.span[1]), text)


def without_element(rule: Rule, at: Address) -> str:
    """Return the text without an element and one blank beside it."""
    start, end = element_at(rule, at).span
    while start and rule.text[start - 1] == " " and rule.text[end : end + 1] in " \r\n)":
        start -= 1
    if rule.text[start - 1] == "(" and rule.text[end] == " ":
        end += 1
    return rule.text[:start] + rule.text[end:]


def with_insertion(rule: Rule, at: Address, text: str) -> str:
    """Return the text with ``text`` inserted before an element, or after the last one."""
    sequence = sequence_at(rule, at[:-1])
    elements, number = sequence.elements, at[-1]
    if not 1 <= number <= len(elements) + 1:
        raise GrammarError(f"rule {rule.name} has no place {spelled(at)}")
    if not elements:
        raise GrammarError(f"rule {rule.name}: an empty alternative at {spelled(at)}")
    if number <= len(elements):
        start = elements[number - 1].span[0]
        return rule.text[:start] + f"{text} " + rule.text[start:]
    end = elements[-1].span[1]
    return rule.text[:end] + f" {text}" + rule.text[end:]


def with_alternative(rule: Rule, text: str) -> str:
    """Return the text with one more alternative, laid out like the others."""
    body, semicolon = rule.text[:-1].rstrip(), rule.text[-1]
    gap = rule.text[len(body) : -1]
    indent = "\n    " if "\n" in rule.text else " "
    return f"{body}{indent}| {text}{gap}{semicolon}"


def without_alternative(rule: Rule, number: int) -> str:
    """Return the text without one alternative, numbered from 1."""
    if not 1 <= number <= len(rule.alternatives) or len(rule.alternatives) == 1:
        raise GrammarError(f"rule {rule.name} cannot lose alternative {number}")
    start, end = rule.alternatives[number - 1].span
    if start == end:
        raise GrammarError(f"rule {rule.name}: alternative {number} is empty")
    if label := re.match(r"\s*#\s*\w+", rule.text[end:]):
        end += label.end()
    if number > 1:
        start = rule.text.rindex("|", 0, start)
        start -= len(rule.text[:start]) - len(rule.text[:start].rstrip())
        return rule.text[:start] + rule.text[end:]
    following = rule.text.index("|", end)
    return rule.text[:start] + rule.text[following + 1 :].lstrip()


def _spliced(rule: Rule, span: tuple[int, int], text: str) -> str:
    return rule.text[: span[0]] + text + rule.text[span[1] :]


def with_rule(grammar: Grammar, after: Rule, text: str) -> Grammar:
    """Return the grammar with one more rule, placed after the rule ``after``."""
    rule = read_rule(text)
    if rule.name in grammar.by_name:
        raise GrammarError(f"rule {rule.name} exists already")
    index = grammar.rules.index(after) + 1
    rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
    gaps = (*grammar.gaps[:index], "\n\n", *grammar.gaps[index:])
    return replace(grammar, rules=rules, gaps=gaps)


def with_token(grammar: Grammar, name: str) -> Grammar:
    """Return the grammar with a token for one more keyword.

    Its rule goes to its alphabetical place among the rules whose names are their own text. If there
    are none, it comes before all other tokens, since the first of two rules that match the same
    text wins.
    """
    if name in grammar.by_name:
        raise GrammarError(f"token {name} exists already")
    if not re.fullmatch(r"[A-Z][A-Za-z0-9_]*", name):
        raise GrammarError(f"{name!r} is not the name of a token")
    keywords = [
        i for i, rule in enumerate(grammar.rules) if re.fullmatch(r"(\w+) : '\1' ;", rule.text)
    ]
    before = [i for i in keywords if _in_order(grammar.rules[i].name) < _in_order(name)]
    tokens = keywords or [i for i, rule in enumerate(grammar.rules) if rule.is_lexer]
    if not tokens:
        raise GrammarError("the grammar has no tokens yet")
    rule = read_rule(f"{name} : '{name}' ;")
    index = before[-1] + 1 if before else tokens[0]
    rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
    gap = index if before else index + 1
    gaps = (*grammar.gaps[:gap], "\n", *grammar.gaps[gap:])
    return replace(grammar, rules=rules, gaps=gaps)


def _in_order(name: str) -> str:
    """Return a sort key that puts a word before longer ones: C_PTP before CHAR."""
    return name.replace("_", " ")


def commented(grammar: Grammar, rule: Rule, text: str) -> Grammar:
    """Return the grammar with another comment of a rule.

    The comment is what stands between the rule and the blank line above it.
    """
    index = grammar.rules.index(rule)
    above, blank, _ = grammar.gaps[index].rpartition("\n\n")
    if not blank:
        raise GrammarError(f"rule {rule.name} has no blank line above it, so no comment of its own")
    lines = "".join(f"// {line}".rstrip() + "\n" for line in text.splitlines())
    gaps = (*grammar.gaps[:index], above + blank + lines, *grammar.gaps[index + 1 :])
    return replace(grammar, gaps=gaps)


def with_preamble(grammar: Grammar, text: str) -> Grammar:
    """Return the grammar with another comment at its head."""
    found = re.match(r"\s*/\*.*?\*/\s*", grammar.gaps[0], re.DOTALL)
    rest = grammar.gaps[0][found.end() :] if found else grammar.gaps[0]
    if "*/" in text:
        raise GrammarError("a preamble cannot hold the end of a comment")
    lines = "".join(f" * {line}".rstrip() + "\n" for line in text.splitlines())
    return replace(grammar, gaps=(f"/*\n{lines} */\n{rest}", *grammar.gaps[1:]))


def without_rule(grammar: Grammar, rule: Rule) -> Grammar:
    """Return the grammar without a rule and the comment above it."""
    index = grammar.rules.index(rule)
    joined = grammar.gaps[index].rstrip("\n ") + grammar.gaps[index + 1]
    return replace(
        grammar,
        rules=(*grammar.rules[:index], *grammar.rules[index + 1 :]),
        gaps=(*grammar.gaps[:index], joined, *grammar.gaps[index + 2 :]),
    )
