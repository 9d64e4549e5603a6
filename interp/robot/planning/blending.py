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

from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.solution_choice import check_path
from interp.robot.path.axis_path import (
    AxisPath,
    BlendedAxes,
    Curve,
    JointCurve,
    PosePathCurve,
    Rates,
)
from interp.robot.path.pose_path import GRID, Blend, Line, OrientedPath
from interp.robot.path.speed_profile import SpeedProfile, joined
from interp.robot.path.transition import Overlap, Rounding, Transition
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
from interp.robot.planning.tracks import METRE, Track, Tracks
from interp.values.faults import Fault

#: Slopes of roundings; the first is nearly a parabola, which BLD-12 states for lines.
_PARABOLA, _SMOOTH = 1.0, 2.0
#: Share of a duration above which the transition nearer to a parabola is preferred.
_SOONER = 0.95
#: Share of the duration with an exact stop that such a transition must not exceed.
_SAVED = 0.97
_TINY = 1e-9
#: Relative difference below which directions count as equal.
_STRAIGHT = 1e-3
#: The smallest cosine of a corner whose speed is kept; a reversal has no finite curve.
_BACK = -0.99
_ENDS = np.array([0.0, 1.0])


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
    tracks: Tracks, first: Track, second: Track, zone: Zone, run: StraightRun | None = None
) -> PlannedBlend:
    """Return the blend of a zone; ``run`` is the straight run that ends with the first motion.

    Among the transitions with about the same duration, the one nearest to a parabola is used. Along
    the path of the tool the acceleration is at most $ACC_MA.CP (an assumption, no rule says so).
    The speed may therefore drop [BLD-15]. Raises `Fault` if the blend leaves the working range.
    """
    corner = _Corner(tracks, first, second)
    weights, is_straight = corner.course(zone)
    if is_straight:
        straight = corner.straight_blend(zone, run)
        if straight is not None:
            return straight
        transition: Transition = Rounding(zone.before, zone.after, weights, _SMOOTH)
    else:
        transition = corner.soonest(zone, weights)
    return corner.blend(transition)


class _Corner:
    """The point at which two motions meet.

    ``one`` and ``other`` are the pieces before and after it; ``common`` are both curves if they are
    paths of the tool in the same frames.
    """

    def __init__(self, tracks: Tracks, first: Track, second: Track) -> None:
        self.tracks = tracks
        self.first, self.second = first, second
        self.one, self.other = first.pieces[-1], second.pieces[0]
        self.settings = first.motion.settings, second.motion.settings
        self.common: tuple[PosePathCurve, PosePathCurve] | None = None
        one, other = self.one.curve, self.other.curve
        if (
            isinstance(one, PosePathCurve)
            and isinstance(other, PosePathCurve)
            and one.pose_path
            and other.pose_path
            and one.placement == other.placement
        ):
            self.common = one, other

    def blend(self, transition: Transition) -> PlannedBlend:
        """Return the blend with a transition. Raises `Fault` if it leaves the working range."""
        one, other = self.one.curve, self.other.curve
        axes = BlendedAxes(one, other, transition)
        curve: Curve = JointCurve(one.arm, one.placement, axes)
        if self.common is None:
            check_path(self.tracks.machine.every_axis, curve.axes(curve.grid))
        else:
            start, _ = axes.axes(_ENDS)
            pose_path = self._pose_path(self.common, transition)
            first, second = (each.others for each in self.common)
            others = BlendedAxes(first, second, transition)
            curve = PosePathCurve(one.arm, one.placement, pose_path, start[:ROBOT_AXES], others)
        # The spline of the axes sees little of how quickly the curve begins to bend.
        ends = axes.rates(_ENDS)
        x, y, z = (np.concatenate(both) for both in zip(curve.rates(curve.grid), ends, strict=True))
        in_t1 = self.tracks.reduced_paths(curve, *self.settings)
        slowest = min((path.velocity / path.length for path in in_t1), default=math.inf)
        limits = self.limits(transition, curve, (x, y, z), slowest)
        zone = Zone(transition.before, transition.after)
        return PlannedBlend(zone, curve, limits, *_junctions(transition))

    def limits(
        self, transition: Transition, curve: AxisPath, rates: Rates, slowest: float = math.inf
    ) -> CurveLimits:
        """Return the bounds of a blend along a curve with these derivatives of the axes.

        No torque exceeds its limit. The tool is not faster than on both sides of the blend, and its
        acceleration does not exceed that of the machine data [BLD-15]. Between PTP motions no axis
        exceeds its programmed speed.
        """
        into, out = _junctions(transition)
        limits = self.first.axis_limits.merged(self.second.axis_limits, np.maximum)
        programmed, most = slowest, math.inf
        if self.common is not None:
            tangents = self._pose_path(self.common, transition).tangents(GRID)
            bends = np.gradient(tangents, GRID[1], axis=0)
            sharpest, fastest = (
                max(float(np.linalg.norm(rows, axis=1).max()), _TINY) for rows in (bends, tangents)
            )
            speed = max(path.velocity for side in (self.one, self.other) for path in side.paths[:1])
            programmed = min(programmed, speed / fastest)
            most = math.sqrt(self.tracks.machine.acceleration.path * METRE / sharpest)
        elif not self.first.is_cp and not self.second.is_cp:
            speeds = limits.velocity / np.maximum(np.abs(rates[0]), _TINY)
            programmed = min(programmed, float(speeds.min()))
        before, after = self.one.limits.stretches[-1], self.other.limits.stretches[0]
        beside = before.bounds() * into.gear, after.bounds() * (1.0 / out.gear)
        size = before.size / into.gear
        curve_limits = constant_speed_limits(rates, limits, beside, programmed, most, size)
        return curve_limits.within(self.first.axis_limits.torques, curve)

    def straight_blend(self, zone: Zone, run: StraightRun | None) -> PlannedBlend | None:
        """Return the blend of two straight motions, the second in the direction of the first.

        The blend is straight, too. Return ``None`` if it would miss the point between them.
        """
        one, other = self.one, self.other
        parts = StraightPart.of(one.curve), StraightPart.of(other.curve)
        curve = straight_through(parts, 1.0 - zone.before, zone.after)
        if curve is None or len(one.paths) != len(other.paths):
            return None
        way, way_behind = (part.way for part in parts)
        length = zone.before * way + zone.after * way_behind
        shares = zone.before, zone.after
        straight = extended(self.tracks, run, self.first, self.second, shares)
        if straight is not None:
            curve_limits = straight.limits  # of the whole run: the plan gives each section its part
        else:
            allowed = self.first.axis_limits.merged(self.second.axis_limits, np.minimum)
            paths = self.tracks.reduced_paths(curve, *self.settings) or tuple(
                PathLimits(
                    zone.before * x.length + zone.after * y.length,
                    min(x.velocity, y.velocity),
                    min(x.acceleration, y.acceleration),
                    min(x.jerk, y.jerk),
                )
                for x, y in zip(one.paths, other.paths, strict=True)
            )
            curve_limits = curve_limits_of(curve, self.tracks.limits, allowed, paths)
        into, out = Junction(way / length), Junction(length / way_behind)
        return PlannedBlend(zone, curve, curve_limits, into, out, straight)

    def soonest(self, zone: Zone, weights: tuple[float, float]) -> Transition:
        """Return the transition with the shortest total duration of both motions.

        If an overlap has one side that takes much longer than the other, or if it costs time, only
        the part is used in which both motions run. C_VEL keeps the speed where two lines meet
        [BLD-12]: the curve is travelled at constant speed, and overlapping is used only if that
        costs time.
        """
        sides = [side.curve.pose_path for side in (self.one, self.other)]
        are_lines = all(isinstance(p, OrientedPath) and isinstance(p.shape, Line) for p in sides)
        keeps_speed, cosine = False, 1.0
        if are_lines and self.common is not None and self.first.motion.criteria[0] == "C_VEL":
            (leaving,), (joining,) = (
                curve.tool_path.tangents(np.zeros(1)) for curve in self.common
            )
            lengths = float(np.linalg.norm(leaving) * np.linalg.norm(joining))
            keeps_speed = bool(lengths)
            if keeps_speed:  # rounding may take it beyond 1
                cosine = min(max(float(leaving @ joining) / lengths, _BACK), 1.0)
        choices: list[Transition] = [
            Rounding(zone.before, zone.after, weights, slope, cosine)
            for slope in ((_PARABOLA, _SMOOTH) if are_lines else (_SMOOTH,))
        ]
        times = [self._duration(transition) for transition in choices]
        ending, starting = _parameter(self.one.limits), _parameter(self.other.limits)
        exact = ending.duration + starting.duration
        if keeps_speed and min(times) < exact:
            return choices[times.index(min(times))]
        overlap = Overlap(
            ending.between(ending.time_at(1.0 - zone.before), ending.duration),
            starting.between(0.0, starting.time_at(zone.after)),
        )
        if overlap.is_even:
            choices.append(overlap)
            times.append(self._duration(overlap))
        if not overlap.is_even or min(times) > _SAVED * exact:
            choices.append(overlap.evened())
            times.append(self._duration(choices[-1]))
        if self.first.axis_limits.torques is not None and min(times) > exact:
            text = "the blend would need more torque than its motions with a stop between them"
            raise Fault("torque", text, number=1155, rules=("BLD-11",))
        most = max(min(_SAVED * exact, min(times) / _SOONER), min(times))
        return choices[next(place for place, time in enumerate(times) if time <= most)]

    def course(self, zone: Zone) -> tuple[tuple[float, float], bool]:
        """Return the lengths of both sides of a zone, and whether the path goes straight on.

        Lengths are mm of the tool if both motions are paths of the tool, otherwise seconds of the
        axes.
        """
        (leaving,), _, _ = self.one.curve.rates(np.ones(1))
        (joining,), _, _ = self.other.curve.rates(np.zeros(1))
        velocity = self.tracks.limits.velocity
        before, after = (
            max(float((np.abs(rates) / velocity).max()), _TINY) for rates in (leaving, joining)
        )
        if self.common is not None:
            one, other = (curve.tool_path for curve in self.common)
            tangents = one.tangents(np.ones(1)), other.tangents(np.zeros(1))
            lengths = [float(np.linalg.norm(tangent)) for tangent in tangents]
            if all(lengths):
                before, after = lengths
        off = np.abs(joining - leaving * after / before).max()
        weights = zone.before * before, zone.after * after
        return weights, bool(off <= _STRAIGHT * np.abs(joining).max())

    def _duration(self, transition: Transition) -> float:
        """Return the duration of both pieces from rest to rest, with a blend of the axes."""
        blend = BlendedAxes(self.one.curve, self.other.curve, transition)
        (zone,) = self.limits(transition, blend, blend.rates(blend.grid)).stretches
        into, out = _junctions(transition)
        before = self.one.limits.between(0.0, 1.0 - transition.before)
        after = self.other.limits.between(transition.after, 1.0)
        stretches = [
            *(JoinedStretch(stretch, SAME_CURVE) for stretch in before),
            JoinedStretch(zone, into),
            *(JoinedStretch(s, SAME_CURVE if place else out) for place, s in enumerate(after)),
        ]
        found = schedule(stretches, AT_REST, 1.0)
        return math.inf if found is None else found.duration

    @staticmethod
    def _pose_path(curves: tuple[PosePathCurve, PosePathCurve], transition: Transition) -> Blend:
        return Blend(curves[0].tool_path, curves[1].tool_path, transition)


@lru_cache(maxsize=64)  # a motion is the second of one blend, then the first of another
def _parameter(curve_limits: CurveLimits) -> SpeedProfile:
    """Return the parameter of a curve over time, from rest to rest."""
    stretches = [JoinedStretch(stretch, SAME_CURVE) for stretch in curve_limits.stretches]
    found = schedule(stretches, AT_REST, 1.0)
    assert found is not None, "from rest a curve can always be travelled"
    steps = zip(curve_limits.stretches, found.profiles, strict=True)
    return joined([profile.scaled(1.0 / stretch.size) for stretch, profile in steps])


def _junctions(transition: Transition) -> tuple[Junction, Junction]:
    """Return the junctions at both ends of a blend."""
    leaving, joining = transition.rates(_ENDS)
    speed, bend, _ = leaving[:, 0].tolist()
    gear, bend_out, _ = joining[:, 1].tolist()
    return Junction(1.0 / speed, -bend / speed**3), Junction(gear, bend_out)
