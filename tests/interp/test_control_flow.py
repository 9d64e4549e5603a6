"""Control flow: blocks, loops, jumps, calls, recursion."""

from collections.abc import Callable
from typing import Any

import pytest

from interp.port.events import ExecutorEvent
from interp.port.executor import Executor
from interp.port.requests import End, Fail, Halt, Slice
from interp.program.load import Limits
from interp.values.faults import BudgetExhausted, LinkError

Make = Callable[..., Executor]
Run = Callable[..., Any]


def body(text: str, declarations: str = "INT I,J,N") -> str:
    return f"DEF main()\n{declarations}\n{text}\nEND\n"


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


@pytest.mark.parametrize(
    "loop", ["LOOP\nENDLOOP", "WHILE TRUE\nENDWHILE", "REPEAT\nUNTIL FALSE", "A:\nGOTO A"]
)
@pytest.mark.parametrize(("statements", "slices"), [(10, 0), (11, 1), (20, 1), (21, 2), (35, 3)])
def test_budget(go: Run, loop: str, statements: int, slices: int) -> None:
    """An endless program ends with its budget, and lets time pass on the way."""
    ran = go(body(loop), Limits(statements=statements, per_slice=10))
    assert isinstance(ran.last.fault, BudgetExhausted)
    assert slices == len(ran.asked(Slice))
    assert statements == len(ran.events_of("line"))


@pytest.mark.parametrize(("per_slice", "kinds"), [(4, [Halt, Slice, End]), (5, [Halt, End])])
def test_a_request_begins_a_slice(go: Run, per_slice: int, kinds: list[type]) -> None:
    """Statements are counted from the last request on; a slice names the one that waits."""
    ran = go(body("HALT\n" + "I=1\n" * 5), Limits(per_slice=per_slice))
    asked = [one for one in ran.steps if not isinstance(one, ExecutorEvent)]
    assert kinds == [type(one) for one in asked]
    assert [8] * (len(kinds) - 2) == [one.at.line for one in ran.asked(Slice)]


@pytest.mark.parametrize(("text", "kind"), [("I=1", End), ("I=J", Fail)])
def test_ended_stays_ended(make: Make, text: str, kind: type) -> None:
    """An executor that has ended returns the same request again."""
    executor = make(body(text))
    last = executor.advance()
    assert isinstance(last, kind)
    assert last is executor.advance()


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
