"""Approximate positioning: where a blend begins and ends, and what it is [BLD-01 to BLD-15].

A zone takes a share of the path before the point and of the path behind it, neither more than half
[BLD-07]. How much is said by the criteria behind the first motion. Where both motions are
paths of the tool in the same frames, the blend is one as well; else it is one of the axes. So a
motion has up to three parts [MOT-17], and the point itself is not passed [BLD-08]. Whether the two
sides are alike is not known [CON-08].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Approximation, Motion
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.kinematics.targets import check_path
from interp.robot.path.axis_path import BlendedAxes, BlendedOthers, Curve, PosePathCurve, Rates
from interp.robot.path.pose_path import Blend, StraightLine, Way
from interp.robot.path.transition import Overlap, Rounding, Transition
from interp.robot.planning.limits import AxisLimits, Ceiling, even_ceiling
from interp.robot.planning.profile import Bounds, ramp
from interp.robot.planning.schedule import AtRest, GearedStretch, alone, schedule
from interp.robot.planning.timeline import tool_tangents
from interp.robot.planning.tracks import Piece, Track

__all__ = ["Joint", "Zone", "blend_of", "wants_blend", "zone_of"]

_HALF = 0.5
_SMALLEST = 1e-6
"""Share of a path below which there is nothing to blend."""
_METRE = 1000.0
_PARABOLA, _SMOOTH = 1.0, 2.0
"""Slopes of roundings; the first is nearly a parabola, which is said of lines [BLD-12]."""
_SOONER = 0.95
"""Share of a duration from which on a transition nearer to a parabola is preferred."""
_SAVED = 0.97
"""Share of the duration with an exact stop that such a transition has to keep below."""
_TINY = 1e-9
_STRAIGHT = 1e-3
"""Relative difference of directions that counts as none."""
_EVEN = 1e-6
_GRID = np.linspace(0.0, 1.0, 65)
_STEP = 1.0 / 64.0


@dataclass(frozen=True, slots=True)
class Zone:
    """The shares of the first path and of the second that a blend takes the place of."""

    before: float
    after: float


def wants_blend(motion: Motion) -> bool:
    """Whether a motion asks to be blended into the next, with more than a zone of nothing."""
    values = motion.settings.approximation
    if not motion.criteria:
        return False
    match motion.criteria[0]:
        case "C_PTP":
            return values.cptp > 0.0
        case "C_VEL":
            return values.cvel > 0.0
        case "C_ORI":
            return values.cori > 0.0
        case _:
            return values.cdis > 0.0


def zone_of(first: Track, second: Track) -> Zone | None:
    """The zone between two motions, or ``None`` where they cannot be blended [BLD-14].

    On a path of the tool the first criterion counts on both sides; behind PTP the second one, if
    there is one, for the path of the tool that follows. On the side of a PTP, C_PTP takes the
    first motion's value before the point and the second's behind it [BLD-04], C_DIS the first
    motion's for both [BLD-05]. SPTP takes the smaller of both zones [SPL-09].
    """
    if first.is_still or second.is_still or not wants_blend(first.motion):
        return None
    values = first.motion.settings.approximation
    main, *others = first.motion.criteria
    if first.is_cp:
        before = _path_share(first, main, values, at_end=True)
    else:
        before = _axis_share(first, main, values, values, at_end=True)
    if second.is_cp:
        criterion = main if first.is_cp else (others[0] if others else "C_DIS")
        after = _path_share(second, criterion, values, at_end=False)
    else:
        criterion = main if not first.is_cp else (others[0] if others else "C_PTP")
        own = second.motion.settings.approximation
        after = _axis_share(second, criterion, values, own, at_end=False)
    zone = Zone(min(before, _HALF), min(after, _HALF))
    return zone if min(zone.before, zone.after) > _SMALLEST else None


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """A blend: its curve, how fast that may be travelled, and how it joins what it is between.

    ``into`` and ``out`` are gear and bend at its start and at its end, as in `GearedStretch`.
    """

    curve: Curve
    ceiling: Ceiling
    into: tuple[float, float]
    out: tuple[float, float]


def blend_of(
    first: Track, second: Track, zone: Zone, machine: MachineData, limits: AxisLimits
) -> Joint:
    """The blend of a zone.

    Of the transitions that are about as soon over, its shape is the one nearest to a parabola.
    ``limits`` are those of the machine data, which hold for all axes; on the path of the tool the
    acceleration is at most $ACC_MA.CP (an assumption: no rule tells). So the speed may drop
    [BLD-15]. Raises `Fault` where the blend leads out of the working range.
    """
    axes = first.axis_limits.widest(second.axis_limits)
    one, other = first.pieces[-1], second.pieces[0]
    directions = _Directions.of(first, second, limits)
    transition = _soonest(first, second, zone, directions, axes, machine)
    curves = (one.curve, other.curve)
    paths = (one.curve.pose_path, other.curve.pose_path)
    if (
        not _has_common_frames(first, second)
        or not isinstance(curves[0], PosePathCurve)
        or not isinstance(curves[1], PosePathCurve)
        or paths[0] is None
        or paths[1] is None
    ):
        curve: Curve = BlendedAxes(*curves, transition)
        check_path((*machine.axes, *machine.externals), curve.axes(curve.grid))
        most = _most_of_axes(first, second, curve, machine)
    else:
        pose_path = Blend(paths[0], paths[1], transition)
        (start,) = curves[0].axes(np.array([1.0 - zone.before]))
        others = BlendedOthers(curves[0].others, curves[1].others, transition)
        arm, placement = curves[0].arm, curves[0].placement
        curve = PosePathCurve(arm, placement, pose_path, start[:ROBOT_AXES], others)
        most = _most_of_tool(pose_path.tangents(_GRID), one, other, machine)
    into, out = _gears(transition)
    beside = _beside(one, other, into, out)
    size = one.ceiling.stretches[-1].size / into[0]
    # The spline of the axes sees little of how quickly the curve begins to bend.
    ends = directions.rates(transition, np.array([0.0, 1.0]))
    x, y, z = (np.concatenate(both) for both in zip(curve.rates(curve.grid), ends, strict=True))
    ceiling = even_ceiling((x, y, z), axes, beside, most, size)
    return Joint(curve, ceiling, into, out)


def _soonest(
    first: Track,
    second: Track,
    zone: Zone,
    directions: _Directions,
    axes: AxisLimits,
    machine: MachineData,
) -> Transition:
    """The transition with which both motions are soonest over, judged by their directions at P."""
    one, other = first.pieces[-1], second.pieces[0]
    weights = directions.weights(zone)
    paths = (one.curve.pose_path, other.curve.pose_path)
    if directions.is_straight:
        return Rounding(zone.before, zone.after, weights, _SMOOTH)
    are_lines = all(isinstance(path, StraightLine) for path in paths)
    choices: list[Transition] = [
        Rounding(zone.before, zone.after, weights, slope)
        for slope in ((_PARABOLA, _SMOOTH) if are_lines else (_SMOOTH,))
    ]
    ending, starting = alone(one.ceiling), alone(other.ceiling)
    if ending is not None and starting is not None:
        choices.append(Overlap(ending.since(1.0 - zone.before), starting.until(zone.after)))
    times = []
    for transition in choices:
        rates = directions.rates(transition, _GRID)
        most = math.inf
        if (tangents := directions.tangents(transition)) is not None:
            most = _most_of_tool(tangents, one, other, machine)
        times.append(_duration(one, other, transition, rates, most, axes))
    most = min(times) / _SOONER
    if ending is not None and starting is not None:
        most = min(most, _SAVED * (ending.duration + starting.duration))
    most = max(most, min(times))
    return choices[next(place for place, time in enumerate(times) if time <= most)]


@dataclass(frozen=True, slots=True, eq=False)
class _Directions:
    """Derivatives of both paths at the point between: of axes, and of the tool where both have it.

    ``lengths`` are those of both paths in one unit: mm of the tool, else seconds of axes.
    ``is_straight``: the second goes on where the first leads.
    """

    axes: tuple[Array, Array]
    tool: tuple[Array, Array] | None
    lengths: tuple[float, float]
    is_straight: bool

    @classmethod
    def of(cls, first: Track, second: Track, limits: AxisLimits) -> _Directions:
        one, other = first.pieces[-1].curve, second.pieces[0].curve
        (leaving,), _, _ = one.rates(np.ones(1))
        (joining,), _, _ = other.rates(np.zeros(1))
        paths = one.pose_path, other.pose_path
        tool, lengths = None, (0.0, 0.0)
        if _has_common_frames(first, second) and paths[0] is not None and paths[1] is not None:
            tool = (paths[0].tangents(np.ones(1))[0], paths[1].tangents(np.zeros(1))[0])
            lengths = (float(np.linalg.norm(tool[0])), float(np.linalg.norm(tool[1])))
        if min(lengths) <= 0.0:
            before, after = (float((np.abs(r) / limits.velocity).max()) for r in (leaving, joining))
            lengths = (max(before, _TINY), max(after, _TINY))
        onward = leaving * lengths[1] / lengths[0]
        is_straight = bool(np.abs(joining - onward).max() <= _STRAIGHT * np.abs(joining).max())
        if is_straight:
            joining = onward  # but for the splines of the axes, they go straight on
        return cls((leaving, joining), tool, lengths, is_straight)

    def weights(self, zone: Zone) -> tuple[float, float]:
        """The lengths of both sides of a zone."""
        return zone.before * self.lengths[0], zone.after * self.lengths[1]

    def rates(self, transition: Transition, u: Array) -> Rates:
        """Derivatives of the axes in a blend between straight lines."""
        leaving, joining = transition.rates(u)
        x, y, z = (
            before[:, None] * self.axes[0] + after[:, None] * self.axes[1]
            for before, after in zip(leaving, joining, strict=True)
        )
        return x, y, z

    def tangents(self, transition: Transition) -> Array | None:
        """Derivatives of the tool's place in such a blend."""
        if self.tool is None:
            return None
        (before, *_), (after, *_) = transition.rates(_GRID)
        tangents: Array = before[:, None] * self.tool[0] + after[:, None] * self.tool[1]
        return tangents


def _duration(
    one: Piece,
    other: Piece,
    transition: Transition,
    rates: Rates,
    most: float,
    axes: AxisLimits,
) -> float:
    """How long both pieces take from rest to rest with a blend of such derivatives."""
    into, out = _gears(transition)
    beside = _beside(one, other, into, out)
    size = one.ceiling.stretches[-1].size / into[0]
    (zone,) = even_ceiling(rates, axes, beside, most, size).stretches
    before = one.ceiling.between(0.0, 1.0 - transition.before)
    after = other.ceiling.between(transition.after, 1.0)
    steps = [
        *(GearedStretch(stretch, 1.0) for stretch in before),
        GearedStretch(zone, *into),
        *(GearedStretch(s, *((1.0, 0.0) if n else out)) for n, s in enumerate(after)),
    ]
    profiles = schedule(steps, AtRest, 1.0)
    return math.inf if profiles is None else sum(profile.duration for profile in profiles)


def _gears(transition: Transition) -> tuple[tuple[float, float], tuple[float, float]]:
    """Gear and bend at both ends of a blend."""
    leaving, joining = transition.rates(np.array([0.0, 1.0]))
    gear_in, bend_in = 1.0 / leaving[0, 0], -leaving[1, 0] / leaving[0, 0] ** 3
    gear_out, bend_out = joining[0, 1], joining[1, 1]
    if abs(leaving[1, 0]) < _EVEN * leaving[0, 0]:
        bend_in = 0.0
    if abs(bend_out) < _EVEN * gear_out:
        bend_out = 0.0
    return (float(gear_in), float(bend_in)), (float(gear_out), float(bend_out))


def _beside(
    one: Piece, other: Piece, into: tuple[float, float], out: tuple[float, float]
) -> tuple[Bounds, Bounds]:
    """The bounds on both sides in units of the blend."""
    before, after = one.ceiling.stretches[-1].bounds(1.0), other.ceiling.stretches[0].bounds(1.0)
    return before.scaled(into[0]), after.scaled(1.0 / out[0])


def _has_common_frames(first: Track, second: Track) -> bool:
    """Whether both are paths of the tool, in the same frames."""
    curves = (first.pieces[-1].curve, second.pieces[0].curve)
    return all(isinstance(curve, PosePathCurve) and curve.pose_path for curve in curves) and (
        first.motion.settings.placement == second.motion.settings.placement
    )


# ---------------------------------------------------------------------------------------- zones


def _piece(track: Track, *, at_end: bool) -> Piece:
    return track.pieces[-1 if at_end else 0]


def _path_share(track: Track, criterion: str, values: Approximation, *, at_end: bool) -> float:
    """The share of a path of the tool; all of it where there is nothing to measure by."""
    curve = _piece(track, at_end=at_end).curve
    pose_path = curve.pose_path
    if pose_path is None and criterion not in {"C_VEL", "C_ORI"}:
        return _way_share(curve, max(values.cdis, 0.0), at_end=at_end)
    length = pose_path.length if pose_path is not None else 0.0
    if criterion == "C_ORI":
        angles = pose_path.angles if pose_path is not None else (0.0, 0.0)
        length, size = math.degrees(max(angles)), values.cori
    elif criterion == "C_VEL":
        return _braking_share(track, values.cvel / 100.0, at_end=at_end)
    else:
        size = values.cdis
    return max(size, 0.0) / length if length > 0.0 else 1.0


def _braking_share(track: Track, share: float, *, at_end: bool) -> float:
    """The share in which a part of the programmed speed is braked away or reached [BLD-13]."""
    stretches = _piece(track, at_end=at_end).ceiling.stretches
    stretch = stretches[-1] if at_end else stretches[0]
    bounds = stretch.bounds(1.0)
    speed = max(share, 0.0) * stretch.programmed
    size = stretch.size
    sized = Bounds(speed * size, bounds.acceleration * size, bounds.jerk * size)
    return ramp(speed * size, 0.0, 0.0, sized).distance / size


def _axis_share(
    track: Track, criterion: str, values: Approximation, own: Approximation, *, at_end: bool
) -> float:
    """The share of a PTP: by $APO_DIS_PTP of each axis, by the way of the tool, or by both."""
    curve = _piece(track, at_end=at_end).curve
    by_way = criterion in {"C_DIS", "C_SPL"}
    takes_both = track.motion.kind == "SPTP"
    shares = []
    if not by_way or takes_both:
        shares.append(_turning_share(curve, min(max(own.cptp, 0.0), 100.0) / 100.0))
    if by_way or (takes_both and values.cdis > 0.0):
        shares.append(_way_share(curve, max(values.cdis, 0.0), at_end=at_end))
    return min(shares)


def _turning_share(curve: Curve, share: float) -> float:
    """Where no axis is farther from the point than a share of $APO_DIS_PTP [BLD-03]."""
    (travel,), _, _ = curve.rates(np.ones(1))
    machine = curve.arm.machine
    reach = np.array([axis.approximation for axis in (*machine.axes, *machine.externals)])
    return float((share * reach / np.maximum(np.abs(travel), 1e-9)).min())


def _way_share(curve: Curve, distance: float, *, at_end: bool) -> float:
    """The share in which the tool travels a distance."""
    way = Way(lambda u: tool_tangents(curve, u))
    if distance >= way.length:
        return 1.0
    wanted = way.length - distance if at_end else distance
    (u,) = way.parameters(np.array([wanted]))
    return float(1.0 - u if at_end else u)


# ---------------------------------------------------------------------------------------- speed


def _most_of_tool(tangents: Array, one: Piece, other: Piece, machine: MachineData) -> float:
    """The speed at which the tool is no faster than beside the blend [BLD-15].

    And has no more acceleration than the machine's.
    """
    bends = np.gradient(tangents, _STEP, axis=0)
    sharpest = float(np.linalg.norm(bends, axis=1).max())
    fastest = float(np.linalg.norm(tangents, axis=1).max())
    speed = max(path.velocity for piece in (one, other) for path in piece.paths[:1])
    most = machine.acceleration.path * _METRE
    return min(speed / max(fastest, _TINY), math.sqrt(most / max(sharpest, _TINY)))


def _most_of_axes(first: Track, second: Track, curve: Curve, machine: MachineData) -> float:
    """In T1 the tool is no faster than $VEL_CP_T1 on a blend of axes either [MOT-07]."""
    if not any(track.motion.settings.is_reduced for track in (first, second)):
        return math.inf
    tangents: Array = tool_tangents(curve, np.linspace(0.0, 1.0, 33))
    fastest = float(np.linalg.norm(tangents, axis=1).max())
    return machine.t1_speed * _METRE / fastest if fastest > 0.0 else math.inf
