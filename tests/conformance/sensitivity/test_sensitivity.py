"""Planted faults: they change what they say, are removed again, and cases notice them."""

import os
import pickle
from collections.abc import Sequence
from functools import partialmethod
from pathlib import Path

import pytest

from conformance.sensitivity import bench_record, detection
from conformance.sensitivity.detection import Detection, detect_faults, is_possible, reaches_of
from conformance.sensitivity.planted_faults import FAULTS, Fault
from conformance.suite.case import CASES, read_case
from interp.controller.scheduler import Scheduler
from interp.controller.state.clock import Clock
from interp.executors import is_available
from interp.tree.statements import Statements

pytestmark = pytest.mark.skipif(not is_possible(), reason="a detection forks a process")


def _fault(words: str) -> Fault:
    return next(one for one in FAULTS if one.words == words)


def _detections(
    faults: Sequence[Fault], *names: str, executor: str = "tree"
) -> list[Detection[Fault]]:
    cases = [read_case(CASES / f"{name}.src", CASES) for name in names]
    return detect_faults(faults, reaches_of(cases), executor=executor)


def test_a_fault_is_there_only_while_it_is_planted() -> None:
    """The clock rounds down within the context and up outside of it, even after an error."""
    clock = Clock(12_000)
    fault = Fault("", "", Clock, "tick_after", lambda _right: lambda _clock, _duration: 12_000)
    seen = []

    def fails() -> None:
        with fault.plant():
            seen.append(clock.tick_after(23_000))
            raise KeyError

    with pytest.raises(KeyError):
        fails()
    assert [12_000] == seen
    assert 24_000 == clock.tick_after(23_000)


def test_a_detection_that_tells_nothing_is_a_defect(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that ends before its first case is reported, and not taken for a survivor."""
    monkeypatch.setattr(detection, "_outcomes", lambda *_: 1 / 0)
    with pytest.raises(RuntimeError, match="ended before the first case"):
        _detections([_fault("only the last trigger counts")], "trigger/two_at_once")


def test_detections_keep_the_memory_limit_that_is_given() -> None:
    """In a nightly run each process has a limit, which a detection may lower and not raise."""
    import resource  # not on every system

    if not (child := os.fork()):
        try:
            resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
            (found,) = _detections([_fault("only the last trigger counts")], "trigger/two_at_once")
            os._exit(found.fate != "red")
        finally:
            os._exit(2)
    assert 0 == os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def test_no_two_faults_have_the_same_name() -> None:
    """Another process finds a fault by its name."""
    names = [one.name for one in FAULTS]
    assert len(names) == len(set(names))
    assert FAULTS == tuple(map(pickle.loads, map(pickle.dumps, FAULTS)))


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
    (found,) = _detections([_fault(words)], case, "control/if_else")
    assert (case, 1) == (found.case, found.reached)
    assert found.fate in ("red", "soft")


@pytest.mark.skipif(not is_available("compiled"), reason="there is no C compiler")
def test_a_case_finds_a_fault_under_native_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The executor that is asked for runs the case with the fault."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    fault = _fault("a number is declared once and for all")
    (found,) = _detections([fault], "interrupt/declared_anew", executor="compiled")
    assert ("interrupt/declared_anew", "red") == (found.case, found.fate)
    assert [] != list(tmp_path.rglob("*.so"))


def test_detections_do_not_depend_on_the_number_of_processes() -> None:
    """Progress is reported for each fault."""
    names = ("io/anout_follows", "control/if_else")
    reaches = reaches_of([read_case(CASES / f"{name}.src", CASES) for name in names])
    done: list[int] = []
    alone = detect_faults(FAULTS[:3], reaches, 1, on_done=done.append)
    assert [0, 1, 1, 1] == done
    assert alone == detect_faults(FAULTS[:3], reaches, 2)


def test_a_fault_that_changes_nothing_survives() -> None:
    """It is reported with the number of cases that were run."""
    nothing = Fault("none", "nothing", Statements, "_if", partialmethod)
    (found,) = _detections([nothing], "control/recursion", "control/if_else")
    assert ("survived", 2) == (found.fate, found.runs)
    record = bench_record.planted_record([found], "tree")
    assert [{"group": "none", "fault": "nothing", "runs": 2}] == record["survivors"]
    assert 0.0 == record["share"]


def test_a_run_without_end_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fault that makes a program run for ever is noticed by the limit of processor time."""
    monkeypatch.setattr(detection, "_SECONDS", 1.0)

    def make(_right: object) -> object:
        def settle(self: Scheduler) -> None:
            while True:
                self._collect()

        return settle

    endless = Fault("none", "endless", Scheduler, "_settle", make)
    (found,) = _detections([endless], "control/recursion")
    assert ("control/recursion", "red") == (found.case, found.fate)
