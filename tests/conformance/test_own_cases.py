"""All cases of this project, on the tree interpreter and, in part, on the fastest machine here."""

from random import Random

import pytest

from conformance.evaluation.case_run import run_case
from conformance.evaluation.execution import Setup, missing
from conformance.evaluation.verdicts import KnownFailures
from conformance.suite.case import SUITES, Case

ARM = Setup("tree", "kinematic")
MACHINE = Setup("vm" if missing(Setup("native", "none")) else "native", "none")


@pytest.mark.parametrize("suite", SUITES)
def test_no_case_fails(suite: str, own_cases: list[Case]) -> None:
    """Every case of a suite has what it expects.

    On a sixth of them, drawn by seed, executors do the same event by event; `.ci/run` judges all.
    """
    chance, known = Random(suite), KnownFailures.load()
    found = [
        run_case(case, [ARM, MACHINE][: 1 + (chance.random() < 1 / 6)], known)
        for case in own_cases
        if case.suite == suite
    ]
    assert {} == {
        one.case.name: [result.reason for result in one.results if result.verdict == "fail"]
        for one in found
        if one.verdict == "fail"
    }
    assert any(one.verdict == "pass" for one in found)
