"""Operators, indices, components and literals, by rule."""

from collections.abc import Callable

import pytest

from grammar.syntax.build import read_module
from grammar.syntax.node_plans import MAX_DEPTH

Agrees = Callable[..., None]

DECLARATIONS = """DEF NEG()
  DECL INT I, J, LIST[3], GRID[2,2]
  DECL REAL R
  DECL BOOL B
  DECL CHAR C, TEXT[8]
  DECL FRAME F
  DECL E6POS P
"""


def program(*lines: str) -> str:
    """A routine with variables of many types and these statements."""
    return DECLARATIONS + "".join(f"  {line}\n" for line in lines) + "END\n"


@pytest.mark.parametrize(
    ("rule", "line"),
    [
        ("ARI-01", "R = 1 / 2 ;> KRL213?"),
        ("ARI-01", "R = I / J ;> KRL213-"),
        ("ARI-03", "I = R ;> KRL209-"),
        ("ARI-03", "I = 3.5 ;> KRL209-"),
        ("MOT-02", "$VEL.CP = 250 ;> KSS1422?"),
        ("MOT-02", "$VEL = {ORI1 200.0, CP 250} ;> KSS1422?"),
        ("MOT-02", "$APO = {CPTP 101, CDIS 5.0} ;> KSS1422?"),
    ],
)
def test_expression(agrees: Agrees, rule: str, line: str) -> None:
    """A statement is judged as its rule has it."""
    assert rule
    agrees(program(line))


def test_an_error_is_reported_once(agrees: Agrees) -> None:
    """What is wrong within an expression makes nothing around it wrong."""
    agrees(program("I = ((B + 1) * 2) - LIST[4 * (1 + B)] ;> KSS2256 KSS2256"))


def test_unknown_names_fit_everywhere(agrees: Agrees) -> None:
    """What comes from files not at hand is judged nowhere; it is told once."""
    text = program(
        "I = FOREIGN ;> KRL701-",
        "B = FOREIGN AND B",
        "P = FOREIGN.A.B[3]",
        "FOREIGN.X = TRUE",
        "LIN F:FOREIGN",
    )
    agrees(text.replace("DEF NEG()", "DEF NEG() ;> KRL702-"), is_complete=False)


def test_an_expression_may_be_as_deep_as_it_can_be_read(agrees: Agrees) -> None:
    """Depth of nesting is no reason to fail."""
    depth = MAX_DEPTH - 10
    nested = f"{'(' * depth}1{')' * depth}"
    indexed = f"{'LIST[' * (depth // 2)}1{']' * (depth // 2)}"
    summed = " + ".join(["I"] * 3_000)
    decided = " AND ".join(["B"] * 3_000)
    text = program(f"I = {nested}", f"I = {indexed}", f"I = {summed}", f"B = {decided}")
    assert not isinstance(read_module(text), list)
    agrees(text)
