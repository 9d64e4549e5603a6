"""Going back: the whole state is as it was, and what follows is the same again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.controller.inputs.input_script import Script
from interp.debugging.client import (
    Back,
    Breakpoint,
    Command,
    Go,
    Quit,
    Restart,
    Select,
    StepCommand,
    Stop,
)
from interp.debugging.debugger import Debugger
from interp.executors import Prepared, available
from interp.program.load import load
from interp.session import RunResult, RunSetup, run_program
from interp.values.faults import LinkError

MAIN = """\
DEF MAIN()
  INT I,A[4]
  INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO ACTION()
  INTERRUPT ON 5
  PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  I=1
  PTP {A1 10.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0} C_PTP
  TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[4]=TRUE
  PTP {A1 20.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  FOR I=1 TO 4
    A[I]=FAC(I)
    WAIT SEC 0.2
  ENDFOR
  TOTAL=TOTAL+A[4]
  $OUT[1]=TRUE
END
DEF ACTION()
  TOTAL=TOTAL+1
  INTERRUPT OFF 5
END
DEFFCT INT FAC(N:IN)
  INT N
  IF N<=1 THEN
    RETURN 1
  ENDIF
  RETURN N*FAC(N-1)
ENDFCT
"""
DATA = "DEFDAT MAIN\nINT TOTAL=0\nSIGNAL DOOR $IN[1]\nENDDAT\n"
SUBMIT = """\
DEF SPS()
  INT K
  K=0
  LOOP
    K=K+1
    $FLAG[1]=NOT $FLAG[1]
    WAIT SEC 0.1
  ENDLOOP
END
"""
PROGRAM = load(
    [Source(MAIN, "main.src"), Source(DATA, "main.dat"), Source(SUBMIT, "sps.sub")], "main.src"
)
SCRIPT = Script.read("t=0.3 IN[1]=TRUE", "script")
PREPARED = Prepared(PROGRAM)

Commands = Iterator[Command]


def debugged(
    commands: Callable[[Debugger, list[Stop]], Commands], executor: str = available()[-1]
) -> RunResult | None:
    """Run the program with commands from a generator; the stops so far are in its list."""
    stops: list[Stop] = []

    def client(debugger: Debugger, stop: Stop) -> Command:
        stops.append(stop)
        if not left:
            left.append(commands(debugger, stops))
        return next(left[0], Go())

    left: list[Commands] = []
    debugger = Debugger(PROGRAM, client)
    setup = RunSetup(executor=executor, submit="SPS", script=SCRIPT)
    return debugger.run(lambda: run_program(PREPARED, setup, debugger=debugger))


def state(debugger: Debugger) -> Any:
    """All that a program and the arm show."""
    texts = ("TOTAL", "$OUT[1]", "$OUT[4]", "$IN[1]", "$FLAG[1]", "$AXIS_ACT", "$TIMER[1]")
    frames = [(task, debugger.frames(task)) for task in debugger.tasks]
    values = [debugger.value(text) for text in texts]
    outer = len(debugger.frames()) - 1
    values += [debugger.look(text, "robot", outer) for text in ("I", "A")]
    is_begun = debugger.frames("submit")[0].at.line > 1
    return frames, values, debugger.arm, debugger.look("K", "submit") if is_begun else None


def trace(result: RunResult | None) -> list[str]:
    """A run as lines."""
    assert result is not None
    return [event.line() for event in result.events]


@pytest.fixture(scope="module")
def plain() -> list[str]:
    """The trace of the run without a debugger."""
    return trace(run_program(PREPARED, RunSetup(submit="SPS", script=SCRIPT)))


@pytest.mark.skipif(available()[-1] != "native", reason="the machine in C was not built")
@pytest.mark.parametrize("executor", ["native", "compiled"])
def test_only_lines_with_breakpoints_are_looked_at(
    executor: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Forwards and back, the machine in C stops at them and at the ends of slices alone."""
    text = "DEF MAIN()\nINT I\nFOR I=1 TO 9000\n;\nI=I+1-1\nENDFOR\n;\nI=7\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    stops: list[tuple[str, int]] = []
    looks = 0

    def client(debugger: Debugger, stop: Stop) -> Command:
        stops.append((stop.reason, stop.at.line))
        places = [Breakpoint("main.src", 5, condition="I==50"), Breakpoint("main.src", 8)]
        debugger.breakpoints.set(places)
        if len(stops) == 3:
            return Back("go")
        return Go() if len(stops) < 6 else Quit()

    begins = Debugger.begins

    def counted(self: Debugger, executor: Any) -> int | None:
        nonlocal looks
        looks += 1
        return begins(self, executor)

    monkeypatch.setattr(Debugger, "begins", counted)
    debugger, setup = Debugger(program, client), RunSetup(executor=executor)
    debugger.run(lambda: run_program(program, setup, debugger=debugger))
    breakpoints = [("breakpoint", 5), ("breakpoint", 8)]
    assert [("entry", 3), *breakpoints, *breakpoints, ("ended", 8)] == stops
    assert looks < 150


_LOOKED_AT = """DEF MAIN()
DECL INT I
FOR I=-1 TO 3
WORK(I, I)
ENDFOR
END
DEF WORK(GIVEN:IN, REF:OUT)
DECL INT GIVEN, REF, A[2], NONE
DECL T S
DECL MODES MODE
BOOL IS_ODD
A[2] = GIVEN
S.N = GIVEN
SHARED = GIVEN
MODE = #BUSY
IF GIVEN > 0 THEN
MODE = #IDLE
ENDIF
IS_ODD = (GIVEN B_AND 1) == 1
"""
_LISTED = """DEFDAT MAIN
STRUC T INT N
ENUM MODES IDLE, BUSY
DECL INT SHARED=5
SIGNAL OUT $OUT[1]
ENDDAT
"""


def test_conditions_hold_in_the_same_passes() -> None:
    """Whoever looks at the condition of a breakpoint, it holds where the reference says."""
    names = ["GIVEN", "REF", "A[2]", "A[1]", "S.N", "MODE", "IS_ODD", "NONE", "SHARED", "OUT", "NO"]
    sides = product(
        names, ("==", "<>", "<", ">", "<=", ">="), ("1", "3.0", "TRUE", "#IDLE", "GIVEN")
    )
    breakpoints = [
        Breakpoint("main.src", line, condition=" ".join(side), log=f"{line} {{GIVEN}}")
        for line, side in enumerate(sides, _LOOKED_AT.count("\n") + 1)
    ]
    text = _LOOKED_AT + "A[2] = GIVEN\n" * len(breakpoints) + "END\n"
    program = load([Source(text, "main.src"), Source(_LISTED, "main.dat")], "main.src")

    def client(debugger: Debugger, _stop: Stop) -> Command:
        debugger.breakpoints.set(breakpoints)
        return Go()

    logs: dict[str, list[str]] = {executor: [] for executor in available()}
    for executor, log in logs.items():
        debugger, setup = Debugger(program, client, log.append), RunSetup(executor=executor)
        debugger.run(partial(run_program, program, setup, debugger=debugger))
    assert len(available()) * [logs["tree"]] == list(logs.values())


@settings(max_examples=5)
@given(there=st.integers(0, 40), back=st.integers(1, 4), executor=st.sampled_from(available()))
def test_back_and_forward_is_nowhere(
    there: int, back: int, executor: str, plain: list[str]
) -> None:
    """As many steps back as forward: all is as it was, and the trace that of a plain run."""

    def commands(debugger: Debugger, stops: list[Stop]) -> Commands:
        for _ in range(there):
            yield StepCommand("into")
        seen = [state(debugger)]
        for _ in range(back):
            yield StepCommand("into")
            seen.append(state(debugger))
        for before in reversed(seen[:-1]):
            yield Back("into")
            assert before == state(debugger)
        for after in seen[1:]:
            yield StepCommand("into")
            assert after == state(debugger)
        assert not [one for one in stops if one.reason == "refused"]

    assert plain == trace(debugged(commands, executor))


@pytest.mark.parametrize("executor", available())
def test_going_back_out_of_calls_and_motions(executor: str) -> None:
    """Over goes back past a call, out to the call, by motion to before the end of the last one."""

    def commands(debugger: Debugger, stops: list[Stop]) -> Commands:
        debugger.breakpoints.set([Breakpoint("main.src", 26, "N==3")])
        yield Go()
        assert ["FAC", "MAIN"] == [one.name for one in debugger.frames()]
        yield Back("out")
        assert (11, 3) == (stops[-1].at.line, debugger.value("I"))
        yield Back("over")
        assert (10, 2) == (stops[-1].at.line, debugger.value("I"))
        yield Back("over")
        assert 12 == stops[-1].at.line
        assert 3 == debugger.arm.ended
        yield Back("motion")
        assert 2 == debugger.arm.ended
        yield StepCommand("motion")
        assert 3 == debugger.arm.ended
        yield Quit()

    assert debugged(commands, executor) is None


def test_going_back_to_breakpoints_and_changes() -> None:
    """Breakpoints and watches are met backwards in the other order, then the first statement."""

    def commands(debugger: Debugger, stops: list[Stop]) -> Commands:
        debugger.breakpoints.set([Breakpoint("main.src", 11), Breakpoint("main.src", 15, hits="2")])
        debugger.watches.add("TOTAL")
        for _ in range(6):
            yield Go()
        there = [(one.reason, one.at.line) for one in stops[1:]]
        assert ("breakpoint", 11) == there[0]
        assert 6 == sum(reason in ("breakpoint", "watch") for reason, _ in there)
        for place in reversed([one.at.line for one in stops[:6]]):
            yield Back("go")
            assert place == stops[-1].at.line
        yield Back("go")
        assert "refused" == stops[-1].reason
        yield Quit()

    debugged(commands)


def test_changes_are_made_again_at_their_moments(plain: list[str]) -> None:
    """What was assigned is undone by going back behind it, and comes again forwards."""

    def commands(debugger: Debugger, _stops: list[Stop]) -> Commands:
        debugger.breakpoints.set([Breakpoint("main.src", 14)])
        yield StepCommand()
        debugger.assign("TOTAL", "40+2")
        debugger.assign("DOOR", "TRUE")
        debugger.assign("$VEL_AXIS[1]", "50")
        yield Back()
        assert [0, False, 100] == [debugger.value(one) for one in ("TOTAL", "DOOR", "$VEL_AXIS[1]")]
        yield Go()
        assert [42, True, 50] == [debugger.value(one) for one in ("TOTAL", "DOOR", "$VEL_AXIS[1]")]
        yield Restart()
        yield StepCommand()
        assert 0 == debugger.value("TOTAL")

    assert plain == trace(debugged(commands))


def test_a_change_in_the_past_ends_what_was_changed_later() -> None:
    """Behind a new change the old ones are not made again."""

    def commands(debugger: Debugger, _stops: list[Stop]) -> Commands:
        yield StepCommand()
        yield StepCommand()
        debugger.assign("TOTAL", "7")
        yield Back()
        debugger.assign("$OUT[9]", "TRUE")
        yield StepCommand()
        assert [0, True] == [debugger.value("TOTAL"), debugger.value("$OUT[9]")]
        yield Quit()

    debugged(commands)


def test_going_back_behind_a_selection_undoes_it() -> None:
    """The statements that were skipped are executed then."""

    def commands(_debugger: Debugger, stops: list[Stop]) -> Commands:
        yield Select(6)
        yield StepCommand()
        assert 7 == stops[-1].at.line
        yield Back()
        assert ("back", 6) == (stops[-1].reason, stops[-1].at.line)
        yield Back()
        assert 3 == stops[-1].at.line
        yield StepCommand()
        assert 4 == stops[-1].at.line
        yield Quit()

    debugged(commands)


def test_a_fault_stops_and_can_be_left_backwards() -> None:
    """At a fault all can be looked at; what led to it can be changed before it."""

    def commands(debugger: Debugger, stops: list[Stop]) -> Commands:
        yield StepCommand()
        debugger.assign("$ADVANCE", "3")
        with pytest.raises(LinkError):
            debugger.assign("NOWHERE", "3")
        debugger.breakpoints.set([Breakpoint("main.src", 14)])
        yield Go()
        debugger.assign("A[4]", "2147483647")
        debugger.assign("TOTAL", "1")
        yield Go()
        assert ("fault", 14, 2147483647) == (
            *(stops[-1].reason, stops[-1].at.line),
            debugger.value("A[4]"),
        )
        yield Back()
        assert ("back", 14) == (stops[-1].reason, stops[-1].at.line)
        debugger.assign("TOTAL", "0")
        yield Go()
        assert "ended" == stops[-1].reason
        assert "end after" in stops[-1].text

    result = debugged(commands)
    assert result is not None
    assert "end" == result.outcome.ending


def test_frames_name_what_interrupts() -> None:
    """The stack goes through the action of an interrupt to what it interrupted."""

    def commands(debugger: Debugger, _stops: list[Stop]) -> Commands:
        debugger.breakpoints.set([Breakpoint("main.src", 18)])
        yield Go()
        names = [one.name for one in debugger.frames()]
        assert ["ACTION", "interrupt 5 in MAIN", "MAIN"] == names
        assert [18, 3] == [one.at.line for one in debugger.frames()][:2]
        assert ["I", "A"] == list(debugger.names("robot", 2).local)
        assert 0 == debugger.value("TOTAL")
        yield Quit()

    debugged(commands)


def test_texts_of_breakpoints_that_only_report() -> None:
    """Values stand in place of what is in braces; nothing stops, and nothing is told twice."""
    told: list[str] = []

    def client(_debugger: Debugger, stop: Stop) -> Command:
        return Back("go") if stop.reason == "ended" and len(told) == 4 else Go()

    debugger = Debugger(PROGRAM, client, told.append)
    debugger.breakpoints.set([Breakpoint("main.src", 12, log="A[{I}]={A[I]} {NO}")])
    setup = RunSetup(executor=available()[-1], submit="SPS", script=SCRIPT)
    debugger.run(lambda: run_program(PREPARED, setup, debugger=debugger))
    once = [f"A[{i}]={fac} (NO is not known here)" for i, fac in enumerate((1, 2, 6, 24), 1)]
    assert [*once, *once] == told  # once more behind the way back to the first statement


def test_a_program_without_statements_only_ends() -> None:
    """There is nothing to go back to, which is no reason to look for it for ever."""
    program = load([Source("DEF MAIN()\nEND\n", "main.src")], "main.src")
    commands: list[Command] = [Back("into"), Back("go"), Restart()]
    stops: list[str] = []

    def client(_debugger: Debugger, stop: Stop) -> Command:
        stops.append(stop.reason)
        return commands.pop() if commands else Go()

    debugger = Debugger(program, client)
    debugger.run(lambda: run_program(Prepared(program), RunSetup(), debugger=debugger))
    assert ["ended"] * 4 == stops
