"""A program gets as many slices at once as nothing can happen in, and nothing is seen of that.

The programs have no interrupts: those are told of calls, and get one slice at a time.
"""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.bytecode.vm.executor import Machine
from interp.controller.inputs.input_script import Script
from interp.controller.scheduler import Scheduler
from interp.controller.state.profile import Profile
from interp.executors import EXECUTORS, is_available
from interp.program.load import CheckedProgram, Limits, load
from interp.session import RunSetup, run_program

MACHINES = [name for name in EXECUTORS if name != "tree" and is_available(name)]
MAIN = """DEF main ( )
INT I, K, N
REAL X
CHAR TEXT[20]
DECL STATE_T STATE
N=0
X=0
FOR K=1 TO 2
{}ENDFOR
END
DEFFCT INT SUM (N:IN )
INT N, I, S
S=0
FOR I=1 TO N
S=S+I
ENDFOR
RETURN S
ENDFCT
"""
#: What computes; a program has as much of it as of all else.
COMPUTING = (
    "FOR I=1 TO {}\nX=X+I\nENDFOR\n",
    "N=SUM ({})\n",
    "I={}\nREPEAT\nI=I-1\nUNTIL (I<=0) OR (N==2)\n",
)
OTHERS = (
    "$OUT[1]=NOT $OUT[1]\n",
    "$OUT[2]=$IN[1]\n",
    "$OUT[3]=$TIMER[1]>60\n",
    "$TIMER[1]=-80\n$TIMER_STOP[1]=FALSE\n",
    "$FLAG[1]=N>1\n",
    "PULSE ($OUT[4],TRUE,0.1)\n",
    "WAIT SEC 0.05\n",
    "WAIT FOR $IN[2] OR $OUT[1]\n",
    "WHILE NOT $IN[1]\nN=N+1\nENDWHILE\n",
    "PTP {A1 5}\n",
    "PTP {A1 -5} C_PTP\n",
    "SPTP {A1 3}\n",
    "TRIGGER WHEN DISTANCE=1 DELAY=-20 DO $OUT[5]=NOT $OUT[5]\n",
    "CONTINUE\n$OUT[6]=NOT $OUT[6]\n",
    'SWRITE (TEXT[],STATE,N,"%d",K)\nN=0\n',
    "$ADVANCE=1\n",
    "$OV_PRO=50\n",
    "N=N/(K-1)\n",
)


@st.composite
def drawn(draw: st.DrawFn) -> tuple[CheckedProgram, RunSetup]:
    computing = st.builds(str.format, st.sampled_from(COMPUTING), st.integers(1, 300))
    parts = draw(st.lists(st.tuples(computing, st.sampled_from(OTHERS)), max_size=7))
    body = "".join(one for pair in parts for one in pair)
    change = st.builds(
        "t={:.4f} IN[{}]={}\n".format,
        st.floats(0, 1),
        st.integers(1, 3),
        st.sampled_from(["TRUE", "TRUE", "FALSE"]),
    )
    setup = RunSetup(
        executor=draw(st.sampled_from(MACHINES)),
        profile=replace(Profile.load(), requests=draw(st.sampled_from([100, 3, 1]))),
        script=Script.read("".join(draw(st.lists(change, max_size=6)))),
        limits=Limits(
            statements=draw(st.sampled_from([10**6, 10**6, 900])),
            per_slice=draw(st.sampled_from([1, 7, 20, 50])),
        ),
        until=draw(st.sampled_from([2_000_001, 500_000])),
        is_traced=False,
    )
    return load([Source(MAIN.format(body), "main.src")], "main.src", strict=False), setup


def _seen(program: CheckedProgram, setup: RunSetup) -> list[str]:
    run = run_program(program, setup)
    assert isinstance(run.executor, Machine)
    begun, data = run.executor.begun, run.executor.data()
    return [str(run.outcome), f"{begun} {data}", *(one.line() for one in run.events)]


@given(drawn())
def test_nothing_is_seen(one: tuple[CheckedProgram, RunSetup]) -> None:
    """Trace, outcome and statements are as if each slice had been asked for."""
    at_once = _seen(*one)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Scheduler, "_free_slices", lambda _self, begins: int(begins))
        assert _seen(*one) == at_once


@pytest.mark.parametrize("executor", MACHINES)
def test_many_are_given_at_once(executor: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program that only computes asks the controller a few times, not for each slice."""
    asked: list[bool] = []
    right = Scheduler._free_slices

    def free_slices(scheduler: Scheduler, begins: bool) -> int:
        asked.append(begins)
        return right(scheduler, begins)

    monkeypatch.setattr(Scheduler, "_free_slices", free_slices)
    text = MAIN.format("N=SUM (5000)\n")
    program = load([Source(text, "main.src")], "main.src", strict=False)
    setup = RunSetup(executor=executor, limits=Limits(per_slice=20), is_traced=False)
    assert "end" == run_program(program, setup).outcome.ending
    assert 1 <= len(asked) < 10
