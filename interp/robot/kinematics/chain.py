"""A serial chain of joints, for kinematics, models and drawings of an arm."""

from __future__ import annotations

from interp.values.poses import IDENTITY, Pose
from support.lazy_dataclass import dataclass

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint that turns about ``axis``, or slides along it if ``is_linear``.

    ``frame`` is the joint's frame at zero, relative to the moving frame of the previous joint, in
    mm. ``axis`` is a unit vector in that frame, pointing in the positive sense of the axis.
    ``name`` is the name of the axis; a joint without a name never moves.
    """

    name: str
    frame: Pose
    axis: Point = (0.0, 0.0, 1.0)
    is_linear: bool = False


@dataclass(frozen=True, slots=True)
class Chain:
    """Joints from the foot outwards; ``end`` is the flange relative to the last joint."""

    joints: tuple[Joint, ...]
    end: Pose = IDENTITY
