"""Approximate positioning: where a blend begins and ends, and what it is [BLD-01 to BLD-15].

A zone takes a share of the path before the point and of the path behind it, neither more than half
[BLD-07]. How much is said by the criteria behind the first motion. Where both motions are
paths of the tool in the same frames, the blend is one as well; else it is one of the axes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Approximation, Motion
from interp.robot.kinematics.machine_data import ROBOT_AXES, CartesianLimits, MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.kinematics.targets import check_path
from interp.robot.path.axis_path import BlendedAxes, BlendedOthers, Curve, PosePathCurve
from interp.robot.path.pose_path import Blend, Way
from interp.robot.planning.limits import AxisLimits, Ceiling, PathLimits, ceiling_of
from interp.robot.planning.profile import Bounds, ramp
from interp.robot.planning.timeline import tool_tangents
from interp.robot.planning.tracks import Piece, Track

__all__ = ["Zone", "blend_of", "wants_blend", "zone_of"]

_HALF = 0.5
_SMALLEST = 1e-6
"""Share of a path below which there is nothing to blend."""
_METRE = 1000.0
_SHARE = 0.2
"""Of an axis's acceleration for changes of speed: a blend is short, and bends all along."""


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
    """The zone between two motions, or ``None`` where they cannot be blended.

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


def blend_of(
    first: Track, second: Track, zone: Zone, machine: MachineData, limits: AxisLimits
) -> tuple[Curve, Ceiling]:
    """The blend of a zone, and how fast it may be travelled.

    ``limits`` are those of the machine data, which hold for all axes; on the path of the tool the
    acceleration is at most $ACC_MA.CP (an assumption: no rule tells). So the speed may drop
    [BLD-15]. Raises `Fault` where the blend leads out of the working range.
    """
    axes = first.axis_limits.widest(second.axis_limits)
    one, other = first.pieces[-1].curve, second.pieces[0].curve
    pose_path = _common_pose_path(first, second, zone)
    if (
        pose_path is None
        or not isinstance(one, PosePathCurve)
        or not isinstance(other, PosePathCurve)
    ):
        curve: Curve = BlendedAxes(one, zone.before, other, zone.after)
        if not (one.is_straight and other.is_straight):  # a parabola keeps between its points
            check_path((*machine.axes, *machine.externals), curve.axes(curve.grid))
        paths = _tool_limits(first, second, curve, machine)
    else:
        (start,) = one.axes(np.array([1.0 - zone.before]))
        others = BlendedOthers(one.others, zone.before, other.others, zone.after)
        curve = PosePathCurve(one.arm, one.placement, pose_path, start[:ROBOT_AXES], others)
        paths = _path_limits(first, second, pose_path, machine)
    return curve, ceiling_of(curve, limits, axes, paths, _SHARE)


def _common_pose_path(first: Track, second: Track, zone: Zone) -> Blend | None:
    """The blend of two paths of the tool, if both are such and in the same frames."""
    one, other = first.pieces[-1].curve.pose_path, second.pieces[0].curve.pose_path
    if one is None or other is None:
        return None
    if first.motion.settings.placement != second.motion.settings.placement:
        return None
    return Blend(one, zone.before, other, zone.after)


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
    (travel,), _ = curve.rates(np.ones(1))
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


def _path_limits(
    first: Track, second: Track, pose_path: Blend, machine: MachineData
) -> Sequence[PathLimits]:
    """As fast as the faster of both, and with no more path acceleration than the machine's."""
    grid = np.linspace(0.0, 1.0, 65)
    tangents = pose_path.tangents(grid)
    fastest = float(np.linalg.norm(tangents, axis=1).max())
    sharpest = float(np.linalg.norm(np.gradient(tangents, grid, axis=0), axis=1).max())
    most: CartesianLimits = machine.acceleration
    paths = [*first.pieces[-1].paths[:1], *second.pieces[0].paths[:1]]
    limits = []
    if fastest > 0.0 and paths:
        speed = max(path.velocity for path in paths)
        limits.append(PathLimits(fastest, speed, min(path.acceleration for path in paths)))
    if sharpest > 0.0:
        limits.append(PathLimits(1.0, math.sqrt(most.path * _METRE / sharpest), math.inf))
    return limits


def _tool_limits(
    first: Track, second: Track, curve: Curve, machine: MachineData
) -> Sequence[PathLimits]:
    """Beside a path of the tool, or in T1, a blend of axes is no faster than the path or T1."""
    sides = (first.pieces[-1], second.pieces[0])
    speeds = [path.velocity for piece in sides for path in piece.paths[:1]]
    if any(track.motion.settings.is_reduced for track in (first, second)):
        speeds.append(machine.t1_speed * _METRE)
    if not speeds:
        return ()
    tangents: Array = tool_tangents(curve, np.linspace(0.0, 1.0, 33))
    fastest = float(np.linalg.norm(tangents, axis=1).max())
    return (PathLimits(fastest, max(speeds), math.inf),) if fastest > 0.0 else ()
