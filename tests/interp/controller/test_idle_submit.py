"""A submit program that goes round without an effect costs little, and nothing is seen of that."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.bytecode.vm.executor import Machine
from interp.controller import quiet_time
from interp.controller.inputs.automatic_inputs import OPERATOR
from interp.controller.inputs.input_script import Script
from interp.controller.quiet_time import QuietTime
from interp.controller.requests import waits
from interp.controller.state.profile import Profile
from interp.executors import available
from interp.program.load import CheckedProgram, Limits, load
from interp.session import RunResult, RunSetup, run_program

MACHINES = [name for name in available() if name != "tree"]
CONFIG = "DEFDAT $CONFIG\nDECL INT COUNT=0\nDECL INT OTHER=0\nDECL REAL ZERO=0.0\nENDDAT\n"
SHOW = "".join(f"$OUT[{100 + bit}]=(COUNT B_AND {1 << bit})<>0\n" for bit in range(12))
MAIN = """DEF main ( )
INTERRUPT DECL 3 WHEN $IN[3] DO SEEN ( )
INTERRUPT ON 3
WAIT FOR $IN[7]
{}$OUT[50]=NOT $OUT[50]
WAIT SEC 0.25
{}WAIT FOR $IN[8]{}
{}END
DEF SEEN ( )
$FLAG[2]=TRUE
COUNT=COUNT+3
END
DEFFCT BOOL TURNS ( )
OTHER=OTHER+1
RETURN OTHER>90
ENDFCT
"""
SPS = """DEF SPS ( )
DECL INT I
DECL BOOL B
{}LOOP
{}ENDLOOP
END
DEF PASS (B:IN )
BOOL B
IF B THEN
  $OUT[9]=$FLAG[2]
ENDIF
END
"""
#: Statements of a submit program: those that change nothing, and those that do.
IDLE = (
    "$OUT[1]=$IN[1]",
    "$OUT[2]=$IN[2] AND NOT $IN[3]",
    "$FLAG[1]=TRUE",
    "IF $IN[4] THEN\nCOUNT=COUNT+1\nENDIF",
    "FOR I=1 TO 7\nB=$IN[I]\nENDFOR",
    "PASS ($IN[5])",
    "B=$IN[1] OR $IN[1] OR $IN[1]",
    "$OUT[11]=COUNT>20",
    "$OUT[10]=$FLAG[2]",
    "I=I+1-1",
    "$ANOUT[1]=0.25",
    "$OV_PRO=100",
    "$OUT[5]=ZERO==0.0",
)
BUSY = (
    "COUNT=COUNT+1",
    "I=I+1",
    "$OUT[12]=$TIMER[1]>300",
    "$TIMER_STOP[1]=FALSE",
    "$OUT[13]=$ROB_STOPPED",
    "PULSE ($OUT[14],TRUE,0.1)",
    "$FLAG[3]=NOT $FLAG[3]",
    "WAIT SEC 0.05",
    "ZERO=-ZERO",
    "$OUT[15]=NOT $OUT[15]",
    "IF COUNT>20 THEN\n$OUT[16]=TRUE\nENDIF\nCOUNT=COUNT+1",
    "B=RND()>0.5",
    "I=(I+1)-3*((I+1)/3)",
)
#: What the robot's program does beside: also loops that ask for inputs.
PARTS = (
    "",
    "COUNT=COUNT+1\n",
    "$FLAG[1]=FALSE\n",
    "SPTP {A1 10}\n",
    "REPEAT\nUNTIL $IN[5]\n",
    "WHILE NOT $IN[6]\n$FLAG[1]=$IN[5]\nFOR OTHER=1 TO 80\nENDFOR\nENDWHILE\n",
    "REPEAT\nCOUNT=(COUNT+1) B_AND 7\nUNTIL $IN[7]\n",
    "REPEAT\nTRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\nUNTIL $IN[5]\n",
)
HEADS = ("", "I=0\n", "INTERRUPT DECL 5 WHEN $IN[6] DO PASS (TRUE )\nINTERRUPT ON 5\nI=0\n")


def _program(submit: str, main: str = MAIN.format("", "", "", SHOW)) -> CheckedProgram:
    files = {"main.src": main, "sps.sub": submit, "$config.dat": CONFIG}
    sources = [Source(text, name) for name, text in files.items()]
    return load(sources, "main.src", strict=False)


def _seen(run: RunResult) -> list[str]:
    assert isinstance(run.executor, Machine)
    begun = [one.begun for one in run.executor._together]
    return [str(run.outcome), f"{begun}", *(one.line() for one in run.events)]


def _both(program: CheckedProgram, setup: RunSetup) -> tuple[list[str], list[str]]:
    """What is seen of a run, with whole periods at once and without."""
    setup = replace(setup, submit="SPS", is_traced=False)
    quick = _seen(run_program(program, setup))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(QuietTime, "_skipped", lambda *_: 0)
        return quick, _seen(run_program(program, setup))


@pytest.fixture
def is_soon_idle(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program is idle after a tenth of a second, so that short runs have whole periods."""
    for module in (quiet_time, waits):
        monkeypatch.setattr(module, "IDLE_AFTER", 100_000)


@st.composite
def drawn(draw: st.DrawFn) -> tuple[CheckedProgram, RunSetup]:
    idle = draw(st.lists(st.sampled_from(IDLE), max_size=4))
    busy = [draw(st.sampled_from(BUSY))] if draw(st.integers(0, 3)) == 3 else []
    body = "".join(f"{one}\n" for one in draw(st.permutations(idle + busy)))
    calls = draw(st.sampled_from(["", "", "", " OR TURNS ( )"]))
    parts = st.sampled_from(PARTS)
    main = MAIN.format(draw(parts), draw(parts), calls, SHOW)
    times = st.integers(1, 950_000).map(lambda time: f"{time / 1e6:.6f}")
    change = st.builds(
        lambda time, number, value: f"t={time} IN[{number}]={value}\n",
        times,
        st.sampled_from([1, 2, 3, 4, 5, 6, 7, 7, 8, 8]),
        st.sampled_from(["TRUE", "TRUE", "FALSE"]),
    )
    script = draw(st.sampled_from(["", OPERATOR])) + "".join(draw(st.lists(change, max_size=6)))
    profile = replace(
        Profile.load(),
        submit_every=draw(st.sampled_from([1, 1, 3])),
        submit_requests=draw(st.sampled_from([20, 10, 7])),
    )
    limits = Limits(
        statements=draw(st.sampled_from([10**7, 10**7, 3_000, 8_000])),
        per_slice=draw(st.sampled_from([200, 20])),
    )
    setup = RunSetup(
        executor=draw(st.sampled_from(MACHINES)),
        profile=profile,
        script=Script.read(script),
        limits=limits,
        until=1_000_001,
    )
    return _program(SPS.format(draw(st.sampled_from(HEADS)), body), main), setup


@pytest.mark.usefixtures("is_soon_idle")
@given(drawn())
def test_nothing_is_seen(one: tuple[CheckedProgram, RunSetup]) -> None:
    """Trace, outcome and statements are as if each slice of the submit program had run."""
    quick, slow = _both(*one)
    assert slow == quick


def test_busy_before_is_busy_behind() -> None:
    """A program that writes, and reads much, keeps its requests in a slice behind a stretch."""
    body = "$FLAG[1]=TRUE\nFOR I=1 TO 40\nB=$IN[1]\nENDFOR\n$OUT[1]=B\n"
    script = Script.read("t=2.5 IN[1]=TRUE\nt=4.503 IN[1]=FALSE\n")
    setup = RunSetup(executor=MACHINES[-1], script=script, until=5_000_001)
    quick, slow = _both(_program(SPS.format("", body), "DEF main ( )\nWAIT SEC 9\nEND\n"), setup)
    assert slow == quick


@pytest.mark.usefixtures("is_soon_idle")
@pytest.mark.parametrize("executor", MACHINES)
@pytest.mark.parametrize("body", ["$OUT[1]=$IN[1]\n", "PASS ($IN[2])\n", "", "B=$IN[1]\n"])
@pytest.mark.parametrize("wait", ["WAIT FOR $IN[7]", "WAIT SEC 90"])
def test_idle_takes_few_looks(looks: list[int], executor: str, body: str, wait: str) -> None:
    """A minute of it beside a program that waits takes some looks a second, not one each cycle."""
    setup = RunSetup(executor=executor, submit="SPS", is_traced=False, until=60_000_000)
    main = MAIN.format("", "", "", SHOW).replace("WAIT FOR $IN[7]", wait)
    run = run_program(_program(SPS.format("", body), main), setup)
    assert ("time", True) == (run.outcome.ending, len(looks) < 60 * 5)


@pytest.mark.usefixtures("is_soon_idle")
def test_a_counter_is_not_skipped() -> None:
    """A loop that only counts goes on counting."""
    program = _program(SPS.format("", "COUNT=COUNT+1\n$OUT[1]=$IN[1]\n"))
    script = Script.read("t=1 IN[7]=TRUE\nt=1.5 IN[8]=TRUE\n")
    quick, slow = _both(program, RunSetup(executor=MACHINES[-1], script=script))
    assert slow == quick


@pytest.mark.usefixtures("is_soon_idle")
@pytest.mark.parametrize("executor", MACHINES)
def test_slices_keep_their_cycles(executor: str) -> None:
    """Behind a stretch the next slice begins in its own cycle, not at once."""
    setup = RunSetup(
        executor=executor, profile=replace(Profile.load(), submit_every=3), until=1_000_001
    )
    quick, slow = _both(_program(SPS.format("", "")), setup)
    assert slow == quick
