"""`krl bench mutation`: what it prints and writes, and what it refuses."""

import json
from pathlib import Path

import pytest

from krl.cli import main


def test_figures_beside_the_aims(
    tmp_path: Path, small_grammar: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every figure has its row, and the record says what they rest on."""
    grammar, programs = tmp_path / "s.g4", tmp_path / "programs"
    grammar.write_text(small_grammar, encoding="utf-8", newline="\n")
    programs.mkdir()
    for number, line in enumerate(("HALT", "WAIT B", "HALT", "WAIT C")):
        text = f"DEF A()\n{line}\nEND\n"
        (programs / f"{number}.src").write_text(text, encoding="utf-8", newline="\n")
    negatives = tmp_path / "negatives"
    negatives.mkdir()
    target = tmp_path / "out" / "mutation.json"
    options = ["--grammar", str(grammar), "--negatives", str(negatives), "--singles", "3"]
    options += ["--multiple", "0", "--jobs", "1"]
    assert 0 == main(["bench", "mutation", str(programs), *options, "--json", str(target)])
    said, complained = capsys.readouterr()
    assert "" == complained
    record = json.loads(target.read_text(encoding="utf-8"))
    assert (3, 1.0) == (record["mutants"], record["detected"])
    assert ("s.g4", 2) == (record["grammar"], record["held_out"])
    for row in ("rule_top1", "repair_top5", "clusters_per_cause", "false_accept"):
        assert row in said
