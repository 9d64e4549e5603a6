"""The camera of a video, and the path of the flange as it sees it. Lengths are in metres.

The camera looks at the arm from a fixed direction. Columns count to the right and rows downwards
from the upper left corner of the frame, in pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

#: The direction in which the camera looks, in degrees, as MuJoCo has it.
AZIMUTH: Final = 135.0
ELEVATION: Final = -20.0

_MARGIN = 1.1
_PEN = np.array(((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)))  # draws lines of three pixels

Points = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.int64]


def _axes() -> Points:
    azimuth, elevation = math.radians(AZIMUTH), math.radians(ELEVATION)
    level = math.cos(elevation)
    ahead = (level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation))
    right = (math.sin(azimuth), -math.cos(azimuth), 0.0)
    return np.array((right, np.cross(right, ahead), ahead))


_AXES = _axes()  # right, up and ahead


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera in a ``distance`` from the point ``lookat`` in the middle of its frame.

    ``size`` is width and height of the frame in pixels, ``focal`` the number of pixels for 1 m in
    a distance of 1 m. What is nearer than ``near`` or farther than ``far`` is not drawn.
    """

    lookat: Points
    distance: float
    size: tuple[int, int]
    focal: float
    near: float
    far: float

    def seen(self, points: Points) -> tuple[Points, Points, Points]:
        """Return columns and rows of points, (n, 3), and their depths as OpenGL has them."""
        across, up, deep = _AXES @ (points - self.lookat).T
        distance = deep + self.distance
        columns = self.size[0] / 2 + self.focal * across / distance
        rows = self.size[1] / 2 - self.focal * up / distance
        return columns, rows, (1 / self.near - 1 / distance) / (1 / self.near - 1 / self.far)


def camera_of(
    points: Points,
    radii: Points,
    size: tuple[int, int],
    field: float,
    limits: Points,
) -> Camera:
    """Return a camera whose frame spheres around points, (n, 3), fit into as closely as possible.

    ``field`` is the angle in radians that the height of the frame covers, ``limits`` are ``near``
    and ``far``.
    """
    across, up, deep = _AXES @ points.T
    tall, middle = math.tan(field / 2) / _MARGIN, deep.mean()
    centre, distances = [], []
    for values, slope in ((across, tall * size[0] / size[1]), (up, tall)):
        reach = radii * math.hypot(1.0, slope)
        high = (values + reach - slope * deep).max()  # planes that touch both sides
        low = (values - reach + slope * deep).min()
        centre.append((high + low) / 2)
        distances.append(middle + (high - low) / (2 * slope))
    lookat = np.array((*centre, middle)) @ _AXES
    return Camera(lookat, max(distances), size, size[1] / (2 * tall * _MARGIN), *limits)


@dataclass(frozen=True, slots=True)
class SeenPath:
    """The pixels of a line, and how many of them come before each point of the line."""

    rows: Numbers
    columns: Numbers
    depths: Points
    counts: Numbers

    def between(self, start: int, end: int) -> tuple[Numbers, Numbers, Points]:
        """Return rows, columns and depths of what points from ``start`` to before ``end`` add."""
        new = slice(self.counts[start], self.counts[end])
        return self.rows[new], self.columns[new], self.depths[new]


def path_seen(camera: Camera, points: Points) -> SeenPath:
    """Return the line through points, (n, 3), three pixels wide."""
    columns, rows, depths = camera.seen(points)
    lengths = np.cumsum(np.hypot(*(np.diff(one, prepend=one[:1]) for one in (columns, rows))))
    along = np.arange(0.0, lengths[-1] + 0.5, 0.5)  # no pixel is left out
    drawn = []
    for values, offsets, limit in zip((columns, rows), _PEN.T, camera.size, strict=True):
        found = np.floor(np.interp(along, lengths, values)).astype(np.int64)
        drawn.append(np.clip(found[:, None] + offsets, 0, limit - 1).ravel())
    counts = np.searchsorted(along, lengths, side="right") * len(_PEN)
    return SeenPath(
        drawn[1],
        drawn[0],
        np.interp(along, lengths, depths).repeat(len(_PEN)),
        np.concatenate([[0], counts]),
    )
