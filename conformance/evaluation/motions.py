"""Completed motions of a run, with what was programmed and the movement of the axes.

Where the tool is follows from axes and machine data alone (`flanges_of`), so that no kinematics of
ours says where its own set-points lie.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_geometry import between
from conformance.evaluation.run_laws import Violation
from interp.robot.arm import Motion
from interp.robot.kinematics.chain import Chain
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.solver import matrix_of
from interp.robot.simulation.tracking import PathRecord

Array = npt.NDArray[np.float64]

#: mm and degrees by which rounding may move a set-point.
ROUNDING: Final = 1e-4
#: mm and degrees that lie between two samples, where a place is looked up at its own moment.
NEAR_MM: Final = 0.5
NEAR_DEGREES: Final = 0.2


@dataclass(frozen=True)
class EndedMotion:
    """A motion that came to its end, times in µs; where it is blended, the blend is left out.

    ``begins`` and ``stops``: it starts from rest, and comes to it. ``planned`` is the time at
    which its way was known. ``is_held``: a BRAKE, RESUME or stop lies between that and its end.
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

    @cached_property
    def rows(self) -> slice:
        """Its samples that lie in no blend."""
        times = self.path.times
        return slice(
            int(np.searchsorted(times, self.start)), int(np.searchsorted(times, self.end, "right"))
        )

    @cached_property
    def ends(self) -> Array:
        """The axes at its start and its end, (2, axes), which may be within a cycle of the last."""
        times = self.path.times
        return between(times, self.path.axes, [self.start, self.end], _cycle(times))

    @cached_property
    def tools(self) -> Array:
        """The tool in the base at its samples, (n, 4, 4)."""
        return self.poses(self.path.axes[self.rows])

    def poses(self, axes: Array) -> Array:
        """The tool in the base, (n, 4, 4), where axes (n, axes) stand."""
        placement, own = self.motion.settings.placement, axes[:, ROBOT_AXES:]
        flanges = flanges_of(self.machine.chain, axes[:, :ROBOT_AXES])
        poses: Array = (
            np.linalg.inv(placement.chains_before(own)) @ flanges @ matrix_of(placement.tool)
        )
        return poses

    @cached_property
    def axis_rates(self) -> Array | None:
        """Speed, acceleration and jerk that axes have in a PTP, (3, axes); ``None``: not known."""
        settings, axes = self.motion.settings, (*self.machine.axes, *self.machine.externals)
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

    def broken(self, law: str, actual: str, rule: str = "") -> Violation:
        """A violation at its line."""
        return Violation(self.event, law, actual, rule)


def ended(seen: Observation) -> Iterator[EndedMotion]:
    """The motions that came to their end with no other on in between.

    A CIRC behind a RESUME is left out, as it is no circle [INT-14]. None where path or machine
    data are unknown.
    """
    path, machine = seen.path, seen.machine
    if path is None or machine is None:
        return
    stops = [(one.time or 0, one.kind) for one in seen.of_kind("brake", "resume", "halt")]
    starts = [one.time or 0 for one in seen.of_kind("motion_start")]
    known = path.times[-1] + _cycle(path.times)
    found: dict[tuple[str, object], Event] = {}
    kinds = ("motion_planned", "motion_start", "motion_end", "blend_start", "blend_end")
    for one in seen.of_kind(*kinds):
        found.setdefault((one.kind, one.fields.get("motion")), one)
    for begun, motion in path.motions:
        event, end = (found.get((kind, motion.number)) for kind in ("motion_start", "motion_end"))
        entered, left = (found.get((kind, motion.number)) for kind in ("blend_end", "blend_start"))
        if event is None or end is None or end.time is None:
            continue
        planned = found.get(("motion_planned", motion.number), event).time or 0
        is_held = any(planned <= time <= end.time for time, _ in stops)
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


def follows(one: EndedMotion, other: EndedMotion) -> bool:
    """Whether the second motion is the next that was planned behind the first."""
    return other.motion.number == one.motion.number + 1


def _cycle(times: npt.NDArray[np.int64]) -> int:
    """µs from one sample to the next."""
    return int(times[-1] - times[-2]) if len(times) > 1 else 0


def flanges_of(chain: Chain, axes: Array) -> Array:
    """Poses of the flange (n, 4, 4) in front of the foot, joint by joint, for axes (n, 6)."""
    pose = np.eye(4)
    for joint, values in zip(chain.joints, axes.T, strict=False):
        move = np.tile(np.eye(4), (len(values), 1, 1))
        axis = np.array(joint.axis)
        if joint.is_linear:
            move[:, :3, 3] = values[:, None] * axis
        else:
            angle, skew = np.radians(values)[:, None, None], np.cross(np.eye(3), axis)
            move[:, :3, :3] += np.sin(angle) * skew + (1.0 - np.cos(angle)) * (skew @ skew)
        pose = pose @ matrix_of(joint.frame) @ move
    flanges: Array = pose @ matrix_of(chain.end)
    return flanges
