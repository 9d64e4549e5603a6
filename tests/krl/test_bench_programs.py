"""`krl bench programs`: which main programs of a backup it finds, and what it says of each."""

import json
from pathlib import Path
from typing import Any

import pytest

from interp.robot.models import model_file
from krl.cli import main

MOVE = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}\n"

PROGRAMS = {
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


def lay(backup: Path, programs: dict[str, str]) -> Path:
    """Write a backup with machine data and these programs."""
    for name, text in programs.items():
        file = backup / f"{name}.src"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"DEF {text}END\n", encoding="utf-8")
    mada = backup / "R1" / "Mada" / "$machine.dat"
    mada.parent.mkdir()
    mada.write_bytes(model_file("kr6r900.dat").read_bytes())
    return backup


def some(tmp_path: Path, *names: str) -> Path:
    """A backup of these of the programs."""
    programs = {name: text for name, text in PROGRAMS.items() if name.split("/")[-1] in names}
    return lay(tmp_path / "plant", programs)


@pytest.fixture(scope="module")
def backup(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A backup with CELL, main programs and what these call."""
    return lay(tmp_path_factory.mktemp("backup") / "cell", PROGRAMS)


def results(backup: Path, *options: str) -> dict[str, dict[str, Any]]:
    record = backup.parent / "record.json"
    arguments = ["bench", "programs", str(backup), "--executor", "tree", "--max-time", "24"]
    assert 0 == main([*arguments, *options, "--jobs", "1", "--json", str(record)])
    found = json.loads(record.read_text(encoding="utf-8"))["programs"]
    return {Path(row["path"]).stem: row for row in found}


@pytest.fixture(scope="module")
def found(backup: Path) -> dict[str, dict[str, Any]]:
    """The rows of that backup as they come without options."""
    return results(backup)


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


def test_what_stands_in(found: dict[str, dict[str, Any]]) -> None:
    """A routine that a backup lacks stands in, and the row lists it; other rows have none."""
    lacks, fails = found["lacks"], found["fails"]
    assert ("end", 1, ["nothing"]) == (lacks["result"], lacks["motions"], lacks["stood_in"])
    assert ("fault", [], True) == (fails["result"], fails["stood_in"], fails["is_own_fault"])


def test_whose_fault_it_is(tmp_path: Path) -> None:
    """A fault that is skipped is the program's own unless its line names what stood in."""
    texts = {
        "own": f"own ( )\nREAL X\n{MOVE}nothing ( )\nX=X+1.0\n",
        "ours": f"ours ( )\n{MOVE}$VEL.CP=other[999]\n$VEL.CP=-other[1]\n",
    }
    programs = {f"R1/Program/{name}": text for name, text in texts.items()}
    found = results(lay(tmp_path / "cell", programs))
    assert {"own": ("end", True), "ours": ("end", False)} == {
        name: (found[name]["result"], found[name]["is_own_fault"]) for name in texts
    }
    places = [fault.rpartition("/")[2] for fault in found["own"]["own_faults"]]
    assert ["own.src:5: a value is used that was never set"] == places


def test_where_and_why(found: dict[str, dict[str, Any]]) -> None:
    """Each row has the place where it ended, why, the motions made and the machine."""
    row = found["fails"]
    assert row["at"].endswith("R1/Program/fails.src:3")
    assert "(message 1447)" in row["reason"]
    assert (0, "KR6R900 SIZED") == (row["motions"], row["machine"])


def test_inputs_that_are_waited_for(found: dict[str, dict[str, Any]]) -> None:
    """They come after a second, and the row tells how many had to change."""
    row = found["asks"]
    assert ("end", 1) == (row["result"], row["inputs"])
    assert 1.58 < row["seconds"] < 1.62


@pytest.mark.parametrize(
    ("options", "found"),
    [
        (["--part", "modules"], {"cell", "ends", "lacks"}),
        (["--part", "file"], {"cell", "ends", "lacks", "part", "tech"}),
        (["--sample", "0.5", "--seed", "6"], {"ends", "lacks"}),
        (["--sample", "0"], set()),
    ],
)
def test_incomplete_backups(
    options: list[str], found: set[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parts of a backup are run: what users wrote, each file alone, files or programs by chance."""
    some(tmp_path, "ends", "part", "lacks", "tech", "cell")
    monkeypatch.chdir(tmp_path)
    assert found == set(results(Path("plant"), *options))


def test_damage(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All runs whole and with each kind of damage, which ends a program too; results are kept."""
    some(tmp_path, "ends", "part", "lacks")
    monkeypatch.chdir(tmp_path)
    given = ["bench", "programs", "plant", "--executor", "tree", "--cache", "kept", "--jobs", "1"]
    records = []
    for name in ("first.json", "second.json"):
        assert 0 == main([*given, "--damage", "files,cut", "--seed", "9", "--json", name])
        records.append(json.loads(Path(name).read_text(encoding="utf-8")))
    whole, files, cut = records[0]["damages"]
    assert {"damage": "", "programs": 2, "moved": 2, "served": 2} == whole
    assert ("files", 1, 1) == (files["damage"], files["programs"], files["moved"])
    assert ("cut", 1) == (cut["damage"], cut["programs"])
    assert "files: 1 programs, 100% executed a motion" in capsys.readouterr().out
    assert records[0]["programs"] == records[1]["programs"], "taken over, wall time and all"
