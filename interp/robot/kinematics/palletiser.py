"""Palletisers: arms with four or five axes, whose axis 4 is fixed at 0 [$DEF_A4FIX, $DEF_A5LINK].

The flange axis then lies in the vertical plane of the arm, so not every pose can be reached. The
tip of the tool is reached exactly, and its orientation is turned by the smallest angle that brings
the flange axis into that plane. With $DEF_A5LINK a parallelogram keeps the flange level, and A5
follows from A2 and A3. That a controller treats orientations in this way is unconfirmed;
$ORI_CHECK, which would make it check them, is 0 as delivered.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.central_wrist import CentralWrist
from interp.robot.kinematics.kinematics import Array, nearest_turns
from interp.robot.kinematics.machine_data import MachineData, MachineDataError, Palletising

_SOLUTIONS = 4
_TOLERANCE = 1e-9  # mm, or of a cosine
#: Length of the projection of the flange axis on the arm's plane, below which it is undefined.
_FLAT = 1e-6
_ROUNDS = 100  # more than a few are needed only near axis 1
_BESIDE = 1e-6  # mm by which the tip may be missed


class Palletiser(CentralWrist):
    """The kinematics of a palletiser.

    Raises `MachineDataError` if the wrist or flange is not in the plane of the arm.
    """

    has_wrist_singularity = False

    def __init__(self, machine: MachineData) -> None:
        super().__init__(machine)
        self._check_plane()
        self._is_linked = machine.palletising is Palletising.LINKED_A5
        self._from_inner, self._after = self._frames[0], self._frames[-1, :3, :3]
        twist = math.copysign(1.0, machine.dh_4.alpha)
        self._guides = -twist * machine.axes[4].direction, float(machine.axes[5].direction)
        forward, _, down = (-part for part in machine.tx3p3.rows[2][:3])
        self._level = math.degrees(math.atan2(forward, down))  # of axis 5, with A2 and A3 at 0
        self._pitch = -machine.tx3p3.rows[1][1] * np.array(
            [axis.direction for axis in machine.axes[1:3]]
        )

    def _check_plane(self) -> None:
        forearm, flange = self.machine.tx3p3, self.machine.tflwp
        aside = abs(forearm.position[1]), math.hypot(*flange.position[:2])
        turned = abs(forearm.rows[1][1]), flange.rows[2][2]
        if max(*aside, *(abs(cosine - 1.0) for cosine in turned)) > _TOLERANCE:
            raise MachineDataError(
                "the flange of a palletiser does not lie in the plane of the arm"
            )

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Return the axes with A4 at 0, and with a parallelogram A5 as it is guided."""
        found = np.array(axes, dtype=np.float64)
        found[..., 3] = 0.0
        if self._is_linked:
            pitch = found[..., 1:3] @ self._pitch
            found[..., 4] = (self._level + pitch) * self._guides[0]
        return found

    def about_tips(self, poses: Array, tool: Array, /) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.about_tips`.

        The plane of the flange depends on its position, and the position on its orientation, so the
        solution is a fixed-point iteration. NaN if it does not converge, above axis 1.
        """
        tip = tool[:3, 3]
        reached = self._reachable(poses)
        if not tip.any():
            return reached
        tips = poses[..., :3, :3] @ tip + poses[..., :3, 3]
        for _ in range(_ROUNDS):
            moved = poses.copy()
            moved[..., :3, 3] = tips - reached[..., :3, :3] @ tip
            off = np.linalg.norm(moved[..., :3, 3] - reached[..., :3, 3], axis=-1)
            reached = self._reachable(moved)
            if not (off > _TOLERANCE).any():
                break
        reached[off > _BESIDE] = math.nan
        return reached

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return four solutions, which differ in shoulder and elbow; A4 is 0 in all of them."""
        reached = self._reachable(np.asarray(poses, dtype=np.float64))
        main = super().inverse(reached)[..., :_SOLUTIONS, :3]
        return self._with_wrist(main, reached[..., None, :, :])

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.inverse_near`."""
        reached = self._reachable(poses)
        main = super().inverse_near(reached, references)[:, :3]
        found = self._with_wrist(main, reached)
        return nearest_turns(found, references)

    # ------------------------------------------------------------------------------- the geometry

    def _with_wrist(self, main: Array, poses: Array) -> Array:
        """Return axes ``(..., 6)`` for main axes ``(..., 3)`` and poses reachable with A4 at 0."""
        axes = np.zeros((*main.shape[:-1], 6))
        axes[..., :3] = main
        wanted = self._to_inner[:3, :3] @ poses[..., :3, :3] @ self._after.T
        unturned = self._to_inner[:3, :3] @ self._frames_at(axes)[-1][..., :3, :3] @ self._after.T
        wrist = np.swapaxes(unturned, -1, -2) @ wanted
        a5 = np.arctan2(wrist[..., 0, 2], wrist[..., 2, 2])
        a6 = np.arctan2(wrist[..., 1, 0], wrist[..., 1, 1])
        axes[..., 4] = np.degrees(a5) * self._guides[0]
        axes[..., 5] = np.degrees(a6) * self._guides[1]
        axes[..., 3] = np.where(np.isnan(main[..., 0]), math.nan, 0.0)
        return axes

    def _reachable(self, poses: Array) -> Array:
        """Return poses ``(..., 4, 4)`` with the flange axis turned into the plane of the arm.

        NaN if the flange axis is perpendicular to that plane.
        """
        inner = self._to_inner @ poses
        axis = inner[..., :3, 2]
        if self._is_linked:
            wanted = np.broadcast_to(np.array([0.0, 0.0, -1.0]), axis.shape)
        else:
            x, y = inner[..., 0, 3], inner[..., 1, 3]
            is_on_axis = np.hypot(x, y) < _FLAT
            turn = np.arctan2(y, x)
            normal = np.stack((-np.sin(turn), np.cos(turn), np.zeros_like(turn)), axis=-1)
            wanted = axis - (axis * normal).sum(axis=-1, keepdims=True) * normal
            wanted[is_on_axis, :2] = 0.0  # in every such plane
        length = np.linalg.norm(wanted, axis=-1, keepdims=True)
        with np.errstate(invalid="ignore", divide="ignore"):
            wanted = np.where(length < _FLAT, math.nan, wanted / length)
            turned = _least_turn(axis, wanted) @ inner[..., :3, :3]
        inner = inner.copy()
        inner[..., :3, :3] = turned
        reached: Array = self._from_inner @ inner
        return reached


def _least_turn(before: Array, after: Array) -> Array:
    """Return the rotations ``(..., 3, 3)`` of smallest angle that map unit vectors to others.

    NaN for opposite vectors.
    """
    from scipy.spatial.transform import Rotation

    cross = np.cross(before, after)
    cosine = (before * after).sum(axis=-1, keepdims=True)
    sine = np.linalg.norm(cross, axis=-1, keepdims=True)
    angle = np.where(cosine > _FLAT - 1.0, np.arctan2(sine, cosine), math.nan)
    vectors = cross * np.divide(angle, sine, out=angle.copy(), where=sine > 0.0)
    turn: Array = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return turn.reshape(*before.shape, 3)
