"""Calls: arguments by number, mode and type; values; the controller's own functions."""

from collections.abc import Callable

import pytest

from grammar.diagnostics.diagnostic import Diagnostic

Agrees = Callable[..., None]

ROUTINES = """DEF TAKE(A:IN, B:OUT)
  DECL INT A
  DECL REAL B
  B = A
END
DEF FILL(TEXT[]:OUT, LIST[]:OUT)
  DECL CHAR TEXT[]
  DECL INT LIST[]
  TEXT[] = "A"
  LIST[1] = 1
END
DEF SHOW(TEXT[]:OUT, MARK:OUT)
  DECL CHAR TEXT[], MARK
  MARK = TEXT[1]
END
DEFFCT INT COUNT(TEXT[]:IN)
  DECL CHAR TEXT[]
  RETURN STRLEN(TEXT[])
ENDFCT
"""


def program(*lines: str) -> str:
    """A routine with variables of many types, and others to call."""
    body = "".join(f"  {line}\n" for line in lines)
    return f"""DEF NEG()
  DECL INT I, LIST[3]
  DECL REAL R
  DECL CHAR TEXT[8]
  DECL STATE_T STATE
  I = 1
{body}END
{ROUTINES}"""


@pytest.mark.parametrize(
    ("rule", "line"),
    [
        ("ARI-04", "TAKE(R, R) ;> KRL209-"),
        ("ARI-04", "TAKE(I, 5) ;> KRL308-"),
        ("SCO-06", "TAKE(I, R * 2) ;> KRL308-"),
        ("SCO-13", "TAKE(, R) ;> KRL302?"),
        ("SCO-13", "TAKE() ;> KRL302?"),
        ("SCO-07", "FILL(LIST[], LIST[]) ;> KSS2274"),
        ("SCO-07", "FILL(I, LIST[]) ;> KSS2274"),
        ("SCO-07", 'SHOW("FIVE", "F") ;> KRL308-'),
        ("CTL-09", "COUNT(TEXT[]) ;> KRL309-"),
        ("FCT-01", "R = ATAN2(1.0) ;> KRL302?"),
        ("FCT-04", 'I = STRFIND(1, TEXT[], "A", #CASE_SENSITIVE) ;> KSS2296'),
        ("FCT-09", 'SREAD(TEXT[], STATE, I, "%d", 5) ;> KRL308-'),
        ("IOT-07", "PULSE($OUT[1], TRUE) ;> KRL302?"),
    ],
)
def test_call(agrees: Agrees, rule: str, line: str) -> None:
    """A call is judged as its rule has it."""
    assert rule
    agrees(program(line))


@pytest.mark.parametrize(
    "line",
    [
        "I = EKI_CLOSE() ;> KRL302?",
        'I = EKI_GETREAL("A", "B") ;> KRL302?',
        'I = EKI_SEND("A")',
        "BAS() ;> KRL302?",
        "BAS(#INITMOV)",
    ],
)
def test_arguments_of_option_packages(agrees: Agrees, line: str) -> None:
    """What a package needs is known of its manual, whatever else the backup lacks [SCO-13]."""
    agrees(program(line), is_complete=None, packages=frozenset({"EKI"}))


def test_a_routine_of_another_module(agrees: Agrees) -> None:
    """Arguments are judged by the declaration that a call leads to, in its own place."""
    agrees(
        {
            "NEG.src": """DEF NEG()
  OTHER(#RED)
  OTHER(#BLACK) ;> KSS2296
  OTHER(1) ;> KSS2274
END
""",
            "OTHER.src": "DEF OTHER(C:IN)\n  DECL COLOUR C\nEND\n",
            "OTHER.dat": "DEFDAT OTHER PUBLIC\n  GLOBAL ENUM COLOUR RED, BLUE\nENDDAT\n",
        }
    )


def test_a_routine_that_is_only_announced(agrees: Agrees) -> None:
    """EXT tells the types of parameters; that the routine itself is not here is told once."""
    agrees(
        """
DEF NEG()
  EXT OTHER(INT:IN, REAL:OUT)
  OTHER(1) ;> KRL701-
  OTHER(TRUE) ;> KSS2274
  OTHER(1, , 3) ;> KRL301
END
""",
    )


def test_an_undeclared_parameter(agrees: Agrees) -> None:
    """A parameter has its type from the body of its routine; without one it fits everything."""
    agrees(
        """
DEF NEG()
  WORK(TRUE)
  WORK(1)
END
DEF WORK(A:IN) ;> KRL115?
END
"""
    )


@pytest.mark.parametrize(
    ("head", "declared", "meant"),
    [("FEEDACK", "FEEDBACK", "FEEDBACK"), ("FEEDBACK", "FEEDACK", "FEEDBACK"), ("A", "N", None)],
)
def test_what_an_undeclared_parameter_may_mean(
    finds: Callable[..., list[Diagnostic]], head: str, declared: str, meant: str | None
) -> None:
    """A similar variable of the routine, or the parameter where that is declared and unused."""
    text = f"DEF NEG({head}:IN)\nINT {declared}\n$OV_PRO = FEEDBACK\nEND"
    (found,) = [one for one in finds({"neg.src": text}) if one.code == "KRL115"]
    assert found.fix is not None
    assert (meant is None) == found.fix.text.startswith("declare each")
    assert meant is None or f"did you mean {meant}?" == found.fix.text
