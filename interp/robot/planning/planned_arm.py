"""The planned arm: takes motions and plans one continuous path with a time for each point.

Each motion becomes a section of path, and so does each blend between two. At every call, everything
that lies ahead is scheduled again; what was travelled is kept. A motion that is appended in time
therefore turns the stop at the end of the previous one into a blend; one that comes too late leaves
the stop as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from interp.robot.arm import ArmEvent, Motion, Position, Samples
from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.solution_choice import check_limits
from interp.robot.path.programmed_targets import Programmed, check_numbers
from interp.robot.planning.blend_zones import zone_of
from interp.robot.planning.blending import blend_of
from interp.robot.planning.path_events import agenda
from interp.robot.planning.path_execution import PathExecution
from interp.robot.planning.plan import Plan
from interp.robot.planning.spline_blocks import block
from interp.robot.planning.timeline import MICROSECOND, Key, Leg, Timeline, micros
from interp.robot.planning.torque_limits import Dynamics, TorqueLimits
from interp.robot.planning.tracks import Track, Tracks
from interp.values.faults import Fault
from interp.values.poses import Pose

_ROUNDING = 1e-9  # of u
_BACK = 1e-3  # degrees or mm by which the arm may have come back beside the place it left


class PlannedArm:
    """An `interp.robot.arm.Arm` of set-points only, which every robot follows.

    ``start`` are the axes as `MachineData.standing` takes them. With ``dynamics``, the masses of
    the arm, no motion needs more than the torques in the machine data. Raises `Fault` 1447 for a
    start beyond a software limit switch.
    """

    def __init__(
        self, machine: MachineData, start: Sequence[float], dynamics: Dynamics | None = None
    ) -> None:
        torques = None if dynamics is None else TorqueLimits(dynamics, machine.torques)
        self._tracks = Tracks(machine, torques)
        axes = np.array(machine.standing(start))
        axes[:ROBOT_AXES] = self._tracks.arm.coupled(axes[:ROBOT_AXES])
        check_limits(machine.every_axis, axes.tolist())
        self._plan = Plan(Programmed(self._tracks.arm, axes))
        #: For each brake what it interrupted, once other motions were planned behind it [INT-09].
        self._brakes: list[Plan | None] = []
        self._timeline = Timeline(axes)
        self._execution = PathExecution(self._timeline)
        self._override = 1.0
        self._now = 0
        #: The end of the last brake, until it was taken.
        self._stopped: ArmEvent | None = None
        #: All events ahead, the earliest last; ``None`` if the path has changed since.
        self._agenda: list[ArmEvent] | None = None

    # ------------------------------------------------------------------------------- planning

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; see `interp.robot.arm.Arm.plan`.

        Returns the numbers of messages that stop nothing: 3171 for a motion of length zero
        [MOT-11], 2868 for a PTP into a singularity [POS-08].
        """
        self._advance(now)
        check_numbers(motion)
        plan = self._standing_plan() if self._is_braked else self._plan
        if motion.kind in {"SPLINE", "PTP_SPLINE"}:
            track, programmed = block(self._tracks, motion, plan.programmed)
        else:
            track, programmed = self._tracks.track(
                motion, plan.programmed, is_after_abort=plan.is_aborted
            )
        if self._is_braked:
            self._brakes[-1] = self._plan
        following = self._blended(plan, track, programmed)
        if following is None or not self._schedule(following, is_strict=True):
            following = plan.with_motion(track, programmed)
            self._schedule(following)
        self._plan = following
        return track.notices

    def mark(self) -> Callable[[], None]:
        """See `interp.robot.arm.Arm.mark`."""
        known = self._plan, [*self._brakes], self._now
        legs = tuple(self._timeline.legs)

        def rewind() -> None:
            self._plan, self._brakes[:], self._now = known
            self._timeline.restore(legs)
            self._agenda = None

        return rewind

    def _blended(self, plan: Plan, track: Track, programmed: Programmed) -> Plan | None:
        """Return a plan with one more motion and a blend into it, or ``None``.

        There may be no blend, or it may be too late for it.
        """
        path = plan.sections
        if plan.last is None or not self._execution.ahead(path, self._seconds):
            return None
        zone = zone_of(plan.last, track)
        if zone is None:
            return None
        body, leaves = path[-1], 1.0 - zone.before
        reached = self._execution.reached(body, self._seconds)
        if self._override == 0.0:  # it may brake still
            reached = max(reached, self._execution.stood_at(body))
        if reached > leaves + _ROUNDING:
            return None
        try:
            blend = blend_of(self._tracks, plan.last, track, zone, plan.straight)
        except Fault:
            return None
        return plan.with_blend(blend, track, programmed)

    def _standing_plan(self, *, is_aborted: bool = False) -> Plan:
        """Return an empty plan that starts where the arm stops."""
        axes = self._timeline.axes_at(self._end)
        return Plan(Programmed(self._tracks.arm, axes), is_aborted=is_aborted)

    # ----------------------------------------------------------------------------------- events

    def next_event(self) -> ArmEvent | None:
        """See `interp.robot.arm.Arm.next_event`."""
        events = self._events()
        return events[-1] if events else None

    def take(self) -> ArmEvent:
        """Take the next event as `interp.robot.arm.Arm.take`; raises `IndexError` without one."""
        event = self._events().pop()
        self._advance(event.time)
        if event.kind == "stopped":
            self._stopped = None
        else:
            self._plan = self._plan.without(event)
        return event

    def pending(self) -> int:
        """See `interp.robot.arm.Arm.pending`."""
        return sum(plan.pending for plan in self._plans())

    def _events(self) -> list[ArmEvent]:
        """Return all events ahead, the earliest last."""
        if self._agenda is None:
            path, is_braked = self._plan.sections, self._is_braked

            def stop_from(time: float) -> tuple[Key, float] | None:
                return None if is_braked else self._execution.stop_from(path, time)

            self._agenda = agenda(
                self._plan.passages, self._timeline, self._now, stop_from, self._stopped
            )
        return self._agenda

    def _plans(self) -> tuple[Plan, ...]:
        """Return what brakes have interrupted, and the current plan."""
        return (*(plan for plan in self._brakes if plan is not None), self._plan)

    # ------------------------------------------------------------------------------ where it is

    def target(self) -> Position:
        """Return the target of the last planned motion, or the position of an arm without one."""
        programmed = self._plan.programmed
        return Position(tuple(programmed.axes.tolist()), programmed.flange)

    def position(self, time: int) -> Position:
        """See `interp.robot.arm.Arm.position`."""
        axes = self._timeline.axes_at(time * MICROSECOND)
        flange = self._tracks.arm.forward(axes[:ROBOT_AXES])
        return Position(tuple(axes.tolist()), Pose.from_matrix(flange.tolist()))

    def speed(self, time: int) -> float:
        """See `interp.robot.arm.Arm.speed`."""
        seconds = time * MICROSECOND
        leg = self._timeline.leg_at(seconds)
        return 0.0 if leg is None else leg.tool_speed(seconds) / 1000.0

    def distances(self, time: int) -> tuple[float, float]:
        """See `interp.robot.arm.Arm.distances`; 0 and 0 where no motion is on."""
        seconds = time * MICROSECOND
        leg = self._timeline.leg_at(seconds)
        if leg is None:
            return 0.0, 0.0
        section, u = leg.section, leg.state(seconds).u
        number = section.motion_at(u)
        for passage in self._plan.passages:
            if passage.number == number:
                return passage.distances(section.key, u)
        return 0.0, 0.0

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """See `interp.robot.arm.Arm.sample`."""
        return self._timeline.sample(np.asarray(times, dtype=np.int64))

    def forget(self, time: int) -> None:
        """See `interp.robot.arm.Arm.forget`."""
        oldest = min(plan.oldest for plan in self._plans())
        self._timeline.forget(time * MICROSECOND, oldest)

    def path(self) -> tuple[Leg, ...]:
        """Return the legs of the path, from the oldest that is kept to the last planned one.

        Each leg has its `Section` with the curve, its parameters, the path of the tool with kind
        and control points, and its times.
        """
        return tuple(self._timeline.legs)

    # ------------------------------------------------------------------------ stopping and going

    def override(self, now: int, percent: float) -> None:
        """See `interp.robot.arm.Arm.override`. Raises `Fault` 1422 outside 0 to 100."""
        if not 0.0 <= percent <= 100.0:
            text = f"$OV_PRO is {percent:g}, not within 0 to 100"
            raise Fault("invalid", text, number=1422, rules=("MOT-09",))
        self._advance(now)
        was, self._override = self._override, percent / 100.0
        if self._is_braked or was == self._override:
            return
        if self._override == 0.0:
            self._halt(is_hard=False)
        else:
            self._schedule(self._plan)

    def brake(self, now: int, is_hard: bool) -> None:
        """See `interp.robot.arm.Arm.brake`."""
        self._advance(now)
        self._halt(is_hard=is_hard)
        self._brakes.append(None)
        self._announce_stop()

    def proceed(self, now: int) -> None:
        """See `interp.robot.arm.Arm.proceed`: undoes the latest brake.

        Raises `ValueError` where the arm has been moved away and not back.
        """
        self._advance(now)
        if self._brakes and (plan := self._brakes[-1]) is not None:
            here = self._timeline.axes_at(self._end)
            if np.abs(here - self._left_at(plan)).max() > _BACK:
                raise ValueError("the arm is not where the brake has left it")
            self._plan = plan
        del self._brakes[-1:]
        self._stopped = None
        if not self._is_braked and self._override > 0.0:
            self._schedule(self._plan)

    def discard(self, now: int) -> None:
        """See `interp.robot.arm.Arm.discard`."""
        self._advance(now)
        is_moving = self._execution.is_moving(self._seconds)
        if is_moving and not self._is_braked:
            self._halt(is_hard=False)
            self._announce_stop()
        else:
            self._timeline.cut(self._end if is_moving else self._seconds)
        self._brakes.clear()
        self._plan = self._standing_plan(is_aborted=True)
        self._agenda = None

    def _announce_stop(self) -> None:
        """Set the event of the end of a brake, in the motion in which the arm comes to rest."""
        leg = self._timeline.leg_at(self._end)
        passages = self._plan.passages
        number = leg.section.number if leg else passages[0].number if passages else 0
        self._stopped = ArmEvent(max(self._now, micros(self._end)), "stopped", number)

    def _left_at(self, plan: Plan) -> Array:
        """Return the axes at which a plan was interrupted."""
        section = next(iter(self._execution.ahead(plan.sections, self._seconds)), None)
        if section is None:
            return plan.programmed.axes
        axes: Array
        (axes,) = section.curve.axes(np.array([self._execution.stood_at(section)]))
        return axes

    @property
    def _is_braked(self) -> bool:
        """Whether nothing was planned behind the last brake."""
        return bool(self._brakes) and self._brakes[-1] is None

    # -------------------------------------------------------------------------- time and schedule

    @property
    def _seconds(self) -> float:
        """The present time in seconds."""
        return self._now * MICROSECOND

    @property
    def _end(self) -> float:
        """The end of the last leg in seconds, or now."""
        return max(self._timeline.end, self._seconds)

    def _advance(self, now: int) -> None:
        self._now = max(self._now, now)

    def _schedule(self, plan: Plan, *, is_strict: bool = False) -> bool:
        """Schedule a plan from now on, unless the override is 0; return whether that was possible.

        With ``is_strict`` it is so only if no seam is passed too fast.
        """
        self._agenda = None
        if self._override == 0.0:
            return True
        path, time = plan.sections, self._seconds
        return self._execution.go(path, time, self._override, is_strict=is_strict)

    def _halt(self, *, is_hard: bool) -> None:
        """Stop on the path."""
        self._agenda = None
        self._execution.halt(self._plan.sections, self._seconds, is_hard=is_hard)
