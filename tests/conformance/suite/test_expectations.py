"""Expectations are read strictly, and mean what CASES.md says."""

import re
from pathlib import Path

import pytest

from conformance.suite.expectations import KINDS, ExpectationError, read_expectation

CASES_MD = Path(__file__).parents[3] / "conformance" / "CASES.md"


def test_time_and_tolerance_are_parted_from_arguments() -> None:
    """``out 2 TRUE at end 1 - 0.1 within 0.02`` has an output, a moment and a tolerance."""
    found = read_expectation("out 2 TRUE at end 1 - 0.1 within 0.02", "a.src", 7)
    assert ("out", ("2", "TRUE"), 0.02) == (found.kind, found.arguments, found.tolerance)
    assert found.when is not None
    assert ("at", "end", "1", -0.1) == (
        found.when.relation,
        found.when.first.event,
        found.when.first.of,
        found.when.first.seconds,
    )


def test_span_has_two_moments() -> None:
    """``between`` names two moments."""
    when = read_expectation("apex between blend-start 2 and blend-end 3", "a.src", 1).when
    assert when is not None
    assert when.last is not None
    assert ("blend-start", "blend-end") == (when.first.event, when.last.event)


def test_texts_may_hold_blanks() -> None:
    """A text is one argument, whatever it holds."""
    found = read_expectation('value T "a  b within 3"', "a.src", 1)
    assert ("T", '"a  b within 3"') == found.arguments


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("", "no expectation"),
        ("outputs 2", "no expectation"),
        ("out two TRUE", "cannot stand behind out"),
        ("out 2 MAYBE", "cannot stand behind out"),
        ("value N", "cannot stand behind value"),
        ("never at 1.0", "no time"),
        ("runs 3 within 2", "no tolerance"),
        ("value R 1.0 within -1", "not negative"),
        ("path line 1 2 3 to 4 5", "cannot stand behind path"),
        ("out 1 TRUE at noon 3", "cannot stand behind out"),
    ],
)
def test_nonsense_is_refused_with_its_reason(text: str, part: str) -> None:
    """What means nothing is an error that says why, on one line."""
    with pytest.raises(ExpectationError, match=part) as raised:
        read_expectation(text, "a.src", 1)
    assert "\n" not in str(raised.value)


def test_every_kind_is_in_the_contract() -> None:
    """CASES.md tells of every word that an expectation can begin with, and of no other."""
    text = CASES_MD.read_text(encoding="utf-8")
    rows = [row.split("|")[1] for row in text.splitlines() if row.startswith("| `")]
    told = {word for row in rows for word in re.findall(r"`([a-z-]+)", row)}
    assert set(KINDS) <= told, set(KINDS) - told
