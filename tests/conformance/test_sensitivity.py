"""Planted faults: they change what they say, are removed again, and cases notice them."""

from pathlib import Path

import pytest

from conformance.sensitivity import bench
from conformance.sensitivity.planted_fault import Fault, constant, on, several
from conformance.sensitivity.trial import all_faults, try_faults
from conformance.suite.case import CASES, Case, read_case
from interp.controller.state.clock import Clock
from interp.executors import is_available
from interp.robot.planning import blending


def _fault(words: str) -> Fault:
    return next(one for one in all_faults() if one.words == words)


def _cases(*names: str) -> list[Case]:
    return [read_case(CASES / f"{name}.src", CASES) for name in names]


def test_a_fault_is_there_only_while_it_is_planted() -> None:
    """The clock rounds down within the context and up outside of it, even after an error."""
    clock = Clock(12_000)
    plant = constant(Clock, "tick_after", lambda _clock, _duration: 12_000)
    seen = []

    def fails() -> None:
        with plant():
            seen.append(clock.tick_after(23_000))
            raise KeyError

    with pytest.raises(KeyError):
        fails()
    assert [12_000] == seen
    assert 24_000 == clock.tick_after(23_000)


def test_plants_are_put_back_in_any_combination() -> None:
    """Attributes and constants come back as they were."""
    half, cycle = blending._HALF, Clock.__dict__["cycle"]
    plant = several(on(Clock, "cycle", lambda _one: 3), constant(blending, "_HALF", 0.9))
    with plant():
        assert (3, 0.9) == (Clock.__dict__["cycle"], blending._HALF)
    assert (cycle, half) == (Clock.__dict__["cycle"], blending._HALF)


def test_there_are_enough_faults_and_each_has_its_name(own_cases: list[Case]) -> None:
    """There are forty and more; no two are called the same."""
    assert len(all_faults()) >= 40
    names = [(one.group, one.words) for one in all_faults()]
    assert len(names) == len(set(names))
    suites = {case.suite for case in own_cases}
    assert set() == {suite for one in all_faults() for suite in one.suites} - suites


@pytest.mark.parametrize(
    ("words", "case"),
    [
        ("outputs are switched a cycle late", "trigger/start_distance_0"),
        ("only the last trigger counts", "trigger/two_at_once"),
        ("an event is a level, not an edge", "interrupt/called_once"),
        ("nothing is blended", "blending/c_dis_blends"),
        ("CONTINUE does nothing", "advance/continue_spares"),
    ],
)
def test_a_case_finds_a_fault(words: str, case: str) -> None:
    """A case that passes as things are does not with the fault."""
    (found,) = try_faults([_fault(words)], _cases(case))
    assert case == found.case
    assert found.verdict in ("fail", "unconfirmed")


@pytest.mark.skipif(not is_available("compiled"), reason="there is no C compiler")
def test_a_case_finds_a_fault_under_native_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The executor that is asked for runs the case with the fault."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (found,) = try_faults(
        [_fault("an event is a level, not an edge")],
        _cases("interrupt/called_once"),
        executor="compiled",
    )
    assert ("interrupt/called_once", "fail") == (found.case, found.verdict)
    assert [] != list(tmp_path.rglob("*.so"))


def test_each_fault_is_reported_when_it_was_judged() -> None:
    """Progress moves with each fault, and nothing depends on how many processes there are."""
    faults, cases = all_faults()[:3], _cases("io/anout_follows", "control/if_else")
    told: list[int] = []
    alone = try_faults(faults, cases, 1, told.append)
    assert [1, 1, 1] == told
    assert alone == try_faults(faults, cases, 2, told.append)
    assert [1] * 6 == told


def test_a_fault_that_changes_nothing_survives() -> None:
    """A fault that nobody can see is told as not found, with how often it was looked for."""
    nothing = Fault("none", "nothing", ("control",), constant(blending, "_HALF", blending._HALF))
    (found,) = try_faults([nothing], _cases("control/recursion", "control/if_else"))
    assert (None, 2) == (found.case, found.runs)
    record = bench.record_of([found])
    assert [{"group": "none", "fault": "nothing", "runs": 2}] == record["survivors"]
    assert 0.0 == record["share"]


def test_a_run_without_end_is_found() -> None:
    """A fault that lets a program go round for ever is stopped, and counts as found."""
    from interp.controller.scheduler import Scheduler

    def make(_right: object) -> object:
        def settle(self: Scheduler) -> None:
            while True:
                self._collect()

        return settle

    endless = Fault("none", "endless", (), on(Scheduler, "_settle", make))
    (found,) = try_faults([endless], _cases("control/recursion"))
    assert "control/recursion" == found.case
