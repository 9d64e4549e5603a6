"""Where the arm is, as the system variables show it [MOT-18, INT-15].

$POS_ACT and $AXIS_ACT are set-points, $POS_ACT_MES and $AXIS_ACT_MEAS are measured where the robot
measures. $POS_INT is where the event of an interrupt came, $POS_RET where BRAKE stopped the arm,
$POS_BACK where the running motion began, $POS_FOR where it goes. $IN_HOME is TRUE where every axis
is within $H_POS_TOL of $H_POS; $IN_HOME1 to 5 likewise, with $AXIS_HOME and $H_AXIS_TOL.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Final

from grammar.semantics.predefined import System
from grammar.semantics.types import Structure
from interp.controller.variables import Computed, Variables
from interp.port.requests import Path, Value
from interp.robot.kinematics.frames import Pose
from interp.robot.kinematics.machine_data import ROBOT_AXES, Machine
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solver import Arm as Kinematics
from interp.robot.kinematics.targets import turn_of
from interp.values.faults import fault
from interp.values.values import StructureValue, empty, single

__all__ = ["Positions", "Where", "axes_value", "pose_of", "pose_value"]

#: The axes in degrees, and the flange in front of the robot's foot.
Where = tuple[tuple[float, ...], Pose]

#: Degrees or mm by which an axis may miss a home position beside its tolerance.
_HOME: Final = 1e-3


def _structure(name: str) -> StructureValue:
    type_ = System.load().types[name]
    assert isinstance(type_, Structure)
    value = empty(type_)
    assert isinstance(value, StructureValue)
    return value


def axes_value(axes: Sequence[float]) -> StructureValue:
    """An E6AXIS; external axes that are not there are 0."""
    value = _structure("E6AXIS")
    for place in range(len(value.members)):
        value.members[place] = single(axes[place] if place < len(axes) else 0.0)
    return value


def pose_value(
    pose: Pose, status: int = 0, turn: int = 0, externals: Sequence[float] = ()
) -> StructureValue:
    """An E6POS."""
    value = _structure("E6POS")
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


class Positions:
    """Answers for all of them; ``actual`` and ``measured`` give where the arm is now."""

    def __init__(
        self,
        variables: Variables,
        machine: Machine | None,
        actual: Callable[[], Where],
        measured: Callable[[], Where],
        placement: Callable[[], Placement],
    ) -> None:
        self._kinematics = None if machine is None else Kinematics(machine)
        self._placement = placement
        self._kept: dict[str, Where] = {}
        looks: Mapping[str, tuple[str, str, Callable[[], Where]]] = {
            "actual": ("$AXIS_ACT", "$POS_ACT", actual),
            "measured": ("$AXIS_ACT_MEAS", "$POS_ACT_MES", measured),
            **{
                name: (f"$AXIS_{name}", f"$POS_{name}", self._looker(name))
                for name in ("INT", "RET", "BACK", "FOR")
            },
        }
        self._actual = actual
        self._variables = variables
        homes: dict[str, tuple[Path, Path]] = {"$IN_HOME": (("$H_POS",), ("$H_POS_TOL",))}
        for place in range(1, 6):
            homes[f"$IN_HOME{place}"] = ("$AXIS_HOME", place), ("$H_AXIS_TOL", place)
        for name, (home, tolerance) in homes.items():
            variables.connect([name], Computed(partial(self._is_home, home, tolerance)))
        for axes, pose, where in looks.values():
            variables.connect([axes], Computed(partial(_axes_at, where)))
            variables.connect([pose], Computed(partial(self._shown_at, where)))

    def keep(self, name: str, where: Where | None = None) -> None:
        """Keep where the arm is now as INT, RET, BACK or FOR, or another position."""
        self._kept[name] = self._actual() if where is None else where

    def shown(self, where: Where) -> StructureValue:
        """A position as $POS_ACT shows it: the point of the tool in the base, Status and Turn."""
        axes, flange = where
        status, turn = self.status_turn(axes)
        point = self._placement().point(flange)
        return pose_value(point, status, turn, axes[ROBOT_AXES:])

    def status_turn(self, axes: Sequence[float]) -> tuple[int, int]:
        """Status and Turn of axes; a Status of 0 where there is no machine data."""
        robot = axes[:ROBOT_AXES]
        status = 0 if self._kinematics is None else int(self._kinematics.status(robot))
        return status, turn_of(robot)

    def flange(self, axes: Sequence[float]) -> Pose:
        """The flange in front of the robot's foot for axes in degrees."""
        assert self._kinematics is not None, "only where there is machine data"
        return Pose.from_matrix(self._kinematics.forward(axes[:ROBOT_AXES]).tolist())

    def _is_home(self, home: Path, tolerance: Path) -> Value:
        """Whether all axes that a home position names are there."""
        wanted: Any = self._variables.read(home)
        allowed: Any = self._variables.read(tolerance)
        names = [member.name for member in wanted.type.members]
        for name, axis in zip(names, self._actual()[0], strict=False):
            value = wanted.get(name)
            if value is not None and abs(axis - value) > abs(allowed.get(name) or 0.0) + _HOME:
                return False
        return True

    def _shown_at(self, where: Callable[[], Where]) -> StructureValue:
        return self.shown(where())

    def _looker(self, name: str) -> Callable[[], Where]:
        def look() -> Where:
            if name not in self._kept:
                raise fault("uninitialised")
            return self._kept[name]

        return look


def _axes_at(where: Callable[[], Where]) -> StructureValue:
    return axes_value(where()[0])
