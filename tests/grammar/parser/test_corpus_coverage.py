"""The own corpus exercises the whole grammar in force.

What it leaves out is not KRL by the manuals: the grammar lets it in because it is the checker that
refuses it, or because the rule is shared with places where it has a meaning.
"""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

import pytest

from grammar.notation.addresses import Address, sequences
from grammar.notation.model import Element, Grammar, Group, Reference, Repeat
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Tree

NAMES = ("name", "keyword")
#: Motions that are no splines, which the checker keeps out of spline blocks [SPL-04].
NO_PROGRAM_HAS = {("splineItem", 1)}


@pytest.fixture(scope="module")
def trees(krl_recognizer: Recognizer, corpus: Mapping[Path, str]) -> list[Tree]:
    """The trees of all programs of the own corpus."""
    parser = Parser(krl_recognizer)
    found = []
    for path, text in corpus.items():
        if "programs" in path.parts:
            tree = parser.parse(text)
            assert isinstance(tree, Tree), path
            found.append(tree)
    return found


@pytest.fixture(scope="module")
def coverage(krl: Grammar, trees: list[Tree]) -> GrammarCoverage:
    found = GrammarCoverage(krl)
    for tree in trees:
        found.add(tree)
    return found


def test_every_alternative_occurs(coverage: GrammarCoverage) -> None:
    """Every alternative is exercised that a valid program can have."""
    assert NO_PROGRAM_HAS == set(coverage.unused_alternatives)


def branches(
    grammar: Grammar, coverage: GrammarCoverage, words: Collection[str]
) -> Iterator[tuple[str, Address, int | str, bool]]:
    """Each branch of the grammar with its place, and whether a tree takes it.

    *Context-dependent branch coverage* (Ralf Lämmel, "Grammar Testing", FASE 2001): every
    alternative at every reference to its rule, and no round, one round and several of each loop.
    A reference to a rule of ``words`` is one branch.
    """
    for rule in grammar.parser_rules:
        for address, alternative in sequences(rule):
            for place, element in enumerate(alternative.elements, 1):
                at = (*address, place)
                item: Element = element
                if isinstance(element, Repeat):
                    item = element.item
                    met = {min(often, 2) for often in coverage.rounds[rule.name, at]}
                    for often in {"?": (0, 1), "*": (0, 1, 2), "+": (1, 2)}[element.operator]:
                        yield rule.name, at, f"{often} times", often in met
                numbers = 0
                if isinstance(item, Reference) and not item.is_token:
                    numbers = (
                        1 if item.name in words else len(grammar.by_name[item.name].alternatives)
                    )
                elif isinstance(item, Group) and len(item.alternatives) > 1:
                    numbers = len(item.alternatives)
                taken = coverage.choices[rule.name, at]
                for number in range(1, numbers + 1):
                    yield rule.name, at, number, bool(taken if numbers == 1 else taken[number])


@pytest.mark.parametrize("words", [(), NAMES], ids=["every-name", "names-as-one"])
def test_branches_are_covered(
    krl: Grammar, coverage: GrammarCoverage, words: tuple[str, ...]
) -> None:
    """At least 95 % of the context-dependent branches are covered, however names are counted."""
    found = list(branches(krl, coverage, words))
    missing = [(rule, at, what) for rule, at, what, is_taken in found if not is_taken]
    assert len(missing) <= 0.05 * len(found), missing


def test_corpus_is_as_large_as_it_is_said_to_be(trees: list[Tree]) -> None:
    """There are at least 150 programs and 300 kB of them."""
    assert len(trees) >= 150
    assert sum(len(tree.text) for tree in trees) >= 300_000
