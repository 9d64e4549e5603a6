"""The demonstration programs of the own corpus do what they show, with whatever they are run."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from interp.controller.inputs.input_script import Script
from interp.controller.state.trace import TraceEvent
from interp.executors import Prepared, available
from interp.session import RunResult, RunSetup, run_program
from krl.running.program_loading import load_program

PROGRAMS = Path(__file__).parents[2] / "corpus" / "programs"
WAYS = [("tree", "none"), ("vm", "kinematic"), (available()[-1], "mujoco")]
#: Parts in the trays of the demonstration.
PARTS = 3


def run(name: str, executor: str, robot: str, submit: str | None = None) -> RunResult:
    file = PROGRAMS / name / "R1" / "Program" / f"{name}.src"
    script = Script.read(file.with_suffix(".io").read_text(encoding="utf-8"), f"{name}.io")
    setup = RunSetup(executor, robot, script=script, submit=submit, is_full=True)  # type: ignore[arg-type]
    return run_program(Prepared(load_program(file, strict=True)[0]), setup)


@pytest.fixture(scope="module")
def search() -> RunResult:
    """The search on the reference."""
    return run("search_demo", "tree", "none", "count_parts")


@pytest.fixture(scope="module")
def paper() -> RunResult:
    """The example of the paper on the reference."""
    return run("paper_example", "tree", "none")


def of(events: Sequence[TraceEvent], kind: str) -> list[TraceEvent]:
    return [event for event in events if event.kind == kind]


def outputs(events: Sequence[TraceEvent], number: int) -> list[tuple[int, bool]]:
    return [
        (event.time, event.fields["value"])
        for event in of(events, "out")
        if event.fields["number"] == number
    ]


@pytest.mark.parametrize(("executor", "robot"), WAYS[1:])
def test_traces_are_the_same(
    search: RunResult, paper: RunResult, executor: str, robot: str
) -> None:
    """Every executor and robot gives the trace of the tree without a robot, to the last line."""
    if robot == "mujoco":
        pytest.importorskip("mujoco")
    for one, name, submit in (
        (paper, "paper_example", None),
        (search, "search_demo", "count_parts"),
    ):
        other = run(name, executor, robot, submit)
        assert [event.line() for event in one.events] == [event.line() for event in other.events]


def test_output_comes_20_ms_after_the_motion_starts(paper: RunResult) -> None:
    """The trigger of the paper's example switches 20 ms after its motion has started, to the µs."""
    assert "end" == paper.outcome.ending
    second = of(paper.events, "motion_start")[1]
    assert (second.time + 20_000, True) == outputs(paper.events, 2)[0]


def test_paper_example_is_blended(paper: RunResult) -> None:
    """The line C_DIS of the paper's example goes over into the PTP behind it without a stop."""
    kinds = [event.kind for event in paper.events if event.kind.startswith("blend")]
    assert ["blend_start", "blend_apex", "blend_end"] == kinds
    assert [3] == [event.fields["motion"] for event in of(paper.events, "blend_apex")]


def test_search_brakes_and_resumes(search: RunResult) -> None:
    """Each search ends by the interrupt: it brakes, goes back to its level, and moves no more."""
    assert "end" == search.outcome.ending
    assert PARTS == len(of(search.events, "brake")) == len(of(search.events, "resume"))
    assert {0} == {event.fields["depth"] for event in of(search.events, "resume")}
    for brake, resume in zip(of(search.events, "brake"), of(search.events, "resume"), strict=True):
        touched = max(e.time for e in of(search.events, "in") if e.time <= brake.time)
        assert 0 <= brake.time - touched <= 12_000
        assert brake.time < resume.time < brake.time + 200_000
    started = {e.fields["motion"] for e in of(search.events, "motion_start")}
    ended = {e.fields["motion"] for e in of(search.events, "motion_end")}
    assert PARTS == len(started - ended)
