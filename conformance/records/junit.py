"""Results as JUnit XML, with one test case for each case, executor and robot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from junitparser import Failure, JUnitXml, Skipped, TestCase, TestSuite

from conformance.evaluation.case_result import CaseResult, Result
from support.files.atomic_write import atomic_path


def write_junit(results: Sequence[CaseResult], target: Path) -> None:
    """Write the file atomically; verdicts other than pass and fail are skipped tests."""
    report = JUnitXml("conformance")
    tests: dict[str, list[TestCase]] = {}
    for one in results:
        tests.setdefault(one.case.suite, []).extend(_test(one, result) for result in one.results)
    for name, cases in tests.items():
        suite = TestSuite(name)
        suite.add_testcases(cases)  # adding them singly would recount all of them each time
        report.add_testsuite(suite)
    with atomic_path(target) as part:
        report.write(str(part), pretty=True)


def _test(one: CaseResult, result: Result) -> TestCase:
    stem = one.case.name.rpartition("/")[2]
    setup = f"{result.executor}-{result.robot}" if one.case.phase == "run" else result.executor
    test = TestCase(f"{stem}[{setup}]", f"conformance.{one.case.suite}", result.seconds)
    if result.verdict == "fail":
        failure = Failure(result.reason, "fail")
        failure.text = "\n".join(
            f"{check.file}:{check.line}: {check.text}: {check.state} ({check.actual})"
            for check in result.checks
            if check.state != "met"
        )
        test.result = [failure]
    elif result.verdict != "pass":
        test.result = [Skipped(result.reason, result.verdict)]
    return test
