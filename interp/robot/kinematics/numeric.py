"""Numerical kinematics of a serial chain of up to six joints.

It serves arms without a central wrist, and arms that were described joint by joint. Inverse
kinematics is the Levenberg-Marquardt method with the damping of Sugihara (2011), from many start
positions at once. Lengths are scaled by the size of the arm. An arm with fewer than six joints
reaches a pose only if the pose is compatible with it, up to a rotation of `_OFF`.

Status and Turn are defined as for other arms, with axis 5 as the wrist. No source says how they are
defined for such arms (unconfirmed).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import LARGEST_STEP, Array, matrix_of, wrapped
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData, MachineDataError
from interp.values.faults import Fault

_STARTS = 96
_ROUNDS = 60
_NEAR_ROUNDS = 25
_HOPEFUL = 20, 0.05
"""A start is abandoned after so many rounds unless its error is below the second number."""
_MET = 1e-8
"""The norm of the error, in fractions of the size and radians, from which one step more reaches a
pose to rounding: curves through the samples of a path need their third differences."""
_LEAST_DAMPING = 1e-13
_OFF = 0.002  # radians by which an arm of fewer joints may miss an orientation
_TURN = 1e-9  # degrees of rounding
_COARSE = 32
_FAR = 1e9  # mm


class NumericKinematics:
    """The kinematics of one machine, as a `interp.robot.kinematics.kinematics.Kinematics`.

    Raises `MachineDataError` for a chain without joints, or with more than six.
    """

    has_wrist_singularity = False

    def __init__(self, machine: MachineData) -> None:
        chain = machine.chain
        if not 0 < len(chain.joints) <= ROBOT_AXES:
            raise MachineDataError(f"a chain of {len(chain.joints)} joints; 1 to 6 can be moved")
        self.machine = machine
        self._frames = [matrix_of(joint.frame) for joint in chain.joints]
        self._end = matrix_of(chain.end)
        self._directions = np.array([joint.axis for joint in chain.joints])
        linear = [joint.is_linear for joint in chain.joints]
        self._linear = np.array(linear)
        self._units = np.where(self._linear, 1.0, math.pi / 180.0)
        self._skews = [_skew(axis) for axis in self._directions]
        fixed = [False] * len(linear)
        if machine.palletising is not None:
            fixed[3] = True
        self._free = np.flatnonzero(~np.array(fixed))
        self._size = max(sum(float(np.linalg.norm(f[:3, 3])) for f in self._frames), 1.0)
        self._scale = np.where(self._linear, self._size, 1.0)[self._free]
        self.elbow = self._stretched()

    @property
    def _count(self) -> int:
        return len(self._frames)

    def coupled(self, axes: npt.ArrayLike) -> Array:
        """Return the axes with missing axes, and an axis 4 that is fixed, at 0."""
        found = np.zeros_like(np.asarray(axes, dtype=np.float64))
        found[..., self._free] = np.asarray(axes, dtype=np.float64)[..., self._free]
        return found

    def about_tips(self, poses: Array, _tool: Array, /) -> Array:
        """Return the poses as they are; an incompatible orientation is handled in the solution."""
        return poses

    def forward(self, axes: npt.ArrayLike) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.forward`."""
        given = self.coupled(axes)
        pose, _ = self._poses(given[..., : self._count] * self._units)
        return pose

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return the solutions found from starts spread over the range of the axes.

        Each may be found several times.
        """
        given = np.asarray(poses, dtype=np.float64)
        shape = given.shape[:-2]
        given = given.reshape(-1, 4, 4)
        starts = self._starts()
        found = np.full((len(given), len(starts), ROBOT_AXES), math.nan)
        for place, pose in enumerate(given):
            if (np.abs(pose) < _FAR).all():
                ends = self._solve(np.tile(pose, (len(starts), 1, 1)), starts, _ROUNDS)
                found[place] = self._wrapped(self._degrees(ends))
        return found.reshape(*shape, len(starts), ROBOT_AXES)

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.inverse_near`."""
        starts = self._held(references[:, : self._count]) * self._units
        found = self._degrees(self._solve(poses, starts, _NEAR_ROUNDS))
        lost = (np.abs(found - self.coupled(references)) > LARGEST_STEP).any(axis=1)
        found[lost] = math.nan
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

    def status(self, axes: npt.ArrayLike) -> npt.NDArray[np.int64]:
        """See `interp.robot.kinematics.kinematics.Kinematics.status`."""
        given = self.coupled(axes)
        behind = self._wrist(given)[..., 0] < -1e-7
        bent = given[..., 2] >= self.elbow - _TURN
        found: npt.NDArray[np.int64] = behind + 2 * bent + 4 * (given[..., 4] < -_TURN)
        return found

    def distance_to_axis_1(self, axes: npt.ArrayLike) -> Array:
        """See `interp.robot.kinematics.kinematics.Kinematics.distance_to_axis_1`."""
        distance: Array = np.hypot(*np.moveaxis(self._wrist(self.coupled(axes)), -1, 0)[:2])
        return distance if not self._linear[0] else np.full_like(distance, math.inf)

    # ------------------------------------------------------------------------------- the solution

    def _solve(self, poses: Array, starts: Array, rounds: int) -> Array:
        """Return joints ``(n, joints)`` in radians or mm that reach poses; NaN if not found."""
        theta = starts.copy()
        busy = np.arange(len(theta))
        error = np.full(len(theta), math.inf)
        for turn in range(rounds):
            pose, slopes = self._poses(theta[busy])
            missing = self._missing(poses[busy], pose)
            error[busy] = np.linalg.norm(missing, axis=1)
            is_left = error[busy] > _MET
            if turn >= _HOPEFUL[0]:
                is_left &= error[busy] < _HOPEFUL[1]
            damping = 0.5 * (missing**2).sum(axis=1) + _LEAST_DAMPING
            normal = np.swapaxes(slopes, 1, 2) @ slopes
            normal += damping[:, None, None] * np.eye(len(self._free))
            push = np.swapaxes(slopes, 1, 2) @ missing[:, :, None]
            step = np.linalg.solve(normal, push)[:, :, 0] * self._scale
            theta[np.ix_(busy, self._free)] += step
            busy = busy[is_left]
            if not len(busy):
                break
        theta[~self._is_met(poses, theta, error)] = math.nan
        return theta

    def _is_met(self, poses: Array, theta: Array, error: Array) -> npt.NDArray[np.bool_]:
        """Return which joints reach their poses; fewer than six have a larger tolerance."""
        if len(self._free) == ROBOT_AXES:
            return error <= _MET
        missing = self._missing(poses, self._poses(theta)[0])
        near = np.linalg.norm(missing[:, :3], axis=1) < _OFF * 1e-2
        met: npt.NDArray[np.bool_] = near & (np.linalg.norm(missing[:, 3:], axis=1) < _OFF)
        return met

    def _missing(self, wanted: Array, pose: Array) -> Array:
        """Return the errors of poses ``(n, 6)``: scaled lengths and rotation vectors in rad."""
        from scipy.spatial.transform import Rotation

        turn = wanted[:, :3, :3] @ np.swapaxes(pose[:, :3, :3], 1, 2)
        ways = (wanted[:, :3, 3] - pose[:, :3, 3]) / self._size
        return np.concatenate((ways, Rotation.from_matrix(turn).as_rotvec()), axis=1)

    def _poses(self, theta: Array) -> tuple[Array, Array]:
        """Return poses ``(..., 4, 4)`` of the flange, and their Jacobian for the free joints.

        The Jacobian is ``(..., 6, free)``; lengths in it, and linear joints, are scaled by the size
        of the arm.
        """
        pose = np.broadcast_to(np.eye(4), (*theta.shape[:-1], 4, 4)).copy()
        origins, axes = [], []
        for place, frame in enumerate(self._frames):
            pose = pose @ frame
            axes.append(pose[..., :3, :3] @ self._directions[place])
            origins.append(pose[..., :3, 3])
            pose = pose @ self._move(place, theta[..., place])
        pose = pose @ self._end
        turns = np.stack([axes[place] for place in self._free], axis=-1)
        arms = pose[..., :3, 3:] - np.stack([origins[place] for place in self._free], axis=-1)
        shifts = np.empty_like(arms)  # the cross products of turns and arms
        for row, (one, other) in enumerate(((1, 2), (2, 0), (0, 1))):
            shifts[..., row, :] = (
                turns[..., one, :] * arms[..., other, :] - turns[..., other, :] * arms[..., one, :]
            )
        is_linear = self._linear[self._free]
        slopes = np.concatenate(
            (
                np.where(is_linear, turns, shifts / self._size),
                np.where(is_linear, 0.0, turns),
            ),
            axis=-2,
        )
        return pose, slopes

    def _move(self, place: int, way: Array) -> Array:
        """Return transforms ``(..., 4, 4)`` of a joint that slides, or turns (Rodrigues' formula).

        ``way`` is in mm or radians.
        """
        move = np.broadcast_to(np.eye(4), (*way.shape, 4, 4)).copy()
        if self._linear[place]:
            move[..., :3, 3] = way[..., None] * self._directions[place]
        else:
            skew, angle = self._skews[place], way[..., None, None]
            turn = np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * (skew @ skew)
            move[..., :3, :3] = turn
        return move

    def _starts(self) -> Array:
        """Return starts spread evenly over the joint ranges (the R sequence, Roberts 2018)."""
        count = self._count
        golden = 1.5
        for _ in range(40):
            golden = (1.0 + golden) ** (1.0 / (count + 1))
        shares = np.outer(np.arange(_STARTS), golden ** -np.arange(1, count + 1)) + 0.5
        axes = self.machine.axes[:count]
        lower = np.array([_bound(axis.lower, -1.0, self._linear[i]) for i, axis in enumerate(axes)])
        upper = np.array([_bound(axis.upper, 1.0, self._linear[i]) for i, axis in enumerate(axes)])
        starts: Array = self._held(lower + (shares % 1.0) * (upper - lower)) * self._units
        return starts

    def _held(self, joints: Array) -> Array:
        """Return joints ``(n, joints)`` with the fixed ones set to 0."""
        found = np.zeros_like(joints)
        found[:, self._free] = joints[:, self._free]
        return found

    def _degrees(self, theta: Array) -> Array:
        """Return axes ``(n, 6)`` in degrees or mm."""
        axes = np.zeros((len(theta), ROBOT_AXES))
        axes[:, : self._count] = theta / self._units
        axes[np.isnan(theta).any(axis=1)] = math.nan
        return axes

    def _wrapped(self, axes: Array) -> Array:
        """Return axes with angles in (-180, 180] degrees."""
        turning = np.append(~self._linear, [False] * (ROBOT_AXES - self._count))
        return np.where(turning, wrapped(axes), axes)

    # ------------------------------------------------------------------------------- the geometry

    def _wrist(self, axes: Array) -> Array:
        """Return the place of axis 5, or of the last one, relative to axis 1 turned by A1.

        If that one slides, its place moves with it.
        """
        theta = axes[..., : self._count] * self._units
        pose = np.broadcast_to(np.eye(4), (*theta.shape[:-1], 4, 4)).copy()
        for place in range(1, min(5, self._count)):
            pose = pose @ self._frames[place] @ self._move(place, theta[..., place])
        found: Array = pose[..., :3, 3]
        return found

    def _stretched(self) -> float:
        """Return the angle of A3 in degrees at which axis 5 is farthest from axis 2."""
        if self._count < 4 or self._linear[1:4].any():
            return 0.0
        beyond = self._frames[3]
        if self._count > 4:
            beyond = beyond @ self._frames[4]
        ahead, back = beyond[:3, 3], -(self._frames[2][:3, :3].T @ self._frames[2][:3, 3])
        axis = self._directions[2]
        ahead, back = ahead - axis * (axis @ ahead), back - axis * (axis @ back)
        return math.degrees(math.atan2(-(back @ np.cross(axis, ahead)), -(back @ ahead)))


def _found(path: Array) -> Array:
    if np.isnan(path).any():
        raise Fault("unreachable", "the path cannot be followed", number=1366)
    return path


def _skew(axis: Array) -> Array:
    x, y, z = axis
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _bound(value: float, sign: float, is_linear: bool) -> float:
    """Return a limit of the range of starts: at most half a turn, or 1 m, from zero."""
    most = 1000.0 if is_linear else 180.0
    return value if abs(value) < most or (is_linear and math.isfinite(value)) else sign * most
