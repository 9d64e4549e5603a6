"""The interface of an arm's kinematics, whatever its structure.

Arrays are of float64: ``(..., 6)`` for axes in degrees (mm for linear ones), ``(..., 4, 4)`` for
homogeneous matrices with positions in mm. A pose is that of the flange in the frame of the robot's
foot, $ROBROOT; `interp.robot.kinematics.placement` gets it from the programmed point.
`interp.robot.kinematics.arms.kinematics_of` chooses for a machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.machine_data import MachineData
from interp.values.poses import Pose

Array = npt.NDArray[np.float64]


class Kinematics(Protocol):
    """From axes to poses and back."""

    @property
    def machine(self) -> MachineData:
        """The machine whose kinematics they are."""
        ...

    @property
    def elbow(self) -> float:
        """The angle of A3 in degrees at which the arm is stretched, where bit 1 of S changes."""
        ...

    @property
    def has_wrist_singularity(self) -> bool:
        """Whether A4 is undetermined where A5 is 0."""
        ...

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Axes ``(..., 6)`` with those that the mechanics set set: of a palletiser A4 and A5."""
        ...

    def about_tips(self, poses: Array, tool: Array, /) -> Array:
        """Poses ``(..., 4, 4)`` turned to what the arm can have, about the tip of a tool (4, 4)."""
        ...

    def forward(self, axes: npt.ArrayLike) -> Array:
        """Poses of the flange, ``(..., 4, 4)``, for axes ``(..., 6)``."""
        ...

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Ways to reach poses ``(..., 4, 4)``: axes ``(..., ways, 6)``, NaN where there is none.

        Angles lie above -180 and up to 180 degrees, whatever the software limits.
        """
        ...

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """For each pose the way that a reference stands in: axes ``(n, 6)``, NaN where none is.

        ``poses`` are ``(n, 4, 4)``, ``references`` ``(n, 6)`` axes beside the solution.
        """
        ...

    def inverse_along(self, poses: Array, start: Sequence[float]) -> Array | None:
        """Axes ``(n, 6)`` along a path of poses in the way that ``start`` stands in, unbroken.

        ``None`` where that is not plain; then it has to be followed way by way. Raises
        `interp.values.faults.Fault` 1366 where it cannot be followed at all.
        """
        ...

    def status(self, axes: npt.ArrayLike) -> npt.NDArray[np.int64]:
        """Status of axes ``(..., 6)``, its bits 0 to 2 [POS-03, POS-04, POS-05]."""
        ...

    def distance_to_axis_1(self, axes: npt.ArrayLike) -> Array:
        """How far the wrist is from axis 1, in mm, for axes ``(..., 6)``."""
        ...


def matrix_of(pose: Pose) -> Array:
    """A pose as an array of four by four."""
    return np.array(pose.matrix, dtype=np.float64)
