"""Tracks: the path of a motion instruction as a curve with its limits [MOT-11]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from grammar.motion_kinds import AXIS_MOTIONS
from interp.robot.arm import Motion, Settings, Target
from interp.robot.kinematics.kinematics import Array, matrix_of
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.placement import IpoMode
from interp.robot.path.axis_path import (
    AxisPath,
    Curve,
    JointCurve,
    LinearAxes,
    PosePathCurve,
)
from interp.robot.path.circle import Circle, circle_through
from interp.robot.path.orientation import Carried, Orientation, rotations_about, turning
from interp.robot.path.pose_path import GRID, Line, OrientedPath
from interp.robot.path.programmed_targets import Programmed
from interp.robot.path.tool_path import tool_tangents
from interp.robot.path.wrist import WristCurve
from interp.robot.planning.axis_limits import AxisLimits, axis_limits
from interp.robot.planning.junctions import STOP, Junction
from interp.robot.planning.limits import CurveLimits, PathLimits, curve_limits_of
from interp.robot.planning.torque_limits import TorqueLimits
from interp.values.faults import Fault
from interp.values.poses import Pose

STILL = 1e-6  # mm or degrees: less is no motion
_ZERO_LENGTH, _SINGULAR, _TURNED_VARIABLY = 3171, 2868, 2821
METRE = 1000.0
#: mm/s³ and deg/s³: as delivered [MOT-05].
_SPLINE_JERKS = (500e3, 50e3)


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A part of a motion's path that is one curve; only spline blocks have more than one piece.

    ``paths`` are its limits along the path; none for PTP. ``junction`` is how it continues the
    previous piece; `STOP` if the arm stops between them.
    """

    curve: Curve
    limits: CurveLimits
    paths: tuple[PathLimits, ...] = ()
    junction: Junction = STOP
    is_still: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """The path of one motion, from the previous target to its own.

    ``axis_limits`` are the machine data scaled by its percentages.
    """

    motion: Motion
    pieces: tuple[Piece, ...]
    axis_limits: AxisLimits
    is_singular: bool = False

    @property
    def is_still(self) -> bool:
        """Whether the path has length zero [MOT-11]."""
        return all(piece.is_still for piece in self.pieces)

    @property
    def notices(self) -> tuple[int, ...]:
        """The numbers of notification messages."""
        return (
            (_ZERO_LENGTH,) * self.is_still
            + (_SINGULAR,) * self.is_singular
            + (_TURNED_VARIABLY,) * self._is_turned_variably
        )

    @property
    def _is_turned_variably(self) -> bool:
        """Whether #JOINT is treated as #VAR: in spline blocks, and with a fixed tool [ORI-03]."""
        motion = self.motion
        every = [part.settings or motion.settings for part in motion.parts] or [motion.settings]
        is_fixed = motion.settings.placement.mode is IpoMode.TCP
        wants = any(settings.orientation == "#JOINT" for settings in every)
        return self.is_cp and wants and (bool(motion.parts) or is_fixed)

    @property
    def is_cp(self) -> bool:
        """Whether the motion is a CP motion, whose tool path is programmed."""
        return self.motion.kind not in (*AXIS_MOTIONS, "PTP_SPLINE")


class Tracks:
    """Creates the tracks of one arm."""

    def __init__(self, machine: MachineData, torques: TorqueLimits | None = None) -> None:
        self.machine = machine
        self.arm = kinematics_of(machine)
        self.limits = axis_limits(machine, torques)

    def track(
        self, motion: Motion, before: Programmed, *, is_after_abort: bool = False
    ) -> tuple[Track, Programmed]:
        """Return the track of a motion from a target on, and the target to which it leads.

        After an aborted motion CIRC is executed as LIN, since it does not start where it should
        [INT-14]. Raises `Fault`, with 3094 for #IGNORE, which is only allowed in segments of a
        spline block (where exactly is unconfirmed) [ORI-03].
        """
        is_cp = motion.kind not in AXIS_MOTIONS
        if is_cp and motion.settings.orientation == "#IGNORE":
            raise Fault(
                "orientation", "#IGNORE is not allowed here", number=3094, rules=("ORI-03",)
            )
        match motion.kind:
            case "PTP" | "SPTP":
                return self._ptp(motion, before)
            case "LIN" | "SLIN":
                return self._line(motion, before)
            case "CIRC" | "SCIRC":
                if is_after_abort and motion.kind == "CIRC":
                    return self._line(motion, before)
                return self._circle(motion, before)
            case _:
                raise Fault("motion", f"{motion.kind} is no motion of this arm")

    # ------------------------------------------------------------------------------------ kinds

    def _ptp(self, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
        settings = motion.settings
        goal = before.goal(motion, motion.target, settings.placement)
        piece = self.axis_piece(LinearAxes(before.axes, goal.axes), settings)
        is_still = bool(np.abs(goal.axes - before.axes).max() < STILL)
        pieces = (replace(piece, is_still=is_still),)
        track = Track(motion, pieces, self.programmed(settings), goal.is_singular)
        return track, before.reached(goal.axes, goal.components, settings.placement)

    def _line(self, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
        placement = motion.settings.placement
        start = matrix_of(placement.in_path(before.pose_in(placement)))
        point = self._point(motion, motion.target, before)
        end = matrix_of(placement.in_path(Pose.of(*point)))
        line = Line(start[:3, 3], end[:3, 3])
        last = start if motion.settings.orientation == "#CONSTANT" else end  # [ORI-01]
        pose_path = OrientedPath(line, turning(start[:3, :3], last[:3, :3]))
        return self._along(motion, before, pose_path, point)

    def _circle(self, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
        placement = motion.settings.placement
        start = matrix_of(placement.in_path(before.pose_in(placement)))
        middle = Pose.of(*self._point(motion, motion.auxiliary or {}, before))
        auxiliary = placement.in_path(middle)
        point = self._point(motion, motion.target, before)
        end = matrix_of(placement.in_path(Pose.of(*point)))
        circle = circle_through(
            start[:3, 3], np.array(auxiliary.position), end[:3, 3], motion.angle
        )
        pose_path = OrientedPath(circle, _along_circle(motion.settings, circle, start, end))
        return self._along(motion, before, pose_path, point)

    def _along(
        self, motion: Motion, before: Programmed, pose_path: OrientedPath, point: tuple[float, ...]
    ) -> tuple[Track, Programmed]:
        """Return the track of a path; its end pose is the target unless the motion has an angle."""
        settings = motion.settings
        externals = before.externals(motion.target, motion.is_relative)
        travel = np.abs(externals - before.axes[ROBOT_AXES:]).max(initial=0.0)
        if max(pose_path.length, *map(math.degrees, pose_path.angles), travel) < STILL:
            track = Track(motion, (self.still(before.axes, settings),), self.limits)
            return track, before.reached(before.axes, point, settings.placement)
        others = LinearAxes(before.axes[ROBOT_AXES:], externals)
        piece = self.along(pose_path, before.axes[:ROBOT_AXES], others, motion.kind, settings)
        track = Track(motion, (piece,), self.limits.carrying(settings.loads))
        axes = piece.curve.end
        reached = point if motion.angle is None else None
        return track, before.reached(axes, reached, settings.placement)

    def along(
        self, pose_path: OrientedPath, start: Array, others: AxisPath, kind: str, settings: Settings
    ) -> Piece:
        """Return the piece for a path, from the axes of the robot at its start. Raises `Fault`."""
        limits = self.limits.carrying(settings.loads)
        is_wrist = settings.orientation == "#JOINT" and settings.placement.mode is IpoMode.BASE
        kind_of_curve = WristCurve if is_wrist else PosePathCurve
        curve = kind_of_curve(self.arm, settings.placement, pose_path, start, others)
        angles = () if is_wrist else np.degrees(pose_path.angles).tolist()
        paths = self.paths(settings, (pose_path.length, *angles), is_spline=kind[0] == "S")
        self.check_speed(settings, curve, paths)
        return Piece(curve, curve_limits_of(curve, limits, limits, paths), paths)

    def axis_piece(self, path: AxisPath, settings: Settings, junction: Junction = STOP) -> Piece:
        """Return the piece for a path in axis space."""
        curve = JointCurve(self.arm, settings.placement, path)
        limits, paths = self.programmed(settings), self.reduced_paths(curve, settings)
        return Piece(curve, curve_limits_of(curve, self.limits, limits, paths), (), junction)

    def still(self, axes: Array, settings: Settings) -> Piece:
        """Return a piece of length zero."""
        return replace(self.axis_piece(LinearAxes(axes, axes), settings), is_still=True)

    def _point(self, motion: Motion, target: Target, before: Programmed) -> tuple[float, ...]:
        placement = motion.settings.placement
        return before.components_of(target, placement, motion.is_relative, motion.reference)

    # ----------------------------------------------------------------------------------- limits

    def programmed(self, settings: Settings) -> AxisLimits:
        """Return the limits scaled by percentages and by the reduction in T1 [MOT-02, MOT-07]."""
        percents = settings.axis_velocity, settings.axis_acceleration, settings.axis_jerk
        limits = self.limits.carrying(settings.loads).scaled(*percents)
        if settings.is_reduced:
            limits = replace(limits, velocity=limits.velocity * self.machine.t1_reduction)
        return limits

    def paths(
        self, settings: Settings, lengths: Sequence[float], *, is_spline: bool = False
    ) -> tuple[PathLimits, ...]:
        """Return the limits for a path of this length, swivel and rotation, or length alone.

        See [MOT-04, MOT-05, MOT-07]. Units are mm and degrees. Spline motions have the jerk with
        which controllers are delivered.
        """
        most, steepest = self.machine.velocity, self.machine.acceleration
        path_jerk, turn_jerk = _SPLINE_JERKS if is_spline else (math.inf, math.inf)
        path_speed = min(most.path, self.machine.t1_speed if settings.is_reduced else math.inf)
        programmed = (
            ("CP", settings.velocity, settings.acceleration, path_speed, steepest.path),
            ("ORI1", *settings.swivel, most.swivel, steepest.swivel),
            ("ORI2", *settings.rotation, most.rotation, steepest.rotation),
        )
        limits = []
        for length, (name, velocity, acceleration, top, top_gain) in zip(
            lengths, programmed, strict=False
        ):
            speed = min(_above(velocity, f"$VEL.{name}"), top)
            gain = min(_above(acceleration, f"$ACC.{name}"), top_gain)
            unit, jerk = (METRE, path_jerk) if name == "CP" else (1.0, turn_jerk)
            if length > STILL:
                limits.append(PathLimits(length, speed * unit, gain * unit, jerk))
        return tuple(limits)

    def reduced_paths(self, curve: Curve, *settings: Settings) -> tuple[PathLimits, ...]:
        """Return the limits of a curve in axis space if one of the settings is for T1.

        The speed of the tool is limited to $VEL_CP_T1 there, too [MOT-07].
        """
        if curve.pose_path is not None or not any(each.is_reduced for each in settings):
            return ()
        tangents = tool_tangents(curve, GRID)
        fastest = float(np.linalg.norm(tangents, axis=1).max())
        if fastest < STILL:
            return ()
        return (PathLimits(fastest, self.machine.t1_speed * METRE, math.inf),)

    def check_speed(self, settings: Settings, curve: Curve, paths: Sequence[PathLimits]) -> None:
        """Raise `Fault` 1102 if an axis is too fast and $CP_VEL_TYPE forbids to slow down.

        The speed is the programmed one, or what can be reached from standstill at the nearer end:
        if the motion is blended into a neighbour, it would be slowed down there anyway.
        """
        may_reduce = settings.speed_type in {"#VAR_ALL", "#VAR_ALL_MODEL"}
        if may_reduce or (settings.speed_type == "#VAR_T1" and settings.is_reduced) or not paths:
            return
        grid = curve.grid
        first, _, _ = curve.rates(grid)
        most = min(path.velocity / path.length for path in paths)
        gain = min(path.acceleration / path.length for path in paths)
        speeds = np.minimum(np.sqrt(2.0 * gain * np.minimum(grid, 1.0 - grid)), most)
        over = (np.abs(first) * speeds[:, None] > self.limits.velocity).any(axis=0)
        if over.any():
            name = self.machine.every_axis[int(np.argmax(over))].name
            text = f"the path would move {name} faster than it can"
            raise Fault("axis_velocity", text, number=1102, rules=("MOT-08",))


def _along_circle(settings: Settings, circle: Circle, start: Array, end: Array) -> Orientation:
    """Return the orientation along an arc, in space or relative to the path [ORI-04].

    The programmed end point has its orientation at its place on the circle [MOT-13].
    """
    first, last = (pose[:3, :3] for pose in (start, end))
    is_carried = settings.circle == "#PATH"
    if is_carried:
        (back,) = rotations_about(circle.normal, np.array([-circle.programmed]))
        last = back @ last
    extent = circle.angle / circle.programmed
    turned = turning(first, first if settings.orientation == "#CONSTANT" else last, extent)
    return Carried(turned, circle.normal, circle.angle) if is_carried else turned


def _above(value: float, name: str) -> float:
    """Return a speed or acceleration if it is positive; otherwise raises `Fault` 1422."""
    if not value > 0.0 or not math.isfinite(value):
        raise Fault("invalid", f"{name} is {value:g}", number=1422, rules=("MSG-11",))
    return value
