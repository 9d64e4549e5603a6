"""Tracking: sends set-points of the planned path to a robot, and records both.

The past of a path no longer changes. So set-points are sampled from the path behind the clock, in
chunks. The record has a row for each interpolation cycle from the start.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from interp.robot.arm import Arm, Load, Motion
from interp.robot.kinematics.kinematics import Array, matrix_of
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.placement import Placement
from interp.robot.simulation.observations import Observation, Observer, TorqueCheck
from interp.robot.simulation.robot import Measured, Robot, RobotFault


@dataclass(frozen=True, slots=True)
class PathRecord:
    """A recorded path of ``n`` rows, one for each interpolation cycle.

    ``times`` (n,) are in µs, ``axes`` (n, axes) in degrees or mm. ``points`` (n, 6) are X, Y, Z in
    mm and A, B, C in degrees of the tool relative to the base, with the frames in force at that
    time. ``tips`` (n, 3) are X, Y, Z of the tool in $WORLD, whatever the base. The measured arrays
    are ``None`` if the robot does not measure. ``placements`` are the frames, each with the time in
    µs from which it is in force. ``motions`` are the motions that began, each with its time in µs.
    ``torques`` (n, axes) are in Nm, ``None`` without masses.
    """

    times: npt.NDArray[np.int64]
    axes: Array
    points: Array
    tips: Array
    axes_measured: Array | None
    points_measured: Array | None
    tips_measured: Array | None
    placements: tuple[tuple[int, Placement], ...] = ()
    motions: tuple[tuple[int, Motion], ...] = ()
    torques: Array | None = None

    def columns(self) -> dict[str, npt.NDArray[np.int64] | Array]:
        """Return the columns of a path file: t, q1…q6, e1…, x…c, measured ones with ``_meas``."""
        columns: dict[str, npt.NDArray[np.int64] | Array] = {"t": self.times}
        columns |= _named(self.axes, self.points, "")
        if self.axes_measured is not None and self.points_measured is not None:
            columns |= _named(self.axes_measured, self.points_measured, "_meas")
        return columns


class Tracking:
    """Sends the set-points of a path to a robot as time advances.

    ``start`` are the axes at time 0, as for `MachineData.standing`. ``cycle`` is the interpolation
    cycle in µs, a multiple of the robot's step.
    """

    def __init__(
        self,
        arm: Arm,
        robot: Robot,
        machine: MachineData,
        cycle: int,
        start: Sequence[float],
        observer: Observer | None = None,
    ) -> None:
        if robot.step and cycle % robot.step:
            raise ValueError(f"a cycle of {cycle} µs is no multiple of {robot.step} µs")
        self._arm = arm
        self._robot = robot
        self._kinematics = kinematics_of(machine)
        stands = machine.standing(start)
        coupled = self._kinematics.coupled(stands[:ROBOT_AXES])
        stands = (*coupled.tolist(), *stands[ROBOT_AXES:])
        self._cycle = cycle
        self._sent = 0
        self._place_times = [0]
        self._placements = [Placement(robroot=machine.robroot, carrier=machine.carrier)]
        self._times: list[npt.NDArray[np.int64]] = [np.zeros(1, dtype=np.int64)]
        self._axes: list[Array] = [np.array([stands])]
        self._measured: list[Array | None] = [None]
        self._torques: list[Array] = [np.zeros((1, len(stands)))]
        self._torque_check = TorqueCheck(machine)
        self._observer = observer
        self._begun: list[tuple[int, Motion]] = []
        self._loads: Mapping[str, Load] = {}
        #: Changes of loads, for times up to which set-points have not been sent yet.
        self._changes: list[tuple[int, Mapping[str, Load]]] = []
        self._last: Array | None = None
        robot.stand(stands)
        if observer is not None:
            observer.observe(self._times[0], self._axes[0])

    def next_time(self, now: int) -> int | None:
        """Return when `advance` must be called next, in µs; ``None`` if nothing new is sent."""
        moves = self._robot.step and self._arm.next_event() is not None
        return now + self._robot.chunk if moves else None

    def begun(self, time: int, motion: Motion) -> None:
        """Note that a motion begins: its frames and loads are in force from now on."""
        settings = motion.settings
        self.placed(time, settings.placement)
        self._begun.append((time, motion))
        if settings.loads != self._loads:
            self._loads = settings.loads
            self._changes.append((time, settings.loads))

    def placed(self, time: int, placement: Placement) -> None:
        """Use these frames for points from a time on, which must not be before the previous one."""
        if time == self._place_times[-1]:
            self._place_times.pop()
            self._placements.pop()
        self._place_times.append(time)
        self._placements.append(placement)

    def advance(self, now: int) -> None:
        """Send all complete chunks up to the time ``now``; raise `RobotFault` at most once."""
        while self._robot.step and now - self._sent >= self._robot.chunk:
            self._send(self._sent + self._robot.chunk)

    def settle(self, now: int) -> None:
        """Send all set-points up to ``now``; raise `RobotFault`."""
        self.advance(now)
        if self._robot.step and now - self._sent >= self._robot.step:
            self._send(now)

    def measured(self, now: int) -> tuple[float, ...]:
        """Return the axes measured at ``now``, or up to a step before it; raise `RobotFault`."""
        self.settle(now)
        if self._last is None:
            return self._arm.position(now).axes
        return tuple(self._last.tolist())

    def record(self) -> PathRecord:
        """Return the record of the path so far."""
        times, axes = np.concatenate(self._times), np.concatenate(self._axes)
        points, tips = self._points(times, axes)
        frames = tuple(zip(self._place_times, self._placements, strict=True))
        begun = tuple(self._begun)
        rows = [axes[:1] if row is None else row for row in self._measured]
        if self._last is None:
            return PathRecord(times, axes, points, tips, None, None, None, frames, begun)
        measured = np.concatenate(rows)
        found = self._points(times, measured)
        torques = np.concatenate(self._torques)
        return PathRecord(times, axes, points, tips, measured, *found, frames, begun, torques)

    def observations(self) -> tuple[Observation, ...]:
        """Return contacts and excessive torques, in the order in which they began."""
        seen = [*self._torque_check.observations()]
        seen += () if self._observer is None else self._observer.observations()
        placed = [replace(one, at=self._line_at(one.start)) for one in seen]
        return tuple(sorted(placed, key=lambda one: (one.start, one.kind, one.parts)))

    def _line_at(self, time: int) -> str:
        """Return the line of the motion that ran at a time."""
        place = bisect_right(self._begun, time, key=lambda begun: begun[0])
        if not place:
            return ""
        at = self._begun[place - 1][1].at
        return f"{at.file}:{at.line}"

    def _send(self, until: int) -> None:
        """Send set-points up to a time, each with the loads carried at that time."""
        step = self._robot.step
        while self._changes and self._changes[0][0] - self._sent < step:
            self._robot.carry(self._changes.pop(0)[1])
        if self._changes and self._changes[0][0] + step <= until:
            self._send_at_once(self._changes[0][0])
            self._send(until)
        else:
            self._send_at_once(until)

    def _send_at_once(self, until: int) -> None:
        step = self._robot.step
        times = np.arange(self._sent + step, until + 1, step, dtype=np.int64)
        self._sent = int(times[-1])
        samples = self._arm.sample(times)
        self._arm.forget(self._sent)
        try:
            measured = self._robot.follow(samples)
        except RobotFault as fault:
            self._store(times[times < fault.time], samples.axes, None)
            raise
        self._store(times, samples.axes, measured)

    def _store(self, times: npt.NDArray[np.int64], axes: Array, measured: Measured | None) -> None:
        if not len(times):
            return
        rows = np.flatnonzero(times % self._cycle == 0)
        self._times.append(times[rows])
        self._axes.append(axes[rows])
        if measured is not None:
            self._last = measured.axes[-1]
            self._measured.append(measured.axes[rows])
            self._torques.append(measured.torques[rows])
            self._torque_check.check(times, measured.torques)
        else:
            self._measured.append(axes[rows])
            self._torques.append(np.zeros_like(axes[rows]))
        if self._observer is not None:
            self._observer.observe(times[rows], axes[rows])

    def _points(self, times: npt.NDArray[np.int64], axes: Array) -> tuple[Array, Array]:
        """Return X to C of the tool in the base in force (n, 6), and X to Z in $WORLD (n, 3)."""
        flanges = self._kinematics.forward(axes[:, :ROBOT_AXES])
        points, tips = np.empty((len(times), 6)), np.empty((len(times), 3))
        for rows, placement in self._placement_rows(times):
            before = np.linalg.inv(placement.chains_before(axes[rows, ROBOT_AXES:]))
            standing = flanges[rows] @ matrix_of(placement.tool)
            poses = before @ standing
            points[rows, :3] = poses[:, :3, 3]
            points[rows, 3:] = _angles(poses)
            tips[rows] = (placement.feet(axes[rows, ROBOT_AXES:]) @ standing)[:, :3, 3]
        return points, tips

    def _placement_rows(self, times: npt.NDArray[np.int64]) -> Iterator[tuple[slice, Placement]]:
        """Yield the rows during which each placement was in force."""
        known = times.tolist()
        starts = [bisect_right(known, time - 1) for time in self._place_times]
        for first, last, placement in zip(
            starts, [*starts[1:], len(known)], self._placements, strict=True
        ):
            if first < last:
                yield slice(first, last), placement


def _angles(poses: Array) -> Array:
    """Return A, B, C (n, 3) in degrees of poses (n, 4, 4), as `interp.values.poses.Pose.angles`."""
    over = np.hypot(poses[:, 0, 0], poses[:, 1, 0])
    a = np.where(over > 1e-12, np.arctan2(poses[:, 1, 0], poses[:, 0, 0]), 0.0)
    sine, cosine = np.sin(a), np.cos(a)
    c = np.arctan2(
        sine * poses[:, 0, 2] - cosine * poses[:, 1, 2],
        cosine * poses[:, 1, 1] - sine * poses[:, 0, 1],
    )
    angles: Array = np.degrees(np.stack((a, np.arctan2(-poses[:, 2, 0], over), c), axis=-1))
    return angles


def _named(axes: Array, points: Array, suffix: str) -> dict[str, Array]:
    robot = {f"q{number + 1}": axes[:, number] for number in range(ROBOT_AXES)}
    others = {f"e{number + 1}": column for number, column in enumerate(axes[:, ROBOT_AXES:].T)}
    place = {name: points[:, number] for number, name in enumerate("xyzabc")}
    return {f"{name}{suffix}": column for name, column in (robot | others | place).items()}
