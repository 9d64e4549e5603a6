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
        ("CTL-01", ["WHILE B", "ENDWHILE"]),
        ("CTL-01", ["WHILE I ;> KRL201", "ENDWHILE"]),
        ("CTL-01", ["REPEAT", "UNTIL I ;> KRL201"]),
        ("ARI-11", ["IF R THEN ;> KRL201", "ENDIF"]),
        ("CTL-03", ["SWITCH I", "CASE 1, -2", "ENDSWITCH"]),
        ("CTL-03", ["SWITCH C", 'CASE "A"', "ENDSWITCH"]),
        ("CTL-03", ["SWITCH R ;> KSS2255", "CASE 1", "ENDSWITCH"]),
        ("CTL-03", ["SWITCH I", "CASE TRUE ;> KSS2255", "ENDSWITCH"]),
        ("CTL-03", ["SWITCH $ORI_TYPE", "CASE #VAR", "CASE #NONE ;> KSS2296", "ENDSWITCH"]),
        ("CTL-04", ["SWITCH I", "CASE 1, 2", "CASE 3, 2 ;> KRL408?", "ENDSWITCH"]),
        ("CTL-04", ["SWITCH I", "CASE 1", "CASE 'H1' ;> KRL408?", "ENDSWITCH"]),
        ("CTL-05", ["FOR I = 1 TO 5 STEP -1", "ENDFOR"]),
        ("CTL-05", ["FOR R = 1 TO 5 ;> KRL405?", "ENDFOR"]),
        ("CTL-05", ["FOR B = 1 TO 5 ;> KRL405", "ENDFOR"]),
        ("CTL-05", ["FOR I = 1 TO R ;> KRL405?", "ENDFOR"]),
        ("CTL-05", ['FOR I = "A" TO 5 ;> KRL405', "ENDFOR"]),
        ("CTL-05", ["FOR I = 1 TO 5 STEP 0 ;> KRL406?", "ENDFOR"]),
        ("CTL-05", ["FOR I = 1 TO 5 STEP I ;> KRL406?", "ENDFOR"]),
        ("CTL-06", ["FOR I = 1 TO $NUM_AX", "ENDFOR"]),
        ("CTL-12", ["WAIT FOR $IN[1]"]),
        ("CTL-12", ["WAIT FOR I ;> KRL201"]),
        ("TIM-06", ["WAIT SEC R"]),
        ("TIM-06", ["WAIT SEC B ;> KRL211"]),
        ("TIM-06", ["WAIT SEC 1 / 2 ;> KRL213?"]),
        ("MOT-14", ["LIN_REL {X 10} #TOOL"]),
        ("MOT-14", ["LIN_REL {X 10} #WORLD ;> KSS2296?"]),
        ("TYP-15", ["PTP {A1 0, A2 -90, E1 5}"]),
        ("TYP-15", ["LIN {X 0, Y 1, S 2}"]),
        ("TYP-15", ["LIN {X 0, W 1} ;> KSS2125"]),
        ("ARI-11", ["LIN F"]),
        ("ARI-11", ["LIN R ;> KRL207"]),
        ("ARI-11", ["CIRC F, F, CA B ;> KRL211"]),
        ("SPL-08", ["SLIN F WITH $VEL.CP = 0.5"]),
        ("SPL-08", ["SLIN F WITH $VEL.CP = TRUE ;> KSS1446"]),
        ("TRG-03", ["TRIGGER WHEN DISTANCE=0 DELAY=0 DO B=TRUE ;>", "LIN F"][1:]),
        ("INT-06", ["INTERRUPT DECL 21 WHEN I DO WORK() ;> KRL201"]),
        ("INT-02", ["INTERRUPT ON B ;> KRL210"]),
        ("SCO-11", ["$POS_ACT = $POS_FOR ;> KSS1388"]),
        ("SCO-11", ["$IN[1] = TRUE ;> KSS1388"]),
        ("SCO-11", ["$MODE_OP = #T1 ;> KSS1388?"]),
        ("CTL-09", ["RETURN 5 ;> KRL305?"]),
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
