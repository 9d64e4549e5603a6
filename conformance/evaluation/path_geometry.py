"""Distances of points from lines, circles and blend arcs, and interpolation of samples.

Points are in mm, shape (n, 3). The analytic shapes come from the case, never from our planner.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

#: The usual tolerances: mm for the tool, degrees (mm if linear) for an axis.
TOLERANCE_MM: Final = 0.05
TOLERANCE_DEGREES: Final = 0.01
#: The largest factor by which rounding makes `change_rates` exceed speeds, accelerations and jerks.
RATE_MARGIN: Final = 1.0005

#: The number of points of a sampled blend arc; its error is 0.001 mm for arcs of 1 m.
_POINTS = 4_001
#: Degrees or mm below which an axis does not move.
_STILL = 1e-9


def from_line(points: Array, start: Array, end: Array) -> Array:
    """Return the distance of each point from a line segment."""
    along = end - start
    length = float(along @ along)
    share = (
        np.clip((points - start) @ along / length, 0.0, 1.0) if length else np.zeros(len(points))
    )
    return np.asarray(np.linalg.norm(points - (start + share[:, None] * along), axis=1))


def feet(
    starts: Array, ends: Array, point: Array, least: npt.ArrayLike = 0.0
) -> tuple[Array, Array]:
    """Return at which share of n line segments they are nearest to a point, and how far away.

    Ends have shape (n, columns). Shares lie between ``least`` and 1.
    """
    along = ends - starts
    squares = np.einsum("ij,ij->i", along, along)
    shares = np.einsum("ij,ij->i", point - starts, along) / np.where(squares > 0.0, squares, 1.0)
    shares = np.clip(shares, least, 1.0)
    return shares, np.asarray(np.linalg.norm(starts + shares[:, None] * along - point, axis=1))


def nearest(starts: Array, ends: Array, point: Array) -> Array:
    """Return the distance of a point from each of n line segments, with ends of shape (n, 3)."""
    return feet(starts, ends, point)[1]


def crosses_box(starts: Array, ends: Array, low: Array, high: Array) -> npt.NDArray[np.bool_]:
    """Return which line segments, with ends of shape (n, 3), have a point strictly inside a box.

    ``low`` and ``high`` are opposite corners of the box, whose edges are parallel to the axes.
    """
    along = ends - starts
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.stack(((low - starts) / along, (high - starts) / along))
    is_level = along == 0.0
    between_faces = (starts > low) & (starts < high)
    first = np.where(is_level, np.where(between_faces, 0.0, np.inf), shares.min(axis=0))
    last = np.where(is_level, np.where(between_faces, 1.0, -np.inf), shares.max(axis=0))
    begin, end = np.maximum(first.max(axis=1), 0.0), np.minimum(last.min(axis=1), 1.0)
    is_point = is_level.all(axis=1)
    return np.asarray((begin < end) | (is_point & between_faces.all(axis=1)))


def circle_of(first: Array, second: Array, third: Array) -> tuple[Array, Array]:
    """Return the centre of the circle through three points, and its axis as a unit vector.

    Seen from the tip of the axis, the circle runs counterclockwise. Raises `ValueError` for
    collinear points.
    """
    one, other = second - first, third - first
    normal = np.cross(one, other)
    square = float(normal @ normal)
    if square < 1e-12:
        raise ValueError("three points on a line make no circle")
    towards = np.cross(normal, one) * float(other @ other)
    towards -= np.cross(normal, other) * float(one @ one)
    return first + towards / (2 * square), normal / np.sqrt(square)


def from_circle(points: Array, first: Array, second: Array, third: Array) -> Array:
    """Return the distance of each point from the circle through three points."""
    centre, axis = circle_of(first, second, third)
    radius = float(np.linalg.norm(first - centre))
    height = (points - centre) @ axis
    flat = np.linalg.norm(points - centre - height[:, None] * axis, axis=1)
    return np.asarray(np.hypot(flat - radius, height))


def rotations(angles: Array) -> Array:
    """Return the rotations (n, 3, 3) of A, B and C in degrees (n, 3), as `Pose.of` [ARI-09]."""
    (sa, sb, sc), (ca, cb, cc) = np.sin(radians := np.radians(angles.T)), np.cos(radians)
    rows = (
        (ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc),
        (sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc),
        (-sb, cb * sc, cb * cc),
    )
    return np.moveaxis(np.array(rows), 2, 0)


def arc_length(points: Array) -> float:
    """Return the length of the arc along points (n, 3), by the circle that fits them best.

    Neighbours are less than half a turn apart; there may be several turns.
    """
    off = points - points.mean(axis=0)
    flat = off @ np.linalg.svd(off, full_matrices=False)[2][:2].T
    (x, y, rest), *_ = np.linalg.lstsq(
        np.column_stack((2.0 * flat, np.ones(len(flat)))), (flat**2).sum(axis=1), rcond=None
    )
    angles = np.unwrap(np.arctan2(flat[:, 1] - y, flat[:, 0] - x))
    return float(np.sqrt(rest + x**2 + y**2) * abs(angles[-1] - angles[0]))


def from_arc(points: Array, start: Array, corner: Array, end: Array) -> Array:
    """Return the distance of each point from the parabola of a blend between two lines.

    The parabola leaves the first line at ``start`` and joins the second at ``end``; ``corner`` is
    where the lines meet.
    """
    share = np.linspace(0.0, 1.0, _POINTS)[:, None]
    arc = (1 - share) ** 2 * start + 2 * share * (1 - share) * corner + share**2 * end
    return np.array([np.linalg.norm(arc - point, axis=1).min() for point in points])


def from_synchronous(axes: Array) -> float | None:
    """Return the largest deviation of axes from synchronous motion; ``None`` if none moves."""
    way = axes[-1] - axes[0]
    longest = int(np.argmax(np.abs(way)))
    if abs(way[longest]) < _STILL:
        return None
    share = (axes[:, longest] - axes[0, longest]) / way[longest]
    return float(np.abs(axes - axes[0] - share[:, None] * way).max())


def around(moment: float, unsure: float) -> Array:
    """Return the moments that a time may mean which is unsure by so much: 240 steps, if it is."""
    return np.linspace(moment - unsure, moment + unsure, 241 if unsure else 1)


def between(
    times: npt.NDArray[np.int64], rows: Array, moments: npt.ArrayLike, after: int = 0
) -> Array:
    """Return rows at other times, interpolated by the cubic through the four nearest samples.

    ``rows`` has shape (n, columns). The result has shape (moments, columns), or (columns,) for one
    moment. Moments outside are moved to the ends; the last cubic is extrapolated for ``after`` µs.
    """
    last = times[-1] + after
    wanted = np.clip(np.atleast_1d(np.asarray(moments, dtype=np.float64)), times[0], last)
    count = min(4, len(times))
    first = np.clip(np.searchsorted(times, wanted) - count // 2, 0, len(times) - count)
    found = np.zeros((len(wanted), rows.shape[1]))
    for one in range(count):
        weight = np.ones(len(wanted))
        for other in range(count):
            if other != one:
                gap = times[first + one] - times[first + other]
                weight *= (wanted - times[first + other]) / gap
        found += weight[:, None] * rows[first + one]
    return found[0] if np.ndim(moments) == 0 else found


def refined(
    times: npt.NDArray[np.int64], rows: Array, start: float, end: float, count: int = 200
) -> Array:
    """Return rows at ``count`` equidistant times from ``start`` to ``end``."""
    return between(times, rows, np.linspace(start, end, count))


def change_rates(times: npt.NDArray[np.int64], rows: Array) -> Array:
    """Return the difference quotients of rows per second, shape (n - 1, columns)."""
    return np.asarray(np.diff(rows, axis=0) / (np.diff(times)[:, None] / 1e6))


def rates_of(times: npt.NDArray[np.int64], rows: Array) -> list[Array]:
    """Return the speeds, accelerations and jerks between n rows: n - 1, n - 2 and n - 3."""
    speeds = change_rates(times, rows)
    gains = change_rates(times[1:], speeds)
    return [speeds, gains, change_rates(times[2:], gains)]


def lengths(points: Array) -> Array:
    """Return the length in mm along n points up to each of them."""
    return np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))


def drawn(kind: str, points: Array, count: int = 33) -> Array:
    """Return points along a ``line``, a ``circle`` or the arc of a ``blend``, for drawing.

    ``points`` define the shape, (2, 3) or (3, 3); a circle goes from the first through the second
    to the third.
    """
    share = np.linspace(0.0, 1.0, count)[:, None]
    if kind == "line":
        return np.asarray(points[0] + share * (points[1] - points[0]))
    if kind == "blend":
        start, corner, end = points
        arc = (1 - share) ** 2 * start + 2 * share * (1 - share) * corner + share**2 * end
        return np.asarray(arc)
    centre, normal = circle_of(*points)
    first = points[0] - centre
    sideways = np.cross(normal, first)
    turned = np.arctan2((points[2] - centre) @ sideways, (points[2] - centre) @ first)
    angle = share * (turned % (2 * np.pi))
    return np.asarray(centre + np.cos(angle) * first + np.sin(angle) * sideways)
