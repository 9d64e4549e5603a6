"""The runner: verdicts, comparison of executors, known failures, parallel and deterministic."""

import os
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from conformance import runner
from conformance.evaluation import case_run
from conformance.evaluation.case_run import repeated, run_case
from conformance.evaluation.execution import Setup, missing, observe
from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.trace_comparison import first_divergence
from conformance.evaluation.verdicts import Known, KnownFailures
from conformance.runner import Stopped, run_cases
from conformance.suite.case import Case, read_case

TREE, VM = Setup("tree", "none"), Setup("vm", "none")
NOTHING_KNOWN = KnownFailures()

TEXT = """\
;@ rule: CTL-01
;@ title: a fact
;@ phase: run
DEF fact()
  DECL INT N
  N = 1
  N = N + 1 ;> value N 2
END
"""

MakeCase = Callable[..., Case]


@pytest.fixture
def make(tmp_path: Path) -> MakeCase:
    """A case; each pair of texts replaces one by the other."""

    def make(*changes: tuple[str, str], name: str = "fact") -> Case:
        text = TEXT.replace("DEF fact", f"DEF {name}")
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "control" / f"{name}.src"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return read_case(path, tmp_path)

    return make


def test_case_passes_on_both_interpreters(make: MakeCase) -> None:
    """Each has a result of its own, with what it was seen doing."""
    done = run_case(make(), [TREE, VM], NOTHING_KNOWN)
    assert [("tree", "pass"), ("vm", "pass")] == [(r.executor, r.verdict) for r in done.results]
    assert all(r.observation is not None and r.observation.events for r in done.results)


def test_unmet_expectation_fails_with_its_line(make: MakeCase) -> None:
    """The reason names line, expectation and what was seen."""
    (result,) = run_case(make(("value N 2", "value N 3")), [TREE], NOTHING_KNOWN).results
    assert "fail" == result.verdict
    assert "line 7: value N 3; seen: 2" == result.reason


def test_unconfirmed_rule_fails_no_executor(make: MakeCase) -> None:
    """What rests on recollection is told as that."""
    case = make(("value N 2", "value N 3"), ("CTL-01", "CTL-02"))
    assert "unconfirmed" == run_case(case, [TREE], NOTHING_KNOWN).verdict


def test_known_failure_is_reported_and_its_pass_fails(make: MakeCase) -> None:
    """An entry that is no longer true has to go."""
    known = KnownFailures((Known("control/fact", "not built yet", executor="v*"),))
    wrong = run_case(make(("value N 2", "value N 3")), [TREE, VM], known)
    assert ["fail", "known-failure"] == [one.verdict for one in wrong.results]
    right = run_case(make(), [TREE, VM], known)
    assert ["pass", "fail"] == [one.verdict for one in right.results]
    assert "not built yet" in right.results[1].reason


def test_setup_that_is_not_here_is_skipped_with_its_reason(make: MakeCase) -> None:
    """Nothing is silently left out."""
    done = run_case(make(), [TREE, VM], NOTHING_KNOWN, absent=lambda s: "no" if s == VM else "")
    assert [("pass", ""), ("skipped", "no")] == [(r.verdict, r.reason) for r in done.results]
    assert "there is no executor cobol" in missing(Setup("cobol", "none"))


def test_path_without_a_robot_is_skipped(make: MakeCase) -> None:
    """What nobody could see is neither right nor wrong."""
    (result,) = run_case(make(("value N 2", "passes 1 2 3")), [TREE], NOTHING_KNOWN).results
    assert ("skipped", "needs the robot kinematic") == (result.verdict, result.reason)


def _other_value(case: Case, setup: Setup) -> Observation:
    """The second executor computes one more at the last line."""
    seen = observe(case, TREE)
    if setup == TREE:
        return seen
    events = tuple(
        replace(event, fields={**event.fields, "value": 7})
        if event.kind == "assign" and event.line == 7
        else event
        for event in seen.events
    )
    return replace(seen, events=events)


def test_executors_that_differ_have_failed_whatever_the_rule(make: MakeCase) -> None:
    """The first difference stands at its source line, with both states."""
    case = make(("CTL-01", "CTL-02"), ("value N 2", "runs 1"))
    done = run_case(case, [TREE, VM], NOTHING_KNOWN, see=_other_value)
    assert ["pass", "fail"] == [one.verdict for one in done.results]
    found = done.results[1].divergence
    assert found is not None
    assert ("fact.src", 7) == (found.file, found.line)
    assert ({"N": 2}, {"N": 7}) == (found.left.variables, found.right.variables)
    assert "fact.src:7: tree/none says assign N 2" in str(found)


def _other_robot(case: Case, setup: Setup) -> Observation:
    """On the second robot the last assignment gives another value, or comes later."""
    seen = replace(_other_value(case, VM), robot=setup.robot)
    late = replace(seen.events[-1], time=5_000_000)
    if setup.robot == "none":
        return observe(case, TREE)
    return seen if setup.executor == "tree" else replace(seen, events=(*seen.events[:-1], late))


def test_robots_may_measure_other_values_at_the_same_times(make: MakeCase) -> None:
    """What variables hold may differ by robot, what happens and when may not."""
    case = make(("value N 2", "runs 1"))
    there = Setup("tree", "kinematic")
    assert "pass" == run_case(case, [TREE, there], NOTHING_KNOWN, see=_other_robot).verdict
    late = Setup("native", "kinematic")
    assert "fail" == run_case(case, [TREE, late], NOTHING_KNOWN, see=_other_robot).verdict


def _failing(_case: Case, _setup: Setup) -> Observation:
    raise ZeroDivisionError("in the executor")


def test_exception_of_an_executor_is_a_failed_case(make: MakeCase) -> None:
    """A defect costs its case and no other."""
    (result,) = run_case(make(), [TREE], NOTHING_KNOWN, see=_failing).results
    assert "fail" == result.verdict
    assert any("ZeroDivisionError: in the executor" in one.actual for one in result.checks)


def test_executor_that_never_ends_is_a_failed_case_with_its_name(make: MakeCase) -> None:
    """It has failed though nothing but an unconfirmed rule is at stake."""

    def see(_case: Case, _setup: Setup) -> Observation:
        while True:
            pass

    case = make(("CTL-01", "CTL-02"))
    (result,) = run_case(case, [TREE], NOTHING_KNOWN, see, most=0.05).results
    reason = "crash: it takes more than 0.05 seconds of computing"
    assert ("fail", reason) == (result.verdict, result.reason)


def test_executor_that_waits_for_ever_is_a_failed_case(
    make: MakeCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It needs no processor for that."""
    monkeypatch.setattr(case_run, "MOST_LASTING", 0.05)

    def see(case: Case, setup: Setup) -> Observation:
        sleep(600)
        return observe(case, setup)

    (result,) = run_case(make(), [TREE], NOTHING_KNOWN, see).results
    assert ("fail", "crash: it takes more than 0.05 seconds") == (result.verdict, result.reason)


def test_case_that_does_not_end_is_tried_once(
    make: MakeCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither on the executors after that, nor once more."""
    monkeypatch.setattr(case_run, "MOST_COMPUTING", 0.05)
    begun: list[str] = []

    def see(_case: Case, setup: Setup) -> Observation:
        begun.append(setup.executor)
        while True:
            pass

    done = repeated(lambda: run_case(make(), [TREE, VM], NOTHING_KNOWN, see, most=0.05))
    assert ["fail", "skipped"] == [one.verdict for one in done.results]
    assert "it does not end on tree/none" == done.results[1].reason
    assert ["tree"] == begun


def test_executor_that_crashes_fails_alone(make: MakeCase) -> None:
    """Its exception and the place are the reason, though the others have a trace to compare."""

    def see(case: Case, setup: Setup) -> Observation:
        return observe(case, setup) if setup in (VM, native) else _failing(case, setup)

    native = Setup("native", "none")
    results = run_case(make(), [TREE, VM, native], NOTHING_KNOWN, see).results
    assert ["fail", "pass", "pass"] == [one.verdict for one in results]
    place = f"test_runner.py:{_failing.__code__.co_firstlineno + 1}"
    assert f"crash: ZeroDivisionError: in the executor ({place})" == results[0].reason
    assert results[0].reason == run_case(make(), [VM, TREE], NOTHING_KNOWN, see).results[1].reason


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="there are no such signals")
def test_run_that_is_stopped_keeps_what_is_done(
    make: MakeCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also by a signal; it says what was running."""

    def stop(_signal: int, _frame: object) -> None:
        raise Stopped

    def see(case: Case, setup: Setup) -> Observation:
        if case.name == "control/two":
            os.kill(os.getpid(), signal.SIGUSR1)
        return observe(case, setup)

    monkeypatch.setattr(runner, "observe", see)
    running: list[str] = []
    cases = [make(name=name) for name in ("one", "two", "three")]
    before = signal.signal(signal.SIGUSR1, stop)
    try:
        given = (NOTHING_KNOWN, 1, lambda _: None, None, running.extend)
        done = run_cases(cases, ["tree"], ["none"], *given)
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert ["control/one"] == [one.case.name for one in done]
    assert ["control/two on tree/none"] == running


def test_failed_case_that_passes_when_run_again_is_flaky(make: MakeCase) -> None:
    """It stays failed and its reason says so; one that fails again has its reason alone."""
    seen = [Observation(ending="crash", note="lost"), observe(make(), TREE)]
    bad = "crash: lost"

    def reasons() -> list[str]:
        left = [*seen]
        done = repeated(lambda: run_case(make(), [TREE], see=lambda _case, _setup: left.pop(0)))
        return [f"{one.verdict}: {one.reason}" for one in done.results]

    assert [f"fail: flaky, pass when run again: {bad}"] == reasons()
    seen[1] = seen[0]
    assert [f"fail: {bad}"] == reasons()


def test_run_that_goes_on_differs_from_one_that_ended() -> None:
    """A longer trace differs where the shorter one is over."""
    one = Observation(events=(Event(0, "robot", "line", "a.src", 2),), ending="end")
    more = Observation(events=(*one.events, Event(5, "robot", "line", "a.src", 3)), ending="end")
    found = first_divergence(("one", "more"), one, more)
    assert found is not None
    assert (1, 3, None) == (found.place, found.line, found.left.event)
    assert first_divergence(("one", "one"), one, one) is None
    assert first_divergence(("a", "b"), one, replace(one, ending="running")) is not None


def test_results_are_the_same_in_any_number_of_processes(make: MakeCase) -> None:
    """Order, verdicts and traces do not depend on how the work was shared out."""
    cases = [make(name=f"fact{number}") for number in range(10)]
    counted: list[int] = []
    one = run_cases(cases, ["tree"], ["none"], NOTHING_KNOWN, jobs=1)
    two = run_cases(cases, ["tree"], ["none"], NOTHING_KNOWN, jobs=2, on_done=counted.append)
    assert [r.case.name for r in one] == [r.case.name for r in two]
    assert 10 == sum(counted)
    for left, right in zip(one, two, strict=True):
        first, second = left.results[0].observation, right.results[0].observation
        assert first is not None
        assert second is not None
        assert first.events == second.events


class _Deadly:
    """Ends the process that receives it."""

    def __reduce__(self) -> tuple[Callable[[int], object], tuple[int]]:
        return os._exit, (3,)


def test_case_that_kills_its_process_fails_alone(
    make: MakeCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others are run again without it."""
    monkeypatch.setattr("conformance.runner._SHARE", 1)
    deadly: Any = _Deadly()
    cases = [make(name="one"), replace(make(name="two"), path=deadly)]
    done = run_cases(cases, ["tree"], ["none"], NOTHING_KNOWN, jobs=2)
    assert ["pass", "fail"] == [one.verdict for one in done]
    assert "the process died" == done[1].results[0].reason


def test_file_of_known_failures_is_read_strictly(tmp_path: Path) -> None:
    """An entry without a reason, or with another key, is an error."""
    path = tmp_path / "known.toml"
    path.write_text('[[known]]\ncase = "a/b"\nreason = "so"\nrobot = "mujoco"\n', encoding="utf-8")
    known = KnownFailures.load(path)
    assert "so" == known.reason("a/b", "vm", "mujoco")
    assert not known.reason("a/b", "vm", "none")
    path.write_text('[[known]]\ncase = "a/b"\n', encoding="utf-8")
    with pytest.raises(ValueError, match="reason"):
        KnownFailures.load(path)
