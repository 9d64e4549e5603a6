"""Laws about the duration of motions from rest to rest, at an override of 100.

A PTP takes exactly the time that its axes need, in closed form. A LIN or CIRC is no faster than its
speed and acceleration allow, and no slower if all axes are far from their limits. Sequences of
motions are compared with other sequences of the same run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import compress
from typing import Final

import numpy as np

from conformance.evaluation.motions import (
    NEAR_DEGREES,
    ROUNDING,
    Array,
    EndedMotion,
    follows,
)
from conformance.evaluation.path_geometry import arc_length, change_rates
from conformance.evaluation.place_laws import axes_of
from conformance.evaluation.run_laws import Violation
from interp.robot.kinematics.placement import IpoMode

#: Fractions by which a duration may be shorter or longer than computed, and seconds: ends lie
#: between two samples.
_SHORTER, _LONGER, _AT_ENDS = 1e-4, 1e-5, 1e-4
#: Fraction of a cycle by which a duration differs whose ramps are shorter than a cycle: the cubic
#: between samples misses the ends of the motion. The error falls with the square of longer ramps.
_BESIDE: Final = 0.4
#: Seconds by which rounding to microseconds may change a duration between known ends.
_ROUNDED: Final = 1.5e-6
#: Seconds below which a motion is not checked: there are too few samples between its ends.
_SHORTEST: Final = 0.2
#: Fraction of a time by which a motion back may take longer, because its samples differ.
_BACK: Final = 0.03
#: Degrees that an axis must move for two motions to be compared whose ends are within
#: `NEAR_DEGREES`.
_FAR_DEGREES: Final = 5.0
#: Largest ratio of the duration of blended motions to that of what they are compared with, and
#: microseconds by which rounding may change durations that are equal.
_SLOWER, _STRAIGHT, _TICKS = 1.001, 1.00001, 2
#: Fraction of the limits of all axes below which no axis can slow a path down.
_IDLE: Final = 0.15
#: The smallest numbers of samples that show the load of the axes.
_OF_LINE, _OF_CIRCLE = 5, 40
#: Jerk of spline motions in mm/s³ and deg/s³, and seconds in which other motions build up
#: acceleration.
_SPLINE_JERKS: Final = (500e3, 50e3)
_RAMP: Final = 0.08

#: Speed, acceleration and jerk.
_Limits = tuple[float, float, float]


def duration_violations(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield motions with an implausible duration, in a run whose override is 100."""
    for before, one in zip((None, *motions), motions, strict=False):
        yield from _start_violations(before, one)
        yield from _motion_violations(one, None if before is None else _known_way(before, one))
    yield from _sequence_violations(motions)


def seconds_of(length: float, speed: float, acceleration: float, jerk: float) -> float:
    """Return the shortest time in s for a length from rest to rest, with limited jerk."""
    ramp = ramp_seconds(speed, acceleration, jerk)
    if ramp * speed <= length:
        return 2.0 * ramp + (length - ramp * speed) / speed
    low, high = 0.0, speed
    for _ in range(100):
        middle = (low + high) / 2.0
        is_reached = ramp_seconds(middle, acceleration, jerk) * middle <= length
        low, high = (middle, high) if is_reached else (low, middle)
    return 2.0 * ramp_seconds(low, acceleration, jerk)


def ramp_seconds(speed: float, acceleration: float, jerk: float) -> float:
    """Return the shortest time in s from rest to a speed, with limited jerk."""
    if speed < acceleration**2 / jerk:
        return 2.0 * math.sqrt(speed / jerk)
    return speed / acceleration + acceleration / jerk


def _start_violations(before: EndedMotion | None, one: EndedMotion) -> Iterator[Violation]:
    """Yield a motion from rest that does not begin at the microsecond from which it can.

    That is when it is planned, or when the motion before ends.
    """
    if not one.begins or one.is_held or (before is not None and not follows(before, one)):
        return
    if before is None and one.motion.number > 1:
        return
    wanted = one.planned if before is None else max(one.planned, before.end)
    if one.start != wanted:
        law = "a motion from rest begins as soon as it is planned and the one before has ended"
        yield one.broken(law, f"{one.start} us, not {wanted} us")


def _motion_violations(one: EndedMotion, way: Array | None) -> Iterator[Violation]:
    """Yield a PTP that differs from the time of its axes [MOT-20], or an implausible LIN or CIRC.

    Implausible is faster than speed and acceleration allow, or slower although all axes are far
    from their limits. ``way`` is the movement of the axes if the program tells it: then
    microseconds count.
    """
    motion = one.motion
    took = (one.end - one.start) / 1e6
    if not one.begins or not one.stops or motion.parts:
        return
    is_free = True
    if motion.kind in ("PTP", "SPTP"):
        limits = _limits_of_axes(one, one.ends[1] - one.ends[0] if way is None else way)
        law, rule = "a PTP is as quick as its axes allow", "MOT-20"
        is_free = not motion.settings.is_reduced
    else:
        limits = _limits_of_path(one)
        law, rule = "a path takes what its speed and acceleration allow", ""
        # The jerk of S motions ends within a sample, so axes may limit it unseen.
        is_free = motion.kind[0] != "S" and _largest_load(one) < _IDLE
    if limits is None:
        return
    if min(limits) <= 0.0:
        yield one.broken(law, "it has no speed or no acceleration", rule)
        return
    wanted = seconds_of(1.0, *limits)
    cycle = np.diff(one.path.times[-2:]).item() / 1e6
    beside = _BESIDE * cycle * min((cycle / ramp_seconds(*limits)) ** 2, 1.0)
    shorter, longer = (part * wanted + _AT_ENDS + beside for part in (_SHORTER, _LONGER))
    if way is not None:
        shorter = longer = _ROUNDED
    elif max(took, wanted) < _SHORTEST:
        return
    if took < wanted - shorter or (is_free and took > wanted + longer):
        yield one.broken(law, f"{took:.6f} s, not {wanted:.6f} s", rule)


def _known_way(before: EndedMotion, one: EndedMotion) -> Array | None:
    """Return the movement of the axes in a PTP between two targets that are given as axes."""
    if not before.stops or not one.begins or not follows(before, one) or before.is_held:
        return None
    if before.motion.parts or one.motion.parts or one.motion.kind not in ("PTP", "SPTP"):
        return None
    unknown = np.full(one.ends.shape[1], math.nan)
    start = axes_of(before, unknown)
    end = axes_of(one, unknown if start is None else start)
    way = None if start is None or end is None else end - start
    return None if way is None or np.isnan(way).any() else way


def _limits_of_axes(one: EndedMotion, way: Array) -> _Limits | None:
    """Return the limits of a PTP, whose length is 1, by its slowest axes; ``None`` if unknown."""
    most, way = one.axis_rates, np.abs(way)
    moved = way > ROUNDING
    if most is None or not moved.any():
        return None
    v, a, j = (float((row[moved] / way[moved]).min()) for row in most)
    return v, a, j


def _limits_of_path(one: EndedMotion) -> _Limits | None:
    """Return the limits of a path, whose length is 1; ``None`` if unknown.

    They are the smallest ones of translation, swivel and rotation.
    """
    motion, settings, most = one.motion, one.motion.settings, one.machine
    first, last = one.poses(one.ends)
    # The sum of the steps between samples would be longer: rounding adds to each of them.
    way = (
        arc_length(np.concatenate((first[None], one.tools, last[None]))[:, :3, 3])
        if "CIRC" in motion.kind
        else float(np.linalg.norm(last[:3, 3] - first[:3, 3]))
    )
    turned = first[:3, :3].T @ last[:3, :3]
    swivel = math.degrees(math.acos(min(max(turned[0, 0], -1.0), 1.0)))
    twist = 2.0 * math.atan2(abs(turned[2, 1] - turned[1, 2]), 1.0 + np.trace(turned))
    is_known = settings.placement.mode is IpoMode.BASE and settings.orientation != "#JOINT"
    if not is_known or way < 1.0 or ("CIRC" in motion.kind and swivel + twist > ROUNDING):
        return None
    speed = min(settings.velocity, most.velocity.path)
    if settings.is_reduced:
        speed = min(speed, most.t1_speed)
    gain = min(settings.acceleration, most.acceleration.path)
    limits = [(way, speed * 1000.0, gain * 1000.0, _SPLINE_JERKS[0])]
    for angle, (fastest, steepest), turn, turn_gain in (
        (swivel, settings.swivel, most.velocity.swivel, most.acceleration.swivel),
        (
            math.degrees(twist),
            settings.rotation,
            most.velocity.rotation,
            most.acceleration.rotation,
        ),
    ):
        if angle > ROUNDING:
            limits.append((angle, min(fastest, turn), min(steepest, turn_gain), _SPLINE_JERKS[1]))
    v, a, j = (min(row[place] / row[0] for row in limits) for place in (1, 2, 3))
    return v, a, j if motion.kind[0] == "S" else a / _RAMP


def _largest_load(one: EndedMotion) -> float:
    """Return the largest fraction of a limit of speed, acceleration or jerk that an axis uses."""
    rows, most = one.path.axes[one.rows], one.axis_rates
    if most is None or len(rows) < (_OF_CIRCLE if "CIRC" in one.motion.kind else _OF_LINE):
        return math.inf
    used = 0.0
    for order, limits in enumerate(most):
        rows = change_rates(one.path.times[one.rows][order:], rows)
        used = max(used, float((np.abs(rows) / limits).max()))
    return used


# ------------------------------------------------------------------------------ rows of motions


def _sequences(motions: Sequence[EndedMotion]) -> Iterator[tuple[EndedMotion, ...]]:
    """Yield the sequences of blended motions from rest to rest; most have a single motion."""
    row: list[EndedMotion] = []
    for one in motions:
        row = [*row, one] if row and not one.begins and follows(row[-1], one) else [one]
        if one.stops and row[0].begins:
            yield tuple(row)


def _sequence_violations(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield sequences whose duration contradicts that of other sequences of the same run.

    A motion back takes as long as the motion there. Blended motions are no slower than the same
    motions with exact stops, and, if all were planned before the first began and lie on a straight
    line, no slower than a single motion.
    """
    rows = [row for row in _sequences(motions) if not any(one.motion.parts for one in row)]
    if not rows:
        return
    ends = np.array([(row[0].ends[0], row[-1].ends[1]) for row in rows])  # (rows, 2, axes)
    times = [row[-1].end - row[0].start for row in rows]
    is_far = np.abs(ends[:, 1] - ends[:, 0]).max(axis=1) > _FAR_DEGREES
    for row, way, took in compress(zip(rows, ends, times, strict=True), is_far):
        one = row[0]
        if len(row) == 1:
            for other, known in _single_motions(way[::-1], rows, ends, times):
                if _is_same_motion(one, other, is_back=True) and took > known * (1.0 + _BACK):
                    law = "a way back takes the time of the way there"
                    yield one.broken(law, f"{took} us, not {known} us")
        elif row[-1].planned < one.start:
            for other, known in _single_motions(way, rows, ends, times):
                if took > known * _STRAIGHT + _TICKS and _is_straight((*row, other)):
                    law = "points on a straight way cost no time"
                    yield one.broken(law, f"{took} us, not {known} us")
    for row, took in zip(rows, times, strict=True):
        stops = _time_with_exact_stops(rows, row) if len(row) > 1 else None
        if stops is not None and took > stops * _SLOWER:
            law = "blended motions are no slower than exact ones"
            yield row[0].broken(law, f"{took} us, not {stops} us")


def _single_motions(
    way: Array, rows: Sequence[Sequence[EndedMotion]], ends: Array, times: Sequence[int]
) -> Iterator[tuple[EndedMotion, int]]:
    """Yield single motions between two positions of the axes (2, axes), with their µs."""
    near = np.abs(ends - way).max(axis=(1, 2)) < NEAR_DEGREES
    for row, took in compress(zip(rows, times, strict=True), near):
        if len(row) == 1:
            yield row[0], took


def _is_same_motion(one: EndedMotion, other: EndedMotion, *, is_back: bool = False) -> bool:
    """Return whether two motions have the same kind, settings, auxiliary point and target."""
    first, second = one.motion, other.motion
    return (
        first.kind == second.kind
        and first.auxiliary == second.auxiliary
        and first.angle == second.angle
        and first.is_relative == second.is_relative
        and (is_back or first.target == second.target)
        and first.settings == second.settings
    )


def _is_straight(row: Sequence[EndedMotion]) -> bool:
    """Return whether PTP or LIN motions with equal settings lie on the line of the last one."""
    whole = row[-1]
    if whole.motion.kind not in ("PTP", "LIN"):
        return False
    if any(
        one.motion.kind != whole.motion.kind or one.motion.settings != whole.motion.settings
        for one in row
    ):
        return False
    axes = np.vstack([one.ends for one in row])
    if whole.motion.kind == "PTP":
        places = axes
    else:
        poses = whole.poses(axes)
        places = np.hstack((poses[:, :3, 3], 100.0 * poses[:, :3, :3].reshape(-1, 9)))
        if np.abs(poses[:, :3, :3] - poses[0, :3, :3]).max() > ROUNDING:
            return False
    start, along = places[-2], places[-1] - places[-2]
    shares = (places - start) @ along / float(along @ along)
    off = np.abs(places - start - shares[:, None] * along).max()
    return bool(off < ROUNDING * 100.0 and (np.diff(shares[:-2]) > -ROUNDING).all())


def _time_with_exact_stops(
    rows: Sequence[Sequence[EndedMotion]], row: Sequence[EndedMotion]
) -> int | None:
    """Return the µs of the same motions with exact stops, if the run has them."""
    for place in range(len(rows) - len(row) + 1):
        same = rows[place : place + len(row)]
        are_alike = all(
            len(other) == 1 and _is_same_motion(one, other[0])
            for one, other in zip(row, same, strict=True)
        )
        if are_alike and np.abs(same[0][0].ends[0] - row[0].ends[0]).max() < NEAR_DEGREES:
            return sum(one[0].end - one[0].start for one in same)
    return None
