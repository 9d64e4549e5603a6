"""Mutants of the machine: the fuzzer finds wrong ones, ends endless ones, passes a right one."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import NoReturn

import pytest

from conformance.sensitivity import fuzzed_mutants
from conformance.sensitivity.code_exchange import load
from conformance.sensitivity.fuzzed_mutants import MACHINE, ReferenceRuns, Verdict, record_of
from conformance.sensitivity.mutants import Mutant, all_mutants, named
from krl.cli import main

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no POSIX signals")


@pytest.fixture(scope="module")
def reference() -> ReferenceRuns:
    """Programs with the runs of the reference, each of which is made once."""
    load()
    return ReferenceRuns(1, 12)


def _mutant(function: str, now: str) -> Mutant:
    """The first mutant of a function of the machine's control flow that has this now."""
    every = (named(one) for one in all_mutants([MACHINE]) if "control_flow" in one)
    return next(one for one in every if (one.function, one.now) == (function, now))


def test_a_wrong_machine_is_found(reference: ReferenceRuns) -> None:
    """Jumps that go the other way diverge from the reference, and the machine is right again."""
    wrong = _mutant("ControlRules._jump_unless", "not pop()")
    found = reference.examine(wrong)
    assert found.found_by is not None
    assert found == reference.examine(wrong)


def test_a_right_machine_is_not_found(reference: ReferenceRuns) -> None:
    """A change that no program shows is told as not found, on all programs."""
    unseen = _mutant("_jump", "target >= site.place")
    found = reference.examine(unseen)
    assert (None, 12) == (found.found_by, found.runs)
    record = record_of([found, Verdict(unseen, 3, 2)], 12, 1)
    assert (2, 1, 0.5, 2) == tuple(
        record[name] for name in ("mutants", "found", "share", "median_runs")
    )
    assert [None, 3] == [one["program"] for one in record["verdicts"]]


def test_what_never_ends_is_found(
    reference: ReferenceRuns, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run that takes more than its time has no facts, unlike that of the reference."""
    unseen = _mutant("_jump", "target >= site.place")
    reference.examine(unseen)
    monkeypatch.setattr(fuzzed_mutants, "_COMPUTING", 0.02)
    monkeypatch.setattr(fuzzed_mutants, "trace_of", _endless)
    assert reference.examine(unseen).found_by is not None


def _endless(*_given: object) -> NoReturn:
    while True:
        pass


def test_the_command_draws_the_same_mutants_in_any_number_of_processes(tmp_path: Path) -> None:
    """Verdicts are those of the drawn mutants, in their order."""
    records = []
    for jobs in ("1", "2"):
        target = tmp_path / f"{jobs}.json"
        words = ["bench", "fuzz", "--mutants", "3", "--programs", "4", "--seed", "5"]
        assert 0 == main([*words, "--jobs", jobs, "--json", str(target)])
        records.append(json.loads(target.read_text(encoding="utf-8")))
    assert records[0] == records[1]
    assert 3 >= records[0]["mutants"] > 0
