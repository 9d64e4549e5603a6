"""`krl bench arm`: a record of figures, and a word where a robot cannot be measured."""

import json
from pathlib import Path

import pytest

from krl.cli import main

pytest.importorskip("ruckig")
pytest.importorskip("scipy")


def test_the_record(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each robot gets to the end of the program at the same simulated time."""
    target = tmp_path / "out" / "arm.json"
    assert 0 == main(["bench", "arm", "--motions", "8", "--json", str(target)])
    record = json.loads(target.read_text(encoding="utf-8"))
    assert ("arm", 8) == (record["bench"], record["motions"])
    assert ["none", "kinematic", "mujoco"] == [robot["robot"] for robot in record["robots"]]
    times = {robot["simulated_s"] for robot in record["robots"] if "absent" not in robot}
    assert 1 == len(times)
    assert min(times) > 1.0
    assert record["simulated_s_batch"] >= record["simulated_s_lookahead"] > min(times)
    assert record["inverse_per_s"] > 1_000
    said = capsys.readouterr().out
    assert "planning a motion" in said
    assert "times real time" in said


def test_without_mujoco(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where MuJoCo is not installed the bench says so and measures the others."""
    monkeypatch.setattr("interp.bench.arm.find_spec", lambda _: None)
    assert 0 == main(["bench", "arm", "--motions", "3"])
    assert "MuJoCo is not installed" in capsys.readouterr().out
