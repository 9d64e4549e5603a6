"""Which files are one project."""

from collections.abc import Iterable
from pathlib import Path

import pytest

from grammar.semantics.project_grouping import projects_of
from support.files.discovery import FoundFile

#: Paths of files, and the routine that each calls; the sets are the projects.
PROJECTS = {
    "programs in a folder": [{"main.src": "", "part.src": "", "x/y/other.src": ""}],
    "folders that call": [{"a/main.src": "grip", "b/lib/grip.src": "", "c/idle.src": ""}],
    "folders that do not": [{"a/main.src": ""}, {"b/lib/lost.src": ""}],
    "a folder in between": [{"main.src": "", "lib/a/one.src": "", "lib/b/two.src": ""}],
    "two robots": [{"left/main.src": "grip"}, {"right/main.src": "", "right/grip.src": ""}],
    "two robots beside a program": [
        {"idle.src": "x"},
        {"left/main.src": "", "left/grip.src": "main"},
        {"right/main.src": "", "right/grip.src": "main"},
    ],
    "copies of a program": [
        {"main.src": "a", "x/a.src": "", "x/y/b.src": "", "z/c.src": "main"},
        {"old/main.src": "a"},
        {"idle/d.src": ""},
    ],
    "a list twice": [{"a/x.src": "y", "a/$config.dat": ""}, {"b/y.src": "", "b/$config.dat": ""}],
    "a folder inside two robots": [
        {"left/main.src": "", "left/x/a.src": "", "left/x/y/b.src": ""},
        {"right/main.src": ""},
    ],
    "a controller and programs around it": [
        {"cell/R1/Program/main.src": "a", "cell/STEU/Mada/$custom.dat": ""},
        {"a.src": "main", "cell/b.src": ""},
    ],
    "an archive": [{"main.src": "old"}, {"old.zip/old.src": "main"}, {"old.zip/a.zip/a.src": "b"}],
    "letters of any case": [{"a/MAIN.SRC": "grip"}, {"b/main.src": "", "b/grip.src": ""}],
}  # fmt: skip


def _projects(folder: Path, files: Iterable[str]) -> list[list[str]]:
    found = [FoundFile(f"cell/{path}", "", 0, folder / path, None) for path in files]
    return [[one.path.removeprefix("cell/") for one in some] for _, _, some in projects_of(found)]


@pytest.mark.parametrize("name", PROJECTS)
def test_projects(name: str, tmp_path: Path) -> None:
    """A project is what a controller holds, or a folder in which one part needs another.

    Its files keep their order.
    """
    projects = PROJECTS[name]
    for path, call in [pair for some in projects for pair in some.items()]:
        (file := tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        text = f"{call} ( )\n" if call else ";lost ( )\n"
        file.write_text(f"DEF {file.stem} ( )\n{text}END\nDEF lost ( )\nEND\n", "utf-8")
    every = [path for some in projects for path in some]
    assert sorted(map(list, projects)) == sorted(_projects(tmp_path, every))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_calls_are_found_with_any_line_ends(end: str, tmp_path: Path) -> None:
    """A comment ends with its line, and a call behind it makes two folders one project."""
    for path, lines in (
        ("a/main.src", ["; main", "DEF main()", "grip()", "END"]),
        ("b/lib/grip.src", ["DEF grip()", "END", ""]),
    ):
        (file := tmp_path / path).parent.mkdir(parents=True)
        file.write_text(end.join(lines), "utf-8", newline="")
    every = ["a/main.src", "b/lib/grip.src"]
    assert [every] == _projects(tmp_path, every)
