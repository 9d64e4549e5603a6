"""Brackets are paired with those of their form."""

import pytest

from recovery.brackets import closer_of, left_open


@pytest.mark.parametrize(
    ("text", "closer", "opened"),
    [
        ("( a [ b ) ]", 4, None),
        ("( ( a )", None, 0),
        ("[ a ( b ) , {", None, 6),
        ("a )", None, None),
    ],
)
def test_the_closer_of_the_first_and_the_one_left_open(
    text: str, closer: int | None, opened: int | None
) -> None:
    """Of what is closed nothing is left open, and only an opening bracket has a closer."""
    assert closer == closer_of(text.split())
    assert opened == left_open(text.split())
