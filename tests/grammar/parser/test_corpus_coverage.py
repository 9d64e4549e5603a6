"""The own corpus exercises the whole grammar in force.

What it leaves out is not KRL by the manuals: the grammar lets it in because it is the checker that
refuses it, or because the rule is shared with places where it has a meaning.
"""

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

import pytest

from grammar.notation.model import Grammar
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


def coverage(
    grammar: Grammar, trees: Iterable[Tree], words: Collection[str] = ()
) -> GrammarCoverage:
    found = GrammarCoverage(grammar, words)
    for tree in trees:
        found.add(tree)
    return found


def test_every_rule_and_alternative_occurs(krl: Grammar, trees: list[Tree]) -> None:
    """Every rule is exercised, and every alternative that a valid program can have."""
    found = coverage(krl, trees)
    assert [] == found.unused_rules
    assert NO_PROGRAM_HAS == set(found.unused_alternatives)


@pytest.mark.parametrize("words", [(), NAMES], ids=["every-name", "names-as-one"])
def test_branches_are_covered(krl: Grammar, trees: list[Tree], words: tuple[str, ...]) -> None:
    """At least 95 % of the context-dependent branches are covered, however names are counted."""
    found = coverage(krl, trees, words)
    missing = [found.describe(branch) for branch in found.uncovered]
    assert 95 <= found.branches.percent, missing


def test_corpus_is_as_large_as_it_is_said_to_be(trees: list[Tree]) -> None:
    """There are at least 150 programs and 300 kB of them."""
    assert len(trees) >= 150
    assert sum(len(tree.text) for tree in trees) >= 300_000
