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
        ("TYP-01", "I = 2147483647"),
        ("TYP-01", "I = 2147483648 ;> KRL204"),
        ("TYP-01", "I = -2147483648"),
        ("TYP-01", "I = -2147483649 ;> KRL204"),
        ("TYP-01", "I = 'HFFFFFFFF'"),
        ("TYP-01", "I = 'H1FFFFFFFF' ;> KRL204"),
        ("TYP-03", 'C = "A"'),
        ("TYP-03", 'C = "AB" ;> KRL205'),
        ("TYP-03", "B = 1 ;> KSS1446"),
        ("TYP-08", "I = LIST[1]"),
        ("TYP-08", "I = LIST[1,1] ;> KRL203"),
        ("TYP-08", "I = GRID[1] ;> KRL203"),
        ("TYP-09", "I = LIST[3]"),
        ("TYP-09", "I = LIST[4] ;> KSS1444"),
        ("TYP-09", "I = LIST[0] ;> KSS1444"),
        ("TYP-09", "I = LIST[1 + 1 + 2] ;> KSS1444"),
        ("TYP-09", "I = LIST[J]"),
        ("TYP-09", "I = GRID[2, 3] ;> KSS1444"),
        ("TYP-09", "B = $IN[100000] ;> KSS1444?"),
        ("TYP-09", "B = $IN[0] ;> KSS1444"),
        ("TYP-11", 'TEXT[] = "EIGHT   "'),
        ("TYP-11", 'TEXT[] = "NINE     " ;> KRL206?'),
        ("TYP-11", 'TEXT = "A" ;> KSS2052'),
        ("TYP-14", "$VEL.CP = 0.5"),
        ("TYP-14", "$VEL.CQ = 0.5 ;> KSS2125"),
        ("TYP-15", "P.E1 = P.S + P.X ;>"),
        ("TYP-15", "F.S = 1 ;> KSS2125"),
        ("TYP-16", "$IPO_MODE = #BASE"),
        ("TYP-16", "$CIRC_TYPE = #BASE"),
        ("TYP-16", "$IPO_MODE = #PATH ;> KSS2296"),
        ("TYP-16", "B = $MODE_OP == #T1"),
        ("TYP-16", "B = #T9 == $MODE_OP ;> KSS2296?"),
        ("TYP-19", "F = {X 1, Y 2}"),
        ("TYP-19", "F = {FRAME: X 1, Y 2}"),
        ("TYP-19", "F = {X 1, Y 2, X 3} ;> KRL212?"),
        ("TYP-20", "I = LIST + 1 ;> KSS2052"),
        ("TYP-20", "I = J[1] ;> KSS2295"),
        ("TYP-20", "F = {X 1, Q 2} ;> KSS2125"),
        ("ARI-01", "R = I + 0.5"),
        ("ARI-01", "R = 1 / 2 ;> KRL213?"),
        ("ARI-01", "R = 4 / 2"),
        ("ARI-01", "R = I / J ;> KRL213-"),
        ("ARI-01", "R = (I + J) / 2.0"),
        ("ARI-03", "I = R ;> KRL209-"),
        ("ARI-03", "I = 3.0"),
        ("ARI-03", "I = 3.5 ;> KRL209-"),
        ("ARI-05", "B = (I == 1) AND (J == 2)"),
        ("ARI-05", "B = I == 1 AND J == 2 ;> KRL214?"),
        ("ARI-05", "B = I == 1 AND J == 2 OR C == 3 ;> KRL214?"),
        ("ARI-05", "B = NOT I == 1 ;> KRL214?"),
        ("ARI-06", "B = B == TRUE AND B"),
        ("ARI-07", "B = (I B_AND 2) > 0"),
        ("ARI-07", "B = I B_AND 2 > 0"),
        ("ARI-07", "I = R B_OR 1 ;> KRL210"),
        ("ARI-07", "I = B_NOT B ;> KRL210"),
        ("ARI-08", "F = F:$NULLFRAME"),
        ("ARI-08", "P = F:P"),
        ("ARI-08", "F = F:5 ;> KRL208?"),
        ("ARI-10", 'B = C == "A"'),
        ("ARI-10", "B = B < TRUE ;> KRL202?"),
        ("ARI-10", "B = B == 1 ;> KRL202"),
        ("ARI-10", "B = F == F ;> KRL202?"),
        ("ARI-11", "I = B + 1 ;> KSS2256"),
        ("ARI-11", "B = NOT I ;> KRL201"),
        ("ARI-11", "B = B AND I ;> KRL201"),
        ("ARI-11", "I = -B ;> KSS2256"),
        ("ARI-11", "LIST[B] = 1 ;> KRL211"),
        ("ARI-11", "$ADVANCE = 6 ;> KSS1422"),
        ("ARI-11", "$ADVANCE = 5"),
        ("MOT-02", "$VEL.CP = 250 ;> KSS1422?"),
        ("MOT-02", "$VEL = {CP 0.25, ORI1 200.0}"),
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
