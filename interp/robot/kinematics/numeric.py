"""Numerical kinematics of a serial chain of up to six joints.

It serves arms without a central wrist, and arms that were described joint by joint. Inverse
kinematics is the Levenberg-Marquardt method with the damping of Sugihara (2011), from many start
positions at once. An arm with fewer than six joints reaches a pose only if the pose is compatible
with it, up to a rotation of `_OFF`.

Joints are in fractions of the size of the arm and radians.

Status and Turn are defined as for other arms, with axis 5 as the wrist. No source says how they are
defined for such arms (unconfirmed).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import LARGEST_STEP, Array, Kinematics, wrapped
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData, MachineDataError
from interp.values.faults import Fault

_STARTS = 96
_ROUNDS = 40
#: The largest step of a joint after which the next would change nothing but rounding: curves
#: through the samples of a path need their third differences.
_SETTLED = 1e-8
_LEAST_DAMPING = 1e-13
#: Radians by which an arm may miss an orientation, with six joints and with fewer.
_MET, _OFF = 1e-7, 0.002
_BESIDE = 0.01  # the fraction of the size by which it may miss a position then, for a radian
_COARSE = 32


class NumericKinematics(Kinematics):
    """The kinematics of one machine.

    Raises `MachineDataError` for a chain without joints, or with more than six.
    """

    def __init__(self, machine: MachineData) -> None:
        count = len(machine.chain.joints)
        if not 0 < count <= ROBOT_AXES:
            raise MachineDataError(f"a chain of {count} joints; 1 to 6 can be moved")
        super().__init__(machine)
        # with the 1 of each homogeneous matrix, so it is never 0
        self._size = float(np.linalg.norm(self._frames[..., 3], axis=1).sum())
        self._moves = (self._slides + self._turns).any(axis=1)
        self._units = np.where(self._linear, 1.0 / self._size, math.pi / 180.0)
        self._tolerance = _MET if self._moves.all() else _OFF
        self.elbow = self._stretched()

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Return the axes with those that do not move at 0.

        An incompatible orientation is handled in the solution.
        """
        return np.where(self._moves, np.asarray(axes, dtype=np.float64), 0.0)

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return the solutions found from starts spread at random over the range of the axes.

        Each may be found several times. The starts are always the same.
        """
        given = np.asarray(poses, dtype=np.float64)
        most = np.where(self._linear, self._size, 180.0)
        limits = np.array([(axis.lower, axis.upper) for axis in self.machine.axes])
        lower, upper = np.clip(limits.T, -most, most)
        starts = np.random.default_rng(0).uniform(lower, upper, (_STARTS, ROBOT_AXES))
        found = np.array([self._solve(pose, starts) for pose in given.reshape(-1, 1, 4, 4)])
        ways = np.where(self._linear, found, wrapped(found))
        return ways.reshape(*given.shape[:-2], _STARTS, ROBOT_AXES)

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.inverse_near`."""
        found = self._solve(poses, references)
        found[(np.abs(found - self.coupled(references)) > LARGEST_STEP).any(axis=1)] = math.nan
        return found

    def inverse_along(self, poses: Array, start: Sequence[float]) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.inverse_along`.

        It solves a few samples one after the other, then all samples between them at once.
        """
        places = np.unique(np.linspace(0, len(poses) - 1, _COARSE + 1).astype(int))
        before = np.array(start, dtype=np.float64)[None]
        known = np.empty((len(places), ROBOT_AXES))
        for row, place in enumerate(places):
            known[row] = before = _found(self.inverse_near(poses[place : place + 1], before))
        between = np.arange(len(poses))
        references = np.stack([np.interp(between, places, c) for c in known.T], axis=-1)
        return _found(self.inverse_near(poses, references))

    # ------------------------------------------------------------------------------- the solution

    def _solve(self, poses: Array, starts: Array) -> Array:
        """Return the axes ``(n, 6)`` that reach poses, from starts; NaN if not found."""
        joints = self.coupled(starts) * self._units
        for _ in range(_ROUNDS):
            missing, slopes = self._missing(poses, joints)
            damping = 0.5 * (missing**2).sum(axis=1) + _LEAST_DAMPING
            normal = slopes @ np.swapaxes(slopes, 1, 2) + damping[:, None, None] * np.eye(6)
            step = np.linalg.solve(normal, slopes @ missing[:, :, None])[:, :, 0]
            joints += step
            if np.abs(step).max(initial=0.0) < _SETTLED:
                break
        missing, _ = self._missing(poses, joints)
        beside, turned = (np.linalg.norm(part, axis=1) for part in np.split(missing, 2, axis=1))
        is_met = (beside <= _BESIDE * self._tolerance) & (turned <= self._tolerance)
        return np.where(is_met[:, None], joints / self._units, math.nan)

    def _missing(self, poses: Array, joints: Array) -> tuple[Array, Array]:
        """Return the errors ``(n, 6)`` of joints, and how each ``(n, joints, 6)`` changes the pose.

        An error is the way to a pose and the rotation vector to its orientation.
        """
        from scipy.spatial.transform import Rotation

        *frames, pose = self._frames_at(joints / self._units)
        at = np.stack(frames, axis=1)
        turn = Rotation.from_matrix(poses[:, :3, :3] @ np.swapaxes(pose[:, :3, :3], 1, 2))
        way = (poses[:, :3, 3] - pose[:, :3, 3]) / self._size
        slides, turns = (
            (at[..., :3, :3] @ axes[:, :, None])[..., 0] for axes in (self._slides, self._turns)
        )
        arms = (pose[:, None, :3, 3] - at[..., :3, 3]) / self._size
        shifts = slides + np.cross(turns, arms)
        return (
            np.concatenate((way, turn.as_rotvec()), axis=1),
            np.concatenate((shifts, turns), axis=2),
        )

    # ------------------------------------------------------------------------------- the geometry

    def _wrist(self, axes: Array) -> tuple[Array, Array]:
        """Return the place of axis 5, or of the last one; if that one slides, it moves with it."""
        turned = axes.copy()
        turned[..., 0] = 0.0
        wrist = np.linalg.inv(self._frames[0]) @ self._frames_at(turned)[4]
        return wrist[..., 0, 3], np.where(self._linear[0], math.inf, wrist[..., 1, 3])

    def _stretched(self) -> float:
        """Return the angle of A3 in degrees at which axis 5 is farthest from axis 2."""
        if self._linear[2]:
            return 0.0
        axes = np.zeros((3, ROBOT_AXES))
        axes[:, 2] = 90.0 * np.arange(3)
        frames = self._frames_at(axes)
        ahead, aside, back = ((frames[4] - frames[1])[:, :3, 3] ** 2).sum(axis=1)  # a sine wave
        return math.degrees(math.atan2(2.0 * aside - ahead - back, ahead - back))


def _found(path: Array) -> Array:
    if np.isnan(path).any():
        raise Fault("unreachable", "the path cannot be followed", number=1366)
    return path
