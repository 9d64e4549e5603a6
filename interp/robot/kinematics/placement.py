"""The pose of the flange for a programmed point: $BASE, $TOOL, $ROBROOT and $IPO_MODE.

A point P is the pose of the tool relative to the base. So the flange is at ``BASE · P · TOOL⁻¹``
relative to the world, and at ``ROBROOT⁻¹ · BASE · P · TOOL⁻¹`` relative to the robot's foot
[ARI-09]. This holds for a fixed tool as well: then $BASE is the tool, and $TOOL the workpiece on
the flange. $IPO_MODE changes only the path between points: that of the tool relative to the base
(#BASE), or that of the base relative to the tool (#TCP) [ORI-07].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

from interp.robot.kinematics.carrier import Carrier
from interp.values.poses import IDENTITY, Pose

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Array


class IpoMode(Enum):
    """$IPO_MODE: the frame in which the path is planned."""

    BASE = "#BASE"
    TCP = "#TCP"


@dataclass(frozen=True, slots=True)
class Placement:
    """The frames in force, each with the value of its system variable.

    If a ``carrier`` carries the robot, its foot is not at ``robroot`` but where the external axes
    have moved it; the same holds for a base on a ``table``. `at` returns the frames for given
    external axes.
    """

    base: Pose = IDENTITY
    tool: Pose = IDENTITY
    robroot: Pose = IDENTITY
    mode: IpoMode = IpoMode.BASE
    carrier: Carrier | None = None
    table: Carrier | None = None

    @property
    def is_carried(self) -> bool:
        """Whether external axes move one of the frames."""
        return self.carrier is not None or self.table is not None

    def at(self, externals: Sequence[float]) -> Placement:
        """Return the frames for external axes in degrees or mm."""
        if not self.is_carried:
            return self
        robroot = self.robroot if self.carrier is None else self.carrier.pose(externals)
        base = self.base if self.table is None else self.table.pose(externals)
        return replace(self, robroot=robroot, base=base, carrier=None, table=None)

    def feet(self, externals: Array) -> Array:
        """Return the robot's foot for external axes ``(n, axes)``: (n, 4, 4), or one (4, 4)."""
        return _poses(self.robroot, self.carrier, externals)

    def chains_before(self, externals: Array) -> Array:
        """Return `before` for external axes ``(n, axes)``: (n, 4, 4), or one (4, 4) for all."""
        from numpy.linalg import inv

        if not self.is_carried:
            return _poses(self.before, None, externals)
        feet = inv(self.feet(externals)).astype("float64")
        return feet @ _poses(self.base, self.table, externals)

    @property
    def before(self) -> Pose:
        """The transform before the point, in the chain from the foot to the flange."""
        return self.robroot.inverse() @ self.base

    @property
    def after(self) -> Pose:
        """The transform after the point, in the chain from the foot to the flange."""
        return self.tool.inverse()

    def flange(self, point: Pose) -> Pose:
        """Return the flange relative to the robot's foot for a programmed point."""
        return self.before @ point @ self.after

    def point(self, flange: Pose) -> Pose:
        """Return the point, as $POS_ACT shows it, for a flange relative to the robot's foot."""
        return self.before.inverse() @ flange @ self.tool

    def in_path(self, point: Pose) -> Pose:
        """Return the pose that is interpolated for a point."""
        return point if self.mode is IpoMode.BASE else point.inverse()


def _poses(fixed: Pose, carrier: Carrier | None, externals: Array) -> Array:
    from interp.robot.kinematics.kinematics import matrix_of

    if carrier is None:
        return matrix_of(fixed)
    return carrier.poses(externals)
