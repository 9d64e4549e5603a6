"""The page that tells what was tried is that of the code: its entry points, kinds and limits."""

import re

import pytest

from tests.soak.entries import ENTRIES
from tests.soak.hostile_page import PAGE, added, page, table
from tests.soak.pieces import KINDS

COUNTS = {
    "entries": {"check": {"0": 3, "1": 2, "2": 1, "seconds": 1.5}, "lsp": {"0": 4, "seconds": 2.0}},
    "kinds": {"junk bytes": 3},
    "slowest": {"seconds": 1.2, "input": "check 7"},
    "seconds": 4,
}


@pytest.mark.parametrize("name", ENTRIES)
def test_entry_points_are_on_the_page(name: str) -> None:
    """Each entry point stands on the page with what it is given and how many inputs it had."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.search(rf"^\| {name} \| {re.escape(ENTRIES[name].words)} \| ([\d,]+) \|", text, re.M)
    assert found is not None
    assert int(found[1].replace(",", "")) > 0


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_are_on_the_page(kind: str) -> None:
    """Each kind of hostility stands on the page, and was met."""
    text = PAGE.read_text(encoding="utf-8")
    assert re.search(rf"^\| {re.escape(kind)} \| [1-9][\d,]* \|$", text, re.M)


def test_limits_are_those_of_the_code() -> None:
    """The page says the limits that hold now."""
    limits = page(COUNTS).partition("## Limits")[2]
    assert limits == PAGE.read_text(encoding="utf-8").partition("## Limits")[2]


def test_slices_are_added() -> None:
    """Counts of slices become those of the whole; the slowest input is that of any of them."""
    slower = {**COUNTS, "slowest": {"seconds": 9.0, "input": "lsp 8"}}
    whole = added([COUNTS, slower])
    assert {"0": 6, "1": 4, "2": 2, "seconds": 3.0} == dict(whole["entries"]["check"])
    assert (6, 8, "lsp 8") == (
        whole["kinds"]["junk bytes"],
        whole["seconds"],
        whole["slowest"]["input"],
    )
    assert "| check | a program, its name strange too | 12 | 6 | 4 | 2 |" in page(whole)
    assert "all                     20" in table(whole)
