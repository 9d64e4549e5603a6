"""What the fixed parts of the survey page say."""

from collections.abc import Callable
from typing import Any

import pytest

from reports.recovery.survey_view import survey_view
from reports.rendering.number_format import percent, size

RecordBuilder = Callable[[str], dict[str, Any]]


@pytest.mark.parametrize(
    ("part", "whole", "text"),
    [
        (0, 583, "0.0 %"),
        (1, 5830, "<0.1 %"),
        (312, 583, "53.5 %"),
        (99_999, 100_000, "99.9 %"),
        (583, 583, "100 %"),
        (0, 0, "–"),
    ],
)
def test_a_share_is_never_rounded_to_all_or_nothing(part: int, whole: int, text: str) -> None:
    """100 % means every file and 0.0 % means none."""
    assert text == percent(part, whole)


@pytest.mark.parametrize(
    ("octets", "text"),
    [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1000, "1.00 kB"),
        (12_340, "12.3 kB"),
        (4.3e6, "4.30 MB"),
        (2e12, "2,000 GB"),
    ],
)
def test_sizes_have_three_digits_and_a_decimal_unit(octets: float, text: str) -> None:
    """Sizes are in kB, MB and GB of a thousand each."""
    assert text == size(octets)


@pytest.mark.parametrize(
    ("reached", "verdict"),
    [
        ((80, 96, 100), "Mend the first two clusters and 95 % of the files parse."),
        ((95, 96, 100), "Mend the first cluster and 95 % of the files parse."),
        ((80, 100, 100), "Mend the first two clusters and every file parses."),
        ((80, 85, 90), "Mend the first three clusters and 90.0 % of the files parse."),
    ],
)
def test_the_verdict_names_the_fewest_clusters_for_95_per_cent(
    reached: tuple[int, ...], verdict: str
) -> None:
    """Where 95 % is out of reach, the verdict says how far all of them lead."""
    ids = [f"c-{n}" for n in range(len(reached))]
    record = {
        "files": 100,
        "parsed": 50,
        "clusters": [{"id": name, "title": name} for name in ids],
        "greedy": [{"cluster": n, "parsed": p} for n, p in zip(ids, reached, strict=True)],
    }
    assert verdict == survey_view(record)["section"]["verdict"]


def test_the_verdict_aims_higher_where_95_per_cent_parse_already() -> None:
    """From 97 % on, the next goals are 99 % and every file."""
    record = {
        "files": 100,
        "parsed": 99,
        "clusters": [{"id": "c-1", "title": "A"}],
        "greedy": [{"cluster": "c-1", "parsed": 100}],
    }
    verdict = survey_view(record)["section"]["verdict"]
    assert "Mend the first cluster and every file parses." == verdict


def test_the_seconds_are_those_of_the_survey() -> None:
    """Causes are searched after it, which may take far longer."""
    (*_, last) = survey_view({"seconds": 3.3, "bytes": 6_600})["figures"]
    assert ("seconds to survey", "3.3", "2.00 kB/s") == (last.label, last.value, last.note)


def test_each_repair_step_says_what_it_adds(survey_record: RecordBuilder) -> None:
    """The gain counts from the step before, the first one from today."""
    record = survey_record("believable")
    steps = survey_view(record)["section"]["mending"]
    assert [step["place"] for step in steps] == list(range(1, 10))
    assert steps[0]["gain"] == record["greedy"][0]["parsed"] - record["parsed"]
    assert sum(step["gain"] for step in steps) == record["greedy"][-1]["parsed"] - record["parsed"]


def test_rows_keep_the_order_of_the_record(survey_record: RecordBuilder) -> None:
    """The survey ranks; the page does not rank again."""
    record = survey_record("believable")
    assert [c["title"] for c in record["clusters"]] == [
        row["title"] for row in survey_view(record)["section"]["rows"]
    ]


def test_a_cluster_whose_failures_all_follow_is_marked(survey_record: RecordBuilder) -> None:
    """Only such a cluster is marked, not one with some failures that follow."""
    rows = survey_view(survey_record("believable"))["section"]["rows"]
    assert [row["title"] for row in rows if row["follower"]] == ["ENDIF without its IF"]


def test_skipped_files_are_grouped_by_reason_most_frequent_first(
    survey_record: RecordBuilder,
) -> None:
    """Each reason stands once, with its number of files."""
    skipped = survey_view(survey_record("believable"))["skipped"]
    groups = [(group["reason"], group["total"]) for group in skipped]
    assert groups == [
        ("not KRL: no DEFDAT", 14),
        ("binary: holds NUL bytes", 1),
        ("not KRL: no such suffix", 1),
    ]


def test_long_lists_of_skipped_files_are_cut_and_the_rest_counted() -> None:
    """The page of a hard disk full of pictures stays small."""
    record = {"skipped": [{"path": f"{n}.dat", "reason": "no"} for n in range(450)], "clusters": []}
    group = survey_view(record)["skipped"][0]
    assert (450, 200) == (group["total"], len(group["paths"]))


@pytest.mark.parametrize(
    ("record", "state"),
    [
        ({"files": 0, "clusters": []}, "no-files"),
        ({"files": 3, "parsed": 3, "clusters": []}, "complete"),
        ({"files": 3, "parsed": 2, "clusters": []}, "unclustered"),
        ({"files": 3, "parsed": 2, "clusters": [{"id": "c-1"}]}, "clusters"),
    ],
)
def test_the_state_of_the_survey_decides_what_the_page_says(
    record: dict[str, Any], state: str
) -> None:
    """No files, all parsed, failures without clusters, and the usual case are told apart."""
    assert state == survey_view(record)["state"]


@pytest.mark.parametrize(
    ("generated", "made"),
    [
        ("2031-05-06T07:08:09+00:00", "2031-05-06 07:08 UTC"),
        ("2031-05-06T07:08:09", "2031-05-06 07:08"),
        ("2031-05-06", "2031-05-06"),
        ("yesterday", "yesterday"),
    ],
)
def test_the_time_of_the_survey_is_given_to_the_minute(generated: str, made: str) -> None:
    """A date alone, or what is no date, stays as it is."""
    assert made == survey_view({"generated": generated, "clusters": []})["made"]
