"""A rule becomes a minimal deterministic automaton, which knows the addresses of its states."""

from collections.abc import ItemsView

import pytest

from grammar.notation.addresses import element_at, sequences
from grammar.notation.g4 import read
from grammar.notation.model import Grammar, Literal, Reference
from grammar.parser.rule_automaton import RuleAutomaton, _minimal, rule_automaton

TOKENS = "A : 'a' ;\nB : 'b' ;\nC : 'c' ;\nCOMMA : ',' ;\nNEWLINE : '\\n' ;\n"


def automaton_of(rule: str) -> RuleAutomaton:
    grammar = read(f"grammar T;\n{rule}\nt : A | B t ;\n{TOKENS}")
    return rule_automaton(grammar, grammar.rules[0])


@pytest.mark.parametrize(
    ("rule", "edges", "final"),
    [
        ("s : A B ;", [{"A": 1}, {"B": 2}, {}], {2}),
        ("s : A | A B ;", [{"A": 1}, {"B": 2}, {}], {1, 2}),
        ("s : A B | t B ;", [{"A": 1, "t": 1}, {"B": 2}, {}], {2}),
        ("s : ;", [{}], {0}),
        ("s : A* ;", [{"A": 0}], {0}),
        ("s : A+ ;", [{"A": 1}, {"A": 1}], {1}),
        ("s : A (',' A)* ;", [{"A": 1}, {"COMMA": 0}], {1}),
        ("s : (A? B?)? ;", [{"A": 1, "B": 2}, {"B": 2}, {}], {0, 1, 2}),
        ("s : ((A | 'b')* 'a')? ;", [{"A": 0, "B": 1}, {"A": 0, "B": 1}], {0}),
    ],
)
def test_a_rule_is_the_smallest_automaton(
    rule: str, edges: list[dict[str, int]], final: set[int]
) -> None:
    """States that read on alike are one, and no state reads one symbol in two ways."""
    automaton = automaton_of(rule)
    assert edges == [dict(e) for e in automaton.edges]
    assert final == automaton.final


def test_where_in_the_rule_a_state_stands() -> None:
    """`places` are the addresses of the elements that may come next, and of ends of sequences."""
    automaton = automaton_of("s : A (B | C t)? A ;")
    assert automaton.places[0] == {(1, 1)}
    assert automaton.places[automaton.edges[0]["A"]] == {(1, 2), (1, 2, 1, 1), (1, 2, 2, 1), (1, 3)}
    after_c = automaton.edges[automaton.edges[0]["A"]]["C"]
    assert automaton.places[after_c] == {(1, 2, 2, 2)}
    after_group = automaton.edges[after_c]["t"]
    assert automaton.places[after_group] == {(1, 2, 1, 2), (1, 2, 2, 3), (1, 3)}
    (last,) = automaton.final
    assert automaton.places[last] == {(1, 4)}


@pytest.mark.parametrize("name", ["krl", "preliminary"])
def test_places_name_what_is_read_there(name: str, request: pytest.FixtureRequest) -> None:
    """A state reads the symbols of the elements at its places, and every place has a state."""
    grammar: Grammar = request.getfixturevalue(name)
    for rule in grammar.parser_rules:
        automaton = rule_automaton(grammar, rule)
        lengths = {at: len(alternative.elements) for at, alternative in sequences(rule)}
        for edges, places in zip(automaton.edges, automaton.places, strict=True):
            elements = [element_at(rule, p) for p in places if p[-1] <= lengths[p[:-1]]]
            symbols = [e for e in elements if isinstance(e, Reference | Literal)]
            assert {grammar.token_of(e) for e in symbols} <= set(edges)
        expected = {(*at, n) for at, size in lengths.items() for n in range(1, size + 2)}
        assert expected == set().union(*automaton.places)


class _Row(dict[str, int]):
    """The edges of a state, which count how often they are looked through."""

    uses = 0

    def items(self) -> ItemsView[str, int]:  # type: ignore[override]
        _Row.uses += 1
        return super().items()


def test_a_long_sequence_is_made_minimal_in_linear_time() -> None:
    """Each state of a chain is looked at a few times, however long the chain is."""
    works = []
    for count in (200, 400):
        table: list[dict[str, int]] = [_Row(A=number + 1) for number in range(count)]
        _Row.uses = 0
        found = _minimal([*table, _Row()], [False] * count + [True], [set()] * (count + 1))
        assert count + 1 == len(found.edges)
        works.append(_Row.uses)
    assert works[1] < 2.2 * works[0]
