"""Features removed from cases: what they are, which a title names, and who misses them."""

from pathlib import Path

import pytest

from conformance.sensitivity.removed_features import (
    case_without,
    features,
    named_by,
    removals_record,
    try_removals,
)
from conformance.suite.case import Case, read_case

_HEAD = ";@ rule: IOT-07\n;@ title: {}\n;@ phase: run\nDEF made()\n"


def _case(tmp_path: Path, title: str, *lines: str) -> Case:
    path = tmp_path / "made.src"
    path.write_text(_HEAD.format(title) + "".join(f"  {one}\n" for one in lines) + "END\n", "utf-8")
    return read_case(path, tmp_path)


@pytest.mark.parametrize(
    ("line", "left"),
    [
        ("WAIT SEC 0.5", {"WAIT SEC": ""}),
        ("BRAKE F", {"BRAKE F": "", "F": "BRAKE"}),
        ("INTERRUPT OFF 5", {"INTERRUPT OFF": ""}),
        ("$APO.CDIS = 5.0", {"$APO.CDIS": ""}),
        ("LIN {X 1} C_DIS", {"LIN": "", "C_DIS": "LIN {X 1}"}),
        ("R = SQRT(4.0)", {"SQRT": "R = 0.0"}),
        ("B = $IN[7]", {"$IN": "B = FALSE"}),
        ("B = R == 4.0", {}),
    ],
)
def test_features_of_a_line(tmp_path: Path, line: str, left: dict[str, str]) -> None:
    """Each feature of a statement, and what the line is without it."""
    case = _case(tmp_path, "A line", "$OUT[1] = TRUE ;> out 1 TRUE", line)
    rows = {one: case_without(case, one).sources[0].text.splitlines() for one in features(case)}
    assert left == {one: row[5].strip() for one, row in rows.items() if one != "$OUT"}


def test_lines_stay_where_they_are(tmp_path: Path) -> None:
    """A block of several lines leaves as many behind."""
    case = _case(tmp_path, "A loop", "LOOP", "EXIT", "ENDLOOP", "$OUT[1] = TRUE ;> out 1 TRUE")
    assert [*[""] * 3, "$OUT[1] = TRUE ;> out 1 TRUE"] == [
        one.strip() for one in case_without(case, "LOOP").sources[0].text.splitlines()[4:8]
    ]


def test_what_a_title_names(tmp_path: Path) -> None:
    """Of features that share a word with the title those that share most; no small words."""
    lines = "WAIT SEC 0.1", "WAIT FOR $IN[1]", "$OUT[1] = TRUE ;> out 1 TRUE", "HALT"
    assert ["WAIT SEC"] == named_by(_case(tmp_path, "WAIT SEC is no halt for long", *lines))
    assert ["WAIT SEC", "WAIT FOR"] == named_by(_case(tmp_path, "WAIT is no halt", *lines))


def test_a_weak_case_is_found(tmp_path: Path) -> None:
    """The output changes with and without PULSE; the moment of its end tells them apart."""
    lines = "$OUT[1] = TRUE ;> out 1 TRUE", "PULSE($OUT[2],TRUE,0.2)", "WAIT SEC 0.5"
    weak = _case(tmp_path, "PULSE goes on", *lines)
    seen = f"{lines[1]} ;> out 2 TRUE ;> out 2 FALSE"
    strong = _case(tmp_path, "PULSE ends", lines[0], seen, lines[2])
    record = removals_record([*try_removals([weak]), *try_removals([strong])])
    assert (2, [{"case": "made", "feature": "PULSE"}]) == (record["removed"], record["unnoticed"])
