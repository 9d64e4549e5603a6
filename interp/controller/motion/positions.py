"""System variables of the arm's position [MOT-18, INT-15].

$POS_ACT and $AXIS_ACT are set-points, $POS_ACT_MES and $AXIS_ACT_MEAS are measured where the robot
measures. $POS_INT is where the event of an interrupt came, $POS_RET where BRAKE stopped the arm,
$POS_BACK where the running motion began, $POS_FOR where it goes. $IN_HOME is TRUE where every axis
is within $H_POS_TOL of $H_POS; $IN_HOME1 to 5 likewise, with $AXIS_HOME and $H_AXIS_TOL.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

from interp.controller.state.predefined_values import empty_structure
from interp.controller.state.state import ControllerState
from interp.controller.state.variables import Computed, Snapshot, Variables
from interp.port.requests import Path, Value
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Position
from interp.robot.kinematics.arms import kinematics_of
from interp.robot.kinematics.carrier import Carrier
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.placement import IpoMode, Placement
from interp.values.faults import fault
from interp.values.poses import IDENTITY, Pose
from interp.values.values import EnumValue, StructureValue, single

if TYPE_CHECKING:
    from interp.robot.kinematics.solver import Kinematics
    from interp.robot.simulation.tracking import Tracking

#: Degrees or mm by which an axis may miss a home position beside its tolerance.
_HOME: Final = 1e-3


def axes_value(axes: Sequence[float]) -> StructureValue:
    """An E6AXIS; external axes that are not there are 0."""
    value = empty_structure("E6AXIS")
    for place in range(len(value.members)):
        value.members[place] = single(axes[place] if place < len(axes) else 0.0)
    return value


def pose_value(
    pose: Pose, status: int = 0, turn: int = 0, externals: Sequence[float] = ()
) -> StructureValue:
    """An E6POS."""
    value = empty_structure("E6POS")
    for name, number in zip("XYZABC", pose.components, strict=True):
        value.set(name, single(number))
    value.set("S", status)
    value.set("T", turn)
    for place in range(6):
        value.set(f"E{place + 1}", single(externals[place] if place < len(externals) else 0.0))
    return value


def pose_of(frame: Any) -> Pose | None:
    """The pose of a FRAME, POS or E6POS; ``None`` where a component has no value."""
    numbers = [frame.get(name) for name in "XYZABC"]
    return None if None in numbers else Pose.of(*map(float, numbers))


def word_of(value: Any) -> str:
    """A value of an enumeration as KRL writes it, ``#BASE``; others as they are printed."""
    return f"#{value.name.upper()}" if isinstance(value, EnumValue) else str(value)


class FramesInForce:
    """$BASE, $TOOL, $ROBROOT and $IPO_MODE in the advance run and in the main run."""

    def __init__(
        self, variables: Variables, machine: MachineData | None, core: ControlCore
    ) -> None:
        self._variables = variables
        self._machine = machine
        self._core = core
        #: What EK gave last, and what carries it.
        self._coupled: tuple[Pose, Carrier] | None = None

    def couple(self, frame: Pose, table: Carrier) -> None:
        """$BASE moves with external axes as long as it has the value of a frame that EK gave."""
        self._coupled = frame, table

    def of(self, values: Snapshot) -> Placement:
        """The frames of a motion; a $TOOL or $BASE without a value counts as zero."""
        base = pose_of(values["$BASE"]) or IDENTITY
        given, table = self._coupled or (None, None)
        return Placement(
            base,
            pose_of(values["$TOOL"]) or IDENTITY,
            self._robroot(),
            IpoMode(word_of(values["$IPO_MODE"])),
            None if self._machine is None else self._machine.carrier,
            table if base == given else None,
        )

    def advance_run(self) -> Placement:
        """The frames as the program has set them last."""
        return self.of(self._variables.snapshot())

    def main_run(self) -> Placement:
        """The frames of the motion that runs; after the last one those of the advance run."""
        return self.of(self._variables.main) if self._core.pending() else self.advance_run()

    def _robroot(self) -> Pose:
        """$ROBROOT of a data list, else that of the machine data."""
        found = pose_of(self._variables.read(("$ROBROOT",)))
        if found is not None and found != IDENTITY:
            return found
        return IDENTITY if self._machine is None else self._machine.robroot


class Positions:
    """The position of the arm now, as it is measured, and where it was at certain events.

    ``tracking`` measures, where there is a robot.
    """

    def __init__(
        self,
        state: ControllerState,
        core: ControlCore,
        frames: FramesInForce,
        tracking: Tracking | None,
    ) -> None:
        self._clock = state.clock
        self._arm = core.arm
        self._frames = frames
        self._tracking = tracking
        self._machine = state.machine
        self._kept: dict[str, Position] = {}
        shown: Mapping[str, tuple[str, str, Callable[[], Position]]] = {
            "actual": ("$AXIS_ACT", "$POS_ACT", self.actual),
            "measured": ("$AXIS_ACT_MEAS", "$POS_ACT_MES", self._measured),
            **{
                name: (f"$AXIS_{name}", f"$POS_{name}", partial(self._recall, name))
                for name in ("INT", "RET", "BACK", "FOR")
            },
        }
        self._variables = variables = state.variables
        homes: dict[str, tuple[Path, Path]] = {"$IN_HOME": (("$H_POS",), ("$H_POS_TOL",))}
        for place in range(1, 6):
            homes[f"$IN_HOME{place}"] = ("$AXIS_HOME", place), ("$H_AXIS_TOL", place)
        for name, (home, tolerance) in homes.items():
            variables.connect([name], Computed(partial(self._is_home, home, tolerance)))
        for axes, pose, position in shown.values():
            variables.connect([axes], Computed(partial(_axes_at, position)))
            variables.connect([pose], Computed(partial(self._point_at, position)))

    @cached_property
    def _kinematics(self) -> Kinematics | None:
        return None if self._machine is None else kinematics_of(self._machine)

    def actual(self) -> Position:
        """The set-point at this time."""
        return self._arm.position(self._clock.now)

    def keep(self, name: str, position: Position | None = None) -> None:
        """Keep a position, by default the set-point at this time, as INT, RET, BACK or FOR."""
        self._kept[name] = self.actual() if position is None else position

    def _recall(self, name: str) -> Position:
        if name not in self._kept:
            raise fault("uninitialised")
        return self._kept[name]

    def _measured(self) -> Position:
        if self._tracking is None or self._kinematics is None:
            return self.actual()
        axes = self._tracking.measured(self._clock.now)
        flange = Pose.from_matrix(self._kinematics.forward(axes[:ROBOT_AXES]).tolist())
        return Position(axes, flange)

    def _point_at(self, position: Callable[[], Position]) -> StructureValue:
        """A position as $POS_ACT shows it: the point of the tool in the base, Status and Turn."""
        at = position()
        status, turn = self.status_turn(at.axes)
        externals = at.axes[ROBOT_AXES:]
        point = self._frames.main_run().at(externals).point(at.flange)
        return pose_value(point, status, turn, externals)

    def status_turn(self, axes: Sequence[float]) -> tuple[int, int]:
        """Status and Turn of axes; a Status of 0 where there is no machine data."""
        from interp.robot.kinematics.targets import turn_of

        robot = axes[:ROBOT_AXES]
        status = 0 if self._kinematics is None else int(self._kinematics.status(robot))
        return status, turn_of(robot)

    def _is_home(self, home: Path, tolerance: Path) -> Value:
        """Whether all axes that a home position names are there."""
        wanted: Any = self._variables.read(home)
        allowed: Any = self._variables.read(tolerance)
        names = [member.name for member in wanted.type.members]
        for name, axis in zip(names, self.actual().axes, strict=False):
            value = wanted.get(name)
            if value is not None and abs(axis - value) > abs(allowed.get(name) or 0.0) + _HOME:
                return False
        return True


def _axes_at(position: Callable[[], Position]) -> StructureValue:
    return axes_value(position().axes)
