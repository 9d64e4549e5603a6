"""An archive is the same project at every level at which it is cut, for `run` and for `check`.

Only where folders are lost is anything else seen, and then alike however what is left is laid out.
"""

import json
import shutil
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import Any
from zipfile import ZipFile

import pytest

from krl.cli import main

CELLS = Path(__file__).parents[2] / "corpus" / "programs"
#: An argument is missing, which only another file can tell, and two types do not agree.
FAULTY = 'DEF faulty ( )\nINT N\nN="A"\nBAS (#INITMOV )\nEND\n'

#: The tree needs no translation of the whole archive.
QUICK = ("--executor", "tree", "--io", "auto", "--until", "2")

Names = Callable[[str], str]
Seen = tuple[int, list[dict[str, Any]], list[tuple[str, str, int]]]


def _renamed(**names: str) -> Names:
    return lambda name: names.get(name, name)


#: Whole archives: the folder of the cell that is copied, where to, and other names of folders.
WHOLE: dict[str, tuple[str, str, Names]] = {
    "a folder around the archive": ("", "cell", _renamed()),
    "KRC": ("KRC", "KRC", _renamed()),
    "a folder of another name": ("KRC", "backup of today", _renamed()),
    "R1 under another name": ("KRC", "KRC", _renamed(R1="Robot_9")),
    "in small letters": ("", "cell", str.lower),
}
#: What is left of an archive: the drive alone, and its programs alone.
DRIVES = {
    "R1": ("KRC/R1", "cut/R1", _renamed()),
    "a drive of another name": ("KRC/R1", "cut", _renamed()),
}
PROGRAMS = {
    "Program": ("KRC/R1/Program", "cut/Program", _renamed()),
    "a folder of programs": ("KRC/R1/Program", "cut", _renamed()),
}


def _copy(cell: str, target: Path, level: tuple[str, str, Names]) -> None:
    part, top, name = level
    source = CELLS / cell / part
    for file in filter(Path.is_file, source.rglob("*")):
        *folders, last = file.relative_to(source).parts
        copy = target.joinpath(top, *map(name, folders), last)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, copy)


def _file(folder: Path, name: str) -> Path:
    return next(one for one in folder.rglob("*") if one.name.lower() == name.lower())


def _seen(file: Path, faulty: Path, out: Path, capsys: pytest.CaptureFixture[str]) -> Seen:
    """Exit status and trace of a run, and the findings of a check, with names of files only."""
    status = main(["run", str(file), *QUICK, "--trace", str(out)])
    capsys.readouterr()
    main(["check", str(faulty), "--format", "json", "--no-cache", "--no-settings", "--jobs", "1"])
    findings = json.loads(capsys.readouterr().out)
    events = [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]
    for event in events:
        event["at"] = event["at"] and PurePosixPath(event["at"]).name
    told = [(PurePosixPath(one["path"]).name, one["code"], one["line"]) for one in findings]
    return status, events, [one for one in told if one[0] == "faulty.src"]


@pytest.mark.parametrize(
    ("cell", "program", "levels"),
    [
        ("spot_cell", "Seite_Links.src", WHOLE),
        ("spot_cell", "Seite_Links.src", DRIVES),
        ("eki_client", "vision_pick.src", PROGRAMS),
    ],
    ids=["whole", "drive", "programs"],
)
def test_levels(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    cell: str,
    program: str,
    levels: dict[str, tuple[str, str, Names]],
) -> None:
    """A program has one trace and one set of findings at all levels that hold the same files."""
    seen: dict[str, Seen] = {}
    for number, (title, level) in enumerate(levels.items()):
        folder = tmp_path / str(number)
        _copy(cell, folder, level)
        file = _file(folder, program)
        faulty = file.with_name("faulty.src")
        faulty.write_text(FAULTY, encoding="utf-8")
        seen[title] = _seen(file, faulty, tmp_path / "trace.jsonl", capsys)
    first, *others = seen.values()
    assert len(first[1]) > 5
    assert 3 in [line for _, _, line in first[2]]
    assert [first] * len(others) == others


def test_zip(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A program has the same trace in a .zip as in the folder that it was made of."""
    _copy("spot_cell", tmp_path, WHOLE["KRC"])
    file = _file(tmp_path / "KRC", "Seite_Links.src")
    with ZipFile(tmp_path / "cell.zip", "w") as archive:
        for one in filter(Path.is_file, (tmp_path / "KRC").rglob("*")):
            archive.write(one, one.relative_to(tmp_path))
    out = tmp_path / "trace.jsonl"
    packed = tmp_path / "cell.zip" / file.relative_to(tmp_path)
    texts = []
    for one in (file, packed):
        main(["run", str(one), *QUICK, "--trace", str(out)])
        texts.append(out.read_text(encoding="utf-8").replace('"KRC/', '"'))
    capsys.readouterr()
    assert len(texts[0].splitlines()) > 5
    assert texts[0] == texts[1]
