"""Functions that take long count as many statements before a program is endless."""

from dataclasses import replace

import pytest

from grammar.syntax.source import Source
from interp.controller.state.profile import Profile
from interp.executors import EXECUTORS
from interp.program.load import CheckedProgram, Limits, load
from interp.session import RunSetup, run_program
from interp.values.builtins import BUILTINS, FUNCTIONS, WEIGHTS

_DATA = """DEF main ( )
INT I,N,O
CHAR T[20]
FRAME F,G
REAL X
DECL STATE_T S
DECL VAR_STATE V
N=0
T[]="spot"
F={X 1.0,Y 2.0,Z 3.0,A 40.0,B 5.0,C 6.0}
G=F
"""
#: Functions that C computes, that Python computes, and those that set arguments.
_CALLS = (
    "F=G:F",
    "F=INV_POS(G)",
    "I=STRLEN(T[])",
    'V=VARSTATE("I")',
    "X=FRAND(0.0,1.0)",
    'O=0\nSWRITE(T[],S,O,"%d",N)',
    "$OUT[1]=STRLEN(T[])>STRLEN(T[])+N",
    "F=G:F:G\nIF $IN[2] THEN\nN=1\nENDIF",
)


def _program(body: str) -> CheckedProgram:
    return load([Source(f"{_DATA}{body}\nEND\n", "main.src")], "main.src")


@pytest.mark.parametrize("count", ["", "N=N+1\n"])
@pytest.mark.parametrize("call", _CALLS)
def test_loop_of_functions_ends(call: str, count: str) -> None:
    """It ends after the same function on every executor, with a trace and without."""
    program = _program(f"LOOP\n{count}{call}\nENDLOOP")
    setup = RunSetup(limits=Limits(functions=6_000, per_slice=100), until=9_000_000)
    runs = [
        run_program(program, replace(setup, executor=one, is_full=is_full, is_traced=is_full))
        for one in EXECUTORS
        for is_full in (False, True)
    ]
    outcomes = {(run.outcome.ending, run.outcome.time, run.outcome.at) for run in runs}
    assert (1, "budget") == (len(outcomes), outcomes.pop()[0])
    assert all(run.events == runs[1].events for run in runs[1::2])


@pytest.mark.parametrize(
    "body",
    [
        "LOOP\nF=G:F\nWAIT SEC 0.012\nENDLOOP",
        "WHILE NOT $IN[1]\nF=G:F\nENDWHILE",
        "INTERRUPT DECL 3 WHEN STRLEN(T[])+STRLEN(T[])>9 DO STOP1 ( )\nINTERRUPT ON 3\n"
        "LOOP\nWHILE NOT $IN[1]\n$OUT[1]=NOT $OUT[1]\nENDWHILE\nENDLOOP\nEND\nDEF STOP1 ( )",
    ],
)
def test_functions_of_a_program_that_waits(body: str) -> None:
    """They count from the last wait on, also where it polls; those of conditions do not."""
    limits, profile = Limits(functions=10_000), replace(Profile.load(), requests=1)
    setup = RunSetup(limits=limits, profile=profile, until=4_000_000)
    program = _program(body)
    assert {"time"} == {
        run_program(program, replace(setup, executor=one)).outcome.ending for one in EXECUTORS
    }


def test_each_function_that_takes_long_has_a_weight() -> None:
    """All functions do, but those of numbers; and so does the operator for poses."""
    assert {*BUILTINS, ":"} - set(FUNCTIONS) | {"INV_POS"} == set(WEIGHTS)
