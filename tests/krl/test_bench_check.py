"""`krl bench check`: what it takes, prints and writes."""

import json
from pathlib import Path

import pytest

from grammar.bench import check_speed
from krl.cli import main


def test_figures_are_printed_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stdout and the record have the cost of a MB, the phases and the growth."""
    monkeypatch.setattr(
        check_speed, "call_isolated", lambda function, *arguments: function(*arguments)
    )
    (tmp_path / "A.src").write_text("DEF A()\nEXIT\nEND\n", encoding="utf-8", newline="\n")
    target = tmp_path / "out" / "speed.json"
    given = ["bench", "check", str(tmp_path)]
    given += ["--planted", "0", "--json", str(target)]
    assert 0 == main(given)
    said, complained = capsys.readouterr()
    assert "" == complained
    assert said.startswith("1 file of 1 project, 0.00 MB; 1 warning; Python 3.")
    for row in ("first check", "nothing changed", "building", "resolving"):
        assert row in said
    assert "planted mistakes" not in said
    record = json.loads(target.read_text(encoding="utf-8"))
    assert "check" == record["bench"]
    assert {"s_per_mb", "unchanged_s_per_mb", "phases"} <= record.keys()


def test_mistakes_are_planted_without_measuring_speed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """``--no-speed`` starts no measurement, and tells the findings of each kind of damage."""
    monkeypatch.setattr(check_speed, "call_isolated", lambda *_: pytest.fail("a measurement"))
    (tmp_path / "A.src").write_text("DEF A()\nEXIT\nEND\n", encoding="utf-8", newline="\n")
    given = ["bench", "check", str(tmp_path), "--no-speed", "--planted", "6", "--damage", "tokens"]
    assert 0 == main(given)
    said = capsys.readouterr().out
    for row in ("token dropped", "token exchanged", "findings each in the median file"):
        assert row in said
    assert "first check" not in said
