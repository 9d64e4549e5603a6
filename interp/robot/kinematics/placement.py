"""Where a programmed point puts the flange: $BASE, $TOOL, $ROBROOT and $IPO_MODE.

A point P is the pose of the tool in the base. So the flange is in the world at
``BASE · P · TOOL⁻¹``, and in front of the robot's foot at ``ROBROOT⁻¹ · BASE · P · TOOL⁻¹``
[ARI-09]. That holds for a fixed tool as well: there $BASE is the tool, and $TOOL the workpiece on
the flange. What $IPO_MODE changes is the path between points, which is that of the tool in the base
(#BASE) or that of the base in the tool (#TCP) [ORI-07].
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from interp.values.poses import IDENTITY, Pose

__all__ = ["IpoMode", "Placement"]


class IpoMode(Enum):
    """$IPO_MODE: which frame the path is planned in."""

    BASE = "#BASE"
    TCP = "#TCP"


@dataclass(frozen=True, slots=True)
class Placement:
    """The frames in force, each with the value of its system variable."""

    base: Pose = IDENTITY
    tool: Pose = IDENTITY
    robroot: Pose = IDENTITY
    mode: IpoMode = IpoMode.BASE

    @property
    def before(self) -> Pose:
        """What comes before the point in the chain to the flange."""
        return self.robroot.inverse() @ self.base

    @property
    def after(self) -> Pose:
        """What comes after the point in the chain to the flange."""
        return self.tool.inverse()

    def flange(self, point: Pose) -> Pose:
        """The flange in front of the robot's foot for a programmed point."""
        return self.before @ point @ self.after

    def point(self, flange: Pose) -> Pose:
        """The point, as $POS_ACT shows it, for a flange in front of the robot's foot."""
        return self.before.inverse() @ flange @ self.tool

    def in_path(self, point: Pose) -> Pose:
        """The pose that is interpolated for a point."""
        return point if self.mode is IpoMode.BASE else point.inverse()
