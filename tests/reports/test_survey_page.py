"""The survey page as a file."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from reports.recovery import survey_page
from reports.recovery.survey_page import write_survey_page
from tests.reports.page_elements import LOADING_ATTRIBUTES, Elements

RecordBuilder = Callable[[str], dict[str, Any]]


def _page(record: dict[str, Any], folder: Path) -> str:
    return write_survey_page(record, folder).read_text(encoding="utf-8")


def test_the_page_is_index_html_in_a_folder_made_for_it(tmp_path: Path) -> None:
    """Missing parents are made, and nothing but the page is left in the folder."""
    folder = tmp_path / "reports" / "out"
    assert folder / "index.html" == write_survey_page({}, folder)
    assert [path.name for path in folder.iterdir()] == ["index.html"]


def test_the_page_loads_nothing(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """No element names a resource, no style sheet imports one; links stay inside the page."""
    page = _page(survey_record("believable"), tmp_path)
    elements = Elements(page)
    loaded = [
        value
        for _, attributes in elements.tags
        for name, value in attributes.items()
        if name in LOADING_ATTRIBUTES and not (value or "").startswith("#cluster=")
    ]
    assert loaded == []
    assert [tag for tag, _ in elements.tags if tag in {"link", "iframe", "object", "base"}] == []
    assert re.findall(r"@import|url\(", page) == []
    written = {"http://www.w3.org/2000/svg", "https://github.com/leeoniya/uPlot"}  # its licence
    assert set(re.findall(r"\w+://[^\"'\s<]*", page)) == written


def test_only_our_script_may_run(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """The policy of the page forbids every source and allows scripts by hash alone."""
    tags = Elements(_page(survey_record("believable"), tmp_path)).tags
    (policy,) = [a["content"] for t, a in tags if t == "meta" and "http-equiv" in a]
    assert policy is not None
    assert policy.startswith("default-src 'none'; ")
    assert re.search(r"script-src 'sha256-[A-Za-z0-9+/=]{44}';", policy)


def test_the_same_record_gives_the_same_bytes(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """Neither the clock nor the place of the folder is in the page."""
    pages = [write_survey_page(survey_record("large"), tmp_path / name) for name in ("a", "b")]
    assert pages[0].read_bytes() == pages[1].read_bytes()


def test_hostile_text_adds_no_element(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """A record full of markup gives the same elements as one without."""
    plain = Elements(_page(survey_record("both"), tmp_path / "plain"))
    hostile = Elements(_page(survey_record("hostile"), tmp_path / "hostile"))
    assert [tag for tag, _ in plain.tags] == [tag for tag, _ in hostile.tags]


def test_hostile_text_leaves_no_control_character(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """Terminal escapes cannot reach someone who prints the page to a terminal."""
    page = _page(survey_record("hostile"), tmp_path)
    assert re.findall("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e\u2028]", page) == []


def test_template_marks_in_a_record_are_not_evaluated(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """Text that looks like a template expression is text."""
    assert "{{ 7*7 }}" in _page(survey_record("hostile"), tmp_path)


def test_where_nothing_is_missing_the_start_is_reported(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """A friendly screen first, then the clusters of the start with what answered them."""
    page = _page(survey_record("story"), tmp_path)
    assert "Nothing is missing: every file parses under this grammar" in page
    assert "under which 312 of them parse (53.5 %)" in page
    assert "fell into 11 clusters; 9 constructs answered 8 of them" in page
    assert page.index('id="empty"') < page.index('id="story"') < page.index('id="start-rows"')
    assert 'id="rows"' not in page
    assert '<td class="answer">DEFFCT with a return type</td>' in page
    assert 3 == page.count('<td class="answer dim">nothing yet</td>')


def test_what_is_still_computed_is_said(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """A page without clusters whose causes are yet to come says so, and nothing of a bad record."""
    record = survey_record("believable") | {"clusters": [], "greedy": []}
    assert "No clusters in this record" in _page(record, tmp_path)
    page = _page(record | {"pending": "the causes, in 7 files"}, tmp_path)
    assert "What is missing here: the causes, in 7 files." in page
    assert "No clusters in this record" not in page
    assert "unlock files alone" not in page
    assert "unlock files alone" in _page(survey_record("believable"), tmp_path)


def test_failures_in_force_come_before_those_of_the_start(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """Both have their tables."""
    page = _page(survey_record("both"), tmp_path)
    places = [page.index(f'id="{name}"') for name in ("rows", "story", "start-rows", "origins")]
    assert sorted(places) == places
    assert 22 == page.count('<tr class="row"')


def test_the_page_does_not_hold_the_failures(survey_record: RecordBuilder, tmp_path: Path) -> None:
    """A survey may have a million failures; the page shows clusters."""
    assert "only-in-failures" not in _page(survey_record("believable"), tmp_path)


def test_the_page_of_2000_clusters_stays_below_5_mb(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """Large surveys remain something to send by mail, that of the start and proposals included."""
    record = survey_record("large")
    (proposal,) = next(filter(None, (one["proposals"] for one in record["clusters"])))[:1]
    for cluster in record["clusters"]:
        cluster["proposals"] = [proposal | {"diff": f"{n} {'x' * 800}"} for n in range(8)]
    record["clusters"] = [
        cluster | {"id": f"{cluster['id']}-{copy}"}
        for copy in range(2)
        for cluster in record["clusters"]
    ]
    record["start"] = dict(record)
    page = write_survey_page(record, tmp_path)
    assert page.stat().st_size < 5_000_000
    assert page.read_text(encoding="utf-8").count('<tr class="row"') == 2000


def test_a_record_far_too_large_is_shown_with_less_detail(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """Endless lines and very many files cost detail, not clusters."""
    record = survey_record("large")
    for cluster in record["clusters"]:
        cluster["example"]["text"] += "x" * 1500
        for example in (cluster["example"], *cluster["examples"]):
            for line in example["context"]:
                line["text"] += "y" * 1500
    page = write_survey_page(record, tmp_path)
    assert page.stat().st_size < 5_000_000
    assert page.read_text(encoding="utf-8").count('<tr class="row"') == 500


def test_a_record_with_nothing_in_it_gives_a_page(tmp_path: Path) -> None:
    """All fields may be absent."""
    assert "No KRL found" in _page({}, tmp_path)


def test_a_record_read_from_json_gives_the_same_page(
    survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """The page can be made again from the JSON that was written beside it."""
    record = survey_record("believable")
    again = json.loads(json.dumps(record))
    assert _page(record, tmp_path / "a") == _page(again, tmp_path / "b")


def test_a_page_that_cannot_be_put_in_place_leaves_the_old_one(
    survey_record: RecordBuilder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A failure half way leaves neither a torn page nor a draft."""
    page = write_survey_page({}, tmp_path)
    before = page.read_bytes()

    def refuse(*_: object) -> None:
        raise PermissionError("held open")

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(PermissionError):
        write_survey_page(survey_record("believable"), tmp_path)
    assert before == page.read_bytes()
    assert [path.name for path in tmp_path.iterdir()] == ["index.html"]


def test_every_column_can_be_sorted() -> None:
    """The button in the head of each column has a value to sort by, and no value lacks a column."""
    folder = Path(survey_page.__file__).parents[1] / "templates"
    section = (folder / "survey-section.html.j2").read_text(encoding="utf-8")
    script = (folder / "survey-table.js").read_text(encoding="utf-8")
    values = script.partition("const sortValue = {")[2].partition("};")[0]
    assert set(re.findall(r'data-key="(\w+)"', section)) == set(
        re.findall(r"^  (\w+):", values, re.M)
    )
