"""ANTLR is asked whether it accepts, and says where it stopped."""

import pytest

from grammar.parser import antlr_reference

PROGRAM = "DEF A()\nEND\n"


def test_a_program_is_accepted(capfd: pytest.CaptureFixture[str]) -> None:
    """A program is accepted, and nothing is printed on the way."""
    assert antlr_reference.accepts(PROGRAM)
    assert antlr_reference.refusal(PROGRAM) is None
    assert not antlr_reference.accepts("DEF ?A()\nEND\n")
    assert ("", "") == tuple(capfd.readouterr())


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("DEF A()\nEND\n  DEF ]\n", 3, 6, "unexpected ']'"),
        ("DEF A()\n ? ~\nEND\n", 2, 1, "token recognition error at: '?'"),
        ("DEF A()\nEND ?\n", 2, 4, "token recognition error at: '?'"),
        ("DEF", 1, 3, "unexpected '<EOF>'"),
        ("DEF A()\n ~ DEF", 2, 1, "token recognition error at: '~'"),
    ],
)
def test_where_it_stops(text: str, line: int, column: int, message: str) -> None:
    """A refusal has the line from 1, the column from 0 and what was wrong, the first thing only."""
    assert antlr_reference.Refusal(line, column, message) == antlr_reference.refusal(text)
