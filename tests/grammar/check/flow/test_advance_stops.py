"""What stops the advance run, which blends are lost for it, what CONTINUE takes back; by rule."""

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from grammar.check.analysis.context import Context
from grammar.check.flow import advance_stops
from grammar.check.project.batch import CheckOptions, check_paths
from grammar.check.project.framework import check_module
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.link import File, link
from grammar.semantics.predefined import System
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source

MARK = re.compile(r";>\s*(.*)")


def notes(files: Mapping[str, str]) -> list[Diagnostic]:
    """The notes about the first of some files."""
    read = []
    for path, text in files.items():
        syntax = read_module(text, path)
        assert isinstance(syntax, ast.Module), syntax
        read.append(File(path, syntax))
    first = next(iter(files))
    for project, module in link(read).modules():
        if module.path == first:
            source = Source(files[first], first)
            resolution = check_module(project, module, source).resolution
            return list(
                advance_stops.check(Context(project, module, source, resolution, System.load()))
            )
    raise AssertionError(first)


def agrees(*lines: str, data: str = "", name: str = "A.src") -> None:
    """Codes in comments, without their ``KRL6``, are those of the notes on the lines."""
    text = "\n".join(["DEF A()", *lines, "END", ""])
    others = {"A.dat": f"DEFDAT A\n{data}\nENDDAT\n"} if data else {}
    found = notes({name: text, **others})
    expected = [
        (number, f"KRL6{code}")
        for number, line in enumerate(text.splitlines(), 1)
        for marked in MARK.findall(line)
        for code in marked.split()
    ]
    assert expected == sorted((one.region.line, one.code) for one in found), found
    assert {"note"} >= {one.severity for one in found}


@pytest.mark.parametrize(
    ("rule", "statement"),
    [
        ("ADV-04", "HALT"),
        ("ADV-04", "WAIT SEC 0.5"),
        ("ADV-04", "WAIT FOR $FLAG[1]"),
        ("ADV-04", "PULSE($OUT[1], TRUE, 0.5)"),
        ("ADV-04", "ANIN ON X = 1.0 * LEVEL"),
        ("ADV-04", "ANOUT OFF LEVEL"),
        ("ADV-07", "DIGIN OFF LEVEL"),
        ("ADV-05", "$OUT[1] = TRUE"),
        ("ADV-05", "$ANOUT[1] = 0.5"),
        ("ADV-05", "B = $IN[1]"),
        ("ADV-05", "B = NOT ($FLAG[1] AND ($IN[1] OR $FLAG[2]))"),
        ("ADV-05", "LAMP = TRUE"),
        ("ADV-05", "B = CODE == 5"),
        ("ADV-05", "N = THEIRS"),
        ("ADV-06", "$ACT_TOOL = 1"),
        ("ADV-07", "P = $POS_ACT"),
        ("ADV-07", "PTP $AXIS_ACT"),
        ("ADV-07", "X = $POS_ACT.X"),
        ("ADV-07", "$LOAD_A3.M = 5"),
        ("ADV-07", "CREAD(N, STATE)"),
    ],
)
def test_what_stops_the_advance_run(rule: str, statement: str) -> None:
    """Statements and variables that the documentation names are told with their rule."""
    data = """DECL BOOL B
DECL REAL X
DECL INT N
DECL E6POS P
DECL STATE_T STATE
SIGNAL LAMP $OUT[5]
SIGNAL CODE $IN[1] TO $IN[4]
SIGNAL LEVEL $ANIN[1]
IMPORT INT THEIRS IS /R1/OTHER..COUNT"""
    text = f"DEF A()\n{statement}\nEND\n"
    (found,) = notes({"A.src": text, "A.dat": f"DEFDAT A\n{data}\nENDDAT\n"})
    assert ("KRL601", 2) == (found.code, found.region.line)
    assert rule in found.rules


@pytest.mark.parametrize(
    "statement",
    [
        "B = $FLAG[1]",
        "N = N + 1",
        "$VEL.CP = 0.5",
        "$BASE = $NULLFRAME",
        "$OUT_C[1] = TRUE",
        "LIN P C_DIS",
        "INTERRUPT DECL 5 WHEN $IN[1] DO BRAKE",
        "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE",
        "$CYCFLAG[1] = $IN[1] AND $IN[2]",
        "OTHER(N)",
    ],
)
def test_what_does_not(statement: str) -> None:
    """Program data, motion parameters, and what interrupts and triggers do later."""
    agrees(statement, data="DECL BOOL B\nDECL INT N\nDECL E6POS P")


def test_conditions_of_blocks() -> None:
    """A block stops where its condition is evaluated: UNTIL at its end."""
    agrees(
        "IF $IN[1] THEN ;> 01",
        "  N = 1",
        "ENDIF",
        "WHILE $IN[1] ;> 01",
        "ENDWHILE",
        "REPEAT",
        "  N = 2",
        "UNTIL $IN[1] ;> 01",
        "SWITCH $MODE_OP ;> 01",
        "CASE #T1",
        "ENDSWITCH",
        data="DECL INT N",
    )


def test_continue_is_for_the_next_line() -> None:
    """It takes back the stop of the very next line, and a blank line or a comment uses it up."""
    agrees(
        "CONTINUE",
        "$OUT[1] = TRUE",
        "$OUT[2] = TRUE ;> 01",
        "CONTINUE ;> 03",
        "",
        "$OUT[3] = TRUE ;> 01",
        "CONTINUE ;> 03",
        "; a comment",
        "$OUT[4] = TRUE ;> 01",
        "REPEAT",
        "  CONTINUE",
        "UNTIL $IN[1]",
    )


def test_submit_programs_have_no_advance_run() -> None:
    """Nothing is told about a submit program."""
    agrees("WAIT FOR $IN[1]", "$OUT[1] = TRUE", name="A.sub")


def test_blends_that_are_lost() -> None:
    """A stop between an approximated motion and the next one is told at the motion as well."""
    agrees(
        "PTP P C_PTP ;> 02",
        "$OUT[1] = TRUE ;> 01",
        "LIN P C_DIS",
        "N = N + 1",
        "BAS(#VEL_CP, 0.5)",
        "LIN P C_DIS",
        "OTHER(N)",
        "$OUT[1] = TRUE ;> 01",
        "LIN P",
        "$OUT[1] = TRUE ;> 01",
        "SLIN P C_SPL",
        "CONTINUE",
        "$OUT[1] = TRUE",
        "LIN P C_DIS ;> 02",
        "PTP $POS_ACT ;> 01",
        "SPLINE ;> 02",
        "  SPL P",
        "ENDSPLINE C_SPL",
        "WAIT SEC 0.1 ;> 01",
        data="DECL E6POS P\nDECL INT N",
    )


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("LIN P C_DIS", "WAIT SEC 1", "LIN P"), "before the next motion"),
        (
            ("LIN P C_DIS", "IF N == 1 THEN", "WAIT SEC 1", "ENDIF", "LIN P"),
            "where the way leads there",
        ),
        (("LOOP", "IF $FLAG[1] THEN", "HALT", "ENDIF", "LIN P C_DIS", "ENDLOOP"), "where the way"),
    ],
)
def test_certain_and_possible_losses(lines: tuple[str, ...], said: str) -> None:
    """Whether a blend is lost in any case, or on some way only."""
    text = "\n".join(["DEF A()", *lines, "END", ""])
    found = notes({"A.src": text, "A.dat": "DEFDAT A\nDECL E6POS P\nDECL INT N\nENDDAT\n"})
    (lost,) = (one for one in found if one.code == "KRL602")
    assert said in lost.reason


def test_no_blends_without_advance_run() -> None:
    """$ADVANCE = 0 excludes all blends until it is set again, or something is called [ADV-02]."""
    agrees(
        "LIN P C_DIS",
        "$ADVANCE = 0",
        "LIN P C_DIS ;> 04",
        "IF N == 1 THEN",
        "  LIN P C_DIS ;> 04",
        "  $ADVANCE = 3",
        "ENDIF",
        "LIN P C_DIS ;> 04",
        "OTHER()",
        "LIN P C_DIS",
        data="DECL E6POS P\nDECL INT N",
    )


@pytest.mark.parametrize(
    ("body", "is_lost"),
    [
        ("$OUT[1] = TRUE", True),
        ("IF $IN[1] THEN\nHALT\nENDIF\nPTP XP1", True),
        ("N = 1\nINNER()", True),
        ("CONTINUE\n$OUT[1] = TRUE", False),
        ("PTP XP1\n$OUT[1] = TRUE", False),
        ("IF N > 1 THEN\n$OUT[1] = TRUE\nENDIF", False),
        ("N = 1", False),
        ("LOOP\nN = 1\nENDLOOP", False),
        ("WORK()", False),
    ],
)
def test_blends_before_routines_that_stop(tmp_path: Path, body: str, *, is_lost: bool) -> None:
    """A called routine that stops before it moves, by itself or by another, takes the blend."""
    data = "DEFDAT DATA PUBLIC\nDECL GLOBAL INT N=0\nDECL GLOBAL POS XP1={X 1}\nENDDAT\n"
    (tmp_path / "DATA.dat").write_text(data, encoding="utf-8")
    for name, text in {
        "MAIN": "PTP XP1 C_PTP\nBAS(#VEL_PTP, 50)\nWORK()\nPTP XP1",
        "WORK": body,
        "INNER": "WAIT SEC 0",
    }.items():
        (tmp_path / f"{name}.src").write_text(f"DEF {name}()\n{text}\nEND\n", encoding="utf-8")
    found = check_paths([tmp_path], CheckOptions(stops=True), jobs=1).diagnostics
    lost = [(one.path.rpartition("/")[2], one.region.line) for one in found if one.code == "KRL602"]
    assert lost == [("MAIN.src", 2)] * is_lost
