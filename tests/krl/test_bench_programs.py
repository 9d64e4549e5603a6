"""`krl bench programs`: which main programs of a backup it finds, and what it says of each."""

import json
from pathlib import Path
from typing import Any

import pytest

from interp.robot.models import model_file
from krl.cli import main

MOVE = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}\n"


@pytest.fixture
def backup(tmp_path: Path) -> Path:
    """A backup with machine data, CELL, main programs and what these call."""
    files = {
        "R1/Program/ends": f"ends ( )\n{MOVE}part ( )\n",
        "R1/Program/part": f"part ( )\n{MOVE}",
        "R1/Program/asks": f"asks ( )\n{MOVE}WAIT FOR $IN[8] AND NOT $IN[7]\n",
        "R1/Program/waits": f"waits ( )\n{MOVE}WAIT FOR $OV_PRO==50\n",
        "R1/Program/halts": f"halts ( )\n{MOVE}HALT\n{MOVE}",
        "R1/Program/turns": "turns ( )\nLOOP\nPTP {A1 10}\nPTP {A1 0}\nENDLOOP\n".replace(
            "LOOP\nPTP", f"{MOVE}LOOP\nPTP", 1
        ),
        "R1/Program/fails": f"fails ( )\n{MOVE}PTP {{A1 999}}\n",
        "R1/Program/lacks": f"lacks ( )\n{MOVE}nothing ( )\n",
        "R1/Program/still": "still ( )\n$OUT[1]=TRUE\n",
        "R1/Program/takes": f"takes (A :IN )\nINT A\n{MOVE}",
        "R1/System/tech": f"tech ( )\n{MOVE}",
        "R1/cell": f"cell ( )\n{MOVE}ends ( )\nwaits ( )\nhalts ( )\n",
    }
    for name, text in files.items():
        file = tmp_path / "cell" / f"{name}.src"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"DEF {text}END\n", encoding="utf-8")
    mada = tmp_path / "cell" / "R1" / "Mada" / "$machine.dat"
    mada.parent.mkdir()
    mada.write_bytes(model_file("kr6r900.dat").read_bytes())
    return tmp_path / "cell"


def results(backup: Path, *options: str) -> dict[str, dict[str, Any]]:
    record = backup.parent / "record.json"
    arguments = ["bench", "programs", str(backup), "--executor", "tree", "--max-time", "24"]
    assert 0 == main([*arguments, *options, "--json", str(record)])
    found = json.loads(record.read_text(encoding="utf-8"))["programs"]
    return {Path(row["path"]).stem: row for row in found}


def test_main_programs_and_their_results(backup: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What CELL alone calls, or nobody, is a main program; a HALT is gone on from by START."""
    found = {name: row["result"] for name, row in results(backup, "--strict").items()}
    assert {
        "cell": "waits",
        "ends": "end",
        "asks": "end",
        "waits": "waits",
        "halts": "end",
        "turns": "goes on",
        "fails": "fault",
        "lacks": "unlinked",
    } == found
    said = capsys.readouterr().out
    assert "8 main programs on the robot none, tree; 0 files that cannot be read" in said
    assert "to its end: 3; waits for ever: 2; never ends: 1; a fault: 1;" in said


def test_what_stands_in(backup: Path) -> None:
    """A routine that a backup lacks stands in, and the row lists it; other rows have none."""
    found = results(backup)
    lacks, fails = found["lacks"], found["fails"]
    assert ("end", 1, ["nothing"]) == (lacks["result"], lacks["motions"], lacks["stood_in"])
    assert ("fault", [], True) == (fails["result"], fails["stood_in"], fails["is_own_fault"])


def test_whose_fault_it_is(backup: Path) -> None:
    """A fault is not the program's own where its line names something that stood in."""
    texts = {
        "own": f"own ( )\nREAL X\n{MOVE}nothing ( )\nX=X+1.0\n",
        "ours": f"ours ( )\n{MOVE}$VEL.CP=other[99]\n$VEL.CP=-other[1]\n",
    }
    for name, text in texts.items():
        file = backup / "R1" / "Program" / f"{name}.src"
        file.write_text(f"DEF {text}END\n", encoding="utf-8")
    found = results(backup)
    assert {"own": ("fault", True), "ours": ("fault", False)} == {
        name: (found[name]["result"], found[name]["is_own_fault"]) for name in texts
    }


def test_where_and_why(backup: Path) -> None:
    """Each row has the place where it ended, why, the motions made and the machine."""
    row = results(backup)["fails"]
    assert row["at"].endswith("R1/Program/fails.src:3")
    assert "(message 1447)" in row["reason"]
    assert (0, "KR6R900 SIZED") == (row["motions"], row["machine"])


def test_inputs_that_are_waited_for(backup: Path) -> None:
    """They come after a second, and the row tells how many had to change; a script has its own."""
    row = results(backup)["asks"]
    assert ("end", 1) == (row["result"], row["inputs"])
    assert 1.58 < row["seconds"] < 1.62
    scripts = backup.parent / "scripts"
    scripts.mkdir()
    (scripts / "asks.io").write_text("t=2 IN[8]=TRUE\n", encoding="utf-8")
    row = results(backup, "--scripts", str(scripts))["asks"]
    assert ("end", 2) == (row["result"], row["inputs"])  # $IN[7] there and back
    assert 2.0 <= row["seconds"] < 2.02


def test_scripts(backup: Path) -> None:
    """A script with the name of an archive or of a program says what the cell does."""
    scripts = backup.parent / "scripts"
    scripts.mkdir()
    (scripts / "waits.io").write_text("t=2 OV_PRO=50\n", encoding="utf-8")
    found = results(backup, "--scripts", str(scripts))
    assert ("end", "waits") == (found["waits"]["result"], found["cell"]["result"])
    (scripts / "cell.io").write_text("t=2 OV_PRO=50\n", encoding="utf-8")
    assert "end" == results(backup, "--scripts", str(scripts))["cell"]["result"]


def test_own_machine_data_is_asked_for(backup: Path) -> None:
    """Programs of a backup without an arm are left aside where that is asked for."""
    (backup / "R1" / "Mada" / "$machine.dat").unlink()
    assert {} == results(backup, "--own-arm")
    assert 8 == len(results(backup))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["missing"], "missing"),
        (["--scripts", "nowhere", "."], "--scripts: nowhere: no such folder"),
        (["--scripts", "bad", "."], "--scripts: "),
    ],
)
def test_bad_input(
    backup: Path,
    options: list[str],
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """What cannot be used is one line with status 2."""
    monkeypatch.chdir(backup)
    (backup / "bad").mkdir()
    (backup / "bad" / "ends.io").write_text("nonsense\n", encoding="utf-8")
    assert 2 == main(["bench", "programs", *options])
    err = capsys.readouterr().err
    assert said in err
    assert 1 == err.count("\n")
