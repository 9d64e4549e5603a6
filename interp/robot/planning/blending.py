"""Approximate positioning: the shape of a blend, and the bounds along it [BLD-08 to BLD-15].

A blend replaces the zone of two motions (`blend_zones`). If both are CP motions in the same frames,
it is a path of the tool, too; otherwise it is a curve of the axes. So a motion has up to three
parts [MOT-17], and the point itself is not passed [BLD-08]. Whether both sides are equal is not
known [CON-08].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.targets import check_path
from interp.robot.path.axis_path import (
    BlendedAxes,
    BlendedExternals,
    Curve,
    PosePathCurve,
    Rates,
)
from interp.robot.path.pose_path import Blend, StraightLine
from interp.robot.path.transition import Cubics, Overlap, Rounding, Transition
from interp.robot.planning.axis_limits import AxisLimits
from interp.robot.planning.blend_zones import Zone
from interp.robot.planning.junctions import AT_REST, SAME_CURVE, JoinedStretch, Junction
from interp.robot.planning.limits import (
    CurveLimits,
    PathLimits,
    constant_speed_limits,
    curve_limits_of,
)
from interp.robot.planning.schedule import schedule
from interp.robot.planning.straight_run import StraightPart, StraightRun, extended, straight_through
from interp.robot.planning.tracks import Piece, Track, reduced_paths
from interp.values.faults import Fault

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


@dataclass(frozen=True, slots=True, eq=False)
class PlannedBlend:
    """A blend: its curve, the bounds along it, and its connection to both motions.

    ``zone`` is what it replaces of both, which may be less than the zone requested. ``into`` and
    ``out`` are the junctions at its start and at its end. ``straight`` is the straight run of which
    both motions are parts, if they are.
    """

    zone: Zone
    curve: Curve
    limits: CurveLimits
    into: Junction
    out: Junction
    straight: StraightRun | None = None


def blend_of(
    first: Track,
    second: Track,
    zone: Zone,
    machine: MachineData,
    limits: AxisLimits,
    run: StraightRun | None = None,
) -> PlannedBlend:
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
        check_path(machine.every_axis, curve.axes(curve.grid))
    else:
        pose_path = Blend(common[0].tool_path, common[1].tool_path, transition)
        (start,) = one.axes(np.array([1.0 - zone.before]))
        others = BlendedExternals(common[0].others, common[1].others, transition)
        curve = PosePathCurve(one.arm, one.placement, pose_path, start[:ROBOT_AXES], others)
    # The spline of the axes sees little of how quickly the curve begins to bend.
    ends = axes.rates(np.array([0.0, 1.0]))
    x, y, z = (np.concatenate(both) for both in zip(curve.rates(curve.grid), ends, strict=True))
    settings = first.motion.settings, second.motion.settings
    in_t1 = reduced_paths(curve, machine, *settings)
    slowest = min((path.velocity / path.length for path in in_t1), default=math.inf)
    curve_limits = _blend_limits(first, second, transition, curve, (x, y, z), machine, slowest)
    return PlannedBlend(zone, curve, curve_limits, *_junctions(transition))


def _blend_limits(
    first: Track,
    second: Track,
    transition: Transition,
    curve: Curve,
    rates: Rates,
    machine: MachineData,
    slowest: float = math.inf,
) -> CurveLimits:
    """Return the bounds of a blend along a curve with these derivatives of the axes.

    No torque exceeds its limit. The tool is not faster than on both sides of the blend, and its
    acceleration does not exceed that of the machine data [BLD-15]. Between PTP motions no axis
    exceeds its programmed speed.
    """
    one, other = first.pieces[-1], second.pieces[0]
    into, out = _junctions(transition)
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
    before, after = (
        one.limits.stretches[-1].bounds(1.0),
        other.limits.stretches[0].bounds(1.0),
    )
    beside = before * into.gear, after * (1.0 / out.gear)
    size = one.limits.stretches[-1].size / into.gear
    curve_limits = constant_speed_limits(rates, limits, beside, programmed, most, size)
    return curve_limits.within(first.axis_limits.torques, curve)


def _straight_on(
    first: Track,
    second: Track,
    zone: Zone,
    machine: MachineData,
    limits: AxisLimits,
    run: StraightRun | None,
) -> PlannedBlend | None:
    """Return the blend of two straight motions of which the second continues in the same direction.

    The blend is straight, too. Return ``None`` if it would miss the point between them.
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
        curve_limits = straight.curve_limits_of((first.motion.number, True, 0))
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
        curve_limits = curve_limits_of(curve, limits, allowed, paths)
    into, out = Junction(ways[0] / length), Junction(length / ways[1])
    return PlannedBlend(zone, curve, curve_limits, into, out, straight)


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
        curve_limits = _blend_limits(
            first, second, transition, blend, blend.rates(blend.grid), machine
        )
        return _duration(one, other, transition, curve_limits)

    times = [duration(transition) for transition in choices]
    most = math.inf
    ending, starting = _parameter(one.limits), _parameter(other.limits)
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


def _duration(one: Piece, other: Piece, transition: Transition, curve_limits: CurveLimits) -> float:
    """Return the duration of both pieces from rest to rest with a blend in these bounds."""
    into, out = _junctions(transition)
    (zone,) = curve_limits.stretches
    before = one.limits.between(0.0, 1.0 - transition.before)
    after = other.limits.between(transition.after, 1.0)
    stretches = [
        *(JoinedStretch(stretch, SAME_CURVE) for stretch in before),
        JoinedStretch(zone, into),
        *(JoinedStretch(s, SAME_CURVE if place else out) for place, s in enumerate(after)),
    ]
    profiles = schedule(stretches, AT_REST, 1.0)
    return math.inf if profiles is None else sum(profile.duration for profile in profiles)


@lru_cache(maxsize=64)  # a motion is the second of one blend, then the first of another
def _parameter(curve_limits: CurveLimits) -> Cubics | None:
    """Return the parameter of a curve over time, from rest to rest, or ``None`` if impossible."""
    stretches = [JoinedStretch(stretch, SAME_CURVE) for stretch in curve_limits.stretches]
    profiles = schedule(stretches, AT_REST, 1.0)
    if profiles is None:
        return None
    knots, time = [], 0.0
    for stretch, profile in zip(curve_limits.stretches, profiles, strict=True):
        start, size = stretch.start, stretch.size
        for begin, place, *rates in profile.knots:
            knots.append((time + begin, start + place / size, *(rate / size for rate in rates)))
        time += profile.duration
    return Cubics(np.array(knots), time)


def _junctions(transition: Transition) -> tuple[Junction, Junction]:
    """Return the junctions at both ends of a blend."""
    leaving, joining = transition.rates(np.array([0.0, 1.0]))
    gear_in, bend_in = 1.0 / leaving[0, 0], -leaving[1, 0] / leaving[0, 0] ** 3
    gear_out, bend_out = joining[0, 1], joining[1, 1]
    if abs(leaving[1, 0]) < _EVEN * leaving[0, 0]:
        bend_in = 0.0
    if abs(bend_out) < _EVEN * gear_out:
        bend_out = 0.0
    return Junction(float(gear_in), float(bend_in)), Junction(float(gear_out), float(bend_out))


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
