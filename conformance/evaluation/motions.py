"""The completed motions of a run, with what was programmed and the movement of the axes.

The pose of the tool is computed from axes and machine data alone (`flanges_of`), independently of
the kinematics that has produced the set-points.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_geometry import between, change_rates
from interp.robot.arm import Motion, Settings, Target
from interp.robot.kinematics.chain import Chain
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.placement import IpoMode
from interp.robot.simulation.tracking import PathRecord

Array = npt.NDArray[np.float64]

#: mm and degrees of rounding in a set-point.
ROUNDING: Final = 1e-4
#: mm and degrees of tolerance for a position that is interpolated between two samples.
NEAR_MM: Final = 0.5
NEAR_DEGREES: Final = 0.2
#: The components of a target that are its point, and its orientation.
POINT: Final = ("X", "Y", "Z")
ANGLES: Final = ("A", "B", "C")
#: The events of a motion.
_STAGES: Final = ("motion_planned", "motion_start", "motion_end", "blend_start", "blend_end")


@dataclass(frozen=True)
class EndedMotion:
    """A motion that came to its end, with times in µs; a blend at either end is left out.

    ``begins`` and ``stops`` say whether it starts from rest and ends at rest. ``planned`` is the
    time at which it was planned. ``is_held`` is set if a BRAKE, RESUME, HALT or message
    that has to be acknowledged happened between that time and its end.
    """

    motion: Motion
    event: Event
    planned: int
    start: int
    end: int
    begins: bool
    stops: bool
    is_held: bool
    path: PathRecord
    machine: MachineData

    @property
    def is_ptp(self) -> bool:
        """Whether its axes have the speed, not the tool."""
        return self.motion.kind in ("PTP", "SPTP")

    @property
    def is_in_base(self) -> bool:
        """Whether the tool moves relative to the base, not the base relative to a fixed tool."""
        return self.motion.settings.placement.mode is IpoMode.BASE

    @property
    def has_six(self) -> bool:
        """Whether its arm can take any orientation."""
        return self.machine.palletising is None and len(self.machine.chain.joints) == ROBOT_AXES

    @property
    def settings(self) -> list[Settings]:
        """Its settings, then those of its parts that have their own."""
        own = (part.settings for part in self.motion.parts if part.settings is not None)
        return [self.motion.settings, *own]

    def follows(self, before: EndedMotion) -> bool:
        """Return whether it was planned directly after another motion."""
        return self.motion.number == before.motion.number + 1

    @cached_property
    def rows(self) -> slice:
        """The rows of its samples outside of blends."""
        times = self.path.times
        return slice(
            int(np.searchsorted(times, self.start)), int(np.searchsorted(times, self.end, "right"))
        )

    @cached_property
    def ends(self) -> Array:
        """The axes at start and end, (2, axes); the end may be a cycle after the last sample."""
        times = self.path.times
        return between(times, self.path.axes, [self.start, self.end], _cycle(times))

    @cached_property
    def tools(self) -> Array:
        """The tool relative to the base at its samples, (n, 4, 4)."""
        return self.poses(self.axes)

    @property
    def times(self) -> npt.NDArray[np.int64]:
        """The times of its samples in µs."""
        return self.path.times[self.rows]

    @property
    def axes(self) -> Array:
        """The axes at its samples, (n, axes)."""
        return self.path.axes[self.rows]

    @cached_property
    def speeds(self) -> Array:
        """The speeds in m/s between its samples, of a base with a fixed tool [ORI-07]."""
        poses = self.tools if self.is_in_base else np.linalg.inv(self.tools)
        moves = change_rates(self.times, np.asarray(poses[:, :3, 3], dtype=np.float64))
        return np.asarray(np.linalg.norm(moves, axis=1) / 1000.0)

    def points(self, axes: Array) -> Array:
        """Return X, Y and Z of the tool relative to the base, (n, 3), for axes (n, axes)."""
        return self.poses(axes)[:, :3, 3]

    def poses(self, axes: Array) -> Array:
        """Return the tool relative to the base, (n, 4, 4), for axes (n, axes)."""
        placement, own = self.motion.settings.placement, axes[:, ROBOT_AXES:]
        flanges = flanges_of(self.machine.chain, axes[:, :ROBOT_AXES])
        poses: Array = (
            np.linalg.inv(placement.chains_before(own)) @ flanges @ matrix_of(placement.tool)
        )
        return poses

    @cached_property
    def axis_rates(self) -> Array | None:
        """The largest speed, acceleration and jerk in a PTP, (3, axes); ``None`` if unknown."""
        settings, axes = self.motion.settings, self.machine.every_axis
        dynamics = [axis.dynamics for axis in axes if axis.dynamics is not None]
        if len(dynamics) < len(axes):
            return None
        reduction = self.machine.t1_reduction if settings.is_reduced else 1.0
        rows = (
            (settings.axis_velocity, [each.velocity * reduction for each in dynamics]),
            (settings.axis_acceleration, [each.acceleration for each in dynamics]),
            (settings.axis_jerk, [each.jerk for each in dynamics]),
        )
        return np.array(
            [
                [
                    most * (share / 100.0 if 0.0 < share <= 100.0 else 1.0)
                    for share, most in zip(shares, mosts, strict=False)
                ]
                for shares, mosts in rows
            ]
        )


def stages(seen: Observation) -> Mapping[object, Mapping[str, Event]]:
    """Return the first event of each kind of each motion, by number."""
    found: dict[object, dict[str, Event]] = {}
    for one in seen.of_kind(*_STAGES):
        found.setdefault(one.fields.get("motion"), {}).setdefault(one.kind, one)
    return found


def ended(seen: Observation) -> Iterator[EndedMotion]:
    """Yield the motions that came to their end without another motion in between.

    A CIRC after a RESUME is left out, because it is no longer a circle [INT-14]. Yield nothing if
    path or machine data are unknown.
    """
    path, machine = seen.path, seen.machine
    if path is None or machine is None:
        return
    stops = [(one.time or 0, one.kind) for one in seen.of_kind("brake", "resume", "halt")]
    pauses = [time for time, _ in stops]
    pauses += (
        one.time or 0
        for one in seen.of_kind("message")
        if one.fields.get("type") == "acknowledgement"
    )
    starts = [one.time or 0 for one in seen.of_kind("motion_start")]
    known = path.times[-1] + _cycle(path.times)
    every = stages(seen)
    for begun, motion in path.motions:
        its = every.get(motion.number, {})
        event, end = its.get("motion_start"), its.get("motion_end")
        entered, left = its.get("blend_end"), its.get("blend_start")
        if event is None or end is None or end.time is None:
            continue
        planned = its.get("motion_planned", event).time or 0
        is_held = any(planned <= time <= end.time for time in pauses)
        _, last_stop = max((each for each in stops if each[0] <= planned), default=(0, ""))
        if last_stop == "resume" and motion.kind.startswith("CIRC"):
            continue
        start = begun if entered is None else entered.time
        last = end.time if left is None else left.time
        if start is None or last is None or not start <= last <= known:
            continue
        if not any(start < time < last for time in starts):
            ends = entered is None, left is None
            yield EndedMotion(motion, event, planned, start, last, *ends, is_held, path, machine)


def completed(target: Target, names: Sequence[str], before: Array) -> Array:
    """Return components of a target; omitted ones keep their value [MOT-16]."""
    return np.array([target.get(name, value) for name, value in zip(names, before, strict=True)])


def point_of(target: Target | None) -> Array | None:
    """Return the point of a target; ``None`` if it is incomplete."""
    if target is None or not set(POINT) <= set(target):
        return None
    return np.array([target[name] for name in POINT])


def _cycle(times: npt.NDArray[np.int64]) -> int:
    """Return the time between two samples in µs."""
    return int(times[-1] - times[-2]) if len(times) > 1 else 0


def flanges_of(chain: Chain, axes: Array) -> Array:
    """Return flange poses (n, 4, 4) relative to the foot, joint by joint, for axes (n, 6)."""
    pose = np.eye(4)
    for (frame, axis, is_linear, skew, square), values in zip(_joints(chain), axes.T, strict=False):
        move = np.zeros((len(values), 4, 4))
        move[:] = np.eye(4)
        if is_linear:
            move[:, :3, 3] = values[:, None] * axis
        else:
            angle = np.radians(values)[:, None, None]
            move[:, :3, :3] += np.sin(angle) * skew + (1.0 - np.cos(angle)) * square
        pose = pose @ frame @ move
    flanges: Array = pose @ matrix_of(chain.end)
    return flanges


@lru_cache(maxsize=16)
def _joints(chain: Chain) -> list[tuple[Array, Array, bool, Array, Array]]:
    """Return of each joint its frame, axis and kind, and the terms of a rotation about the axis."""
    skews = [np.cross(np.eye(3), np.array(joint.axis)) for joint in chain.joints]
    return [
        (matrix_of(joint.frame), np.array(joint.axis), joint.is_linear, skew, skew @ skew)
        for joint, skew in zip(chain.joints, skews, strict=True)
    ]
