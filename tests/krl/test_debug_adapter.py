"""The debug adapter, driven over the wire by a client of its protocol."""

from __future__ import annotations

import contextlib
import json
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import Any, BinaryIO, cast

import pytest

from krl.debug_adapter.adapter import Adapter
from krl.debug_adapter.connection import Connection
from krl.running.run_options import RunOptions

MAIN = """\
DEF MAIN()
  INT I,A[300],B[2,2]
  FRAME F
  INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO ACTION()
  INTERRUPT ON 5
  PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  PTP {A1 10.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  F={X 1.0,Y 2.0}
  B[2,1]=7
  FOR I=1 TO 4
    A[I]=FAC(I)
  ENDFOR
  WAIT FOR DOOR
  $OUT[1]=TRUE
  I=A[4]/NOTHING
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
DATA = "DEFDAT MAIN\nINT TOTAL=0\nINT NOTHING=0\nSIGNAL DOOR $IN[1]\nENDDAT\n"
SUBMIT = "DEF SPS()\nINT K\nK=0\nLOOP\nK=K+1\nWAIT SEC 0.1\nENDLOOP\nEND\n"


class Client:
    """The other end: sends requests, keeps the events that come meanwhile."""

    def __init__(self, source: BinaryIO, target: BinaryIO) -> None:
        self._source = source
        self._target = target
        self._sent = 0
        self.events: list[dict[str, Any]] = []
        self.said: list[str] = []

    def ask(self, command: str, **arguments: Any) -> dict[str, Any]:
        """The response, whether it is a success or not."""
        self._sent += 1
        message = {"seq": self._sent, "type": "request", "command": command, "arguments": arguments}
        data = json.dumps(message).encode()
        self._target.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
        self._target.flush()
        while True:
            found = self._next()
            if found["type"] == "response":
                assert (self._sent, command) == (found["request_seq"], found["command"])
                return found
            self.events.append(found)

    def do(self, command: str, **arguments: Any) -> Any:
        """The body of the response to a request that succeeds."""
        found = self.ask(command, **arguments)
        assert found["success"], found
        return found.get("body")

    def wait(self, event: str) -> dict[str, Any]:
        """The body of the next event of a name."""
        while True:
            for place, one in enumerate(self.events):
                if one["event"] == event:
                    del self.events[: place + 1]
                    found: dict[str, Any] = one["body"]
                    return found
            self.events.append(self._next())
            # nothing comes behind this one, and one would wait for ever
            assert event == "terminated" or self.events[-1]["event"] != "terminated", self.events

    def stopped(self, command: str, **arguments: Any) -> tuple[str, int]:
        """Why and at which line it stops behind a command."""
        self.do(command, **arguments)
        event = self.wait("stopped")
        frames = self.do("stackTrace", threadId=event["threadId"])["stackFrames"]
        return event["reason"], frames[0]["line"]

    def variables(self, scope: str, frame: int | None = None) -> dict[str, dict[str, Any]]:
        """Those of a scope by name."""
        if frame is None:
            frame = self.do("stackTrace", threadId=1)["stackFrames"][0]["id"]
        scopes = {one["name"]: one for one in self.do("scopes", frameId=frame)["scopes"]}
        reference = scopes[scope]["variablesReference"]
        return {
            one["name"]: {**one, "of": reference}
            for one in self.do("variables", variablesReference=reference)["variables"]
        }

    def _next(self) -> dict[str, Any]:
        length = int(self._source.readline().partition(b":")[2])
        assert self._source.readline() == b"\r\n"
        found: dict[str, Any] = json.loads(self._source.read(length))
        if found.get("event") == "output":
            self.said.append(found["body"]["output"])
        return found


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A program with a data list and a submit; the path of its file."""
    for name, text in (("main.src", MAIN), ("main.dat", DATA), ("sps.sub", SUBMIT)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path / "main.src"


@pytest.fixture
def client() -> Iterator[Client]:
    """A client of an adapter that serves a socket."""
    ours, theirs = socket.socketpair()
    there = cast(BinaryIO, theirs.makefile("rwb"))
    thread = Thread(target=Adapter(Connection(there, there), None, RunOptions()).serve)
    thread.start()
    here = cast(BinaryIO, ours.makefile("rwb"))
    yield Client(here, here)
    here.close()
    ours.close()
    thread.join()
    with contextlib.suppress(BrokenPipeError):  # the client goes as it likes
        there.close()
    theirs.close()


def begun(client: Client, project: Path, *breakpoints: Any, **launch: Any) -> list[Any]:
    """Begin a session with breakpoints in the main file; gives what became of them."""
    assert client.do("initialize", adapterID="krl")["supportsStepBack"]
    client.do("launch", program=str(project), **launch)
    client.wait("initialized")
    source = {"path": str(project)}
    found = client.do("setBreakpoints", source=source, breakpoints=list(breakpoints))
    client.do("setExceptionBreakpoints", filters=["faults"])
    client.do("configurationDone")
    return list(found["breakpoints"])


def test_a_session_forwards_and_back(client: Client, project: Path) -> None:
    """Breakpoints with conditions, steps, the stack, and the same backwards with the variables."""
    where = begun(client, project, {"line": 26, "condition": "N==3"}, {"line": 12}, {"line": 99})
    assert [(True, 26), (True, 13), (False, None)] == [
        (one["verified"], one.get("line")) for one in where
    ]
    assert "breakpoint" == client.wait("stopped")["reason"]
    frames = client.do("stackTrace", threadId=1)
    assert [("FAC", 26), ("MAIN", 11)] == [(f["name"], f["line"]) for f in frames["stackFrames"]]
    assert [("FAC", 26)] == [
        (f["name"], f["line"]) for f in client.do("stackTrace", threadId=1, levels=1)["stackFrames"]
    ]
    assert str(project) == frames["stackFrames"][0]["source"]["path"]
    assert "3" == client.do("evaluate", expression="N", context="hover")["result"]
    outer = frames["stackFrames"][1]["id"]
    assert "3" == client.variables("Locals", outer)["I"]["value"]
    assert ("step", 23) == client.stopped("stepIn", threadId=1)
    assert "2" == client.do("evaluate", expression="N")["result"]
    assert ("step", 26) == client.stopped("stepBack", threadId=1)
    assert ("step", 10) == client.stopped("stepOut", threadId=1)
    assert ("step", 11) == client.stopped("stepBack", threadId=1)
    assert "3" == client.do("evaluate", expression="I")["result"]
    assert ("step", 10) == client.stopped("stepBack", threadId=1)
    assert ("breakpoint", 26) == client.stopped("continue", threadId=1)
    assert ("step", 4) == client.stopped("reverseContinue", threadId=1)
    client.do("disconnect")


@pytest.mark.parametrize(("is_stopping", "reason"), [(False, "breakpoint"), (True, "entry")])
def test_the_first_statement(client: Client, project: Path, is_stopping: bool, reason: str) -> None:
    """A breakpoint at it stops like any other; a stop at the entry stands for both."""
    begun(client, project, {"line": 4}, {"line": 8}, stopOnEntry=is_stopping)
    assert reason == client.wait("stopped")["reason"]
    assert 4 == client.do("stackTrace", threadId=1)["stackFrames"][0]["line"]
    assert ("breakpoint", 8) == client.stopped("continue", threadId=1)
    client.do("disconnect")


def test_variables_are_trees_that_can_be_changed(client: Client, project: Path) -> None:
    """Structures and arrays open, long arrays by pages; members, inputs and data can be set."""
    begun(client, project, {"line": 13})
    client.wait("stopped")
    found = client.variables("Locals")
    assert "{X 1.0, Y 2.0}" == found["F"]["value"]
    members = client.do("variables", variablesReference=found["F"]["variablesReference"])
    assert [("X", "1.0", "F.X"), ("Y", "2.0", "F.Y")] == [
        (one["name"], one["value"], one["evaluateName"]) for one in members["variables"][:2]
    ]
    assert 300 == found["A"]["indexedVariables"]
    reference = found["A"]["variablesReference"]
    page = client.do("variables", variablesReference=reference, start=2, count=2)["variables"]
    assert [("[3]", "6"), ("[4]", "24")] == [(one["name"], one["value"]) for one in page]
    rows = client.do("variables", variablesReference=found["B"]["variablesReference"])
    assert ["[1,1]", "[1,2]", "[2,1]", "[2,2]"] == [one["name"] for one in rows["variables"]]
    assert "7" == rows["variables"][2]["value"]
    set_one = client.do("setVariable", variablesReference=reference, name="[4]", value="20+5")
    assert "25" == set_one["value"]
    assert "25" == client.do("evaluate", expression="A[4]")["result"]
    data = client.variables("Data list")
    assert ["TOTAL", "NOTHING"] == list(data)
    total = data["TOTAL"]["of"]
    refused = client.ask("setVariable", variablesReference=total, name="TOTAL", value="NO+1")
    assert "NO is not known here" == refused["message"]
    assert "FALSE" == client.variables("Signals")["DOOR"]["value"]
    assert "2.5" == client.do("setExpression", expression="F.X", value="2.5")["value"]
    assert "TRUE" == client.do("evaluate", expression="DOOR = TRUE", context="repl")["result"]
    assert "FALSE" == client.do("evaluate", expression="F.X <= 1", context="repl")["result"]
    assert "{X " in client.variables("System")["$POS_ACT"]["value"]


def test_data_breakpoints_and_faults(client: Client, project: Path) -> None:
    """A change stops with both values, a fault with its text, from where one goes back."""
    begun(client, project, stopOnEntry=True)
    assert "entry" == client.wait("stopped")["reason"]
    of = {name: client.variables(name) for name in ("Data list", "Signals")}
    wanted = [
        client.do("dataBreakpointInfo", name=name, variablesReference=of[scope][name]["of"])
        for scope, name in (("Data list", "TOTAL"), ("Signals", "DOOR"))
    ]
    found = client.do("setDataBreakpoints", breakpoints=wanted)
    assert [True, True] == [one["verified"] for one in found["breakpoints"]]
    client.do("evaluate", expression="DOOR=TRUE", context="repl")
    client.do("continue", threadId=1)
    assert "DOOR: FALSE -> TRUE" == client.wait("stopped")["description"]
    client.do("continue", threadId=1)
    stop = client.wait("stopped")
    if stop["reason"] == "data breakpoint":
        assert "TOTAL: 0 -> 1" == stop["description"]
        client.do("continue", threadId=1)
        stop = client.wait("stopped")
    assert ("exception", "division by zero") == (stop["reason"], stop["description"])
    assert "division by zero" == client.do("exceptionInfo", threadId=1)["description"]
    assert ("step", 15) == client.stopped("stepBack", threadId=1)
    client.do("evaluate", expression="NOTHING=2", context="repl")
    client.do("continue", threadId=1)
    assert 0 == client.wait("exited")["exitCode"]
    client.wait("terminated")


def test_programs_and_the_arm_are_threads(client: Client, project: Path) -> None:
    """The submit has a stack of its own; the arm is in the motion of the main run."""
    begun(client, project, {"line": 8}, submit="SPS")
    client.wait("stopped")
    names = [one["name"] for one in client.do("threads")["threads"]]
    assert ["robot", "submit", "arm (main run)"] == names
    arm = client.do("stackTrace", threadId=3)["stackFrames"]
    assert [("motion under way", 7)] == [(one["name"], one["line"]) for one in arm]
    assert "SPS" == client.do("stackTrace", threadId=2)["stackFrames"][0]["name"]
    assert ("step", 3) == client.stopped("next", threadId=2)
    assert ("step", 4) == client.stopped("next", threadId=2)
    assert ("step", 3) == client.stopped("stepBack", threadId=2)
    (main,) = client.do("gotoTargets", source={"path": str(project)}, line=5)["targets"]
    assert ("step", 3) == client.stopped("goto", threadId=1, targetId=main["id"])
    assert "the submit has stopped here: a line can be selected in it alone\n" == client.said[-1]
    assert ("step", 3) == client.stopped("goto", threadId=2, targetId=main["id"])
    assert "main.src:5 is not in SPS\n" == client.said[-1]
    assert not client.ask("goto", threadId=2, targetId=9)["success"]
    assert "step" == client.stopped("stepMotion", threadId=2)[0]
    assert [] == client.do("stackTrace", threadId=3)["stackFrames"]
    assert "step" == client.stopped("stepMotionBack", threadId=2)[0]
    assert 1 == len(client.do("stackTrace", threadId=3)["stackFrames"])


def test_the_stack_goes_through_an_interrupt(client: Client) -> None:
    """Its routine lies on the interrupt, and that on the routines that were interrupted.

    A step out of it goes where RESUME leads.
    """
    cell = Path(__file__).parents[2] / "corpus" / "programs" / "search_demo" / "R1" / "Program"
    program, script = cell / "search_demo.src", cell / "search_demo.io"
    begun(client, program, {"line": 56}, submit="count_parts", robot="kinematic", io=str(script))
    client.wait("stopped")
    frames = client.do("stackTrace", threadId=1)["stackFrames"]
    assert [
        ("touched", 56),
        ("interrupt 10 in search_demo", 23),
        ("search", 49),
        ("search_demo", 29),
    ] == [(one["name"], one["line"]) for one in frames]
    submit = client.do("stackTrace", threadId=2)["stackFrames"]
    assert ["count_parts"] == [one["name"] for one in submit]
    assert ("step", 30) == client.stopped("stepOut", threadId=1)


def test_a_line_is_selected_and_files_are_read_again(client: Client, project: Path) -> None:
    """Goto executes nothing between; restart runs what the files are now."""
    begun(client, project, stopOnEntry=True)
    client.wait("stopped")
    source = {"path": str(project)}
    (target,) = client.do("gotoTargets", source=source, line=14)["targets"]
    assert [] == client.do("gotoTargets", source=source, line=2)["targets"]
    assert ("goto", 14) == client.stopped("goto", threadId=1, targetId=target["id"])
    assert ("step", 15) == client.stopped("next", threadId=1)
    project.write_text(MAIN.replace("INTERRUPT ON 5", "TOTAL=9"), encoding="utf-8")
    assert ("entry", 4) == client.stopped("restart")
    client.stopped("next", threadId=1)
    client.stopped("next", threadId=1)
    assert "9" == client.do("evaluate", expression="TOTAL")["result"]
    client.do("terminate")
    client.wait("terminated")


def test_breakpoints_that_report_count_or_are_wrong(client: Client, project: Path) -> None:
    """A message has values, hits count, and what cannot be read is not verified."""
    where = begun(
        client,
        project,
        {"line": 11, "logMessage": "I={I}"},
        {"line": 11, "hitCondition": "3"},
        {"line": 11, "condition": "I=="},
        {"line": 11, "hitCondition": "often"},
    )
    assert [True, True, False, False] == [one["verified"] for one in where]
    client.wait("stopped")
    assert "3" == client.do("evaluate", expression="I")["result"]
    assert ["I=1\n", "I=2\n", "I=3\n"] == client.said[-3:]
    client.do("disconnect")


def test_lines_that_begin_at_zero(client: Client, project: Path) -> None:
    """A client that calls the first line 0 has its own numbers throughout."""
    client.do("initialize", linesStartAt1=False)
    client.do("launch", program=str(project))
    given = {"source": {"path": str(project)}, "breakpoints": [{"line": 11}]}
    (found,) = client.do("setBreakpoints", **given)["breakpoints"]
    client.do("configurationDone")
    client.wait("stopped")
    frame = client.do("stackTrace", threadId=1)["stackFrames"][0]
    assert (12, 12, 0) == (found["line"], frame["line"], frame["column"])
    client.do("disconnect")


@pytest.mark.parametrize(
    ("command", "arguments", "text"),
    [
        ("launch", {}, "launch names no program"),
        ("launch", {"program": "nowhere.src"}, "nowhere.src: no such file"),
        ("launch", {"program": "x.src", "robot": "tin"}, "robot: tin is none of"),
        ("continue", {}, "the program runs"),
        ("next", {"threadId": 1}, "the program runs"),
        ("pause", {}, "no program has been launched"),
        ("restart", {}, "no program runs"),
        ("fly", {}, "fly is not supported"),
        ("setBreakpoints", {"source": 7}, "no program has been launched"),
    ],
)
def test_requests_that_are_refused(
    client: Client, command: str, arguments: dict[str, Any], text: str
) -> None:
    """What cannot be is refused in a line, and the session goes on."""
    found = client.ask(command, **arguments)
    assert not found["success"]
    assert text in found["message"]
    assert client.do("threads")["threads"]


def test_over_standard_input_and_output(project: Path) -> None:
    """The command speaks the protocol there, and nothing else; a program on the way is left."""
    command = [sys.executable, "-m", "krl", "debug", "--dap", str(project)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        client = Client(cast(BinaryIO, process.stdout), cast(BinaryIO, process.stdin))
        client.do("initialize")
        client.do("launch", stopOnEntry=True, routine="")  # an empty text says nothing
        client.do("configurationDone")
        assert "entry" == client.wait("stopped")["reason"]
        client.do("disconnect")
        assert 0 == process.wait()


def test_a_program_that_runs_can_be_paused_and_ended(client: Client, tmp_path: Path) -> None:
    """It stops at its next statement; breakpoints can be set meanwhile, none on data too."""
    file = tmp_path / "main.src"
    file.write_text("DEF MAIN()\nINT I\nLOOP\nI=0\nWAIT SEC 0.01\nENDLOOP\nEND\n", encoding="utf-8")
    begun(client, file)
    assert "the program runs" == client.ask("stackTrace", threadId=1)["message"]
    client.do("setDataBreakpoints", breakpoints=[])
    client.do("pause", threadId=1)
    assert "pause" == client.wait("stopped")["reason"]
    client.do("continue", threadId=1)
    client.do("setBreakpoints", source={"path": str(file)}, breakpoints=[{"line": 4}])
    assert "breakpoint" == client.wait("stopped")["reason"]
    client.do("setBreakpoints", source={"path": str(file)}, breakpoints=[])
    client.do("continue", threadId=1)
    client.do("terminate")
    client.wait("terminated")


def test_over_a_port(project: Path) -> None:
    """Clients are served one after the other; what is no message ends a session, not the server."""
    command = [sys.executable, "-m", "krl", "debug", "--dap", "--port", "0"]
    with (
        subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process,
        contextlib.ExitStack() as at_end,
    ):
        at_end.callback(process.terminate)
        assert process.stderr is not None
        port = int(process.stderr.readline().rpartition(":")[2])
        with socket.create_connection(("127.0.0.1", port)) as rude:
            rude.sendall(b"GET / HTTP/1.1\r\n\r\n")
            assert b"without a valid length" in rude.makefile("rb").read()
        with socket.create_connection(("127.0.0.1", port)) as polite:
            stream = cast(BinaryIO, polite.makefile("rwb"))
            client = Client(stream, stream)
            begun(client, project, {"line": 8})
            assert "breakpoint" == client.wait("stopped")["reason"]
            client.do("disconnect")
