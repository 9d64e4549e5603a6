"""Cases against faults: each case runs with every fault that is not found yet and that it may find.

So a case is read, checked and compiled once. Cases of rules that may fail come first: a fault that
they find turns the night red, one that only others find shows as a verdict that has changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from multiprocessing import get_context
from typing import Any, Final

from conformance.case import Case
from conformance.comparison import first_divergence
from conformance.observation import Observation
from conformance.observing import Setup
from conformance.runner import run_case
from conformance.sensitivity import ahead, interrupting, machine, path, timing
from conformance.sensitivity.planting import Fault, on, several
from conformance.verdicts import KnownFailures
from interp.controller.controller import Controller
from interp.executors import Prepared
from interp.robot.core import ControlCore
from recovery.orphans import end_with_parent

__all__ = ["Verdict", "all_faults", "try_faults"]

#: More often than this nothing happens in a case; a run that goes on has come to no end.
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


@lru_cache(maxsize=1)
def all_faults() -> tuple[Fault, ...]:
    """Every fault there is, group by group."""
    return (
        *timing.faults(),
        *ahead.faults(),
        *interrupting.faults(),
        *path.faults(),
        *machine.faults(),
    )


def try_faults(
    faults: Sequence[Fault],
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> list[Verdict]:
    """What becomes of each fault, in their order; the same whatever ``jobs`` is.

    With more than one job the faults have to be among `all_faults`. ``on_done`` is told how many
    faults were judged since it was told last.
    """
    running = [case for case in cases if case.phase == "run"]
    ordered = sorted(running, key=lambda case: (not case.may_fail, case.name))
    if jobs <= 1:
        found = _Trial(faults).judge(ordered)
        on_done(len(faults))
        return found
    known = {id(one): number for number, one in enumerate(all_faults())}
    numbers = [known[id(one)] for one in faults]
    shares = [range(first, len(numbers), jobs) for first in range(jobs)]
    judged: dict[int, Verdict] = {}
    with ProcessPoolExecutor(jobs, get_context("spawn"), end_with_parent) as pool:
        tasks = [pool.submit(_judged, [numbers[one] for one in share], ordered) for share in shares]
        for share, task in zip(shares, tasks, strict=True):
            judged.update(zip(share, task.result(), strict=True))
            on_done(len(share))
    return [judged[number] for number in range(len(numbers))]


def _judged(numbers: Sequence[int], cases: Sequence[Case]) -> list[Verdict]:
    known = all_faults()
    return _Trial([known[number] for number in numbers]).judge(cases)


class _Trial:
    """Faults that are not found yet."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        self._faults = faults
        self._runs = [0] * len(faults)
        self._found: dict[int, tuple[str, str]] = {}

    def judge(self, cases: Sequence[Case]) -> list[Verdict]:
        """Run the cases until each fault is found, or there are none left."""
        for case in cases:
            if len(self._found) == len(self._faults):
                break
            self._try(case)
        verdicts = []
        for number, one in enumerate(self._faults):
            name, verdict = self._found.get(number, (None, ""))
            verdicts.append(Verdict(one.group, one.words, name, verdict, self._runs[number]))
        return verdicts

    def _try(self, case: Case) -> None:
        usual: dict[tuple[str, str], _Usual | None] = {}
        for number, fault in enumerate(self._faults):
            if number in self._found or (fault.suites and case.suite not in fault.suites):
                continue
            setup = Setup(fault.executor, fault.robot)
            key = (fault.executor, fault.robot)
            if key not in usual:
                usual[key] = _usual(case, setup)
            before = usual[key]
            if before is None or (fault.op and fault.op not in before.ops):
                continue
            self._runs[number] += 1
            verdict = _with(fault, case, setup, before)
            if verdict:
                self._found[number] = case.name, verdict


@dataclass(frozen=True, slots=True)
class _Usual:
    """A case without any fault: what was seen, and the instructions it has on a machine."""

    seen: Observation
    ops: frozenset[str]


def _usual(case: Case, setup: Setup) -> _Usual | None:
    """``None`` for a case that does not pass as it is: it cannot find anything."""
    ops: set[str] = set()

    def make(right: Any) -> Any:
        def executor(self: Prepared, name: str, *given: Any) -> Any:
            if name == "vm":
                ops.update(machine.instructions(self))
            return right(self, name, *given)

        return executor

    with on(Prepared, "executor", make)():
        (result,) = run_case(case, [setup], KnownFailures()).results
    if result.verdict != "pass" or result.observation is None:
        return None
    return _Usual(result.observation, frozenset(ops))


def _with(fault: Fault, case: Case, setup: Setup, before: _Usual) -> str:
    """The verdict on a case with a fault where it is no longer ``pass``, else an empty text."""
    with several(fault.plant, *_ending())():
        (result,) = run_case(case, [setup], KnownFailures()).results
    if result.verdict != "pass":
        return result.verdict
    if setup.executor == "tree" or result.observation is None:
        return ""
    names = ("right", "wrong")
    return "fail" if first_divergence(names, before.seen, result.observation) else ""


def _ending() -> Iterator[Callable[[], Any]]:
    """A run that has come to no end is given up, wherever it goes round."""
    left = [_ENDLESS]

    def make(right: Any) -> Any:
        def counted(self: Any, *given: Any) -> Any:
            left[0] -= 1
            if left[0] < 0:
                raise AssertionError("this never ends")
            return right(self, *given)

        return counted

    yield on(Controller, "_collect", make)
    yield on(ControlCore, "_pass", make)
