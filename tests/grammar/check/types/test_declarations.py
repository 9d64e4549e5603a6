"""Declarations, data lists and names, by rule."""

from collections.abc import Callable

import pytest

Agrees = Callable[..., None]


@pytest.mark.parametrize(
    ("rule", "lines"),
    [
        ("TYP-10", ["DECL CHAR A[3]", 'A[1] = "A"', 'A[3] = "C" ;> KRL118?']),
        ("TYP-10", ["DECL CHAR A[2,3]", 'A[1,1] = "A"', 'A[1,3] = "C" ;> KRL118?']),
        ("TYP-10", ["DECL CHAR A[2,3]", 'A[1,1] = "A"', 'A[2,2] = "B" ;> KRL118?']),
        ("TYP-10", ["DECL INT A[9]", "A[1] = 1", "A[99] = 1 ;> KSS1444", "A[3] = 1"]),
        ("TYP-12", ["DECL INT A = 3.5 ;> KRL209-"]),
        ("TYP-19", ["STRUC T INT X, FRAME F", "DECL T A = {X TRUE, F {V 2}} ;> KSS1446 KSS2125"]),
        ("IOT-03", ["SIGNAL A B", "SIGNAL B A ;> KRL119"]),
        ("IOT-03", ["SIGNAL A A ;> KRL119"]),
    ],
)
def test_data_list(agrees: Agrees, rule: str, lines: list[str]) -> None:
    """A declaration or an initial value is judged as its rule has it."""
    assert rule
    agrees("DEFDAT NEG\n" + "".join(f"  {line}\n" for line in lines) + "ENDDAT\n")


def test_a_public_data_list(agrees: Agrees) -> None:
    """GLOBAL needs PUBLIC; the controller's own lists need neither [SCO-04]."""
    agrees("DEFDAT NEG PUBLIC\n  GLOBAL INT A = 1\nENDDAT\n")
    agrees({"$CONFIG.dat": "DEFDAT $CONFIG\n  GLOBAL INT A = 1\nENDDAT\n"})


def test_a_parameter_is_declared_in_the_body(agrees: Agrees) -> None:
    """That is no second declaration; a second one in the body is [SCO-06]."""
    agrees(
        """
DEF NEG(A:IN, B:OUT)
  DECL INT A
  DECL REAL B[], A ;> KRL104
END
"""
    )


@pytest.mark.parametrize(
    "lines",
    [
        ["DECL INT P", "DECL FRAME P ;> KRL104", "P.X = 3", "LIN P", "P = P : P"],
        ["DECL INT P", "DECL INT P[3] ;> KRL104", "P[2] = 3"],
        ["SIGNAL P $IN[1]", "DECL INT P ;> KRL104", "P = 3"],
        ["DECL INT P", "DECL INT P ;> KRL104", "P = TRUE ;> KSS1446"],
        ["ENUM T X", "ENUM T Y ;> KRL104", "DECL T P", "P = #Y"],
        ["FETCH()", "FETCH(1)", "END", "DEF FETCH()", "END", "DEF FETCH(X:IN) ;> KRL104", "INT X"],
    ],
)
def test_a_name_that_is_declared_with_two_types(agrees: Agrees, lines: list[str]) -> None:
    """One mistake is one finding, at the second declaration, and none is at the uses."""
    agrees("\n".join(["DEF NEG()", *lines, "END"]))


def test_only_a_whole_array_takes_a_text(agrees: Agrees) -> None:
    """That is certain of variables too that are declared in no file at hand [TYP-11]."""
    lines = [
        'X[] = "text"',
        'X[1,] = "text"',
        'X = "t"',
        'X = "text" ;> KSS1446',
        'X[1] = "text" ;> KSS1446',
        'X.NAME = ("text") ;> KSS1446',
        'X.NAME = "text" ;> KSS1446',
        'T[] = "text"',
        'T = "text" ;> KSS2052',
    ]
    text = "\n".join(["DEF NEG()", "DECL CHAR T[9]", *lines, "END"])
    agrees(text, is_complete=None, ignored=("KRL701", "KRL702"))


def test_names_that_hide_others(agrees: Agrees) -> None:
    """A variable of a routine hides that of the data list, which is worth a note [SCO-05]."""
    agrees(
        {
            "NEG.src": "DEF NEG()\n  DECL INT A ;> KRL111-\n  A = 1\nEND\n",
            "NEG.dat": "DEFDAT NEG\n  DECL BOOL A = TRUE\nENDDAT\n",
        }
    )


def test_unknown_names(agrees: Agrees) -> None:
    """What nothing declares is an error, once in a file, where nothing is missing."""
    agrees(
        """
DEF NEG()
  DECL INT COUNT
  COUNT = COUNTT + COUNTT ;> KRL101
  WORK(COUNTT) ;> KRL102
  $NO_SUCH_VARIABLE = 1 ;> KRL113-
END
"""
    )


def test_names_of_other_modules(agrees: Agrees) -> None:
    """Data and routines of other modules are seen if they are GLOBAL [SCO-01, SCO-04]."""
    agrees(
        {
            "NEG.src": """DEF NEG()
  OTHER()
  INNER() ;> KRL703
  SHARED()
  $OUT[A] = TRUE
  $OUT[B] = TRUE ;> KRL101
END
""",
            "OTHER.src": "DEF OTHER()\nEND\nDEF INNER()\nEND\nGLOBAL DEF SHARED()\nEND\n",
            "OTHER.dat": "DEFDAT OTHER PUBLIC\n  GLOBAL INT A = 1\n  INT B = 1\nENDDAT\n",
        }
    )


def test_imports(agrees: Agrees) -> None:
    """What is imported has to be there, in a PUBLIC data list [ADV-05]."""
    agrees(
        {
            "NEG.src": """DEF NEG()
  DECL INT I
  IMPORT INT A IS /R1/OTHER..A
  IMPORT INT C IS /R1/OTHER..C ;> KRL101
  I = A + C
END
""",
            "OTHER.dat": "DEFDAT OTHER PUBLIC\n  INT A = 1\nENDDAT\n",
        }
    )


def test_a_name_that_two_modules_declare_for_everybody(agrees: Agrees) -> None:
    """On a controller that is a fault; elsewhere folders are full of copies."""
    text = "DEF {}()\nEND\nGLOBAL DEF SHARED(){}\nEND\n"
    agrees(
        {
            "KRC/R1/Program/A.src": text.format("A", ""),
            "KRC/R1/Program/B.src": text.format("B", " ;> KRL104?"),
        }
    )
    agrees({"X/A.src": text.format("A", ""), "Y/B.src": text.format("B", "")})
