"""Coverage: what trees exercise of a grammar, counted by hand and by a slow plain reading."""

from collections import Counter
from collections.abc import Callable, Iterable
from random import Random

import pytest

from grammar.notation.addresses import Address
from grammar.notation.g4 import read
from grammar.notation.model import Grammar, Repeat, walk
from grammar.notation.wellformed import shortest_length, shortest_lengths
from grammar.parser import coverage as measuring
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from grammar.parser.tree import ParseNode, Tree
from tests.grammar.parser.readings import first_way

WORDS = "".join(f"{word} : '{word}' ;\n" for word in "ABCDE") + "COMMA : ',' ;\n"
SPACE = "SPACE : ' ' -> skip ;\n"

#: Alternatives taken and rounds made, by rule and address.
Counts = tuple[dict[tuple[str, Address], set[int]], dict[tuple[str, Address], set[int]]]


def grammar_of(*rules: str) -> Grammar:
    return read("grammar T;\n" + "".join(f"{rule} ;\n" for rule in rules) + WORDS + SPACE)


def covered_by(grammar: Grammar, texts: Iterable[str]) -> GrammarCoverage:
    parser = Parser(Recognizer(grammar))
    coverage = GrammarCoverage(grammar)
    for text in texts:
        tree = parser.parse(text)
        assert isinstance(tree, Tree), text
        coverage.add(tree)
    return coverage


def counts(coverage: GrammarCoverage) -> Counts:
    choices = {place: set(found) for place, found in coverage.choices.items()}
    return choices, {place: set(found) for place, found in coverage.rounds.items()}


def test_unused_alternatives() -> None:
    """What no tree takes is named in the order of the grammar; of two ways the first counts."""
    grammar = grammar_of("s : x EOF", "x : A | y | z z | A", "y : B C", "z : C | D E |")
    assert [("x", 2), ("x", 4), ("y", 1), ("z", 3)] == (
        covered_by(grammar, ["A", "C D E"]).unused_alternatives
    )


# ------------------------------------------------------------------- counted independently


def note(grammar: Grammar, node: ParseNode, found: Counts) -> None:
    """Enter what one node takes."""
    choices, rounds = found
    met = first_way(grammar, node)
    for sign, at, number in met:
        if sign != "symbol":
            into = rounds if sign == "rounds" else choices
            into.setdefault((node.rule, at), set()).add(number)
    places = [at for sign, at, _ in met if sign == "symbol"]
    for child, at in zip(node.children, places, strict=True):
        if isinstance(child, ParseNode):
            number = first_way(grammar, child)[0][2]
            choices.setdefault((node.rule, at), set()).add(number)


@pytest.mark.parametrize("seed", range(3))
def test_random_grammars(random_grammar: Callable[[Random], Grammar], seed: int) -> None:
    """What is counted is what trying all ways through every node finds."""
    chance = Random(seed)
    compared = 0
    for _ in range(40):
        grammar = random_grammar(chance)
        if has_empty_rounds(grammar):
            continue
        sentences = Sentences(grammar)
        rows = [sentences.random(chance, chance.randint(1, 12)) for _ in range(6)]
        texts = ["".join(row).replace("NEWLINE", "\n") for row in rows if len(row) < 20]
        parser = Parser(Recognizer(grammar))
        expected: Counts = {}, {}
        for text in texts:
            tree = parser.parse(text)
            assert isinstance(tree, Tree)
            for node in tree.root.walk():
                if isinstance(node, ParseNode):
                    note(grammar, node, expected)
        assert expected == counts(covered_by(grammar, texts)), (grammar.text, texts)
        compared += len(expected[0])
    assert compared > 100


def has_empty_rounds(grammar: Grammar) -> bool:
    lengths = shortest_lengths(grammar)
    elements = (e for r in grammar.parser_rules for e in walk(r))
    return any(isinstance(e, Repeat) and shortest_length(e.item, lengths) == 0 for e in elements)


def test_every_alternative_of_the_grammar_in_force(krl: Grammar) -> None:
    """The shortest programs through each part of each rule use every alternative."""
    sentences, speller = Sentences(krl), Speller(krl)
    texts = {speller.text(t) for rule in sentences.reachable for t in sentences.through(rule)}
    assert [] == covered_by(krl, sorted(texts)).unused_alternatives


def test_long_sequences(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sequences of any length are matched, and nothing changes where none is remembered."""
    grammar = grammar_of("s : (x | C)* EOF", "x : A | B")
    texts = ["A C " * 5_000]
    found = covered_by(grammar, texts)
    assert Counter({10_000: 1}) == found.rounds["s", (1, 1)]
    for name in ("_LONGEST_REMEMBERED", "_MOST_REMEMBERED"):
        monkeypatch.setattr(measuring, name, 1)
        assert counts(found) == counts(covered_by(grammar, texts))
