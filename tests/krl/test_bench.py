"""`krl bench`: what it takes, prints and writes."""

import json
from pathlib import Path

import pytest

from krl.cli import main
from recovery.bench import survey_speed

PROGRAM = "DEF main()\nDECL INT count\ncount = 1\nfold = = 3\nEND\n"


def test_recover_prints_a_table_and_writes_the_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`krl bench recover` measures on the files named, and stdout and record have the figures."""
    monkeypatch.setattr(survey_speed, "call_isolated", lambda function, *given: function(*given))
    (tmp_path / "main.src").write_text(PROGRAM, encoding="utf-8", newline="\n")
    target = tmp_path / "out" / "speed.json"
    given = ["bench", "recover", str(tmp_path), "--json", str(target)]
    assert 0 == main(given)
    said, complained = capsys.readouterr()
    assert "" == complained
    assert said.startswith("1 file, 0.00 MB; 0 parse; 1 failure; Python 3.")
    for row in ("all failures, cold", "ANTLR's Python runtime", "recording"):
        assert row in said
    record = json.loads(target.read_text(encoding="utf-8"))
    assert ("recover", "KRL.g4", len(PROGRAM)) == (
        record["bench"],
        record["grammar"],
        record["bytes"],
    )
    assert {"bytes_per_s", "ratio_vs_antlr_python", "unchanged_s_per_mb"} <= record.keys()


@pytest.mark.slow
def test_scale_measures_both_commands_at_each_size(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A row for each, with the size that was written and the page, and the growth between them."""
    (tmp_path / "main.src").write_text(PROGRAM, encoding="utf-8", newline="\n")
    target = tmp_path / "out" / "scale.json"
    given = ["bench", "scale", str(tmp_path), "--sizes", "0.02,0.01", "--json", str(target)]
    assert 0 == main(given)
    said = capsys.readouterr().out
    record = json.loads(target.read_text(encoding="utf-8"))
    assert ["recover", "check"] * 2 == [row["command"] for row in record["rows"]]
    sizes = [row["bytes"] for row in record["rows"]]
    assert 10_000 <= sizes[0] == sizes[1] < 20_000 <= sizes[2] == sizes[3] < 24_000
    for row in record["rows"]:
        assert 0 < row["seconds"] < 60
        assert 30e6 < row["peak_bytes"] < 1e9
        assert ("check" == row["command"]) == (row["page_bytes"] is None)
    for name in ("recover", "check"):
        assert f"{name}: exponent of CPU time over size {record[f'{name}_exponent']:.2f}" in said
        assert 0.5 < record[f"{name}_memory_growth"] < 2


def test_growth_names_shapes_with_their_slopes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only what was asked for is measured, and the record has its costs."""
    target = tmp_path / "growth.json"
    words = "bench growth --entry format --largest 32 --jobs 1 --shape".split()
    assert 0 == main([*words, "blank lines", "--json", str(target)])
    assert "format: blank lines" in capsys.readouterr().out
    (row,) = json.loads(target.read_text(encoding="utf-8"))["rows"]
    assert ["format", "blank lines", 3] == [row["entry"], row["shape"], len(row["costs"])]


def test_growth_goes_on_from_its_record(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With a time to end at, what the record has is not measured again; no other file is one."""
    target = tmp_path / "growth.json"
    words = "bench growth --entry format --largest 32 --jobs 1 --shape".split()
    row = {"entry": "format", "shape": "blank lines", "costs": []}
    target.write_text(json.dumps({"rows": [row]}), encoding="utf-8")
    again = [*words, "blank lines", "--json", str(target), "--minutes", "1"]
    assert 2 == main(again)  # it says that the shape cannot be made
    assert "nothing to measure" in capsys.readouterr().err
    for text in ("[", "[1]", '{"rows": [1]}'):
        target.write_text(text, encoding="utf-8")
        assert 2 == main(again)
        assert capsys.readouterr().err.endswith("not a record of krl bench growth\n")


def test_growth_leaves_out_what_cannot_be_made(capsys: pytest.CaptureFixture[str]) -> None:
    """No refusal is measured where a program does not compile whose code was to be read."""
    words = "bench growth --entry asm --largest 32 --jobs 1 --shape".split()
    assert 2 == main([*words, "blocks never closed"])
    assert "nothing to measure" in capsys.readouterr().err
