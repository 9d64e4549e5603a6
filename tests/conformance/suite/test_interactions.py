"""Cases of what meets: they are up to date, and each pair of features stands in one."""

from itertools import combinations, product

from conformance.suite.interactions import FEATURES, FOLDER, cases, covering


def test_cases_are_up_to_date() -> None:
    """What is in the folder is what the features make."""
    there = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.s*")}
    assert there == dict(cases())


def test_each_pair_of_values_stands_together() -> None:
    """Of any two features each value meets each of the other."""
    rows = covering(FEATURES)
    for one, other in combinations(FEATURES, 2):
        wanted = set(product(FEATURES[one], FEATURES[other]))
        assert wanted == {(row[one], row[other]) for row in rows}
    assert len(rows) < 100
