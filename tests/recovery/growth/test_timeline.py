"""A corpus under a row of grammars: exactly what one survey each would find."""

import sqlite3
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, RemoveAlternative, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.growth import timeline
from recovery.growth.timeline import Timeline, contents_of, read_through
from recovery.survey.survey import survey
from recovery.survey.surveyed_files import SurveyedFile

START = read_file(GRAMMAR.with_name("preliminary.g4"))
FILES = {
    "fine.src": "DEF A()\nHALT\nEND\n",
    "name.src": "DEF A()\nSTEP=1\nEND\n",  # a name until STEP is reserved
    "step.src": "DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nHALT 1\nEND\n",
    "copies/step.src": "DEF A()\nFOR I=1 TO 9 STEP 2\nENDFOR\nHALT 1\nEND\n",
    "global.src": "GLOBAL DEF A()\nWAIT SEC 1\nEND\n",
    "open.src": "DEF A()\n",
    "table.dat": "1;2;3\n4;5;6\n",
}


def _row() -> list[Grammar]:
    """The start and four steps: one reserves a word in use, one takes something away."""
    edits: tuple[list[Edit], ...] = (
        [AddToken("STEP"), Insert("forStatement", (1, 7), "(STEP expression)?")],
        [AddToken("GLOBAL"), Insert("procedure", (1, 1), "GLOBAL?")],
        [AddAlternative("halt", "HALT INTEGER")],
        [RemoveAlternative("wait", 2)],
    )
    row = [START]
    for step in edits:
        row.append(read(apply(row[-1], step).text))
    return row


ROW = _row()


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        file = tmp_path / "cell" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.encode())
    return tmp_path / "cell"


def timelines(
    corpus: Path, row: Sequence[Grammar] = ROW, *, jobs: int = 1, cache: Path | None = None
) -> list[Timeline]:
    return read_through(contents_of([corpus])[0], row, jobs=jobs, cache=cache)


def record_of(found: Sequence[Timeline]) -> object:
    return [(f.content, dict(f.failing), f.reason) for f in found]


def test_each_grammar_finds_what_its_survey_finds(corpus: Path) -> None:
    """The same files with the same failing lines; what is no KRL has the same reason."""
    found = timelines(corpus)
    for number, grammar in enumerate(ROW):
        alone = survey([corpus], grammar, jobs=1)
        expected = {f.path: sorted({x.line for x in f.failures}) for f in alone.files}
        assert expected == {
            f.content.path: [line for line, when in f.failing.items() if when >> number & 1]
            for f in found
            if not f.reason
        }
        assert {s.path: s.reason for s in alone.skipped} == {
            f.content.path: f.reason for f in found if f.reason
        }


def test_when_a_file_parses(corpus: Path) -> None:
    """A keyword takes the name away, and a rule that goes takes its statement with it."""
    found = {f.content.path.rsplit("/", 1)[1]: f for f in timelines(corpus)}
    parses = {
        name: "".join("-x"[f.parses(n)] for n in range(len(ROW)))
        for name, f in found.items()
        if not f.reason
    }
    assert {
        "fine.src": "xxxxx",
        "name.src": "x----",
        "step.src": "---xx",
        "global.src": "--xx-",
        "open.src": "-----",
    } == parses


def test_copies_are_places_of_one_content(corpus: Path) -> None:
    """Each content is read once and keeps all its places."""
    contents, skipped = contents_of([corpus])
    assert ([], 6) == (skipped, len(contents))
    places = [[path for path, _ in c.places] for c in contents if len(c.places) > 1]
    assert [["copies/step.src", "step.src"]] == [
        [path.split("cell/")[1] for path in paths] for paths in places
    ]


def test_more_processes_tell_the_same(corpus: Path) -> None:
    """In the same order."""
    assert record_of(timelines(corpus)) == record_of(timelines(corpus, jobs=2))


def test_what_is_kept_is_not_read_again(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second time nothing is left to do, and the result is the same."""
    first = timelines(corpus, cache=tmp_path / "cache")
    monkeypatch.setattr(timeline, "_read_under", lambda *_: pytest.fail("read again"))
    assert record_of(first) == record_of(timelines(corpus, cache=tmp_path / "cache"))


def test_only_what_is_new_is_read(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A further step reads every content under that step, a new file is read under all."""
    timelines(corpus, ROW[:4], cache=tmp_path / "cache")
    (corpus / "new.src").write_text("DEF N()\nHALT\nEND\n", encoding="utf-8")
    asked: list[tuple[list[int], int]] = []
    perform = timeline._read_under

    def watched(run: tuple[tuple[int, Grammar], ...], contents: tuple[SurveyedFile, ...]) -> Any:
        asked.append(([number for number, _ in run], len(contents)))
        return perform(run, contents)

    monkeypatch.setattr(timeline, "_read_under", watched)
    kept = timelines(corpus, cache=tmp_path / "cache")
    # table.dat is no KRL under any grammar
    assert {(4, 5), (0, 1), (1, 1), (2, 1), (3, 1), (4, 1)} == {
        (number, count) for numbers, count in asked for number in numbers
    }
    assert record_of(kept) == record_of(timelines(corpus))


def test_a_growth_that_breaks_off_goes_on_with_the_next_grammar(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was read under the first grammars is kept before the others have had their turn."""
    asked: list[int] = []
    perform = timeline._read_under

    def breaking(run: tuple[tuple[int, Grammar], ...], contents: tuple[SurveyedFile, ...]) -> Any:
        asked.extend(number for number, _ in run)
        if len(asked) == 3:
            raise KeyboardInterrupt
        return perform(run, contents)

    monkeypatch.setattr(timeline, "_read_under", breaking)
    with pytest.raises(KeyboardInterrupt):
        timelines(corpus, cache=tmp_path / "cache")
    kept = timelines(corpus, cache=tmp_path / "cache")
    assert [0, 1, 2, 2, 3, 4] == asked
    monkeypatch.undo()
    assert record_of(kept) == record_of(timelines(corpus))


def test_what_is_kept_holds_for_another_row_of_the_same_grammars(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Results are kept by grammar, not by number."""
    timelines(corpus, cache=tmp_path / "cache")
    other = [ROW[0], ROW[3], ROW[1]]
    expected = record_of(timelines(corpus, other))
    monkeypatch.setattr(timeline, "_read_under", lambda *_: pytest.fail("read again"))
    assert expected == record_of(timelines(corpus, other, cache=tmp_path / "cache"))


def test_a_damaged_result_is_worked_out_again(corpus: Path, tmp_path: Path) -> None:
    """What is kept is never trusted."""
    expected = record_of(timelines(corpus, cache=tmp_path / "cache"))
    with sqlite3.connect(tmp_path / "cache" / "results.sqlite") as base:
        base.execute("UPDATE result SET body = ?", (b"nonsense",))
    base.close()
    assert expected == record_of(timelines(corpus, cache=tmp_path / "cache"))


def test_a_file_that_changes_meanwhile_is_reported(corpus: Path, tmp_path: Path) -> None:
    """Lines of one text are not told of another, nor is it kept that it could not be read."""
    contents, _ = contents_of([corpus])
    text = (corpus / "fine.src").read_text(encoding="utf-8")
    (corpus / "fine.src").write_text("DEF B()\nEND\n", encoding="utf-8")
    found = read_through(contents, ROW[:1], jobs=1, cache=tmp_path / "cache")
    reasons = {f.content.path.rsplit("/", 1)[1]: f.reason for f in found}
    assert "changed while it was read" == reasons["fine.src"]
    (corpus / "fine.src").write_text(text, encoding="utf-8", newline="\n")
    again = read_through(contents, ROW[:1], jobs=1, cache=tmp_path / "cache")
    assert record_of(again) == record_of(timelines(corpus, ROW[:1]))


def test_a_place_that_cannot_be_read_is_skipped(corpus: Path) -> None:
    """With its reason."""
    (corpus / "cut.zip").write_bytes(b"PK\x03\x04 and no more")
    _, skipped = contents_of([corpus])
    assert ["cut.zip"] == [Path(s.path).name for s in skipped]


def test_progress_counts_readings(corpus: Path) -> None:
    """A content under a grammar is one."""
    told_of: list[int] = []
    done: list[int] = []
    contents, _ = contents_of([corpus])
    read_through(contents, ROW, jobs=1, on_found=told_of.append, on_done=done.append)
    assert [6 * 5] == told_of == [sum(done)]


def test_a_row_has_a_grammar(corpus: Path) -> None:
    """Nothing can be read under none."""
    with pytest.raises(ValueError, match="no grammar"):
        timelines(corpus, [])


def test_a_file_that_parses_is_not_read_while_the_grammar_only_adds(
    corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Read again are those that failed, those with the new word, and all where something went."""
    contents, _ = contents_of([corpus])
    read: list[list[str]] = []
    alone = {f.content.path: f.failing for f in timelines(corpus) if not f.reason}

    class Watched(FailureFinder):
        def __init__(self, recognizer: Recognizer) -> None:
            super().__init__(recognizer)
            read.append([])

        def find(self, text: str) -> list[Failure]:
            read[-1].append(text)
            return super().find(text)

    monkeypatch.setattr(timeline, "FailureFinder", Watched)
    results = timeline._read_under(tuple(enumerate(ROW)), tuple(contents))
    assert alone == {
        content.path: result
        for content, result in zip(contents, results, strict=True)
        if isinstance(result, dict)
    }
    fine = FILES["fine.src"]
    assert [True, False, False, False, True] == [fine in texts for texts in read]
    assert [True] * 5 == [FILES["name.src"] in texts for texts in read]
    assert [True, True, True, False, True] == [FILES["global.src"] in texts for texts in read]
