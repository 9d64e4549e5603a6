"""The port: requests at any depth, what is entered, evaluated and unwound."""

from collections.abc import Callable
from typing import NoReturn

import pytest

from interp.port import requests
from interp.port.events import Recorder
from interp.port.executor import Executor
from interp.port.requests import (
    DeclareInterrupt,
    EmptyError,
    End,
    Fail,
    Halt,
    Path,
    Poll,
    Read,
    Resume,
    Wait,
    Write,
)
from interp.values.faults import Fault, fault

Make = Callable[..., Executor]
INTERRUPT = (
    "DEF main()\nINT I\nI=1\nINTERRUPT DECL 3 WHEN $IN[1]==TRUE DO Stop(I)\n"
    "Work()\nI=I\nEND\n"
    "DEF Work()\nHALT\nHALT\nEND\n"
    "DEF Stop(A)\nINT A\nA=A+1\nWAIT SEC 0\nRESUME\nA=99\nEND\n"
)


def test_request_within_an_expression(make: Make) -> None:
    """A function within an expression may ask; its caller goes on with the reply."""
    recorder = Recorder()
    executor = make(
        "DEF main()\nINT I\nI=1+F()*2\nEND\nDEFFCT INT F()\nRETURN $OV_PRO\nENDFCT\n",
        None,
        recorder,
    )
    asked = executor.advance()
    assert Read(requests.At("main.src", 6, 1), ("$OV_PRO",)) == asked
    assert 1 == executor.depth
    assert isinstance(executor.advance(20), End)
    assert [41] == [one.value for one in recorder.events if one.kind == "assign"]


def test_wait_for_polls(make: Make) -> None:
    """WAIT FOR asks before each look at its condition [CTL-12]."""
    executor = make("DEF main()\nWAIT FOR $IN[1]\nWAIT SEC 1\nEND\n")
    polls = [executor.advance(), executor.advance(), executor.advance(False), executor.advance()]
    assert [Poll, Read, Poll, Read] == [type(one) for one in polls]
    assert [True, False] == [one.is_first for one in polls if isinstance(one, Poll)]
    asked = executor.advance(True)
    assert isinstance(asked, Wait)
    assert (1.0, 3) == (asked.seconds, asked.at.line)


def interrupted(
    make: Make, recorder: Recorder | None = None
) -> tuple[Executor, DeclareInterrupt, Halt]:
    """A program that halts in a routine, with its interrupt declared."""
    executor = make(INTERRUPT, None, recorder)
    declared = executor.advance()
    assert isinstance(declared, DeclareInterrupt)
    halted = executor.advance()
    assert isinstance(halted, Halt)
    return executor, declared, halted


def test_condition_is_evaluated(make: Make) -> None:
    """A condition is looked at without a request; what it cannot read is a fault."""
    executor, declared, _ = interrupted(make)
    assert executor.evaluate(declared.condition, lambda _path: True) is True
    assert executor.evaluate(declared.condition, lambda _path: False) is False

    def unreadable(_path: Path) -> NoReturn:
        raise Fault("x", "y")

    with pytest.raises(Fault):
        executor.evaluate(declared.condition, unreadable)
    with pytest.raises(Fault):
        executor.evaluate(declared.condition, lambda _path: None)
    assert 1 == executor.depth


def test_enter_asks_again(make: Make) -> None:
    """After an action the request is asked again that was open before."""
    executor, declared, halted = interrupted(make)
    executor.enter(declared.action)
    assert isinstance(executor.advance(), Wait)
    assert 2 == executor.depth
    assert isinstance(executor.advance(), Resume)
    assert isinstance(executor.advance(), End)  # nobody unwinds: it ends as any routine does
    assert halted == executor.advance()
    again = executor.advance()
    assert (Halt, 10) == (type(again), again.at.line)
    assert isinstance(executor.advance(), End)


_EXPRESSION = """DEF main()
INT X
X=5
INTERRUPT DECL 3 WHEN $IN[7] DO Add(X)
$OV_PRO=$OV_APPL+$OV_APPL+X
END
DEF Add(A:OUT)
INT A
A=A+100
WAIT SEC 1
END
"""


@pytest.mark.parametrize("times", [1, 2])
def test_action_runs_within_an_expression(make: Make, times: int) -> None:
    """Operands stay, the open request is asked again, and what the action changed is seen."""
    executor = make(_EXPRESSION)
    declared, _ = executor.advance(), executor.advance()
    assert isinstance(declared, DeclareInterrupt)
    second = executor.advance(10)
    assert isinstance(second, Read)
    for _ in range(times):
        executor.enter(declared.action)
    assert [Wait, End] * times == [type(executor.advance()) for _ in range(2 * times)]
    assert second == executor.advance()
    written = executor.advance(20)
    assert isinstance(written, Write)
    assert 10 + 20 + 5 + 100 * times == written.value


def test_unwind_to_the_level_of_the_request(make: Make) -> None:
    """RESUME to the routine that was interrupted continues behind its statement."""
    executor, declared, _ = interrupted(make)
    executor.enter(declared.action)
    assert [Wait, Resume] == [type(executor.advance()), type(executor.advance())]
    executor.unwind(1)
    halted = executor.advance()
    assert (Halt, 10, 1) == (type(halted), halted.at.line, executor.depth)


def test_unwind(make: Make) -> None:
    """RESUME leaves the action and all routines below its declaration [INT-10]."""
    recorder = Recorder()
    executor, declared, _ = interrupted(make, recorder)
    executor.enter(declared.action)
    assert [Wait, Resume] == [type(executor.advance()), type(executor.advance())]
    executor.unwind(0)
    assert 0 == executor.depth
    assert isinstance(executor.advance(), End)
    assigned = [(one.path, one.value) for one in recorder.events if one.kind == "assign"]
    assert [(("I",), 1), (("A",), 2), (("I",), 2)] == assigned


def test_enter_after_unwind(make: Make) -> None:
    """An action may be entered before the program goes on behind RESUME."""
    executor, declared, _ = interrupted(make)
    executor.enter(declared.action)
    assert [Wait, Resume] == [type(executor.advance()), type(executor.advance())]
    executor.unwind(0)
    executor.enter(declared.action)
    assert [Wait, Resume, End] == [type(executor.advance()) for _ in range(3)]
    ended = executor.advance()
    assert (End, 6) == (type(ended), ended.at.line)


def test_action_may_be_interrupted(make: Make) -> None:
    """Actions are entered above actions, each with its own open request."""
    executor, declared, halted = interrupted(make)
    executor.enter(declared.action)
    waiting = executor.advance()
    executor.enter(declared.action)
    assert isinstance(executor.advance(), Wait)
    assert isinstance(executor.advance(), Resume)
    assert isinstance(executor.advance(), End)
    assert waiting == executor.advance()
    assert isinstance(executor.advance(), Resume)
    assert isinstance(executor.advance(), End)
    assert halted == executor.advance()


def test_action_without_its_routine(make: Make) -> None:
    """An action that uses a variable of a routine that has ended faults."""
    executor = make(
        "DEF main()\nSub()\nHALT\nEND\n"
        "DEF Sub()\nINT K\nK=1\nGLOBAL INTERRUPT DECL 4 WHEN $IN[1] DO Use(K)\nEND\n"
        "DEF Use(A:IN)\nINT A\nEND\n"
    )
    declared = executor.advance()
    assert isinstance(declared, DeclareInterrupt)
    assert isinstance(executor.advance(), Halt)
    executor.enter(declared.action)
    failed = executor.advance()
    assert isinstance(failed, Fail)
    assert fault("uninitialised") == failed.fault


def test_values_are_not_shared(make: Make) -> None:
    """What was handed over does not change with the program's variables."""
    executor = make("DEF main()\nFRAME F\nF={X 1}\n$TOOL=F\nF.X=2\nHALT\nEND\n")
    written = executor.advance()
    assert isinstance(written, Write)
    executor.advance()
    assert 1.0 == written.value.get("X")


def test_unwind_while_a_fault_is_noted(make: Make) -> None:
    """RESUME comes back behind the statement itself, not behind the loop around it."""
    recorder = Recorder()
    executor = make(
        "DEF main()\nINT I,A[2]\nFOR I=3 TO 4\nON_ERROR_PROCEED\nA[I]=1\nA[I-2]=I\nENDFOR\nEND\n",
        None,
        recorder,
    )
    assert isinstance(executor.advance(), EmptyError)
    assert isinstance(executor.advance(), Write)
    executor.unwind(0)
    assert isinstance(executor.advance(), EmptyError)
    assert isinstance(executor.advance(), Write)
    assert isinstance(executor.advance(), End)
    assert [3, 4] == [
        one.value for one in recorder.events if one.kind == "assign" and one.path[0] == "A"
    ]
