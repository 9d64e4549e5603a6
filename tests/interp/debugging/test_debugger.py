"""Debugging: the same stops, steps, watches and jumps on every executor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, cast

import pytest

from conformance.differential.random_world import QuietWorld
from grammar.semantics.types import UNKNOWN
from grammar.syntax.source import Source
from interp.controller.controller import ArmState
from interp.debugging.client import Breakpoint, Command, Go, Select, StepCommand, Stop, Watch
from interp.debugging.debugger import Debugger
from interp.executors import Prepared
from interp.native import AVAILABLE
from interp.port.events import Recorder, Sink
from interp.port.inspection import Inspectable
from interp.port.requests import DeclareInterrupt, End, Fail, Request, Slice, Wait, Write
from interp.program.load import CheckedProgram, Limits, Routine, Unit, load
from interp.program.statement_paths import routine_at
from interp.values.faults import LinkError

EXECUTORS = ("tree", "vm", *(["native"] if AVAILABLE else []))

MAIN = """\
DEF MAIN()
  INT I,A[3]
  FRAME F
  I=1
  A[1]=10
  A[2]=20
  F={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}
  TWICE(I)
  IF I==2 THEN
    F.X=5.5
  ELSE
    F.X=6.5
  ENDIF
  WHILE I<5
    I=I+1
    TOTAL=TOTAL+I
  ENDWHILE
  FOR I=1 TO 3
    A[I]=I
  ENDFOR
  I=HALF(I)
  $OUT[1]=TRUE
END
DEF TWICE(N:OUT)
  INT N,K
  K=N
  N=K*2
END
DEFFCT INT HALF(N:IN)
  INT N
  IF N>2 THEN
    RETURN N/2
  ENDIF
  RETURN N
ENDFCT
"""
DATA = "DEFDAT MAIN\nINT TOTAL=0\nENDDAT\n"


@dataclass
class Script:
    """A client that answers with commands in turn, and goes on when it has none left."""

    commands: list[Any]
    stops: list[Stop] = field(default_factory=list)
    seen: list[Any] = field(default_factory=list)

    def __call__(self, debugger: Debugger, stop: Stop) -> Command:
        """The next command, behind all that only looks; the end is no stop here."""
        if stop.reason == "ended":
            return Go()
        self.stops.append(stop)
        while self.commands:
            command = self.commands.pop(0)
            if callable(command):
                self.seen.append(command(debugger))
            else:
                assert isinstance(command, Go | StepCommand | Select)
                return command
        return Go()

    @property
    def lines(self) -> list[int]:
        """The lines of all stops."""
        return [one.at.line for one in self.stops]

    @property
    def reasons(self) -> list[str]:
        """Why it stopped."""
        return [one.reason for one in self.stops]


@dataclass
class World:
    """What a debugger asks of the controller."""

    stub: QuietWorld
    arm: ArmState = field(default_factory=lambda: ArmState(0, None, 0, 0))

    def look(self, path: Any) -> Any:
        """The value of a system variable."""
        return self.stub.read(path)

    def assign(self, path: Any, value: Any) -> None:
        """Nothing is assigned here."""

    def type_of(self, _path: Any) -> Any:
        """Types are not known here."""
        return UNKNOWN

    def levels(self, _task: str) -> Any:
        """Nothing is known of interrupts here."""
        return []


def make_of(name: str, program: CheckedProgram) -> Callable[[Limits, Sink | None], Inspectable]:
    """Makes an executor of a program."""
    return cast("Callable[..., Inspectable]", partial(Prepared(program).executor, name))


def program_of(text: str, data: str = "") -> CheckedProgram:
    """A program of one module."""
    sources = [Source(text, "main.src")]
    return load(sources + ([Source(data, "main.dat")] if data else []), "main.src")


def driven(executor: Any, world: QuietWorld) -> list[Request]:
    """All requests to the end."""
    found: list[Request] = []
    reply: Any = None
    while not found or not isinstance(found[-1], End | Fail):
        found.append(executor.advance(reply))
        reply = world.reply(found[-1])
        assert len(found) < 1000
    return found


@pytest.fixture(params=EXECUTORS)
def debug(request: pytest.FixtureRequest) -> Callable[..., tuple[Script, list[Request]]]:
    """Runs a program under a debugger with the commands given, on each executor."""

    def ran(*commands: Any, text: str = MAIN, data: str = DATA) -> tuple[Script, list[Request]]:
        program = program_of(text, data if text is MAIN else "")
        script, world = Script(list(commands)), QuietWorld()
        make = make_of(request.param, program)
        debugger = Debugger(program, script)
        debugger.attach(World(world))  # type: ignore[arg-type]  # has what is asked here
        inside = make(Limits(), None)
        requests = debugger.run(lambda: driven(debugger.around(inside, 1000), world))
        assert requests is not None
        return script, requests

    return ran


# ------------------------------------------------------------------------------- transparency


@pytest.mark.parametrize("name", EXECUTORS)
@pytest.mark.parametrize("per_slice", [1, 3, 1000])
def test_a_program_does_the_same_under_a_debugger(name: str, per_slice: int) -> None:
    """Requests, slices among them, and events are those of a run without a debugger."""
    program, limits = program_of(MAIN, DATA), Limits(per_slice=per_slice)
    make = make_of(name, program)
    alone, debugged = Recorder(), Recorder()
    expected = driven(make(limits, alone), QuietWorld())
    script = Script([StepCommand("into")] * 20)
    debugger = Debugger(program, script)
    inside = make(limits, debugged)
    found = debugger.run(lambda: driven(debugger.around(inside, per_slice), QuietWorld()))
    assert found is not None
    assert expected == found
    assert alone.events == debugged.events
    assert any(isinstance(one, Slice) for one in expected) == (per_slice < 1000)
    assert len(script.stops) == 21


# ------------------------------------------------------------------------------- breakpoints


def test_condition_of_a_breakpoint(debug: Any) -> None:
    """A breakpoint with a condition stops only where it is TRUE."""
    set_one = Breakpoint("MAIN.SRC", 16, "(I==4) AND (F.X>5.0) AND NOT (A[1]==A[2])")
    script, _ = debug(lambda debugger: debugger.breakpoints.set([set_one]))
    assert [4, 16] == script.lines


def test_condition_that_means_nothing_stops_and_says_so(debug: Any) -> None:
    """A condition that cannot be evaluated counts as TRUE, and the reason is told."""
    set_one = Breakpoint("main.src", 22, "NOWHERE==1")
    script, _ = debug(lambda debugger: debugger.breakpoints.set([set_one]))
    assert [4, 22] == script.lines
    assert "NOWHERE is not known here" == script.stops[1].text


def test_lines_at_which_a_program_can_stop(debug: Any) -> None:
    """Statements, not declarations and ends of blocks; a REPEAT at its UNTIL too."""
    script, _ = debug(lambda debugger: debugger.breakpoints.lines("main.src"))
    expected = (4, 5, 6, 7, 8, 9, 10, 12, 14, 15, 16, 18, 19, 21, 22, 26, 27, 31, 32, 34)
    assert [expected] == script.seen
    text = "DEF MAIN()\nINT I\nI=0\nREPEAT\nI=I+1\nUNTIL I>1\nEND\n"
    script, _ = debug(
        lambda debugger: debugger.breakpoints.lines("main.src"), *[StepCommand()] * 9, text=text
    )
    assert [(3, 4, 5, 6)] == script.seen
    assert [3, 4, 5, 6, 5, 6] == script.lines


# ------------------------------------------------------------------------------- steps


def test_a_routine_is_found_without_a_look_at_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """Finding the routine of a frame again and again lists the routines of a file once."""
    program = program_of("DEF MAIN()\nEND\n" + "".join(f"DEF B{n}()\nEND\n" for n in range(30)))
    listed: list[Unit] = []
    routines_of = CheckedProgram.routines_of

    def counted(self: CheckedProgram, unit: Unit) -> tuple[Routine, ...]:
        listed.append(unit)
        return routines_of(self, unit)

    monkeypatch.setattr(CheckedProgram, "routines_of", counted)
    path = program.main.module.path
    found = [routine_at(program, path, f"B{n}") for n in range(30)]
    assert [f"B{n}" for n in range(30)] == [one.name for one in found if one is not None]
    assert len(listed) == len(program.units)


def test_frames_tell_who_called_from_where(debug: Any) -> None:
    """The routines that are open are told from the innermost outwards, each with its place."""
    script, _ = debug(
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 27)]),
        Go(),
        lambda debugger: [(one.name, one.at.line) for one in debugger.frames()],
    )
    assert [[("TWICE", 27), ("MAIN", 8)]] == script.seen[1:]


# ------------------------------------------------------------------------------- looking


def test_values_where_a_program_has_stopped(debug: Any) -> None:
    """Variables, members, elements, data lists, system variables and expressions can be seen."""
    texts = ("I", "A[2]", "A[I+1]", "F.Z", "TOTAL", "$OUT[1]", "(I+1)*2", "A[1]>A[2]")
    script, _ = debug(
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 8)]),
        Go(),
        lambda debugger: [debugger.value(text) for text in texts],
    )
    assert [[1, 20, 20, 3.0, 0, False, 4, False]] == script.seen[1:]


def test_what_is_seen_is_the_present_routine(debug: Any) -> None:
    """Names mean what they mean where the program is: the caller's variables are not visible."""

    def tried(debugger: Debugger) -> str:
        with pytest.raises(LinkError) as raised:
            debugger.value("A[1]")
        return f"{debugger.value('N')} {raised.value}"

    script, _ = debug(*[StepCommand("into")] * 5, tried)
    assert ["1 A[1] is not known here"] == script.seen


def test_watch_stops_where_a_value_has_changed(debug: Any) -> None:
    """A watch on a member stops before the statement behind the change, with both values."""

    def watching(debugger: Debugger) -> None:
        debugger.watches.add("F.X")

    script, _ = debug(watching)
    found = [(one.at.line, one.watch, one.before, one.now) for one in script.stops[1:]]
    assert [(8, Watch("F.X"), None, 1.0), (14, Watch("F.X"), 1.0, 5.5)] == found


def test_watch_on_data_of_a_data_list(debug: Any) -> None:
    """Data of a data list is watched in every routine of the module."""
    script, _ = debug(lambda debugger: debugger.watches.add("TOTAL"))
    assert [3, 7, 12] == [one.now for one in script.stops[1:]]


def test_watch_on_local_data_is_of_its_activation(debug: Any) -> None:
    """A change by reference is seen back in the routine; a name of a callee is another variable."""
    script, _ = debug(
        StepCommand(),
        lambda debugger: debugger.watches.add("I"),
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 27)]),
    )
    assert [("breakpoint", 27), ("watch", 9)] == [
        (one.reason, one.at.line) for one in script.stops[2:4]
    ]
    assert [2, 3, 4, 5] == [one.now for one in script.stops[3:7]]


# ------------------------------------------------------------------------------- block selection


def test_selection_skips_statements(debug: Any) -> None:
    """What lies between the present statement and the one selected is not executed."""
    script, requests = debug(Select(22), lambda debugger: debugger.value("TOTAL"))
    assert [("entry", 4), ("selected", 22)] == [(one.reason, one.at.line) for one in script.stops]
    assert [0] == script.seen
    assert [("$OUT", 1)] == [one.path for one in requests if isinstance(one, Write)]


def test_selection_goes_back(debug: Any) -> None:
    """A line that was passed can be selected: its statements are executed once more."""
    script, _ = debug(
        *[StepCommand()] * 4,
        Select(4),
        *[StepCommand()] * 4,
        StepCommand(),
        lambda debugger: debugger.value("I"),
    )
    assert [4, 5, 6, 7, 8, 4, 5, 6, 7, 8, 9] == script.lines
    assert [2] == script.seen


@pytest.mark.parametrize("line", [10, 12, 15])
def test_selection_enters_blocks(debug: Any, line: int) -> None:
    """A statement within IF, ELSE or a loop can be selected; no condition is looked at."""
    script, _ = debug(StepCommand(), Select(line), StepCommand())
    assert [4, 5, line] == script.lines[:3]
    assert ({10: 14, 12: 14, 15: 16}[line]) == script.lines[3]


def test_loop_entered_by_selection_goes_on_as_a_loop(debug: Any) -> None:
    """Behind its last statement a loop that was entered tests its condition."""
    script, _ = debug(
        StepCommand(),
        Select(16),
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 16)]),
    )
    assert [16, 16, 16, 16, 16] == script.lines[2:]


def test_selection_out_of_a_loop(debug: Any) -> None:
    """The loop around the present statement is left."""
    script, _ = debug(
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 19)]),
        Go(),
        Select(5),
        StepCommand(),
    )
    assert [4, 19, 5, 6] == script.lines[:4]


def test_selection_within_a_for(debug: Any) -> None:
    """Inside a FOR that has begun, its statements can be selected."""
    script, _ = debug(
        lambda debugger: debugger.breakpoints.set([Breakpoint("main.src", 19)]),
        Go(),
        Select(19),
        lambda debugger: debugger.value("I"),
        Go(),
        lambda debugger: debugger.value("I"),
    )
    assert [1, 2] == script.seen[1:]


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (19, "line 19 is inside the FOR of line 18, which has not begun"),
        (26, "no statement of MAIN begins in line 26"),
        (13, "no statement of MAIN begins in line 13"),
    ],
)
def test_selection_that_is_refused(debug: Any, line: int, text: str) -> None:
    """The program stays where it is, and the client is told why."""
    script, _ = debug(Select(line))
    assert [("entry", 4), ("refused", 4)] == [(one.reason, one.at.line) for one in script.stops]
    assert text == script.stops[1].text


# ------------------------------------------------------------------------------- interrupts

INTERRUPTED = """\
DEF MAIN()
  INTERRUPT DECL 5 WHEN $IN[1] DO ACTION()
  WAIT SEC 1
  $OUT[2]=TRUE
  $OUT[3]=TRUE
END
DEF ACTION()
  $OUT[9]=TRUE
END
"""


@pytest.mark.parametrize(("way", "lines"), [("over", [2, 3, 4]), ("into", [2, 3, 2, 8, 4])])
@pytest.mark.parametrize("name", EXECUTORS)
def test_steps_and_actions(name: str, way: Any, lines: list[int]) -> None:
    """An action that comes up meanwhile is stepped over, or into."""
    program, world = program_of(INTERRUPTED), QuietWorld()
    script = Script([StepCommand(way)] * (len(lines) - 1))
    stops = Debugger(program, script)
    debugger = stops.around(make_of(name, program)(Limits(), None), 1000)
    action = None
    reply: Any = None
    is_done = False
    asked: list[str] = []
    for _ in range(30):
        request = debugger.advance(reply)
        asked.append(type(request).__name__)
        reply = world.reply(request)
        if isinstance(request, DeclareInterrupt):
            action = request.action
        if isinstance(request, Wait) and not is_done:
            assert action is not None
            debugger.enter(action)
            reply, is_done = None, True
        if isinstance(request, End) and asked.count("End") == 2:
            break
    assert lines == script.lines
    assert ["DeclareInterrupt", "Wait", "Write", "End", "Wait", "Write", "Write", "End"] == asked


def test_the_example_of_the_documentation(capsys: pytest.CaptureFixture[str]) -> None:
    """It works as it stands: a breakpoint, a value, a step back."""
    text = (Path(__file__).parents[3] / "docs/debugging.md").read_text(encoding="utf-8")
    exec(text.partition("```python\n")[2].partition("```")[0], {})
    expected = ["entry 3", "breakpoint 4", "8", "back 3", "6"]
    assert expected == [line.partition(" [")[0] for line in capsys.readouterr().out.splitlines()]
