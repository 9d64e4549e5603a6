"""A function without RETURN, or whose RETURN fails, gives a value where things stand in."""

import pytest

from grammar.syntax.source import Source
from interp.executors import EXECUTORS
from interp.program.load import Limits, load
from interp.session import RunSetup, run_program
from interp.values.faults import Fault

TEXT = """DEF main ( )
IF IS_OPEN(1)==FALSE THEN
$OUT[1]=TRUE
ENDIF
$OUT[2+NUMBER(3)]=TRUE
$OUT[NUMBER(4)]=TRUE
IF STATE()==#IDLE THEN
$OUT[5]=TRUE
ENDIF
$OUT[6]=LOST
END
DEFFCT BOOL IS_OPEN(N:IN)
INT N
N=N+1
ENDFCT
DEFFCT INT NUMBER(N:IN)
INT N
IF N>3 THEN
RETURN N
ENDIF
ENDFCT
DEFFCT STATE_T STATE()
DECL STATE_T NEVER
RETURN NEVER
ENDFCT
"""
LIST = "DEFDAT main\nENUM STATE_T IDLE,BUSY\nENDDAT\n"


@pytest.mark.parametrize("executor", EXECUTORS)
def test_first_values(executor: str) -> None:
    """The caller goes on with the value, and the end of the function is told as skipped."""
    files = [Source(TEXT, "main.src"), Source(LIST, "main.dat")]
    program = load(files, "main.src", strict=False, stands_in=True)
    setup = RunSetup(executor=executor, is_tolerant=True, skips_failures=True)
    run = run_program(program, setup)
    outputs = [event.fields["number"] for event in run.events if event.kind == "out"]
    assert ("end", [1, 2, 4, 5]) == (run.outcome.ending, outputs[:4])
    assert [("main.src", line) for line in (15, 21, 24, 25)] == list(run.controller.skipped)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_fails_without_stand_ins(executor: str) -> None:
    """Where nothing stands in the program ends there."""
    files = [Source(TEXT, "main.src"), Source(LIST, "main.dat")]
    program = load(files, "main.src", strict=False)
    run = run_program(program, RunSetup(executor=executor, limits=Limits()))
    assert isinstance(run.outcome.error, Fault)
    assert "no_result" == run.outcome.error.slug
