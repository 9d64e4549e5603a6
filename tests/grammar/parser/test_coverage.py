"""Coverage: what trees exercise of a grammar, counted by hand and by a slow plain reading."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from random import Random

import pytest

from grammar.notation.addresses import Address
from grammar.notation.g4 import read
from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    walk,
)
from grammar.notation.wellformed import shortest_length, shortest_lengths
from grammar.parser import coverage as measuring
from grammar.parser.coverage import Branch, GrammarCoverage, Share, branches
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from grammar.parser.tree import ParseNode, Tree

WORDS = "".join(f"{word} : '{word}' ;\n" for word in "ABCDE") + "COMMA : ',' ;\n"
SPACE = "SPACE : ' ' -> skip ;\n"


def grammar_of(*rules: str) -> Grammar:
    return read("grammar T;\n" + "".join(f"{rule} ;\n" for rule in rules) + WORDS + SPACE)


def covered_by(
    grammar: Grammar, texts: Iterable[str], words: Sequence[str] = ()
) -> GrammarCoverage:
    parser = Parser(Recognizer(grammar))
    coverage = GrammarCoverage(grammar, words)
    for text in texts:
        tree = parser.parse(text)
        assert isinstance(tree, Tree), text
        coverage.add(tree)
    return coverage


def missing(rules: Sequence[str], texts: Iterable[str]) -> list[str]:
    coverage = covered_by(grammar_of(*rules), texts)
    return [coverage.describe(branch) for branch in coverage.uncovered]


# ------------------------------------------------------------------------------- branches


def test_the_branches_of_a_grammar() -> None:
    """Every alternative at every place of its rule, of every group, and every count of a loop."""
    grammar = grammar_of("s : (x | A)? B+ x (y C)* EOF", "x : A | B C", "y : D")
    assert [
        Branch("s", (1, 1), None, "absent"),
        Branch("s", (1, 1), None, "present"),
        Branch("s", (1, 1), None, 1),
        Branch("s", (1, 1), None, 2),
        Branch("s", (1, 2), None, "one"),
        Branch("s", (1, 2), None, "more"),
        Branch("s", (1, 3), "x", 1),
        Branch("s", (1, 3), "x", 2),
        Branch("s", (1, 4), None, "none"),
        Branch("s", (1, 4), None, "one"),
        Branch("s", (1, 4), None, "more"),
        Branch("s", (1, 1, 1, 1), "x", 1),
        Branch("s", (1, 1, 1, 1), "x", 2),
        Branch("s", (1, 4, 1, 1), "y", 1),
    ] == list(branches(grammar))


@pytest.mark.parametrize(
    ("rules", "texts", "expected"),
    [
        # an alternative has to occur at each place of its rule
        (["s : x C x EOF", "x : A | B"], ["A C A", "B C B"], []),
        (
            ["s : x C x EOF", "x : A | B"],
            ["A C A", "A C B"],
            ["s 1.1: x is never B"],
        ),
        (["s : x EOF | y EOF", "x : A", "y : B C"], ["A"], ["s 2.1: y is never there"]),
        # optional parts and loops
        (["s : A? EOF"], ["A"], ["s 1.1: A? is always there"]),
        (["s : A? EOF"], [""], ["s 1.1: A? is never there"]),
        (["s : A? EOF"], ["", "A"], []),
        (
            ["s : A* B EOF"],
            ["A A B"],
            ["s 1.1: A* is always there", "s 1.1: A* never comes just once"],
        ),
        (["s : A* B EOF"], ["B", "A B"], ["s 1.1: A* never comes more than once"]),
        (["s : A+ EOF"], ["A A A"], ["s 1.1: A+ never comes just once"]),
        (["s : A+ EOF"], ["A"], ["s 1.1: A+ never comes more than once"]),
        # groups, and loops in loops: each time the inner loop is entered counts for itself
        (
            ["s : (A | B C | D) EOF"],
            ["A"],
            ["s 1.1: (A | B C | D) is never B C", "s 1.1: (A | B C | D) is never D"],
        ),
        (["s : (A B*)+ EOF"], ["A A B A B B"], ["s 1.1: (A B*)+ never comes just once"]),
        (["s : (A B*)* EOF"], ["", "A", "A A B A B"], ["s 1.1.1.2: B* never comes more than once"]),
        # an empty alternative
        (["s : x A EOF", "x : B |"], ["B A"], ["s 1.1: x is never empty"]),
        (["s : (B |) A EOF"], ["A"], ["s 1.1: (B |) is never B"]),
    ],
)  # fmt: skip
def test_what_is_missing(rules: Sequence[str], texts: Sequence[str], expected: list[str]) -> None:
    """What no tree takes is named, with its place, in words."""
    assert expected == missing(rules, texts)


def test_shares() -> None:
    """Rules, alternatives and branches are counted, with what was never used in order."""
    grammar = grammar_of("s : x EOF", "x : A | y | z z", "y : B C", "z : C | D E")
    coverage = covered_by(grammar, ["A", "C D E"])
    assert Share(3, 4) == coverage.rules
    assert Share(5, 7) == coverage.alternatives
    assert Share(4, 8) == coverage.branches
    assert 75.0 == coverage.rules.percent
    assert ["y"] == coverage.unused_rules
    assert [("x", 2), ("y", 1)] == coverage.unused_alternatives
    assert 100.0 == Share(0, 0).percent
    group = covered_by(grammar_of("s : (A B)? (C) EOF"), ["A B C"])
    assert Share(1, 2) == group.branches


def test_rules_of_words_count_once() -> None:
    """The alternatives of a rule of words are branches of their own and not of every place."""
    grammar = grammar_of("s : x C x EOF", "x : A | B | D")
    coverage = covered_by(grammar, ["A C B"], ["x"])
    assert Share(4, 5) == coverage.branches
    assert ["x is never D"] == [coverage.describe(branch) for branch in coverage.uncovered]
    assert Share(2, 6) == covered_by(grammar, ["A C B"]).branches
    unused = GrammarCoverage(grammar, ["x"])
    assert [
        "s 1.1: x is never there",
        "s 1.3: x is never there",
        "x is never A",
        "x is never B",
        "x is never D",
    ] == [unused.describe(branch) for branch in unused.uncovered]


def test_the_way_is_the_one_written_first() -> None:
    """Where a rule says the same twice, only the way that ANTLR takes counts."""
    assert ["s 1.1: (A | A) is never A"] == missing(["s : (A | A) EOF"], ["A"])
    assert ["s 1.2: A? is never there"] == missing(["s : A? A? EOF"], ["", "A"])


# ------------------------------------------------------------------- counted independently

#: What is met on a way through a rule: places of symbols, and branches taken.
Met = tuple[tuple[str, Address, int | str], ...]


def through(
    grammar: Grammar, alternatives: Sequence[Alternative], at: Address, symbols: Sequence[str]
) -> Iterator[tuple[Met, Sequence[str]]]:
    """Every way to read a beginning of the symbols, in the order of the text, and what is left."""
    for number, alternative in enumerate(alternatives, 1):
        for met, left in in_row(grammar, alternative.elements, (*at, number), 1, symbols):
            yield (("taken", at, number), *met), left


def in_row(
    grammar: Grammar, elements: Sequence[Element], at: Address, place: int, symbols: Sequence[str]
) -> Iterator[tuple[Met, Sequence[str]]]:
    if not elements:
        yield (), symbols
        return
    for first, middle in at_element(grammar, elements[0], (*at, place), symbols):
        for rest, left in in_row(grammar, elements[1:], at, place + 1, middle):
            yield (*first, *rest), left


def at_element(
    grammar: Grammar, element: Element, at: Address, symbols: Sequence[str]
) -> Iterator[tuple[Met, Sequence[str]]]:
    match element:
        case Reference() | Literal():
            if symbols and symbols[0] == grammar.token_of(element):
                yield (("symbol", at, symbols[0]),), symbols[1:]
        case Group(alternatives=alternatives):
            yield from through(grammar, alternatives, at, symbols)
        case Repeat(item=item, operator=operator):
            for met, rounds, left in in_rounds(grammar, item, operator, at, symbols):
                names = {"?": ("absent", "present"), "*": ("none", "one", "more")}
                name = names.get(operator, ("", "one", "more"))[min(rounds, 2)]
                yield (*met, ("taken", at, name)), left


def in_rounds(
    grammar: Grammar, item: Element, operator: str, at: Address, symbols: Sequence[str]
) -> Iterator[tuple[Met, int, Sequence[str]]]:
    for first, middle in at_element(grammar, item, at, symbols):
        if operator != "?" and len(middle) < len(symbols):
            for rest, rounds, left in in_rounds(grammar, item, "*", at, middle):
                yield (*first, *rest), rounds + 1, left
        else:
            yield first, 1, middle
    if operator != "+":
        yield (), 0, symbols


def first_way(grammar: Grammar, node: ParseNode) -> Met:
    symbols = [c.rule if isinstance(c, ParseNode) else c.kind for c in node.children]
    ways = through(grammar, grammar.by_name[node.rule].alternatives, (), symbols)
    return next(met for met, left in ways if not left)


def taken_in(grammar: Grammar, node: ParseNode) -> set[Branch]:
    """The branches that one node takes."""
    met = first_way(grammar, node)
    taken = {Branch(node.rule, at, None, what) for sign, at, what in met if sign == "taken" and at}
    places = [at for sign, at, _ in met if sign == "symbol"]
    for child, at in zip(node.children, places, strict=True):
        if isinstance(child, ParseNode):
            number = first_way(grammar, child)[0][2]
            taken.add(Branch(node.rule, at, child.rule, number))
    return taken


@pytest.mark.parametrize("seed", range(3))
def test_random_grammars(random_grammar: Callable[[Random], Grammar], seed: int) -> None:
    """The branches covered are those that trying all ways through every node finds."""
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
        expected: set[Branch] = set()
        for text in texts:
            tree = parser.parse(text)
            assert isinstance(tree, Tree)
            for node in tree.root.walk():
                if isinstance(node, ParseNode):
                    expected |= taken_in(grammar, node)
        every = set(branches(grammar))
        found = every - set(covered_by(grammar, texts).uncovered)
        assert expected & every == found, (grammar.text, texts)
        compared += len(found)
    assert compared > 100


def has_empty_rounds(grammar: Grammar) -> bool:
    lengths = shortest_lengths(grammar)
    elements = (e for r in grammar.rules if not r.is_lexer for a in r.alternatives for e in walk(a))
    return any(isinstance(e, Repeat) and shortest_length(e.item, lengths) == 0 for e in elements)


def test_every_alternative_of_the_grammar_in_force(krl: Grammar) -> None:
    """The shortest programs through each part of each rule use every rule and alternative."""
    sentences, speller = Sentences(krl), Speller(krl)
    texts = {speller.text(t) for rule in sentences.reachable for t in sentences.through(rule)}
    coverage = covered_by(krl, sorted(texts))
    assert [] == coverage.unused_rules
    assert [] == coverage.unused_alternatives
    assert 40 < coverage.branches.percent < 100


def test_long_sequences(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sequences of any length are matched, and nothing changes where none is remembered."""
    grammar = grammar_of("s : (x | C)* EOF", "x : A | B")
    texts = ["A C " * 5_000]
    found = covered_by(grammar, texts).uncovered
    assert ["s 1.1: (x | C)* is always there", "s 1.1: (x | C)* never comes just once"] == [
        GrammarCoverage(grammar).describe(branch) for branch in found[:2]
    ]
    for name in ("_LONGEST_REMEMBERED", "_MOST_REMEMBERED"):
        monkeypatch.setattr(measuring, name, 1)
        assert found == covered_by(grammar, texts).uncovered
