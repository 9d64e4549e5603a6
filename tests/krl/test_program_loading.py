"""Which files are one project, from wherever one enters it."""

from pathlib import Path
from zipfile import ZipFile

import pytest

from krl.cli import main
from krl.running.program_loading import load_program
from krl.running.project_folders import project_paths, project_root
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


MIXED = ("notes.txt", "plan.pdf", "a.png", "b.png", "other.src", "help.src")


@pytest.mark.parametrize("files", [MIXED, ("part.src", *MIXED[4:])])
def test_folder_above(tmp_path: Path, files: tuple[str, ...]) -> None:
    """A folder above is of a project where half of its files are KRL, for a run and a check."""
    for name in (*files, "cell/main.src"):
        (file := tmp_path / name).parent.mkdir(exist_ok=True)
        file.write_text(f"DEF {file.stem} ( )\nEND\n", "utf-8")
    inside = tmp_path / "cell" / "main.src"
    is_taken = files != MIXED
    wanted = ["cell/main.src", *sorted(files)] if is_taken else ["main.src"]
    assert wanted == _files(inside)
    for path in (inside, inside.parent):
        assert [tmp_path if is_taken else tmp_path / "cell"] == project_paths(path)


SIBLINGS = {
    "one/cell/job/main.src": "DEF main ( )\ngrip ( )\nEND\n",
    "one/cell/parts/lib/grip.src": "DEF grip ( )\nEND\n",
    "one/cell/parts/other/idle.src": "DEF idle ( )\nEND\n",
}


def _written(folder: Path, files: dict[str, str]) -> Path:
    for path, text in files.items():
        (file := folder / path).parent.mkdir(exist_ok=True, parents=True)
        file.write_text(text, "utf-8")
    return folder


def test_folders_beside_that_have_what_is_called(tmp_path: Path) -> None:
    """The smallest folder around that has it is the project, on disk and in an archive."""
    cell = _written(tmp_path, SIBLINGS) / "one" / "cell"
    files = ["job/main.src", "parts/lib/grip.src", "parts/other/idle.src"]
    assert files == _files(cell / "job" / "main.src")
    assert [cell] == project_paths(cell / "job" / "main.src") == project_paths(cell / "job")
    assert ["idle.src"] == _files(cell / "parts" / "other" / "idle.src")
    with ZipFile(tmp_path / "cell.zip", "w") as archive:
        for path in SIBLINGS:
            archive.write(tmp_path / path, path)
    assert files == _files(tmp_path / "cell.zip" / "one" / "cell" / "job" / "main.src")


@pytest.mark.parametrize(
    "more",
    [
        {"one/cell/parts/main.src": "DEF main ( )\nEND\n"},  # another robot
        {f"one/cell/notes/{number}.txt": "" for number in range(4)},  # much else
    ],
)
def test_folders_beside_that_are_left_alone(tmp_path: Path, more: dict[str, str]) -> None:
    """Programs of the same names, or other files for the most part, are no part of a project."""
    _written(tmp_path, SIBLINGS | more)
    assert ["main.src"] == _files(tmp_path / "one" / "cell" / "job" / "main.src")


def test_link_beside_a_program(tmp_path: Path) -> None:
    """A folder with links in it is no backup."""
    _written(tmp_path, SIBLINGS)
    (tmp_path / "one" / "cell" / "latest").symlink_to(tmp_path / "one" / "cell" / "job")
    assert ["main.src"] == _files(tmp_path / "one" / "cell" / "job" / "main.src")


def test_program_among_other_files(tmp_path: Path) -> None:
    """Of a folder in which other files are the most a program has what it names."""
    for name in (*MIXED, "lib/Lib/part.src", "lib/own.src", "text/more/far.src", "main.src"):
        (file := tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        file.write_text(f"DEF {file.stem} ( )\nEND\n", "utf-8")
    (tmp_path / "main.src").write_text("DEF main ( )\nhelp ( )\npart ( )\nEND\n", "utf-8")
    sources, _, left = read_sources(tmp_path / "main.src")
    assert ["help.src", "lib/Lib/part.src", "main.src"] == sorted(one.path for one in sources)
    assert ["3 of 6 files that the program does not name"] == left


@pytest.mark.parametrize("name", ["copies/a/job", "copies/a/parts/part", "job", "copies/b/job"])
def test_archive_without_a_controller(tmp_path: Path, name: str) -> None:
    """Copies side by side in an archive are as little one project as in the folder."""
    folder = tmp_path / "cell"
    for copy in ("copies/a", "copies/b", "."):
        for part in ("job", "parts/part"):
            file = folder / copy / f"{part}.src"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(f"DEF {file.stem}()\nEND\n", "utf-8")
    with ZipFile(tmp_path / "cell.zip", "w") as archive:
        for file in folder.rglob("*.src"):
            archive.write(file, file.relative_to(folder).as_posix())
    path = f"{name}.src"
    assert _files(folder / path) == _files(tmp_path / "cell.zip" / path)


def test_unreadable_file_is_left_out(tmp_path: Path) -> None:
    """A file that cannot be read is left out with its reason, and the program is loaded."""
    backup = _backup(tmp_path / "KRC")
    (backup / "R1" / "System" / "broken.src").write_text("DEF broken ( )\nIF\nEND\n", "utf-8")
    program, left = load_program(backup / "R1" / "Program" / "main.src")
    assert (len(FILES), ["R1/System/broken.src"]) == (
        len(program.units),
        [reason.partition(":")[0] for reason in left],
    )


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
        monkeypatch.setattr("interp.bytecode.compiler.compile_program", None)
    assert traces[0] == traces[1]
