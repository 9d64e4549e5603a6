"""Faults of the arm: blends, speeds, orientation, frames, targets, splines."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Final

import numpy as np

from conformance.sensitivity.planted_fault import (
    Fault,
    Plant,
    constant,
    group_in,
    on,
    several,
)
from interp.controller.motions import MotionBuilder
from interp.robot.kinematics.central_wrist import CentralWrist
from interp.robot.kinematics.placement import Placement
from interp.robot.path import targets_in_force
from interp.robot.path.axis_path import JointLine
from interp.robot.path.pose_path import Blend, StraightLine
from interp.robot.path.targets_in_force import Programmed
from interp.robot.planning import blending, path_events, planned_arm, spline_blocks, tracks
from interp.robot.planning.blending import Zone
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.planning.timeline import Timeline
from interp.robot.planning.tracks import Track, Tracks

_CYCLE: Final = 12_000


def faults() -> tuple[Fault, ...]:
    """All of them; they are looked for on the kinematic robot, which records the path."""
    moving = ("motion", "posture", "spline", "interrupt", "blending", "message")
    return (
        *group_in("blends", ("blending", "trigger", "spline", "advance"), _BLENDS),
        *group_in("motions", moving, _MOTIONS),
        *group_in("frames and targets", ("motion", "posture", "data"), _TARGETS),
        *group_in("splines", ("spline",), _SPLINES),
    )


# ------------------------------------------------------------------------------------ blends


def _zone(alter: Any) -> Plant:
    """The zones of blends are others."""

    def make(right: Any) -> Any:
        def zone_of(first: Track, second: Track) -> Zone | None:
            found = right(first, second)
            return None if found is None else alter(found)

        return zone_of

    return on(planned_arm, "zone_of", make)


def _chord(right: Any) -> Any:
    def at(self: Blend, u: Any) -> Any:
        _, rotations = right(self, u)
        (start, end), _ = right(self, np.array([0.0, 1.0]))
        return start + u[:, None] * (end - start), rotations

    return at


def _hugging(right: Any) -> Any:
    return lambda before, after, weights, _slope, *others: right(
        before, after, weights, 2.9, *others
    )


def _unlimited(right: Any) -> Any:
    def even_ceiling(rates: Any, limits: Any, beside: Any, *speeds: float) -> Any:
        *_, size = speeds
        slower = tuple(rate / 100.0 for rate in rates)
        return right(slower, limits, beside, math.inf, math.inf, size)

    return even_ceiling


def _axis_share(alter: Any) -> Plant:
    """``alter`` is given criterion, values of the first motion and those of the own one."""

    def make(right: Any) -> Any:
        def share(track: Any, criterion: str, values: Any, own: Any, *, at_end: bool) -> float:
            return float(right(track, *alter(criterion, values, own), at_end=at_end))

        return share

    return on(blending, "_axis_share", make)


def _path_share(kind: str, factor: float) -> Plant:
    def make(right: Any) -> Any:
        def share(track: Any, criterion: str, values: Any, *, at_end: bool) -> float:
            found = float(right(track, criterion, values, at_end=at_end))
            return found * factor if criterion == kind else found

        return share

    return on(blending, "_path_share", make)


_BLENDS: Final = (
    ("nothing is blended", constant(planned_arm, "zone_of", lambda _first, _second: None)),
    ("zones are 10 % too large", _zone(lambda z: Zone(z.before * 1.1, z.after * 1.1))),
    ("the zone behind the point is half as large", _zone(lambda z: Zone(z.before, z.after / 2))),
    ("a zone may take more than half of a path", constant(blending, "_HALF", 0.9)),
    ("a zone takes a quarter of a path at most", constant(blending, "_HALF", 0.25)),
    ("the apex is at the end of the blend", constant(path_events, "_APEX", 1.0)),
    ("a blend is a straight line", on(Blend, "at", _chord)),
    ("a blend keeps nearer to the corner", on(blending, "Rounding", _hugging)),
    ("a blend may be as fast as it likes", on(blending, "even_ceiling", _unlimited)),
    (
        "$APO.CPTP of the second motion counts nothing",
        _axis_share(lambda criterion, values, _own: (criterion, values, values)),
    ),
    (
        "behind PTP every zone is one of C_PTP",
        _axis_share(lambda _criterion, values, own: ("C_PTP", values, own)),
    ),
    (
        "before PTP every zone is one of C_DIS",
        _axis_share(lambda _criterion, values, own: ("C_DIS", values, own)),
    ),
    ("$APO.CDIS counts twice", _path_share("C_DIS", 2.0)),
    ("$APO.CORI counts twice", _path_share("C_ORI", 2.0)),
    ("$APO.CVEL counts a half", _path_share("C_VEL", 0.5)),
)


# ------------------------------------------------------------------------------------ motions


def _paths(alter: Any) -> Plant:
    """The limits along paths are others."""

    def make(right: Any) -> Any:
        def paths(self: Tracks, *given: Any, **more: Any) -> Any:
            return alter(right(self, *given, **more))

        return paths

    return on(Tracks, "paths", make)


def _scaled(**factors: float) -> Any:
    def alter(limits: Any) -> Any:
        return tuple(
            replace(one, **{name: getattr(one, name) * by for name, by in factors.items()})
            for one in limits
        )

    return alter


def _bulging(right: Any) -> Any:
    def at(self: StraightLine, u: Any) -> Any:
        positions, rotations = right(self, u)
        return positions + np.sin(np.pi * u)[:, None] * np.array([0.0, 0.0, 0.2]), rotations

    return at


def _uneven(right: Any) -> Any:
    def axes(self: Any, u: Any) -> Any:
        found = np.array(right(self, u))
        found[:, 0] = right(self, u * u)[:, 0]
        return found

    return axes


def _fast_axes(right: Any) -> Any:
    def limits(machine: Any) -> Any:
        found = right(machine)
        return replace(found, velocity=found.velocity * 1.1)

    return limits


def _override(alter: Any) -> Plant:
    return on(
        PlannedArm,
        "override",
        lambda right: lambda self, now, percent: right(self, now, alter(percent)),
    )


def _never_aborted(right: Any) -> Any:
    return lambda self, motion, before, *, is_after_abort=False: right(
        self, motion, before, is_after_abort=is_after_abort and False
    )


_MOTIONS: Final = (
    ("paths are 5 % too fast", _paths(_scaled(velocity=1.05))),
    ("paths are 5 % too slow", _paths(_scaled(velocity=0.95))),
    ("paths are accelerated twice as hard", _paths(_scaled(acceleration=2.0))),
    ("turns of the tool have no limits", _paths(lambda limits: limits[:1])),
    (
        "$VEL_AXIS and $ACC_AXIS count nothing",
        on(Tracks, "programmed", lambda _: lambda self, _settings: self.limits),
    ),
    ("axes are 10 % faster than they can be", on(tracks, "axis_limits", _fast_axes)),
    ("a straight line bulges by 0.2 mm", on(StraightLine, "at", _bulging)),
    ("the first axis is out of step with the others", on(JointLine, "axes", _uneven)),
    (
        "CA counts nothing",
        on(tracks, "circle_through", lambda right: lambda a, b, c, _angle: right(a, b, c)),
    ),
    (
        "$ORI_TYPE counts nothing",
        on(
            tracks,
            "_turning",
            lambda right: lambda settings, a, b: right(replace(settings, orientation="#VAR"), a, b),
        ),
    ),
    (
        "$CIRC_TYPE counts nothing",
        on(
            tracks,
            "_along_circle",
            lambda right: lambda settings, *more: right(replace(settings, circle="#BASE"), *more),
        ),
    ),
    ("no path is too fast for an axis", on(Tracks, "check_speed", lambda _: lambda *_given: None)),
    ("the override counts twice", _override(lambda percent: percent * percent / 100)),
    ("an override of 0 moves on", _override(lambda percent: percent or 100.0)),
    (
        "motions without length are not told",
        on(Track, "notices", lambda _: property(lambda _s: ())),
    ),
    ("CIRC behind RESUME stays a circle", on(Tracks, "track", _never_aborted)),
    (
        "set-points come a cycle late",
        on(Timeline, "sample", lambda right: lambda self, times: right(self, times - _CYCLE)),
    ),
)


# ------------------------------------------------------------------------------------ targets


def _ptp_target(**changes: Any) -> Plant:
    return on(
        targets_in_force,
        "ptp_target",
        lambda right: lambda *given, **more: right(*given, **{**more, **changes}),
    )


def _components(alter: Any) -> Plant:
    """``alter`` is given whether a target is relative, and to what."""

    def make(right: Any) -> Any:
        def components(
            self: Programmed,
            target: Any,
            placement: Placement,
            is_relative: bool = False,
            reference: str | None = None,
        ) -> Any:
            return right(self, target, placement, *alter(is_relative, reference))

        return components

    return on(Programmed, "components_of", make)


def _zero_where_missing(right: Any) -> Any:
    def components(self: Programmed, target: Any, placement: Placement, *more: Any) -> Any:
        whole = dict.fromkeys("XYZABC", 0.0)
        is_plain = not (more and more[0]) and not any(
            name[0] == "A" and name != "A" for name in target
        )
        return right(self, {**whole, **target} if is_plain else target, placement, *more)

    return components


_TARGETS: Final = (
    ("the Status of a target counts nothing", _ptp_target(status=None)),
    ("the Turn of a target counts nothing", _ptp_target(turn=None)),
    (
        "bit 2 of the Status is the wrong way round",
        on(CentralWrist, "status", lambda right: lambda self, axes: right(self, axes) ^ 4),
    ),
    (
        "$BASE counts nothing",
        on(Placement, "before", lambda _: property(lambda self: self.robroot.inverse())),
    ),
    (
        "$TOOL counts nothing",
        on(Placement, "flange", lambda _: lambda self, point: self.before @ point),
    ),
    (
        "$ROBROOT counts nothing",
        on(Placement, "before", lambda _: property(lambda self: self.base)),
    ),
    ("$IPO_MODE counts nothing", on(Placement, "in_path", lambda _: lambda _self, point: point)),
    (
        "relative targets are absolute",
        _components(lambda _is_relative, reference: (False, reference)),
    ),
    (
        "targets relative to #TOOL are relative to #BASE",
        _components(lambda is_relative, _reference: (is_relative, "#BASE")),
    ),
    (
        "components left out are zero",
        on(Programmed, "components_of", _zero_where_missing),
    ),
    (
        "software limit switches are not looked at",
        several(
            constant(targets_in_force, "check_limits", lambda *_given: None),
            constant(planned_arm, "check_limits", lambda *_given: None),
        ),
    ),
)


# ------------------------------------------------------------------------------------ splines


def _late_chance(_right: Any) -> Any:
    def chance(self: Any, place: Any, part: Any, _now: int, _stop_from: Any) -> Any:
        return self.time(*self._on_path(place, part))

    return chance


def _on_end(right: Any) -> Any:
    def on_path(self: Any, place: Any, part: Any) -> Any:
        return right(self, replace(place, on_start=False), part)

    return on_path


_SPLINES: Final = (
    (
        "CONST_VEL and TIME_BLOCK count nothing",
        constant(spline_blocks, "with_ranges", lambda _m, p: p),
    ),
    (
        "conditional stops brake at their place only",
        on(path_events._Clock, "last_chance", _late_chance),
    ),
    ("places in blocks count from the end always", on(path_events._Clock, "_on_path", _on_end)),
    (
        "values behind WITH count nothing",
        on(
            MotionBuilder,
            "_part",
            lambda right: lambda self, item, *more: right(self, replace(item, values=()), *more),
        ),
    ),
)
