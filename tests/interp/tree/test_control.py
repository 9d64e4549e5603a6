"""Control flow: blocks, loops, jumps, calls, recursion."""

from collections.abc import Callable
from typing import Any

from interp.port.requests import End, Fail, Halt, Slice
from interp.program.load import Limits
from interp.tree import TreeExecutor
from interp.values.faults import BudgetExhausted, Fault, LinkError

Run = Callable[..., Any]
Make = Callable[..., TreeExecutor]


def body(text: str, declarations: str = "INT I,J,N") -> str:
    return f"DEF main()\n{declarations}\n{text}\nEND\n"


def test_for_counts_up(go: Run) -> None:
    """The counter is beyond the end behind the loop [CTL-05]."""
    ran = go(body("N=0\nFOR I=1 TO 3\nN=N+I\nENDFOR\nJ=I"))
    assert [0, 1, 3, 6] == ran.values("N")
    assert [1, 2, 3, 4] == ran.values("I")
    assert [4] == ran.values("J")


def test_for_counts_down(go: Run) -> None:
    """A negative step counts down [CTL-05]."""
    assert [6, 4, 2] == go(body("FOR I=6 TO 1 STEP -2\nJ=I\nENDFOR")).values("J")


def test_for_may_not_run(go: Run) -> None:
    """It is tested before the first pass [CTL-05]."""
    assert [] == go(body("FOR I=5 TO 1\nJ=I\nENDFOR")).values("J")


def test_while_repeat_loop(go: Run) -> None:
    """WHILE tests before, REPEAT after a pass, LOOP is left by EXIT [CTL-01, CTL-02]."""
    ran = go(
        body(
            "N=0\nWHILE N<2\nN=N+1\nENDWHILE\n"
            "REPEAT\nN=N+10\nUNTIL N>0\n"
            "LOOP\nLOOP\nEXIT\nENDLOOP\nN=N+100\nIF N>200 THEN\nEXIT\nENDIF\nENDLOOP"
        )
    )
    assert [0, 1, 2, 12, 112, 212] == ran.values("N")
    assert isinstance(ran.last, End)


def test_switch(go: Run) -> None:
    """One CASE at most is chosen, there is no fall-through, DEFAULT takes the rest [CTL-04]."""
    switch = "SWITCH I\nCASE 1,2\nN=10\nCASE 3\nN=30\nDEFAULT\nN=99\nENDSWITCH\n"
    ran = go(body(f"FOR I=1 TO 4\n{switch}ENDFOR"))
    assert [10, 10, 30, 99] == ran.values("N")
    assert [1, 1, 2, 0] == [event.way for event in ran.told("branch")]


def test_switch_without_default(go: Run) -> None:
    """Nothing runs where nothing is chosen [CTL-04]."""
    assert [] == go(body("I=7\nSWITCH I\nCASE 1\nN=1\nENDSWITCH")).values("N")


def test_goto(go: Run) -> None:
    """GOTO leaves blocks, backwards and forwards [CTL-07]."""
    ran = go(
        body(
            "N=0\nAGAIN:\nN=N+1\nFOR I=1 TO 5\nIF N<3 THEN\nGOTO AGAIN\nENDIF\n"
            "GOTO DONE\nENDFOR\nN=-1\nDONE:\nJ=N"
        )
    )
    assert [0, 1, 2, 3] == ran.values("N")
    assert [3] == ran.values("J")


def test_goto_within_a_block(go: Run) -> None:
    """A label inside a loop is reached from inside that loop."""
    text = "N=0\nLOOP\nTOP:\nN=N+1\nIF N<4 THEN\nGOTO top\nENDIF\nEXIT\nENDLOOP"
    assert [0, 1, 2, 3, 4] == go(body(text)).values("N")


def test_in_and_out(go: Run) -> None:
    """:IN is a copy, :OUT a reference, and OUT is the default [SCO-06]."""
    ran = go(
        body("I=1\nJ=1\nN=1\nSub(I,J,N)\nI=I\nJ=J\nN=N")
        + "DEF Sub(A:IN,B:OUT,C)\nINT A,B,C\nA=A+1\nB=B+2\nC=C+3\nEND\n"
    )
    assert ([1, 1], [1, 3], [1, 4]) == (ran.values("I"), ran.values("J"), ran.values("N"))
    assert ([2], [3], [4]) == (ran.values("A"), ran.values("B"), ran.values("C"))


def test_out_reference_to_parts(go: Run) -> None:
    """Elements and members are passed by reference, by the index at the time of the call."""
    ran = go(
        body("I=2\nSet(LIST[I],I)\nSet(P.S,I)\nN=LIST[2]\nJ=P.S", "INT I,J,N,LIST[3]\nPOS P")
        + "DEF Set(A:OUT,B:OUT)\nINT A,B\nB=3\nA=77\nEND\n"
    )
    assert ([77], [77]) == (ran.values("N"), ran.values("J"))


def test_whole_arrays(go: Run) -> None:
    """A formal array has the sizes of the actual one, which it refers to [SCO-07]."""
    ran = go(
        body("Fill(LIST[])\nN=LIST[3]", "INT N,LIST[3]")
        + "DEF Fill(A[]:OUT)\nINT A[]\nA[3]=5\nA[4]=6\nEND\n"
    )
    assert "index" == ran.last.fault.slug
    assert [5] == ran.values("A", 3)
    assert 1 == ran.last.at.depth


def test_arguments_left_out(go: Run) -> None:
    """An argument that is left out has no value [SCO-13]."""
    ran = go(
        body("Sub( ,2)")
        + 'DEF Sub(A:IN,B:IN)\nINT A,B\nDECL VAR_STATE S\nS=VARSTATE("A")\nB=B\nEND\n'
    )
    assert "[#DECLARED]" == repr(ran.values("S"))
    assert [2] == ran.values("B")


def test_recursion(go: Run) -> None:
    """Every call has its own data; results come back through expressions."""
    text = (
        "DEFFCT INT Fac(K:IN)\nINT K,L\nL=K\nIF K<2 THEN\nRETURN 1\nENDIF\n"
        "RETURN Fac(K-1)*L\nENDFCT\n"
    )
    assert [3628800] == go(body("N=Fac(10)") + text).values("N")


def test_endless_recursion(go: Run) -> None:
    """Recursion ends in the fault 1424, however deep the stack may be [SCO-11]."""
    text = body("Deeper()") + "DEF Deeper()\nDeeper()\nEND\n"
    for depth in (19, 5_000):
        fault = go(text, Limits(depth=depth)).last.fault
        assert ("stack", 1424) == (fault.slug, fault.number)


def test_function_without_return(go: Run) -> None:
    """A function that ends without RETURN is a fault [CTL-09]."""
    text = "DEFFCT INT F(A:IN)\nINT A\nIF A>0 THEN\nRETURN 1.6\nENDIF\nENDFCT\n"
    ran = go(body("N=F(1)\nN=F(0)") + text)
    assert [2] == ran.values("N")
    assert "no_result" == ran.last.fault.slug


def test_calls_are_told(go: Run) -> None:
    """A call is told at its caller's line, its end at the last line of the routine."""
    ran = go(body("Sub()") + "DEF Sub()\nHALT\nEND\n")
    told = [(one.kind, one.name, one.at.line, one.at.depth) for one in ran.recorder.events]
    assert [
        ("line", "", 3, 0),
        ("call", "Sub", 3, 0),
        ("line", "", 6, 1),
        ("return", "Sub", 6, 1),
        ("return", "main", 3, 0),
    ] == told
    assert [1] == [halt.at.depth for halt in ran.asked(Halt)]


def test_unknown_routine(go: Run) -> None:
    """A routine that is nowhere is an error when it is reached, and not before."""
    ran = go("DEF main()\nEXT Nowhere()\nINT I\nI=1\nNowhere()\nI=2\nEND\n")
    assert isinstance(ran.last, Fail)
    assert isinstance(ran.last.fault, LinkError)
    assert [1] == ran.values("I")


def test_budget(go: Run) -> None:
    """An endless program ends with its budget, and lets time pass on the way."""
    for loop in ("LOOP\nENDLOOP", "WHILE TRUE\nENDWHILE", "REPEAT\nUNTIL FALSE", "A:\nGOTO A"):
        ran = go(body(loop), Limits(statements=100, per_slice=30))
        assert isinstance(ran.last.fault, BudgetExhausted), loop
        assert 3 == len(ran.asked(Slice)), loop
        assert 100 == len(ran.told("line")), loop


def test_ended_stays_ended(make: Make) -> None:
    """An executor that has ended returns the same request again."""
    executor = make(body("I=1"))
    assert executor.advance() is executor.advance()


def test_fault_is_no_traceback(go: Run) -> None:
    """A fault is told with the place where it happened."""
    ran = go(body("I=0\nJ=1/I"))
    assert isinstance(ran.last.fault, Fault)
    assert ("division_by_zero", 4, "main.src") == (
        ran.last.fault.slug,
        ran.last.at.line,
        ran.last.at.file,
    )


def test_deepest_nesting(go: Run) -> None:
    """The deepest blocks and expressions that are allowed do not exhaust Python's stack."""
    blocks, calls = 49, 95
    deep = "F(" * calls + "1" + ")" * calls
    text = "IF TRUE THEN\n" * blocks + f"N={deep}\n" + "ENDIF\n" * blocks
    function = "DEFFCT INT F(A:IN)\nINT A\nHALT\nRETURN A+1\nENDFCT\n"
    ran = go(body(text) + function)
    assert [96] == ran.values("N")
    assert calls == len(ran.asked(Halt))


def test_deepest_parentheses(go: Run) -> None:
    """Parentheses within parentheses, as deep as they are read."""
    assert [5] == go(body("N=" + "(" * 190 + "5" + ")" * 190)).values("N")
