"""Meaning of a programmed target: omitted components, relative targets, axes and points.

`Programmed` is the last target that was programmed, whether the arm has got there or not: relative
motions add to it, and components left out keep its values [MOT-14, MOT-16].
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Motion, Target
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solver import Array, Kinematics
from interp.robot.kinematics.targets import Singularity, TargetStatus, check_limits, ptp_target
from interp.values.faults import Fault
from interp.values.poses import Pose

_COMPONENTS = ("X", "Y", "Z", "A", "B", "C")
_AXES = tuple(f"A{i}" for i in range(1, ROBOT_AXES + 1))
_EXTERNALS = tuple(f"E{i}" for i in range(1, 7))


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """Where a PTP motion leads; ``components`` where it was given as a point.

    ``is_singular`` is message 2868, a notification [POS-08].
    """

    axes: Array
    components: tuple[float, ...] | None = None
    is_singular: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Programmed:
    """A target as it stands: all axes, and the point with the frames it was given in.

    ``components`` are X…C as the program gave them, so that one left out keeps its very value;
    in other frames the components are those of the same place there (unconfirmed).
    """

    arm: Kinematics
    axes: Array
    components: tuple[float, ...] | None = None
    placement: Placement | None = None

    @property
    def flange(self) -> Pose:
        """The flange in front of the robot's foot."""
        return Pose.from_matrix(self.arm.forward(self.axes[:ROBOT_AXES]).tolist())

    def reached(
        self, axes: Array, components: tuple[float, ...] | None, placement: Placement
    ) -> Programmed:
        """The next target, with its components where a point was given."""
        return Programmed(self.arm, axes, components, placement)

    def point(self, placement: Placement) -> tuple[float, ...]:
        """X, Y, Z, A, B, C of the target in given frames."""
        if self.components is not None and placement == self.placement:
            return self.components
        return self.pose_in(placement).components

    def pose_in(self, placement: Placement) -> Pose:
        """The target as a point in given frames, where its external axes have brought them."""
        return placement.at(self.axes[ROBOT_AXES:].tolist()).point(self.flange)

    def externals(self, target: Target, is_relative: bool) -> Array:
        """External axes of a target. Raises `Fault` 1447 beyond their limits."""
        values = self.axes[ROBOT_AXES:].copy()
        for place, name in enumerate(_EXTERNALS[: len(values)]):
            if name in target:
                values[place] = target[name] + (values[place] if is_relative else 0.0)
        check_limits(self.arm.machine.externals, values.tolist())
        return values

    def components_of(
        self,
        target: Target,
        placement: Placement,
        is_relative: bool = False,
        reference: str | None = None,
    ) -> tuple[float, ...]:
        """X, Y, Z, A, B, C of a Cartesian target; one of axes is the point where they lead.

        Relative to #TOOL the target is a frame in the last point; relative to #BASE each
        component adds to that of the last point [MOT-14].
        """
        check_finite(target)
        if has_axes(target):
            axes = self._axes(target, is_relative)
            flange = Pose.from_matrix(self.arm.forward(axes[:ROBOT_AXES]).tolist())
            return placement.at(axes[ROBOT_AXES:].tolist()).point(flange).components
        before = self.point(placement)
        if not is_relative:
            return tuple(
                target.get(name, value) for name, value in zip(_COMPONENTS, before, strict=True)
            )
        change = [target.get(name, 0.0) for name in _COMPONENTS]
        if reference == "#TOOL":
            return (Pose.of(*before) @ Pose.of(*change)).components
        return tuple(one + other for one, other in zip(before, change, strict=True))

    def goal(self, motion: Motion, target: Target, placement: Placement) -> Goal:
        """The axes of a PTP target. Raises `Fault` 1366, 1447, or 1422 for what is no number."""
        check_finite(target)
        if has_axes(target) or not any(name in target for name in (*_COMPONENTS, "S", "T")):
            return Goal(self._axes(target, motion.is_relative))
        externals = self.externals(target, motion.is_relative)
        components = self.components_of(target, placement, motion.is_relative, motion.reference)
        found = ptp_target(
            self.arm,
            placement.at(externals.tolist()).flange(Pose.of(*components)),
            self.axes[:ROBOT_AXES].tolist(),
            tool=placement.tool,
            status=_bits(target, "S") if not motion.is_relative else None,
            turn=_bits(target, "T") if not motion.is_relative else None,
            preference=TargetStatus(motion.settings.target_status),
        )
        is_singular = bool({Singularity.OVERHEAD, Singularity.WRIST} & set(found.singularities))
        return Goal(np.concatenate((found.axes, externals)), components, is_singular)

    def _axes(self, target: Target, is_relative: bool) -> Array:
        axes = self.axes.copy()
        for place, name in enumerate(_AXES):
            if name in target:
                axes[place] = target[name] + (axes[place] if is_relative else 0.0)
        axes[:ROBOT_AXES] = self.arm.coupled(axes[:ROBOT_AXES])
        check_limits(self.arm.machine.axes, axes[:ROBOT_AXES].tolist())
        axes[ROBOT_AXES:] = self.externals(target, is_relative)
        return axes


def has_axes(target: Target) -> bool:
    """Whether it is a target of axes rather than a point."""
    return any(name in target for name in _AXES)


def check_finite(target: Target) -> None:
    """Raise `Fault` 1422 where a component is no number or an infinite one."""
    for name, value in target.items():
        if not math.isfinite(value):
            text = f"component {name} of the target is not a finite number"
            raise Fault("invalid_target", text, number=1422, rules=("MSG-11",))


def check_numbers(motion: Motion) -> None:
    """Raise `Fault` 1422 where a motion parameter, a place or a range is no finite number.

    Components of targets are looked at where they are read; what has to be more than a number is
    too.
    """
    settings, apo = motion.settings, motion.settings.approximation
    percent = (*settings.axis_velocity, *settings.axis_acceleration, *settings.axis_jerk)
    places = [*motion.places, *motion.stop_places]
    for part in motion.parts:
        places += (*part.places, *part.stop_places)
    numbers: Mapping[str, Iterable[float]] = {
        "the speed, acceleration or jerk of an axis": percent,
        "a part of $APO": (apo.cdis, apo.cptp, apo.cvel, apo.cori),
        "a place on the path": (place.position for place in places),
    }
    for name, values in numbers.items():
        if not math.isfinite(sum(values)):
            raise Fault("invalid", f"{name} is not a finite number", number=1422, rules=("MSG-11",))


def _bits(target: Target, name: str) -> int | None:
    return int(target[name]) if name in target else None
