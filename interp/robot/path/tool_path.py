"""Where the tool is along a curve, how it moves and how far it travels.

With a fixed tool ($IPO_MODE = #TCP, an external TCP), it is the workpiece that moves.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from interp.robot.kinematics.kinematics import Array, matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.placement import IpoMode
from interp.robot.path.arc_length import ArcLength
from interp.robot.path.axis_path import Curve

_NEAR = 1e-4  # of u: half the width of a central difference


def tool_positions(curve: Curve, u: Array) -> Array:
    """Return the tool relative to the base in mm, ``(n, 3)``; for a fixed tool, the reverse."""
    if curve.pose_path is not None:
        return curve.pose_path.at(u)[0]
    axes = curve.axes(u)
    flanges = curve.arm.forward(axes[:, :ROBOT_AXES])
    placement = curve.placement
    base = placement.chains_before(axes[:, ROBOT_AXES:])
    tool = flanges @ matrix_of(placement.tool)
    if placement.mode is IpoMode.TCP:
        base, tool = tool, base
    positions: Array = (np.linalg.inv(base) @ tool)[:, :3, 3]
    return positions


def tool_tangents(curve: Curve, u: Array) -> Array:
    """Return the derivatives of the tool positions by u in mm, ``(n, 3)``."""
    if curve.pose_path is not None:
        return curve.pose_path.tangents(u)
    middle = np.clip(u, _NEAR, 1.0 - _NEAR)
    both = tool_positions(curve, np.concatenate((middle - _NEAR, middle + _NEAR)))
    tangents: Array = (both[len(u) :] - both[: len(u)]) / (2.0 * _NEAR)
    return tangents


@lru_cache(maxsize=32)
def tool_way(curve: Curve) -> ArcLength:
    """Return the distance in mm that the tool travels along a curve from u = 0 on."""
    return ArcLength(lambda u: tool_tangents(curve, u))
