"""Blend zones: the shares of two paths that a blend replaces [BLD-01 to BLD-07].

The criteria of the first motion determine them; each is at most half of its path [BLD-07].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Approximation, Motion
from interp.robot.path.axis_path import Curve
from interp.robot.path.pose_path import OrientedPath
from interp.robot.path.tool_path import tool_way
from interp.robot.planning.ramps import ramp
from interp.robot.planning.tracks import Piece, Track

_HALF = 0.5
#: Share of a path below which motions are not blended.
_SMALLEST = 1e-6


@dataclass(frozen=True, slots=True)
class Zone:
    """The shares of the first and the second path that a blend replaces."""

    before: float
    after: float


def wants_blend(motion: Motion) -> bool:
    """Return whether a motion is approximated, with a zone larger than zero."""
    values = motion.settings.approximation
    sizes = {"C_PTP": values.cptp, "C_VEL": values.cvel, "C_ORI": values.cori}
    return bool(motion.criteria) and sizes.get(motion.criteria[0], values.cdis) > 0.0


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


def _piece(track: Track, *, at_end: bool) -> Piece:
    return track.pieces[-1 if at_end else 0]


def _path_share(track: Track, criterion: str, values: Approximation, *, at_end: bool) -> float:
    """Return the share of a CP motion; 1 if it has no length for this criterion."""
    if criterion == "C_VEL":
        return _braking_share(track, values.cvel / 100.0, at_end=at_end)
    curve = _piece(track, at_end=at_end).curve
    pose_path = curve.pose_path
    if isinstance(pose_path, OrientedPath):
        angle, length = math.degrees(max(pose_path.angles)), pose_path.length
        return _share(values.cori, angle) if criterion == "C_ORI" else _share(values.cdis, length)
    return 1.0 if criterion == "C_ORI" else _way_share(curve, values.cdis, at_end=at_end)


def _share(part: float, whole: float) -> float:
    """Return the share of a part, all if the whole is less."""
    return part / whole if part < whole else 1.0


def _braking_share(track: Track, share: float, *, at_end: bool) -> float:
    """Return the share on which a part of the programmed speed is lost or gained [BLD-13]."""
    stretches = _piece(track, at_end=at_end).limits.stretches
    stretch = stretches[-1] if at_end else stretches[0]
    return ramp(0.0, share * stretch.programmed, stretch.normal).length


def _axis_share(
    track: Track, criterion: str, values: Approximation, own: Approximation, *, at_end: bool
) -> float:
    """Return the share of a PTP: by $APO_DIS_PTP of each axis, distance of the tool, or both."""
    curve = _piece(track, at_end=at_end).curve
    by_way = criterion in {"C_DIS", "C_SPL"}
    takes_both = track.motion.kind == "SPTP"
    shares = []
    if not by_way or takes_both:
        shares.append(_turning_share(curve, min(own.cptp, 100.0) / 100.0))
    if by_way or (takes_both and values.cdis > 0.0):
        shares.append(_way_share(curve, values.cdis, at_end=at_end))
    return min(shares)


def _turning_share(curve: Curve, share: float) -> float:
    """Return the share on which no axis is farther away than a part of $APO_DIS_PTP [BLD-03]."""
    (travel,), _, _ = curve.rates(np.ones(1))
    machine = curve.arm.machine
    reach = np.array([axis.approximation for axis in machine.every_axis])
    moved = travel.nonzero()  # an external axis at rest often has the distance zero
    return float((share * reach[moved] / np.abs(travel[moved])).min(initial=_HALF))


def _way_share(curve: Curve, distance: float, *, at_end: bool) -> float:
    """Return the share on which the tool travels a distance."""
    way = tool_way(curve)
    if distance >= way.length:
        return 1.0
    wanted = way.length - distance if at_end else distance
    (u,) = way.parameters(np.array([wanted]))
    return float(1.0 - u if at_end else u)
