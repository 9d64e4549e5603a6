"""Scripts of inputs: their language, their errors, and what they do."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.controller.inputs.input_script import (
    Answer,
    Assign,
    AtTime,
    DialogueShown,
    EnumWord,
    MessageShown,
    Press,
    ProgramHalted,
    Script,
    ScriptError,
    ScriptStep,
    Send,
    TextReceived,
    VariableChanged,
)
from interp.controller.requests import waits
from interp.controller.state.profile import Profile
from interp.executors import EXECUTORS
from interp.program.load import Limits, load
from interp.session import RunSetup, run_program

Go = Callable[..., Any]

#: Loops have fewer rounds here, so that no test takes long.
FEW = replace(Profile.load(), statements=20, requests=8)


def test_language() -> None:
    """Every form of a line."""
    text = """
    ; a comment
    # another
    t=0.5 IN[1]=TRUE, $ANIN[2]=-0.4   ; behind it
    t=1 MODE_OP=#T1
    T=2 in[1..8]=17
    on OUT[3]=TRUE after 0.2 IN[7]=TRUE
    on HALT after 1 press START
    on message 1442 press CONFIRM
    on message press CONFIRM 1442
    on dialogue answer 2
    on channel SER_1 gets "ping" after 0.1 channel :SER_1 sends "pong"
    fulfil waits after 1.5
    stop at 10
    """
    script = Script.read(text)
    found = [(one.cause, one.delay, one.actions) for one in script.steps]
    assert [
        (AtTime(500_000), 0, (Assign(("$IN", 1), True), Assign(("$ANIN", 2), -0.4))),
        (AtTime(1_000_000), 0, (Assign(("$MODE_OP",), EnumWord("T1")),)),
        (AtTime(2_000_000), 0, (Assign(("$IN", 1, "TO", 8), 17),)),
        (VariableChanged(("$OUT", 3), True), 200_000, (Assign(("$IN", 7), True),)),
        (ProgramHalted(), 1_000_000, (Press("START"),)),
        (MessageShown(1442), 0, (Press("CONFIRM"),)),
        (MessageShown(None), 0, (Press("CONFIRM", 1442),)),
        (DialogueShown(), 0, (Answer(2),)),
        (TextReceived("SER_1", "ping"), 100_000, (Send("SER_1", "pong"),)),
    ] == found
    assert (10_000_000, 1_500_000) == (script.stop, script.fulfils)
    assert 0 == Script.read("FULFIL WAITS").fulfils


def test_where_it_stands() -> None:
    """A step knows its line."""
    assert (
        ScriptStep("io:2", AtTime(0), 0, (Press("STOP"),))
        == Script.read("\nt=0 press STOP", "io").steps[0]
    )


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("IN[1]=TRUE", "a line begins with t=SECONDS, with on, with fulfil waits, or with stop at"),
        ("t=1", "a variable is missing at the end"),
        ("t=x IN[1]=TRUE", "a time in seconds is missing before 'x'"),
        ("t=-1 IN[1]=TRUE", "-1 is not a time in seconds"),
        ("t=1 IN[1]", "'=' is missing at the end"),
        ("t=1 IN[1]=", "a value is missing at the end"),
        ("t=1 IN[1]=YES", "'YES' is not a value"),
        ("t=1 IN[x]=TRUE", "an index is missing before 'x'"),
        ("t=1 IN[1]=TRUE IN[2]=TRUE", "'IN' is not expected here"),
        ("t=1 press HELP", "there is no button HELP; there are START, STOP, CONFIRM"),
        ("t=1 channel A says", "'SENDS' is missing before 'says'"),
        ("t=1 IN[1]=TRUE ?", "'?' is not expected here"),
        ("stop 3", "'AT' is missing before '3'"),
    ],
)
def test_errors(line: str, words: str) -> None:
    """What cannot be understood is told in one line that names the place."""
    with pytest.raises(ScriptError) as caught:
        Script.read("; first\n" + line, "io.txt")
    assert f"io.txt:2: {words}" == str(caught.value)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("t=1 NOSUCH[1]=TRUE", "script:1: there is no system variable $NOSUCH"),
        ("t=1 IN[0]=TRUE", "script:1: an array index lies outside the array"),
        ("t=1 IN[9999]=TRUE", "script:1: an array index lies outside the array"),
        ("t=1 IN[1]=3", "script:1: 3 is not a value for $IN"),
        ("t=1 IN[1]=#ON", "script:1: #ON is given to what is no enumeration"),
        ("t=1 MODE_OP=#WRONG", "script:1: MODE_OP has no constant #WRONG that is known"),
        ("on OUT[0]=TRUE IN[1]=TRUE", "script:1: an array index lies outside the array"),
    ],
)
def test_what_is_not_there(go: Go, line: str, words: str) -> None:
    """Variables, indices and values are tried before the program begins."""
    with pytest.raises(ScriptError) as caught:
        go("DEF main()\nEND\n", line)
    assert words == str(caught.value)


@given(st.text(max_size=40))
def test_any_text(text: str) -> None:
    """Any text is a script, or a `ScriptError` of one line."""
    words = ""
    try:
        Script.read(text)
    except ScriptError as error:
        words = str(error)
    assert len(words.splitlines()) <= 1


PROGRAM = "DEF main()\nINT I\n{}END\n"
HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\n"


def test_events_repeat(go: Go) -> None:
    """An event acts each time that it happens; only an edge is one."""
    body = (
        "FOR I=1 TO 3\n$OUT[1]=TRUE\nWAIT FOR $IN[1]\n$OUT[1]=FALSE\nWAIT FOR NOT $IN[1]\nENDFOR\n"
    )
    script = "on OUT[1]=TRUE after 0.1 IN[1]=TRUE\non OUT[1]=FALSE after 0.1 IN[1]=FALSE"
    ran = go(PROGRAM.format(body), script)
    assert [True, False] * 3 == [one.fields["value"] for one in ran.events_of("in")]
    assert [0.1, 0.208] == ran.times("in")[:2]


@pytest.mark.parametrize(
    ("condition", "changes"),
    [
        ("$IN[3]", [(3, True)]),
        ("$IN[5] AND NOT $IN[3]", [(5, True)]),
        ("NOT $IN[3] AND $IN[5]", [(3, True), (5, True), (3, False)]),
        ("WORD==2", [(8, True), (9, True), (8, False)]),
        ("$IN[3] AND $FLAG[1]", [(3, True), (3, False)]),
        (
            "$IN[3] AND $IN[4] AND $FLAG[1]",
            [(3, True), (4, True), (3, False), (4, False)],
        ),
        ("$FLAG[1]", []),
    ],
)
def test_waits_are_fulfilled(go: Go, condition: str, changes: list[tuple[int, bool]]) -> None:
    """The inputs of a condition change through all combinations until it holds, or back."""
    text = f"DEF main()\nSIGNAL WORD $IN[8] TO $IN[10]\nWAIT FOR {condition}\nEND\n"
    ran = go(text, "fulfil waits after 1", until=3.0)
    assert changes == [(one.fields["number"], one.fields["value"]) for one in ran.events_of("in")]
    cycles = [1.008 + 0.012 * place for place in range(len(changes))]
    assert cycles == pytest.approx(ran.times("in"))
    assert ("time" if "FLAG" in condition else "end") == ran.outcome.ending
    assert len(changes) == ran.controller.automatic_inputs.count


@pytest.mark.parametrize(
    ("body", "seconds"),
    [
        ("WHILE NOT $IN[5]\nWAIT SEC 0.4\nENDWHILE\n", 2.448),
        ("REPEAT\n$OUT[3]=FALSE\n$OV_PRO=100\nUNTIL $IN[5]\n", 2.0),
        (f"LOOP\n{HOME}IF $IN[5] THEN\nEXIT\nENDIF\nENDLOOP\n", 2.0),
        ("REPEAT\nCONTINUE\nUNTIL $IN[5]\n", 2.0),
        ("WAIT FOR NOT $IN[7]\nWHILE NOT $IN[5]\nENDWHILE\n", 2.0),
        ("WAIT FOR $IN[7]\nWHILE NOT $IN[5] OR NOT $IN[7]\nENDWHILE\n", 3.06),
        ("WAIT FOR look ( )\n", 1.0),
    ],
)
def test_loops_that_look_at_inputs_wait_too(body: str, seconds: float) -> None:
    """Waits, values that were there, and a motion to where the arm stands change nothing."""
    text = f"DEF main ( )\n{body}$OUT[1]=TRUE\nEND\nDEFFCT BOOL look ( )\nRETURN $IN[5]\nENDFCT\n"
    program = load([Source(text, "main.src")], "main.src")
    script = Script.read("fulfil waits after 1")
    setups = [
        RunSetup(executor=one, profile=FEW, script=script, until=9_000_000) for one in EXECUTORS
    ]
    first, *others = [run_program(program, setup) for setup in setups]
    assert "end" == first.outcome.ending
    assert seconds == pytest.approx(first.outcome.time / 1e6, abs=0.05)
    assert all(first.events == other.events for other in others)


@pytest.mark.parametrize("body", ["CONTINUE\n", "$OUT[3]=FALSE\n", "$BASE=$NULLFRAME\n"])
def test_loops_that_change_nothing_are_given_few_requests(body: str) -> None:
    """From the second second on five in each cycle, as those that only read variables."""
    text = f"DEF main ( )\nREPEAT\n{body}UNTIL $IN[5]\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    run = run_program(program, RunSetup(executor=EXECUTORS[-1], profile=FEW, until=2_000_000))
    rounds = sum(one.kind == "branch" and one.time > 1_100_000 for one in run.events)
    assert 75 <= rounds <= 5 * 76


@pytest.mark.parametrize(
    ("body", "seconds"),
    [
        ("WHILE NOT $IN[5]\n$OUT[2]=NOT $OUT[2]\nWAIT SEC 0.5\nENDWHILE\n", 6.048),
        ("WHILE NOT $IN[5]\n$TIMER[1]=0\nENDWHILE\n", 6.0),
        ("WHILE NOT ($IN[5] AND NOT $IN[6])\n$OUT[2]=NOT $OUT[2]\nENDWHILE\n", 6.0),
    ],
)
def test_loops_with_a_heartbeat_wait_too(body: str, seconds: float) -> None:
    """Where a program only switches outputs, its inputs change after five more seconds."""
    program = load([Source(f"DEF main ( )\n{body}END\n", "main.src")], "main.src")
    script = Script.read("fulfil waits after 1")
    setups = [
        RunSetup(executor=one, profile=FEW, script=script, until=9_000_000) for one in EXECUTORS
    ]
    first, *others = [run_program(program, setup) for setup in setups]
    assert ("end", 1) == (first.outcome.ending, first.controller.automatic_inputs.count)
    assert seconds == pytest.approx(first.outcome.time / 1e6, abs=0.1)
    assert all(first.events == other.events for other in others)


@pytest.mark.parametrize(
    "body", ["$OUT[1]=NOT $OUT[1]\n", "IF $TIMER[1]>=0 THEN\n$TIMER[1]=-500\nENDIF\n"]
)
def test_endless_loops_end(monkeypatch: pytest.MonkeyPatch, body: str) -> None:
    """After many requests without a wait, the last of them slower; a script lets them go on."""
    monkeypatch.setattr(waits, "_ENDLESS", 1_000)
    monkeypatch.setattr(waits, "_MOST", 1_200)
    text = f"DEF main ( )\n$TIMER_STOP[1]=FALSE\nLOOP\n{body}ENDLOOP\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    executors = (EXECUTORS[0], EXECUTORS[-1])
    setups = [RunSetup(executor=one, until=2_000_000) for one in executors]
    first, *others = [run_program(program, setup) for setup in setups]
    assert "budget" == first.outcome.ending
    assert all(first.events == other.events for other in others)
    script = Script.read("t=1.5 IN[1]=TRUE")
    assert "time" == run_program(program, replace(setups[-1], script=script)).outcome.ending


@pytest.mark.parametrize(
    ("long", "most"),
    [("J=INVERSE($POS_ACT,$AXIS_ACT,E)", 900), ("P=$POS_ACT", 4_000)],
)
def test_long_requests_count_as_many(long: str, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A loop of requests that take long ends after fewer of them."""
    monkeypatch.setattr(waits, "_MOST", 12_000)
    text = f"DEF main ( )\nE6AXIS J\nE6POS P\nINT E\nLOOP\n{long}\nENDLOOP\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    ran = run_program(program, RunSetup(limits=Limits(statements=most)))
    assert "requests" in str(ran.outcome.error)


def test_catching_faults_is_no_polling(monkeypatch: pytest.MonkeyPatch) -> None:
    """A loop that only catches the same fault is endless, and each counts as many requests."""
    monkeypatch.setattr(waits, "_MOST", 12_000)
    text = "DEF main ( )\nINT E\nE=0\nLOOP\nON_ERROR_PROCEED\nE=1/(E-E)\nENDLOOP\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    setup = RunSetup(profile=replace(FEW, requests=10), limits=Limits(statements=6_000))
    assert "requests" in str(run_program(program, setup).outcome.error)


@pytest.mark.parametrize("body", ["", "N=N+1\n", "IF $IN[2] THEN\n$OUT[1]=TRUE\nENDIF\n"])
def test_polling_is_no_endless_loop(monkeypatch: pytest.MonkeyPatch, body: str) -> None:
    """It goes on until the time is over on every executor, with a trace and without."""
    monkeypatch.setattr(waits, "_MOST", 800)
    text = f"DEF main ( )\nINT N\nN=0\nWHILE NOT $IN[1]\n{body}ENDWHILE\nEND\n"
    program = load([Source(text, "main.src")], "main.src")
    setup = RunSetup(profile=FEW, until=2_500_000)
    assert {"time"} == {
        run_program(program, replace(setup, executor=one, is_traced=is_traced)).outcome.ending
        for one in EXECUTORS
        for is_traced in (False, True)
    }


def test_loop_that_moves_is_no_wait(go: Go) -> None:
    """Inputs stay as they are where a program moves the arm meanwhile."""
    body = "WHILE NOT $IN[5]\nPTP_REL {A1 1}\nPTP_REL {A1 -1}\nENDWHILE\n"
    ran = go(PROGRAM.format(f"{HOME}{body}"), "fulfil waits after 1", until=20.0)
    assert ("time", 0) == (ran.outcome.ending, ran.controller.automatic_inputs.count)


@pytest.mark.parametrize("condition", ["$FLAG[7]", "$IN[2] AND $FLAG[7]"])
def test_flags_of_packages_are_set(go: Go, condition: str) -> None:
    """A flag that nothing has set by then is set after five times as long as inputs take."""
    ran = go(f"DEF main()\nWAIT FOR {condition}\n$OUT[1]=TRUE\nEND\n", "fulfil waits after 1")
    assert ("end", True) == (ran.outcome.ending, 5.0 <= ran.times("out")[0] < 5.1)


def test_flags_of_the_program_are_its_own(go: Go) -> None:
    """A flag that an interrupt sets meanwhile is left alone."""
    text = (
        "DEF main()\nINTERRUPT DECL 5 WHEN $TIMER[1]>0 DO READY()\n$TIMER[1]=-3000\n"
        "$TIMER_STOP[1]=FALSE\nINTERRUPT ON 5\nWAIT FOR $FLAG[7]\n$OUT[1]=TRUE\nEND\n"
        "DEF READY()\n$FLAG[7]=TRUE\nEND\n"
    )
    ran = go(text, "fulfil waits after 1")
    assert 0 == ran.controller.automatic_inputs.count
    assert 3.0 <= ran.times("out")[0] < 3.1


def test_scripted_inputs_are_not_fulfilled(go: Go) -> None:
    """What a script sets itself comes when the script says."""
    ran = go("DEF main()\nWAIT FOR $IN[3]\nEND\n", "fulfil waits\nt=2 IN[3]=TRUE")
    assert [2.0] == ran.times("in")
    assert 0 == ran.controller.automatic_inputs.count


def test_waits_begin_anew(go: Go) -> None:
    """The time of a wait counts from where the program comes to it."""
    body = "FOR I=1 TO 2\nWAIT FOR $IN[1]\nWAIT FOR NOT $IN[1]\nENDFOR\n"
    ran = go(PROGRAM.format(body), "fulfil waits after 0.5")
    assert [0.504, 1.02, 1.536, 2.052] == ran.times("in")


def test_inputs_are_reported(go: Go) -> None:
    """An input is an event of the trace that comes from no line."""
    ran = go(PROGRAM.format("WAIT SEC 1\n"), "t=0.5 IN[3]=TRUE, ANIN[1]=0.5")
    assert [("$IN", 3, True), ("$ANIN", 1, 0.5)] == [
        tuple(one.fields.values()) for one in ran.events_of("in")
    ]
    assert [None, None] == [one.place for one in ran.events_of("in")]


def test_values_are_converted(go: Go) -> None:
    """A whole number is a REAL where the variable is one, and a flag any system variable."""
    body = "WAIT SEC 0.1\nIF ($ANIN[1]==1.0) AND $FLAG[7] THEN\nI=1\nENDIF\n"
    assert 1 == go(PROGRAM.format(body), "t=0 ANIN[1]=1, FLAG[7]=TRUE").last("I")


def test_write_protected_variables(go: Go) -> None:
    """A script may set what programs may not; a value out of range is told with its line."""
    with pytest.raises(ScriptError, match="script:1: the value is not valid"):
        go(PROGRAM.format("WAIT SEC 1\n"), "t=0.5 OV_PRO=101")
