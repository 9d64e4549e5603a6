"""Results kept from one survey to the next."""

from pathlib import Path

import pytest

from grammar.notation import g4
from grammar.notation.model import Grammar
from recovery.survey import survey as survey_module
from recovery.survey.survey import Survey, survey

PRELIMINARY = g4.read_file(Path(g4.__file__).parents[1].joinpath("preliminary.g4"))


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    folder = tmp_path / "cell"
    folder.mkdir()
    (folder / "good.src").write_text("DEF GOOD()\nEND\n", encoding="utf-8")
    (folder / "bad.src").write_text(
        "DEF BAD()\nGOTO X\nFOR I=1 TO 9 STEP 2\nENDFOR\nEND\n", "utf-8"
    )
    (folder / "table.dat").write_text("1 2 3\n4 5 6\n", encoding="utf-8")
    return folder


def record_of(found: Survey) -> object:
    return tuple(found.files), found.skipped, found.forms


def run(corpus: Path, cache: Path | None, grammar: Grammar = PRELIMINARY) -> Survey:
    return survey([corpus], grammar, jobs=1, cache=cache)


def test_a_second_survey_gives_the_same(corpus: Path, tmp_path: Path) -> None:
    """What is recalled equals what was worked out, failures, forms and reasons alike."""
    fresh = run(corpus, None)
    first, second = (run(corpus, tmp_path / "cache") for _ in range(2))
    assert record_of(fresh) == record_of(first) == record_of(second)


def test_nothing_is_read_again(
    corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Unchanged contents are not handed to a process a second time."""
    run(corpus, tmp_path / "cache")
    monkeypatch.setattr(survey_module, "_read_contents", lambda *_: pytest.fail("read again"))
    assert len(run(corpus, tmp_path / "cache").files) == 2


def test_a_changed_file_is_read_again(corpus: Path, tmp_path: Path) -> None:
    """Results go by content."""
    run(corpus, tmp_path / "cache")
    (corpus / "bad.src").write_text("DEF BAD()\nEND\n", encoding="utf-8")
    assert all(not f.failures for f in run(corpus, tmp_path / "cache").files)


def test_a_changed_grammar_reads_everything_again(corpus: Path, tmp_path: Path) -> None:
    """Results go by grammar too."""
    run(corpus, tmp_path / "cache")
    wider = g4.read(PRELIMINARY.text.replace("    : RETURN\n", "    : RETURN\n    | NAME NAME\n"))
    found = run(corpus, tmp_path / "cache", wider)
    assert record_of(found) == record_of(run(corpus, None, wider))


@pytest.mark.parametrize("damage", [b"", b"no database", b"SQLite format 3\x00" + b"\xff" * 4000])
def test_a_damaged_file_is_put_aside(corpus: Path, tmp_path: Path, damage: bytes) -> None:
    """Whatever lies where the results should, the survey tells what it always does."""
    cache = tmp_path / "cache"
    run(corpus, cache)
    for file in cache.iterdir():
        file.write_bytes(damage)
    assert record_of(run(corpus, cache)) == record_of(run(corpus, None))
