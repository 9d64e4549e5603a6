"""All pages in a real browser: WCAG AA by axe-core, in light and dark, and narrow windows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver

from grammar.comparison.backups import compare
from grammar.syntax.source import Source
from reports.conformance.claims_page import write_claims_page
from reports.conformance.conform_page import write_conformance_page
from reports.nightly.nightly_page import write_nightly_page
from reports.programs.coverage_page import CoveredFile, write_coverage_page
from reports.programs.diff_page import write_diff_page
from reports.programs.run_page import write_run_page
from reports.recovery.auto_page import write_auto_page
from reports.recovery.growth_page import write_growth_page
from reports.recovery.survey_page import write_survey_page
from tests.reports.browsing import find_all, load
from tests.reports.test_claims_page import RECORDS
from tests.reports.test_conform_browser import conform_record
from tests.reports.test_run_browser import recorded

axe = pytest.importorskip("axe_core_python")
pytestmark = pytest.mark.slow

Json = dict[str, Any]
SCRIPT = next(Path(axe.__file__).parent.glob("axe*.js"))
PAGES = (
    "survey", "pending", "complete", "no-files", "growth", "conform", "nightly", "run", "stopped",
    "diff", "claims", "auto", "coverage",
)  # fmt: skip


@pytest.fixture(scope="module")
def pages(
    tmp_path_factory: pytest.TempPathFactory,
    survey_record: Callable[[str], Json],
    grown: Callable[[str], Json],
) -> dict[str, Path]:
    """All pages, from records as commands make them."""
    at = tmp_path_factory.mktemp("pages")
    (at / "run").mkdir()
    growth = grown("believable")
    growth["steps"] = growth["steps"][:12]  # axe looks at every element
    waiting = survey_record("believable") | {"clusters": [], "greedy": [], "pending": "causes"}
    night = {
        "date": "2031-05-07",
        "bench": {"vm.ratio": 4.0},
        "failures": [{"what": "case a/b failed", "page": "conform/x.html", "command": "krl c"}],
        "changes": ["new failure: a/b"],
        "history": [{"date": f"2031-05-0{n}", "bench": {"vm.ratio": n}} for n in (5, 6)],
    }
    old, new = ([Source(f"DEF A()\n{line}\nEND\n", "a.src")] for line in ("HALT", "PTP XHOME"))
    change = {"old": "old", "new": "new", **compare(old, new)}
    step = {"id": "0001-for-step", "title": "FOR … STEP", "edits": ["forStatement: STEP"]}
    covered = CoveredFile(
        "R1/Program/cell.src",
        "DEF CELL()\nIF $IN[1] THEN\nHALT\nENDIF\nEND\n",
        lines={2: 3, 3: 0},
        branches={2: {"THEN": 0, "ELSE": 3}},
        routines={"CELL": (1, 3)},
    )
    grown_alone = {
        "start": "preliminary.g4",
        "rounds": [
            {
                "shown": {"parsed": 3 + n, "files": 9, "failing": 9 - n},
                "rules": 90 + n,
                "taken": [step],
                "refused": [step | {"reason": "accepts negatives"}],
            }
            for n in range(3)
        ],
    }
    return {
        "survey": write_survey_page(survey_record("both"), at / "survey"),
        "pending": write_survey_page(waiting, at / "pending"),
        "complete": write_survey_page(survey_record("story"), at / "complete"),
        "no-files": write_survey_page(survey_record("empty"), at / "no-files"),
        "growth": write_growth_page(growth, at / "growth"),
        "conform": write_conformance_page(conform_record(), at / "conform"),
        "nightly": write_nightly_page(night, at / "nightly"),
        "run": write_run_page(recorded(), at / "run" / "run.html"),
        "stopped": write_run_page(recorded("DEF CELL()\nHALT\nEND\n"), at / "run" / "stopped.html"),
        "diff": write_diff_page(change, at / "diff.html"),
        "claims": write_claims_page(RECORDS, at / "claims"),
        "coverage": write_coverage_page([covered], 1, at / "coverage"),
        "auto": write_auto_page(grown_alone, at / "auto"),
    }


@pytest.fixture
def resize(browser: webdriver.Chrome) -> Iterator[Callable[[int], None]]:
    """Makes the window so many pixels wide, and waits for charts, which are drawn anew then."""
    drawn = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));"

    def to(width: int) -> None:
        size = {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        browser.execute_async_script(drawn)

    yield to
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


@pytest.mark.parametrize("name", PAGES)
def test_a_page_can_be_used_by_all(
    browser: webdriver.Chrome, pages: dict[str, Path], name: str, resize: Callable[[int], None]
) -> None:
    """No rule of WCAG 2.1 A and AA that a program can check is broken, rows opened.

    Neither in a wide window nor, in dark, in a narrow one.
    """
    resize(1400)
    load(browser, pages[name].as_uri())
    for row in find_all(browser, ".row .open")[:2]:
        browser.execute_script("arguments[0].click()", row)
    browser.execute_script(SCRIPT.read_text(encoding="utf-8"))
    tags = {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]}
    found = _violations(browser, tags)
    resize(400)
    dark = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", dark)
    try:
        found += _violations(browser, tags)
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert [] == found


@pytest.mark.parametrize("name", PAGES)
def test_a_page_can_be_printed(
    browser: webdriver.Chrome, pages: dict[str, Path], name: str, resize: Callable[[int], None]
) -> None:
    """On paper nothing is cut off at the side, and no title of a row is set letter by letter."""
    resize(720)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        load(browser, pages[name].as_uri())
        page = "return document.documentElement.scrollWidth"
        assert 720 >= browser.execute_script(page)
        rows = "return [...document.querySelectorAll('.row .open')].map((one) => one.offsetHeight)"
        assert 80 > max(browser.execute_script(rows), default=0)
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def _violations(browser: webdriver.Chrome, only: Json) -> list[str]:
    script = (
        "const done = arguments[1]; axe.run(document, { runOnly: arguments[0] })"
        ".then((found) => done(found.violations.flatMap((one) => one.nodes.map("
        "(node) => `${one.id}: ${node.html.slice(0, 150)}`))), (error) => done([String(error)]));"
    )
    return list(browser.execute_async_script(script, only))


@pytest.mark.parametrize("name", PAGES)
def test_a_page_fits_a_narrow_window(
    browser: webdriver.Chrome, pages: dict[str, Path], name: str, resize: Callable[[int], None]
) -> None:
    """Nothing is beside the window, and text stands in words and not in letters."""
    resize(400)
    load(browser, pages[name].as_uri())
    for window in (400, 800, 950):
        resize(window)
        width = browser.execute_script("return document.documentElement.scrollWidth")
        columns = browser.execute_script(
            "return [...document.querySelectorAll('th, td, h1, h2, h3, p, li')].filter((one) => {"
            " const box = one.getBoundingClientRect();"
            " return one.textContent.trim().length > 12 && box.width > 0 && box.width < 40"
            "  && box.height > 60; }).map((one) => one.textContent.trim())"
        )
        assert width <= window
        assert [] == columns
