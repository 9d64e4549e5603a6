"""The automata of rules, linked into one network."""

from collections.abc import Callable
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.edits import AddAlternative, AddToken, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.notation.wellformed import problem
from grammar.parser.lexer import lexer_of
from grammar.parser.network import Network, is_left_recursive, network_of, with_rule
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences

RandomGrammar = Callable[[Random], Grammar]
Mutated = Callable[[list[str], Random, list[str]], list[str]]

#: A position with the positions to return to, the outermost first.
Way = tuple[int, tuple[int, ...]]

MANY = st.randoms(use_true_random=True)
PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))


def accepts(network: Network, tokens: list[str]) -> int | None:
    """Where the recogniser of a network stops."""
    recognizer = Recognizer(PRELIMINARY, network)
    return recognizer.run(recognizer.start, [network.lexer.kind_of[t] for t in tokens])[1]


@pytest.mark.parametrize("name", ["krl", "preliminary"])
def test_positions_are_the_states_of_all_rules(name: str, request: pytest.FixtureRequest) -> None:
    """Each state of each rule's automaton is one position with that state's edges."""
    grammar: Grammar = request.getfixturevalue(name)
    network = network_of(grammar)
    assert grammar.start == network.rule[network.start]
    positions = 0
    for rule, automaton in network.automata.items():
        base = network.entry[rule]
        for state, edges in enumerate(automaton.edges):
            p = base + state
            tokens = {network.lexer.names[k]: to - base for k, to in network.shifts[p].items()}
            calls = {network.rule[entry]: back - base for entry, back in network.calls[p]}
            assert all(network.entry[network.rule[entry]] == entry for entry, _ in network.calls[p])
            assert dict(edges) == tokens | calls
            assert (rule, state in automaton.final) == (network.rule[p], network.final[p])
            positions += 1
    assert positions == len(network.rule)


def surroundings(network: Network, start: int) -> tuple[set[Way], set[tuple[str, Way]], bool]:
    """What `Network.reach` tells, by taking one step after the other."""
    sites: set[Way] = {(start, ())}
    todo = list(sites)
    for position, returns in todo:  # grows while it is walked
        found = [(entry, (*returns, back)) for entry, back in network.calls[position]]
        found += [(returns[-1], returns[:-1])] if network.final[position] and returns else []
        todo += [way for way in found if way not in sites]
        sites |= set(found)
    moves = {
        (network.lexer.names[kind], (target, returns))
        for position, returns in sites
        for kind, target in network.shifts[position].items()
    }
    return sites, moves, any(network.final[p] and not returns for p, returns in sites)


@pytest.mark.parametrize("name", ["krl", "preliminary"])
def test_the_reach_of_every_position(name: str, request: pytest.FixtureRequest) -> None:
    """What is known of a position is what following calls and returns from it leads to."""
    network = network_of(request.getfixturevalue(name))
    for position in range(len(network.rule)):
        check_reach(network, position)


@given(chance=MANY)
def test_the_reach_in_random_grammars(chance: Random, random_grammar: RandomGrammar) -> None:
    """The same where rules are empty, recursive and call one another in every way."""
    network = network_of(random_grammar(chance))
    for position in range(len(network.rule)):
        check_reach(network, position)


def check_reach(network: Network, position: int) -> None:
    sites, moves, ends = surroundings(network, position)
    reach = network.reach(position)
    assert sites == set(reach.sites)
    assert moves == {(network.lexer.names[k], way) for k in reach.first for way in reach[k]}
    assert not any(reach[k] for k in range(len(network.lexer.names)) if k not in reach.first)
    assert ends == reach.ends
    assert reach.rules >= {network.rule[p] for p, _ in sites}


@given(chance=MANY)
def test_positions_that_pass_a_return_on(chance: Random, random_grammar: RandomGrammar) -> None:
    """From these, and from no others, the rule can end and nothing else can be done."""
    network = network_of(random_grammar(chance))
    for position in range(len(network.rule)):
        found = surroundings(network, position)
        assert (({(position, ())}, set(), True) == found) == (position in network.passing())


@given(chance=MANY)
def test_exchanging_one_rule(chance: Random, mutated: Mutated) -> None:
    """A network with one rule exchanged reads like one linked anew; other positions stay."""
    rule = chance.choice(PRELIMINARY.parser_rules)
    text = chance.choice(["STRING", "WAIT NAME?", "'(' expression ')'", "ZZWORD (',' NAME)*"])
    changed = apply(PRELIMINARY, [AddToken("ZZWORD"), AddAlternative(rule.name, text)])
    old = network_of(PRELIMINARY)
    accepts(old, [*Sentences(PRELIMINARY).random(chance, 40), "EOF"])  # old now knows its reach
    lexer = lexer_of(PRELIMINARY).with_keyword("ZZWORD")
    network = with_rule(old, changed, changed.by_name[rule.name], lexer)
    anew = network_of(changed, lexer)
    assert (old.entry, old.start) == (network.entry, network.start)
    for p, name in enumerate(old.rule):
        if name != rule.name:
            assert (old.shifts[p], old.calls[p], name) == (
                network.shifts[p],
                network.calls[p],
                network.rule[p],
            )
    names = [n for n in lexer.names if n not in ("COMMENT", "SPACE")]
    for grammar in (PRELIMINARY, changed):
        tokens = Sentences(grammar).random(chance, 40)
        for some in ([*tokens, "EOF"], [*mutated(tokens, chance, names), "EOF"]):
            assert accepts(anew, some) == accepts(network, some)
    again = with_rule(network, PRELIMINARY, rule, lexer)
    assert accepts(network_of(PRELIMINARY, lexer), some) == accepts(again, some)


# ------------------------------------------------------------------------ left recursion


@given(chance=MANY)
def test_left_recursion_is_found(chance: Random, random_grammar: RandomGrammar) -> None:
    """The network has a left-recursive cycle exactly where reading the grammar finds one."""
    grammar = random_grammar(chance)
    rules = [r.name for r in grammar.parser_rules]
    words = [chance.choice([*rules[1:], "A", f"{rules[-1]}?"]) for _ in range(chance.randint(1, 3))]
    changed = apply(grammar, [AddAlternative(chance.choice(rules), " ".join(words))])
    found = "left recursion" in (problem(changed) or "")
    assert found == is_left_recursive(network_of(changed))
