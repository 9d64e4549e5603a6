"""The meaning of a programmed target: omitted components, relative targets, axes and points.

`Programmed` is the last programmed target, whether the arm has reached it or not: relative motions
add to it, and omitted components keep its values [MOT-14, MOT-16].
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import Motion, SplinePart, Target
from interp.robot.kinematics.kinematics import Array, Kinematics
from interp.robot.kinematics.machine_data import AXIS_NAMES, EXTERNAL_NAMES, ROBOT_AXES
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solution_choice import TargetStatus, check_limits, ptp_target
from interp.values.faults import Fault
from interp.values.poses import Pose

_COMPONENTS = ("X", "Y", "Z", "A", "B", "C")


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """The end of a PTP motion; ``components`` is set if it was given as a point.

    ``is_singular`` leads to message 2868, a notification [POS-08].
    """

    axes: Array
    components: tuple[float, ...] | None = None
    is_singular: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Programmed:
    """The last target: all axes, and the point with the frames in which it was given.

    ``components`` are X…C as the program gave them, so that an omitted one keeps exactly its value.
    In other frames, the components are those of the same place in these frames (unconfirmed).
    """

    arm: Kinematics
    axes: Array
    components: tuple[float, ...] | None = None
    placement: Placement | None = None

    @property
    def flange(self) -> Pose:
        """The flange relative to the robot's foot."""
        return Pose.from_matrix(self.arm.forward(self.axes[:ROBOT_AXES]).tolist())

    def reached(
        self, axes: Array, components: tuple[float, ...] | None, placement: Placement
    ) -> Programmed:
        """Return the next target, with its components if it was given as a point."""
        return Programmed(self.arm, axes, components, placement)

    def point(self, placement: Placement) -> tuple[float, ...]:
        """Return X, Y, Z, A, B, C of the target in given frames."""
        if self.components is not None and placement == self.placement:
            return self.components
        return self.pose_in(placement).components

    def pose_in(self, placement: Placement) -> Pose:
        """Return the target as a pose in given frames, at the positions of its external axes."""
        return placement.at(self.axes[ROBOT_AXES:].tolist()).point(self.flange)

    def externals(self, target: Target, is_relative: bool) -> Array:
        """Return the external axes of a target; raise `Fault` 1447 beyond their limits."""
        values = self.axes[ROBOT_AXES:].copy()
        for place, name in enumerate(EXTERNAL_NAMES[: len(values)]):
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
        """Return X, Y, Z, A, B, C of a Cartesian target, or of the point to which axes lead.

        Relative to #TOOL, the target is a frame in the last point. Relative to #BASE, each
        component is added to that of the last point [MOT-14].
        """
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
        """Return the axes of a PTP target; raise `Fault` 1366 or 1447."""
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
        is_singular = bool(found.singularities)
        return Goal(np.concatenate((found.axes, externals)), components, is_singular)

    def _axes(self, target: Target, is_relative: bool) -> Array:
        axes = self.axes.copy()
        for place, name in enumerate(AXIS_NAMES):
            if name in target:
                axes[place] = target[name] + (axes[place] if is_relative else 0.0)
        axes[:ROBOT_AXES] = self.arm.coupled(axes[:ROBOT_AXES])
        check_limits(self.arm.machine.axes, axes[:ROBOT_AXES].tolist())
        axes[ROBOT_AXES:] = self.externals(target, is_relative)
        return axes


def has_axes(target: Target) -> bool:
    """Return whether a target has axes and not a point."""
    return any(name in target for name in AXIS_NAMES)


def check_numbers(motion: Motion) -> None:
    """Raise `Fault` 1422 if a target, a motion parameter or a place is infinite or NaN.

    Numbers with a further requirement are checked where they are used.
    """
    settings, apo = motion.settings, motion.settings.approximation
    every: tuple[Motion | SplinePart, ...] = (motion, *motion.parts)
    places = [place for one in every for place in (*one.places, *one.stop_places)]
    targets = [target for one in every for target in (one.target, one.auxiliary or {})]
    percent = (*settings.axis_velocity, *settings.axis_acceleration, *settings.axis_jerk)
    numbers: Mapping[str, Iterable[float]] = {
        "the speed, acceleration or jerk of an axis": percent,
        "a part of $APO": (apo.cdis, apo.cptp, apo.cvel, apo.cori),
        "a place on the path": (place.position for place in places),
        "a component of the target": (value for target in targets for value in target.values()),
    }
    for name, values in numbers.items():
        if not math.isfinite(sum(values)):
            raise Fault("invalid", f"{name} is not a finite number", number=1422, rules=("MSG-11",))


def _bits(target: Target, name: str) -> int | None:
    return int(target[name]) if name in target else None
