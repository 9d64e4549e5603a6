"""Files with syntax errors run until they come to one, and not under strict rules."""

import pytest

from grammar.syntax.source import Source
from interp.program.load import load
from interp.session import EXECUTORS, RunSetup, run_program
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


@pytest.mark.parametrize("executor", EXECUTORS)
def test_stops_where_it_cannot_be_read(executor: str) -> None:
    """What comes before the broken statement is executed whole; one not reached does not count.

    All executors tell the same of it.
    """
    program = load([Source(TEXT, "main.src")], "main.src", strict=False, stands_in=True)
    run = run_program(program, RunSetup(executor=executor, is_tolerant=True))
    ends = [event for event in run.events if event.kind == "motion_end"]
    assert run.outcome.at is not None
    assert (2, "fault", 9) == (len(ends), run.outcome.ending, run.outcome.at.line)
    assert "this line cannot be read" == str(run.outcome.error)


def test_every_broken_line_is_told() -> None:
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
    with pytest.raises(LinkError, match=r"main\.src:2: '5' is not expected"):
        load([Source(TEXT, "main.src")], "main.src", strict=False)
