"""`krl nightly` that goes on where it was: what is there is not done again, nor trusted blindly."""

import json
from pathlib import Path

import pytest

from krl.cli import main

DATE = "2026-01-02"


def night(folder: Path, capsys: pytest.CaptureFixture[str], *steps: str) -> tuple[int, list[str]]:
    """A night of some steps: its status, and what it told on stdout."""
    only = [word for step in steps for word in ("--only", step)]
    given = ["--date", DATE, "--out", str(folder), "--history", str(folder / "h.jsonl")]
    return main(["nightly", *given, *only]), capsys.readouterr().out.splitlines()


def steps_of(folder: Path) -> dict[str, str]:
    record = json.loads((folder / DATE / "night.json").read_text(encoding="utf-8"))
    return {name: step["status"] for name, step in record["steps"].items()}


def test_what_is_there_is_not_done_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The record of a step is taken as it is; the night is one line, however often it went on."""
    (tmp_path / DATE).mkdir()
    record = tmp_path / DATE / "fuzz.json"
    record.write_text('{"programs": 7, "seed": 1, "divergences": 0}', encoding="utf-8")
    before = record.stat().st_mtime_ns
    for _ in range(2):
        assert 0 == night(tmp_path, capsys, "fuzz")[0]
    assert before == record.stat().st_mtime_ns
    assert {"fuzz": "ok"} == steps_of(tmp_path)
    [line] = (tmp_path / "h.jsonl").read_text(encoding="utf-8").splitlines()
    assert 7 == json.loads(line)["fuzz"]["programs"]


@pytest.mark.parametrize("content", [b"", b"[1]", b'{"programs": 1e999}', b"[" * 90_000, b"\xff"])
def test_a_damaged_record_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes
) -> None:
    """A step whose record cannot be read has failed; it is not taken for done."""
    (tmp_path / DATE).mkdir()
    (tmp_path / DATE / "fuzz.json").write_bytes(content)
    assert 1 == night(tmp_path, capsys, "fuzz")[0]
    assert {"fuzz": "failed: fuzz.json there is damaged"} == steps_of(tmp_path)


def test_a_damaged_history_hides_no_night(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Lines that are no nights are passed over, and the night of before is compared with."""
    (tmp_path / DATE).mkdir()
    (tmp_path / DATE / "fuzz.json").write_text('{"divergences": 0}', encoding="utf-8")
    old = json.dumps({"date": "2026-01-01", "fuzz": {"divergences": 3}})
    damaged = f'{old}\n{"[" * 90_000}\n{{"date": \n\x00\x1b[31m\n'
    (tmp_path / "h.jsonl").write_text(damaged, encoding="utf-8")
    status, out = night(tmp_path, capsys, "fuzz")
    assert (0, "fuzz: divergences 3 → 0") == (status, out[-2])
