"""Programs of the own corpus run under the stub world, always in the same way."""

from pathlib import Path

import pytest

from grammar.syntax.source import Source
from interp.bench.stub_controller import Outcome, StubController, run
from interp.port.events import Recorder
from interp.port.requests import Crash, End, Fail
from interp.program.load import Limits, load
from interp.tree import TreeExecutor, system_values
from support.files.decode import decode

PROGRAMS = Path(__file__).parents[3] / "corpus" / "programs"


def executed(main: str, most: int) -> tuple[Outcome, Recorder]:
    folder = PROGRAMS / main.partition("/")[0]
    sources = []
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in (".src", ".dat", ".sub"):
            found = decode(path.read_bytes())
            text = "" if isinstance(found, str) else found.text  # an empty file
            sources.append(Source(text, path.relative_to(PROGRAMS).as_posix()))
    program = load(sources, main)
    recorder = Recorder()
    executor = TreeExecutor(program, limits=Limits(statements=50_000), sink=recorder)
    return run(executor, StubController(1, system_values(program)), most), recorder


@pytest.mark.parametrize(
    "main",
    [
        "assembly/KRC/R1/Program/Assembly.src",
        "palletiser/KRC/R1/Program/Statistics/PalStat.src",
        "spot_cell/KRC/R1/Program/Punkt_Haupt.src",
        "spot_cell/KRC/R1/Program/Service/Wartung.src",
    ],
)
def test_runs_to_its_end(main: str) -> None:
    """The program ends, and a second run asks and tells the same."""
    outcome, recorder = executed(main, 5_000)
    assert isinstance(outcome.last, End)
    again, told = executed(main, 5_000)
    assert outcome == again
    assert recorder.events == told.events


def test_palletiser_runs_on() -> None:
    """The palletiser's cell program, with BAS, messages and motions, runs without a fault."""
    outcome, recorder = executed("palletiser/KRC/R1/cell.src", 3_000)
    assert outcome.is_cut
    assert not isinstance(outcome.last, Fail | Crash)
    assert {"line", "assign", "call", "return", "branch"} == {one.kind for one in recorder.events}
