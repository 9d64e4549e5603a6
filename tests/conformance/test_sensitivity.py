"""Planted faults: they change what they say, are removed again, and cases notice them."""

from pathlib import Path

import pytest

from conformance.sensitivity import bench
from conformance.sensitivity.planted_faults import FAULTS, Fault, on
from conformance.sensitivity.trial import try_faults
from conformance.suite.case import CASES, Case, read_case
from interp.controller.state.clock import Clock
from interp.executors import is_available
from interp.robot.planning import blending


def _fault(words: str) -> Fault:
    return next(one for one in FAULTS if one.words == words)


def _cases(*names: str) -> list[Case]:
    return [read_case(CASES / f"{name}.src", CASES) for name in names]


def test_a_fault_is_there_only_while_it_is_planted() -> None:
    """The clock rounds down within the context and up outside of it, even after an error."""
    clock = Clock(12_000)
    plant = on(Clock, "tick_after", lambda _right: lambda _clock, _duration: 12_000)
    seen = []

    def fails() -> None:
        with plant():
            seen.append(clock.tick_after(23_000))
            raise KeyError

    with pytest.raises(KeyError):
        fails()
    assert [12_000] == seen
    assert 24_000 == clock.tick_after(23_000)


def test_each_fault_has_its_name_and_suites(own_cases: list[Case]) -> None:
    """No two are called the same, and the suites that have to find them exist."""
    names = [(one.group, one.words) for one in FAULTS]
    assert len(names) == len(set(names))
    suites = {case.suite for case in own_cases}
    assert set() == {suite for one in FAULTS for suite in one.suites} - suites


@pytest.mark.parametrize(
    ("words", "case"),
    [
        ("outputs are switched a cycle late", "trigger/start_distance_0"),
        ("only the last trigger counts", "trigger/two_at_once"),
        ("a number is declared once and for all", "interrupt/declared_anew"),
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
        [_fault("a number is declared once and for all")],
        _cases("interrupt/declared_anew"),
        executor="compiled",
    )
    assert ("interrupt/declared_anew", "fail") == (found.case, found.verdict)
    assert [] != list(tmp_path.rglob("*.so"))


def test_each_fault_is_reported_when_it_was_judged() -> None:
    """Progress moves with each fault, and nothing depends on how many processes there are."""
    faults, cases = FAULTS[:3], _cases("io/anout_follows", "control/if_else")
    told: list[int] = []
    alone = try_faults(faults, cases, 1, told.append)
    assert [1, 1, 1] == told
    assert alone == try_faults(faults, cases, 2, told.append)
    assert [1] * 6 == told


def test_a_fault_that_changes_nothing_survives() -> None:
    """A fault that nobody can see is told as not found, with how often it was looked for."""
    nothing = Fault("none", "nothing", ("control",), on(blending, "_HALF", lambda half: half))
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
