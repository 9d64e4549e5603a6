"""Laws about the duration of motions from rest to rest, at an override of 100.

A PTP takes exactly the time that its axes need, in closed form. A LIN or CIRC is no faster than its
speed and acceleration allow, and no slower if all axes are far from their limits. Sequences of
motions are compared with other sequences of the same run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from conformance.evaluation.laws import OVERRIDE, STOP, Deviations, Laws, Run, Subjects
from conformance.evaluation.motions import NEAR_DEGREES, ROUNDING, Array, EndedMotion
from conformance.evaluation.path_geometry import arc_length, rates_of
from conformance.evaluation.programmed_paths import axes_of

LAWS: Final = Laws(OVERRIDE, STOP)
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


@dataclass(frozen=True)
class _Timed:
    """A motion, and the one before it of those that came to their end."""

    before: EndedMotion | None
    one: EndedMotion

    @property
    def took(self) -> float:
        """Its duration in s."""
        return (self.one.end - self.one.start) / 1e6

    @cached_property
    def way(self) -> Array | None:
        """The movement of the axes in a PTP between two targets that are given as axes."""
        before, one = self.before, self.one
        if before is None or not before.stops or not one.begins or not one.follows(before):
            return None
        if before.motion.parts or not one.is_ptp:
            return None
        unknown = np.full(one.ends.shape[1], math.nan)
        start = axes_of(before, unknown)
        end = axes_of(one, unknown if start is None else start)
        way = None if start is None or end is None else end - start
        return None if way is None or np.isnan(way).any() else way

    def off(self, limits: _Limits | None, *, may_be_slow: bool) -> Deviations:
        """Yield that it is faster than its limits allow, or slower without a reason.

        If the program tells the way of its axes, microseconds count.
        """
        if limits is None:
            return
        if min(limits) <= 0.0:
            yield "it has no speed or no acceleration"
            return
        took, wanted = self.took, seconds_of(1.0, *limits)
        cycle = np.diff(self.one.path.times[-2:]).item() / 1e6
        beside = _BESIDE * cycle * min((cycle / ramp_seconds(*limits)) ** 2, 1.0)
        shorter, longer = (part * wanted + _AT_ENDS + beside for part in (_SHORTER, _LONGER))
        if self.way is not None:
            shorter = longer = _ROUNDED
        elif max(took, wanted) < _SHORTEST:
            return
        if took < wanted - shorter or (not may_be_slow and took > wanted + longer):
            yield f"{took:.6f} s, not {wanted:.6f} s"


def _timed(run: Run) -> Subjects[_Timed]:
    pairs = zip((None, *run.free), run.free, strict=False)
    return ((one.event, _Timed(before, one)) for before, one in pairs)


@LAWS.law(
    "a motion from rest begins as soon as it is planned and the one before has ended", of=_timed
)
def _late(timed: _Timed) -> Deviations:
    """At the microsecond."""
    before, one = timed.before, timed.one
    if not one.begins or (before is not None and not one.follows(before)):
        return
    if before is None and one.motion.number > 1:
        return
    wanted = one.planned if before is None else max(one.planned, before.end)
    if one.start != wanted:
        yield f"{one.start} us, not {wanted} us"


def _is_from_rest(one: EndedMotion) -> bool:
    return one.begins and one.stops and not one.motion.parts


@LAWS.law("a PTP is as quick as its axes allow", "MOT-20", of=_timed)
def _wrong_time_of_axes(timed: _Timed) -> Deviations:
    one = timed.one
    if one.is_ptp and _is_from_rest(one):
        limits = _limits_of_axes(one, one.ends[1] - one.ends[0] if timed.way is None else timed.way)
        yield from timed.off(limits, may_be_slow=one.motion.settings.is_reduced)


@LAWS.law("a path takes what its speed and acceleration allow", of=_timed)
def _wrong_time_of_path(timed: _Timed) -> Deviations:
    """It may be slower if an axis is not far from its limits.

    The jerk of S motions ends within a sample, so axes may limit it unseen.
    """
    one = timed.one
    if not one.is_ptp and _is_from_rest(one):
        may_be_slow = one.motion.kind[0] == "S" or _largest_load(one) >= _IDLE
        yield from timed.off(_limits_of_path(one), may_be_slow=may_be_slow)


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
    is_known = one.is_in_base and settings.orientation != "#JOINT"
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
    most = one.axis_rates
    if most is None or len(one.times) < (_OF_CIRCLE if "CIRC" in one.motion.kind else _OF_LINE):
        return math.inf
    rates = zip(rates_of(one.times, one.axes), most, strict=True)
    return max(float((np.abs(rows) / limits).max()) for rows, limits in rates)


# ------------------------------------------------------------------------------ rows of motions


@dataclass(frozen=True)
class _Sequence:
    """Blended motions from rest to rest, often a single one; ``others`` are all of the run."""

    row: Sequence[EndedMotion]
    others: Sequence[_Sequence]

    @property
    def took(self) -> int:
        """Its duration in µs."""
        return self.row[-1].end - self.row[0].start

    @cached_property
    def ends(self) -> Array:
        """The axes at its start and end, (2, axes)."""
        return np.array([self.row[0].ends[0], self.row[-1].ends[1]])

    def single(self, way: Array) -> Iterator[tuple[EndedMotion, int]]:
        """Yield single motions between two positions of the axes, with their µs, if it is long."""
        if np.abs(np.diff(self.ends, axis=0)).max() > _FAR_DEGREES:
            for each in self.others:
                if len(each.row) == 1 and np.abs(each.ends - way).max() < NEAR_DEGREES:
                    yield each.row[0], each.took


def _sequences(run: Run) -> Subjects[_Sequence]:
    row: list[EndedMotion] = []
    found: list[_Sequence] = []
    for one in run.free:
        row = [*row, one] if row and not one.begins and one.follows(row[-1]) else [one]
        if one.stops and row[0].begins and not any(each.motion.parts for each in row):
            found.append(_Sequence(row, found))
    return ((each.row[0].event, each) for each in found)


@LAWS.law("a way back takes the time of the way there", of=_sequences)
def _slow_back(sequence: _Sequence) -> Deviations:
    if len(sequence.row) == 1:
        for other, known in sequence.single(sequence.ends[::-1]):
            is_same = _is_same_motion(sequence.row[0], other, is_back=True)
            if is_same and sequence.took > known * (1.0 + _BACK):
                yield f"{sequence.took} us, not {known} us"


@LAWS.law("points on a straight way cost no time", of=_sequences)
def _slow_straight(sequence: _Sequence) -> Deviations:
    """If all were planned before the first began."""
    row, took = sequence.row, sequence.took
    if len(row) > 1 and row[-1].planned < row[0].start:
        for other, known in sequence.single(sequence.ends):
            if took > known * _STRAIGHT + _TICKS and _is_straight((*row, other)):
                yield f"{took} us, not {known} us"


@LAWS.law("blended motions are no slower than exact ones", of=_sequences)
def _slow_blended(sequence: _Sequence) -> Deviations:
    stops = _time_with_exact_stops(sequence) if len(sequence.row) > 1 else None
    if stops is not None and sequence.took > stops * _SLOWER:
        yield f"{sequence.took} us, not {stops} us"


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


def _time_with_exact_stops(sequence: _Sequence) -> int | None:
    """Return the µs of the same motions with exact stops, if the run has them."""
    size = len(sequence.row)
    for place in range(len(sequence.others) - size + 1):
        same = sequence.others[place : place + size]
        are_alike = all(
            len(other.row) == 1 and _is_same_motion(one, other.row[0])
            for one, other in zip(sequence.row, same, strict=True)
        )
        if are_alike and np.abs(same[0].ends[0] - sequence.ends[0]).max() < NEAR_DEGREES:
            return sum(each.took for each in same)
    return None
