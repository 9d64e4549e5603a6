"""The pages of the conformance cases and of a nightly run in a real browser."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver
from selenium.webdriver.common.by import By

from reports.conformance.conform_page import write_conformance_page
from reports.nightly.nightly_page import write_nightly_page

pytestmark = pytest.mark.slow

HOSTILE = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>\x1b[31m"
Json = dict[str, Any]


def _events() -> list[Json]:
    """Two motions that blend, an output between them."""
    told: list[tuple[int, str, Json]] = [
        (0, "motion_start", {"motion": 1}),
        (20_000, "out", {"signal": "$OUT", "number": 2, "value": True}),
        (400_000, "blend_start", {"motion": 1}),
        (450_000, "blend_apex", {"motion": 1}),
        (450_000, "motion_end", {"motion": 1}),
        (450_000, "motion_start", {"motion": 2}),
        (500_000, "blend_end", {"motion": 2}),
        (900_000, "motion_end", {"motion": 2}),
        (900_000, "message", {"number": 1442, "text": HOSTILE}),
    ]
    return [
        {"t": time, "task": "robot", "kind": kind, "at": f"a.src:{2 + time // 450_000}", **fields}
        for time, kind, fields in told
    ]


def conform_record() -> Json:
    """Two cases on two executors, one of which fails."""
    source = f";@ rule: TRG-04\nDEF A()\nN = 1 ;> value N 2\n; {HOSTILE}\nEND\n"

    def result(executor: str, verdict: str) -> Json:
        check = {"file": "a.src", "line": 3, "text": "value N 2", "state": "unmet", "actual": "1"}
        return {
            "executor": executor,
            "robot": "none",
            "verdict": verdict,
            "ending": "end",
            "reason": HOSTILE,
            "checks": [check] if verdict == "fail" else [],
            "events": _events(),
            "divergence": {"at": "a.src:3", "left": "1", "right": HOSTILE},
            "path": {"t": [0, 1], "poses": [[0, 0, 0, 0, 0, 0], [9, 9, 9, 0, 0, 0]]},
        }

    def case(name: str, verdict: str) -> Json:
        return {
            "name": name,
            "suite": name.partition("/")[0],
            "title": f"It is so in {name}",
            "rules": ["TRG-04"],
            "verdict": verdict,
            "files": [{"name": "a.src", "text": source}],
            "results": [result("tree", "pass"), result("vm", verdict)],
        }

    cells = [{"executor": e, "robot": "none", "verdicts": {"pass": 1}} for e in ("tree", "vm")]
    return {
        "cases_total": 2,
        "case_verdicts": {"pass": 1, "fail": 1},
        "suites": [{"name": n, "cases": 1, "cells": cells} for n in ("trigger", "io")],
        "rules": [{"id": "TRG-04", "tier": "T", "may_fail": True, "statement": "So it is."}],
        "cases": [case("trigger/right", "pass"), case("io/wrong", "fail")],
        "history": [{"date": f"2031-05-0{n}", "verdicts": {"pass": n, "fail": 1}} for n in (1, 2)],
    }


Opened = Callable[[Path, str], None]


@pytest.fixture
def opened(browser: webdriver.Chrome) -> Opened:
    """Opens a page anew, without what the browser said of others."""

    def load(page: Path, fragment: str = "") -> None:
        browser.get("about:blank")
        browser.get_log("browser")
        browser.get(page.as_uri() + fragment)

    return load


def _is_sound(browser: webdriver.Chrome) -> bool:
    """Nothing foreign ran, and the browser had nothing to complain about."""
    log = browser.get_log("browser")
    return browser.execute_script("return window.hacked") is None and not log


def test_the_judge_shows_what_was_seen_beside_what_was_expected(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """A link leads to the case, opened; the line that failed tells what was seen."""
    page = write_conformance_page(conform_record(), tmp_path)
    opened(page, "#case=io%2Fwrong")
    assert "1 case of 2 failed" == browser.find_element(By.TAG_NAME, "h1").text
    unmet = browser.find_element(By.CSS_SELECTOR, ".case-source .l.unmet")
    assert "seen: 1" in unmet.text
    assert browser.find_elements(By.CSS_SELECTOR, ".sheet .plot svg")
    assert _is_sound(browser)


def test_cases_are_filtered_by_verdict_and_words(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """The fragment of the address filters, and a cell of the matrix does."""
    page = write_conformance_page(conform_record(), tmp_path)
    opened(page, "#verdict=fail")
    assert "1 case" == browser.find_element(By.ID, "status").text
    opened(page, "#q=right")
    assert "1 case" == browser.find_element(By.ID, "status").text
    browser.execute_script("document.querySelector('#matrix td.cell').click()")
    assert "1 case" == browser.find_element(By.ID, "status").text
    assert _is_sound(browser)


def test_the_page_of_a_night_draws_its_curves(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """Each figure has a curve over the nightly runs; what changed is text and no more."""
    runs = [
        {
            "date": f"2031-05-0{n}",
            "bench": {"vm.ratio": 2.0 + n},
            "recover": {"files": 2, "parsed": n},
        }
        for n in (1, 2)
    ]
    record = {**runs[-1], "changes": [f"new failure: {HOSTILE}"], "history": runs}
    opened(write_nightly_page(record, tmp_path), "")
    titles = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "#curves h3")]
    assert any(title.startswith("vm.ratio") for title in titles)
    assert "Nothing failed" == browser.find_element(By.CSS_SELECTOR, ".top .grammar").text
    row = browser.find_element(By.XPATH, "//tr[th='vm.ratio']")
    assert "vm.ratio 4 3 +33.3 %" == row.text
    figures = browser.find_element(By.CSS_SELECTOR, ".figures").text
    assert "2 of 2" in figures
    assert "fuzzed" not in figures
    assert _is_sound(browser)


def test_a_page_of_5000_cases_is_bounded(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """Below 5 MB: cases that pass are without their source and say so; a list is short at first."""
    record = conform_record()
    right, wrong = record["cases"]
    right["results"] = (right["results"] * 8)[:8]  # as of four executors with two robots
    record["cases"] = [right | {"name": f"trigger/right_{n}"} for n in range(4_999)] + [wrong]
    page = write_conformance_page(record, tmp_path)
    assert page.stat().st_size < 5_000_000
    opened(page, "#case=io/wrong")
    assert "value N 2" in browser.find_element(By.CSS_SELECTOR, ".sheet").text
    narrow = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", narrow)
    try:
        opened(page, "#case=trigger/right_7")
        assert "source and events" in browser.find_element(By.CSS_SELECTOR, ".sheet").text
        shown = browser.execute_script(
            "return [...document.querySelectorAll('.row')].filter((one) => one.offsetHeight).length"
        )
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert shown == 100


def test_a_nightly_page_compares_and_leads_back(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """Each figure with its change, and links to the pages of the runs before, in their folders."""
    runs = [
        {"date": date, "bench": {"vm.ratio": value}}
        for date, value in (("2031-05-05", 9.0), ("x/../y", 8.0), ("2031-05-06", 4.0))
    ]
    for run in runs:
        (tmp_path / str(run["date"])).mkdir(parents=True)
        (tmp_path / str(run["date"]) / "index.html").touch()
    runs.append({"date": "2031-05-07", "bench": {"vm.ratio": 5.0}})
    opened(write_nightly_page({**runs[-1], "history": runs}, tmp_path / "2031-05-07"), "")
    assert "vm.ratio 5 4 +25.0 %" == browser.find_element(By.XPATH, "//tr[th='vm.ratio']").text
    links = browser.find_elements(By.CSS_SELECTOR, "a[href^='../']")
    assert ["../2031-05-06/index.html", "../2031-05-05/index.html"] == [
        one.get_dom_attribute("href") for one in links
    ]


def test_the_page_of_a_bad_night_says_why(
    browser: webdriver.Chrome, opened: Opened, tmp_path: Path
) -> None:
    """What failed stands on top, with the command that repeats it."""
    record = {
        "date": "2031-05-07",
        "steps": {"recover": {"status": "cut off after 9 minutes", "seconds": 540.0}},
        "failures": [
            {"what": "step recover: cut off after 9 minutes", "page": "", "command": ""},
            {"what": "case a/b failed", "page": "conform/index.html#case=a/b", "command": "krl c"},
        ],
    }
    opened(write_nightly_page(record, tmp_path), "")
    told = browser.find_element(By.CSS_SELECTOR, ".grammar .bad").text
    assert told == "2 failures, first: step recover: cut off after 9 minutes"
    found = [one.text for one in browser.find_elements(By.CSS_SELECTOR, "li.bad")]
    assert ["step recover: cut off after 9 minutes", "case a/b failed\nkrl c"] == found
    assert _is_sound(browser)
