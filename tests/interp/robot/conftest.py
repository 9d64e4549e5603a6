"""An arm of round numbers, in the words of a `$machine.dat`."""

from collections.abc import Callable

import pytest

from interp.robot.kinematics import Arm
from interp.robot.machine import read_machine

LIMITS = ((-170, 170), (-190, 45), (-120, 156), (-350, 350), (-125, 125), (-350, 350))
DIRECTIONS = (-1, 1, 1, -1, -1, -1)


@pytest.fixture
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


@pytest.fixture
def make_arm(machine_text: Callable[..., str]) -> Callable[..., Arm]:
    """An arm of the machine data with lines of one's own."""
    return lambda *lines: Arm(read_machine(machine_text(*lines)))


@pytest.fixture
def arm(make_arm: Callable[..., Arm]) -> Arm:
    """An arm of the size of a KR 6 R900, whose dimensions are published."""
    return make_arm()
