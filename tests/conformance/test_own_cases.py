"""All cases of this project, on the tree interpreter and on the fastest machine built here."""

import pytest

from conformance.evaluation.execution import Setup, missing
from conformance.lint import SUITES
from conformance.runner import run_case
from conformance.suite.case import Case

MACHINE = "vm" if missing(Setup("native", "none")) else "native"
SETUPS = [Setup("tree", "kinematic"), Setup(MACHINE, "none")]


@pytest.mark.parametrize("suite", SUITES)
def test_no_case_fails(suite: str, own_cases: list[Case]) -> None:
    """Every case of a suite has what it expects, and executors do the same event by event."""
    found = [run_case(case, SETUPS) for case in own_cases if case.suite == suite]
    assert {} == {
        one.case.name: [result.reason for result in one.results if result.verdict == "fail"]
        for one in found
        if one.verdict == "fail"
    }
    assert any(one.verdict == "pass" for one in found)
