"""The page of a run in a real browser: the arm, playback, charts, program and events in step."""

import re
from collections.abc import Callable, Iterator
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

from grammar.syntax.source import Source
from interp.program.load import load
from interp.robot.simulation.factory import RobotName
from interp.robot.simulation.scene import Scene, SceneObject
from interp.run_record import RunRecord, record_of
from interp.session import RunSetup, run_program
from interp.values.poses import Pose
from reports.programs.run_page import write_run_page
from tests.reports.browsing import find, find_all

pytestmark = pytest.mark.slow

HOSTILE = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>\x1b[31m"
_PROGRAM = f"""DEF CELL() ; {HOSTILE}
$TOOL = {{X 10, Y 0, Z 100, A 0, B 90, C 0}}
PTP {{A1 0, A2 -90, A3 90, A4 0, A5 45, A6 0}}
TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[2]=TRUE
LIN_REL {{X 100}} C_DIS
LIN_REL {{Y 100}}
$OUT[2] = FALSE
PTP_REL {{A1 30, A5 -30}}
WAIT SEC 1
END
"""
Json = dict[str, Any]
Shown = Callable[[Any], webdriver.Chrome]


@cache
def recorded(
    text: str = _PROGRAM, robot: RobotName = "kinematic", scene: Scene | None = None
) -> RunRecord:
    """The record of a real run."""
    program = load([Source(text, "cell.src")], "cell.src")
    setup = RunSetup(robot=robot, scene=scene)
    return record_of(run_program(program, setup), program, setup)


@pytest.fixture
def shown(browser: webdriver.Chrome, tmp_path: Path) -> Iterator[Shown]:
    """Opens the page of a record; at the end nothing foreign ran, and no script complained."""

    def load_page(record: Any) -> webdriver.Chrome:
        browser.get("about:blank")
        browser.get_log("browser")
        browser.get(write_run_page(record, tmp_path / "run.html").as_uri())
        return browser

    yield load_page
    assert browser.execute_script("return window.hacked") is None
    assert [] == [said for said in browser.get_log("browser") if said["source"] != "rendering"]


@pytest.fixture
def without_webgl(browser: webdriver.Chrome) -> Iterator[None]:
    """A browser that has no 3D graphics."""
    script = """const real = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return kind.startsWith("webgl") ? null : real.call(this, kind, ...more);
        };"""
    added = browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": script})
    yield
    browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", added)


def _point_at(browser: webdriver.Chrome, time: int) -> None:
    """Move the slider, and wait until it is drawn."""
    browser.execute_async_script(
        "const slider = document.getElementById('slider');"
        "slider.value = arguments[0]; slider.dispatchEvent(new Event('input'));"
        "requestAnimationFrame(() => requestAnimationFrame(arguments[1]));",
        time,
    )


def _numbers(text: str) -> list[float]:
    return [float(found) for found in re.findall(r"-?\d+\.\d+", text)]


def _told_place(browser: webdriver.Chrome) -> list[float]:
    return _numbers(find(browser, "#place").text)


def test_the_tool_of_the_arm_is_where_the_path_has_it(shown: Shown) -> None:
    """At every 25th sample the links lead to the set-point of the tool, within 0.3 mm."""
    record = recorded()
    browser = shown(record)
    path = record["path"]
    for time, place in list(zip(path["t"], path["tool"], strict=True))[::25]:
        _point_at(browser, time)
        told = _told_place(browser)
        assert all(abs(one - other) < 0.3 for one, other in zip(told, place, strict=True))


@pytest.mark.usefixtures("without_webgl")
def test_without_webgl_the_arm_is_drawn_all_the_same(shown: Shown) -> None:
    """SVG takes over: its faces move with the slider, and the tool is at the same place."""
    record = recorded()
    browser = shown(record)
    _point_at(browser, 0)
    before = find(browser, "#scene svg").get_attribute("innerHTML")
    _point_at(browser, record["outcome"]["time"])
    assert before != find(browser, "#scene svg").get_attribute("innerHTML")
    expected = record["path"]["tool"][-1]
    assert all(abs(a - b) < 0.3 for a, b in zip(_told_place(browser), expected, strict=True))


def test_the_picture_follows_the_slider_and_the_view(shown: Shown) -> None:
    """Another moment and another direction are other pictures; the first comes back."""
    browser = shown(recorded())
    scene = find(browser, "#scene")
    pictures = []
    for time, view in (
        (0, "slanted"),
        (1_500_000, "slanted"),
        (1_500_000, "above"),
        (0, "slanted"),
    ):
        find(browser, f"#{view}").click()
        _point_at(browser, time)
        pictures.append(scene.screenshot_as_base64)
    assert 3 == len(set(pictures))
    assert pictures[0] == pictures[3]


def test_the_whole_arm_is_in_the_picture(shown: Shown) -> None:
    """However short the path, no view cuts off the arm, which is orange."""
    tool = "$TOOL = {X 500, Y 0, Z 0, A 0, B 0, C 0}"
    point = "{A1 0, A2 -90, A3 90, A4 0, A5 45, A6 0}"
    browser = shown(recorded(f"DEF CELL()\n{tool}\nPTP {point}\nEND\n"))
    for view in ("slanted", "front", "side"):
        find(browser, f"#{view}").click()
        _point_at(browser, 100_000)
        picture = Image.open(BytesIO(find(browser, "#scene").screenshot_as_png)).convert("RGB")
        pixels = np.asarray(picture, dtype=int)
        orange = (pixels[..., 0] > 120) & (pixels[..., 0] - pixels[..., 2] > 90)
        rows, columns = np.nonzero(orange)
        height, width = orange.shape
        assert orange.sum() > 2_000
        assert 4 < min(rows.min(), columns.min())
        assert rows.max() < height - 4
        assert columns.max() < width - 4


def _red(scene: WebElement) -> int:
    """How many pixels of a picture are plainly red."""
    picture = Image.open(BytesIO(scene.screenshot_as_png)).convert("RGB")
    pixels = np.asarray(picture, dtype=int)
    return int(((pixels[..., 0] > 110) & (pixels[..., 1:] < 60).all(axis=-1)).sum())


@pytest.mark.parametrize("graphics", ["webgl", "svg"])
def test_what_touches_is_red_while_it_does(
    shown: Shown, graphics: str, request: pytest.FixtureRequest
) -> None:
    """A held ball meets a table: both are listed with their time, and coloured then only."""
    if graphics == "svg":
        request.getfixturevalue("without_webgl")
    ball = SceneObject("ball", "sphere", Pose.of(z=60), (120, 120, 120), is_held=True)
    end = recorded()["path"]["tool"][-1]
    table = SceneObject("table", "box", Pose.of(*end), (300, 300, 40))
    record = recorded(scene=Scene((ball, table)))
    contact = next(one for one in record["observations"] if set(one["parts"]) == {"ball", "table"})
    browser = shown(record)
    row = browser.find_element(By.XPATH, "//div[@id='events']//tr[td='collision']")
    assert "ball touches table" in row.text
    _point_at(browser, contact["t"] - 50_000)
    before = _red(find(browser, "#scene"))
    _point_at(browser, contact["t"] + 1_000)
    assert _red(find(browser, "#scene")) > before + 100


def test_a_click_on_an_event_shows_its_moment_everywhere(shown: Shown) -> None:
    """Slider, clock, program and the values beside the charts are those of the event."""
    record = recorded()
    browser = shown(record)
    event = next(one for one in record["events"] if one["kind"] == "blend_apex")
    browser.execute_script(
        "[...document.querySelectorAll('#events tbody tr')]"
        ".find((row) => row.cells[1].textContent === 'blend apex').click()"
    )
    assert f"{event['t'] / 1e6:.3f} s" == find(browser, "#moment").text
    slider = browser.execute_script("return document.getElementById('slider').valueAsNumber")
    assert event["t"] == pytest.approx(slider, abs=1e3)
    assert find(browser, "#program .main .no").text in ("5", "6")
    speed = find(browser, "#charts .strip:nth-child(3) .value").text
    samples = dict(zip(record["path"]["t"], record["path"]["speed"], strict=True))
    nearest = min(samples, key=lambda time: abs(time - event["t"]))
    assert _numbers(speed)[0] == pytest.approx(samples[nearest], abs=0.02)


def test_keys_play_and_step(shown: Shown) -> None:
    """Arrows go by 0.1 s, with Shift to the next motion; Space plays to the end and stops there."""
    record = recorded()
    browser = shown(record)
    body = find(browser, "body")
    body.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_LEFT)
    assert "0.100 s" == find(browser, "#moment").text
    body.send_keys(Keys.SHIFT, Keys.ARROW_RIGHT)
    starts = [one["t"] for one in record["events"] if one["kind"] == "motion_start"]
    following = next(time for time in starts if time > 100_000)
    assert f"{following / 1e6:.3f} s" == find(browser, "#moment").text
    play = find(browser, "#play")
    browser.execute_script("document.getElementById('rate').value = '0.1'")
    body.send_keys(Keys.SPACE)
    assert "Pause" == play.get_attribute("aria-label")
    body.send_keys(Keys.SPACE)
    assert "Play" == play.get_attribute("aria-label")
    browser.execute_script("document.getElementById('rate').value = '20'")
    body.send_keys(Keys.SPACE)
    browser.execute_async_script(
        "const [play, done] = arguments;"
        "const look = () => (play.ariaLabel === 'Play' ? done() : requestAnimationFrame(look));"
        "look();",
        play,
    )
    assert f"{record['outcome']['time'] / 1e6:.3f} s" == find(browser, "#moment").text


def test_charts_of_one_axis_have_its_unit_and_its_limits(shown: Shown) -> None:
    """All axes are shown against their limits; the one that is chosen in degrees."""
    record = recorded()
    browser = shown(record)
    titles = [strip.text for strip in find_all(browser, "#charts .strip h3")]
    for wanted in ("Program lines", "Signals", "Speed of the tool", "Position", "Acceleration"):
        assert any(title.startswith(wanted) for title in titles)
    browser.find_element(By.CSS_SELECTOR, "#axis option[value='1']").click()
    (title,) = (
        strip.text
        for strip in find_all(browser, "#charts .strip h3")
        if strip.text.startswith("Position of A2 [°]")
    )
    low, high = record["limits"]["axes"][1]
    assert f"limits {low:g} and {high:g}" in title


def test_a_drag_on_a_chart_enlarges_all(shown: Shown) -> None:
    """What is left of the time axis is what was chosen; a double click shows all again."""
    browser = shown(recorded())
    plots = find_all(browser, "#charts .u-over")
    seen = "return [...document.querySelectorAll('#charts .cross')].map((one) => one.hidden)"
    _point_at(browser, 0)
    assert not any(browser.execute_script(seen))
    actions = webdriver.ActionChains(browser, duration=50)
    width = plots[0].size["width"]
    actions.move_to_element_with_offset(plots[0], 0, 0).click_and_hold()
    actions.move_by_offset(width // 4, 0).release().perform()
    _point_at(browser, 0)
    assert all(browser.execute_script(seen))
    browser.execute_script(
        "arguments[0].dispatchEvent(new MouseEvent('dblclick', {bubbles: true}))", plots[0]
    )
    _point_at(browser, 0)
    assert not any(browser.execute_script(seen))


def test_a_run_that_stops_at_once_says_so(shown: Shown) -> None:
    """No time passed: the arm stands, nothing is drawn over time, and nothing breaks."""
    record = recorded("DEF CELL()\nHALT\nEND\n")
    browser = shown({**record, "events": []})
    assert "The arm did not move." in find(browser, "figcaption").text
    assert find(browser, "#scene canvas").is_displayed()


def test_a_run_without_robot_says_how_to_see_the_arm(shown: Shown) -> None:
    """There is no empty picture, and the rest of the page works."""
    browser = shown(recorded(robot="none"))
    assert not find_all(browser, "#scene")
    assert "--robot kinematic" in find(browser, ".stage").text
    find(browser, "body").send_keys(Keys.ARROW_RIGHT)
    assert "0.100 s" == find(browser, "#moment").text


@pytest.mark.parametrize(
    "record", [{}, {"events": [{"kind": 7, "t": "x"}], "observations": [{"parts": HOSTILE}]}]
)
def test_next_to_nothing_gives_a_page(shown: Shown, record: Json) -> None:
    """An empty or damaged record has nothing to draw and breaks nothing."""
    browser = shown(record)
    assert find(browser, "#no-charts").is_displayed()
    assert "No source was recorded." == find(browser, "#program").text
