"""Damage at one place of a program, drawn by chance."""

import random

import pytest

from grammar.bench.slips import KINDS, Token, damaged, lines_of_tokens, slip
from grammar.syntax.source import Source

LINE = [
    Token("IF", 0, "IF", True),
    Token("NAME", 3, "COUNTER", False),
    Token("GREATER", 11, ">", False),
    Token("NAME", 13, "CALL", False),
    Token("LPAREN", 17, "(", False),
    Token("RPAREN", 18, ")", False),
    Token("INTEGER", 20, "3", False),
]
TEXT = "IF COUNTER > CALL() 3"
#: Lines with a place for what not every line has one for.
OTHERS = {
    "number out of range": [
        Token("NAME", 0, "COUNT", False),
        Token("LBRACKET", 5, "[", False),
        Token("INTEGER", 6, "7", False),
        Token("RBRACKET", 7, "]", False),
    ],
    "end of a block dropped": [Token("ENDIF", 0, "ENDIF", True)],
}


@pytest.mark.parametrize("kind", KINDS["mistakes"])
def test_a_mistake_changes_the_line(kind: str) -> None:
    """Every kind of mistake changes a line that has a place for it, and within the line."""
    for seed in range(30):
        exchange = slip(kind, OTHERS.get(kind, LINE), random.Random(seed))
        assert exchange is not None
        start, end, new = exchange
        assert 0 <= start <= end <= len(TEXT)
        assert kind in OTHERS or TEXT[start:end].upper() != new.upper()


def test_lines_without_a_place_get_no_mistake() -> None:
    """A line without names, calls or literals cannot get a mistake in one."""
    for kind in ("name misspelt", "argument added", "literal of another type"):
        assert slip(kind, [Token("ENDIF", 0, "ENDIF", True)], random.Random(1)) is None


@pytest.mark.parametrize(
    ("call", "left"),
    [
        ("WORK(1)", "WORK()"),
        ("WORK(1, B[2, 3])", "WORK(1)"),
        ("WORK({X 1, Y 2})", "WORK()"),
        ("WORK(1, F(2, 3), )", "WORK(1, F(2, 3))"),
        ("WORK()", None),
        ("WORK( )", None),
        ("WORK = 1", None),
        ("GLOBAL DEF WORK(A :IN)", None),
        ("EXT WORK(INT :IN)", None),
    ],
)
def test_the_last_argument_is_dropped(call: str, left: str | None) -> None:
    """A comma in an index, an aggregate or another call separates no arguments of the call."""
    (line,) = lines_of_tokens(Source(call, "cell.src"))
    drawn = [slip("argument dropped", line, random.Random(seed)) for seed in range(20)]
    made = {one and call[: one[0]] + one[2] + call[one[1] :] for one in drawn}
    assert left in made
    assert "F(" in call or made == {left}


WHOLE = """DEF CELL()
  ; moves home
  IF COUNTER > 3 THEN
    TEXT[] = "go"
  ENDIF
END
"""


@pytest.mark.parametrize("kind", [*KINDS["tokens"], *KINDS["lines"]])
def test_damage_changes_the_text(kind: str) -> None:
    """Each kind of damage is possible in a program, changes it, and follows from the seed."""
    source = Source(WHOLE, "cell.src")
    lines = list(lines_of_tokens(source))
    texts = []
    for chance in (random.Random(1), random.Random(1)):
        drawn = [found for _ in range(60) if (found := damaged(kind, source, lines, chance))]
        texts.append([f"{WHOLE[:start]}{new}{WHOLE[end:]}" for start, end, new in drawn])
    assert texts[0] == texts[1]
    assert texts[0]
    assert WHOLE not in texts[0]
