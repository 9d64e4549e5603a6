"""Which files are one project, from wherever one enters it."""

from itertools import chain
from pathlib import Path, PurePath
from zipfile import ZipFile

import pytest

from krl.cli import main
from krl.library import check
from krl.running.program_loading import load_program
from krl.running.project_folders import project_root
from krl.running.project_sources import read_sources

FILES = {
    "R1/Program/main.src": "DEF main ( )\nhelp ( )\nEND\n",
    "R1/Program/Parts/part.src": "DEF part ( )\nhelp ( )\nEND\n",
    "R1/System/help.src": "DEF help ( )\nHALT\nEND\n",
    "R1/System/$config.dat": "DEFDAT $CONFIG\nENDDAT\n",
    "STEU/Mada/$custom.dat": "DEFDAT $CUSTOM PUBLIC\nENDDAT\n",
}


def _backup(folder: Path, names: dict[str, str] | None = None) -> Path:
    """A backup in a folder, with other names for some of its folders."""
    for path, text in FILES.items():
        parts = [(names or {}).get(part, part) for part in path.split("/")]
        file = folder.joinpath(*parts)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return folder


def _files(file: Path) -> list[str]:
    program, left = load_program(file)
    assert [] == left
    return sorted(unit.module.path for unit in program.units.values())


@pytest.mark.parametrize("around", ["KRC", "backup", "backup/KRC"])
@pytest.mark.parametrize("entry", ["Program/main", "Program/Parts/part", "System/help"])
def test_entry_by_any_file(tmp_path: Path, around: str, entry: str) -> None:
    """A file of a backup leads to all files of its controller, however deep it lies."""
    backup = _backup(tmp_path / around)
    assert sorted(FILES) == _files(backup / "R1" / f"{entry}.src")


@pytest.mark.parametrize("folder", ["", "R1", "R1/Program", "R1/System", "R1/Program/Parts"])
def test_entry_by_any_folder(tmp_path: Path, folder: str) -> None:
    """A folder on the way to a file belongs to the same project as the file."""
    backup = _backup(tmp_path / "KRC")
    wanted = backup if folder else tmp_path / "KRC"
    assert wanted == project_root(backup / folder)


def test_two_controllers(tmp_path: Path) -> None:
    """Two controllers side by side stay two, under whatever names."""
    for name in ("left", "right"):
        _backup(tmp_path / name, {"R1": "Robot"})
    files = _files(tmp_path / "left" / "Robot" / "Program" / "main.src")
    assert len(FILES) == len(files)


TREES = {
    "folders that call one another": {
        "one/cell/job/main.src": "grip",
        "one/cell/parts/lib/grip.src": "",
        "one/cell/parts/other/idle.src": "lost",
    },
    "copies beside programs": {
        f"{folder}{part}.src": "part" if part == "job" else "lost"
        for folder in ("copies/a/", "copies/b/", "")
        for part in ("job", "parts/part")
    },
    "programs and two controllers": {
        "main.src": "grip",
        "left/R1/Program/main.src": "grip",
        "left/R1/System/$config.dat": "",
        "right/KRC/R1/grip.src": "",
    },
    "two robots in a folder": {
        "robots/left/main.src": "grip",
        "robots/left/x/part.src": "main",
        "robots/right/main.src": "grip",
        "robots/right/x/grip.src": "lost",
    },
}
TREES["much else beside"] = TREES["folders that call one another"] | {
    f"one/cell/notes/{number}.txt": "" for number in range(9)
}


def _written(folder: Path, files: dict[str, str]) -> Path:
    for path, call in files.items():
        (file := folder / path).parent.mkdir(exist_ok=True, parents=True)
        name, text = file.stem, f"{call} ( )\n" if call else ""
        is_list = file.suffix == ".dat"
        content = f"DEFDAT {name}\nENDDAT\n" if is_list else f"DEF {name} ( )\n{text}END\n"
        file.write_text(content, "utf-8")
    return folder


def _packed(folder: Path, archive: Path) -> Path:
    with ZipFile(archive, "w") as packed:
        for one in sorted(folder.rglob("*")):
            packed.write(one, one.relative_to(folder))
    return archive


def _seen(path: Path) -> list[str]:
    """What a check finds in files and folders, with ``complete`` names that a project lacks."""
    return sorted(
        f"{Path(one.path).name} {one.message}" for one in check(path, complete=True).findings
    )


@pytest.mark.parametrize("tree", TREES)
def test_tree(tree: str, tmp_path: Path) -> None:
    """A file has one project in a folder and in an archive, for a run and for a check."""
    folder = _written(tmp_path / "tree", TREES[tree])
    archive = _packed(folder, tmp_path / "tree.zip")
    assert _seen(folder) == _seen(archive)
    for path in TREES[tree]:
        if path.endswith(".src"):
            assert _files(folder / path) == _files(archive / path)
    entries = {path: _seen(folder / path) for path in TREES[tree] if not path.endswith(".txt")}
    assert any(entries.values())
    for outer in {parent for path in entries for parent in PurePath(path).parents}:
        inside = (entries[path] for path in entries if outer in PurePath(path).parents)
        assert sorted(chain.from_iterable(inside)) == _seen(folder / outer)


def test_link_beside_a_program(tmp_path: Path) -> None:
    """A link is not followed, neither for a program that lies beside it nor for a check."""
    cell = _written(tmp_path, TREES["folders that call one another"]) / "one" / "cell"
    (cell / "latest").symlink_to(cell / "job")
    assert 3 == len(_files(cell / "job" / "main.src"))


def test_unreadable_file_is_left_out(tmp_path: Path) -> None:
    """A file that cannot be read is left out with its reason, and the program is loaded."""
    backup = _backup(tmp_path / "KRC")
    for name, text in (("broken", "DEF broken ( )\nIF\nEND\n"), ("empty", "")):
        (backup / "R1" / "System" / f"{name}.src").write_text(text, encoding="utf-8")
    program, left = load_program(backup / "R1" / "Program" / "main.src")
    assert len(FILES) == len(program.units)
    unread = sorted(reason.partition(":")[0] for reason in left)
    assert ["R1/System/broken.src", "R1/System/empty.src"] == unread


def test_only_what_is_named_is_read_of_a_large_project(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of more bytes than are read, what the program names counts, and the controller's own data."""
    monkeypatch.setattr("krl.running.project_sources._MOST_BYTES", 100)
    for name, text in {
        "main.src": "DEF main ( )\nPart ( )\nEND\n",
        "part.src": "DEF part ( )\nEND\n",
        "part.dat": "DEFDAT part\nENDDAT\n",
        "$config.dat": "DEFDAT $config PUBLIC\nENDDAT\n",
        "other.src": "DEF other ( )\nEND\n",
    }.items():
        (tmp_path / name).write_text(text, "utf-8")
    sources, main, left = read_sources(tmp_path / "main.src")
    assert ["$config.dat", "main.src", "part.dat", "part.src"] == [one.path for one in sources]
    assert ("main.src", ["1 of 5 files that the program does not name"]) == (main, left)


def test_a_program_that_was_loaded_before_runs_as_it_did(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is neither checked nor compiled again, and its trace is the same."""
    lines = "".join(f"n{i} = 1 + {i}\nx = x + n{i} * 0.5\n" for i in range(400))
    names = "".join(f"INT n{i}\n" for i in range(400))
    text = f"DEF long ( )\nREAL x\n{names}x = 0\n{lines}missing ( x )\nEND\n"
    (tmp_path / "long.src").write_text(text)
    traces = []
    for number in range(2):
        trace = tmp_path / f"{number}.jsonl"
        words = [str(tmp_path / "long.src"), "--trace", str(trace), "--trace-level", "full"]
        assert 0 == main(["run", *words])
        traces.append((trace.read_bytes(), capsys.readouterr()))
        monkeypatch.setattr("interp.program.load.load", None)
        monkeypatch.setattr("interp.bytecode.compiler.project.compile_program", None)
    assert traces[0] == traces[1]
