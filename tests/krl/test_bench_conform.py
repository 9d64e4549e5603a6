"""`krl bench conform` and `krl conform --metamorphic`: what they print, write, and refuse."""

import json
from pathlib import Path

import pytest

from conformance.sensitivity.detection import is_possible
from conformance.suite import case as cases
from krl.cli import main

pytest.importorskip("ruckig")
pytest.importorskip("scipy")


@pytest.mark.skipif(not is_possible(), reason="a trial forks a process")
def test_faults_of_a_group_are_planted_and_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each fault of the group is in the record, found or not; cases are timed."""
    names = ("trigger/two_at_once", "trigger/priorities", "control/if_else")
    known = [one for one in cases.find_cases() if one.name in names]
    monkeypatch.setattr(cases, "find_cases", lambda: known)
    target = tmp_path / "bench.json"
    words = ["bench", "conform", "--mutants", "0", "--group", "outputs", "--jobs", "1"]
    assert 0 == main([*words, "--json", str(target)])
    record = json.loads(target.read_text(encoding="utf-8"))
    assert ["outputs"] == [one["group"] for one in record["groups"]]
    assert (
        record["mutants"] == len(record["verdicts"]) == record["killed"] + len(record["survivors"])
    )
    assert 1 == record["killed"]
    assert record["cases_per_s"] > 0
    assert (
        "Not found: outputs: groups have their bits the other way round" in capsys.readouterr().out
    )


@pytest.mark.skipif(not is_possible(), reason="it takes a copy of a process")
def test_mutants_are_drawn_tried_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each mutant of each seed is in the record; those that fail no case are in a file of rows."""
    known = [one for one in cases.find_cases() if one.name == "control/if_else"]
    monkeypatch.setattr(cases, "find_cases", lambda: known)
    target, rows = tmp_path / "bench.json", tmp_path / "survivors.tsv"
    words = ["bench", "conform", "--mutants", "2", "--seed", "5", "--seed", "6", "--group", "none"]
    words += ["--jobs", "1", "--json", str(target), "--survivors", str(rows)]
    assert 0 == main(words)
    found = json.loads(target.read_text(encoding="utf-8"))["drawn"]
    assert [5, 6] == [one["seed"] for one in found["seeds"]]
    assert 4 == found["mutants"] == len(found["trials"])
    left = [one for one in found["trials"] if one["fate"] not in ("red", "invalid")]
    assert 1 + len(left) == len(rows.read_text(encoding="utf-8").splitlines())
    assert "seed 6" in capsys.readouterr().out


def test_laws_are_reported_one_by_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each law has its line and its place in the record; a broken one is status 1."""
    from conformance.metamorphic import law, law_checks

    right = law_checks.LAWS[0]
    wrong = law.Law("wrong", "", (), lambda _left, _right: "they differ", right.change)
    for made, status in (((right,), 0), ((right, wrong), 1)):
        monkeypatch.setattr(law_checks, "LAWS", made)
        target = tmp_path / f"{status}.json"
        words = ["conform", "control/if_else", "--metamorphic", "1", "--jobs", "1"]
        assert status == main([*words, "--json", str(target)])
        record = json.loads(target.read_text(encoding="utf-8"))["metamorphic"]
        assert [one.name for one in made] == [row["name"] for row in record["laws"]]
    assert "they differ" in capsys.readouterr().out
