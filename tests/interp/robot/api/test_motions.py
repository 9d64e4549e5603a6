"""Motions written in Python, and the example that shows the Robotics API."""

import runpy
import sys
from pathlib import Path

import pytest

from interp.robot.api.motions import MotionFactory
from interp.robot.arm import Place, Settings

EXAMPLE = Path(__file__).parents[4] / "examples" / "ignition.py"


def test_motions_are_numbered_and_keep_what_they_are_given() -> None:
    """A target has upper-case members; the settings are those in force when a motion is made."""
    motions = MotionFactory(Settings(velocity=0.5))
    place = Place(1, "PATH", -10.0)
    first = motions.ptp(a1=10, e1=200)
    motions.settings = Settings(velocity=1.0)
    second = motions.lin(x=1, s=2, criteria=["C_DIS"], places=[place])
    third = motions.circ({"x": 5.0}, y=7, angle=180.0)
    made = [command.motion for command in (first, second, third)]
    assert [(1, "PTP"), (2, "LIN"), (3, "CIRC")] == [(one.number, one.kind) for one in made]
    assert [{"A1": 10.0, "E1": 200.0}, {"X": 1.0, "S": 2.0}, {"Y": 7.0}] == [
        one.target for one in made
    ]
    assert [0.5, 1.0, 1.0] == [one.settings.velocity for one in made]
    assert (("C_DIS",), (place,)) == (made[1].criteria, made[1].places)
    assert ({"X": 5.0}, 180.0) == (made[2].auxiliary, made[2].angle)


def test_a_member_that_no_target_has() -> None:
    """What is no member of a target is refused by its name."""
    with pytest.raises(ValueError, match="a target has no A7, Q"):
        MotionFactory().ptp(q=1, a7=2)


@pytest.mark.parametrize("robot", ["none", "kinematic", "mujoco"])
def test_the_example(
    robot: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The gas comes on at the microsecond at which the ignition ends, on every robot."""
    needed = ["ruckig", "scipy"] + ["mujoco"] * (robot == "mujoco")
    for module in needed:
        pytest.importorskip(module)
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE), robot])
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    out = capsys.readouterr().out
    lines = [line.split(" ms  ", 1) for line in out.splitlines()]
    times = {what.strip(): float(time) for time, what in lines}
    assert times["motion 2 (LIN) ended"] == times["$OUT[1] = TRUE"]
    assert times["motion 4 (LIN) ended"] == times["$OUT[1] = FALSE"]
    assert times["$OUT[2] = TRUE"] < times["motion 3 (LIN) blend_start"]
    assert times["motion 3 (LIN) apex"] == times["motion 4 (LIN) started"]
    assert ("the torch is at X 0.00" in out) is (robot != "none")
