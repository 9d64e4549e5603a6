"""Findings that are known: what a baseline keeps back, and what it lets through."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.diagnostics.baseline import Baseline
from grammar.diagnostics.diagnostic import Diagnostic, Region

CODES = st.sampled_from(["KRL001", "KRL209", "KSS2296"])
TEXTS = st.sampled_from(["A = 1", "B = 2", "PTP P1"])
FOUND = st.lists(st.tuples(st.sampled_from(["a.src", "b.dat"]), CODES, TEXTS), max_size=12)


def made(rows: list[tuple[str, str, str]], first: int = 1) -> list[tuple[Diagnostic, str]]:
    """Findings with the texts of their lines, on lines of their own."""
    return [
        (Diagnostic(path, Region(number, 1, number, 2), "error", code, "wrong"), text)
        for number, (path, code, text) in enumerate(rows, first)
    ]


def new(base: Baseline, found: list[tuple[Diagnostic, str]]) -> tuple[int, int]:
    kept, gone = base.new(found, str)
    return len(kept), gone


@given(FOUND, st.integers(1, 50))
def test_known_findings_are_not_new(rows: list[tuple[str, str, str]], first: int) -> None:
    """What a baseline was made of is known, on whatever lines it now stands, and read back too."""
    base = Baseline.of(made(rows), str)
    assert (0, 0) == new(Baseline.read(base.record()), made(rows, first))


@given(FOUND, FOUND)
def test_new_and_gone_are_counted(
    before: list[tuple[str, str, str]], after: list[tuple[str, str, str]]
) -> None:
    """New ones are those beyond the known number of the same, gone ones those that are missing."""
    added, gone = new(Baseline.of(made(before), str), made(after))
    assert len(after) - len(before) == added - gone
    assert sum(max(0, after.count(row) - before.count(row)) for row in set(after)) == added


@pytest.mark.parametrize(
    "record", [None, [], {}, {"version": 2, "findings": []}, {"version": 1, "findings": [{}]}]
)
def test_what_is_no_baseline_is_refused(record: object) -> None:
    """Other JSON raises `ValueError`."""
    with pytest.raises(ValueError, match="baseline"):
        Baseline.read(record)
