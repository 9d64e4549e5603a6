"""A cell of one file and a function that runs tests of it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from krl.program_tests.execution import Outcome, run_test
from krl.program_tests.test_files import read_tests

PROGRAM = """\
DEF work(n :IN)
  INT n, i
  count = count + n
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  $VEL.CP = 0.5
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}
  LIN XPICK
  $OUT[1] = TRUE
  WAIT FOR $IN[1]
  FOR i = 1 TO n
    count = count + 1
  ENDFOR
  WHILE $FLAG[9]
    $FLAG[9] = FALSE
  ENDWHILE
  IF measure(count) > 100 THEN
    $OUT[2] = TRUE
  ENDIF
END
DEFFCT REAL measure(a :IN)
  INT a
  SWITCH a
  CASE 0
    RETURN (1.5)
  CASE 1, 2
    RETURN (2.5)
  ENDSWITCH
  RETURN (a / 0)
ENDFCT
"""
DATA = """\
DEFDAT work
DECL INT count=0
DECL POS XPICK={X 545,Y 100,Z 700,A 0,B 150,C 0,S 2,T 2}
ENDDAT
"""
SHARED = 'io = "on OUT[1]=TRUE after 0.2 IN[1]=TRUE"\n'

Write = Callable[[str], Path]
Run = Callable[[str], dict[str, Outcome]]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes the cell and ``test_work.toml``, and returns the path of that."""

    def written(text: str) -> Path:
        (tmp_path / "work.src").write_text(PROGRAM, encoding="utf-8")
        (tmp_path / "work.dat").write_text(DATA, encoding="utf-8")
        path = tmp_path / "test_work.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return written


@pytest.fixture
def run(write: Write) -> Run:
    """Runs all tests of a file: outcomes by the names of tests."""

    def ran(text: str) -> dict[str, Outcome]:
        tests = read_tests(write(SHARED + text))
        return {one.name: run_test(one, tests, executor=None, update=False) for one in tests}

    return ran
