"""The interface of the kinematics of an arm, whatever its structure.

Arrays are of float64: ``(..., 6)`` for axes in degrees (mm if linear), ``(..., 4, 4)`` for
homogeneous matrices with positions in mm. A pose is that of the flange relative to the robot's
foot, $ROBROOT; `interp.robot.kinematics.placement` computes it from a programmed point.
`interp.robot.kinematics.kinematics_choice.kinematics_of` chooses the class for a machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.machine_data import MachineData
from interp.values.poses import Pose

Array = npt.NDArray[np.float64]

#: Degrees between two samples up to which a path counts as continuous.
LARGEST_STEP = 30.0


class Kinematics(Protocol):
    """Forward and inverse kinematics of an arm."""

    @property
    def machine(self) -> MachineData:
        """The machine data of the arm."""
        ...

    @property
    def elbow(self) -> float:
        """The angle of A3 in degrees at which the arm is stretched, where bit 1 of S changes."""
        ...

    @property
    def has_wrist_singularity(self) -> bool:
        """Whether A4 is undetermined if A5 is 0."""
        ...

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Return axes ``(..., 6)`` with those set that the mechanics of a palletiser determine."""
        ...

    def about_tips(self, poses: Array, tool: Array, /) -> Array:
        """Return poses ``(..., 4, 4)`` turned about the tip of a tool (4, 4) to be reachable."""
        ...

    def forward(self, axes: npt.ArrayLike) -> Array:
        """Return poses of the flange, ``(..., 4, 4)``, for axes ``(..., 6)``."""
        ...

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return solutions for poses ``(..., 4, 4)``: axes ``(..., solutions, 6)``, NaN for none.

        Angles are in (-180, 180] degrees, whatever the software limits.
        """
        ...

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """Return the solution with the configuration of a reference: axes ``(n, 6)``, NaN if none.

        ``poses`` are ``(n, 4, 4)``, ``references`` ``(n, 6)`` axes near the solution.
        """
        ...

    def inverse_along(self, poses: Array, start: Sequence[float]) -> Array | None:
        """Return continuous axes ``(n, 6)`` along a path, in the configuration of ``start``.

        ``poses`` are ``(n, 4, 4)``. Return ``None`` if that is not certain; then the path has to be
        followed sample by sample. Raises `interp.values.faults.Fault` 1366 if the path cannot be
        followed at all.
        """
        ...

    def status(self, axes: npt.ArrayLike) -> npt.NDArray[np.int64]:
        """Return bits 0 to 2 of the Status of axes ``(..., 6)`` [POS-03, POS-04, POS-05]."""
        ...

    def distance_to_axis_1(self, axes: npt.ArrayLike) -> Array:
        """Return the distance of the wrist from axis 1 in mm, for axes ``(..., 6)``."""
        ...


def nearest_turns(axes: Array, references: Array) -> Array:
    """Return axes in degrees with full turns added so that each is nearest to its reference."""
    near: Array = axes + 360.0 * np.round((references - axes) / 360.0)
    return near


def wrapped(axes: Array) -> Array:
    """Return axes in (-180, 180] degrees."""
    near: Array = axes - 360.0 * np.ceil((axes - 180.0) / 360.0)
    return near


def continued(start: Array, path: Array) -> Array | None:
    """Return a path ``(n, 6)`` in degrees with full turns added so that it continues ``start``.

    Return ``None`` if an axis makes too large a step for that to be certain.
    """
    whole = np.unwrap(np.concatenate((start[None], path)), period=360.0, axis=0)
    return whole[1:] if bool((np.abs(np.diff(whole, axis=0)) < LARGEST_STEP).all()) else None


def matrix_of(pose: Pose) -> Array:
    """Return a pose as a homogeneous matrix, (4, 4)."""
    return np.array(pose.matrix, dtype=np.float64)
