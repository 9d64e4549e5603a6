"""`krl debug` at its prompt: commands from standard input, and what it says."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from krl.cli import main

MAIN = """\
DEF MAIN()
  INT I
  FRAME F
  PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  PTP {A1 10.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  F={X 1.0,Y 2.0}
  FOR I=1 TO 3
    TOTAL=TOTAL+TWICE(I)
  ENDFOR
  $OUT[1]=TRUE
END
DEFFCT INT TWICE(N:IN)
  INT N
  RETURN 2*N
ENDFCT
"""
DATA = "DEFDAT MAIN\nINT TOTAL=0\nSIGNAL LAMP $OUT[1]\nENDDAT\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program with its data list."""
    (tmp_path / "main.dat").write_text(DATA, encoding="utf-8")
    file = tmp_path / "main.src"
    file.write_text(MAIN, encoding="utf-8")
    return file


def said(
    program: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    *commands: str,
) -> tuple[int, list[str]]:
    """The exit status, and the lines on standard output."""
    monkeypatch.setattr("sys.stdin", io.StringIO("\n".join(commands) + "\n"))
    status = main(["debug", str(program)])
    found = capsys.readouterr()
    assert "Traceback" not in found.err
    return status, found.out.splitlines()


@pytest.mark.parametrize("executor", ["tree", "vm", "native"])
def test_a_failure_in_an_incomplete_project(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    executor: str,
) -> None:
    """It is a stop; the program continues behind it as in `krl run`, and the way back passes it."""
    file = tmp_path / "main.src"
    lines = ("DEF MAIN()", "INT I", "GONE()", "I=0", "I=1/I", "I=7", "END", "")
    file.write_text("\n".join(lines), encoding="utf-8")
    fault = "fault: division by zero; to continue is to skip it"
    commands = ("c", "goto 6", "c", "p I", "bs", "p I", "bs", "p I", "bs", "c", "n", "q")
    monkeypatch.setattr("sys.stdin", io.StringIO("\n".join(commands) + "\n"))
    assert 0 == main(["debug", str(file), "--executor", executor])
    said = [
        line
        for line in capsys.readouterr().out.splitlines()
        if not line.startswith(("message: ", "0 s; "))
    ]
    assert [
        *("entry", "main.src:3 GONE()"),
        *(fault, "main.src:5 I=1/I"),
        *("refused: the statement has failed: go back to before it", "main.src:5 I=1/I"),
        *("ended: end after 0 s at main.src:6", "7"),
        *("back", "main.src:6 I=7", "0"),
        *("back", "main.src:5 I=1/I", "0"),
        *("back", "main.src:4 I=0"),
        *(fault, "main.src:5 I=1/I"),
        *("step", "main.src:6 I=7"),
    ] == said


def test_breakpoints_values_and_the_way_back(
    program: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Advance run and arm are shown apart; back is back with variables."""
    commands = ("break 14 if N==2", "c", "w", "frame 1", "p I", "bo", "p TOTAL", "bn", "p I", "q")
    status, lines = said(program, monkeypatch, capsys, *commands)
    assert 0 == status
    start = lines.index("breakpoint")
    assert [
        "main.src:14 RETURN 2*N",
        "0 s; the arm moves, main.src:5",
        "*0 TWICE main.src:14 RETURN 2*N",
        "1 MAIN main.src:8 TOTAL=TOTAL+TWICE(I)",
        "main.src:8 TOTAL=TOTAL+TWICE(I)",
        "2",
        "back",
        "main.src:8 TOTAL=TOTAL+TWICE(I)",
        "0 s; the arm moves, main.src:5",
        "2",
        "back",
        "main.src:7 FOR I=1 TO 3",
        "0 s; the arm moves, main.src:5",
        "1",
    ] == lines[start + 1 :]


def test_watches_changes_and_the_end(
    program: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A watch tells both values; what is set counts; the end can be left backwards."""
    commands = (
        *("watch TOTAL", "display I", "c", "set TOTAL = 40", "delete all", "set LAMP=TRUE"),
        *("variables signals", "c", "p TOTAL", "bs", "restart", "next", "p TOTAL", "c", "c"),
    )
    status, lines = said(program, monkeypatch, capsys, *commands)
    assert 0 == status
    assert "watch TOTAL: 0 -> 2" in lines
    assert "I = 1" in lines
    assert "LAMP = TRUE" in lines
    assert ["50", "0"] == [line for line in lines if line.isdigit()]
    assert 2 == sum(line.startswith("ended") for line in lines)
    assert lines[-1].startswith("ended: end after")


@pytest.mark.parametrize(
    ("command", "text"),
    [
        ("fly", "fly is not a command; help lists them"),
        ("break 2", "main.src:2: no statement begins here; the next is line 4"),
        ("break 14 if N=", "N=: this is no expression"),
        ("break x", "break [FILE:]LINE [if CONDITION] [hits N] [log TEXT]"),
        ("break 8 hits %0", "%0: hits are a number such as 3, >=3 or %3"),
        ("p NOWHERE", "NOWHERE is not known here"),
        ("p", ": this is no expression"),
        ("p TWICE(2)", "only variables, constants and operators can be looked at"),
        ("set 3 = 4", "only a variable has parts"),
        ("set I = TRUE", "a value cannot be assigned"),
        ("goto 8", "refused: line 8 is inside the FOR of line 7, which has not begun"),
        ("goto next", "goto: a number is missing"),
        ("frame 7", "there is no frame 7"),
        ("delete 1", "there is no breakpoint 1"),
        ("task arm", "task: one of robot"),
        ("variables all", "variables: one of local, data, config, others, signals"),
        ("back home", "back: one of step, next, out, motion, continue"),
        ("bn", "refused: this is the first statement"),
    ],
)
def test_a_command_that_is_wrong_is_one_line(
    program: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
    text: str,
) -> None:
    """It says why, and the session goes on; what stands in a file makes the status 1."""
    status, lines = said(program, monkeypatch, capsys, command, "p 6*7")
    assert (0 if text.startswith("refused") else 1) == status
    assert text in lines
    assert "42" == lines[-1]


def test_help_lists_all_commands(
    program: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each in a line."""
    _, lines = said(program, monkeypatch, capsys, "help", "help bs")
    assert 24 == sum(": " in line for line in lines[3:])
    assert lines[-1].startswith("back [step|next|out|motion|continue]")


def test_a_repeated_message_is_reported_seldom(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first ten times with its line, then the 100th."""
    file = tmp_path / "main.src"
    point = "PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}"
    loop = f"FOR I=1 TO 105\n{point}\nENDFOR\n"
    file.write_text(f"DEF MAIN()\nINT I\n{point}\n{loop}END\n", encoding="utf-8")
    _, lines = said(file, monkeypatch, capsys, "c", "c")
    told = [line for line in lines if "length of zero" in line]
    assert ["message: main.src:5: a motion has a length of zero"] * 10 == told[-11:-1]
    assert told[-1].endswith("(100 times)")
