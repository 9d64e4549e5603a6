"""The archive for executors of others: its files, its schema, and that its reference passes."""

import json
from pathlib import Path
from zipfile import ZipFile

import pytest
from jsonschema import Draft202012Validator

from conformance.exchange.export import SCHEMA, expectations_of, write_export
from conformance.exchange.recording import Recording, evaluate_recording
from conformance.runner import run_cases
from conformance.suite.case import Case, selected

NAMES = ("io/pulse_length", "types/index_read", "syntax/declaration_late", "posture/five_axes_line")


@pytest.fixture(scope="module")
def cases(own_cases: list[Case]) -> list[Case]:
    return selected(own_cases, NAMES)


@pytest.fixture(scope="module")
def archive(cases: list[Case], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("export") / "cases.zip"
    write_export(path, run_cases(cases, ["tree"], ["kinematic"], jobs=1), "0")
    return path


def test_expectations_keep_to_their_schema(own_cases: list[Case]) -> None:
    """Every case of this project can be told so."""
    told = json.loads(json.dumps(expectations_of(own_cases)))
    assert [] == [one.message for one in Draft202012Validator(SCHEMA).iter_errors(told)]


def test_archive_has_the_files_of_cases(archive: Path, cases: list[Case]) -> None:
    """Each case lies in a folder of its own, as a controller holds it."""
    with ZipFile(archive) as opened:
        names = set(opened.namelist())
        text = opened.read("cases/posture/five_axes_line/$machine.dat").decode()
    assert {"expectations.json", "expectations.schema.json", "reference.json"} <= names
    assert {"rules.json", "faults.json", "machines/kr6r900.dat", "profiles/kss8.toml"} <= names
    assert {"LICENSE", "docs/trace.md", "docs/io-scripts.md", "docs/semantics.md"} <= names
    assert {f"cases/{one.name}/{each.path}" for one in cases for each in one.sources} <= names
    assert "$DEF_A4FIX=TRUE" in text


def test_reference_meets_what_is_expected(archive: Path, cases: list[Case], tmp_path: Path) -> None:
    """What our own executor did passes as the recording of a controller does."""
    path = tmp_path / "reference.json"
    with ZipFile(archive) as opened:
        path.write_bytes(opened.read("reference.json"))
    results, wrong = evaluate_recording(Recording.read(path), cases)
    assert [] == wrong
    assert dict.fromkeys(NAMES, "pass") == {one.case.name: one.verdict for one in results}


def test_a_fault_is_reported_by_its_number(
    archive: Path, cases: list[Case], tmp_path: Path
) -> None:
    """A controller that knows none of our words passes with 1444, and fails with another."""
    with ZipFile(archive) as opened:
        reference = json.loads(opened.read("reference.json"))
    entry = next(one for one in reference["cases"] if one["case"] == "types/index_read")
    found = []
    for number in (1444, 1446):
        for event in entry["events"]:
            if event["kind"] == "fault":
                event |= {"slug": "", "number": number}
        path = tmp_path / "one.json"
        path.write_text(json.dumps(reference | {"cases": [entry]}), encoding="utf-8")
        results, _ = evaluate_recording(Recording.read(path), cases)
        found += [one.verdict for one in results]
    assert ["pass", "fail"] == found


def test_every_word_of_an_expectation_is_explained(archive: Path, own_cases: list[Case]) -> None:
    """Bases are rules of the archive, faults without a number are in its list."""
    with ZipFile(archive) as opened:
        rules = json.loads(opened.read("rules.json"))["rules"]
        faults = {one["slug"] for one in json.loads(opened.read("faults.json"))["faults"]}
    told = expectations_of(own_cases)["cases"]
    expected = [one for case in told for one in (*case["expectations"], case["ending"])]
    ids = {part["id"] for rule in rules for part in (rule, *rule["clauses"])}
    assert set() == {one["basis"] for one in expected} - ids
    words = {one["arguments"][0] for one in expected if one.get("kind") == "fault"}
    assert set() == {word for word in words if not word.isdigit()} - faults
    unsure = next(case for case in told if case["case"] == "data/abs_of_least")["ending"]
    assert {"accepted": ["fault"], "basis": "ARI-12", "may_fail": False} == unsure
