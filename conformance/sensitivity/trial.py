"""Faults against cases: each fault is tried on the cases that may find it, until one has.

Cases of rules that may fail come first: a fault that they find fails the conformance run, one that
only others find changes a verdict.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from conformance.evaluation.execution import Setup
from conformance.runner import run_case
from conformance.sensitivity.planted_faults import FAULTS, Fault, on
from conformance.suite.case import Case
from interp.controller.scheduler import Scheduler
from interp.robot.api.control_core import ControlCore
from support.parallel.ordered_map import ordered_map

#: No case takes more steps than this; a run that does is endless.
_ENDLESS: Final = 60_000


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a fault: the case that found it, with its verdict, or ``None``.

    ``runs`` are the cases that were run with it.
    """

    group: str
    words: str
    case: str | None
    verdict: str
    runs: int


def try_faults(
    faults: Sequence[Fault],
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    executor: str = "tree",
) -> list[Verdict]:
    """What becomes of each fault, in their order; the same whatever ``jobs`` is.

    With more than one job the faults have to be among `FAULTS`. ``on_done`` is called for
    each fault as soon as it has its verdict. ``executor`` runs the cases.
    """
    running = [case for case in cases if case.phase == "run"]
    ordered = tuple(sorted(running, key=lambda case: (not case.may_fail, case.name)))
    verdicts: list[Verdict] = []
    for found in _verdicts(faults, ordered, jobs, executor):
        verdicts.append(found)
        on_done(1)
    return verdicts


def _verdicts(
    faults: Sequence[Fault], cases: tuple[Case, ...], jobs: int, executor: str
) -> Iterator[Verdict]:
    if jobs <= 1:
        return (_verdict_of(one, cases, executor) for one in faults)
    known = {id(one): number for number, one in enumerate(FAULTS)}
    tasks = ((known[id(one)], _of_suites(one, cases), executor) for one in faults)
    return ordered_map(_verdict_of_number, tasks, jobs=jobs)


def _of_suites(fault: Fault, cases: Sequence[Case]) -> tuple[Case, ...]:
    return tuple(case for case in cases if not fault.suites or case.suite in fault.suites)


def _verdict_of_number(number: int, cases: tuple[Case, ...], executor: str) -> Verdict:
    """Functions are not sent from process to process: a fault is known by its number there."""
    return _verdict_of(FAULTS[number], cases, executor)


def _verdict_of(fault: Fault, cases: Sequence[Case], executor: str) -> Verdict:
    runs = 0
    setup = Setup(executor, "kinematic")
    for case in _of_suites(fault, cases):
        if not _passes(case, setup):
            continue
        runs += 1
        verdict = _with(fault, case, setup)
        if verdict:
            return Verdict(fault.group, fault.words, case.name, verdict, runs)
    return Verdict(fault.group, fault.words, None, "", runs)


@cache
def _passes(case: Case, setup: Setup) -> bool:
    """Whether a case passes as it is; one that does not cannot find anything."""
    return run_case(case, [setup]).verdict == "pass"


def _with(fault: Fault, case: Case, setup: Setup) -> str:
    """The verdict on a case with a fault where it is no longer ``pass``, else an empty text."""
    with ExitStack() as stack:
        for plant in (fault.plant, *_ending()):
            stack.enter_context(plant())
        verdict = run_case(case, [setup]).verdict
    return "" if verdict == "pass" else verdict


def _ending() -> Iterator[Callable[[], Any]]:
    """Ends an endless run, wherever its loop is."""
    left = [_ENDLESS]

    def make(right: Any) -> Any:
        def counted(self: Any, *given: Any) -> Any:
            left[0] -= 1
            if left[0] < 0:
                raise AssertionError("this never ends")
            return right(self, *given)

        return counted

    yield on(Scheduler, "_collect", make)
    yield on(ControlCore, "_handle_arm_event", make)
