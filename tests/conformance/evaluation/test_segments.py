"""Distances of line segments from points, and whether they cross boxes."""

import numpy as np
import numpy.typing as npt
from hypothesis import given
from hypothesis import strategies as st

from conformance.evaluation.path_geometry import crosses_box, nearest

Array = npt.NDArray[np.float64]

COORDINATE = st.integers(-8, 8).map(float)
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE).map(np.array)


@given(POINT, POINT, POINT)
def test_the_nearest_of_a_segment_is_that_of_its_points(
    start: Array, end: Array, point: Array
) -> None:
    """No point of a segment is nearer, and one of many is nearly as near."""
    points = start + np.linspace(0, 1, 501)[:, None] * (end - start)
    sampled = np.linalg.norm(points - point, axis=1).min()
    found = float(nearest(start[None], end[None], point)[0])
    assert found <= sampled + 1e-9
    assert sampled <= found + np.linalg.norm(end - start) / 1000 + 1e-9


@given(POINT, POINT, POINT, POINT)
def test_a_segment_crosses_a_box_where_one_of_its_points_lies_inside(
    start: Array, end: Array, one: Array, other: Array
) -> None:
    """Faces do not count; a segment of one point counts as that point."""
    low, high = np.minimum(one, other), np.maximum(one, other)
    points = start + np.linspace(0, 1, 2401)[:, None] * (end - start)
    inside = bool(((points > low + 1e-9) & (points < high - 1e-9)).all(axis=1).any())
    assert inside <= bool(crosses_box(start[None], end[None], low, high)[0])
    grown = bool(((points > low - 1e-2) & (points < high + 1e-2)).all(axis=1).any())
    assert bool(crosses_box(start[None], end[None], low, high)[0]) <= grown
