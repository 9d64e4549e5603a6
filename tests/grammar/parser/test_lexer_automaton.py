"""Lexer rules become a minimal automaton, and the automaton a pattern for the longest match."""

import re
from itertools import pairwise
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar, GrammarError, normalised_ranges
from grammar.parser import lexer_automaton
from grammar.parser.lexer_automaton import (
    CharAutomaton,
    automaton_of,
    both_cases,
    pattern_of,
)

RANGES = st.lists(
    st.tuples(st.integers(0, 400), st.integers(0, 60)).map(lambda p: (p[0], p[0] + p[1])),
    min_size=1,
    max_size=5,
)


def lexer_grammar(rules: str, *, folded: bool = False) -> Grammar:
    options = "options { caseInsensitive = true; }\n" if folded else ""
    return read(f"grammar T;\n{options}s : EOF ;\n{rules}\n")


def automaton(rules: str, *, folded: bool = False) -> CharAutomaton:
    grammar = lexer_grammar(rules, folded=folded)
    return automaton_of(grammar, [r for r in grammar.rules if r.is_lexer and not r.is_fragment])


def members(ranges: tuple[tuple[int, int], ...] | list[tuple[int, int]]) -> set[int]:
    return {code for low, high in ranges for code in range(low, high + 1)}


# -------------------------------------------------------------------- sets of characters


@given(RANGES)
def test_normalised_ranges(ranges: list[tuple[int, int]]) -> None:
    """Normalising keeps the characters and leaves sorted ranges that do not touch."""
    result = normalised_ranges(ranges)
    assert members(ranges) == members(result)
    assert all(high + 1 < low for (_, high), (low, _) in pairwise(result))
    assert result == normalised_ranges(list(reversed(ranges)))


@given(RANGES)
def test_both_cases_of_ascii_only(ranges: list[tuple[int, int]]) -> None:
    """The other case of A-Z and a-z is added and nothing else: é, ſ and the Kelvin sign stay."""
    letters = {c for c in members(ranges) if chr(c).isascii() and chr(c).isalpha()}
    expected = members(ranges) | {ord(chr(c).swapcase()) for c in letters}
    assert expected == members(both_cases(ranges))


# -------------------------------------------------------------------------- the automaton


@pytest.mark.parametrize(
    ("rules", "states"),
    [
        ("A : 'x' ;", 2),
        ("A : 'x' | 'y' ;", 2),
        ("A : [0-9]+ ;", 2),
        ("A : 'ab' | 'cb' ;", 3),
        ("A : 'ab' ; B : 'cb' ;", 3),
        ("A : [0-9]+ ; B : [0-9]+ '.' [0-9]+ ;", 4),
        ("A : ('a' 'b')* 'a' ;", 2),
        ("A : 'a'? 'b' | 'a'+ 'b' ;", 2),
    ],
)
def test_the_automaton_is_minimal(rules: str, states: int) -> None:
    """No two states of the automaton accept the same continuations."""
    assert states == len(automaton(rules).edges)


# ---------------------------------------------------------------------------- the pattern


def test_a_cycle_of_several_states_has_no_pattern() -> None:
    """A loop over one state is a pattern's loop; a longer cycle has no pattern of its own."""
    assert pattern_of(automaton("A : 'a' [b-d]* 'e' ;")) is not None
    assert pattern_of(automaton("A : '\"' (~[\"] | '\"\"')* '\"' ;")) is None
    assert pattern_of(automaton("A : ('a' 'b')+ ;")) is None


def random_rules(chance: Random) -> str:
    """Lexer rules over few letters, so that they overlap, none matching the empty text."""

    def element(depth: int) -> str:
        kind = chance.choice("csgr" if depth else "cs")
        if kind == "c":
            return f"'{chance.choice('abc')}'"
        if kind == "s":
            return chance.choice(["[ab]", "[bc]", "~[a]", "'aa'", "'bc'", "."])
        if kind == "g":
            inner = (sequence(depth - 1) for _ in range(chance.randint(1, 2)))
            return f"({' | '.join(inner)})"
        return f"({sequence(depth - 1)}){chance.choice('?*+')}"

    def sequence(depth: int) -> str:
        return " ".join(element(depth) for _ in range(chance.randint(1, 3)))

    rules = (
        f"T{n} : '{chance.choice('abc')}' {sequence(2)} ;" for n in range(chance.randint(1, 4))
    )
    return "\n".join(rules)


@given(st.randoms(use_true_random=True))
def test_the_pattern_matches_what_the_automaton_does(chance: Random) -> None:
    """Where there is a pattern, its match is the automaton's longest match at every place."""
    found = automaton(random_rules(chance))
    pattern = pattern_of(found)
    if pattern is None:
        return
    compiled = re.compile(pattern)
    text = "".join(chance.choice("aabbccd") for _ in range(30))
    for start in range(len(text)):
        match = compiled.match(text, start)
        assert (match.end() if match else start) == found.longest(text, start)


@pytest.mark.parametrize("name", ["KRL.g4", "preliminary.g4"])
def test_own_grammars_are_cut_at_the_speed_of_re(name: str) -> None:
    """The project's grammars have a pattern: the slow way is for other people's grammars."""
    grammar = read(GRAMMAR.with_name(name).read_text(encoding="utf-8"))
    rules = [r for r in grammar.rules if r.is_lexer and not r.is_fragment]
    others = [r for r in rules if r.name not in grammar.literal_tokens.values()]
    assert pattern_of(automaton_of(grammar, others)) is not None


# -------------------------------------------------------------------- grammars of strangers


@pytest.mark.parametrize(
    "rule",
    ["A : 'a' " + "'x'? " * 300 + ";", "A : [ab]* 'a' " + "[ab] " * 40 + ";"],
    ids=["optional", "place from the end"],
)
def test_too_many_states_are_refused(rule: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rules whose automaton would take hours are an error after so much work."""
    monkeypatch.setattr(lexer_automaton, "_MOST_WORK", 20_000)
    with pytest.raises(GrammarError, match="lexer rule A: the automaton has too many states"):
        automaton(rule)


def test_a_long_literal_is_no_work() -> None:
    """Ten thousand characters have as many states and one more."""
    assert 10_001 == len(automaton(f"A : '{'x' * 10_000}' ;").edges)


def test_a_pattern_that_repeats_itself_is_left_out() -> None:
    """Where paths meet, the pattern would say what follows once for each of them."""
    forks = [f"A : {fork * number} ;" for fork in ("('a' 'b' | 'c' 'd') ",) for number in (5, 60)]
    assert [True, False] == [pattern_of(automaton(rule)) is not None for rule in forks]
