"""Control flow: blocks, loops, jumps, calls, recursion."""

from collections.abc import Callable
from typing import Any

import pytest

from interp.port.events import ExecutorEvent
from interp.port.requests import End, Fail, Halt, Slice
from interp.program.load import Limits
from interp.tree import TreeExecutor
from interp.tree.run import Frame, ProgramState, Steps
from interp.values.faults import BudgetExhausted, Fault, LinkError

Run = Callable[..., Any]
Make = Callable[..., TreeExecutor]


def body(text: str, declarations: str = "INT I,J,N") -> str:
    return f"DEF main()\n{declarations}\n{text}\nEND\n"


def test_switch(go: Run) -> None:
    """One CASE at most is chosen, there is no fall-through, DEFAULT takes the rest [CTL-04]."""
    switch = "SWITCH I\nCASE 1,2\nN=10\nCASE 3\nN=30\nDEFAULT\nN=99\nENDSWITCH\n"
    ran = go(body(f"FOR I=1 TO 4\n{switch}ENDFOR"))
    assert [10, 10, 30, 99] == ran.values("N")
    assert [1, 1, 2, 0] == [event.way for event in ran.events_of("branch")]


def test_endless_recursion(go: Run) -> None:
    """Recursion ends in the fault 1424, however deep the stack may be [SCO-11]."""
    text = body("Deeper()") + "DEF Deeper()\nDeeper()\nEND\n"
    for depth in (19, 5_000):
        fault = go(text, Limits(depth=depth)).last.fault
        assert ("stack", 1424) == (fault.slug, fault.number)


def test_calls_are_reported(go: Run) -> None:
    """A call is told at its caller's line, its end at the last line of the routine."""
    ran = go(body("Sub()") + "DEF Sub()\nHALT\nEND\n")
    events = [one for one in ran.steps if isinstance(one, ExecutorEvent)]
    told = [(one.kind, one.name, one.at.line, one.at.depth) for one in events]
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
        assert 100 == len(ran.events_of("line")), loop


def test_rounds_that_change_nothing(go: Run, make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    """They count as begun without being run, and all requests come where they did."""
    limits, begin, begun = Limits(statements=1_000, per_slice=301), ProgramState.begin, list[int]()

    def counted(run: ProgramState, frame: Frame, line: int) -> Steps[None]:
        begun.append(line)
        return begin(run, frame, line)

    monkeypatch.setattr(ProgramState, "begin", counted)
    for loop in ("LOOP\nJ=0\nENDLOOP", "WHILE I<1\nENDWHILE", "A:\nI=0\nGOTO A"):
        slow = [one.at for one in go(body(f"I=0\n{loop}"), limits).asked(Slice)]
        begun.clear()
        quick = make(body(f"I=0\n{loop}"), limits)
        asked = [quick.advance(None).at for _ in slow]
        assert isinstance(quick.advance(None), Fail), loop
        assert (slow, 1_000, True) == (asked, quick.begun, len(begun) < 100), loop


def test_rounds_that_change_something(make: Make) -> None:
    """A loop whose variables change is run to its end."""
    for change in ("J=1-J\nI=I+J", "I=I+F()"):
        text = body(f"I=0\nJ=0\nREPEAT\n{change}\nUNTIL I>3")
        executor = make(text + "DEFFCT INT F()\nRETURN 1\nENDFCT\n", Limits(statements=200))
        assert isinstance(executor.advance(), End | Fail), change
        assert executor.begun < 200, change


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
