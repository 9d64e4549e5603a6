"""A sequence is cut where a rule has one element after another."""

import pytest

from recovery.forms.parts import parts


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("LIN  target", ["LIN", "target"]),
        ("DO ('(' NAME (',' NAME)*)? eol", ["DO", "('(' NAME (',' NAME)*)?", "eol"]),
        ("A | '\\'' ')'", ["A", "|", "'\\''", "')'"]),
    ],
)
def test_parts_are_split_outside_of_parentheses_and_quotes(text: str, expected: list[str]) -> None:
    """A group is one part with what it repeats, a quoted sign is no parenthesis."""
    assert expected == parts(text)
