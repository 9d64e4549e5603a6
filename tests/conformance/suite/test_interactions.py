"""Cases of what meets: they are up to date, and each pair of features stands in one."""

from itertools import combinations, product

import pytest

from conformance.suite.case import Case
from conformance.suite.interactions import FEATURES, FOLDER, cases, covering, drawn


def test_cases_are_up_to_date() -> None:
    """What is in the folder is what the features make."""
    there = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.iterdir()}
    assert there == dict(cases())


def test_each_pair_of_values_stands_together() -> None:
    """Of any two features each value meets each of the other."""
    rows = covering(FEATURES)
    for one, other in combinations(FEATURES, 2):
        wanted = set(product(FEATURES[one], FEATURES[other]))
        assert wanted == {(row[one], row[other]) for row in rows}
    assert len(rows) < 130


@pytest.fixture(scope="module")
def first() -> list[Case]:
    """The programs of one seed."""
    return drawn(3)


def test_drawn_programs_follow_from_the_seed(first: list[Case]) -> None:
    """The same seed gives the same programs, another one others; each is a case that runs."""
    again, other = drawn(3), drawn(4)
    assert [one.digest for one in first] == [one.digest for one in again]
    assert {one.title for one in first} != {one.title for one in other}
    assert {("run", "kinematic")} == {(one.phase, one.robot) for one in first}


def test_drawn_programs_have_all_features(first: list[Case]) -> None:
    """Values of which no rule tells all are among them too, and only one line expects anything."""
    titles = " ".join(one.title for one in first)
    assert all(f"path {word}" in titles for word in ("lin_blend", "spline_blend", "circ_long"))
    expected = {each.kind for one in first for each in one.expectations if each.file == one.main}
    assert {"runs"} == expected
