"""The kinematics of an arm: what does not depend on how its inverse is solved.

Arrays are of float64: ``(..., 6)`` for axes in degrees (mm if linear), ``(..., 4, 4)`` for
homogeneous matrices with positions in mm. A pose is that of the flange relative to the robot's
foot, $ROBROOT; `interp.robot.kinematics.placement` computes it from a programmed point.
`interp.robot.kinematics.kinematics_choice.kinematics_of` chooses the class for a machine.
"""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.chain import Joint
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.values.poses import IDENTITY, Pose

Array = npt.NDArray[np.float64]

#: Degrees between two samples up to which a path counts as continuous.
LARGEST_STEP = 30.0
#: Degrees of A5 from which on a wrist with a singularity is clearly bent.
_BENT = 0.06
_BEHIND = 1e-7  # mm of rounding
_TURN = 1e-9  # degrees of rounding


class Kinematics(ABC):
    """Forward and inverse kinematics of a chain of up to six joints.

    ``elbow`` is the angle of A3 in degrees at which the arm is stretched, where bit 1 of S changes.
    """

    #: Whether A4 is undetermined if A5 is 0.
    has_wrist_singularity = False
    elbow: float

    def __init__(self, machine: MachineData) -> None:
        self.machine = machine
        joints, end = machine.chain.joints, machine.chain.end
        missing = (ROBOT_AXES - len(joints)) * [Joint("", IDENTITY)]
        frames = [joint.frame for joint in (*joints, *missing)]
        self._frames = np.array([matrix_of(frame) for frame in (*frames, end)])
        axes = np.zeros((ROBOT_AXES, 3))  # a joint that is missing moves along no axis
        axes[: len(joints)] = [joint.axis for joint in joints]
        if machine.palletising is not None:
            axes[3] = 0.0
        self._linear = np.array([joint.is_linear for joint in (*joints, *missing)])
        self._slides, self._turns = axes * self._linear[:, None], axes * ~self._linear[:, None]

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Return axes ``(..., 6)`` with those set that the mechanics of a palletiser determine."""
        return np.asarray(axes, dtype=np.float64)

    def about_tips(self, poses: Array, _tool: Array, /) -> Array:
        """Return poses ``(..., 4, 4)`` turned about the tip of a tool (4, 4) to be reachable."""
        return poses

    def forward(self, axes: npt.ArrayLike) -> Array:
        """Return poses of the flange, ``(..., 4, 4)``, for axes ``(..., 6)``."""
        return self._frames_at(self.coupled(axes))[-1]

    @abstractmethod
    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return solutions for poses ``(..., 4, 4)``: axes ``(..., solutions, 6)``, NaN for none.

        Angles are in (-180, 180] degrees, whatever the software limits.
        """

    @abstractmethod
    def inverse_near(self, poses: Array, references: Array) -> Array:
        """Return the solution with the configuration of a reference: axes ``(n, 6)``, NaN if none.

        ``poses`` are ``(n, 4, 4)``, ``references`` ``(n, 6)`` axes near the solution.
        """

    def inverse_along(self, poses: Array, start: Sequence[float]) -> Array | None:
        """Return continuous axes ``(n, 6)`` along a path, in the configuration of ``start``.

        ``poses`` are ``(n, 4, 4)``. Return ``None`` if that is not certain; then the path has to be
        followed sample by sample. Raises `interp.values.faults.Fault` 1366 if the path cannot be
        followed at all.
        """
        references = np.array(start, dtype=np.float64)
        found = self.inverse_near(poses, np.tile(references, (len(poses), 1)))
        if self.has_wrist_singularity and (np.abs(found[:, 4]) < _BENT).any():
            return None
        return continued(references, found)

    def status(self, axes: npt.ArrayLike) -> npt.NDArray[np.int64]:
        """Return bits 0 to 2 of the Status of axes ``(..., 6)`` [POS-03, POS-04, POS-05, CON-01].

        1 if the wrist is behind axis 1, 2 if A3 is not below `elbow`, 4 if A5 is negative.
        """
        given = self.coupled(axes)
        behind = self._wrist(given)[0] < -_BEHIND
        bent, negative = given[..., 2] >= self.elbow - _TURN, given[..., 4] < -_TURN
        status: npt.NDArray[np.int64] = behind + 2 * bent + 4 * negative
        return status

    def distance_to_axis_1(self, axes: npt.ArrayLike) -> Array:
        """Return the distance of the wrist from axis 1 in mm, for axes ``(..., 6)``."""
        distance: Array = np.hypot(*self._wrist(self.coupled(axes)))
        return distance

    @abstractmethod
    def _wrist(self, axes: Array) -> tuple[Array, Array]:
        """Return how far the wrist is in front of axis 1 and beside it, in mm, as A1 turns them."""

    def _frames_at(self, axes: Array) -> list[Array]:
        """Return the frames ``(..., 4, 4)`` of joints that have moved, and of the flange."""
        from scipy.spatial.transform import Rotation

        ways = axes[..., None]
        turns = Rotation.from_rotvec((ways * self._turns).reshape(-1, 3), degrees=True).as_matrix()
        moves = np.zeros((*axes.shape, 4, 4))
        moves[..., :3, :3] = turns.reshape(*axes.shape, 3, 3)
        moves[..., :3, 3] = ways * self._slides
        moves[..., 3, 3] = 1.0
        found = list(itertools.accumulate(np.moveaxis(self._frames[:-1] @ moves, -3, 0), np.matmul))
        return [*found, found[-1] @ self._frames[-1]]


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
