"""The clusters as the script of the survey page reads them."""

from typing import Any

import pytest

from reports.recovery.survey_cluster import DETAILS, Detail, clip_around, cluster_data


def _only(cluster: dict[str, Any], detail: Detail = DETAILS[0]) -> dict[str, Any]:
    data = cluster_data([cluster], detail)
    (only,) = data["clusters"]
    return {**only, "strings": data["strings"]}


@pytest.mark.parametrize("column", [1, 20, 150, 299, 300])
def test_a_cut_line_keeps_the_column_on_the_same_character(column: int) -> None:
    """However far right the token stands, its column in the part shown points at it."""
    line = "".join(chr(0x4E00 + n) for n in range(300))
    part, shown = clip_around(line, column, 60)
    assert len(part) == 60
    assert part[shown - 1] == line[column - 1]


def test_a_short_line_is_not_cut() -> None:
    """Line and column of a line that fits are unchanged."""
    assert clip_around("LIN P1", 5, 60) == ("LIN P1", 5)


def test_the_caret_is_as_wide_as_the_token_in_the_line() -> None:
    """The token is looked for without regard to case, as KRL reads it."""
    example = {"path": "a.src", "line": 4, "column": 5, "text": "LIN home", "token": "HOME"}
    assert _only({"example": example})["examples"][0]["width"] == 4


def test_the_caret_is_one_wide_where_the_token_is_not_in_the_line() -> None:
    """The end of the file or of the line has no text of its own."""
    example = {"path": "a.src", "line": 4, "column": 4, "text": "LIN"}
    assert _only({"token": "<EOF>", "example": example})["examples"][0]["width"] == 1


def test_an_example_without_context_still_shows_its_line() -> None:
    """The contract of the JSON asks for path, line and text only."""
    shown = _only({"example": {"path": "a.src", "line": 4, "text": "LIN\r\n"}})["examples"]
    assert shown[0]["lines"] == [[4, "LIN"]]


def test_the_first_example_is_not_shown_twice() -> None:
    """Records may list the leading example among the examples again."""
    first = {"path": "a.src", "line": 4, "column": 1, "text": "X"}
    other = {**first, "line": 9}
    shown = _only({"example": first, "examples": [first, other]})["examples"]
    assert [item["line"] for item in shown] == [4, 9]


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        (None, None),
        ("", None),
        ("DEF A()\nEND\n", {"text": "DEF A()\nEND\n", "line": 0, "column": 0, "tokens": None}),
        (
            {"text": "X", "line": 1, "column": 1, "tokens": 1},
            {"text": "X", "line": 1, "column": 1, "tokens": 1},
        ),
    ],
)
def test_a_reproducer_may_be_text_record_or_absent(given: Any, shown: Any) -> None:
    """All three forms of the field are read."""
    assert shown == _only({"reproducer": given})["reproducer"]


def test_figures_of_a_proposal_may_be_numbers_lists_or_absent() -> None:
    """A list is counted, an absent figure stays unknown instead of becoming 0."""
    proposal = {"edit": "add X", "restores": 3, "accepts_negatives": ["n1", "n2"], "breaks": 0}
    (shown,) = _only({"proposals": [proposal]})["proposals"]
    assert (
        shown["restores"],
        shown["negatives"],
        shown["breaks"],
        shown["ambiguities"],
    ) == (3, 2, 0, None)


def test_files_left_out_are_counted() -> None:
    """What the detail has no room for and what the record left out add up."""
    files = [{"path": f"{n}.src", "line": n} for n in range(30)]
    by_origin = [{"origin": "A", "files": files, "more": 5}, {"origin": "B", "files": files}]
    shown = _only({"files_by_origin": by_origin}, DETAILS[2])["byOrigin"]
    assert [(left_out, len(kept)) for _, left_out, kept in shown] == [(15, 20), (30, 0)]


def test_a_name_met_twice_is_stored_once() -> None:
    """Paths, origins and tokens are numbered, which keeps the page small."""
    cluster = {"expected": ["END", "LIN"], "rule_stack": ["module"]}
    data = cluster_data([cluster, cluster], DETAILS[0])
    assert data["strings"] == ["module", "END", "LIN"]
    assert [c["expected"] for c in data["clusters"]] == [[1, 2], [1, 2]]
