"""Damaged grammars, which measure how well the survey finds what is missing.

There is no official grammar to compare with. So a grammar that reads a corpus loses a rule, an
alternative, an optional part or a keyword. The survey of the same corpus has to notice it, name the
rule and the place, and propose an edit that restores it.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from grammar.notation.addresses import sequences
from grammar.notation.edits import (
    Edit,
    RemoveAlternative,
    RemoveElement,
    RemoveRule,
    apply,
    describe,
)
from grammar.notation.g4 import read
from grammar.notation.model import Element, Grammar, GrammarError, Literal, Reference, Repeat


@dataclass(frozen=True, slots=True)
class DamagedGrammar:
    """A damaged grammar: what was taken out, in how many parts, and of which rules."""

    kind: str
    edits: tuple[Edit, ...]
    rules: frozenset[str]
    grammar: Grammar
    parts: int = 1

    @property
    def keywords(self) -> frozenset[str]:
        """Keywords it no longer knows."""
        return frozenset(
            e.rule for e in self.edits if isinstance(e, RemoveRule) and e.rule[0].isupper()
        )

    def title(self, whole: Grammar) -> str:
        """Return what was removed, in words."""
        return f"{self.kind}: " + "; ".join(describe(whole, e) for e in self.edits[:2])


# ------------------------------------------------------------------------------ damaging


def damaged_grammars(grammar: Grammar) -> Iterator[DamagedGrammar]:
    """Yield every grammar with one element removed from its parser rules that is still valid."""
    for rule in grammar.parser_rules:
        if rule.name != grammar.start:
            yield from _made("rule", grammar, _without_rule(grammar, rule.name), {rule.name})
        if len(rule.alternatives) > 1:
            for number in range(1, len(rule.alternatives) + 1):
                yield from _made(
                    "alternative", grammar, [RemoveAlternative(rule.name, number)], {rule.name}
                )
        for address, alternative in sequences(rule):
            for place, element in enumerate(alternative.elements, 1):
                optional = isinstance(element, Repeat) and element.operator != "+"
                if optional and len(alternative.elements) > 1:
                    removal = RemoveElement(rule.name, (*address, place))
                    yield from _made("optional part", grammar, [removal], {rule.name})
    yield from _without_keywords(grammar)


def _made(
    kind: str, grammar: Grammar, edits: Sequence[Edit] | None, rules: set[str]
) -> Iterator[DamagedGrammar]:
    if edits is None:
        return
    try:
        damaged = read(apply(grammar, edits).text)
    except GrammarError:
        return
    yield DamagedGrammar(kind, tuple(edits), frozenset(rules), damaged)


def _users(grammar: Grammar, name: str) -> list[tuple[str, tuple[int, ...], int]]:
    """Return the uses of a rule or token as (rule, sequence, index), last first."""
    found = []
    for rule in grammar.parser_rules:
        for address, alternative in sequences(rule):
            for place, element in enumerate(alternative.elements, 1):
                inner = element.item if isinstance(element, Repeat) else element
                if isinstance(inner, Reference) and inner.name == name:
                    found.append((rule.name, address, place))
    return found[::-1]


def _removals(grammar: Grammar, name: str) -> list[Edit] | None:
    """Return edits that take out every alternative or optional part that needs a rule or token."""
    edits: list[Edit] = []
    gone: set[tuple[str, int]] = set()
    for rule, address, place in _users(grammar, name):
        alternatives = grammar.by_name[rule].alternatives
        element = _sequence(grammar, rule, address)[place - 1]
        if isinstance(element, Repeat) and element.operator != "+":
            edits.append(RemoveElement(rule, (*address, place)))
        elif (rule, address[0]) not in gone:
            optional = _optional_around(grammar, rule, address)
            if optional is not None:
                edits.append(RemoveElement(rule, optional))
            elif len(alternatives) - sum(r == rule for r, _ in gone) > 1:
                gone.add((rule, address[0]))
                edits.append(RemoveAlternative(rule, address[0]))
            else:
                return None
    return edits or None


def _sequence(grammar: Grammar, rule: str, address: tuple[int, ...]) -> tuple[Element, ...]:
    return dict(sequences(grammar.by_name[rule]))[address].elements


def _optional_around(
    grammar: Grammar, rule: str, address: tuple[int, ...]
) -> tuple[int, ...] | None:
    """Return the innermost optional group that contains a sequence."""
    while len(address) > 1:
        *outer, place, _ = address
        element = _sequence(grammar, rule, tuple(outer))[place - 1]
        if isinstance(element, Repeat) and element.operator != "+":
            return (*outer, place)
        address = tuple(outer)
    return None


def _without_rule(grammar: Grammar, name: str) -> list[Edit] | None:
    removals = _removals(grammar, name)
    return None if removals is None else [*removals, RemoveRule(name)]


def _without_keywords(grammar: Grammar) -> Iterator[DamagedGrammar]:
    """Yield grammars that do not know a keyword: it reads as a name, and what needs it is gone."""
    for rule in grammar.rules:
        if not rule.is_lexer or rule.is_fragment or not rule.text.startswith(f"{rule.name} : '"):
            continue
        element = rule.alternatives[0].elements[0]
        if not isinstance(element, Literal) or not element.text.isidentifier():
            continue
        removals = _removals(grammar, rule.name)
        if removals:
            users = {user for user, _, _ in _users(grammar, rule.name)}
            yield from _made("keyword", grammar, [*removals, RemoveRule(rule.name)], users)


def combined(
    singles: Sequence[DamagedGrammar], grammar: Grammar, count: int, seed: int
) -> list[DamagedGrammar]:
    """Return grammars with two or three things taken out, of different rules."""
    chance = random.Random(seed)
    out: list[DamagedGrammar] = []
    for _ in range(count * 20):
        if len(out) >= count:
            break
        chosen = chance.sample(list(singles), chance.choice((2, 3)))
        rules = [r for m in chosen for e in m.edits for r in [getattr(e, "rule", "")]]
        if len(set(rules)) < len(rules):
            continue
        edits = [e for m in chosen for e in m.edits]
        names = frozenset[str]().union(*(m.rules for m in chosen))
        made = _made(f"{len(chosen)} parts", grammar, edits, set(names))
        out += (replace(damaged, parts=len(chosen)) for damaged in made)
    return out


def choose_damaged(
    grammar: Grammar, singles: int, multiple: int, seed: int
) -> list[DamagedGrammar]:
    """All that lack one part, or ``singles`` of them drawn, and ``multiple`` that lack several."""
    every = list(damaged_grammars(grammar))
    drawn = every
    if singles and singles < len(every):
        drawn = random.Random(seed).sample(every, singles)
    return drawn + combined(every, grammar, multiple, seed)
