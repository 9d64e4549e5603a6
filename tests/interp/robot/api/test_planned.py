"""The control core on the arm that really plans: what is undone, cancelled, and batched."""

import math
from typing import Any

import numpy as np
import pytest

from interp.robot.api.batch import BatchCore
from interp.robot.api.commands import (
    CommandState,
    CoreEvent,
    MotionCommand,
    OutputCommand,
    Transaction,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.api.motions import MotionFactory
from interp.robot.arm import Approximation, Place, Settings
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.values.faults import Fault
from interp.values.poses import Pose

pytest.importorskip("ruckig")
pytest.importorskip("scipy")

from interp.robot.planning.planned_arm import PlannedArm

HOME = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
CELL = Placement(base=Pose.of(x=450.0, y=-100.0, z=300.0), tool=Pose.of(z=100.0))


@pytest.fixture
def motions() -> MotionFactory:
    return MotionFactory(
        Settings(placement=CELL, velocity=0.25, approximation=Approximation(cdis=20.0))
    )


def made(kind: type[ControlCore] = ControlCore) -> tuple[ControlCore, list[tuple[int, Any]]]:
    switched: list[tuple[int, Any]] = []
    arm = PlannedArm(default_machine(), HOME)
    return kind(arm, lambda path, _, time: switched.append((time, path)), 12_000), switched


def first(motions: MotionFactory) -> MotionCommand:
    return motions.ptp(x=0, y=0, z=0, a=0, b=0, c=180, s=2, t=2)


def times(events: list[CoreEvent], what: str) -> list[int]:
    return [event.time for event in events if event.what == what]


def test_a_transaction_that_fails_leaves_the_path_as_it_was(motions: MotionFactory) -> None:
    """A good motion before a bad one would blend; after the fault the arm stops as before."""
    paths = []
    for is_disturbed in (False, True):
        motions.count = 0
        core, _ = made()
        core.load(0, Transaction(first(motions), motions.lin(x=100, criteria=["C_DIS"])))
        core.run_until(12_000)
        if is_disturbed:
            good, beyond = motions.lin(y=100, criteria=["C_DIS"]), motions.lin(x=5_000.0)
            with pytest.raises(Fault):
                core.load(12_000, Transaction(good, beyond))
            assert [CommandState.CREATED] * 2 == [good.state, beyond.state]
        ends = times(core.run_out(), "ended")
        paths.append((ends, core.arm.sample(np.arange(0, ends[-1], 4_000)).axes))
    assert paths[0][0] == paths[1][0]
    np.testing.assert_array_equal(paths[0][1], paths[1][1])


def test_cancelling_on_the_way(motions: MotionFactory) -> None:
    """The arm brakes on its line and stands; the next motion starts from there."""
    core, switched = made()
    place = Place(1, "PATH", 0.0)
    start, line = first(motions), motions.lin(x=200, places=[place])
    beyond, never = motions.lin(y=100), OutputCommand(("$OUT", 1), True)
    core.load(
        0,
        Transaction(start, line, beyond, never).link(line.reached(place), "start", never),
    )
    begun = next(time for time in iter(lambda: _next(core, line), None) if time)
    core.apply(begun + 400_000, "cancel", line)
    events = core.run_out()
    assert [CommandState.CANCELLED] * 3 == [line.state, beyond.state, never.state]
    assert [] == switched
    stands = times(events, "stopped")[0]
    assert begun + 400_000 < stands < begun + 700_000
    x, y, *_ = CELL.point(core.arm.position(stands).flange).components
    assert 80.0 < x < 140.0
    assert 0.0 == pytest.approx(y, abs=1e-6)
    back = motions.lin(x=0)
    core.load(core.now, Transaction(back))
    core.run_out()
    x, *_ = CELL.point(core.arm.position(core.now).flange).components
    assert 0.0 == pytest.approx(x, abs=1e-6)
    assert CommandState.ENDED is back.state


def _next(core: ControlCore, motion: MotionCommand) -> int:
    """Go on to the next event; the time, where it is the start of a motion."""
    time = core.next_time()
    assert time is not None
    events = core.run_until(time)
    return time if any(e.command is motion and e.what == "started" for e in events) else 0


def test_batches_blend_as_look_ahead_does(motions: MotionFactory) -> None:
    """The path of a batch is that of the look-ahead, later by what the first motion waits."""
    starts, paths = [], []
    for kind in (ControlCore, BatchCore):
        motions.count = 0
        core, _ = made(kind)
        work = [
            first(motions),
            motions.lin(x=100, criteria=["C_DIS"]),
            motions.lin(y=100, criteria=["C_DIS"]),
            motions.lin(x=0),
        ]
        for number, motion in enumerate(work):
            core.load(360_000 * number, Transaction(motion))
        events = core.run_out()
        begun = next(e.time for e in events if e.command is work[1] and e.what == "started")
        starts.append(begun)
        ends = times(events, "ended")[-1]
        paths.append(core.arm.sample(np.arange(begun, ends - 4_000, 4_000)).axes)
        assert 2 == len(times(events, "apex"))
    assert 360_000 < starts[1] - starts[0] < 720_000
    rows = min(map(len, paths))
    np.testing.assert_allclose(paths[0][:rows], paths[1][:rows], atol=1e-3)


@pytest.mark.parametrize("what", ["x", "a1", "e1", "auxiliary", "angle", "place", "speed"])
def test_what_is_no_number(motions: MotionFactory, what: str) -> None:
    """NaN anywhere in a motion is refused with 1422 or 1506, and the arm ends what it has begun."""
    core, switched = made()
    core.load(0, Transaction(first(motions)))
    core.run_until(120_000)
    place = Place(1, "PATH", math.nan)
    if what == "speed":
        motions.settings = Settings(placement=CELL, velocity=math.nan)
    match what:
        case "auxiliary":
            bad = motions.circ({"x": math.nan}, y=100)
        case "angle":
            bad = motions.circ({"x": 50.0, "y": 50.0}, y=100, angle=math.nan)
        case "place":
            bad = motions.lin(y=100, places=[place])
        case "a1":
            bad = motions.ptp(a1=math.nan)
        case "speed":
            bad = motions.lin(y=100)
        case _:
            coordinate: dict[str, Any] = {what: math.nan}
            bad = motions.lin(**coordinate)
    transaction = Transaction(bad)
    if what == "place":
        gas = OutputCommand(("$OUT", 1), True)
        transaction.add(gas).link(bad.reached(place), "start", gas)
    with pytest.raises(Fault) as caught:
        core.load(core.now, transaction)
    assert (1506 if what == "angle" else 1422) == caught.value.number
    assert ("created", []) == (bad.state.value, switched)
    core.run_out()
    x, y, z, *_ = CELL.point(core.arm.position(core.now).flange).components
    assert [0.0] * 3 == pytest.approx([x, y, z], abs=1e-6)
    assert 0 == core.pending()
