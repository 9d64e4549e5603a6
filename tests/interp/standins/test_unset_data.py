"""Values for data that a project declares and reads and nothing sets."""

import pytest

from grammar.syntax.source import Source
from interp.executors import EXECUTORS
from interp.program.load import CheckedProgram, load
from interp.session import RunResult, RunSetup, run_program

TYPES = "ENUM KIND ONE,TWO\nSTRUC PART KIND K,INT N,E6POS P\n"


def _program(declared: str, body: str, *, stands_in: bool = True) -> CheckedProgram:
    data = f"DEFDAT main\n{TYPES}{declared}ENDDAT\n"
    files = [Source(f"DEF main ( )\n{body}END\n", "main.src"), Source(data, "main.dat")]
    return load(files, "main.src", strict=False, stands_in=stands_in)


def _run(program: CheckedProgram, executor: str = "tree") -> RunResult:
    return run_program(program, RunSetup(executor=executor, is_full=True, is_tolerant=True))


def _outcome(run: RunResult) -> tuple[str, str]:
    return run.outcome.ending, str(run.outcome.error or "")


@pytest.mark.parametrize("executor", EXECUTORS)
def test_values(executor: str) -> None:
    """Numbers are 1, enumerations their first constant, points places, flags FALSE."""
    declared = "DECL PART G\nINT N,M\nREAL R\nBOOL BAD\nDECL E6POS XP[3]\nDECL KIND K\n"
    body = (
        "K=G.K\nIF BAD OR (K<>#ONE) THEN\nHALT\nENDIF\nM=N\n$OUT[M]=TRUE\nR=1.0/N\n"
        "PTP XP[2]\nLIN XP[3]\nPTP G.P\n"
    )
    run = _run(_program(declared.replace("M\n", "M=0\n"), body), executor)
    assert (("end", ""), [1]) == (
        _outcome(run),
        [one.fields["number"] for one in run.events if one.kind == "out"],
    )
    assert {} == run.controller.skipped


def test_flag_that_is_waited_for() -> None:
    """A WAIT FOR that only somebody outside can end goes on."""
    assert ("end", "") == _outcome(_run(_program("BOOL READY\n", "WAIT FOR READY\n")))


def test_counter_that_counts_on() -> None:
    """A counter that the project only counts on was set before; it is listed with its line."""
    program = _program("INT PARTS\n", "PARTS=PARTS+1\n")
    assert ("end", "") == _outcome(_run(program))
    assert [("PARTS", "unset", "main.dat", 4)] == [
        (one.name, one.origin, one.path, one.line) for one in program.stand_ins
    ]


@pytest.mark.parametrize(
    "body",
    [
        "$OUT[N]=TRUE\nN=2\n",
        "$OUT[N]=TRUE\nhelp (N )\nEND\nDEF help (P :OUT )\nINT P\nP=3\n",
        "$OUT[N]=TRUE\nFOR N=1 TO 2\nENDFOR\n",
    ],
)
def test_what_the_project_sets(body: str) -> None:
    """What the project sets too late is the program's own fault."""
    program = _program("INT N\n", body)
    assert ("fault", "a value is used that was never set") == _outcome(_run(program))
    assert () == program.stand_ins


def test_values_in_the_list() -> None:
    """What the data list gives values to, in part or as a whole, is left as it is."""
    declared = 'INT A[3]\nINT B=5\nCHAR T[4]\nA[2]=7\nT[]="X"\n'
    program = _program(declared, "$OUT[B]=TRUE\n$OUT[A[2]]=TRUE\nT[2]=T[1]\n")
    assert () == program.stand_ins
    assert ("end", "") == _outcome(_run(program))


def test_strict() -> None:
    """Where nothing may stand in the run ends at the first use."""
    program = _program("INT N\n", "$OUT[N]=TRUE\n", stands_in=False)
    assert ("fault", "a value is used that was never set") == _outcome(_run(program))
