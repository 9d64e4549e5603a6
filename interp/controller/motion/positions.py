"""System variables for the position of the arm [MOT-18, INT-15].

$POS_ACT and $AXIS_ACT are set-points. $POS_ACT_MES and $AXIS_ACT_MEAS are measured if the robot
measures. $POS_INT is the position at the event of an interrupt, $POS_RET where BRAKE stopped the
arm, $POS_BACK the start and $POS_FOR the end of the running motion. $IN_HOME is TRUE if every axis
is within $H_POS_TOL of $H_POS; $IN_HOME1 to 5 likewise with $AXIS_HOME and $H_AXIS_TOL.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain, repeat
from typing import TYPE_CHECKING, Any, Final

from interp.controller.motion.follower import Follower
from interp.controller.state.state import ControllerState
from interp.controller.state.variables import Computed, Snapshot, Variables
from interp.port.requests import Path, Value
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Position
from interp.robot.kinematics.carrier import Carrier
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import (
    AXIS_NAMES,
    EXTERNAL_NAMES,
    ROBOT_AXES,
    MachineData,
)
from interp.robot.kinematics.placement import IpoMode, Placement
from interp.values.faults import fault
from interp.values.poses import IDENTITY, Pose
from interp.values.predefined_values import empty_structure
from interp.values.values import StructureValue, single
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Kinematics

#: Degrees or mm by which an axis may miss a home position in addition to its tolerance.
_HOME: Final = 1e-3


def axes_value(axes: Sequence[float]) -> StructureValue:
    """Return an E6AXIS from axis values in degrees or mm; missing external axes are 0."""
    value = empty_structure("E6AXIS")
    _set(value, (*AXIS_NAMES, *EXTERNAL_NAMES), axes)
    return value


def pose_value(
    pose: Pose, status: int = 0, turn: int = 0, externals: Sequence[float] = ()
) -> StructureValue:
    """Return an E6POS from a pose, Status, Turn and external axes; missing axes are 0."""
    value = empty_structure("E6POS")
    _set(value, "XYZABC", pose.components)
    value.set("S", status)
    value.set("T", turn)
    _set(value, EXTERNAL_NAMES, externals)
    return value


def _set(value: StructureValue, names: Iterable[str], numbers: Iterable[float]) -> None:
    """Set components of a position; those for which there is no number are 0."""
    for name, number in zip(names, chain(numbers, repeat(0.0)), strict=False):
        value.set(name, single(number))


def pose_of(frame: Any) -> Pose | None:
    """Return the pose of a FRAME, POS or E6POS; ``None`` if a component has no value."""
    numbers = [frame.get(name) for name in "XYZABC"]
    return None if None in numbers else Pose.of(*map(float, numbers))


def constant_text(value: Any) -> str:
    """Return an enumeration constant as KRL writes it, ``#BASE``; other values in upper case."""
    return str(value).upper()


@dataclass(slots=True, eq=False)
class FramesInForce:
    """$BASE, $TOOL, $ROBROOT and $IPO_MODE, in the advance run and in the main run."""

    _variables: Variables
    _machine: MachineData
    _core: ControlCore
    #: The frame that EK returned last, and the kinematic system that carries it.
    _coupled: tuple[Pose, Carrier] | None = None

    def couple(self, frame: Pose, table: Carrier) -> None:
        """Let $BASE move with external axes as long as it equals the frame that EK returned."""
        self._coupled = frame, table

    def of(self, values: Snapshot) -> Placement:
        """Return the frames of a motion; a $TOOL or $BASE without a value counts as zero."""
        base = pose_of(values["$BASE"]) or IDENTITY
        given, table = self._coupled or (None, None)
        return Placement(
            base,
            pose_of(values["$TOOL"]) or IDENTITY,
            self._robroot(),
            IpoMode(constant_text(values["$IPO_MODE"])),
            self._machine.carrier,
            table if base == given else None,
        )

    def advance_run(self) -> Placement:
        """Return the frames that the program has set last."""
        return self.of(self._variables.snapshot())

    def main_run(self) -> Placement:
        """Return the frames of the running motion; after the last one, those of the advance run."""
        return self.of(self._variables.main) if self._core.pending() else self.advance_run()

    def _robroot(self) -> Pose:
        """Return $ROBROOT of a data list, else that of the machine data."""
        found = pose_of(self._variables.read(("$ROBROOT",)))
        if found not in (None, IDENTITY):
            return found
        return self._machine.robroot


class Positions:
    """The present position of the arm, its measured position, and those at certain events.

    ``follower`` measures the position.
    """

    def __init__(
        self,
        state: ControllerState,
        core: ControlCore,
        frames: FramesInForce,
        follower: Follower,
    ) -> None:
        self._clock = state.clock
        self._arm = core.arm
        self._frames = frames
        self._follower = follower
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
    def _kinematics(self) -> Kinematics:
        return kinematics_of(self._machine)

    def actual(self) -> Position:
        """Return the present set-point."""
        return self._arm.position(self._clock.now)

    def keep(self, name: str, position: Position | None = None) -> None:
        """Store a position, by default the present set-point, as INT, RET, BACK or FOR."""
        self._kept[name] = self.actual() if position is None else position

    def _recall(self, name: str) -> Position:
        if name not in self._kept:
            raise fault("uninitialised")
        return self._kept[name]

    def _measured(self) -> Position:
        axes = self._follower.measured(self._clock.now)
        flange = Pose.from_matrix(self._kinematics.forward(axes[:ROBOT_AXES]).tolist())
        return Position(axes, flange)

    def _point_at(self, position: Callable[[], Position]) -> StructureValue:
        """Return a position as in $POS_ACT: the tool centre point in the base, Status and Turn."""
        at = position()
        status, turn = self.status_turn(at.axes)
        externals = at.axes[ROBOT_AXES:]
        point = self._frames.main_run().at(externals).point(at.flange)
        return pose_value(point, status, turn, externals)

    def status_turn(self, axes: Sequence[float]) -> tuple[int, int]:
        """Return Status and Turn of axes in degrees."""
        from interp.robot.kinematics.solution_choice import turn_of

        robot = axes[:ROBOT_AXES]
        return int(self._kinematics.status(robot)), turn_of(robot)

    def _is_home(self, home: Path, tolerance: Path) -> Value:
        """Return whether all axes that a home position names are within their tolerance."""
        wanted: Any = self._variables.read(home)
        allowed: Any = self._variables.read(tolerance)
        names = [member.name for member in wanted.type.members]
        for name, axis in zip(names, self.actual().axes, strict=False):
            value = wanted.get(name)
            if value is not None and abs(axis - value) > (allowed.get(name) or 0.0) + _HOME:
                return False
        return True


def _axes_at(position: Callable[[], Position]) -> StructureValue:
    return axes_value(position().axes)
