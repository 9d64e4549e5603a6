"""The growth page as a file."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from reports.recovery.growth_page import write_growth_page

RecordBuilder = Callable[[str], dict[str, Any]]


def _page(record: dict[str, Any], folder: Path) -> str:
    return write_growth_page(record, folder).read_text(encoding="utf-8")


def _rows(page: str) -> list[str]:
    """What the rows of the table of steps say."""
    found = re.findall(r'<tr class="row".*?</tr>', page, re.DOTALL)
    return [" ".join(re.sub(r"<[^>]*>", " ", row).split()) for row in found]


def test_the_headline_says_where_the_grammar_came_from(
    grown: RecordBuilder, tmp_path: Path
) -> None:
    """From the restrictive start to the last construct."""
    page = _page(grown("believable"), tmp_path)
    assert "<h2>From 6.1 % of the files to 99.4 % in 40 constructs.</h2>" in page


def test_every_step_has_a_row(grown: RecordBuilder, tmp_path: Path) -> None:
    """Title, grounds, where it was seen, what it restored and broke, without any script."""
    rows = _rows(_page(grown("believable"), tmp_path))
    assert 41 == len(rows)
    assert "0 The restrictive start – 0 6.1 % 0.8 % 38,170" == rows[0]
    assert rows[7].startswith("7 SWITCH with CASE lists confirmed ")
    assert " 8 origins " in rows[7]
    assert " −2 " in rows[7]


def test_what_remains_says_why(grown: RecordBuilder, tmp_path: Path) -> None:
    """A file that breaks a fact of KRL is no valid KRL; the others are open."""
    page = _page(grown("believable"), tmp_path)
    assert "What remains: 3 different files" in page
    assert "invalid: an aggregate begins with a name (line 4)" in page
    assert 1 == page.count('<span class="open-question">open</span>')
    assert 'LIN <span class="token">{</span>{ X 1' in page


def test_health_is_reported(grown: RecordBuilder, tmp_path: Path) -> None:
    """Lookahead and lines with two readings."""
    page = _page(grown("believable"), tmp_path)
    assert "Of 196 decisions in the rules 85.5 % need one token and 95.2 %" in page
    assert "1 of 114,000 lines in files that parse can be read in two ways." in page


def test_the_same_record_gives_the_same_page(grown: RecordBuilder, tmp_path: Path) -> None:
    """Also when it was read from JSON in between."""
    record = grown("believable")
    again = json.loads(json.dumps(record))
    assert _page(record, tmp_path / "a") == _page(again, tmp_path / "b")


@pytest.mark.parametrize(
    ("name", "words"), [("empty", "No KRL found"), ("start", "The ledger is empty")]
)
def test_a_growth_without_steps_says_why(
    name: str, words: str, grown: RecordBuilder, tmp_path: Path
) -> None:
    """There is no empty table and no chart."""
    page = _page(grown(name), tmp_path)
    assert f"<h2>{words}</h2>" in page
    assert [] == _rows(page)


def test_a_growth_that_leaves_nothing_says_so(grown: RecordBuilder, tmp_path: Path) -> None:
    """The list goes, the message stays."""
    record = grown("believable") | {"remaining": [], "remaining_files": []}
    assert "Nothing remains: every file parses" in _page(record, tmp_path)
