"""A serial chain of joints: what kinematics, models and drawings of an arm have in common."""

from __future__ import annotations

from interp.values.poses import IDENTITY, Pose
from support.lazy_dataclass import dataclass

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint that turns about ``axis``, or slides along it where ``is_linear``.

    ``frame`` is where it stands at zero in the moving frame of the joint before it, in mm. ``axis``
    is a unit vector in that frame, with the sense in which the axis counts. ``name`` is that of the
    axis; one without a name never moves.
    """

    name: str
    frame: Pose
    axis: Point = (0.0, 0.0, 1.0)
    is_linear: bool = False


@dataclass(frozen=True, slots=True)
class Chain:
    """Joints from the foot outwards; ``end`` is the flange in the frame of the last of them."""

    joints: tuple[Joint, ...]
    end: Pose = IDENTITY
