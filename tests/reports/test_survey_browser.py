"""The survey page in a real browser."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

from reports.recovery.survey_page import write_survey_page
from tests.reports.browsing import find, find_all, load, row_titles

RecordBuilder = Callable[[str], dict[str, Any]]
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def pages(
    tmp_path_factory: pytest.TempPathFactory, survey_record: RecordBuilder
) -> Callable[[str], str]:
    """The address of the page of a named record, each written once."""
    folder = tmp_path_factory.mktemp("pages")
    names = ("believable", "large", "complete", "empty", "hostile", "story", "both")
    written = {name: write_survey_page(survey_record(name), folder / name) for name in names}
    return lambda name: written[name].as_uri()


def _click(browser: webdriver.Chrome, element: WebElement) -> None:
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
    element.click()


def _column(browser: webdriver.Chrome, key: str) -> list[int]:
    script = """
        const head = document.querySelector(`#table > thead th[data-key=${arguments[0]}]`);
        return [...document.querySelectorAll('.row:not([hidden])')]
            .map(row => Number(row.cells[head.cellIndex].textContent.replaceAll(',', '')));
    """
    return list(browser.execute_script(script, key))


def _box(browser: webdriver.Chrome, element: WebElement) -> dict[str, float]:
    return dict(browser.execute_script("return arguments[0].getBoundingClientRect()", element))


def test_clusters_are_listed_in_the_order_of_the_survey(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """Every cluster has its row, and no card is built before it is asked for."""
    load(browser, pages("believable"))
    expected = [cluster["title"] for cluster in survey_record("believable")["clusters"]]
    assert expected == row_titles(browser)
    assert find_all(browser, ".card") == []


def test_the_page_loads_no_resource_and_reports_no_error(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """The browser asked for nothing beyond the page, and its policy was not offended."""
    browser.get_log("browser")
    load(browser, pages("believable"))
    assert browser.execute_script("return performance.getEntriesByType('resource').length") == 0
    assert browser.get_log("browser") == []


def test_a_click_on_a_heading_sorts_and_a_third_one_restores(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Figures sort from the largest, then from the smallest; the state is told to readers."""
    load(browser, pages("believable"))
    original = _column(browser, "files")
    head = find(browser, "#table > thead th[data-key=files]")
    heading = head.find_element(By.TAG_NAME, "button")
    _click(browser, heading)
    assert sorted(original, reverse=True) == _column(browser, "files")
    assert head.get_attribute("aria-sort") == "descending"
    _click(browser, heading)
    assert sorted(original) == _column(browser, "files")
    assert head.get_attribute("aria-sort") == "ascending"
    _click(browser, heading)
    assert original == _column(browser, "files")
    assert head.get_attribute("aria-sort") is None


def test_headings_and_rows_work_from_the_keyboard(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Return sorts by a heading, arrows walk the rows, Return opens one."""
    load(browser, pages("believable"))
    find(browser, "th[data-key=title] button").send_keys(Keys.ENTER)
    assert sorted(row_titles(browser), key=str.lower) == row_titles(browser)
    find(browser, ".row .open").send_keys(Keys.ARROW_DOWN)
    browser.switch_to.active_element.send_keys(Keys.ENTER)
    opened = find(browser, ".row.opened .open")
    assert row_titles(browser)[1] == opened.text
    assert opened.get_attribute("aria-expanded") == "true"


def test_a_click_on_a_row_opens_and_closes_its_card(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """The card shows the example in its context, and what was expected instead."""
    cluster = survey_record("believable")["clusters"][0]
    load(browser, pages("believable"))
    _click(browser, find(browser, ".row .rule"))
    card = find(browser, ".card")
    assert card.is_displayed()
    lines = card.find_elements(By.CSS_SELECTOR, ".example .l:not(.caret) .tx")
    assert [c["text"] for c in cluster["example"]["context"]] == [
        line.get_attribute("textContent") for line in lines
    ]
    assert card.find_element(By.CSS_SELECTOR, ".example .token").text == cluster["token"]
    assert cluster["expected"] == [chip.text for chip in find_all(browser, ".chips code")]
    _click(browser, find(browser, ".row .rule"))
    assert not card.is_displayed()


@pytest.mark.parametrize(
    ("line", "token"),
    [
        ("\t  PTP\tXP4 C_PTP C_DIS", "C_DIS"),
        ('s[]="Größe; 位置 ␀"\tbad', "bad"),
        ('s[]="e\u0301e\u0301e\u0301" \x1b bad', "bad"),
        ("§", "§"),
        ("LIN {X 1.0" + ",Y 20.5" * 60 + "} EXTRA", "EXTRA"),
    ],
)
def test_the_carets_stand_exactly_under_the_token(
    browser: webdriver.Chrome,
    survey_record: RecordBuilder,
    tmp_path: Path,
    line: str,
    token: str,
) -> None:
    """Tabs, wide characters and long lines do not move them, and they are in view."""
    record = survey_record("believable")
    cluster = record["clusters"][0]
    column = line.index(token) + 1
    cluster["token"] = token
    cluster["example"] = {"path": "a.src", "line": 7, "column": column, "text": line}
    load(browser, write_survey_page(record, tmp_path).as_uri() + f"#cluster={cluster['id']}")
    block = _box(browser, find(browser, ".example .source"))
    found = _box(browser, find(browser, ".example .token"))
    carets = _box(browser, find(browser, ".example .marks"))
    assert carets["left"] == pytest.approx(found["left"], abs=0.6)
    assert carets["right"] == pytest.approx(found["right"], abs=0.6)
    assert found["bottom"] - 4 <= carets["top"] <= found["bottom"] + 4
    assert block["left"] <= carets["left"]
    assert carets["right"] <= block["right"]


def test_a_link_to_a_cluster_opens_it_and_brings_it_into_view(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """A link in a mail or an issue leads to the card itself."""
    cluster = survey_record("large")["clusters"][431]
    load(browser, f"{pages('large')}#cluster={cluster['id']}")
    opened = find(browser, ".row.opened")
    assert cluster["title"] == opened.find_element(By.CLASS_NAME, "open").text
    assert 0 <= _box(browser, opened)["top"] < 200
    assert len(find_all(browser, ".card")) == 1


def test_a_link_to_an_unknown_cluster_is_reported(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """The page of another survey may not have it."""
    load(browser, f"{pages('believable')}#cluster=c-unknown")
    assert find(browser, "#status").text == "No such cluster in this survey"


def test_search_looks_at_title_rule_source_path_and_expected_tokens(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """All words must be found, in whatever case; what was searched stands in the address."""
    load(browser, pages("believable"))
    field = find(browser, "#search")
    for words, title in (
        ("onstart trigger", "TRIGGER … ONSTART"),
        ("ifstatement", "ELSEIF"),
        ("part_code $in[33]", "SIGNAL … TO"),
        ("part_37.src", "CONTINUE before $OUT"),
        ("ENDSWITCH", "ELSEIF"),
    ):
        field.clear()
        field.send_keys(words)
        assert title in row_titles(browser)
        assert len(row_titles(browser)) < 11
    assert "q=ENDSWITCH" in browser.current_url
    assert "of 11 clusters" in find(browser, "#status").text


def test_a_search_without_a_match_says_so_and_can_be_cleared(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """The address carries the search, and one button leads back."""
    load(browser, f"{pages('believable')}#q=nowhere+at+all")
    assert row_titles(browser) == []
    assert find(browser, "#none").is_displayed()
    _click(browser, find(browser, "#clear"))
    assert len(row_titles(browser)) == 11


def test_filters_keep_what_unlocks_what_is_direct_and_one_origin(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """Each filter hides exactly the clusters it names."""
    clusters = survey_record("believable")["clusters"]
    load(browser, pages("believable"))
    _click(browser, find(browser, "#unlocking"))
    assert [c["title"] for c in clusters if c["unlocks"]] == row_titles(browser)
    _click(browser, find(browser, "#unlocking"))
    _click(browser, find(browser, "#direct"))
    assert [c["title"] for c in clusters if c["follows"] < c["failures"]] == row_titles(browser)
    _click(browser, find(browser, "#direct"))
    find(browser, "#origin").send_keys("training")
    with_origin = [
        c["title"] for c in clusters if any(o["origin"] == "training" for o in c["files_by_origin"])
    ]
    assert with_origin == row_titles(browser)


def test_a_long_expected_set_is_folded_and_unfolds(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """The rest is counted on the button that shows it."""
    cluster = max(survey_record("believable")["clusters"], key=lambda c: len(c["expected"]))
    load(browser, f"{pages('believable')}#cluster={cluster['id']}")
    assert len(find_all(browser, ".chips code")) == 14
    more = find(browser, ".chips button")
    assert f"… {len(cluster['expected']) - 14} more" == more.text
    _click(browser, more)
    assert cluster["expected"] == [chip.text for chip in find_all(browser, ".chips code")]


def test_files_of_many_origins_are_folded_by_origin(
    browser: webdriver.Chrome, survey_record: RecordBuilder, tmp_path: Path
) -> None:
    """The first six origins are named at once, each with its files behind a fold."""
    record = survey_record("believable")
    cluster = record["clusters"][0]
    cluster["files_by_origin"] = [
        {"origin": f"cell-{n}", "files": [{"path": f"cell-{n}/a.src", "line": n}], "more": 2}
        for n in range(1, 21)
    ]
    load(browser, write_survey_page(record, tmp_path).as_uri() + f"#cluster={cluster['id']}")
    section = find_all(browser, ".halves section")[-1]
    assert [line.text for line in section.find_elements(By.TAG_NAME, "summary")] == [
        *(f"3 cell-{n}" for n in range(1, 7)),
        "14 more origins",
    ]
    _click(browser, section.find_element(By.TAG_NAME, "summary"))
    browser.implicitly_wait(2)
    paths = section.find_element(By.CLASS_NAME, "paths").text
    browser.implicitly_wait(0)
    assert paths == "cell-1/a.src:1\n… 2 more in the JSON of the survey"


def test_the_copy_button_copies_the_reproducer_unchanged(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """What is copied is the program, without line numbers or carets."""
    cluster = survey_record("believable")["clusters"][4]
    load(browser, f"{pages('believable')}#cluster={cluster['id']}")
    browser.execute_script(  # the label stays, however slow we are to look at it
        "navigator.clipboard.writeText = async (text) => { window.copied = text; };"
        "window.setTimeout = () => {};"
    )
    copy = find(browser, ".heading button")
    _click(browser, copy)
    assert cluster["reproducer"]["text"] == browser.execute_script("return window.copied")
    assert copy.text == "Copied"


def test_proposals_stand_in_a_table_with_their_figures(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Figures that speak against a proposal stand out; the change unfolds."""
    load(browser, f"{pages('believable')}#cluster=c-001003")
    heads = [cell.text for cell in find_all(browser, ".proposals th")]
    assert heads == ["Edit", "Restores", "Breaks", "Negatives accepted", "Ambiguities"]
    figures = [cell.text for cell in find_all(browser, ".proposals td.num")]
    assert figures == ["41", "0", "0", "0", "42", "0", "12", "1"]
    assert [cell.text for cell in find_all(browser, ".proposals .bad")] == ["12", "1"]
    _click(browser, find(browser, ".proposals summary"))
    browser.implicitly_wait(2)
    assert find(browser, ".proposals .add").text == "+    : 'A' 'X'? 'B'"
    browser.implicitly_wait(0)


def test_the_chart_names_the_step_under_the_pointer_and_opens_it(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """The list beside the chart shows the same step; a click leads to its card."""
    load(browser, pages("believable"))
    plot, steps = find(browser, "#chart .u-over"), len(find_all(browser, "#steps a"))
    offset = round(plot.size["width"] * (2 / steps - 1 / 2))
    ActionChains(browser).move_to_element_with_offset(plot, offset, 0).perform()
    tip = find(browser, ".tip").text
    assert tip == "2. GLOBAL before DEF\n+46 files, then 415 of 583 parse (71.1 %)"
    assert "GLOBAL before DEF" in find(browser, "#steps a.on").text
    ActionChains(browser).click().perform()
    assert find(browser, ".row.opened .open").text == "GLOBAL before DEF"
    assert "cluster=c-002ef2" in browser.current_url


def test_a_step_of_the_mending_order_opens_its_cluster(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """A filter that hides the cluster is lifted."""
    load(browser, f"{pages('believable')}#q=elseif")
    _click(browser, find_all(browser, "#steps a")[3])
    assert find(browser, ".row.opened .open").text == "CONTINUE before $OUT"
    assert find(browser, ".row.opened").is_displayed()


def test_hostile_text_is_shown_and_does_not_run(
    browser: webdriver.Chrome, pages: Callable[[str], str]
) -> None:
    """Every card and fold is opened; nothing ran, nothing loaded, and the text is there."""
    browser.get_log("browser")
    load(browser, pages("hostile"))
    browser.execute_async_script(
        """
        const done = arguments[0];
        document.querySelectorAll('.row .open').forEach(e => e.click());
        document.querySelectorAll('.chips button').forEach(e => e.click());
        document.querySelectorAll('details').forEach(e => { e.open = true; });
        setTimeout(done, 200);
        """
    )
    assert browser.execute_script("return window.hacked === undefined")
    assert find_all(browser, "img") == []
    assert len(find_all(browser, "script")) == 2
    assert len(find_all(browser, ".card")) == 22
    assert len(find_all(browser, ".answered")) == 8
    line = find(browser, ".example .failing .tx").get_attribute("textContent") or ""
    assert "</script><script>window.hacked=1</script>" in line
    assert "␛[31m␀" in line
    assert browser.get_log("browser") == []


def test_a_cluster_of_the_start_shows_what_answered_it(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """The construct with its edit, evidence and examples, before the example that failed."""
    cluster = survey_record("story")["start"]["clusters"][1]
    load(browser, f"{pages('story')}#start-cluster={cluster['id']}")
    card = find(browser, ".card")
    assert card.text.index("Answered by 0002-deffct-with-a: DEFFCT") < card.text.index("Example")
    answer = card.find_element(By.CLASS_NAME, "answered")
    assert answer.find_element(By.CLASS_NAME, "add").text == "+    : WORD2? DEF NAME"
    assert "documented" in answer.find_element(By.CLASS_NAME, "evidence").text
    browser.execute_script("document.querySelectorAll('.answered details')[2].open = true")
    assert "WORD2 DEF A()" in answer.text
    titles = [
        button.get_attribute("title") or "" for button in find_all(browser, ".heading button")
    ]
    assert not any("krl construct propose" in title for title in titles)


def test_both_sections_keep_their_own_state(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """Clusters of the same name are opened, searched and sorted each in its own table."""
    cluster = survey_record("both")["clusters"][2]
    load(browser, f"{pages('both')}#cluster={cluster['id']}&start-q=elseif")
    assert [e.get_attribute("id") for e in find_all(browser, ".card")] == ["card-2"]
    shown = "return [...document.querySelectorAll(arguments[0])].filter(e => !e.hidden).length"
    assert browser.execute_script(shown, "#rows > .row") == 11
    assert browser.execute_script(shown, "#start-rows > .row") == 1
    _click(browser, find(browser, "#start-clear"))
    _click(browser, find(browser, "#start-table th[data-key=answer] button"))
    answers = [e.text for e in find_all(browser, "#start-rows .answer")]
    assert answers[-3:] == ["nothing yet"] * 3
    assert f"cluster={cluster['id']}" in browser.current_url
    assert "start-sort=answer" in browser.current_url


def test_500_clusters_stay_usable(browser: webdriver.Chrome, pages: Callable[[str], str]) -> None:
    """All rows are there at once, no card is built before it is asked for, and search finds few."""
    load(browser, pages("large"))
    assert len(find_all(browser, "#rows > .row")) == 500
    assert find_all(browser, ".card") == []
    browser.execute_script(
        """
        document.querySelector('th[data-key=rule] button').click();
        const search = document.getElementById('search');
        search.value = 'elseif';
        search.dispatchEvent(new Event('input'));
        """
    )
    assert 0 < len(row_titles(browser)) < 500
    assert find_all(browser, ".card") == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("complete", "Nothing is missing: every file parses under this grammar"),
        ("empty", "No KRL found"),
    ],
)
def test_a_survey_without_clusters_says_why(
    browser: webdriver.Chrome, pages: Callable[[str], str], name: str, words: str
) -> None:
    """There is no empty table; the reasons of skipped files remain."""
    load(browser, pages(name))
    assert find(browser, "#empty h2").text == words
    assert find_all(browser, "#table") == []
    assert len(find_all(browser, "#skipped summary")) == 3


def test_a_long_list_is_short_at_first(
    browser: webdriver.Chrome, pages: Callable[[str], str], survey_record: RecordBuilder
) -> None:
    """A hundred clusters are shown, then all of them; a link leads to any."""
    clusters = survey_record("large")["clusters"]
    visible = "[...document.querySelectorAll('.row')].filter((row) => row.checkVisibility())"
    shown = f"return {visible}.length"
    load(browser, pages("large"))
    assert 100 == browser.execute_script(shown)
    more = find(browser, "button.more")
    assert f"{len(clusters) - 100:,} more" == more.text
    _click(browser, more)
    assert len(clusters) == browser.execute_script(shown)
    load(browser, f"{pages('large')}#cluster={clusters[431]['id']}")
    assert find(browser, ".row.opened").is_displayed()
