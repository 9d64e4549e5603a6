"""CONST_VEL and TIME_BLOCK: parts of a spline block with constant speed or with a given duration.

The start or end of a range is given in mm from the end of the next segment, or from its start
[SPL-07].
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from interp.port.requests import SplineRange
from interp.robot.arm import Motion
from interp.robot.kinematics.kinematics import Array
from interp.robot.path.pose_path import OrientedPath
from interp.robot.path.speed_profile import SpeedProfile
from interp.robot.planning.junctions import AT_REST, SAME_CURVE, STOP, JoinedStretch
from interp.robot.planning.limits import CurveLimits, Stretch
from interp.robot.planning.schedule import schedule
from interp.robot.planning.tracks import Piece
from interp.values.faults import Fault

_ROUNDS = 60
#: Relative difference below which speeds or durations count as equal.
_SAME = 1e-6

Pieces = tuple[Piece, ...]
#: The number of the segment before which a START, PART or END of a range is written, and that.
_Mark = tuple[int, SplineRange]


def with_ranges(motion: Motion, pieces: Pieces) -> Pieces:
    """Return the pieces of a block with the speeds that its ranges require.

    Raises `Fault`: 3214 if the programmed speed cannot be kept in a range of constant speed, 3215
    if the arm stops in it, 3216 or 3217 if the path before or after it is too short to accelerate
    or brake [SPL-05]; and if a block has both kinds of ranges [SPL-10].
    """
    marks = list(_marks(motion))
    keywords = {mark.keyword for _, mark in marks}
    if not keywords:
        return pieces
    if len(keywords) > 1:
        text = "CONST_VEL and TIME_BLOCK exclude each other in a spline block"
        raise Fault("spline", text, rules=("SPL-10",))
    if keywords == {"CONST_VEL"}:
        return _constant(pieces, marks)
    return _timed(pieces, marks)


def _marks(motion: Motion) -> Iterator[_Mark]:
    every = [*(part.ranges for part in motion.parts), motion.ranges]
    yield from ((number, mark) for number, marks in enumerate(every) for mark in marks)


# ------------------------------------------------------------------------------- constant speed


def _constant(pieces: Pieces, marks: Sequence[_Mark]) -> Pieces:
    ends = np.cumsum([0.0, *(_length(piece) for piece in pieces)])
    programmed = [
        _length(piece) * min(stretch.programmed for stretch in piece.limits.stretches)
        for piece in pieces
    ]
    start: float | None = None
    for number, mark in marks:
        segment = min(number + (not mark.on_start), len(pieces))
        place = float(np.clip(ends[segment] + (mark.value or 0.0), 0.0, ends[-1]))
        if mark.edge == "START":
            start = place
        elif start is not None:
            pieces = _kept(pieces, programmed, ends, start, place)
            start = None
    if start is None:
        return pieces
    return _kept(pieces, programmed, ends, start, float(ends[-1]))


def _kept(
    pieces: Pieces, programmed: Sequence[float], ends: Array, start: float, end: float
) -> Pieces:
    """Return the pieces with one speed between two positions along the path.

    It is the lowest of those that the program gives these pieces, whatever other ranges made of it.
    """
    inside = [
        number
        for number in range(len(pieces))
        if ends[number + 1] > start and ends[number] < end and not pieces[number].is_still
    ]
    if not inside or end <= start:
        return pieces
    if any(pieces[number].junction == STOP and ends[number] > start for number in inside):
        raise _broken(3215, "the speed falls to zero in a range of constant speed")
    speed = min(programmed[number] for number in inside)
    changed = list(pieces)
    edges = []
    for number in inside:
        length = _length(pieces[number])
        low, high = np.minimum((np.array([start, end]) - ends[number]) / length, 1.0).tolist()
        edges.append(((number, low), (number, high)))
        whole = pieces[number].limits
        within = []
        for stretch in whole.between(low, high):
            if stretch.normal.velocity * length < speed * (1.0 - _SAME):
                raise _broken(3214, "the programmed speed cannot be kept in its range")
            most = min(speed / length, stretch.normal.velocity)
            within.append(replace(stretch, programmed=most))
        stretches = (*whole.between(0.0, low), *within, *whole.between(high, 1.0))
        changed[number] = replace(pieces[number], limits=CurveLimits(stretches))
    _check_reached(changed, edges[0][0], edges[-1][1], speed)
    return tuple(changed)


def _check_reached(
    pieces: Sequence[Piece], start: tuple[int, float], end: tuple[int, float], speed: float
) -> None:
    """Raise `Fault` 3216 or 3217 unless a range is entered and left with its speed.

    It goes from one number of a piece and its parameter to another.
    """
    for number, stretch, profile in _travelled(pieces):
        scale = _length(pieces[number]) / stretch.size
        least = speed * (1.0 - _SAME)
        if (number, stretch.start) == start and profile.knots[0][2] * scale < least:
            raise _broken(3216, "the way to speed up before a range of constant speed is too short")
        if (number, stretch.end) == end and profile.final * scale < least:
            raise _broken(3217, "the way to brake behind a range of constant speed is too short")


# ----------------------------------------------------------------------------------- durations


def _timed(pieces: Pieces, marks: Sequence[_Mark]) -> Pieces:
    """Return the pieces slowed down so that parts of a TIME_BLOCK take their shares of the time.

    Speeds are found by iteration. Parts that cannot be that fast are travelled as fast as possible.
    """
    groups: list[range] = []
    shares: list[float] = []
    begins: int | None = None
    for number, mark in marks:
        value = mark.value or 0.0
        if mark.edge == "START":
            groups, shares, begins = [], [], number
        elif begins is not None and mark.edge == "PART":
            groups.append(range(begins, number))
            shares.append(value)
            begins = number
        elif begins is not None:
            if not groups:
                groups, shares = [range(begins, number)], [value]
            wanted = [value * share / (sum(shares) or 1.0) for share in shares]
            pieces = _slowed(pieces, groups, wanted)
            begins = None
    return pieces


def _slowed(pieces: Pieces, groups: Sequence[range], wanted: Sequence[float]) -> Pieces:
    speeds = np.ones(len(groups))
    slowed = pieces
    for _ in range(_ROUNDS):
        taken = np.zeros(len(groups))
        for number, _, profile in _travelled(slowed):
            for place, group in enumerate(groups):
                if number in group:
                    taken[place] += profile.duration
        ratios = taken / np.maximum(wanted, 1e-9)
        if np.abs(ratios - 1.0).max() < _SAME:
            break
        speeds = np.minimum(speeds * ratios, 1.0)
        changed = list(pieces)
        for speed, group in zip(speeds, groups, strict=True):
            for number in group:
                changed[number] = _slower(pieces[number], float(speed))
        slowed = tuple(changed)
    return slowed


def _slower(piece: Piece, share: float) -> Piece:
    """Return a piece with its speed scaled by a share; acceleration and jerk match."""
    stretches = []
    for stretch in piece.limits.stretches:
        normal = stretch.normal
        slower = replace(
            normal, acceleration=normal.acceleration * share**2, jerk=normal.jerk * share**3
        )
        programmed = min(stretch.programmed, normal.velocity) * share
        stretches.append(replace(stretch, programmed=programmed, normal=slower))
    return replace(piece, limits=CurveLimits(tuple(stretches)))


# ---------------------------------------------------------------------------------------- shared


def _travelled(pieces: Sequence[Piece]) -> Iterator[tuple[int, Stretch, SpeedProfile]]:
    """Yield the stretches of a block travelled from rest to rest, with the number of the piece."""
    numbers, stretches = [], []
    for number, piece in enumerate(pieces):
        if piece.is_still:
            continue
        for place, stretch in enumerate(piece.limits.stretches):
            numbers.append(number)
            stretches.append(JoinedStretch(stretch, SAME_CURVE if place else piece.junction))
    found = schedule(stretches, AT_REST, 1.0)
    assert found is not None, "from rest a block can always be travelled"
    for number, joined, profile in zip(numbers, stretches, found.profiles, strict=True):
        yield number, joined.stretch, profile


def _length(piece: Piece) -> float:
    pose_path = piece.curve.pose_path
    return pose_path.length if isinstance(pose_path, OrientedPath) else 0.0


def _broken(number: int, text: str) -> Fault:
    return Fault("constant_velocity", text, number=number, rules=("SPL-05",))
