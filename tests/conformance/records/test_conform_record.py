"""The record and the JUnit file tell of every result."""

import json
from pathlib import Path

import pytest
from junitparser import JUnitXml

from conformance.evaluation.case_result import CaseResult
from conformance.evaluation.verdicts import Known, KnownFailures
from conformance.records.conform_record import record_of
from conformance.records.junit import write_junit
from conformance.runner import run_cases
from conformance.suite.case import Case, selected

NAMES = ["control/exit_for", "control/exit_while", "syntax/advance_six", "motion/lin_is_straight"]
KNOWN = KnownFailures((Known("control/exit_while", "for the sake of the test"),))


@pytest.fixture(scope="module")
def results(own_cases: list[Case]) -> list[CaseResult]:
    cases = selected(own_cases, NAMES)
    return run_cases(cases, ["tree", "vm"], ["kinematic"], KNOWN, jobs=1)


def test_record_counts_what_it_holds(results: list[CaseResult]) -> None:
    """Totals are those of the results, and all of it is JSON."""
    record = record_of(results, ["tree", "vm"], ["kinematic"], version="1", seconds=2.0)
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert (4, 1, 7) == (record["cases_total"], record["negative"], record["runs"])
    assert 7 == sum(record["verdicts"].values())
    assert {"pass": 3, "fail": 1} == {k: v for k, v in record["case_verdicts"].items() if v}
    assert ["syntax", "control", "motion"] == [suite["name"] for suite in record["suites"]]
    assert 254 == len(record["rules"]) == record["coverage"]["rules"]


def test_record_shows_each_case(results: list[CaseResult]) -> None:
    """Source, checks, what was seen, and the path with what it should be."""
    record = record_of(results, ["tree", "vm"], ["kinematic"], version="1", seconds=2.0)
    by_name = {case["name"]: case for case in record["cases"]}
    assert set(NAMES) == set(by_name)
    line = by_name["motion/lin_is_straight"]
    assert "LIN {X 600" in line["files"][0]["text"]
    first, second = line["results"]
    assert ("tree", "vm") == (first["executor"], second["executor"])
    assert {"t", "axes", "poses", "analytic"} == set(first["path"])
    assert len(first["path"]["t"]) == len(first["path"]["poses"])
    assert [445.0, 0.0, 810.0] == first["path"]["analytic"][0]
    assert "motion_start" in {event["kind"] for event in first["events"]}
    assert "line" not in {event["kind"] for event in first["events"]}
    assert "grammar" == by_name["syntax/advance_six"]["results"][0]["executor"]
    assert all(check["state"] == "met" for check in first["checks"])


def test_a_path_is_kept_though_others_ran_without_a_robot(own_cases: list[Case]) -> None:
    """Where the first executors have no robot, the first that has one shows the path."""
    results = run_cases(selected(own_cases, NAMES[3:]), ["tree"], ["none", "kinematic"], jobs=1)
    (case,) = record_of(results, ["tree"], ["none", "kinematic"], version="1", seconds=1.0)["cases"]
    without, moved = case["results"]
    assert "path" not in without
    assert len(moved["path"]["poses"]) > 10
    assert [445.0, 0.0, 810.0] == moved["path"]["analytic"][0]


def test_junit_has_a_test_for_each_result(results: list[CaseResult], tmp_path: Path) -> None:
    """Failures are failures, with what was expected."""
    target = tmp_path / "deep" / "junit.xml"
    write_junit(results, target)
    suites = {suite.name: suite for suite in JUnitXml.fromfile(str(target))}
    assert {"control", "syntax", "motion"} == set(suites)
    assert (4, 2) == (suites["control"].tests, suites["control"].failures)
    names = {test.name for test in suites["motion"]}
    assert {"lin_is_straight[tree-kinematic]", "lin_is_straight[vm-kinematic]"} == names
    assert "listed as a known failure" in target.read_text(encoding="utf-8")
