"""Faults of the arm: blends, speeds, orientation, frames, targets, splines."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from conformance.sensitivity.planted_fault import (
    Fault,
    Plant,
    constant,
    group_in,
    on,
)
from interp.controller.motion.motions import MotionBuilder
from interp.robot.kinematics.placement import Placement
from interp.robot.path import targets_in_force
from interp.robot.path.targets_in_force import Programmed
from interp.robot.planning import blending, path_events, planned_arm, tracks
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.planning.timeline import Timeline
from interp.robot.planning.tracks import Tracks

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


def _axis_share(alter: Any) -> Plant:
    """``alter`` is given criterion, values of the first motion and those of the own one."""

    def make(right: Any) -> Any:
        def share(track: Any, criterion: str, values: Any, own: Any, *, at_end: bool) -> float:
            return float(right(track, *alter(criterion, values, own), at_end=at_end))

        return share

    return on(blending, "_axis_share", make)


_BLENDS: Final = (
    ("nothing is blended", constant(planned_arm, "zone_of", lambda _first, _second: None)),
    (
        "behind PTP every zone is one of C_PTP",
        _axis_share(lambda _criterion, values, own: ("C_PTP", values, own)),
    ),
)


# ------------------------------------------------------------------------------------ motions


def _paths(alter: Any) -> Plant:
    """The limits along paths are others."""

    def make(right: Any) -> Any:
        def paths(self: Tracks, *given: Any, **more: Any) -> Any:
            return alter(right(self, *given, **more))

        return paths

    return on(Tracks, "paths", make)


def _override(alter: Any) -> Plant:
    return on(
        PlannedArm,
        "override",
        lambda right: lambda self, now, percent: right(self, now, alter(percent)),
    )


_MOTIONS: Final = (
    ("turns of the tool have no limits", _paths(lambda limits: limits[:1])),
    (
        "$VEL_AXIS and $ACC_AXIS count nothing",
        on(Tracks, "programmed", lambda _: lambda self, _settings: self.limits),
    ),
    (
        "$ORI_TYPE counts nothing",
        on(
            tracks,
            "_turning",
            lambda right: lambda settings, a, b: right(replace(settings, orientation="#VAR"), a, b),
        ),
    ),
    ("the override counts twice", _override(lambda percent: percent * percent / 100)),
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
    (
        "$TOOL counts nothing",
        on(Placement, "flange", lambda _: lambda self, point: self.before @ point),
    ),
    (
        "components left out are zero",
        on(Programmed, "components_of", _zero_where_missing),
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
