"""All cases on the executor or robot of a third party, with one call.

    from conformance.external_backend import prove

    prove(executor=MyExecutor).assert_conforms()

``MyExecutor(program, routine, limits, sink)`` creates an `interp.port.executor.Executor` for a
checked program. ``MyRobot(machine, cycle)`` creates an `interp.robot.simulation.robot.Robot`. Each
case is evaluated by its expectations, and compared event by event with the reference: the tree
interpreter, and the kinematic robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from conformance.evaluation.case_result import CaseResult
from conformance.evaluation.case_run import run_case
from conformance.evaluation.execution import (
    MakeExecutor,
    MakeRobot,
    Setup,
    missing,
    observe,
    observe_with,
)
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.suite.case import CASES, Case, find_cases, selected

__all__ = ["MakeExecutor", "MakeRobot", "NotConforming", "Proof", "prove"]

#: The names of the third party's part and of the reference in results.
CANDIDATE = "candidate"
REFERENCE = "tree"


class NotConforming(AssertionError):
    """Cases have failed; the text names each with its reason."""


@dataclass(frozen=True, slots=True)
class Proof:
    """The results of all cases."""

    results: tuple[CaseResult, ...]

    @property
    def failed(self) -> list[str]:
        """The cases that the candidate failed, each with its reason."""
        return [
            f"{one.case.name}: {result.reason}"
            for one in self.results
            for result in one.results
            if result.verdict == "fail" and CANDIDATE in (result.executor, result.robot)
        ]

    def assert_conforms(self) -> None:
        """Raise `NotConforming` if a case failed, or if no case could be evaluated."""
        every = [result for one in self.results for result in one.results]
        candidate = [one for one in every if CANDIDATE in (one.executor, one.robot)]
        if all(one.verdict == "skipped" for one in candidate):
            raise NotConforming("no case could be evaluated")
        if self.failed:
            count = f"{len(self.failed)} of {len(self.results)} cases failed"
            raise NotConforming("\n".join([count, *self.failed]))


def prove(
    executor: MakeExecutor | None = None,
    robot: MakeRobot | None = None,
    *,
    select: Sequence[str] = (),
    cases: Path = CASES,
) -> Proof:
    """Run all cases of phase run, or the selected ones, on the candidate and on the reference.

    Raises `ValueError` if neither executor nor robot is given, and `CaseError` for a selection that
    names nothing.
    """
    if executor is None and robot is None:
        raise ValueError("give an executor, a robot, or both")
    reference = Setup(REFERENCE, "kinematic" if robot is not None else "none")
    candidate = Setup(
        CANDIDATE if executor is not None else REFERENCE,
        CANDIDATE if robot is not None else reference.robot,
    )

    def see(case: Case, setup: Setup) -> Observation:
        if setup == candidate:
            return observe_with(case, executor, robot)
        return observe(case, setup)

    def absent(setup: Setup) -> str:
        return "" if setup == candidate else missing(setup)

    wanted = [case for case in selected(find_cases(cases), select) if case.phase == "run"]
    known = KnownFailures.load()
    done = [run_case(case, (reference, candidate), known, see, absent) for case in wanted]
    return Proof(tuple(done))
