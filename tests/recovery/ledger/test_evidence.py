"""Evidence: lines of real files that failed before a construct and are read with it."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.edits import AddToken, Insert, apply
from recovery.ledger.construct import Evidence
from recovery.ledger.evidence import (
    broken_files,
    place,
    restored_files,
    restored_lines,
    with_counts,
)
from recovery.survey.survey import Survey, survey

START = g4.read_file(Path(g4.__file__).parents[1].joinpath("preliminary.g4"))
STEP = apply(START, [AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")])
LOOP = "FOR I=1 TO 9 STEP 2\nX=1\nENDFOR\n"


def surveys(root: Path, files: dict[str, str]) -> tuple[Survey, Survey]:
    """Files written below a folder and surveyed without STEP and with it."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="")
    return survey([root], START, jobs=1), survey([root], STEP, jobs=1)


def test_a_line_counts_where_it_failed_by_itself_and_no_longer_fails(tmp_path: Path) -> None:
    """Lines that still fail, and lines that never did, are no evidence."""
    text = f"DEF A()\n{LOOP}WEAVE 7\n{LOOP}END\n"
    before, after = surveys(tmp_path, {"o1/a.src": text})
    assert [2, 5, 6] == [f.line for f in before.files[0].failures]
    assert [2, 6] == [line.failed.line for line in restored_lines(before, after)]


def test_a_line_that_only_followed_is_no_evidence(tmp_path: Path) -> None:
    """A closer that fails because its opener was not understood says nothing of its own."""
    text = "DEF A()\nSPLINE 1 2\nENDSPLINE\nEND\n"
    (tmp_path / "a.src").write_text(text, encoding="utf-8")
    found = survey([tmp_path], START, jobs=1)
    (failures,) = (file.failures for file in found.files)
    assert any(f.follows for f in failures)
    nothing_fails = replace(found, files=tuple(replace(f, failures=()) for f in found.files))
    lines = [line.failed.line for line in restored_lines(found, nothing_fails)]
    assert [f.line for f in failures if not f.follows] == lines


def test_files_lines_and_origins_are_counted(tmp_path: Path) -> None:
    """Files by their places, lines by their contents, origins as ingest names them."""
    one, two = f"DEF A()\n{LOOP}END\n", f"DEF B()\n{LOOP}{LOOP}END\n"
    files = {"A__X/a.src": one, "B__Y/b.src": two, "B__Y/old/b.src": two, "C/c.src": "DEF C()\nEND"}
    before, after = surveys(tmp_path, files)
    found = with_counts(Evidence(rules=("CTL-05",), manual="m"), restored_lines(before, after))
    assert (3, 2, 3) == (found.files, found.origins, found.lines)
    assert (("CTL-05",), "m") == (found.rules, found.manual)
    assert ("A__X/a.src:2", "B__Y/b.src:2", "B__Y/b.src:5") == found.seen
    assert 3 == sum(len(file.places) for file in restored_files(before, after))


def test_one_content_is_one_witness(tmp_path: Path) -> None:
    """The same file in three origins does not corroborate what it shows."""
    text = f"DEF A()\n{LOOP}END\n"
    before, after = surveys(tmp_path, {f"{origin}/bas.src": text for origin in "ABC"})
    found = with_counts(Evidence(), restored_lines(before, after))
    assert (3, 1, 1) == (found.files, found.origins, found.lines)
    assert () == found.grounds


def test_places_are_spread_over_the_origins(tmp_path: Path) -> None:
    """At most ten places, and none of an origin twice while another one waits."""
    files = {
        f"o{origin:02}/{n}.src": f"DEF P{n}()\n{LOOP}X={origin}{n}\nEND\n"
        for origin in range(6)
        for n in range(3)
    }
    before, after = surveys(tmp_path, files)
    seen = with_counts(Evidence(), restored_lines(before, after)).seen
    assert 10 == len(seen)
    assert {f"o{origin:02}" for origin in range(6)} == {name.split("/")[0] for name in seen}


def test_places_are_spread_over_the_files_of_an_origin(tmp_path: Path) -> None:
    """A second line of a file waits until each file has been named."""
    files = {f"o/{n}.src": f"DEF P{n}()\n{LOOP}{LOOP}X={n}\nEND\n" for n in range(6)}
    before, after = surveys(tmp_path, files)
    seen = with_counts(Evidence(), restored_lines(before, after)).seen
    assert {name: 2 if n < 4 else 1 for n, name in enumerate(files)} == dict(
        Counter(name.partition(":")[0] for name in seen)
    )


def test_old_places_go_when_nothing_is_found() -> None:
    """What is counted replaces what was written, also where it is nothing."""
    assert Evidence(rules=("CTL-05",)) == with_counts(
        Evidence(3, 2, 9, ("CTL-05",), seen=("A/b:1",)), []
    )


def test_a_file_that_no_longer_parses_is_found(tmp_path: Path) -> None:
    """With its first failure; a reserved word can do that."""
    text = "DEF A()\nSTEP=1\nEND\n"
    before, after = surveys(tmp_path, {"o/a.src": text, "o/b.src": f"DEF A()\n{LOOP}END\n"})
    ((file, failed),) = broken_files(before, after)
    assert ("a.src", 2) == (file.path.rpartition("/")[2], failed.line)


@pytest.mark.parametrize(
    ("path", "origin", "expected"),
    [
        ("/home/me/open/A__B/C/d.src", "A/B", "A__B/C/d.src"),
        ("cell/KRC/d.src", "cell", "cell/KRC/d.src"),
        ("C:/x/backup.zip/KRC/d.src", "backup", "backup.zip/KRC/d.src"),
        ("/home/me/d.src", "elsewhere", "elsewhere/d.src"),
        ("d.src", "cell", "cell/d.src"),
    ],
)
def test_a_place_begins_with_its_origin(path: str, origin: str, expected: str) -> None:
    """Nothing of the folders around it is told."""
    assert expected == place(path, origin)
