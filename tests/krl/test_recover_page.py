"""The page of a real survey, opened in a real browser."""

import json
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement

from grammar.notation.generate import GRAMMAR
from krl.cli import main

FILES = {
    "cell1/KRC/R1/step.src": "DEF A()\r\nFOR I=1 TO 9 STEP 2\r\nENDFOR\r\nEND\r\n",
    "cell1/KRC/R1/loop.src": "DEF A()\nLOOP\n\tFOR I=1 TO N STEP K ; on\n\tENDFOR\nENDLOOP\nEND\n",
    "cell2/KRC/R1/long.src": "DEF A()\nHALT\nFOR J=1 TO 5 STEP LONG\nENDFOR\nRETURN 1\nEND\n",
    "cell2/KRC/R1/back.src": 'DEF A()\n\tRETURN "Größe<script>window.hacked=1</script>"\nEND\n',
    "cell2/KRC/R1/fine.src": "DEF A()\nHALT\nEND\n",
    "cell2/KRC/R1/odd.src": "DEF A()\nA=1 § \x1b[31m\nEND\n",
    "cell2/KRC/R1/copy.src": "DEF A()\nA=1 § \x1b[31m\nEND\n",
    "cell2/KRC/R1/junk.dat": "1;2;3\n",
}

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `krl recover` wrote for a small corpus."""
    root = tmp_path_factory.mktemp("corpus")
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(text.encode())
    folder = tmp_path_factory.mktemp("out")
    grammar = str(GRAMMAR.with_name("preliminary.g4"))
    options = ["--grammar", grammar, "--out", str(folder), "--jobs", "1"]
    assert 0 == main(["recover", str(root), *options])
    return folder


@pytest.fixture(scope="module")
def record(out: Path) -> dict[str, Any]:
    loaded = json.loads((out / "survey.json").read_text("utf-8"))
    assert isinstance(loaded, dict)
    return loaded


@pytest.fixture
def page(browser: webdriver.Chrome, out: Path) -> webdriver.Chrome:
    """The page, freshly loaded."""
    browser.get("about:blank")
    browser.get_log("browser")
    browser.get((out / "index.html").as_uri())
    return browser


def texts(within: webdriver.Chrome | WebElement, selector: str) -> list[str]:
    found = within.find_elements(By.CSS_SELECTOR, selector)
    return [element.get_attribute("textContent") or "" for element in found]


def opened(page: webdriver.Chrome, number: int) -> WebElement:
    """The card of a cluster, the only one that is open, opened by a click."""
    address = page.current_url.partition("#")[0]
    page.get("about:blank")
    page.get(address)
    row = page.find_elements(By.CSS_SELECTOR, ".row .open")[number]
    page.execute_script("arguments[0].scrollIntoView({block: 'center'})", row)
    row.click()
    return page.find_element(By.CSS_SELECTOR, ".card")


def test_every_cluster_of_the_survey_is_listed(
    page: webdriver.Chrome, record: dict[str, Any]
) -> None:
    """A row for each cluster, in the order of the record, with what it unlocks."""
    titles = [entry["title"] for entry in record["clusters"]]
    assert len(titles) >= 3
    assert "FOR with STEP" in titles
    assert titles == texts(page, "#rows > .row .open")
    for row, entry in zip(
        page.find_elements(By.CSS_SELECTOR, "#rows > .row"), record["clusters"], strict=True
    ):
        figures = [cell.text for cell in row.find_elements(By.TAG_NAME, "td")]
        assert str(entry["unlocks"]) in figures
        assert str(entry["files"]) in figures


def test_an_opened_cluster_shows_its_example(
    page: webdriver.Chrome, record: dict[str, Any]
) -> None:
    """The failing line stands among its neighbours, its token marked, as in the file."""
    for number, entry in enumerate(record["clusters"]):
        card = opened(page, number)
        assert card.is_displayed()
        example = entry["example"]
        shown = texts(card, ".example .l:not(.caret) .tx")
        assert len(example["context"]) == len(shown)
        (failing,) = texts(card, ".example .failing .tx")
        assert visible(example["text"]) == failing
        assert [visible(example["token"])] == texts(card, ".example .token")[:1]


def visible(text: str) -> str:
    """A text as the page shows it: control characters as pictures of themselves."""
    return "".join(chr(0x2400 + ord(c)) if ord(c) < 32 and c != "\t" else c for c in text)


def test_an_opened_cluster_shows_what_would_mend_it(
    page: webdriver.Chrome, record: dict[str, Any]
) -> None:
    """The proposals stand with their figures, and the reproducer with its program."""
    number, entry = next(
        (n, e) for n, e in enumerate(record["clusters"]) if e["title"] == "FOR with STEP"
    )
    card = opened(page, number)
    rows = card.find_elements(By.CSS_SELECTOR, ".proposals tbody tr")
    assert any(entry["proposals"][0]["edit"] in row.text for row in rows)
    assert str(entry["proposals"][0]["restores"]) in texts(card, ".proposals td.num")[0]
    failing = entry["reproducer"]["text"].splitlines()[entry["reproducer"]["line"] - 1]
    assert failing.strip() in (card.get_attribute("textContent") or "")


def test_the_figures_of_the_survey_are_on_the_page(
    page: webdriver.Chrome, record: dict[str, Any]
) -> None:
    """How many files there are, and that some were skipped, is said."""
    said = page.find_element(By.TAG_NAME, "body").text
    assert (7, 1, 1) == (record["files"], record["parsed"], len(record["skipped"]))
    assert str(record["files"]) in said
    assert "junk.dat" in (page.find_element(By.ID, "skipped").get_attribute("textContent") or "")


def test_the_order_of_mending_is_on_the_page(
    page: webdriver.Chrome, record: dict[str, Any]
) -> None:
    """The chart and its list name the clusters in the order in which to mend them."""
    titles = {entry["id"]: entry["title"] for entry in record["clusters"]}
    steps = texts(page, "#steps a")
    assert len(record["greedy"]) == len(steps)
    for step, shown in zip(record["greedy"], steps, strict=True):
        assert titles[step["cluster"]] in shown


def test_source_does_not_run(page: webdriver.Chrome, record: dict[str, Any]) -> None:
    """Markup in a program is text; the page asks for nothing and reports no error."""
    for number in range(len(record["clusters"])):
        opened(page, number)
        assert page.execute_script("return window.hacked === undefined")
        assert [] == page.find_elements(By.CSS_SELECTOR, ".card script")
    assert 0 == page.execute_script("return performance.getEntriesByType('resource').length")
    assert [] == page.get_log("browser")
