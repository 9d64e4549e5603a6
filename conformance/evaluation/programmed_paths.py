"""Programmed paths of motions, from point to point, without blends.

They follow from targets and machine data, not from the executed path.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from conformance.evaluation.motions import POINT, Array, EndedMotion, completed
from conformance.evaluation.path_geometry import drawn, feet, lengths
from interp.robot.arm import Target
from interp.robot.kinematics.machine_data import ROBOT_AXES

_SHARES: Final = np.linspace(0.0, 1.0, 501)[:, None]


@dataclass(frozen=True)
class ProgrammedPath:
    """The programmed path of a motion: axes (n, axes) of a PTP if known, and tool points (n, 3)."""

    axes: Array | None
    points: Array

    @cached_property
    def sums(self) -> Array:
        """The path length of the tool up to each point in mm."""
        return lengths(self.points)

    @property
    def middle(self) -> float:
        """The path length up to the middle of the parameter in mm."""
        return float(np.interp(0.5, np.linspace(0.0, 1.0, len(self.sums)), self.sums))

    def length_to(self, point: Array) -> float:
        """Return the path length in mm up to the place that is nearest to a point."""
        shares, off = feet(self.points[:-1], self.points[1:], point)
        place = int(np.argmin(off))
        return float(self.sums[place] + shares[place] * np.diff(self.sums)[place])


def programmed_paths(motions: Sequence[EndedMotion]) -> Iterator[ProgrammedPath | None]:
    """Yield the programmed path of each motion, ``None`` if that is not completely numeric."""
    axes: Array | None = None
    point: Array | None = None
    placement = None
    for before, one in zip((None, *motions), motions, strict=False):
        if before is not None and not one.follows(before):
            axes = point = None
        if one.begins or placement != one.motion.settings.placement:
            axes = one.ends[0] if one.begins else axes
            point = None if axes is None else one.points(axes[None])[0]
        placement = one.motion.settings.placement
        start, axes = axes, one.ends[1] if one.stops else axes_of(one, axes)
        origin, point = point, _point(one, one.motion.target, point)
        if axes is not None:
            point = one.points(axes[None])[0]
        yield _path(one, start, axes, origin, point)


def _path(
    one: EndedMotion,
    start: Array | None,
    end: Array | None,
    origin: Array | None,
    last: Array | None,
) -> ProgrammedPath | None:
    """Return the path between axes for a PTP, else between points; ``None`` if unknown."""
    motion = one.motion
    is_plain = not motion.parts and motion.angle is None and one.machine.palletising is None
    if not is_plain or not one.is_in_base:
        return None
    match motion.kind:
        case "PTP" | "SPTP" if start is not None and end is not None:
            axes = start + _SHARES * (end - start)
            return ProgrammedPath(axes, one.points(axes))
        case "LIN" | "SLIN" if origin is not None and last is not None:
            return ProgrammedPath(None, np.array([origin, last]))
        case "CIRC" | "SCIRC" if origin is not None and last is not None:
            middle = _point(one, motion.auxiliary, origin)
            if middle is not None:
                arc = drawn("circle", np.array([origin, middle, last]), len(_SHARES))
                return ProgrammedPath(None, arc)
    return None


def axes_of(one: EndedMotion, before: Array | None) -> Array | None:
    """Return the axes of a target given as axes; omitted ones keep their value [MOT-16]."""
    names = [axis.name for axis in one.machine.every_axis]
    target = one.motion.target
    if before is None or one.motion.is_relative or not set(names[:ROBOT_AXES]) & set(target):
        return None
    return completed(target, names, before)


def _point(one: EndedMotion, target: Target | None, before: Array | None) -> Array | None:
    """Return the point of a target; omitted components keep their value [MOT-16]."""
    given = set(POINT) & set(target or {})
    if target is None or not given or one.motion.is_relative or (before is None and len(given) < 3):
        return None
    return completed(target, POINT, np.zeros(3) if before is None else before)
