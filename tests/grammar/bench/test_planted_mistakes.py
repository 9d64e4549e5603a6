"""Mistakes are planted by chance, and what finds them is the check alone."""

import random
from pathlib import Path

import pytest

from grammar.bench.planted_mistakes import KINDS, Token, damaged, measure_planted

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
LINE = [
    Token("IF", 0, "IF", True),
    Token("NAME", 3, "COUNTER", False),
    Token("GREATER", 11, ">", False),
    Token("NAME", 13, "CALL", False),
    Token("LPAREN", 17, "(", False),
    Token("RPAREN", 18, ")", False),
    Token("INTEGER", 20, "3", False),
]
TEXT = "IF COUNTER > CALL() 3"
#: Lines with a place for what not every line has one for.
OTHERS = {
    "number out of range": [
        Token("NAME", 0, "COUNT", False),
        Token("LBRACKET", 5, "[", False),
        Token("INTEGER", 6, "7", False),
        Token("RBRACKET", 7, "]", False),
    ],
    "end of a block dropped": [Token("ENDIF", 0, "ENDIF", True)],
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_mistake_changes_the_line(kind: str) -> None:
    """Every kind of mistake changes a line that has a place for it, and within the line."""
    for seed in range(30):
        exchange = damaged(kind, OTHERS.get(kind, LINE), random.Random(seed))
        assert exchange is not None
        start, end, new = exchange
        assert 0 <= start <= end <= len(TEXT)
        assert kind in OTHERS or TEXT[start:end].upper() != new.upper()


def test_lines_without_a_place_get_no_mistake() -> None:
    """A line without names, calls or literals cannot get a mistake in one."""
    for kind in ("name misspelt", "argument added", "literal of another type"):
        assert damaged(kind, [Token("ENDIF", 0, "ENDIF", True)], random.Random(1)) is None


def test_the_same_seed_gives_the_same_figures(tmp_path: Path) -> None:
    """What was planted and found follows from the seed; another seed plants other mistakes."""
    (tmp_path / "cell.src").write_text(CELL, encoding="utf-8")
    first = measure_planted([tmp_path], 36, 1)
    assert first == measure_planted([tmp_path], 36, 1)
    assert first != {**measure_planted([tmp_path], 36, 2), "seed": 1}
    assert 36 == first["planted"]
    assert first["found"] > 0.6


def test_files_can_be_missing(tmp_path: Path) -> None:
    """A share of the files is left out by the seed, and mistakes are planted in the others."""
    for number in range(20):
        text = CELL.replace("CELL", f"CELL{number}")
        (tmp_path / f"cell{number}.src").write_text(text, encoding="utf-8")
    part = measure_planted([tmp_path], 9, 1, missing="0.5")
    assert 20 == measure_planted([tmp_path], 9, 1)["files"]
    assert 0 < part["files"] < 20
    assert 9 == part["planted"]


def test_data_lists_or_all_other_files_can_be_missing(tmp_path: Path) -> None:
    """Alone, a program does not have the data list that its names are one slip away from."""
    (tmp_path / "cell.src").write_text("DEF CELL()\n  GRIPPED = 1\nEND\n", encoding="utf-8")
    data = "DEFDAT CELL\nDECL INT GRIPPED=0\nENDDAT\n"
    (tmp_path / "cell.dat").write_text(data, encoding="utf-8")
    kinds = KINDS[:1]
    whole, alone = (
        measure_planted([tmp_path], 12, 5, missing=missing, kinds=kinds)
        for missing in ("0", "others")
    )
    assert 1 == measure_planted([tmp_path], 12, 5, missing="dat", kinds=kinds)["files"]
    assert 2 == whole["files"] == alone["files"]
    assert "variable" in {row["kind"] for row in whole["names"]}
    assert {"nowhere else"} == {row["kind"] for row in alone["names"]}
    assert whole["found"] > alone["found"]


def test_a_mistake_that_nothing_finds_is_a_survivor(tmp_path: Path) -> None:
    """Nothing is found where every name may come from elsewhere, and the record says which."""
    text = "DEF CELL()\n  AXXX = BYYY + CZZZ\nEND\n"
    (tmp_path / "cell.src").write_text(text, encoding="utf-8")
    record = measure_planted([tmp_path], 60, 3)
    survivors = {one["kind"] for one in record["survivors"]}
    assert "literal of another type" not in survivors
    assert record["found"] < 1


def test_what_is_missing_causes_findings(tmp_path: Path) -> None:
    """What is found only because files end early is counted apart; whole files cause nothing."""
    for number in range(8):
        (tmp_path / f"cell{number}.src").write_text(CELL, encoding="utf-8")
    whole = measure_planted([tmp_path], 0, 1)["unplanted"]
    cut = measure_planted([tmp_path], 0, 1, missing="cut")["unplanted"]
    assert {} == whole["caused"]
    assert cut["caused"]["error KRL001"] == cut["codes"]["error KRL001"] > 0
