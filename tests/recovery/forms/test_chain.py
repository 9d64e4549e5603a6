"""Chains: what they read, and what they generalise."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recovery.forms.chain import Factor, chain_of


def _pattern(factors: tuple[Factor[str], ...]) -> str:
    return "".join(f"[{''.join(factor.symbols)}]{factor.often}" for factor in factors)


@pytest.mark.parametrize(
    ("examples", "pattern"),
    [
        (["abd", "acd", "ac"], "[a][bc][d]?"),
        (["dtn", "gdtn"], "[g]?[d][t][n]"),
        (["ab", "abab"], "[ab]+"),
        (["a", "aa", ""], "[a]*"),
    ],
)
def test_what_comes_and_goes(examples: list[str], pattern: str) -> None:
    """Order alone decides: what excludes each other is a choice, what is missing optional."""
    assert pattern == _pattern(chain_of(examples))


@given(st.lists(st.text("abcde", max_size=6), min_size=1, max_size=6))
def test_every_example_is_read(examples: list[str]) -> None:
    """The chain of examples reads each of them."""
    pattern = re.compile(_pattern(chain_of(examples)) or "(?!)|")
    assert [] == [text for text in examples if not pattern.fullmatch(text)]


@given(st.lists(st.text("abcde", max_size=6), min_size=1, max_size=6))
def test_no_symbol_comes_twice(examples: list[str]) -> None:
    """Each symbol of the examples is in one factor."""
    symbols = [symbol for factor in chain_of(examples) for symbol in factor.symbols]
    assert sorted(set("".join(examples))) == sorted(symbols)
