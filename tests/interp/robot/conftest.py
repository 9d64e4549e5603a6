"""An arm of round numbers, in the words of a `$machine.dat`."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from interp.port.requests import At
from interp.robot.arm import ArmEvent, Motion, Samples, Settings
from interp.robot.kinematics.kinematics import Kinematics
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.planning.planned_arm import PlannedArm

LIMITS = ((-170, 170), (-190, 45), (-120, 156), (-350, 350), (-125, 125), (-350, 350))
DIRECTIONS = (-1, 1, 1, -1, -1, -1)


@pytest.fixture(scope="session")
def machine_text() -> Callable[..., str]:
    """The text of machine data, with lines of one's own behind the others."""

    def write(*lines: str) -> str:
        own = [
            'CHAR $TRAFONAME[32]\n$TRAFONAME[]="#TRY6R900 C4 FLR"',
            *(f"$AXIS_DIR[{i}]={value}" for i, value in enumerate(DIRECTIONS, start=1)),
            *(f"$SOFTN_END[{i}]={float(low)}" for i, (low, _) in enumerate(LIMITS, start=1)),
            *(f"$SOFTP_END[{i}]={float(high)}" for i, (_, high) in enumerate(LIMITS, start=1)),
            "FRAME $TIRORO={X 0.0,Y 0.0,Z 400.0,A 0.0,B 0.0,C 0.0}",
            "FRAME $TFLWP={X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}",
            "FRAME $TX3P3={X 420.0,Y 0.0,Z 35.0,A 0.0,B 90.0,C 0.0}",
            "REAL $LENGTH_A=25.0",
            "REAL $LENGTH_B=455.0",
            "DECL DHART $DH_4={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA 90.0}",
            "DECL DHART $DH_5={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA -90.0}",
        ]
        return "\n".join(["DEFDAT $MACHINE PUBLIC", *own, *lines, "ENDDAT", ""])

    return write


@pytest.fixture(scope="session")
def make_arm(machine_text: Callable[..., str]) -> Callable[..., Kinematics]:
    """An arm of the machine data with lines of one's own."""
    return lambda *lines: kinematics_of(read_machine(machine_text(*lines)))


@pytest.fixture(scope="session")
def arm(make_arm: Callable[..., Kinematics]) -> Kinematics:
    """An arm of the size of a KR 6 R900, whose dimensions are published."""
    return make_arm()


SPEEDS = (360.0, 300.0, 360.0, 381.0, 388.0, 615.0)
"""Degrees a second, of the size that the makers of such arms publish."""


@pytest.fixture
def machine(machine_text: Callable[..., str]) -> MachineData:
    """The same arm with speeds, and with a linear axis that it stands on."""
    lines = [
        *(f"$VEL_AXIS_MA[{i}]={speed * 100 / 6}" for i, speed in enumerate(SPEEDS, start=1)),
        *(f"$RAT_MOT_AX[{i}]={{N 100,D 1}}" for i in range(1, 7)),
        *(f"$RAISE_TIME[{i}]=300.0" for i in range(1, 8)),
        "REAL $DEF_FLT_PTP=60.0",
        "INT $EX_AX_NUM=1",
        "$AXIS_TYPE[7]=1",
        "$VEL_AXIS_MA[7]=3000.0",
        "$RAT_MOT_AX[7]={N 20,D 1}",
        "$SOFTN_END[7]=-500.0",
        "$SOFTP_END[7]=2000.0",
    ]
    return read_machine(machine_text(*lines))


START = {"A1": 0.0, "A2": -90.0, "A3": 100.0, "A4": 0.0, "A5": 60.0, "A6": 0.0}
"""Axes from where all of the space in front of the arm can be reached, the tool pointing down."""


class Driver:
    """Plans motions on an arm that stands at `START`, and plays them to their end."""

    def __init__(self, machine: MachineData) -> None:
        self.machine = machine
        self.arm = PlannedArm(machine, tuple(START.values()))
        self.now = 0
        self.events: list[ArmEvent] = []
        self._number = 0
        every = machine.every_axis
        self.fastest = np.array([axis.dynamics.velocity for axis in every if axis.dynamics])
        self.steepest = np.array([axis.dynamics.acceleration for axis in every if axis.dynamics])

    def move(self, kind: str, target: Any = None, **others: Any) -> tuple[int, ...]:
        """Plan a motion now; settings may be given by their names."""
        names = {field.name for field in fields(Settings)}
        settings = Settings(**{name: others.pop(name) for name in names & others.keys()})
        self._number += 1
        at = At("test.src", self._number, 0)
        motion = Motion(self._number, at, kind, settings, target or {}, **others)
        return self.arm.plan(self.now, motion)

    def play(self, until: int | None = None) -> list[ArmEvent]:
        """Take the events up to a time, or all of them; then it is that time."""
        while (event := self.arm.next_event()) is not None:
            if until is not None and event.time > until:
                break
            self.events.append(self.arm.take())
            assert event.time >= self.now
            self.now = event.time
        if until is not None:
            self.now = max(self.now, until)
        return self.events

    def time(self, kind: str, motion: int, key: int | None = None) -> int:
        """When an event came; it has to have come once."""
        (found,) = (
            event.time
            for event in self.events
            if (event.kind, event.motion, event.key) == (kind, motion, key)
        )
        return found

    def samples(self, step: int = 1000) -> Samples:
        """Set-points from the beginning to now and a little on."""
        return self.arm.sample(np.arange(0, self.now + 20 * step, step))

    def tool(self, time: int) -> npt.NDArray[np.float64]:
        """Where the flange is, in mm."""
        return np.array(self.arm.position(time).flange.position)

    def check_limits(self) -> None:
        """No axis is faster, or changes its speed faster, than the machine data allow."""
        axes = self.samples().axes
        assert np.isfinite(axes).all()
        assert (np.abs(speeds(axes)) <= self.fastest * (1 + 1e-9)).all()
        assert (np.abs(np.diff(speeds(axes), axis=0) * 1000.0) <= self.steepest * (1 + 1e-6)).all()


def speeds(axes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The mean speeds between set-points a millisecond apart, (n - 1, axes)."""
    moved: npt.NDArray[np.float64] = np.diff(axes, axis=0) * 1000.0
    return moved


@pytest.fixture
def driver(machine: MachineData) -> Driver:
    """An arm to drive."""
    return Driver(machine)
