"""A text is ambiguous when trees of two shapes have it as their leaves."""

from collections.abc import Callable, Sequence
from functools import cache
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grammar.ambiguity import is_ambiguous
from grammar.g4 import read
from grammar.model import Grammar
from grammar.network import Network
from grammar.recognizer import Recognizer
from grammar.sentences import Sentences

RandomGrammar = Callable[[Random], Grammar]
TOKENS = "A : 'a' ;\nB : 'b' ;\nC : 'c' ;\n"


class EndlessError(Exception):
    """A rule that may be empty repeats itself: no count of its readings ends."""


def readings(network: Network, kinds: Sequence[int]) -> int:
    """How many ways through the network have these tokens, counted straight from its edges."""
    active: set[tuple[int, int]] = set()

    @cache
    def ways(position: int, start: int) -> dict[int, int]:
        """For every end, in how many ways the rest of a rule has the tokens from ``start``."""
        if (position, start) in active:
            raise EndlessError
        active.add((position, start))
        found = {start: 1} if network.final[position] else {}
        if start < len(kinds) and kinds[start] in network.shifts[position]:
            add(found, ways(network.shifts[position][kinds[start]], start + 1), 1)
        for entry, back in network.calls[position]:
            for end, count in ways(entry, start).items():
                add(found, ways(back, end), count)
        active.remove((position, start))
        return found

    def add(found: dict[int, int], more: dict[int, int], times: int) -> None:
        for end, count in more.items():
            found[end] = found.get(end, 0) + times * count

    return ways(network.start, 0).get(len(kinds), 0)


@pytest.mark.parametrize(
    ("rules", "text", "ambiguous"),
    [
        ("s : x EOF ;\nx : A | B x ;", "bba", False),
        ("s : (x | y) EOF ;\nx : A ;\ny : A ;", "a", True),
        ("s : (x | A) EOF ;\nx : A ;", "a", True),
        ("s : x* EOF ;\nx : A | A A ;", "a", False),
        ("s : x* EOF ;\nx : A | A A ;", "aa", True),
        ("s : x (A x)? EOF ;\nx : B x (C x)? | A ;", "ba", False),
        ("s : x EOF ;\nx : B x (C x)? | A ;", "bbaca", True),
        ("s : x y EOF ;\nx : A? ;\ny : A? B ;", "ab", True),
        ("s : x y EOF ;\nx : A? ;\ny : A? B ;", "b", False),
        ("s : (A | A) EOF ;", "a", False),
        ("s : (x | y) EOF ;\nx : A ;\ny : A ;", "b", False),
    ],
)
def test_known_cases(rules: str, text: str, ambiguous: bool) -> None:
    """Two rules, or two places of one, that can have the same tokens make two readings."""
    recognizer = Recognizer(read(f"grammar T;\n{rules}\n{TOKENS}"))
    kinds = recognizer.kinds(text)
    assert ambiguous == (readings(recognizer.network, kinds) > 1)
    assert ambiguous == is_ambiguous(recognizer, recognizer.start, kinds)


@settings(max_examples=150, deadline=None)
@given(chance=st.randoms(use_true_random=True))
def test_two_readings_are_found(chance: Random, random_grammar: RandomGrammar) -> None:
    """A program of a random grammar is ambiguous when counting its readings gives more than one."""
    recognizer = Recognizer(random_grammar(chance))
    tokens = [*Sentences(recognizer.grammar).random(chance, 8), "EOF"]
    kinds = [recognizer.lexer.kind_of[name] for name in tokens]
    state = recognizer.start
    for kind in kinds:
        if len(recognizer.sites(state)) > 300:
            return  # so many readings that no one would write such a grammar
        after = recognizer.step(state, kind)
        assert after is not None
        state = after
    try:
        expected = readings(recognizer.network, kinds) > 1
    except EndlessError:
        return
    assert expected == is_ambiguous(recognizer, recognizer.start, kinds)


def test_own_programs_have_one_reading(preliminary: Grammar, recognizer: Recognizer) -> None:
    """Random programs of the restrictive start have one reading each."""
    sentences, chance = Sentences(preliminary), Random(5)
    for _ in range(40):
        tokens = [*sentences.random(chance, 40), "EOF"]
        kinds = [recognizer.lexer.kind_of[name] for name in tokens]
        assert 1 == readings(recognizer.network, kinds)
        assert not is_ambiguous(recognizer, recognizer.start, kinds)
