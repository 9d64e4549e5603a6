"""Edits of findings, tried before they are kept."""

import random

import pytest

from grammar.check.project.project_check import read_source
from grammar.check.project.repair import repair
from grammar.diagnostics.diagnostic import Fix, Region, diagnose
from grammar.syntax.source import Source

RIGHT = """DEF WORK()
  INT N
  FOR N = 1 TO 5 STEP 2
    IF N == 3 THEN
      $OUT[1] = TRUE
    ENDIF
  ENDFOR
  PTP {A1 0, A2 -90}
  TURN(N, 2)
END
"""


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("STEP = 2", "STEP  2"),
        ("IF N = 3 THEN", "IF N == 3 THEN"),
        ("IF N = 3", "IF N == 3 THEN"),
        ("$OUT[1] := TRUE", "$OUT[1] = TRUE"),
        ("A2 -90", "A2 -90}"),
        ("END IF", "ENDIF"),
    ],
)
def test_plain_errors_are_mended(wrong: str, right: str) -> None:
    """An edit that makes the line readable is applied, two in a row where one is not enough."""
    whole = right if right != "STEP  2" else "STEP 2"
    text = RIGHT.replace(whole, wrong) if whole in RIGHT else RIGHT.replace(f"{right}}}", wrong)
    text = RIGHT.replace("A2 -90}", wrong) if wrong == "A2 -90" else text
    done = repair(Source(text))
    assert () == read_source(Source(done.text)).diagnostics
    assert RIGHT.split() == done.text.split()


def test_what_is_not_wanted_stays() -> None:
    """Findings that were chosen away are not mended."""
    text = RIGHT.replace("==", "=")
    assert text == repair(Source(text), lambda _: False).text


def test_edits_of_checks() -> None:
    """What a check would write is written, beside what a syntax error would."""
    text = RIGHT.replace("== 3", "= 3").replace("TURN(N, 2)", "TURN(N, F)")
    at = text.splitlines().index("  TURN(N, F)") + 1
    end = Region(at, 12, at, 12)
    found = diagnose("array-without-index", "", end, "", fix=Fix("", end, "[]"))
    done = repair(Source(text), checked=[found])
    assert done.text == RIGHT.replace("TURN(N, 2)", "TURN(N, F[])")
    spoiling = diagnose("array-without-index", "", end, "", fix=Fix("", end, "["))
    assert "TURN(N, F)" in repair(Source(text), checked=[spoiling]).text


@pytest.mark.parametrize("seed", range(40))
def test_no_repair_does_harm(seed: int) -> None:
    """With a token dropped or doubled anywhere a repair touches no line but those it names."""
    chance = random.Random(seed)
    words = RIGHT.replace("\n", " \n ").replace("(", " ( ").replace("[", " [ ").split(" ")
    at = chance.randrange(len(words))
    words[at : at + 1] = chance.choice([[], [words[at], words[at]]])
    before = Source(" ".join(words))
    done = repair(before)
    after = Source(done.text)
    named = {one.region.line for one in done.mended}
    changed = {n for n, line in enumerate(after.lines, 1) if line != before.line(n)}
    assert changed <= named
    wrong = len(read_source(before).diagnostics)
    assert len(read_source(after).diagnostics) <= wrong - bool(named)
