"""Waiting and computing for long cost nothing and change nothing."""

from dataclasses import replace
from typing import Any

import pytest

from grammar.syntax.source import Source
from interp.controller.inputs.automatic_inputs import OPERATOR
from interp.controller.inputs.input_script import Script
from interp.controller.quiet_time import QuietTime
from interp.controller.requests.waits import Waits
from interp.controller.state.profile import Profile
from interp.executors import available
from interp.program.load import load
from interp.session import RunResult, RunSetup, run_program

WAITS = """DEF main ( )
INTERRUPT DECL 3 WHEN $IN[3] DO SEEN ( )
INTERRUPT ON 3
$TIMER[1]=-5000
$TIMER_STOP[1]=FALSE
WAIT FOR $TIMER_FLAG[1]
$OUT[1]=TRUE
WAIT FOR $IN[7]
$OUT[2]=TRUE
WAIT SEC 0.5
WAIT FOR $IN[8] AND $FLAG[2]
END
DEF SEEN ( )
$FLAG[2]=TRUE
PULSE ($OUT[9],TRUE,0.7 )
END
"""
SCRIPT = "t=20.0005 IN[7]=TRUE\nt=31 IN[3]=TRUE\nt=40.001 IN[8]=TRUE\n"

#: A loop that asks has fewer rounds in a cycle here.
FEW = replace(Profile.load(), requests=40)


def _run(text: str, executor: str = "tree", script: str = "", until: int = 90) -> RunResult:
    program = load([Source(text, "main.src")], "main.src", strict=False)
    script_read = Script.read(script)
    setup = RunSetup(
        executor=executor,
        profile=FEW,
        script=script_read,
        is_traced=False,
        until=until * 1_000_000,
    )
    return run_program(program, setup)


def _assert_same(told: RunResult, quick: RunResult) -> None:
    """A run without a trace, whose slices pass at once, does all that a run with one does."""
    kept = [one for one in told.events if one.kind not in ("call", "return", "branch")]
    assert (str(told.outcome), kept) == (str(quick.outcome), quick.events)


#: A condition that calls a function that changes something; a timer, and a script between ticks.
COUNTS = """DEF main ( )
DECL INT N
N=0
WAIT FOR TURNS (N)
END
DEFFCT BOOL TURNS (N:OUT )
INT N
N=N+1
RETURN N>900
ENDFCT
"""
#: Triggers until there are too many, one in each cycle, which ends elsewhere.
ASKS = "FOR I=1 TO {}\nB=$IN[5]\nENDFOR\n"
TRIGGERS = f"""DEF main ( )
INT I
BOOL B
{ASKS.format(9)}REPEAT
TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE
{ASKS.format(38)}UNTIL $IN[5]
END
"""
TIMES = "DEF main ( )\n$TIMER[1]=-2500\n$TIMER_STOP[1]=FALSE\nWAIT FOR $TIMER_FLAG[1]\nEND\n"


@pytest.mark.parametrize(
    ("text", "script"),
    [(WAITS, SCRIPT), (COUNTS, ""), (TIMES, "t=2.0005 IN[9]=FALSE\n"), (TRIGGERS, "")],
)
def test_same_trace(monkeypatch: pytest.MonkeyPatch, text: str, script: str) -> None:
    """Jumps over quiet stretches are not seen in the trace."""
    quick = [_run(text, executor, script) for executor in ("tree", "vm")]
    monkeypatch.setattr(QuietTime, "end", lambda _self, _tasks, now, *_: now)
    slow = _run(text, "vm", script)
    for run in quick:
        assert str(slow.outcome) == str(run.outcome)
        assert [one.line() for one in slow.events] == [one.line() for one in run.events]


@pytest.mark.parametrize("loop", ["UNTIL $IN[7]\n", "$FLAG[1]=$IN[7]\nUNTIL FALSE\n"])
def test_polling_takes_few_looks(looks: list[int], loop: str) -> None:
    """A minute of a loop that polls, and changes nothing, passes at once."""
    run = _run(f"DEF main ( )\nREPEAT\n{loop}END\n", "vm", until=60)
    assert ("time", True) == (run.outcome.ending, len(looks) < 60 * 5)


def test_waiting_takes_few_looks(looks: list[int]) -> None:
    """A minute of waiting for an input takes some looks a second, and not one in every cycle."""
    run = _run("DEF main ( )\nWAIT FOR $IN[7]\nEND\n", until=60)
    assert ("time", True) == (run.outcome.ending, len(looks) < 60 * 5)


def test_long_computing() -> None:
    """A program may compute for as many statements as the limits say, whatever else is going on."""
    run = _run("DEF main ( )\nINT I\nFOR I=1 TO 1000000\nENDFOR\nEND\n", available()[-1])
    assert ("end", 12_000_000) == (run.outcome.ending, run.outcome.time)


def test_interrupt_ends_a_loop() -> None:
    """A loop that an interrupt may leave is no endless one."""
    text = """DEF main ( )
INTERRUPT DECL 3 WHEN $IN[3] DO LEAVE ( )
INTERRUPT ON 3
AROUND ( )
END
DEF AROUND ( )
LOOP
ENDLOOP
END
DEF LEAVE ( )
BRAKE
RESUME
END
"""
    run = _run(text, "vm", script="t=8 IN[3]=TRUE\n")
    assert ("end", 8) == (run.outcome.ending, round(run.outcome.time / 1e6))


def test_a_loop_that_polls_sees_a_change() -> None:
    """However long a program has polled, it sees a change in the cycle in which it comes."""
    text = "DEF main ( )\nREPEAT\nUNTIL $IN[5]\n$OUT[1]=TRUE\nEND\n"
    run = _run(text, script="t=2.006 IN[5]=TRUE\n")
    assert [2_016_000] == [event.time for event in run.events if event.kind == "out"]


def test_computing_between_looks_at_inputs() -> None:
    """Automatic inputs change at the same times for a program that got many slices at once."""
    computes = "FOR I=1 TO 130007\nENDFOR\n"
    head = "DEF main ( )\nINT I\nWHILE NOT ($IN[5] AND NOT $IN[6])\n"
    text = f"{head}{computes}ENDWHILE\nEND\n"
    program = load([Source(text, "main.src")], "main.src", strict=False)
    setup = RunSetup(executor=available()[-1], script=Script.read(OPERATOR), until=5_000_000)
    told, quick = run_program(program, setup), run_program(program, replace(setup, is_traced=False))
    _assert_same(told, quick)
    assert 1 == quick.controller.automatic_inputs.count == told.controller.automatic_inputs.count


#: Requests behind computing: a WAIT FOR, outputs, inputs that are looked at in a loop.
REQUESTS = (
    "WAIT FOR $IN[1]==(I<2)\nWAIT FOR $IN[7] OR (K<0)\n",
    "$OUT[1]=NOT $OUT[1]\n$OUT[2]=NOT $OUT[1]\n$OUT[3]=$IN[3]\n",
    "REPEAT\nFOR K=1 TO 335\nENDFOR\nUNTIL $IN[7] OR $IN[8]\n",
)


@pytest.mark.parametrize("requests", REQUESTS)
@pytest.mark.parametrize("most", [1, 2, 3, 9])
def test_few_requests_a_slice(requests: str, most: int) -> None:
    """Where a slice has too few requests for what comes, that waits as it does slice by slice."""
    text = f"DEF main ( )\nINT I,K\nFOR I=1 TO 9\nFOR K=1 TO 335\nENDFOR\n{requests}ENDFOR\nEND\n"
    program = load([Source(text, "main.src")], "main.src", strict=False)
    profile = replace(Profile.load(), statements=100, requests=most)
    script = Script.read("t=0.9 press STOP\nt=1 press START\nfulfil waits after 0.024\n")
    setup = RunSetup(executor="vm", script=script, profile=profile, until=4_000_000)
    told, quick = run_program(program, setup), run_program(program, replace(setup, is_traced=False))
    _assert_same(told, quick)


@pytest.mark.parametrize("executor", [name for name in available() if name != "tree"])
def test_computing_between_requests(monkeypatch: pytest.MonkeyPatch, executor: str) -> None:
    """What passes between two requests of a program that runs alone is asked for once."""
    asked: list[int] = []
    slice_ = Waits.slice

    def counted(self: Waits, task: Any, request: Any) -> Any:
        asked.append(request.count)
        return slice_(self, task, request)

    monkeypatch.setattr(Waits, "slice", counted)
    computes = "FOR K=1 TO 7000\nENDFOR\n$OUT[1]=NOT $OUT[1]\n"
    text = f"DEF main ( )\nINT I,K\nFOR I=1 TO 20\n{computes}ENDFOR\nEND\n"
    program = load([Source(text, "main.src")], "main.src", strict=False)
    setup = RunSetup(executor=executor)
    told = run_program(program, setup)
    assert (140, 140) == (sum(asked), len(asked))
    asked.clear()
    quick = run_program(program, replace(setup, is_traced=False))
    assert [7] * 20 == asked
    _assert_same(told, quick)
    assert 20 == sum(one.kind == "out" for one in quick.events)
