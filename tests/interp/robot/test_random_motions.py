"""Whatever is moved, blended, braked and overridden: no limit is exceeded, and time goes on."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from interp.robot.arm import Approximation, Place, SplinePart
from interp.values.faults import Fault
from tests.interp.robot.conftest import Driver

if TYPE_CHECKING:
    from interp.robot.kinematics.machine_data import MachineData

DOCUMENTED = {1102, 1211, 1366, 1447, 1456, 1457, 1458, 1506, 2829}
"""Messages of motions that a random program may well ask for."""

POINTS = st.fixed_dictionaries(
    {
        "X": st.floats(350, 650),
        "Y": st.floats(-350, 350),
        "Z": st.floats(400, 900),
        "A": st.floats(-40, 40),
        "B": st.floats(100, 190),
        "C": st.floats(-40, 40),
    },
    optional={"E1": st.floats(-400, 1000)},
)
AXES = st.fixed_dictionaries(
    {},
    optional={"A1": st.floats(-160, 160), "A4": st.floats(-340, 340), "A5": st.floats(-120, 120)},
)
CRITERIA = [
    (),
    ("C_DIS",),
    ("C_PTP",),
    ("C_VEL",),
    ("C_ORI",),
    ("C_DIS", "C_DIS"),
    ("C_PTP", "C_DIS"),
]
PERCENTS = st.sampled_from(
    [(100.0,) * 12, (20.0,) * 12, (100.0, 10.0, 50.0, 100.0, 30.0, 5.0, 60.0)]
)

MOTIONS = st.fixed_dictionaries(
    {
        "kind": st.sampled_from(["PTP", "LIN", "LIN", "CIRC", "SLIN", "SPTP", "SPLINE"]),
        "target": POINTS,
        "auxiliary": POINTS,
        "third": POINTS,
        "angle": st.sampled_from([None, None, 90.0, -200.0]),
        "criteria": st.sampled_from(CRITERIA),
        "velocity": st.sampled_from([0.2, 0.5, 2.0]),
        "acceleration": st.sampled_from([1.0, 2.3, 9.0]),
        "axis_velocity": PERCENTS,
        "axis_acceleration": PERCENTS,
        "orientation": st.sampled_from(["#VAR", "#CONSTANT", "#JOINT"]),
        "circle": st.sampled_from(["#BASE", "#PATH"]),
        "is_reduced": st.sampled_from([False, False, False, True]),
        "cdis": st.sampled_from([2.0, 30.0, 300.0]),
        "cptp": st.sampled_from([5.0, 50.0, 100.0]),
    }
)
STEPS = st.one_of(
    MOTIONS,
    MOTIONS,
    MOTIONS,
    st.builds(lambda share: ("wait", share), st.floats(0.0, 1.0)),
    st.builds(lambda percent: ("override", percent), st.sampled_from([30.0, 60.0, 100.0])),
    st.builds(lambda is_hard: ("brake", is_hard), st.booleans()),
    st.builds(lambda axes: ("axes", axes), AXES),
)


def do(driver: Driver, step: Any) -> None:
    """One step of a random program."""
    match step:
        case ("wait", share):
            event = driver.arm.next_event()
            if event is not None:
                driver.play(until=driver.now + int((event.time - driver.now) * share))
        case ("override", percent):
            driver.arm.override(driver.now, percent)
        case ("brake", is_hard):
            driver.arm.brake(driver.now, is_hard)
            while driver.arm.take().kind != "stopped":
                pass
            driver.now = driver.arm._now
            driver.arm.proceed(driver.now)
        case ("axes", axes):
            driver.move("PTP", axes)
        case _:
            move(driver, dict(step))


def move(driver: Driver, step: dict[str, Any]) -> None:
    """A motion; or none, where it is refused with a message that is documented."""
    near = Approximation(cdis=step.pop("cdis"), cptp=step.pop("cptp"), cori=20.0, cvel=60.0)
    third = step.pop("third")
    if step["kind"] not in {"CIRC", "SPLINE"}:
        step["angle"] = step["auxiliary"] = None
    if step["kind"] == "SPLINE":
        points = (step.pop("target"), step.pop("auxiliary"), third)
        step["parts"] = tuple(
            SplinePart(kind, point)
            for kind, point in zip(("SPL", "SLIN", "SPL"), points, strict=True)
        )
        step["angle"] = None
    step["places"] = (
        Place(1, "DISTANCE", 1.0, delay=-20_000),
        Place(2, "DISTANCE", 0.0, delay=5_000),
    )
    number = None
    try:
        driver.move(step.pop("kind"), approximation=near, speed_type="#VAR_ALL", **step)
    except Fault as error:
        number = error.number
    assert number is None or number in DOCUMENTED


@settings(
    phases=[Phase.explicit, Phase.generate],
)
@given(steps=st.lists(STEPS, min_size=2, max_size=9))
def test_limits_are_never_exceeded(machine: MachineData, driver: Driver, steps: list[Any]) -> None:
    """At every millisecond of any program each axis keeps its speed and acceleration."""
    driver.__init__(machine)  # type: ignore[misc]
    for step in steps:
        do(driver, step)
    driver.arm.override(driver.now, 100.0)
    driver.play()
    assert 0 == driver.arm.pending()
    begins = [(leg.begins, leg.ends) for leg in driver.arm.path()]
    for (begin, end), (following, _) in pairwise(begins):
        assert begin <= end <= following + 1e-12
    for leg in driver.arm.path():
        assert leg.profile.lowest >= -1e-6
    driver.check_limits()


@settings(
    phases=[Phase.explicit, Phase.generate],
)
@given(steps=st.lists(STEPS, min_size=2, max_size=9))
def test_forgetting_the_past_changes_nothing(machine: MachineData, steps: list[Any]) -> None:
    """Events and places are the same whether what was travelled is kept or forgotten."""
    keeps, forgets = Driver(machine), Driver(machine)
    for step in steps:
        for driver in (keeps, forgets):
            do(driver, step)
        forgets.arm.forget(forgets.now)
        assert keeps.arm.position(keeps.now) == forgets.arm.position(forgets.now)
    for driver in (keeps, forgets):
        driver.arm.override(driver.now, 100.0)
    assert keeps.play() == forgets.play()
    kept, rest = (
        [(leg.section.key, leg.begins, leg.ends) for leg in driver.arm.path()]
        for driver in (keeps, forgets)
    )
    assert kept[len(kept) - len(rest) :] == rest


def test_a_long_path_is_forgotten(driver: Driver) -> None:
    """Of a path with a thousand motions only the end is kept."""
    for number in range(1000):
        driver.move("LIN", {"X": 500.0 + number % 2, "Y": 0.0, "Z": 700.0})
        driver.play()
        driver.arm.forget(driver.now)
    assert {leg.section.number for leg in driver.arm.path()} <= {999, 1000}
