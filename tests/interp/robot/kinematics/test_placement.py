"""Base, tool and foot: where a programmed point puts the flange."""

import pytest

from interp.robot.kinematics.placement import IpoMode, Placement
from interp.values.poses import IDENTITY, Pose

POINT = Pose.of(100, 200, 300, 10, 20, 30)
FRAMES = Placement(
    base=Pose.of(1000, 0, 500, 90),
    tool=Pose.of(0, 0, 250, 0, 90, 0),
    robroot=Pose.of(0, 0, 700, 0, 0, 180),
)


def components(pose: Pose) -> object:
    return pytest.approx(pose.components, abs=1e-9)


def test_without_frames_the_flange_is_the_point() -> None:
    """Nothing given means that the point is told of the flange, in front of the foot."""
    assert POINT == Placement().flange(POINT)


def test_base_tool_and_foot() -> None:
    """The tool at the flange reaches the point in the base, told from the robot's foot [ARI-09]."""
    flange = FRAMES.flange(POINT)
    tip = FRAMES.robroot @ flange @ FRAMES.tool
    assert components(FRAMES.base @ POINT) == tip.components


def test_a_tool_lengthens_the_arm() -> None:
    """A tool of 250 mm leaves the flange 250 mm behind the point."""
    placement = Placement(tool=Pose.of(z=250))
    assert (
        components(Pose.of(500, 0, 250, 0, 180))
        == placement.flange(Pose.of(500, 0, 0, 0, 180)).components
    )


def test_there_and_back() -> None:
    """The point that the flange shows is the one it was sent to."""
    assert components(POINT) == FRAMES.point(FRAMES.flange(POINT)).components


@pytest.mark.parametrize("mode", IpoMode)
def test_what_is_interpolated(mode: IpoMode) -> None:
    """With a fixed tool the path is that of the base in the tool; the flange stays [ORI-07]."""
    placement = Placement(FRAMES.base, FRAMES.tool, FRAMES.robroot, mode)
    pose = placement.in_path(POINT)
    assert (pose == POINT) is (mode is IpoMode.BASE)
    if mode is IpoMode.TCP:
        assert components(IDENTITY) == (pose @ POINT).components
    assert FRAMES.flange(POINT) == placement.flange(POINT)
