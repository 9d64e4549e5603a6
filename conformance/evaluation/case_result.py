"""The results of a case: one for each executor and robot."""

from __future__ import annotations

from dataclasses import dataclass

from conformance.evaluation.evaluator import Check
from conformance.evaluation.observation import Observation
from conformance.evaluation.trace_comparison import Divergence
from conformance.evaluation.verdicts import Verdict
from conformance.suite.case import Case


@dataclass(frozen=True, slots=True)
class Result:
    """The result of a case on one executor and robot; ``seconds`` is wall-clock time."""

    executor: str
    robot: str
    verdict: Verdict
    reason: str
    checks: tuple[Check, ...]
    seconds: float
    divergence: Divergence | None = None
    observation: Observation | None = None


@dataclass(frozen=True, slots=True)
class CaseResult:
    """A case with its results, in the order of executors and robots."""

    case: Case
    results: tuple[Result, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst of its verdicts."""
        order: tuple[Verdict, ...] = ("fail", "known-failure", "unconfirmed", "pass", "skipped")
        return min((one.verdict for one in self.results), key=order.index)
