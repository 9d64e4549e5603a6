"""Every metric is what one counts by hand."""

import pytest

from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from recovery.ledger.metrics import MEANINGS, metrics

TOKENS = "X : 'x' ; Y : 'y' ; COMMA : ',' ; L : '(' ; R : ')' ;"


def of(rules: str) -> dict[str, float]:
    return dict(metrics(read(f"grammar T;\n{rules}\n{TOKENS}\n")))


def test_a_small_grammar_counted_by_hand() -> None:
    """Two levels, three decisions; a and b call each other.

    Symbols: a , a / X b Y / ( a ). Operators: five sequences, *, | and ?. Effort:
    (4/2 × 12/8) × (8 + 12) × log2(4 + 8) = 215.1. Pairs that reach: sa sb ab ba.
    """
    expected = {
        "TERM": 5,
        "VAR": 3,
        "MCC": 3,
        "AVS": 3,
        "HAL": 0.215,
        "TIMP": 50,
        "CLEV": 66.667,
        "NSLEV": 1,
        "DEP": 2,
        "HEI": 2,
        "DEC": 3,
        "LL1": 100,
        "LL2": 100,
    }
    assert expected == of("s : a (',' a)* EOF ; a : X b? | Y ; b : '(' a ')' ;")


@pytest.mark.parametrize(
    ("rules", "impurity", "levels", "height"),
    [
        ("s : X ;", 0, 1, 1),
        ("s : a b ; a : X ; b : Y ;", 0, 3, 2),
        ("s : a ; a : b ; b : X ;", 25, 3, 3),
        ("s : X a | X ; a : Y s | Y ;", 100, 1, 1),
        ("s : X s? ;", 0, 1, 1),
    ],
)
def test_structure(rules: str, impurity: float, levels: int, height: int) -> None:
    """A star is a tree, a chain reaches more, a ring reaches all, and one rule is one level."""
    found = of(rules)
    assert (impurity, levels, height) == (
        found["TIMP"],
        round(found["CLEV"] * found["VAR"] / 100),
        found["HEI"],
    )


def test_levels_of_one_rule_are_no_nslev() -> None:
    """Only rules that reach one another make a level that counts there."""
    found = of("s : a b ; a : X c | X ; c : Y a | Y ; b : L ;")
    assert (1, 2) == (found["NSLEV"], found["DEP"])


def test_quoted_text_and_the_name_of_its_token_are_one_symbol() -> None:
    """``'x'`` is the token X."""
    assert 1 == of("s : X 'x' X ;")["TERM"]


def test_an_empty_alternative_is_an_operator_without_operands() -> None:
    """``|`` and the empty alternative; X and s: (2/2 × 2/2) × (2 + 2) × log2(2 + 2) = 8."""
    assert 0.008 == of("s : X | ;")["HAL"]


def test_each_metric_has_its_meaning() -> None:
    """The names are those of `MEANINGS`, in its order, for the grammar in force too."""
    assert list(MEANINGS) == list(metrics(read_file(GRAMMAR)))


def test_the_restrictive_start_stays_as_small_as_it_is() -> None:
    """A yardstick that does not move: figures of a grammar that is never edited."""
    found = metrics(read_file(GRAMMAR.with_name("preliminary.g4")))
    sizes = {name: found[name] for name in ("TERM", "VAR", "MCC", "DEC")}
    assert {"TERM": 76, "VAR": 44, "MCC": 77, "DEC": 48} == sizes
