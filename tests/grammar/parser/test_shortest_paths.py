"""Shortest ways lead into any state and from it to the end of a program."""

from collections.abc import Callable
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.network import network_of
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences
from grammar.parser.shortest_paths import Paths

RandomGrammar = Callable[[Random], Grammar]

OWN = {p.stem: Recognizer(read_file(p)) for p in (GRAMMAR, GRAMMAR.with_name("preliminary.g4"))}
MANY = st.randoms(use_true_random=True)


def names(recognizer: Recognizer, kinds: list[int]) -> str:
    return " ".join(recognizer.lexer.names[kind] for kind in kinds)


def sentence_kinds(recognizer: Recognizer, chance: Random, size: int) -> list[int]:
    tokens = [*Sentences(recognizer.grammar).random(chance, size), "EOF"]
    return [recognizer.lexer.kind_of[name] for name in tokens]


@pytest.mark.parametrize("name", OWN)
@given(chance=MANY)
def test_into_a_configuration_and_out_again(name: str, chance: Random) -> None:
    """The prefix leads to a state with that configuration, and its completion ends a program."""
    recognizer = OWN[name]
    paths = Paths(recognizer.network)
    kinds = sentence_kinds(recognizer, chance, 40)
    cut = chance.randint(0, len(kinds) - 1)
    state, _ = recognizer.run(recognizer.start, kinds[:cut])
    completion = paths.completion(recognizer.frames(state))
    assert recognizer.run(state, completion)[1] is None
    assert len(completion) <= len(kinds) - cut
    for frames in recognizer.frames(state):
        prefix = paths.prefix(frames)
        assert len(prefix) <= cut
        there, index = recognizer.run(recognizer.start, prefix)
        assert index is None
        whole = recognizer.restore(recognizer.frames(there))
        assert frames in {(p, *stack.positions()) for p, stack in recognizer.sites(whole)}


@given(chance=MANY)
def test_ways_through_random_grammars(chance: Random, random_grammar: RandomGrammar) -> None:
    """From every state on the way through a program the shortest completion ends one."""
    recognizer = Recognizer(random_grammar(chance))
    paths = Paths(recognizer.network)
    state = recognizer.start
    kinds = sentence_kinds(recognizer, chance, 12)
    for read, kind in enumerate(kinds):
        if len(recognizer.sites(state)) > 300:
            return  # so many readings that no one would write such a grammar
        completion = paths.completion(recognizer.frames(state))
        assert len(completion) <= len(kinds) - read
        assert recognizer.run(state, completion)[1] is None
        after = recognizer.step(state, kind)
        assert after is not None
        state = after


@pytest.mark.parametrize(
    ("text", "completion"),
    [
        ("", "DEFDAT NAME NEWLINE ENDDAT EOF"),
        ("DEF A()\nFOR I=1 TO 9", "NEWLINE ENDFOR NEWLINE END EOF"),
        ("DEF A()\nX=F((A[1", "RBRACKET RPAREN RPAREN NEWLINE END EOF"),
        ("DEF A()\nEND", "EOF"),
    ],
)
def test_the_shortest_completion(recognizer: Recognizer, text: str, completion: str) -> None:
    """What is open is closed, and nothing more is added."""
    kinds = recognizer.kinds(text)[:-1]
    state, index = recognizer.run(recognizer.start, kinds)
    assert index is None
    found = Paths(recognizer.network).completion(recognizer.frames(state))
    assert completion == names(recognizer, found)


def test_the_shortest_prefix(preliminary: Grammar, recognizer: Recognizer) -> None:
    """The way into a rule says no more than what has to stand before it."""
    paths = Paths(network_of(preliminary))
    state, _ = recognizer.run(
        recognizer.start, recognizer.kinds("DEF A()\nY=2\nIF X THEN\nWAIT\n")[:-2]
    )
    (frames,) = recognizer.frames(state)
    found = names(recognizer, paths.prefix(frames)).split()
    assert "DEF NAME LPAREN RPAREN NEWLINE IF".split() == found[:6]
    assert "THEN NEWLINE WAIT".split() == found[7:]
