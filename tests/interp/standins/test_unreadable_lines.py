"""Files with syntax errors run without the wrong lines, and not under strict rules."""

import pytest

from grammar.syntax.source import Source
from interp.executors import EXECUTORS
from interp.program.load import CheckedProgram, load
from interp.session import RunResult, RunSetup, run_program
from interp.standins.unreadable_lines import COUNT, UNREADABLE
from interp.values.faults import LinkError

TEXT = """DEF main ( )
DECL INT 5X
INT J
PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
IF $IN[1] THEN
J = = 3
ENDIF
PTP {A1 10}
FOR J 1 TO 3
PTP {A1 20}
ENDFOR
END
"""


def _run(text: str, executor: str) -> tuple[CheckedProgram, RunResult]:
    program = load([Source(text, "main.src")], "main.src", strict=False, stands_in=True)
    return program, run_program(program, RunSetup(executor=executor, is_tolerant=True))


def _passed(run: RunResult) -> list[str | None]:
    """The lines that the trace tells of."""
    calls = (event for event in run.events if event.kind == "call")
    return [event.place for event in calls if event.fields["name"] in (COUNT, UNREADABLE)]


@pytest.mark.parametrize("executor", EXECUTORS)
def test_goes_on_behind_what_cannot_be_read(executor: str) -> None:
    """A broken statement that is not come to is not told, and a broken FOR goes round once."""
    program, run = _run(TEXT, executor)
    ends = [event for event in run.events if event.kind == "motion_end"]
    used = program.used_stand_ins(program.start())
    assert (3, "end") == (len(ends), run.outcome.ending)
    assert ["main.src:9"] == _passed(run)
    assert [("unreadable", 6), ("unreadable", 9)] == [(one.origin, one.line) for one in used]


HEADS = """DEF main ( )
INT I
IF $IN[1] = = TRUE THEN
$OUT[1]=TRUE
J = = 4
ELSE
$OUT[2]=TRUE
ENDIF
FOR I=3 TOO 7
$OUT[10+I]=TRUE
ENDFOR
REPEAT
$OUT[3]=TRUE
UNTIL I > > 3
WHILE (I < 3
$OUT[4]=TRUE
ENDWHILE
END
"""


@pytest.mark.parametrize("executor", EXECUTORS)
def test_blocks_whose_heads_cannot_be_read(executor: str) -> None:
    """Such a block is gone through once, in its first branch, and the trace shows their heads."""
    _, run = _run(HEADS, executor)
    outputs = [event.fields["number"] for event in run.events if event.kind == "out"]
    assert ("end", [1, 11, 3, 4]) == (run.outcome.ending, outputs)
    assert [f"main.src:{line}" for line in (3, 5, 9, 14, 15, 17)] == _passed(run)


def test_every_broken_line_is_reported() -> None:
    """Why each line cannot be read is told with file and line."""
    left: list[str] = []
    load([Source(TEXT, "main.src")], "main.src", strict=False, stands_in=True, unread=left)
    assert ["main.src:2", "main.src:6", "main.src:9"] == [one.rpartition(": ")[0] for one in left]


def test_data_lists_keep_what_can_be_read() -> None:
    """A line of a data list that cannot be read costs no other declaration."""
    files = [
        Source("DEF main ( )\n$OUT[N]=TRUE\nEND\n", "main.src"),
        Source("DEFDAT main\nDECL INT N=7\nDECL INT = 3\nENDDAT\n", "main.dat"),
    ]
    program = load(files, "main.src", strict=False, stands_in=True, unread=[])
    run = run_program(program, RunSetup())
    assert [7] == [event.fields["number"] for event in run.events if event.kind == "out"]


def test_refused_without_stand_ins() -> None:
    """Without stand-ins nothing is run of such a file."""
    with pytest.raises(LinkError, match=r"main\.src:2: a name does not begin with a digit"):
        load([Source(TEXT, "main.src")], "main.src", strict=False)


@pytest.mark.parametrize("end", ["E", "EN\n", "IF $IN[1] THEN\n", "PTP {A1 2"])
def test_file_that_was_cut(end: str) -> None:
    """Of a file that was cut what comes ahead of the cut runs."""
    text = f"DEF main ( )\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}}\n\n\n\n{end}"
    program = load([Source(text, "main.src")], "main.src", strict=False, stands_in=True)
    run = run_program(program, RunSetup(is_tolerant=True))
    assert ("end", 1) == (
        run.outcome.ending,
        sum(event.kind == "motion_end" for event in run.events),
    )


@pytest.mark.parametrize("executor", EXECUTORS)
@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("&ACCESS RVP\n\nWAIT SEC 0\n$OUT[1]=TRUE\nEND\n", 4),
        (";by mail\nGLOBAL INTERRUPT DECL 3 WHEN $IN[1] DO main()\n$OUT[1]=TRUE\n", 3),
        ("DECL INT J\nJ=1\n$OUT[J]=TRUE\nEND\nDEF other ( )\nEND\n", 4),  # no room: one line more
        ("J=1\n$OUT[1]=TRUE\nRETURN J\nENDFCT\n", 3),
        ("DEF main ( )\n\N{NO-BREAK SPACE}$OUT[1]\N{NO-BREAK SPACE}= TRUE\nEND\n", 2),
        ("DEF main ( )\nMsgNotify(“on”)\n$OUT[1]=TRUE\nEND\n", 3),
    ],
)
def test_what_is_missing_or_strange_is_put_right(text: str, line: int, executor: str) -> None:
    """A file without DEF, or with signs of a word processor, loses no statement."""
    program, run = _run(text, executor)
    assert ("end", [f"main.src:{line}"]) == (
        run.outcome.ending,
        [event.place for event in run.events if event.kind == "out"],
    )
    assert not _passed(run)
    assert program.damaged == {"main.src"}


def test_data_list_without_its_head() -> None:
    """It is read all the same, and so is a data list of which only data is left."""
    files = [
        Source("DEF main ( )\n$OUT[N]=TRUE\nEND\n", "main.src"),
        Source("&ACCESS RVP\nDECL INT N=7\n", "main.dat"),
    ]
    program = load(files, "main.src", strict=False, stands_in=True, unread=[])
    run = run_program(program, RunSetup())
    assert [7] == [event.fields["number"] for event in run.events if event.kind == "out"]
