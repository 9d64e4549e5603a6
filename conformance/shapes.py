"""How far points are from a line, a circle or the arc of a blend, and points between samples.

Points are in mm, shape (n, 3). What is analytic here comes from the case, never from our planner.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["between", "from_arc", "from_circle", "from_line", "refined"]

Array = npt.NDArray[np.float64]

#: So many points stand for the arc of a blend: 0.001 mm apart from it for arcs of 1 m.
_POINTS = 4_001


def from_line(points: Array, start: Array, end: Array) -> Array:
    """The distance of each point from a line segment."""
    along = end - start
    length = float(along @ along)
    share = (
        np.clip((points - start) @ along / length, 0.0, 1.0) if length else np.zeros(len(points))
    )
    return np.asarray(np.linalg.norm(points - (start + share[:, None] * along), axis=1))


def from_circle(points: Array, first: Array, second: Array, third: Array) -> Array:
    """The distance of each point from the circle through three points."""
    one, other = second - first, third - first
    normal = np.cross(one, other)
    square = float(normal @ normal)
    if square < 1e-12:
        raise ValueError("three points on a line make no circle")
    towards = np.cross(normal, one) * float(other @ other) - np.cross(normal, other) * float(
        one @ one
    )
    centre = first + towards / (2 * square)
    radius = float(np.linalg.norm(first - centre))
    unit = normal / np.sqrt(square)
    height = (points - centre) @ unit
    flat = np.linalg.norm(points - centre - height[:, None] * unit, axis=1)
    return np.asarray(np.hypot(flat - radius, height))


def from_arc(points: Array, start: Array, corner: Array, end: Array) -> Array:
    """The distance of each point from the parabola that leaves and joins two lines at their corner.

    ``start`` and ``end`` are where it leaves the first line and joins the second.
    """
    share = np.linspace(0.0, 1.0, _POINTS)[:, None]
    arc = (1 - share) ** 2 * start + 2 * share * (1 - share) * corner + share**2 * end
    return np.array([np.linalg.norm(arc - point, axis=1).min() for point in points])


def between(times: npt.NDArray[np.int64], rows: Array, time: float) -> Array:
    """A row at a time, by the cubic through the four samples around it; the ends are kept."""
    if len(times) < 4:
        columns = [np.interp(time, times, rows[:, column]) for column in range(rows.shape[1])]
        return np.array(columns)
    at = int(np.clip(np.searchsorted(times, time) - 2, 0, len(times) - 4))
    known = times[at : at + 4].astype(np.float64)
    moment = float(np.clip(time, times[0], times[-1]))
    found = np.zeros(rows.shape[1])
    for one in range(4):
        others = [other for other in range(4) if other != one]
        weight = np.prod([(moment - known[o]) / (known[one] - known[o]) for o in others])
        found += weight * rows[at + one]
    return found


def refined(
    times: npt.NDArray[np.int64], rows: Array, start: float, end: float, count: int = 200
) -> Array:
    """Rows at so many times from one to another."""
    return np.array([between(times, rows, time) for time in np.linspace(start, end, count)])
