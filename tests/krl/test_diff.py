"""`krl diff`: the command, its forms and its exit status."""

import json
import zipfile
from pathlib import Path

import pytest

from krl.cli import main

OLD = "DEF A()\nINT N\nN = 1 ; one\nEND\n"
POINTS = "DEFDAT A\nDECL POS XP1={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0,S 2,T 2}\nENDDAT\n"


@pytest.fixture
def states(tmp_path: Path) -> tuple[str, str]:
    """An old and a new state that differ in a statement and in a point."""
    for name, text, points in (
        ("old", OLD, POINTS),
        ("new", OLD.replace("N = 1", "N = 2"), POINTS.replace("X 0.0", "X 12.5")),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.src").write_text(text, encoding="utf-8")
        (tmp_path / name / "a.dat").write_text(points, encoding="utf-8")
    return str(tmp_path / "old"), str(tmp_path / "new")


def test_differences_are_reported(
    states: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    """Statements with their lines, points with how far they went, and a summary."""
    assert 1 == main(["diff", *states])
    said = capsys.readouterr().out
    assert "a.src:1: A changed\n  line 3, now 3\n  - N = 1\n  + N = 2\n" in said
    assert "a.dat:2: XP1 moved 12.50 mm\n" in said
    assert said.endswith("2 and 2 files: 1 routine, 1 point changed\n")


def test_the_same_is_no_difference(
    states: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status 0, and one line."""
    assert 0 == main(["diff", states[0], states[0]])
    assert "2 and 2 files: nothing changed" == capsys.readouterr().out.rstrip()


def test_file_that_went_is_counted(
    states: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    """The summary counts a file that was removed, also where only data went with it."""
    Path(states[1], "a.dat").unlink()
    Path(states[1], "a.src").write_text(OLD, encoding="utf-8")
    assert 1 == main(["diff", *states])
    assert capsys.readouterr().out.endswith("2 and 1 files: 1 file removed\n")


def test_a_folder_that_moved_is_reported_once(
    states: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Files below another folder than before are one line, a single file one of its own."""
    below = tmp_path / "below"
    for folder, name in (("R1/Deep", "a.src"), ("R1/Deep", "a.dat"), ("R1", "c.src")):
        (below / folder).mkdir(parents=True, exist_ok=True)
        text = (
            OLD.replace("DEF A", "DEF C") if name[0] == "c" else Path(states[0], name).read_text()
        )
        (below / folder / name).write_text(text, encoding="utf-8")
    Path(states[0], "c.src").write_text(OLD.replace("DEF A", "DEF C"), encoding="utf-8")
    assert 1 == main(["diff", states[0], str(below), "--html", str(tmp_path)])
    told = "2 files moved: . -> R1/Deep\nfile moved: c.src -> R1/c.src\n"
    assert capsys.readouterr().out.startswith(told)
    (page,) = tmp_path.glob("*.html")
    file = tmp_path / "changes.html"
    main(["diff", states[0], str(below), "--html", str(file)])
    assert page.read_bytes() == file.read_bytes()
    assert "2 files of . are in R1/Deep now" in page.read_text(encoding="utf-8")


def test_archives_files_and_nothing_are_compared(
    states: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An archive is like its folder; a file beside another name is that file; /dev/null is none."""
    archive = tmp_path / "old.zip"
    with zipfile.ZipFile(archive, "w") as into:
        for name in ("a.src", "a.dat"):
            into.write(Path(states[0], name), name)
    assert 0 == main(["diff", states[0], str(archive)])
    other = tmp_path / "Xy12_a.src"
    other.write_text(OLD, encoding="utf-8")
    assert 0 == main(["diff", f"{states[0]}/a.src", str(other)])
    assert 1 == main(["diff", "/dev/null", f"{states[0]}/a.src"])
    assert "a.src:1: A added, 2 statements" in capsys.readouterr().out


def test_json_and_page_have_the_same(
    states: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The record is printed and written; the page shows statements, point and figures, escaped."""
    (Path(states[1]) / "a.src").write_text(OLD.replace("N = 1", 'N = "<b>"'), encoding="utf-8")
    file, folder = tmp_path / "diff.json", tmp_path / "page"
    main(["diff", *states, "--format", "json", "--json", str(file), "--html", str(folder)])
    record = json.loads(capsys.readouterr().out)
    assert record == json.loads(file.read_text(encoding="utf-8"))
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert '<span class="new">+ N = &#34;&lt;b&gt;&#34;</span>' in page
    assert '<th scope="row">XP1</th><td class="num">12.50</td>' in page


def test_git_is_given_what_says_something(
    states: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    """--textconv prints a file without comments and layout."""
    assert 0 == main(["diff", "--textconv", f"{states[0]}/a.src"])
    assert ["DEF A()", "INT N", "N = 1"] == capsys.readouterr().out.split("\n")[:3]
