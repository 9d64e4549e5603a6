"""Faults against cases: each fault is tried on the cases that may find it, until one has.

Cases of rules that may fail come first: a fault that they find fails the conformance run, one that
only others find changes a verdict. A machine that diverges from the tree interpreter has failed
whatever the rule. The observation of a case without any fault is made once a process and kept. A
case that cannot find a fault, since its programs lack the instruction, is not run with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from conformance.evaluation.execution import Setup, prepared
from conformance.evaluation.observation import Observation
from conformance.evaluation.trace_comparison import first_divergence
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import run_case
from conformance.sensitivity import (
    advance_run_faults,
    instruction_faults,
    interrupt_faults,
    path_faults,
    timing_faults,
)
from conformance.sensitivity.planted_fault import Fault, on, several
from conformance.suite.case import Case
from interp.controller.scheduler import Scheduler
from interp.robot.api.control_core import ControlCore
from interp.values.faults import LinkError
from support.parallel.ordered_map import ordered_map

__all__ = ["Verdict", "all_faults", "try_faults"]

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


@cache
def all_faults() -> tuple[Fault, ...]:
    """Every fault there is, group by group."""
    return (
        *timing_faults.faults(),
        *advance_run_faults.faults(),
        *interrupt_faults.faults(),
        *path_faults.faults(),
        *instruction_faults.faults(),
    )


def try_faults(
    faults: Sequence[Fault],
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> list[Verdict]:
    """What becomes of each fault, in their order; the same whatever ``jobs`` is.

    With more than one job the faults have to be among `all_faults`. ``on_done`` is called for
    each fault as soon as it has its verdict.
    """
    running = [case for case in cases if case.phase == "run"]
    ordered = tuple(sorted(running, key=lambda case: (not case.may_fail, case.name)))
    verdicts: list[Verdict] = []
    for found in _verdicts(faults, ordered, jobs):
        verdicts.append(found)
        on_done(1)
    return verdicts


def _verdicts(faults: Sequence[Fault], cases: tuple[Case, ...], jobs: int) -> Iterator[Verdict]:
    if jobs <= 1:
        return (_verdict_of(one, cases) for one in faults)
    known = {id(one): number for number, one in enumerate(all_faults())}
    tasks = ((known[id(one)], _of_suites(one, cases)) for one in faults)
    return ordered_map(_verdict_of_number, tasks, jobs=jobs)


def _of_suites(fault: Fault, cases: Sequence[Case]) -> tuple[Case, ...]:
    return tuple(case for case in cases if not fault.suites or case.suite in fault.suites)


def _verdict_of_number(number: int, cases: tuple[Case, ...]) -> Verdict:
    """Functions are not sent from process to process: a fault is known by its number there."""
    return _verdict_of(all_faults()[number], cases)


def _verdict_of(fault: Fault, cases: Sequence[Case]) -> Verdict:
    runs = 0
    setup = Setup(fault.executor, fault.robot)
    for case in _of_suites(fault, cases):
        if fault.op and fault.op not in _instructions(case):
            continue
        usual = _usual(case, setup)
        if usual is None:
            continue
        runs += 1
        verdict = _with(fault, case, setup, usual.seen)
        if verdict:
            return Verdict(fault.group, fault.words, case.name, verdict, runs)
    return Verdict(fault.group, fault.words, None, "", runs)


@dataclass(frozen=True, slots=True)
class _Usual:
    """A case without any fault; ``seen`` is kept where a machine will be compared with it."""

    seen: Observation | None


@cache
def _instructions(case: Case) -> frozenset[str]:
    """The instructions that a case has on a machine; none where it cannot be compiled."""
    program = prepared(case)
    try:
        return (
            frozenset()
            if isinstance(program, LinkError)
            else instruction_faults.instructions(program)
        )
    except LinkError:
        return frozenset()


@cache
def _usual(case: Case, setup: Setup) -> _Usual | None:
    """``None`` for a case that does not pass as it is: it cannot find anything."""
    (result,) = run_case(case, [setup], KnownFailures()).results
    if result.verdict != "pass" or result.observation is None:
        return None
    return _Usual(None if setup.executor == "tree" else result.observation)


def _with(fault: Fault, case: Case, setup: Setup, before: Observation | None) -> str:
    """The verdict on a case with a fault where it is no longer ``pass``, else an empty text."""
    with several(fault.plant, *_ending())():
        (result,) = run_case(case, [setup], KnownFailures()).results
    if before is not None and result.observation is not None:
        names = ("right", "wrong")
        if first_divergence(names, before, result.observation):
            return "fail"
    return "" if result.verdict == "pass" else result.verdict


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
    yield on(ControlCore, "_pass", make)
