"""How many tokens a decision needs, and which ones leave it open."""

import pytest

from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from recovery.ledger.lookahead import Decision, decisions, share_decided

TOKENS = "X : 'x' ; Y : 'y' ; Z : 'z' ; COMMA : ',' ;"


def of(rules: str) -> tuple[Decision, ...]:
    return decisions(read(f"grammar T;\n{rules}\n{TOKENS}\n"))


def needed(rules: str) -> list[int]:
    return [decision.tokens for decision in of(rules)]


@pytest.mark.parametrize(
    ("rules", "tokens"),
    [
        ("s : X | Y ;", [1]),
        ("s : X Y | X Z ;", [2]),
        ("s : X X Y | X X Z ;", [3]),
        ("s : X | X ;", [3]),
        ("s : X? Y ;", [1]),
        ("s : X? X Y ;", [2]),
        ("s : X* Y ;", [1]),
        ("s : (X Y)* X Z ;", [2]),
        ("s : X+ ;", [1]),
        ("s : X+ X ;", [2]),
        ("s : (X Y)+ X ;", [2]),
        ("s : (X | Y)? Z ;", [1, 1]),
        ("s : X Y Z ;", []),
        ("s : X | ;", [1]),
    ],
)
def test_tokens_needed(rules: str, tokens: list[int]) -> None:
    """Alternatives, optional and repeated parts, in the order in which they are written."""
    assert tokens == needed(rules)


def test_what_follows_a_rule_counts_wherever_it_is_used() -> None:
    """``a`` need not look ahead in ``a Y``, but it has to in ``a X``."""
    assert 1 == of("s : a Y EOF ; a : Z X? ;")[0].tokens
    assert 2 == next(d for d in of("s : a Y | Y a X Z ; a : Z X? ;") if d.rule == "a").tokens


def test_a_call_returns_to_where_it_was_made() -> None:
    """Both branches call x; what follows x in the other branch does not blur them."""
    assert [2] == needed("s : p Y | r ; p : x ; r : x Z ; x : X ;")


def test_the_end_of_a_program_is_a_token() -> None:
    """Nothing more, or one more comma."""
    assert [1] == needed("s : X (',' X)* EOF ;")


def test_a_decision_that_two_tokens_take_names_the_one_they_share() -> None:
    """People read the text of a token where it has only one."""
    (decision,) = of("s : X ',' Y | X ',' ',' | Z ;")
    assert 3 == decision.tokens
    assert "s: “X ',' Y” and “X ',' ','” can begin alike, with x ," == decision.in_words


def test_a_decision_on_one_token_has_nothing_to_tell() -> None:
    """No branches, no tokens."""
    (decision,) = of("s : X | Y ;")
    assert ((), (), "s: one token decides") == (
        decision.branches,
        decision.alike,
        decision.in_words,
    )


def test_shares_are_per_cent_of_all_decisions() -> None:
    """One of three needs one token, two of three at most two."""
    found = of("s : (X | Y) (X Y | X Z) (X | X) ;")
    assert [33, 66, 100] == [int(share_decided(found, n)) for n in (1, 2, 3)]
    assert 100 == share_decided((), 1)


def test_the_start_of_krl() -> None:
    """Only the line end before a further routine takes more than two tokens."""
    found = decisions(read_file(GRAMMAR.with_name("preliminary.g4")))
    assert ["program"] == [decision.rule for decision in found if decision.tokens > 2]
    assert "NEWLINE NEWLINE" in next(d for d in found if d.rule == "program").in_words
