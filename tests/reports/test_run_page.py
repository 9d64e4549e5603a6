"""The page of a run as a file: what it holds, and how much of it."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from reports.programs.run_page import write_run_page

Json = dict[str, Any]


def data_of(record: Json, folder: Path) -> Json:
    """What the scripts of a run's page read."""
    page = write_run_page(record, folder / "run.html").read_text(encoding="utf-8")
    found = re.search(r'id="page-data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data: Json = json.loads(found[1])
    return data


def _moving(count: int, speeds: list[float] | None = None) -> Json:
    """A run whose first axis turns all the time."""
    return {
        "path": {
            "t": [12_000 * n for n in range(count)],
            "axes": [[0.1 * n for n in range(count)], [0.0] * count],
            "tool": [[n, 0.0, 500.0] for n in range(count)],
            "speed": [0.5] * count,
            "axis_speeds": [speeds or [8.0] * count, [0.0] * count],
        }
    }


def test_a_minute_of_motion_keeps_every_set_point(tmp_path: Path) -> None:
    """5,000 set-points are few enough for a page."""
    assert 5_000 == len(data_of(_moving(5_000), tmp_path)["path"]["t"])


def test_a_long_motion_is_thinned_out_and_keeps_its_peaks(tmp_path: Path) -> None:
    """The greatest speed of what a sample stands for stays, with its sign."""
    speeds = [8.0] * 60_000
    speeds[23_457] = -99.0
    path = data_of(_moving(60_000, speeds), tmp_path)["path"]
    assert len(path["t"]) <= 6_001
    assert -99.0 == min(path["speeds"][0])
    assert all(len(path["t"]) == len(column) for column in (*path["axes"], *path["speeds"]))


def test_where_nothing_moves_two_samples_are_enough(tmp_path: Path) -> None:
    """An hour of waiting between two motions leaves its first and its last row."""
    record = _moving(100)
    for column in (*record["path"]["axes"], record["path"]["tool"]):
        column[20:80] = [column[20]] * 60
    times = data_of(record, tmp_path)["path"]["t"]
    assert [12_000 * n for n in (*range(21), *range(79, 100))] == times


def test_a_program_that_stops_all_the_time_stays_within_the_bound(tmp_path: Path) -> None:
    """Rests are kept whole only while there is room for them."""
    record = _moving(60_000)
    path = record["path"]
    for column in (*path["axes"], path["tool"]):
        for row in range(0, len(column), 4):
            column[row : row + 3] = [column[row]] * 3
    assert len(data_of(record, tmp_path)["path"]["t"]) <= 12_001


def test_steps_of_the_advance_run_leave_room_for_what_happened(tmp_path: Path) -> None:
    """A loop of a million lines does not push out the motion behind it."""
    steps = [{"t": n, "kind": "branch", "at": "a.src:2"} for n in range(50_000)]
    record = {"events": [*steps, {"t": 50_000, "kind": "motion_start", "motion": 1}]}
    events = data_of(record, tmp_path)["events"]
    assert "motion_start" == events[-1]["kind"]
    assert 5_000 < len(events) <= 10_000


@pytest.mark.parametrize(
    "record",
    [
        {},
        {"path": {"t": [0, 12_000]}},
        {"path": {"t": "x", "axes": 7, "tool": [1, None]}, "arm": [], "limits": 3},
        {
            "path": {
                "t": [0, 1, 2],
                "axes": [[1.0]],
                "tool": [[1.0]],
                "axis_speeds": [None, [1e999]],
            }
        },
        {"arm": {"links": [{"parent": 7, "frame": [1], "shapes": [{"radius": "x"}]}], "hand": 99}},
    ],
    ids=["empty", "times only", "not what it should be", "cut off", "an arm in pieces"],
)
def test_a_damaged_record_gives_a_page(record: Json, tmp_path: Path) -> None:
    """What is missing or wrong counts as nothing; columns are as long as the times."""
    data = data_of(record, tmp_path)
    path = data["path"]
    assert all(len(column) == len(path["t"]) for column in (*path["axes"], *path["speeds"]))
    assert all(link["parent"] < place for place, link in enumerate(data["arm"]["links"]))


def test_without_set_points_the_page_has_no_3d_library(tmp_path: Path) -> None:
    """A run on no robot loads in no time."""
    page = write_run_page({"main": "a.src"}, tmp_path / "run.html").read_text(encoding="utf-8")
    assert "three.js authors" not in page
    assert len(page) < 150_000
