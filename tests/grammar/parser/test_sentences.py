"""Sentences derived from a grammar are programs of it, and their spelling reads back."""

from collections.abc import Callable, Sequence
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar, Literal, Reference, walk
from grammar.parser import antlr_reference
from grammar.parser.lexer import lexer_of
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller

Parse = Callable[[Grammar, Sequence[str]], tuple[bool, list[frozenset[str]]]]
RandomGrammar = Callable[[Random], Grammar]

OWN = {p.stem: Recognizer(read_file(p)) for p in (GRAMMAR, GRAMMAR.with_name("preliminary.g4"))}
MANY = st.randoms(use_true_random=True)


def is_program(recognizer: Recognizer, tokens: Sequence[str]) -> bool:
    kinds = [recognizer.lexer.kind_of[name] for name in [*tokens, "EOF"]]
    return recognizer.run(recognizer.start, kinds)[1] is None


# ------------------------------------------------------------------------------ derived


@pytest.mark.parametrize("name", OWN)
def test_the_shortest_program_through_every_rule(name: str) -> None:
    """Every rule is reachable; its frame around its shortest sentence is a program."""
    recognizer = OWN[name]
    sentences = Sentences(recognizer.grammar)
    assert set(recognizer.network.entry) == set(sentences.reachable)
    lengths = []
    for rule in sentences.reachable:
        before, after = sentences.frame(rule)
        assert is_program(recognizer, [*before, *sentences.shortest(rule), *after])
        lengths.append(len(before) + len(after))
    assert sorted(lengths) == lengths
    shortest = sentences.shortest(recognizer.grammar.start)
    assert is_program(recognizer, shortest)
    assert len(shortest) == min(
        len(p) for rule in sentences.reachable for p in sentences.through(rule)
    )


def _tokens_in(grammar: Grammar, rule: str) -> set[str]:
    """Names of the tokens that a rule writes itself, quoted or by name."""
    elements = [e for one in grammar.by_name[rule].alternatives for e in walk(one)]
    return {
        grammar.token_of(one)
        for one in elements
        if isinstance(one, Literal) or (isinstance(one, Reference) and one.is_token)
    }


@pytest.mark.parametrize("name", OWN)
def test_programs_through_every_part_of_a_rule(name: str) -> None:
    """Programs through a rule use every token it writes and differ from one another in it."""
    recognizer = OWN[name]
    sentences = Sentences(recognizer.grammar)
    for rule in sentences.reachable:
        programs = list(sentences.through(rule))
        assert len(programs) >= len(recognizer.grammar.by_name[rule].alternatives)
        assert all(is_program(recognizer, program) for program in programs)
        written = {token for program in programs for token in program} | {"EOF"}
        assert _tokens_in(recognizer.grammar, rule) <= written


def test_programs_through_alternatives_and_options() -> None:
    """Each alternative, option and repetition of a rule appears in a program of its own."""
    grammar = read(
        "grammar T;\ns : A r B EOF ;\nr : A (B | C A)? | C* B | ;\n"
        "A : 'a' ;\nB : 'b' ;\nC : 'c' ;\n"
    )
    found = [" ".join(p) for p in Sentences(grammar).through("r")]
    expected = ["A A B", "A A B B", "A A C A B", "A B B", "A C B B", "A C C B B", "A B"]
    assert sorted(expected) == sorted(set(found))


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_random_programs(name: str, chance: Random) -> None:
    """A random program is one, and about as long as was asked."""
    recognizer = OWN[name]
    size = chance.choice([0, 5, 20, 100])
    tokens = Sentences(recognizer.grammar).random(chance, size)
    assert is_program(recognizer, tokens)
    assert len(tokens) < 3 * size + 100


@given(chance=MANY)
def test_random_sentences_of_random_grammars(
    chance: Random, random_grammar: RandomGrammar, parse: Parse
) -> None:
    """A search of all readings finds what was derived, the shortest and the random ones."""
    grammar = random_grammar(chance)
    sentences = Sentences(grammar)
    shortest = sentences.shortest(grammar.start)
    assert parse(grammar, [*shortest, "EOF"])[0]
    for rule in sentences.reachable:
        for program in sentences.through(rule):
            assert len(program) >= len(shortest)
            assert parse(grammar, [*program, "EOF"])[0]
    for _ in range(3):
        assert parse(grammar, [*sentences.random(chance, 10), "EOF"])[0]


def test_random_programs_repeat_by_seed(preliminary: Grammar) -> None:
    """The same seed gives the same programs, another seed others."""
    programs = [
        [Sentences(preliminary).random(chance, 40) for _ in range(20)]
        for chance in (Random(1), Random(1), Random(2))
    ]
    assert programs[0] == programs[1]
    assert programs[0] != programs[2]


# ------------------------------------------------------------------------------- spelled


@pytest.mark.parametrize("name", OWN)
def test_each_token_has_a_spelling(name: str) -> None:
    """The sample of a token is that token to the lexer, every token that is not skipped has one."""
    recognizer = OWN[name]
    samples = Speller(recognizer.grammar).samples
    lexer = recognizer.lexer
    skipped = {r.name for r in recognizer.grammar.rules if r.is_skipped or r.is_fragment}
    assert set(lexer.names[1:]) - skipped == set(samples)
    for token, sample in samples.items():
        assert lexer.kind_of[token] == lexer.kinds[sample], token
        assert sample in lexer.lexemes(sample)


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_spelled_programs_read_back(name: str, chance: Random) -> None:
    """The text of a program has its tokens, and both parsers accept it."""
    recognizer = OWN[name]
    tokens = Sentences(recognizer.grammar).random(chance, 40)
    text = Speller(recognizer.grammar).text(tokens)
    kinds = recognizer.kinds(text)
    assert [*tokens, "EOF"] == [recognizer.lexer.names[kind] for kind in kinds]
    assert recognizer.accepts(text)
    if name == "KRL":
        assert antlr_reference.accepts(text)


def test_a_spelled_program(preliminary: Grammar) -> None:
    """One blank stands between two tokens, none around the end of a line."""
    tokens = "HEADER NEWLINE DEF NAME LPAREN RPAREN NEWLINE NEWLINE END NEWLINE"
    assert "&\nDEF A ( )\n\nEND\n" == Speller(preliminary).text(tokens.split())


def test_a_sample_that_is_no_other_token() -> None:
    """Where the shortest text of a token belongs to an earlier rule, another one is found."""
    grammar = read(
        "grammar T;\noptions { caseInsensitive = true; }\ns : IF NAME REAL ;\n"
        "IF : 'A' ;\nINT : [0-9]+ ;\nNAME : [A-C]+ ;\nREAL : [0-9]+ ('.' [0-9])? ;\n"
    )
    lexer = lexer_of(grammar)
    for token, sample in Speller(grammar).samples.items():
        assert lexer.kind_of[token] == lexer.kinds[sample]
