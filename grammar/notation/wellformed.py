"""Well-formedness of a grammar: rules are defined, productive and not left-recursive."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from grammar.notation.model import (
    Alternative,
    CharSet,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    referred,
    walk,
)

# Reserved words of ANTLR; no rule may have one as its name.
_RESERVED = frozenset(
    "catch channels finally fragment grammar import lexer locals mode options parser "
    "private protected public returns throws tokens".split()
)

#: Characters and sets of all lexer rules, those that a rule refers to counted each time.
_MOST_CHARACTERS = 100_000
#: ``re`` compiles patterns recursively and needs a few frames for each level of nesting.
_MOST_NESTED = 100


def problem(grammar: Grammar) -> str | None:
    """Return the first error of a grammar as ``LINE: text``, or ``None`` if it is well-formed."""
    names = [rule.name for rule in grammar.rules]
    for index, name in enumerate(names):
        if name in names[:index]:
            return f"{_line(grammar, index)}: rule {name} is defined twice"
        if name in _RESERVED:
            return f"{_line(grammar, index)}: ANTLR keeps the word {name} for itself"
    if all(rule.is_lexer for rule in grammar.rules):
        return "1: no parser rule"
    for index, rule in enumerate(grammar.rules):
        for element in walk(rule):
            wrong = _problem(grammar, rule, element)
            if wrong:
                return f"{_line(grammar, index, element.span[0])}: rule {rule.name}: {wrong}"
    lengths = _lengths(grammar.rules)
    cycle = _left_recursion(grammar, lengths)
    if cycle:
        what = "recursive tokens" if cycle[0][0].isupper() else "left recursion"
        line = _line(grammar, names.index(cycle[0]))
        return f"{line}: {what} through {' → '.join(cycle)}"
    deep = _too_deep(grammar)
    if deep:
        line = _line(grammar, names.index(deep))
        return f"{line}: tokens within {deep} are nested more than {_MOST_NESTED} deep"
    large = _too_large(grammar)
    if large:
        line = _line(grammar, names.index(large))
        return f"{line}: {large} and what it refers to: more than {_MOST_CHARACTERS:,} characters"
    endless = next((name for name in names if math.isinf(lengths[name])), None)
    if endless is None:
        return None
    line = _line(grammar, names.index(endless))
    return f"{line}: rule {endless} has no end: every alternative needs it again"


def misuse(grammar: Grammar) -> str | None:
    """Return what nobody writes on purpose in a well-formed grammar, as ``LINE: text``.

    It is read in endless ways, or never. ANTLR refuses the first and warns of a text that two
    tokens have. Returns ``None`` if there is nothing of the kind.
    """
    return next(_misuses(grammar), None)


def _misuses(grammar: Grammar) -> Iterator[str]:
    lengths = _lengths(grammar.rules)
    has_end = False
    for index, rule in enumerate(grammar.rules):
        elements = list(walk(rule))
        for element in elements:
            match element:
                case Reference(name="EOF"):
                    has_end = True
                case Repeat(item=item, operator="*" | "+") if not (
                    rule.is_lexer or shortest_length(item, lengths)
                ):
                    what = f"{rule.source_of(element)} repeats what may be empty"
                    yield f"{_line(grammar, index, element.span[0])}: rule {rule.name}: {what}"
        match elements:
            case [Literal(text=text)] if rule.is_lexer and not rule.is_fragment:
                first = grammar.literal_tokens.get(grammar.fold(text), rule.name)
                if first != rule.name:
                    what = f"token {rule.name} is never read: {first} has the same text"
                    yield f"{_line(grammar, index)}: {what}"
    if not has_end:
        line = _line(grammar, grammar.rules.index(grammar.by_name[grammar.start]))
        yield f"{line}: no rule reads EOF, so no file can be read to its end"


def _too_deep(grammar: Grammar) -> str | None:
    """Return the name of a lexer rule that is nested too deeply, or ``None``."""
    tokens = [rule for rule in grammar.rules if rule.is_lexer]
    refers = {rule.name: referred(rule) for rule in tokens}
    depths: dict[str, int] = {}
    for name in TopologicalSorter(refers).static_order():
        brackets = max(map(_brackets, grammar.by_name[name].alternatives))
        depths[name] = 1 + brackets + max(map(depths.__getitem__, refers[name]), default=0)
        if depths[name] > _MOST_NESTED:
            return name
    return None


def _too_large(grammar: Grammar) -> str | None:
    """Return the name of the first lexer rule with which the rules are too large, or ``None``.

    Rules are not recursive.
    """
    sizes: dict[str, int] = {}

    def size(name: str) -> int:
        if name not in sizes:
            sizes[name] = sum(
                len(element.text)
                if isinstance(element, Literal)
                else len(element.ranges)
                if isinstance(element, CharSet)
                else size(element.name)
                for element in walk(grammar.by_name[name])
                if isinstance(element, Literal | CharSet | Reference)
            )
        return sizes[name]

    total = 0
    for rule in grammar.rules:
        if rule.is_lexer and not rule.is_fragment:
            total += size(rule.name)
            if total > _MOST_CHARACTERS:
                return rule.name
    return None


def _brackets(alternative: Alternative) -> int:
    """Return how deeply parentheses and repetitions are nested."""
    inner = (
        max(map(_brackets, element.alternatives))
        if isinstance(element, Group)
        else _brackets(Alternative((element.item,), None, element.span))
        for element in alternative.elements
        if isinstance(element, Group | Repeat)
    )
    return max((1 + depth for depth in inner), default=0)


def _line(grammar: Grammar, index: int, offset: int = 0) -> int:
    """Return the line on which a rule begins, or on which ``offset`` in its text lies."""
    pairs = zip(grammar.gaps[: index + 1], grammar.rules[: index + 1], strict=True)
    ahead = sum(gap.count("\n") + rule.text.count("\n") for gap, rule in pairs)
    return 1 + ahead - grammar.rules[index].text.count("\n", offset)


def _problem(grammar: Grammar, rule: Rule, element: Element) -> str | None:
    match element:
        case Reference(name=name):
            if name == "EOF":
                return None if not rule.is_lexer else "EOF in a lexer rule"
            target = grammar.by_name.get(name)
            if target is None:
                return f"{name} is not defined"
            if not rule.is_lexer and target.is_fragment:
                return f"{name} is a fragment, not a token"
            if rule.is_lexer and not target.is_lexer:
                return f"{name} is a parser rule"
        case Literal(text=text) if not rule.is_lexer:
            if grammar.fold(text) not in grammar.literal_tokens:
                return f"no token is defined as {text!r}"
        case CharSet() if not rule.is_lexer:
            return "a set of characters in a parser rule"
    return None


def _left_recursion(grammar: Grammar, lengths: Mapping[str, float]) -> list[str] | None:
    """Return the rules on a left-recursive cycle, the first repeated at the end, or ``None``.

    ``lengths`` are those of `_lengths`. Lexer rules may not be recursive at all.
    """

    def leading(elements: tuple[Element, ...]) -> Iterator[str]:
        for element in elements:
            match element:
                case Reference(name=name):
                    yield name
                case Group(alternatives=alternatives):
                    for alternative in alternatives:
                        yield from leading(alternative.elements)
                case Repeat(item=item):
                    yield from leading((item,))
            if shortest_length(element, lengths):
                return

    edges = {
        rule.name: {
            name
            for a in rule.alternatives
            for name in (referred(a) if rule.is_lexer else leading(a.elements))
        }
        for rule in grammar.rules
    }
    return _cycle(edges)


def _cycle(edges: Mapping[str, set[str]]) -> list[str] | None:
    """Return a cycle in the graph ``edges``, its first name repeated at its end, or ``None``."""
    try:
        TopologicalSorter(edges).prepare()
    except CycleError as error:
        cycle: list[str] = error.args[1][:0:-1]
        first = cycle.index(min(cycle, key=list(edges).index))
        return [*cycle[first:], *cycle[: first + 1]]
    return None


def shortest_lengths(grammar: Grammar) -> Mapping[str, float]:
    """Return the length in tokens of the shortest sentence of each parser rule.

    It is infinite if the rule has no finite sentence.
    """
    return _lengths(grammar.parser_rules)


def _lengths(rules: Iterable[Rule]) -> Mapping[str, float]:
    """Return the shortest length of each rule, in tokens or characters.

    Rules that are not among ``rules`` count as one token.
    """
    rules = tuple(rules)[::-1]  # most rules refer to later ones
    lengths: dict[str, float] = dict.fromkeys((rule.name for rule in rules), math.inf)
    changed = True
    while changed:
        changed = False
        for rule in rules:
            length = min(
                sum(shortest_length(e, lengths) for e in a.elements) for a in rule.alternatives
            )
            if length < lengths[rule.name]:
                lengths[rule.name] = length
                changed = True
    return lengths


def shortest_length(element: Element, lengths: Mapping[str, float]) -> float:
    """Return the number of tokens in the shortest text of an element, given those of the rules."""
    match element:
        case Reference(name=name):
            return lengths[name] if name in lengths else float(name != "EOF")
        case Group(alternatives=alternatives):
            return min(sum(shortest_length(e, lengths) for e in a.elements) for a in alternatives)
        case Repeat(item=item, operator=operator):
            return shortest_length(item, lengths) if operator == "+" else 0
        case _:
            return 1
