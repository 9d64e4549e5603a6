"""The controller with the arm as it is planned: what it shows of it, and how it stops."""

from collections import Counter
from itertools import pairwise
from typing import Any

import pytest

from grammar.syntax.source import Source
from interp.controller.controller import Controller
from interp.controller.inputs.input_script import Script
from interp.controller.state.profile import Profile
from interp.controller.state.trace import Trace
from interp.port.events import EVERY_KIND
from interp.program.load import load
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Motion, Position
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.robot import RobotFault
from interp.tree.executor import TreeExecutor

START = (0.0, -90.0, 90.0, 0.0, 45.0, 10.0)
FRAMES = "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n"
HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\n"
FIRST = FRAMES + HOME + "PTP {X 500,Y 100,Z 600,A 180,B 0,C 180,S 2}\n"


class Ran:
    """A run with the planned arm."""

    def __init__(
        self,
        text: str,
        script: str = "",
        follower: Any = None,
        until: int = 60_000_000,
    ) -> None:
        machine = default_machine()
        self.arm = PlannedArm(machine, START)
        trace = Trace(kinds=EVERY_KIND)
        sink = trace.sink()
        program = load([Source(text, "main.src")], "main.src", strict=False)
        self.controller = Controller(
            TreeExecutor(program, sink=sink),
            lambda switch: ControlCore(self.arm, switch, 1),
            profile=Profile.load(),
            script=Script.read(script),
            trace=trace,
            sink=sink,
            machine=machine,
            follower=follower,
        )
        self.outcome = self.controller.run(until)
        self.events = trace.events

    def times(self, kind: str, **fields: Any) -> list[int]:
        """The times in µs of events of a kind that have these fields."""
        return [
            one.time
            for one in self.events
            if one.kind == kind and fields.items() <= dict(one.fields).items()
        ]

    def messages(self) -> list[int]:
        """The numbers of messages."""
        return [one.fields["number"] for one in self.events if one.kind == "message"]


def program(body: str, routines: str = "") -> str:
    """A program that stands at X 500, Y 100, Z 600 before its body."""
    return f"DEF main()\nREAL R,Q\nINT I\n{FIRST}{body}END\n{routines}"


def test_actual_position_in_frames_set_behind_the_last_motion() -> None:
    """Once the arm stands the main run has caught up: PTP $POS_ACT leads nowhere [MOT-18]."""
    frames = "$TOOL={X 0,Y 0,Z 150,A 0,B 30,C 0}\n$BASE={X 300,Y 20,Z 10,A 45,B 0,C 0}\n"
    ran = Ran(program(f"LIN {{Y 100,Z 700}}\n{frames}PTP $POS_ACT\n"))
    assert 3171 == ran.messages()[-1]
    assert 3 == ran.controller.points[-1].number
    before, after = (ran.arm.position(time).axes for time in ran.times("motion_end")[-2:])
    assert pytest.approx(before, abs=1e-4) == after


def test_points() -> None:
    """Every motion that was planned is told with where it leads."""
    ran = Ran(program("LIN {Y -100} C_DIS\nLIN {Z 700}\n"))
    points = ran.controller.points
    assert [(1, "PTP"), (2, "PTP"), (3, "LIN"), (4, "LIN")] == [
        (one.number, one.kind) for one in points
    ]
    position = points[2].position
    assert isinstance(position, Position)
    assert pytest.approx((500, -100, 600)) == position.flange.position


def test_a_loop_of_motions_to_where_the_arm_is_lets_time_pass() -> None:
    """Two motions of length zero are a slice: the loop goes on in the next cycle [MOT-11]."""
    loop = "$ADVANCE=1\nLOOP\nPTP_REL {A1 0} C_PTP\nENDLOOP\n"
    ran = Ran(program(loop), until=2_000_000)
    assert "time" == ran.outcome.ending
    ends = Counter(time for time in ran.times("motion_end") if time % 12_000 == 0)
    assert {2} == set(ends.values())
    assert {12_000} == {after - before for before, after in pairwise(sorted(ends))}
    assert len(ends) > 100


def test_points_leave_out_motions_to_where_the_arm_is() -> None:
    """A motion of length zero leads nowhere, so its point is that of the motion before it."""
    ran = Ran(program("LIN {Y -100}\nLIN {Y -100}\nLIN {Z 700}\n"))
    assert [3171] == ran.messages()
    assert [1, 2, 3, 5] == [one.number for one in ran.controller.points]


class Colliding:
    """A robot that touches something after a second."""

    chunk = 100_000

    def __init__(self) -> None:
        self.placements: list[tuple[int, Placement]] = []
        self.is_over = False

    def advance(self, now: int) -> None:
        """Time has come to ``now``."""
        if now >= 1_000_000 and not self.is_over:
            self.is_over = True
            raise RobotFault("collision", "the robot has touched the table", 1_000_000)

    def begun(self, time: int, motion: Motion) -> None:
        """The frames of a motion."""
        self.placements.append((time, motion.settings.placement))

    def next_time(self, now: int) -> int:
        """When `advance` must be called."""
        return now + self.chunk

    def settle(self, _now: int) -> None:
        """All is sent."""


def test_robot_that_cannot_go_on() -> None:
    """A fault of the robot stops the arm hard and ends the program at the running motion."""
    robot = Colliding()
    ran = Ran(program("$VEL.CP=0.05\nLIN {Y -100}\n"), follower=robot)
    assert ("fault", "collision") == (ran.outcome.ending, ran.outcome.error.slug)  # type: ignore[union-attr]
    assert 9 == ran.outcome.at.line  # type: ignore[union-attr]
    assert 1_000_000 <= ran.times("fault")[0] <= 1_000_000 + robot.chunk
    assert ran.times("motion_start") == [time for time, _ in robot.placements]
