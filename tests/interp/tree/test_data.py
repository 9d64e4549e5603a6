"""Variables, structures, arrays, texts, enumerations, data lists, faults that are noted."""

from collections.abc import Callable
from typing import Any

import pytest

from grammar.syntax.source import Source
from interp.port.requests import End, Invoke, Read, Write
from interp.program.load import Limits, load
from interp.tree import TreeExecutor, system_values
from interp.values.faults import LinkError, fault

Run = Callable[..., Any]
Make = Callable[..., TreeExecutor]


def body(text: str, declarations: str) -> str:
    return f"DEF main()\n{declarations}\n{text}\nEND\n"


def test_uninitialised(go: Run) -> None:
    """Reading what has no value faults [TYP-13]."""
    for declaration, text in (
        ("INT I,J", "J=I"),
        ("FRAME F\nREAL J", "J=F.X"),
        ("INT A[2],J", "J=A[2]"),
    ):
        assert "uninitialised" == go(body(text, declaration)).last.fault.slug


def test_error_is_noted(go: Run) -> None:
    """ON_ERROR_PROCEED takes a fault of the next statement and of no other [TYP-13]."""
    ran = go(body("I=3\nON_ERROR_PROCEED\nJ=A[I]\nJ=5\nJ=A[I]\nJ=6", "INT A[2],I,J"))
    assert [(("$ERR", "NUMBER"), 1444)] == [(w.path, w.value) for w in ran.asked(Write)]
    assert [5] == ran.values("J")
    assert 7 == ran.last.at.line


def test_error_in_a_condition_is_noted(go: Run) -> None:
    """The program goes on behind the whole IF."""
    ran = go(body("ON_ERROR_PROCEED\nIF I>0 THEN\nJ=1\nELSE\nJ=2\nENDIF\nJ=3", "INT I,J"))
    assert [3] == ran.values("J")


def test_error_of_the_world_is_noted(make: Make) -> None:
    """A fault as reply is raised in the statement that asked."""
    executor = make(body("ON_ERROR_PROCEED\nI=$OV_PRO\nI=2", "INT I"))
    assert isinstance(executor.advance(), Read)
    written = executor.advance(fault("index"))
    assert isinstance(written, Write)
    assert ("$ERR", "NUMBER") == written.path
    assert isinstance(executor.advance(), End)


def test_full_stack_is_noted(go: Run) -> None:
    """A call that finds no room faults in the statement of the caller."""
    ran = go(body("ON_ERROR_PROCEED\nSub()\nI=1", "INT I") + "DEF Sub()\nEND\n", Limits(depth=0))
    assert [1424] == [one.value for one in ran.asked(Write)]
    assert [1] == ran.values("I")


def test_structures_are_values(go: Run) -> None:
    """Assignment copies; an aggregate leaves the rest without a value [TYP-19]."""
    ran = go(body("F={X 1,Y 2}\nG=F\nG.X=5\nR=F.X\nG={Y 3}\nR=G.X", "FRAME F,G\nREAL R"))
    assert [1.0] == ran.values("R")
    assert "uninitialised" == ran.last.fault.slug


def test_geometric_operator(go: Run) -> None:
    """A frame is moved by another one [ARI-08]."""
    ran = go(body("F={X 1,Y 2,Z 3,A 0,B 0,C 0}\nF=F:F\nR=F.Z", "FRAME F\nREAL R"))
    assert [6.0] == ran.values("R")


def test_own_structures(go: Run) -> None:
    """Structures within structures, with arrays in them."""
    ran = go(
        body(
            "B.P.V[2]=4\nB.E=#GREEN\nC=B\nB.P.V[2]=5\nI=C.P.V[2]",
            "STRUC PART INT V[3]\nENUM COL RED,GREEN\nSTRUC BOX PART P,COL E\nDECL BOX B,C\nINT I",
        )
    )
    assert [4] == ran.values("I")
    assert "[#GREEN]" == repr(ran.values("B", "E"))


def test_enumerations(go: Run) -> None:
    """A constant is that of its place; SWITCH chooses by it [TYP-16, CTL-03]."""
    text = "E=#B\nSWITCH E\nCASE #A\nI=1\nCASE #B\nI=2\nENDSWITCH\nIF #B==E THEN\nI=3\nENDIF"
    assert [2, 3] == go(body(text, "ENUM EE A,B\nDECL EE E\nINT I")).values("I")


def test_texts(go: Run) -> None:
    """Texts are arrays of CHAR, rows of them too [TYP-11]."""
    text = (
        'T[2,]="abc"\nC=T[2,3]\nN=STRLEN(T[2,])\nS[]="xy"\nB=STRADD(S[],"z")\nC=S[3]\nC=Last(S[])'
    )
    ran = go(
        body(text, "CHAR T[2,5],S[8],C\nINT N,B")
        + "DEFFCT CHAR Last(A[]:IN)\nCHAR A[]\nRETURN A[STRLEN(A[])]\nENDFCT\n"
    )
    assert ["c", "z", "z"] == ran.values("C")
    assert [3] == ran.values("N")


def test_function_that_gives_a_text(go: Run) -> None:
    """A function may give an array of CHAR [TYP-17]."""
    text = 'DEFFCT CHAR[8] F()\nCHAR A[8]\nA[]="ab"\nRETURN A[]\nENDFCT\n'
    assert [2] == go(body("S[]=F()\nN=STRLEN(S[])", "CHAR S[8]\nINT N") + text).values("N")


def test_numbers(go: Run) -> None:
    """Numbers are converted when they are assigned [ARI-03]; bits have a sign [TYP-04]."""
    ran = go(body("I=2.5\nI='HFFFFFFFF'\nR=1\nI=7/2", "INT I\nREAL R"))
    assert [3, -1, 3] == ran.values("I")
    assert [1.0] == ran.values("R")
    assert isinstance(ran.values("R")[0], float)


def test_varstate(go: Run) -> None:
    """VARSTATE sees parts and what is declared nowhere [TYP-18]."""
    text = 'V=VARSTATE("A[2]")\nA[2]=1\nV=VARSTATE("a[2]")\nV=VARSTATE("A[9]")\nV=VARSTATE("QQ")'
    ran = go(body(text, "INT A[3]\nDECL VAR_STATE V"))
    assert "[#DECLARED, #INITIALIZED, #UNKNOWN, #UNKNOWN]" == repr(ran.values("V"))


def test_data_lists_live_on(go: Run) -> None:
    """Data of a list keep their values from call to call; GLOBAL ones are seen elsewhere."""
    ran = go(
        "DEF main()\nEXT other()\nSub()\nSub()\nother()\nEND\nDEF Sub()\nCOUNT=COUNT+1\nEND\n",
        main_dat="DEFDAT main PUBLIC\nINT COUNT=5\nGLOBAL INT SHARED=8\nINT L[2]\nL[1]=3\nENDDAT\n",
        other_src="DEF other()\nSHARED=SHARED+1\nEND\n",
    )
    assert [6, 7] == ran.values("COUNT")
    assert [9] == ran.values("SHARED")


def test_imports(go: Run) -> None:
    """An import is the other list's variable itself [ADV-05]."""
    ran = go(
        "DEF main()\nMINE=MINE+1\nEND\n",
        main_dat="DEFDAT main\nIMPORT INT MINE IS /R1/other..THEIRS\nENDDAT\n",
        other_dat="DEFDAT other PUBLIC\nINT THEIRS=41\nENDDAT\n",
    )
    assert [42] == ran.values("THEIRS")


def test_signals(go: Run) -> None:
    """A signal is the input or output it stands for; several bits are asked for at once."""
    ran = go(
        "DEF main()\nLAMP=TRUE\nGROUP=5\nFLAG=LAMP\nEND\n",
        main_dat=(
            "DEFDAT main\nSIGNAL LAMP $OUT[3]\nSIGNAL GROUP $OUT[4] TO $OUT[7]\nBOOL FLAG\nENDDAT\n"
        ),
    )
    assert [("$OUT", 3), ("$OUT", 4, "TO", 7)] == [one.path for one in ran.asked(Write)]
    assert [("$OUT", 3)] == [one.path for one in ran.asked(Read)]
    assert [True] == ran.values("FLAG")


def test_world_by_reference(go: Run) -> None:
    """A system variable passed :OUT is read and written where the parameter is."""
    ran = go(body("Set($OUT[2])", "INT I") + "DEF Set(B:OUT)\nBOOL B\nB=NOT B\nEND\n")
    assert [(("$OUT", 2), True, 1)] == [
        (one.path, one.value, one.at.depth) for one in ran.asked(Write)
    ]


def test_system_values_are_converted(go: Run) -> None:
    """What a system variable gets is of its type."""
    writes = go(body("$VEL.CP=1\n$OV_PRO=50.4", "INT I")).asked(Write)
    assert [1.0, 50] == [one.value for one in writes]
    assert [float, int] == [type(one.value) for one in writes]


def test_world_routines(go: Run) -> None:
    """Routines that need the world are requests; what they change is assigned."""
    ran = go(body("PULSE($OUT[4],TRUE,0.5)", "INT I"))
    assert [("PULSE", (False, True, 0.5))] == [(o.name, o.arguments) for o in ran.asked(Invoke)]


def test_errors_are_link_errors() -> None:
    """What does not check or cannot be read is one clear line."""
    for text in ("DEF main()\nINT I\nI=\nEND\n", "DEF main()\nBOOL B\nB=1\nEND\n"):
        with pytest.raises(LinkError, match=r"main\.src:3: "):
            load([Source(text, "main.src")], "main.src")
    with pytest.raises(LinkError, match="not among"):
        load([], "main.src")
    program = load([Source("DEF main(A:IN)\nINT A\nEND\n", "main.src")], "main.src")
    with pytest.raises(LinkError, match="parameters"):
        TreeExecutor(program)
    with pytest.raises(LinkError, match="no routine"):
        TreeExecutor(program, "other")


def test_deep_blocks_are_refused() -> None:
    """Blocks nested without end are one clear line."""
    text = "DEF main()\n" + "LOOP\n" * 5000 + "ENDLOOP\n" * 5000 + "END\n"
    with pytest.raises(LinkError, match="blocks"):
        load([Source(text, "main.src")], "main.src")


def test_values_of_the_controllers_own_lists() -> None:
    """What $machine.dat gives its variables is there for the world."""
    files = [
        Source("DEF main()\nEND\n", "main.src"),
        Source("DEFDAT $MACHINE PUBLIC\nINT $NUM_AX=6\nENDDAT\n", "$machine.dat"),
    ]
    assert {"$NUM_AX": 6} == dict(system_values(load(files, "main.src")))


def test_huge_arrays(go: Run) -> None:
    """What is too large for any memory is refused, or is the fault of a full stack."""
    ran = go(body("A[1]=1", "INT A[2000000000]"))
    assert "the variables of main are too large" == str(ran.last.fault)
    with pytest.raises(LinkError, match="too much"):
        go("DEF main()\nEND\n", main_dat="DEFDAT main\nINT A[600000],B[600000]\nENDDAT\n")
    ran = go("DEF main()\nSub()\nEND\nDEF Sub()\nINT A[300000]\nSub()\nEND\n")
    assert ("stack", 3) == (ran.last.fault.slug, ran.last.at.depth)
    ran = go("DEF main()\nSub()\nEND\nDEF Sub()\nINT A[2000000000]\nEND\n")
    assert "stack" == ran.last.fault.slug
