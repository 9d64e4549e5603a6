"""What a grammar leaves over: files it cannot read, lines it can read in two ways."""

from pathlib import Path

import pytest

from grammar.notation.edits import AddAlternative, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from recovery.growth import remaining as leftover
from recovery.growth.remaining import ambiguous_lines, remaining
from recovery.growth.timeline import contents_of
from recovery.survey.surveyed_files import SurveyedFile

START = read_file(GRAMMAR.with_name("preliminary.g4"))


def lay(root: Path, **files: str) -> list[SurveyedFile]:
    for name, text in files.items():
        (root / f"{name}.src").write_bytes(text.encode())
    return contents_of([root])[0]


def doubled() -> Grammar:
    """A call as a statement has two readings, one of them through a rule of its own."""
    return read(apply(START, [AddAlternative("statement", "call eol")]).text)


def test_lines_with_two_readings_are_counted_where_they_stand(tmp_path: Path) -> None:
    """The same line in two files counts twice; the first are named."""
    contents = lay(
        tmp_path,
        a="DEF A()\nLOOP\nB()\nENDLOOP\nHALT\nEND\n",
        b="DEF A()\r\nB()\r\n\r\nB( )\r\nEND",
    )
    found = ambiguous_lines(contents, doubled())
    assert (3, 6 + 5) == (found["lines"], found["of"])
    assert [("a.src", 3, "B()"), ("b.src", 2, "B()"), ("b.src", 4, "B( )")] == [
        (Path(e["path"]).name, e["line"], e["text"]) for e in found["examples"]
    ]


def test_the_start_has_one_reading_of_each_line(tmp_path: Path) -> None:
    """Nothing is named."""
    contents = lay(tmp_path, a="DEF A()\nB()\nHALT\nEND\n")
    assert {"lines": 0, "of": 4, "examples": []} == ambiguous_lines(contents, START)


def test_examples_are_few(tmp_path: Path) -> None:
    """However many lines there are."""
    contents = lay(tmp_path, a="DEF A()\n" + "B()\n" * 50 + "END\n")
    found = ambiguous_lines(contents, doubled())
    assert (50, 20) == (found["lines"], len(found["examples"]))


def test_all_failing_lines_remain_with_their_files(tmp_path: Path) -> None:
    """Lines that only follow are marked; sizes are those of the file."""
    contents = lay(tmp_path, a="DEF A()\nSWITCH B\nCASE 1\nENDSWITCH\nA=1 2\nEND\n")
    found = remaining(contents, START)
    assert [(2, False), (3, True), (4, True), (5, False)] == [
        (line["line"], line["follows"]) for line in found["remaining"]
    ]
    (file,) = found["remaining_files"]
    assert (4, contents[0].size, 7) == (file["failing"], file["bytes"], file["lines"])
    assert (5, "two operands have an operator between them") == (file["fact_line"], file["fact"])
    assert ("invalid", file["fact"]) == (file["kind"], file["reason"])


def test_a_file_that_has_changed_is_left_out(tmp_path: Path) -> None:
    """What is told of a file is told of the text that was found."""
    contents = lay(tmp_path, a="DEF A()\nHALT 1\nEND\n")
    (tmp_path / "a.src").write_text("DEF A()\nEND\n", encoding="utf-8")
    assert {"remaining": [], "remaining_files": []} == remaining(contents, START)


def test_what_a_person_found_out_is_reported_by_digest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file of the public corpus has the reason that was written down for its content."""
    contents = lay(tmp_path, a="DEF A()\nHALT {}\nEND\n")
    known = tmp_path / "known.tsv"
    row = "\t".join((contents[0].digest, "template", "o", "a.src", "to be filled in"))
    known.write_text(f"# why\nsha256\tkind\torigin\tname\treason\n{row}\n", encoding="utf-8")
    monkeypatch.setattr(leftover, "_REASONS", known)
    leftover._reasons.cache_clear()
    (file,) = remaining(contents, START)["remaining_files"]
    leftover._reasons.cache_clear()
    assert ("template", "to be filled in") == (file["kind"], file["reason"])
