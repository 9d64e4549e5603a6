"""Declarations, data lists and names, by rule."""

from collections.abc import Callable

import pytest

Agrees = Callable[..., None]


@pytest.mark.parametrize(
    ("rule", "lines"),
    [
        ("TYP-05", ["DECL INT A", "DECL INT a ;> KRL104"]),
        ("TYP-05", ["STRUC T INT X, REAL X ;> KRL104"]),
        ("TYP-05", ["ENUM T X, Y, X ;> KRL104"]),
        ("TYP-05", ["STRUC T INT X", "DECL INT T"]),
        ("TYP-08", ["DECL INT A[3], B[2,2], C[1,1,1]"]),
        ("TYP-08", ["DECL INT A[] ;> KSS2086"]),
        ("TYP-08", ["STRUC T INT A[] ;> KSS2086"]),
        ("TYP-08", ["DECL INT A[0] ;> KRL114"]),
        ("TYP-08", ["DECL INT A[TRUE] ;> KRL114"]),
        (
            "TYP-08",
            ["DECL CONST INT N = 3", "DECL INT A[N]", "A[3] = 1", "A[4] = 1 ;> KSS1444"][:3],
        ),
        ("TYP-09", ["DECL INT A[3]", "A[1] = 1", "A[4] = 4 ;> KSS1444"]),
        ("TYP-10", ["DECL INT A[3]", "A[1] = 1", "A[3] = 1"]),
        ("TYP-10", ["DECL INT A[3]", "A[2] = 1", "A[1] = 1 ;> KSS2074"]),
        ("TYP-10", ["DECL INT A[2,2]", "A[1,2] = 1", "A[2,1] = 1"]),
        ("TYP-10", ["DECL INT A[2,2]", "A[2,1] = 1", "A[1,2] = 1 ;> KSS2074"]),
        ("TYP-10", ["DECL INT A[2], B[2]", "A[1] = 1", "B[1] = 1", "A[2] = 2"]),
        ("TYP-10", ["DECL INT A[2]", "", "A[1] = 1 ;> KRL112-"]),
        ("TYP-10", ["DECL INT A[2]", ";its places", "A[1] = 1"]),
        ("TYP-10", ["DECL INT A[2]", "DECL INT B", "A[1] = 1 ;> KRL112", "A[2] = 1"]),
        ("TYP-10", ["DECL CHAR A[3]", 'A[1] = "A"', 'A[3] = "C" ;> KRL118?']),
        ("TYP-10", ["DECL CHAR A[2,3]", 'A[1,1] = "A"', 'A[1,3] = "C" ;> KRL118?']),
        ("TYP-10", ["DECL CHAR A[2,3]", 'A[1,1] = "A"', 'A[2,1] = "B"', 'A[2,2] = "C"']),
        ("TYP-10", ["DECL CHAR A[2,3]", 'A[1,1] = "A"', 'A[2,2] = "B" ;> KRL118?']),
        ("TYP-11", ["DECL CHAR A[3]", 'A[] = "ABC"']),
        ("TYP-11", ["DECL CHAR A[3]", 'A[] = "ABCD" ;> KRL206?']),
        ("TYP-11", ["DECL CHAR A[2,3]", 'A[1,] = "ABC"']),
        ("IOT-03", ["DECL BOOL $BWDSTART = FALSE", "DECL INT $FLAG ;> KRL104?"]),
        ("TYP-12", ["DECL INT A = 3.0"]),
        ("TYP-12", ["DECL INT A = 3.5 ;> KRL209-"]),
        ("TYP-12", ["DECL REAL A = 3"]),
        ("TYP-12", ["DECL BOOL A = 1 ;> KSS1446"]),
        ("TYP-15", ["DECL POS A = {X 1, S 2}"]),
        ("TYP-15", ["DECL FRAME A = {X 1, S 2} ;> KSS2125"]),
        ("TYP-16", ["ENUM T X, Y", "DECL T A = #Y"]),
        ("TYP-16", ["ENUM T X, Y", "DECL T A = #Z ;> KSS2296"]),
        ("TYP-19", ["STRUC T INT X, FRAME F, CHAR N[4]", 'DECL T A = {X 1, F {Y 2}, N[] "ABCD"}']),
        ("TYP-19", ["STRUC T INT X, FRAME F", "DECL T A = {X TRUE, F {V 2}} ;> KSS1446 KSS2125"]),
        ("IOT-03", ["SIGNAL A $IN[1] TO $IN[32]"]),
        ("IOT-03", ["SIGNAL A $IN[1] TO $IN[33] ;> KSS2335"]),
        ("IOT-03", ["SIGNAL A $IN[1] TO $OUT[8] ;> KRL110"]),
        ("IOT-03", ["SIGNAL A B", "SIGNAL B A ;> KRL119"]),
        ("IOT-03", ["SIGNAL A A ;> KRL119"]),
        ("IOT-03", ["SIGNAL A B", "SIGNAL B $IN[1]", "SIGNAL C A"]),
        ("IOT-03", ["SIGNAL $NO_SUCH_SIGNAL $IN[1] ;> KSS2078?"]),
        ("SCO-04", ["GLOBAL INT A = 1 ;> KRL108"]),
        ("SCO-04", ["GLOBAL ENUM T X, Y ;> KRL108"]),
        ("SCO-04", ["INT A = 1", "GLOBAL INT B = 1 ;> KRL108", "GLOBAL INT C = 1"]),
        ("TYP-06", ["DECL NO_SUCH_TYPE A ;> KRL103"]),
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


def test_module_names(agrees: Agrees) -> None:
    """A module has the name of its file, in any letter case [SCO-01]."""
    agrees({"Neg.src": "DEF NEG()\nEND\n", "neg.dat": "DEFDAT nEG\nENDDAT\n"})
    agrees(
        {"NEG.src": "DEF OTHER() ;> KSS2051\nEND\n", "NEG.dat": "DEFDAT OTHER ;> KSS2051\nENDDAT\n"}
    )


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
