"""Expectations about paths are evaluated by geometry that stands in the case."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conformance.evaluation.evaluator import evaluate_run
from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_expectations import evaluate_on_path
from conformance.evaluation.path_geometry import circle_of, drawn, from_arc, from_circle, from_line
from conformance.evaluation.trace_expectations import Marks
from conformance.suite.expectations import read_expectation
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.robot.simulation.tracking import PathRecord
from interp.values.poses import Pose

NO_MARKS = Marks({}, frozenset())
CYCLE = 12_000


def event(kind: str, time: int, motion: int, line: int = 3) -> Event:
    return Event(time, "robot", kind, "a.src", line, {"motion": motion})


def seen(points: Any, *events: Event, axes: Any = None, measured: Any = None) -> Observation:
    """A path with a point in each cycle; its motion lasts from the first to the last of them."""
    rows = np.zeros((len(points), 6))
    rows[:, :3] = points
    times = np.arange(len(points), dtype=np.int64) * CYCLE
    moved = np.zeros((len(points), 6)) if axes is None else np.asarray(axes, dtype=np.float64)
    far = None if measured is None else rows + np.array([*measured, 0, 0, 0])
    record = PathRecord(times, moved, rows, rows[:, :3], moved, far, None if far is None else far)
    whole = [event("motion_start", 0, 1), event("motion_end", int(times[-1]), 1)]
    robot, machine = "mujoco", default_machine()
    return Observation(events=(*whole, *events), path=record, robot=robot, machine=machine)


def state(text: str, observed: Observation) -> str:
    is_met, _ = evaluate_on_path(read_expectation(text, "a.src", 3), observed, NO_MARKS)
    return "open" if is_met is None else "met" if is_met else "unmet"


LINE = [(float(x), 0.0, 0.0) for x in np.linspace(0, 100, 51)]


def test_distances_are_those_of_geometry() -> None:
    """From a segment, beyond its ends, from a circle and above its plane."""
    a, b = np.zeros(3), np.array([10.0, 0, 0])
    points = np.array([[5.0, 3, 4], [-3.0, 0, 4], [10.0, 0, 0]])
    assert [5.0, 5.0, 0.0] == pytest.approx(from_line(points, a, b))
    ring = (np.array([5.0, 0, 0]), np.array([0.0, 5, 0]), np.array([-5.0, 0, 0]))
    assert [3.0, 4.0, 0.0] == pytest.approx(
        from_circle(np.array([[2.0, 0, 0], [0, 5, 4], [0, -5, 0]]), *ring)
    )
    middle = np.array([[2.5, 2.5, 0]])
    corner = (np.array([0.0, 0, 0]), np.array([5.0, 0, 0]), np.array([5.0, 5, 0]))
    assert [np.hypot(1.25, 1.25)] == pytest.approx(from_arc(middle, *corner), abs=1e-3)


def test_points_on_a_line_make_no_circle() -> None:
    """Nothing is divided by zero."""
    with pytest.raises(ValueError, match="line"):
        circle_of(np.zeros(3), np.array([1.0, 0, 0]), np.array([2.0, 0, 0]))


def test_what_is_drawn_lies_on_the_shape() -> None:
    """The page is shown the very shapes that paths are compared with, from end to end."""
    ring = np.array([[5.0, 0, 0], [0.0, 5, 0], [0.0, -5, 0]])
    points = drawn("circle", ring)
    assert from_circle(points, *ring).max() < 1e-9
    assert from_line(np.array([[0.0, 5, 0]]), points[10], points[11])[0] < 0.1  # by the second
    assert np.allclose(points[[0, -1]], ring[[0, 2]])
    assert np.allclose(drawn("blend", ring)[[0, -1]], ring[[0, 2]])


def test_line_is_compared_with_a_line() -> None:
    """A tenth of a millimetre aside is too much, unless the case allows it."""
    aside = [(x, 0.1 if 40 < x < 60 else 0.0, 0.0) for x, _, _ in LINE]
    assert "met" == state("path line 0 0 0 to 100 0 0", seen(LINE))
    assert "unmet" == state("path line 0 0 0 to 100 0 0", seen(aside))
    assert "met" == state("path line 0 0 0 to 100 0 0 within 0.11", seen(aside))
    assert "unmet" == state("path line 0 0 0 to 90 0 0", seen(LINE))


def test_only_the_part_between_the_blends_is_compared() -> None:
    """What lies in a blend belongs to nobody's line."""
    bent = [(x, 0.0 if 20 < x < 80 else 5.0, 0.0) for x, _, _ in LINE]
    blends = (event("blend_end", 12 * CYCLE, 1), event("blend_start", 38 * CYCLE, 1))
    assert "unmet" == state("path line 0 0 0 to 100 0 0", seen(bent))
    assert "met" == state("path line 0 0 0 to 100 0 0", seen(bent, *blends))


def test_blend_is_compared_with_a_parabola() -> None:
    """Between its start and its end, which belong to two motions."""
    corner = [np.array(p, dtype=float) for p in ((90, 0, 0), (100, 0, 0), (100, 10, 0))]
    share = np.linspace(0, 1, 21)[:, None]
    arc = (1 - share) ** 2 * corner[0] + 2 * share * (1 - share) * corner[1] + share**2 * corner[2]
    way = [*LINE[:45], *arc.tolist()]
    blend = event("blend_start", 45 * CYCLE, 1), event("blend_end", 65 * CYCLE, 2, 4)
    text = "path blend 90 0 0 by 100 0 0 to 100 10 0"
    assert "met" == state(text, seen(way, *blend))
    assert "unmet" == state(text.replace("90 0 0", "80 0 0"), seen(way, *blend))
    assert "unmet" == state(text, seen(way))
    assert "met" == state("misses 100 0 0 by 3.5355", seen(way, *blend))
    assert "unmet" == state("misses 100 0 0 by 5", seen(way, *blend))
    assert "met" == state("leaves 100 0 0 by 10", seen(way, *blend))
    assert "met" == state("joins 100 0 0 by 10", seen(way, *blend))
    assert "unmet" == state("leaves 100 0 0 by 9", seen(way, *blend))


def test_point_between_samples_is_passed() -> None:
    """The path is known between its samples too."""
    assert "met" == state("passes 51 0 0", seen(LINE))
    assert "unmet" == state("passes 51 0.2 0", seen(LINE))


def test_pose_is_at_the_end_or_at_a_moment() -> None:
    """Angles are compared on the circle."""
    out = Event(600_000, "robot", "out", "a.src", 9, {"number": 1, "value": True})
    assert "met" == state("pose 100 0 0", seen(LINE))
    assert "met" == state("pose 100 0 0 360 0 -360", seen(LINE))
    assert "unmet" == state("pose 100 0 0 1 0 0", seen(LINE))
    assert "met" == state("pose 50 0 0 at 0.3", seen(LINE))
    assert "met" == state("pose 100 0 0 at out 1", seen(LINE, out))
    assert "unmet" == state("pose 100 0 0 at out 2", seen(LINE, out))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("pose 50 0 0 at out 1", 3),
        ("out 1 TRUE near 50 0 0 by 0.1", 9),
        ("out 1 TRUE before 0.3", 9),
        ("end after out 1 + 0.3", 3),
        ("out 1 TRUE between 0.2 and 0.3", 9),
    ],
)
def test_a_recorded_time_may_be_a_cycle_off(text: str, line: int) -> None:
    """A real controller is observed once a cycle; more than a cycle is too much."""
    late = Event(300_000 + CYCLE // 2, "robot", "out", "a.src", 9, {"number": 1, "value": True})
    asked, whole = read_expectation(text, "a.src", line), seen(LINE, late)
    for is_exact, cycle, met in ((True, CYCLE, False), (False, CYCLE, True), (False, 5_000, False)):
        found = replace(whole, is_exact=is_exact, cycle=cycle)
        assert met == (evaluate_run([asked], found)[0].state == "met")


def test_pose_beside_another_base_is_in_the_base_of_its_motion() -> None:
    """The next motion begins between two samples, in a base that stands aside and is turned."""
    whole = seen(LINE)
    assert whole.path is not None
    later = np.arange(51) > 25
    points = np.where(
        later[:, None], [[0, 50 - x, 0, -90, 0, 0] for x, _, _ in LINE], whole.path.points
    )
    base = Pose.of(50, 0, 0, 90)
    frames = (0, Placement()), (306_000, Placement(base, tool=Pose.of(0, 0, 7)))
    points[later] += [0, 0, 7, 0, 0, 0]
    events = (event("motion_start", 0, 1), event("motion_end", 306_000, 1))
    both = replace(whole, events=events, path=replace(whole.path, points=points, placements=frames))
    assert "met" == state("pose 51 0 0 0 0 0", both)
    assert "met" == state("pose 50 0 0 0 0 0 at 0.3", both)
    assert "met" == state("pose 0 -2 7 -90 0 0 at 0.312", both)
    assert "met" == state("pose 0 -1.5 7 -90 0 0 at 0.309", both)


def test_speed_is_that_of_the_tool() -> None:
    """Two millimetres in 12 ms are 0.1667 m/s."""
    assert "met" == state("speed reaches 0.1667", seen(LINE))
    assert "unmet" == state("speed reaches 0.2", seen(LINE))
    assert "met" == state("speed most 0.17", seen(LINE))
    assert "unmet" == state("speed most 0.16", seen(LINE))


def test_axes_keep_their_limits() -> None:
    """Ten degrees in a cycle are faster than any axis, and a jump of its speed is not smooth."""
    slow = np.zeros((51, 6))
    slow[:, 0] = np.linspace(0, 30, 51)
    jump = slow.copy()
    jump[30:, 0] += 10
    jerky = slow.copy()
    jerky[30:, 0] += np.linspace(0, 40, 21)
    assert "met" == state("limits", seen(LINE, axes=slow))
    assert "unmet" == state("limits", seen(LINE, axes=jump))
    assert "met" == state("smooth", seen(LINE, axes=slow))
    assert "unmet" == state("smooth", seen(LINE, axes=jerky))
    assert "met" == state("limits", seen(LINE, axes=jerky))


def test_axes_come_the_same_share_of_their_way() -> None:
    """One that lags behind the others is no PTP."""
    together = np.zeros((51, 6))
    together[:, 0] = np.linspace(0, 30, 51) ** 2
    together[:, 4] = together[:, 0] / 3
    lagging = together.copy()
    lagging[20:30, 4] -= 0.1
    assert "met" == state("path joint", seen(LINE, axes=together))
    assert "unmet" == state("path joint", seen(LINE, axes=lagging))


def test_measured_path_is_near_the_set_points() -> None:
    """Half a millimetre is the usual tolerance."""
    assert "met" == state("tracks", seen(LINE, measured=(0, 0.4, 0)))
    assert "unmet" == state("tracks", seen(LINE, measured=(0, 0.6, 0)))
    assert "unmet" == state("tracks within 0.3", seen(LINE, measured=(0, 0.4, 0)))
    assert "open" == state("tracks", seen(LINE))


def test_motion_that_never_was_meets_nothing() -> None:
    """A line without a motion has no path."""
    lost = Observation(path=seen(LINE).path, robot="kinematic")
    assert "unmet" == state("passes 0 0 0", lost)
