"""The growth page in a real browser."""

from collections.abc import Callable
from typing import Any

import pytest
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

from reports.recovery.growth_page import write_growth_page
from tests.reports.browsing import HAS_INK, find, find_all, load, row_titles

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def pages(
    tmp_path_factory: pytest.TempPathFactory, grown: Callable[[str], dict[str, Any]]
) -> Callable[[str], str]:
    """The address of the page of a named record, each written once."""
    folder = tmp_path_factory.mktemp("pages")
    names = ("believable", "hostile", "start")
    written = {name: write_growth_page(grown(name), folder / name) for name in names}
    return lambda name: written[name].as_uri()


def test_a_link_to_a_construct_opens_it(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Its edit, its evidence, its examples and what it restored are there, and it is in view."""
    load(browser, f"{pages('believable')}#c-0012")
    card = find(browser, ".card")
    assert "DEFFCT with a return type (12)" == find(browser, ".row.opened .open").text
    top = browser.execute_script("return arguments[0].getBoundingClientRect().top", card)
    assert 0 <= top < 250
    assert ["+    : WORD12? DEF NAME"] == [e.text for e in card.find_elements(By.CLASS_NAME, "add")]
    headings = [h.text for h in card.find_elements(By.TAG_NAME, "h3")]
    assert [
        "Edit of the grammar",
        "Accepted since",
        "Still refused",
        "Evidence",
        "Metrics",
    ] == headings
    evidence = card.find_element(By.CLASS_NAME, "evidence").text
    assert "corroborated" in evidence
    assert "SCO-04" in evidence
    assert "WORD12 DEF A()" in card.find_element(By.CSS_SELECTOR, ".source:not(.bare)").text


def test_a_click_on_a_row_opens_and_closes_it(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """The address names the step while it is open."""
    load(browser, pages("believable"))
    assert [] == find_all(browser, ".card")
    browser.execute_script("document.querySelectorAll('.row .open')[3].click()")
    assert find(browser, ".card").is_displayed()
    assert browser.current_url.endswith("#c-0003")
    browser.execute_script("document.querySelectorAll('.row .open')[3].click()")
    assert not find(browser, ".card").is_displayed()
    assert "#" not in browser.current_url


def test_search_looks_at_what_a_construct_is(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Title, edit, examples, rules; the address carries it."""
    load(browser, f"{pages('believable')}#q=word31+sco-04")
    assert [] == row_titles(browser)
    assert find(browser, "#none").is_displayed()
    field = find(browser, "#search")
    for words, title in (("word31", "GLOBAL before DEF and DEFFCT (31)"), ("switch", "SWITCH")):
        field.clear()
        field.send_keys(words)
        assert row_titles(browser)[0].startswith(title)
    assert "#q=switch" in browser.current_url
    assert "4 of 41 steps" == find(browser, "#status").text


def test_the_chart_names_the_step_under_the_pointer_and_opens_it(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """All charts show the same step meanwhile."""
    load(browser, pages("believable"))
    plot = find(browser, "#rate .u-over")
    offset = round(plot.size["width"] * (10 / 40 - 1 / 2))
    ActionChains(browser).move_to_element_with_offset(plot, offset, 0).perform()
    assert find(browser, "#rate .tip").text.startswith("10. TRIGGER WHEN PATH … ONSTART\n+")
    assert all("after 10: " in e.text for e in find_all(browser, ".metric .now"))
    ActionChains(browser).click().perform()
    assert "TRIGGER WHEN PATH … ONSTART" == find(browser, ".row.opened .open").text


def test_each_metric_has_its_chart(browser: webdriver.Chrome, pages: Callable[[str], str]) -> None:
    """With where it began and where it ended."""
    load(browser, pages("believable"))
    shown = {
        figure.find_element(By.TAG_NAME, "b").text: figure.find_element(By.CLASS_NAME, "now").text
        for figure in find_all(browser, ".metric")
    }
    assert ["failing lines", "TERM", "VAR", "MCC", "AVS", "HAL", "LL1"] == list(shown)
    assert "76 → 96" == shown["TERM"]
    drawn = "return [...document.querySelectorAll('.metric canvas')].filter(hasInk).length"
    assert 7 == browser.execute_script(f"{HAS_INK} {drawn}")


def test_a_ledger_without_steps_has_no_chart(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """And reports no error."""
    browser.get_log("browser")
    load(browser, pages("start"))
    assert "The ledger is empty" == find(browser, "#empty h2").text
    assert [] == browser.get_log("browser")
