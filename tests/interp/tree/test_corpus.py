"""Programs of the own corpus run under the stub world, always in the same way."""

from pathlib import Path

import pytest

from conformance.differential.random_world import QuietWorld
from conformance.differential.undisturbed_run import Observed, observe
from grammar.syntax.source import Source
from interp.port.requests import Crash, End, Fail
from interp.program.load import Limits, load
from interp.tree.executor import TreeExecutor
from interp.tree.memory import system_values
from support.files.decode import decode

PROGRAMS = Path(__file__).parents[3] / "corpus" / "programs"


def executed(main: str, most: int) -> Observed:
    folder = PROGRAMS / main.partition("/")[0]
    sources = []
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in (".src", ".dat", ".sub"):
            found = decode(path.read_bytes())
            text = "" if isinstance(found, str) else found.text  # an empty file
            sources.append(Source(text, path.relative_to(PROGRAMS).as_posix()))
    program = load(sources, main)
    limits, world = Limits(statements=50_000), QuietWorld(1, system_values(program))
    return observe(lambda sink: TreeExecutor(program, limits=limits, sink=sink), world, most)


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
    seen = executed(main, 5_000)
    assert isinstance(seen.last, End)
    assert seen == executed(main, 5_000)


def test_palletiser_runs_on() -> None:
    """The palletiser's cell program, with BAS, messages and motions, runs without a fault."""
    seen = executed("palletiser/KRC/R1/cell.src", 3_000)
    assert seen.is_cut
    assert not isinstance(seen.last, Fail | Crash)
    assert all(map(seen.events_of, ("line", "assign", "call", "return", "branch")))
