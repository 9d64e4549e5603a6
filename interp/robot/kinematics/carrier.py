"""External kinematic systems: what external axes carry, such as a robot on a linear unit.

The chain is ``ETn_TA1KR · move · ETn_TA2A1 · move · ETn_TA3A2 · move · ETn_TFLA3``. Each axis turns
about the Z axis of the frame before it, or slides along it (KUKA, *KR C2, Machine Data* and
*External Axes*). #ERSYS carries the robot and begins at $ERSYSROOT.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from interp.robot.kinematics.chain import Chain
from interp.values.poses import IDENTITY, Pose

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class Carrier:
    """The frame that up to three external axes carry, relative to $WORLD.

    ``columns`` are the indices of these axes among all external axes, in the order of the chain.
    """

    chain: Chain
    columns: tuple[int, ...]
    root: Pose = IDENTITY

    def with_frames(self, root: Pose, offset: Pose) -> Carrier:
        """Return the same axes with another root, and with a further frame on what they carry."""
        return Carrier(Chain(self.chain.joints, self.chain.end @ offset), self.columns, root)

    def pose(self, externals: Sequence[float]) -> Pose:
        """Return the frame for external axes in degrees or mm."""
        pose = self.root
        for joint, column in zip(self.chain.joints, self.columns, strict=True):
            way = float(externals[column]) * joint.axis[2]
            moved = Pose.of(z=way) if joint.is_linear else Pose.of(a=way)
            pose = pose @ joint.frame @ moved
        return pose @ self.chain.end

    def poses(self, externals: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return homogeneous matrices (n, 4, 4) of the frame for external axes (n, axes)."""
        import numpy as np

        return np.array([self.pose(row).matrix for row in externals.tolist()]).reshape(-1, 4, 4)
