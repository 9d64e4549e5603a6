"""The measure of the tool itself: take something out of a grammar and see whether it is found.

There is no official grammar to compare with. So a grammar that reads a corpus is damaged on
purpose, a rule, an alternative, an optional part or a keyword at a time, and the survey of the same
corpus has to lead back: notice it, name the rule, name the place, propose an edit that restores it.
"""

from __future__ import annotations

import random
import statistics
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from grammar.edits import (
    AddAlternative,
    Address,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    RemoveElement,
    RemoveRule,
    Widen,
    apply,
    describe,
    sequences,
)
from grammar.g4 import Grammar, GrammarError, Literal, Reference, Repeat, read
from grammar.model import walk
from grammar.lexer import lexer_of
from grammar.recognizer import Recognizer
from grammar.sentences import Sentences, Speller
from recovery.causes import Judge
from recovery.cluster import Clusters, cluster
from recovery.progress import Progress, unheard
from recovery.reduce import Reducer
from recovery.survey import survey_texts
from recovery.swallowed import suspects
from recovery.trial import edited

__all__ = ["Mutant", "Verdict", "assess", "bench", "combined", "mutants"]

_CLUSTERS_LOOKED_AT = 5


@dataclass(frozen=True, slots=True)
class Mutant:
    """A damaged grammar: what was taken out, and of which rules (by their names)."""

    kind: str
    edits: tuple[Edit, ...]
    rules: frozenset[str]
    grammar: Grammar

    @property
    def keywords(self) -> frozenset[str]:
        """Keywords it no longer knows."""
        return frozenset(
            e.rule for e in self.edits if isinstance(e, RemoveRule) and e.rule[0].isupper()
        )

    def title(self, whole: Grammar) -> str:
        """What was taken out, for a person."""
        return f"{self.kind}: " + "; ".join(describe(whole, e) for e in self.edits[:2])


@dataclass(frozen=True, slots=True)
class Verdict:
    """How the tool did on one mutant; see `assess` for what each field means."""

    mutant: Mutant
    detected: bool
    rule_rank: int | None
    item_rank: int | None
    repair_rank: int | None
    clusters: int
    false_accepts: int
    reproducer_tokens: tuple[int, ...]
    seconds: float


# ------------------------------------------------------------------------------ making mutants


def mutants(grammar: Grammar) -> Iterator[Mutant]:
    """Every grammar with one thing taken out of its parser rules that still is a grammar."""
    for rule in grammar.rules:
        if rule.is_lexer:
            continue
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
) -> Iterator[Mutant]:
    if edits is None:
        return
    try:
        damaged = read(apply(grammar, edits).text)
    except GrammarError:
        return
    yield Mutant(kind, tuple(edits), frozenset(rules), damaged)


def _users(grammar: Grammar, name: str) -> list[tuple[str, tuple[int, ...], int]]:
    """Where a rule or token is used: (rule, address of the sequence, place in it), last first."""
    found = []
    for rule in grammar.rules:
        if rule.is_lexer:
            continue
        for address, alternative in sequences(rule):
            for place, element in enumerate(alternative.elements, 1):
                inner = element.item if isinstance(element, Repeat) else element
                if isinstance(inner, Reference) and inner.name == name:
                    found.append((rule.name, address, place))
    return found[::-1]


def _removals(grammar: Grammar, name: str) -> list[Edit] | None:
    """Edits that take out every alternative or optional part that needs a rule or token."""
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


def _sequence(grammar: Grammar, rule: str, address: tuple[int, ...]) -> tuple[Any, ...]:
    return dict(sequences(grammar.by_name[rule]))[address].elements


def _optional_around(
    grammar: Grammar, rule: str, address: tuple[int, ...]
) -> tuple[int, ...] | None:
    """The innermost optional group that holds a sequence."""
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


def _without_keywords(grammar: Grammar) -> Iterator[Mutant]:
    """Grammars that do not know a keyword: it reads as a name, and what needs it is gone."""
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


def combined(singles: Sequence[Mutant], grammar: Grammar, count: int, seed: int) -> list[Mutant]:
    """Mutants with two or three things taken out, of different rules."""
    chance = random.Random(seed)
    out: list[Mutant] = []
    for _ in range(count * 20):
        if len(out) >= count:
            break
        chosen = chance.sample(list(singles), chance.choice((2, 3)))
        rules = [r for m in chosen for e in m.edits for r in [getattr(e, "rule", "")]]
        if len(set(rules)) < len(rules):
            continue
        edits = [e for m in chosen for e in m.edits]
        names = frozenset[str]().union(*(m.rules for m in chosen))
        out += _made(f"{len(chosen)} parts", grammar, edits, set(names))
    return out


# ------------------------------------------------------------------------------ judging the tool


def assess(
    mutant: Mutant,
    whole: Grammar,
    shown: Sequence[tuple[str, str]],
    held_out: Sequence[str],
    judge: Callable[[Grammar], Judge],
    negatives: Callable[[Recognizer], int],
) -> Verdict:
    """Survey ``shown`` (path, text) under the mutant and see how the tool does.

    - detected: some program that ``whole`` reads fails, or the lost keyword is suspected
      (`recovery.swallowed`) where it is read as a name.
    - rule_rank, item_rank: the first of the proposals of all clusters, taken in the order of the
      page (every cluster's best first), whose edit is in the right rule, or at the right place.
    - repair_rank: the first after which all of ``shown`` and of ``held_out`` can be read again.
    - false_accepts: negatives the best proposal lets in that ``whole`` rejects.
    """
    began = time.perf_counter()
    found = survey_texts(shown, mutant.grammar)
    failing = [f for f in found.files if f.failures]
    if not failing:
        swallowed = suspects((("", text) for _, text in shown), lexer_of(mutant.grammar))
        noticed = any(s.word in mutant.keywords for s in swallowed)
        seconds = time.perf_counter() - began
        return Verdict(mutant, noticed, None, None, None, int(noticed), 0, (), seconds)
    }
    place = getattr(edits[-1], "rule", "")
    return place in damaged or (mutant.kind in ("rule", "keyword") and place in callers)


def _same_place(edits: Sequence[Edit], mutant: Mutant) -> bool:
    """Whether an edit is where something was taken out: same rule, same place in it.

    A taken alternative comes back as an alternative of that rule; a taken part between the
    elements it stood between.
    """
    edit = edits[-1]
    for removed in mutant.edits:
        if isinstance(removed, RemoveAlternative):
            if isinstance(edit, AddAlternative | Widen | Insert | MakeOptional) and (
                edit.rule == removed.rule
            ):
                return True
        elif (
            isinstance(removed, RemoveElement)
            and isinstance(edit, Insert | Widen)
            and edit.rule == removed.rule
            and _adjacent(edit.at, removed.at)
        ):
            return True
    return False


def _adjacent(here: Address, there: Address) -> bool:
    """Whether two places are in the same sequence with at most one element between them."""
    depth = len(there) - 1
    return (
        len(here) > depth and here[:depth] == there[:depth] and abs(here[depth] - there[depth]) <= 1
    )


def _repairs(base: Recognizer, edits: Sequence[Edit], texts: Sequence[str]) -> bool:
    """Whether every program can be read again."""
    wider = edited(base, edits)
    return wider is not None and all(map(wider.accepts, texts))


# ------------------------------------------------------------------------------------ the bench


def covering(grammar: Grammar) -> list[str]:
    """The shortest programs through every alternative and every optional part of every rule."""
    recognizer = Recognizer(grammar)
    sentences, speller = Sentences(grammar), Speller(grammar)
    texts = {
        speller.text(sentence)
        for rule in sentences.reachable
        for sentence in sentences.through(rule)
    }
    return sorted(text for text in texts if recognizer.accepts(text))


def bench(
    grammar: Grammar,
    shown: Sequence[tuple[str, str]],
    held_out: Sequence[str],
    chosen: Sequence[Mutant],
    judge: Callable[[Grammar], Judge],
    negatives: Callable[[Recognizer], int],
    negative_count: int,
    on_done: Progress = unheard,
) -> dict[str, Any]:
    """Assess mutants and gather the figures; see `assess`."""
    verdicts = []
    for mutant in chosen:
        verdicts.append(assess(mutant, grammar, shown, held_out, judge, negatives))
        on_done(1)
    return {
        **figures(verdicts, negative_count),
        "by_kind": {
            kind: figures([v for v in verdicts if v.mutant.kind == kind], negative_count)
            for kind in sorted({v.mutant.kind for v in verdicts})
        },
        "missed": [
            {
                "mutant": v.mutant.title(grammar),
                "rule_rank": v.rule_rank,
                "item_rank": v.item_rank,
                "repair_rank": v.repair_rank,
                "clusters": v.clusters,
            }
            for v in verdicts
            if not v.detected or v.repair_rank != 1
        ],
    }


def figures(verdicts: Sequence[Verdict], negative_count: int) -> dict[str, Any]:
    """The figures of a set of verdicts."""
    total = len(verdicts)
    seen = [v for v in verdicts if v.detected]
    ranks: dict[str, list[int | None]] = defaultdict(list)
    for v in verdicts:
        ranks["rule"].append(v.rule_rank)
        ranks["item"].append(v.item_rank)
        ranks["repair"].append(v.repair_rank)

    def share(name: str, within: int) -> float:
        return round(sum(r is not None and r <= within for r in ranks[name]) / total, 4)

    tokens = [t for v in seen for t in v.reproducer_tokens]
    return {
        "mutants": total,
        "detected": round(len(seen) / total, 4) if total else None,
        **(
            {
                f"{name}_top{n}": share(name, n)
                for name in ("rule", "item", "repair")
                for n in (1, 5)
            }
            if total
            else {}
        ),
        "clusters_per_cause": round(statistics.mean(v.clusters for v in seen), 3) if seen else None,
        "false_accept": round(
            statistics.mean(v.false_accepts / max(1, negative_count) for v in seen), 5
        )
        if seen
        else None,
        "reproducer_median_tokens": statistics.median(tokens) if tokens else None,
        "seconds_per_mutant": round(statistics.mean(v.seconds for v in verdicts), 3)
        if total
        else None,
    }
