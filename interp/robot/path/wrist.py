"""$ORI_TYPE #JOINT: the tool follows its path while the wrist axes are linear in u [ORI-01].

Axes 4 to 6 move linearly from their values at the start to those at the end, so a straight wrist is
no problem [ORI-03]. Axes 1 to 3 then have to bring the tool to its position, which Newton's method
solves.
"""

from __future__ import annotations

import numpy as np

from interp.robot.kinematics.kinematics import Array, Kinematics
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solution_choice import ptp_target
from interp.robot.path.axis_path import AxisPath, PosePathCurve
from interp.robot.path.pose_path import PosePath, poses_of
from interp.values.faults import Fault
from interp.values.poses import Pose

_MAIN = 3
_STEP = 1e-5  # degrees
_EXACT = 1e-9  # mm
_CLOSE = 1e-6
_LONGEST = 20.0  # degrees of one Newton step
_ROUNDS = 30


class WristCurve(PosePathCurve):
    """The axes along the positions of a path, with the orientation that results from the wrist.

    Raises `Fault` 2829 if the end cannot be reached in the configuration of the start.
    """

    def __init__(
        self,
        arm: Kinematics,
        placement: Placement,
        pose_path: PosePath,
        start: Array,
        others: AxisPath,
    ) -> None:
        (end,) = poses_of(pose_path, np.ones(1))
        try:
            there = placement.at(others.end.tolist())
            flange = there.flange(Pose.from_matrix(end.tolist()))
            goal = ptp_target(arm, flange, start.tolist(), tool=placement.tool)
        except Fault as error:
            text = "start and end have different configurations, which #JOINT does not allow"
            raise Fault("configuration", text, number=2829, rules=("ORI-03",)) from error
        self._from, self._to = start, np.array(goal.axes)
        super().__init__(arm, placement, pose_path, start, others)
        #: ``None``: the orientation is not that of the path, so only the axes can be blended.
        self.pose_path = None

    def _axes_along(self, u: Array, start: Array) -> Array:
        return self._exact_axes(u, start + u[:, None] * (self._to - self._from))

    def _exact_axes(self, u: Array, references: Array) -> Array:
        axes = references.copy()
        positions, _ = self.tool_path.at(u)
        before = self._chains_before(u)
        wanted = (before[..., :3, :3] @ positions[:, :, None])[:, :, 0] + before[..., :3, 3]
        shifts = np.vstack((np.zeros((1, 6)), _STEP * np.eye(6)[:_MAIN]))
        for _ in range(_ROUNDS):
            here, *beside = self._tool_at(axes + shifts[:, None])
            missing = wanted - here
            if np.abs(missing).max() < _EXACT:
                break
            slopes = np.moveaxis(np.array(beside) - here, 0, -1) / _STEP
            try:
                step = np.linalg.solve(slopes, missing[:, :, None])[:, :, 0]
            except np.linalg.LinAlgError:
                break
            axes[:, :_MAIN] += np.clip(step, -_LONGEST, _LONGEST)
        if np.abs(missing).max() > _CLOSE:
            raise Fault("unreachable", "the path cannot be followed", number=1366)
        return axes

    def _tool_at(self, axes: Array) -> Array:
        places: Array = self.arm.forward(axes)[..., :3, :] @ self._tool[:, 3]
        return places
