"""Gas on when the ignition motion ends: the Robotics API, without any KRL.

The paper's example. A torch is ignited by a motion past the igniter; the gas has to come on at the
end of it, not a cycle later. Then the arm cuts along two lines that blend. A lamp goes on 20 ms
before the arm is 80 mm from the end of the first, and the gas goes off where the cut ends. Should
the motion be stopped on its way, the gas goes off as well.

    python examples/ignition.py [none|kinematic|mujoco]
"""

import sys

from interp.robot.api.commands import MotionCommand, OutputCommand, Transaction
from interp.robot.api.control_core import ControlCore
from interp.robot.api.motions import MotionFactory
from interp.robot.arm import Approximation, Place, Settings
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.factory import ROBOTS, make_robot
from interp.robot.simulation.tracking import Tracking
from interp.values.poses import Pose

CYCLE = 12_000  # µs: the interpolation cycle
HOME = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
GAS, LAMP = ("$OUT", 1), ("$OUT", 2)


def switch(path: tuple[str | int, ...], value: object, time: int) -> None:
    """Called by the control core at the very microsecond an output is switched."""
    say(time, f"{path[0]}[{path[1]}] = {str(value).upper()}")


def say(time: int, what: str) -> None:
    """A line of what happens."""
    print(f"{time / 1000:10.3f} ms  {what}")  # noqa: T201  an example speaks for itself


def main(robot_name: str) -> None:
    """Load the work as one transaction, and let time pass until all of it is done."""
    machine = default_machine()
    arm = PlannedArm(machine, HOME)
    core = ControlCore(arm, switch, CYCLE)
    robot = make_robot(next(name for name in ROBOTS if name == robot_name), machine, CYCLE)
    tracking = Tracking(arm, robot, machine, CYCLE, HOME)

    torch = Placement(base=Pose.of(x=450, y=-100, z=300), tool=Pose.of(z=150))
    motions = MotionFactory(
        Settings(placement=torch, velocity=0.25, approximation=Approximation(cdis=20))
    )
    before_end = Place(key=1, kind="PATH", position=-80.0, delay=-20_000)

    to_igniter = motions.ptp(x=0, y=0, z=50, a=0, b=0, c=180, s=2, t=2)
    ignite = motions.lin(x=60)
    first_cut = motions.lin(y=150, z=0, criteria=["C_DIS"], places=[before_end])
    last_cut = motions.lin(x=0)

    gas_on, gas_off = OutputCommand(GAS, True), OutputCommand(GAS, False)
    lamp_on = OutputCommand(LAMP, True)

    work = (
        Transaction(to_igniter, ignite, first_cut, last_cut, gas_on, gas_off, lamp_on)
        .link(ignite.ended, "start", gas_on)
        .link(first_cut.reached(before_end), "start", lamp_on)
        .link(last_cut.ended, "start", gas_off)
        .link(last_cut.cancelled, "start", gas_off)
    )
    core.load(0, work)
    tracking.placed(0, torch)
    while (time := core.next_time()) is not None:
        for event in core.run_until(time):
            if isinstance(event.command, MotionCommand):
                say(event.time, f"{event.command} {event.what}")
        tracking.advance(time)
    tracking.settle(core.now)

    record = tracking.record()
    points = record.points if record.points_measured is None else record.points_measured
    if len(points) > 1:
        x, y, z, *_ = points[-1]
        say(int(record.times[-1]), f"the torch is at X {x:.3f}, Y {y:.3f}, Z {z:.3f}")


if __name__ == "__main__":
    name = sys.argv[1] if len(sys.argv) > 1 else "kinematic"
    if name not in ROBOTS:
        sys.exit(f"{name}: no robot; there are {', '.join(ROBOTS)}")
    main(name)
