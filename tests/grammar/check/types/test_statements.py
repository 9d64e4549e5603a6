"""Conditions, loops, SWITCH, RETURN, motions, triggers and interrupts, by rule."""

from collections.abc import Callable

import pytest

Agrees = Callable[..., None]


def program(*lines: str) -> str:
    """A routine with variables of many types, and others to call."""
    body = "".join(f"  {line}\n" for line in lines)
    return f"""DEF NEG()
  DECL INT I
  DECL REAL R
  DECL BOOL B
  DECL CHAR C
  DECL FRAME F
  I = 1
{body}END
DEF WORK()
END
"""


@pytest.mark.parametrize(
    ("rule", "lines"),
    [
        ("CTL-04", ["SWITCH I", "CASE 1, 2", "CASE 3, 2 ;> KRL408?", "ENDSWITCH"]),
        ("CTL-04", ["SWITCH I", "CASE 1", "CASE 'H1' ;> KRL408?", "ENDSWITCH"]),
        ("TIM-06", ["WAIT SEC B ;> KRL211"]),
        ("TIM-06", ["WAIT SEC 1 / 2 ;> KRL213?"]),
        ("MOT-14", ["LIN_REL {X 10} #WORLD ;> KSS2296?"]),
        ("SPL-08", ["SLIN F WITH $VEL.CP = TRUE ;> KSS1446"]),
        ("INT-02", ["INTERRUPT ON B ;> KRL210"]),
    ],
)
def test_statement(agrees: Agrees, rule: str, lines: list[str]) -> None:
    """A statement is judged as its rule has it."""
    assert rule
    agrees(program(*lines))


def test_return_of_a_function(agrees: Agrees) -> None:
    """RETURN has a value of the type of its function [CTL-09, TYP-17]."""
    agrees(
        """
DEF NEG()
END
DEFFCT INT ONE()
  RETURN 1
ENDFCT
DEFFCT INT TWO()
  RETURN ;> KRL304?
ENDFCT
DEFFCT IPO_MODE THREE()
  RETURN #TCP
ENDFCT
DEFFCT IPO_MODE FOUR()
  RETURN 4 ;> KSS1446
ENDFCT
DEFFCT CHAR[8] FIVE()
  DECL CHAR TEXT[8]
  TEXT[] = "FIVE"
  RETURN TEXT[]
ENDFCT
"""
    )


def test_a_constant_is_not_changed(agrees: Agrees) -> None:
    """CONST keeps its value [TYP-07]; its name can be a label, a size, a step."""
    agrees(
        {
            "NEG.src": """DEF NEG()
  DECL INT I, LIST[SIZE]
  SIZE = 5 ;> KSS1388
  LIST[SIZE] = 1
  LIST[SIZE + 1] = 1 ;> KSS1444
  FOR I = 1 TO 9 STEP SIZE
  ENDFOR
  SWITCH I
  CASE SIZE
  CASE 4 ;> KRL408?
  ENDSWITCH
END
""",
            "NEG.dat": "DEFDAT NEG\n  DECL CONST INT SIZE = 4\nENDDAT\n",
        }
    )


def test_an_input_by_name(agrees: Agrees) -> None:
    """A signal on an input is not written; public code does it, so this is no error."""
    agrees(
        {
            "NEG.src": "DEF NEG()\n  GATE = TRUE ;> KSS1388?\n  LAMP = GATE\nEND\n",
            "NEG.dat": "DEFDAT NEG\n  SIGNAL GATE $IN[1]\n  SIGNAL LAMP $OUT[1]\nENDDAT\n",
        }
    )
