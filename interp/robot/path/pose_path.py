"""Paths of poses, relative to the frame in which they are programmed.

A path is pure geometry. Its parameter u runs from 0 to 1 and is proportional to the path length,
except in blends and splines. `interp.robot.path.axis_path` computes the axes along a path.
Positions are in mm, arrays ``(n, 3)``; rotations are ``(n, 3, 3)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.path.orientation import Orientation
from interp.robot.path.transition import Transition

#: The fewest parameters at which a path is sampled: what a blend does changes quickly.
GRID = np.linspace(0.0, 1.0, 65)


class PathShape(Protocol):
    """A path of points."""

    @property
    def length(self) -> float:
        """The length of the path in mm."""
        ...

    def at(self, u: Array) -> Array:
        """Return positions at parameters ``(n,)``."""
        ...

    def tangents(self, u: Array) -> Array:
        """Return the derivatives of the positions by u in mm."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A straight line."""

    start: Array
    end: Array

    @property
    def length(self) -> float:
        """See `PathShape.length`."""
        return float(np.linalg.norm(self.end - self.start))

    def at(self, u: Array) -> Array:
        """See `PathShape.at`."""
        points: Array = self.start + u[:, None] * (self.end - self.start)
        return points

    def tangents(self, u: Array) -> Array:
        """See `PathShape.tangents`."""
        tangents: Array = np.zeros((len(u), 3)) + (self.end - self.start)
        return tangents


@dataclass(frozen=True, slots=True, eq=False)
class OrientedPath:
    """A path of points, and the orientation along it."""

    shape: PathShape
    orientation: Orientation

    @property
    def length(self) -> float:
        """The length of the path in mm."""
        return self.shape.length

    @property
    def angles(self) -> tuple[float, float]:
        """The angles by which the tool swivels, and turns about its direction, in radians."""
        return self.orientation.swivel, self.orientation.rotation

    def at(self, u: Array) -> tuple[Array, Array]:
        """Return positions and rotations at parameters ``(n,)``."""
        return self.shape.at(u), self.orientation.at(u)

    def tangents(self, u: Array) -> Array:
        """Return the derivatives of the positions by u in mm."""
        return self.shape.tangents(u)


@dataclass(frozen=True, slots=True, eq=False)
class Blend:
    """A blend from one path into the next, around the point P between them [BLD-12].

    It is ``first(one(u)) - P + second(other(u))``, and likewise for rotations. A blend between
    straight lines lies in their plane.
    """

    first: PosePath
    second: PosePath
    transition: Transition

    def at(self, u: Array) -> tuple[Array, Array]:
        """See `OrientedPath.at`."""
        one, other = self.transition.at(u)
        (*before, corner), (*turned, turn) = self.first.at(np.append(one, 1.0))
        behind, onward = self.second.at(other)
        rotations: Array = np.array(turned) @ turn.T @ onward
        return np.array(before) - corner + behind, rotations

    def tangents(self, u: Array) -> Array:
        """See `OrientedPath.tangents`."""
        one, other = self.transition.at(u)
        (leaving, *_), (joining, *_) = self.transition.rates(u)
        before = leaving[:, None] * self.first.tangents(one)
        tangents: Array = before + joining[:, None] * self.second.tangents(other)
        return tangents


PosePath = OrientedPath | Blend


def poses_of(pose_path: PosePath, u: Array) -> Array:
    """Return the poses at parameters ``(n,)`` as homogeneous matrices ``(n, 4, 4)``."""
    poses = np.zeros((len(u), 4, 4))
    poses[:, :3, 3], poses[:, :3, :3] = pose_path.at(u)
    poses[:, 3, 3] = 1.0
    return poses
