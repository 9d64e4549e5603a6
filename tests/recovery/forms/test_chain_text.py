"""Chains as text: what is grouped, and what may be missing."""

import pytest

from recovery.forms.chain_text import FactorText, chain_text

_LIST = "NAME (',' NAME)*"


@pytest.mark.parametrize(
    ("factors", "text"),
    [
        ([("LIST", "012", False), (_LIST, "01", False)], f"LIST ({_LIST})?"),
        ([("A", "01", False), ("B", "01", False)], "(A B)?"),
        ([("A", "01", True)], "A*"),
        ([("A", "01", True), ("B", "01", False)], "(A+ B)?"),
        ([("A", "0", True), ("B", "12", False)], "(A+ | B)"),
        ([("A", "0", False), ("B C", "1", False)], "(A | B C)?"),
        ([("A", "01", False), ("B", "12", False)], "A? B?"),
        ([("','*", "01", False)], "','*"),
    ],
)
def test_what_some_of_three_lines_have(factors: list[tuple[str, str, bool]], text: str) -> None:
    """Factors of the same lines are one group, those of different lines a choice."""
    found = [
        FactorText([one], frozenset(map(int, numbers)), repeated)
        for one, numbers, repeated in factors
    ]
    assert text == chain_text(found, 3)
