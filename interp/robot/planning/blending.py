"""Approximate positioning: where a blend begins and ends, and its shape [BLD-01 to BLD-15].

A blend zone replaces a share of the path before the point and of the path after it, at most half of
each [BLD-07]. The criteria of the first motion determine these shares. If both motions are CP
motions in the same frames, the blend is a path of the tool, too; otherwise it is a curve of the
axes. So a motion has up to three parts [MOT-17], and the point itself is not passed [BLD-08].
Whether both sides are equal is not known [CON-08].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Approximation, Motion
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.targets import check_path
from interp.robot.path.axis_path import (
    BlendedAxes,
    BlendedOthers,
    Curve,
    PosePathCurve,
    Rates,
    tool_tangents,
)
from interp.robot.path.pose_path import Blend, StraightLine
from interp.robot.path.transition import Overlap, Rounding, Transition
from interp.robot.path.way import Way
from interp.robot.planning.limits import AxisLimits, Ceiling, PathLimits, ceiling_of, even_ceiling
from interp.robot.planning.profile import Bounds, ramp
from interp.robot.planning.schedule import AtRest, GearedStretch, alone, schedule
from interp.robot.planning.straight_run import StraightPart, StraightRun, extended, straight_through
from interp.robot.planning.tracks import Piece, Track, reduced_paths
from interp.values.faults import Fault

_HALF = 0.5
_SMALLEST = 1e-6
"""Share of a path below which motions are not blended."""
_METRE = 1000.0
_PARABOLA, _SMOOTH = 1.0, 2.0
"""Slopes of roundings; the first is nearly a parabola, which BLD-12 states for lines."""
_SOONER = 0.95
"""Share of a duration above which the transition nearer to a parabola is preferred."""
_SAVED = 0.97
"""Share of the duration with an exact stop that such a transition must not exceed."""
_TINY = 1e-9
_STRAIGHT = 1e-3
"""Relative difference below which directions count as equal."""
_BACK = -0.99
"""The smallest cosine of a corner whose speed is kept; a reversal has no finite curve."""
_EVEN = 1e-6
_GRID = np.linspace(0.0, 1.0, 65)
_STEP = 1.0 / 64.0


@dataclass(frozen=True, slots=True)
class Zone:
    """The shares of the first and the second path that a blend replaces."""

    before: float
    after: float


def wants_blend(motion: Motion) -> bool:
    """Return whether a motion is approximated, with a zone larger than zero."""
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
    """Return the zone between two motions, or ``None`` if they cannot be blended [BLD-14].

    Between CP motions the first criterion determines both sides; after a PTP, the second criterion,
    if there is one, determines the side of the CP motion that follows. On the side of a PTP, C_PTP
    uses the value of the first motion before the point and that of the second after it [BLD-04];
    C_DIS uses the value of the first for both [BLD-05]. SPTP uses the smaller of both zones
    [SPL-09].
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
    """A blend: its curve, the bounds along it, and its connection to both motions.

    ``zone`` is what it replaces of both, which may be less than the zone requested. ``into`` and
    ``out`` are gear and bend at its start and at its end, as in `GearedStretch`. ``straight`` is
    the straight run of which both motions are parts, if they are.
    """

    zone: Zone
    curve: Curve
    ceiling: Ceiling
    into: tuple[float, float]
    out: tuple[float, float]
    straight: StraightRun | None = None


def blend_of(
    first: Track,
    second: Track,
    zone: Zone,
    machine: MachineData,
    limits: AxisLimits,
    run: StraightRun | None = None,
) -> Joint:
    """Return the blend of a zone; ``run`` is the straight run that ends with the first motion.

    Among the transitions with about the same duration, the one nearest to a parabola is used.
    ``limits`` are the machine data of all axes; along the path of the tool the acceleration is at
    most $ACC_MA.CP (an assumption, no rule says so). The speed may therefore drop [BLD-15]. Raises
    `Fault` if the blend leaves the working range.
    """
    one, other = first.pieces[-1].curve, second.pieces[0].curve
    common = _common_curves(first, second)
    weights, is_straight = _course(one, other, common, zone, limits)
    if is_straight:
        straight = _straight_on(first, second, zone, machine, limits, run)
        if straight is not None:
            return straight
    transition: Transition = Rounding(zone.before, zone.after, weights, _SMOOTH)
    if not is_straight:
        transition = _soonest(first, second, zone, weights, machine)
    zone = Zone(transition.before, transition.after)
    axes = BlendedAxes(one, other, transition)
    curve: Curve = axes
    if common is None:
        check_path((*machine.axes, *machine.externals), curve.axes(curve.grid))
    else:
        pose_path = Blend(common[0].tool_path, common[1].tool_path, transition)
        (start,) = one.axes(np.array([1.0 - zone.before]))
        others = BlendedOthers(common[0].others, common[1].others, transition)
        curve = PosePathCurve(one.arm, one.placement, pose_path, start[:ROBOT_AXES], others)
    # The spline of the axes sees little of how quickly the curve begins to bend.
    ends = axes.rates(np.array([0.0, 1.0]))
    x, y, z = (np.concatenate(both) for both in zip(curve.rates(curve.grid), ends, strict=True))
    settings = first.motion.settings, second.motion.settings
    in_t1 = reduced_paths(curve, machine, *settings)
    slowest = min((path.velocity / path.length for path in in_t1), default=math.inf)
    ceiling = _ceiling(first, second, transition, curve, (x, y, z), machine, slowest)
    return Joint(zone, curve, ceiling, *_gears(transition))


def _ceiling(
    first: Track,
    second: Track,
    transition: Transition,
    curve: Curve,
    rates: Rates,
    machine: MachineData,
    slowest: float = math.inf,
) -> Ceiling:
    """Return the bounds of a blend along a curve with these derivatives of the axes.

    No torque exceeds its limit. The tool is not faster than on both sides of the blend, and its
    acceleration does not exceed that of the machine data [BLD-15]. Between PTP motions no axis
    exceeds its programmed speed.
    """
    one, other = first.pieces[-1], second.pieces[0]
    (gear, bend), out = _gears(transition)
    limits = first.axis_limits.merged(second.axis_limits, np.maximum)
    programmed, most = slowest, math.inf
    if (common := _common_curves(first, second)) is not None:
        tangents = Blend(common[0].tool_path, common[1].tool_path, transition).tangents(_GRID)
        bends = np.gradient(tangents, _STEP, axis=0)
        sharpest, fastest = (
            max(float(np.linalg.norm(rows, axis=1).max()), _TINY) for rows in (bends, tangents)
        )
        speed = max(path.velocity for piece in (one, other) for path in piece.paths[:1])
        programmed = min(programmed, speed / fastest)
        most = math.sqrt(machine.acceleration.path * _METRE / sharpest)
    elif not first.is_cp and not second.is_cp:
        speeds = limits.velocity / np.maximum(np.abs(rates[0]), _TINY)
        programmed = min(programmed, float(speeds.min()))
    beside = _beside(one, other, (gear, bend), out)
    size = one.ceiling.stretches[-1].size / gear
    ceiling = even_ceiling(rates, limits, beside, programmed, most, size)
    return ceiling.within(first.axis_limits.torques, curve)


def _straight_on(
    first: Track,
    second: Track,
    zone: Zone,
    machine: MachineData,
    limits: AxisLimits,
    run: StraightRun | None,
) -> Joint | None:
    """Return the joint of two straight motions of which the second continues in the same direction.

    The joint is straight, too. Return ``None`` if it would miss the point between them.
    """
    one, other = first.pieces[-1], second.pieces[0]
    parts = StraightPart.of(one.curve), StraightPart.of(other.curve)
    curve = straight_through(parts, 1.0 - zone.before, zone.after)
    if curve is None or len(one.paths) != len(other.paths):
        return None
    ways = parts[0].way, parts[1].way
    length = zone.before * ways[0] + zone.after * ways[1]
    straight = extended(run, first, second, (zone.before, zone.after), machine, limits)
    if straight is not None:
        ceiling = straight.ceiling_of((first.motion.number, True, 0))
    else:
        allowed = first.axis_limits.merged(second.axis_limits, np.minimum)
        settings = first.motion.settings, second.motion.settings
        paths = reduced_paths(curve, machine, *settings) or tuple(
            PathLimits(
                zone.before * x.length + zone.after * y.length,
                min(x.velocity, y.velocity),
                min(x.acceleration, y.acceleration),
                min(x.jerk, y.jerk),
            )
            for x, y in zip(one.paths, other.paths, strict=True)
        )
        ceiling = ceiling_of(curve, limits, allowed, paths)
    into, out = ways[0] / length, length / ways[1]
    return Joint(zone, curve, ceiling, (into, 0.0), (out, 0.0), straight)


def _soonest(
    first: Track, second: Track, zone: Zone, weights: tuple[float, float], machine: MachineData
) -> Transition:
    """Return the transition with the shortest total duration of both motions.

    If an overlap has one side that takes much longer than the other, or if it costs time, only the
    part is used in which both motions run. C_VEL keeps the speed where two lines meet [BLD-12]: the
    curve is travelled at constant speed, and overlapping is used only if that costs time.
    """
    one, other = first.pieces[-1], second.pieces[0]
    common = _common_curves(first, second)
    lines = [piece.curve.pose_path for piece in (one, other)]
    are_lines = all(isinstance(line, StraightLine) for line in lines)
    keeps_speed, cosine = False, 1.0
    if are_lines and common is not None and first.motion.criteria[0] == "C_VEL":
        leaving, joining = (curve.tool_path.tangents(np.zeros(1))[0] for curve in common)
        lengths = float(np.linalg.norm(leaving) * np.linalg.norm(joining))
        keeps_speed = lengths > 0.0
        if keeps_speed:  # rounding may take it beyond 1
            cosine = min(max(float(leaving @ joining) / lengths, _BACK), 1.0)
    choices: list[Transition] = [
        Rounding(zone.before, zone.after, weights, slope, cosine)
        for slope in ((_PARABOLA, _SMOOTH) if are_lines else (_SMOOTH,))
    ]

    def duration(transition: Transition) -> float:
        blend = BlendedAxes(one.curve, other.curve, transition)
        ceiling = _ceiling(first, second, transition, blend, blend.rates(blend.grid), machine)
        return _duration(one, other, transition, ceiling)

    times = [duration(transition) for transition in choices]
    most = math.inf
    ending, starting = alone(one.ceiling), alone(other.ceiling)
    if ending is not None and starting is not None:
        exact = ending.duration + starting.duration
        if keeps_speed and min(times) < exact:
            return choices[times.index(min(times))]
        most = _SAVED * exact
        overlap = Overlap(ending.since(1.0 - zone.before), starting.until(zone.after))
        if overlap.is_even:
            choices.append(overlap)
            times.append(duration(overlap))
        if not overlap.is_even or min(times) > most:
            choices.append(overlap.evened())
            times.append(duration(choices[-1]))
        if first.axis_limits.torques is not None and min(times) > exact:
            text = "the blend would need more torque than its motions with a stop between them"
            raise Fault("torque", text, number=1155, rules=("BLD-11",))
    most = max(min(most, min(times) / _SOONER), min(times))
    return choices[next(place for place, time in enumerate(times) if time <= most)]


def _course(
    one: Curve,
    other: Curve,
    common: tuple[PosePathCurve, PosePathCurve] | None,
    zone: Zone,
    limits: AxisLimits,
) -> tuple[tuple[float, float], bool]:
    """Return the lengths of both sides of a zone, and whether the second path continues the first.

    Lengths are mm of the tool if both motions are paths of the tool, otherwise seconds of the axes.
    """
    (leaving,), _, _ = one.rates(np.ones(1))
    (joining,), _, _ = other.rates(np.zeros(1))
    lengths = [0.0, 0.0]
    if common is not None:
        tangents = (
            common[0].tool_path.tangents(np.ones(1)),
            common[1].tool_path.tangents(np.zeros(1)),
        )
        lengths = [float(np.linalg.norm(tangent)) for tangent in tangents]
    if min(lengths) <= 0.0:
        seconds = (float((np.abs(r) / limits.velocity).max()) for r in (leaving, joining))
        lengths = [max(length, _TINY) for length in seconds]
    off = np.abs(joining - leaving * lengths[1] / lengths[0]).max()
    weights = zone.before * lengths[0], zone.after * lengths[1]
    return weights, bool(off <= _STRAIGHT * np.abs(joining).max())


def _duration(one: Piece, other: Piece, transition: Transition, ceiling: Ceiling) -> float:
    """Return the duration of both pieces from rest to rest with a blend in these bounds."""
    into, out = _gears(transition)
    (zone,) = ceiling.stretches
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
    """Return gear and bend at both ends of a blend."""
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
    """Return the bounds on both sides in units of the blend."""
    before, after = one.ceiling.stretches[-1].bounds(1.0), other.ceiling.stretches[0].bounds(1.0)
    return before.scaled(into[0]), after.scaled(1.0 / out[0])


def _common_curves(first: Track, second: Track) -> tuple[PosePathCurve, PosePathCurve] | None:
    """Return both curves if both are paths of the tool in the same frames."""
    one, other = first.pieces[-1].curve, second.pieces[0].curve
    if (
        isinstance(one, PosePathCurve)
        and isinstance(other, PosePathCurve)
        and one.pose_path
        and other.pose_path
        and first.motion.settings.placement == second.motion.settings.placement
    ):
        return one, other
    return None


# ---------------------------------------------------------------------------------------- zones


def _piece(track: Track, *, at_end: bool) -> Piece:
    return track.pieces[-1 if at_end else 0]


def _path_share(track: Track, criterion: str, values: Approximation, *, at_end: bool) -> float:
    """Return the share of a CP motion; 1 if it has no length for this criterion."""
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
    """Return the share on which a part of the programmed speed is lost or gained [BLD-13]."""
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
    """Return the share of a PTP: by $APO_DIS_PTP of each axis, distance of the tool, or both."""
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
    """Return the share on which no axis is farther away than a part of $APO_DIS_PTP [BLD-03]."""
    (travel,), _, _ = curve.rates(np.ones(1))
    machine = curve.arm.machine
    reach = np.array([axis.approximation for axis in (*machine.axes, *machine.externals)])
    return float((share * reach / np.maximum(np.abs(travel), 1e-9)).min())


def _way_share(curve: Curve, distance: float, *, at_end: bool) -> float:
    """Return the share on which the tool travels a distance."""
    way = Way(lambda u: tool_tangents(curve, u))
    if distance >= way.length:
        return 1.0
    wanted = way.length - distance if at_end else distance
    (u,) = way.parameters(np.array([wanted]))
    return float(1.0 - u if at_end else u)
