"""Mistakes are planted by chance, and what finds them is the check alone."""

from pathlib import Path

from grammar.bench.planted_mistakes import measure_planted
from grammar.bench.slips import KINDS

CELL = """DEF CELL()
  DECL INT COUNTER
  COUNTER = 1
  $OUT[3] = TRUE
  IF COUNTER > 3 THEN
    WORKING(COUNTER, 2)
  ENDIF
END
DEF WORKING(A:IN, B:IN)
  DECL INT A, B
  A = B + 2
END
"""
MISTAKES, NAMES = KINDS["mistakes"], KINDS["names"]


def test_the_same_seed_gives_the_same_figures(tmp_path: Path) -> None:
    """What was planted and found follows from the seed; another seed plants other mistakes."""
    (tmp_path / "cell.src").write_text(CELL, encoding="utf-8")
    first = measure_planted([tmp_path], 36, 1, MISTAKES)
    assert first == measure_planted([tmp_path], 36, 1, MISTAKES)
    assert first != {**measure_planted([tmp_path], 36, 2, MISTAKES), "seed": 1}
    assert 36 == first["planted"]
    assert first["found"] > 0.6


def test_files_can_be_missing(tmp_path: Path) -> None:
    """A share of the files is left out by the seed, and mistakes are planted in the others."""
    for number in range(20):
        text = CELL.replace("CELL", f"CELL{number}")
        (tmp_path / f"cell{number}.src").write_text(text, encoding="utf-8")
    part = measure_planted([tmp_path], 9, 1, MISTAKES, missing="0.5")
    assert 20 == measure_planted([tmp_path], 9, 1, MISTAKES)["files"]
    assert 0 < part["files"] < 20
    assert 9 == part["planted"]


def test_data_lists_or_all_other_files_can_be_missing(tmp_path: Path) -> None:
    """Alone, a program does not have the data list that its names are one slip away from."""
    (tmp_path / "cell.src").write_text("DEF CELL()\n  GRIPPED = 1\nEND\n", encoding="utf-8")
    data = "DEFDAT CELL\nDECL INT GRIPPED=0\nENDDAT\n"
    (tmp_path / "cell.dat").write_text(data, encoding="utf-8")
    whole, alone = (
        measure_planted([tmp_path], 12, 5, NAMES, missing=missing) for missing in ("0", "others")
    )
    assert 1 == measure_planted([tmp_path], 12, 5, NAMES, missing="dat")["files"]
    assert 2 == whole["files"] == alone["files"]
    assert "variable" in {row["kind"] for row in whole["names"]}
    assert {"nowhere else"} == {row["kind"] for row in alone["names"]}
    assert whole["found"] > alone["found"]


def test_a_mistake_that_nothing_finds_is_a_survivor(tmp_path: Path) -> None:
    """Nothing is found where every name may come from elsewhere, and the record says which."""
    text = "DEF CELL()\n  AXXX = BYYY + CZZZ\nEND\n"
    (tmp_path / "cell.src").write_text(text, encoding="utf-8")
    record = measure_planted([tmp_path], 60, 3, MISTAKES)
    survivors = {one["kind"] for one in record["survivors"]}
    assert "literal of another type" not in survivors
    assert record["found"] < 1


def test_what_is_missing_causes_findings(tmp_path: Path) -> None:
    """What is found only because files end early is counted apart; whole files cause nothing."""
    for number in range(8):
        (tmp_path / f"cell{number}.src").write_text(CELL, encoding="utf-8")
    whole = measure_planted([tmp_path], 0, 1, MISTAKES)["unplanted"]
    cut = measure_planted([tmp_path], 0, 1, MISTAKES, missing="cut")["unplanted"]
    assert {} == whole["caused"]
    assert cut["caused"]["error KRL001"] == cut["codes"]["error KRL001"] > 0
