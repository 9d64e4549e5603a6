"""The planned arm: takes motions and plans one continuous path with a time for each point.

Each motion becomes a section of path, and so does each blend between two. At every call, everything
that lies ahead is scheduled again; what was travelled is kept. A motion that is appended in time
therefore turns the stop at the end of the previous one into a blend; one that comes too late leaves
the stop as it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from interp.robot.arm import ArmEvent, Motion, Position, Samples
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.kinematics.targets import check_limits
from interp.robot.path.axis_path import tool_tangents
from interp.robot.path.targets_in_force import Programmed, check_numbers
from interp.robot.planning.blend_zones import zone_of
from interp.robot.planning.blending import blend_of
from interp.robot.planning.execution import PathExecution
from interp.robot.planning.path_events import Passage, events_of
from interp.robot.planning.spline_blocks import block
from interp.robot.planning.straight_run import StraightRun
from interp.robot.planning.timeline import (
    MICROSECOND,
    Key,
    Leg,
    Section,
    Timeline,
    micros,
)
from interp.robot.planning.torque_limits import Dynamics, TorqueLimits
from interp.robot.planning.tracks import Track, Tracks
from interp.values.faults import Fault
from interp.values.poses import Pose

_BACK = 1e-3  # degrees or mm by which the arm may have come back beside the place it left


@dataclass(frozen=True, slots=True, eq=False)
class _Plan:
    """Everything that is planned and not travelled yet; the next motion follows ``last``.

    ``programmed`` is the target from which the next motion starts, ``straight`` the straight run
    that ends with the last motion, if it has more than one motion.
    """

    programmed: Programmed
    route: tuple[Section, ...] = ()
    passages: tuple[Passage, ...] = ()
    last: Track | None = None
    straight: StraightRun | None = None
    is_aborted: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class _Mark:
    plan: _Plan
    brakes: tuple[_Plan | None, ...]
    legs: tuple[Leg, ...]
    stopped: ArmEvent | None
    now: int


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
        check_limits((*machine.axes, *machine.externals), axes.tolist())
        self._plan = _Plan(Programmed(self._tracks.arm, axes))
        #: For each brake what it interrupted, once other motions were planned behind it [INT-09].
        self._brakes: list[_Plan | None] = []
        self._timeline = Timeline(axes)
        self._execution = PathExecution(self._timeline)
        self._override = 1.0
        self._stopped: ArmEvent | None = None
        self._agenda: list[ArmEvent] | None = None
        self._now = 0

    # ------------------------------------------------------------------------------- planning

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; see `interp.robot.arm.Arm.plan`.

        Returns the numbers of messages that stop nothing: 3171 for a motion of length zero
        [MOT-11], 2868 for a PTP into a singularity [POS-08].
        """
        self._observe(now)
        check_numbers(motion)
        plan = self._standing_plan() if self._is_braked else self._plan
        if motion.kind in {"SPLINE", "PTP_SPLINE"}:
            track, programmed = block(self._tracks, motion, plan.programmed)
        else:
            track, programmed = self._tracks.track(
                motion, plan.programmed, is_after_abort=plan.is_aborted
            )
        if plan is not self._plan:
            self._brakes[-1] = self._plan
            self._plan = plan
        if not self._append_blended(track, programmed):
            sections = _sections(track)
            self._plan = _Plan(
                programmed,
                (*self._plan.route, *sections),
                (*self._plan.passages, Passage(motion, sections)),
                track,
            )
            self._reschedule(self._plan.route)
        return track.notices

    def mark(self) -> object:
        """See `interp.robot.arm.Arm.mark`."""
        return _Mark(
            self._plan,
            tuple(self._brakes),
            tuple(self._timeline.legs),
            self._stopped,
            self._now,
        )

    def rewind(self, mark: object) -> None:
        """See `interp.robot.arm.Arm.rewind`."""
        if not isinstance(mark, _Mark):
            raise TypeError("not a mark of this arm")
        self._plan, self._brakes = mark.plan, list(mark.brakes)
        self._timeline.restore(mark.legs)
        self._stopped, self._now = mark.stopped, mark.now
        self._agenda = None

    def _append_blended(self, track: Track, programmed: Programmed) -> bool:
        """Append a motion with a blend into it, if a blend exists and there is time for it."""
        before = self._plan
        if before.last is None or not before.route or not before.passages:
            return False
        body, passage = before.route[-1], before.passages[-1]
        zone = zone_of(before.last, track)
        if zone is None or body.number != passage.number:
            return False
        leaves = 1.0 - zone.before
        reached = self._execution.reached(body, self._now * MICROSECOND)
        if self._override == 0.0:  # it may brake still
            reached = max(reached, self._execution.stood_at(body))
        if leaves < body.start or reached > leaves:
            return False
        try:
            machine, limits = self._tracks.machine, self._tracks.limits
            planned = blend_of(before.last, track, zone, machine, limits, before.straight)
        except Fault:
            return False
        number = track.motion.number
        shorter = replace(body, end=1.0 - planned.zone.before)
        blend = Section(body.number, number, planned.curve, planned.limits, junction=planned.into)
        first, *others = _sections(track)
        rest = (replace(first, start=planned.zone.after, junction=planned.out), *others)
        route = (*before.route[:-1], shorter, blend, *rest)
        if planned.straight is not None:
            route = tuple(planned.straight.bounded(section) for section in route)
            shorter = route[len(before.route) - 1]
        if not self._reschedule(route, new_behind=shorter):
            return False
        self._plan = _Plan(
            programmed,
            route,
            (
                *before.passages[:-1],
                replace(passage, body=(*passage.body[:-1], shorter), out=blend),
                Passage(track.motion, rest, into=blend),
            ),
            track,
            planned.straight,
        )
        return True

    def _standing_plan(self) -> _Plan:
        """Return an empty plan that starts where the arm stops."""
        legs = self._timeline.legs
        axes = self._timeline.axes_at(max(legs[-1].ends, self._now * MICROSECOND))
        return _Plan(Programmed(self._tracks.arm, axes))

    # ----------------------------------------------------------------------------------- events

    def next_event(self) -> ArmEvent | None:
        """See `interp.robot.arm.Arm.next_event`."""
        agenda = self._events()
        return agenda[-1] if agenda else None

    def take(self) -> ArmEvent:
        """Take the next event as `interp.robot.arm.Arm.take`; raises `IndexError` without one."""
        event = self._events().pop()
        self._now = max(self._now, event.time)
        if event.kind == "stopped":
            self._stopped = None
            return event
        self._plan = replace(self._plan, passages=self._taken(self._plan.passages, event))
        return event

    def pending(self) -> int:
        """See `interp.robot.arm.Arm.pending`."""
        return sum(
            ("motion_end", None) not in passage.taken
            for plan in self._plans()
            for passage in plan.passages
        )

    def _plans(self) -> Iterator[_Plan]:
        """Yield what brakes have interrupted, and the current plan."""
        yield from (plan for plan in self._brakes if plan is not None)
        yield self._plan

    def _oldest(self) -> float:
        """Return the number of the oldest motion of which a part or an event may lie ahead."""
        sections: list[Section] = []
        for plan in self._plans():
            sections += plan.route[:1]
            sections += [part for passage in plan.passages[:1] for part, _, _ in passage.parts()]
        return min((section.number for section in sections), default=math.inf)

    def _taken(self, passages: tuple[Passage, ...], event: ArmEvent) -> tuple[Passage, ...]:
        """Return passages without an event; one without events is dropped unless it is the last."""
        found = []
        for passage in passages:
            known = passage
            if passage.number == event.motion:
                known = replace(passage, taken=passage.taken | {(event.kind, event.key)})
            if passage is passages[-1] or not known.is_over:
                found.append(known)
        return tuple(found)

    def _events(self) -> list[ArmEvent]:
        """Return all events ahead, the earliest last."""
        if self._agenda is None:
            found = [
                (time, passage.number, rank, event)
                for passage in self._plan.passages
                for time, rank, event in events_of(
                    passage, self._timeline, self._now, self._stop_from
                )
            ]
            found.sort(key=lambda entry: entry[:3], reverse=True)
            self._agenda = [event for _, _, _, event in found]
            if self._stopped is not None:
                time = self._stopped.time
                place = sum(event.time > time for event in self._agenda)
                self._agenda.insert(place, self._stopped)
        return self._agenda

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
        if leg is None or seconds >= leg.ends:
            return 0.0
        state = leg.state(seconds)
        tangent = tool_tangents(leg.section.curve, np.array([state.u]))
        return float(np.linalg.norm(tangent)) * state.speed / 1000.0

    def distances(self, time: int) -> tuple[float, float]:
        """See `interp.robot.arm.Arm.distances`; 0 and 0 where no motion is on."""
        seconds = time * MICROSECOND
        leg = self._timeline.leg_at(seconds)
        if leg is None:
            return 0.0, 0.0
        section, u = leg.section, leg.state(seconds).u
        number = section.number
        if section.following is not None and u >= 0.5:
            number = section.following
        for passage in self._plan.passages:
            if passage.number == number:
                return passage.distances(section.key, u)
        return 0.0, 0.0

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """See `interp.robot.arm.Arm.sample`."""
        return self._timeline.sample(np.asarray(times, dtype=np.int64))

    def forget(self, time: int) -> None:
        """See `interp.robot.arm.Arm.forget`."""
        self._timeline.forget(time * MICROSECOND, self._oldest())

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
        self._observe(now)
        was, self._override = self._override, percent / 100.0
        if self._is_braked or was == self._override:
            return
        if self._override == 0.0:
            self._halt(is_hard=False)
        else:
            self._reschedule(self._plan.route)

    def brake(self, now: int, is_hard: bool) -> None:
        """See `interp.robot.arm.Arm.brake`."""
        self._observe(now)
        self._halt(is_hard=is_hard)
        self._brakes.append(None)
        self._tell_stop()

    def proceed(self, now: int) -> None:
        """See `interp.robot.arm.Arm.proceed`: undoes the latest brake.

        Raises `ValueError` where the arm has been moved away and not back.
        """
        self._observe(now)
        if self._brakes and (plan := self._brakes[-1]) is not None:
            here = self._timeline.axes_at(self._end())
            if np.abs(here - self._left_at(plan)).max() > _BACK:
                raise ValueError("the arm is not where the brake has left it")
            self._plan = plan
        del self._brakes[-1:]
        self._stopped = None
        if not self._is_braked and self._override > 0.0:
            self._reschedule(self._plan.route)

    def discard(self, now: int) -> None:
        """See `interp.robot.arm.Arm.discard`."""
        self._observe(now)
        is_moving = self._execution.is_moving(now * MICROSECOND)
        if is_moving and not self._is_braked:
            self._halt(is_hard=False)
            self._tell_stop()
        else:
            self._timeline.cut(now * MICROSECOND if not is_moving else self._end())
        self._brakes.clear()
        axes = self._timeline.axes_at(self._end())
        self._plan = _Plan(Programmed(self._tracks.arm, axes), is_aborted=True)
        self._agenda = None

    def _tell_stop(self) -> None:
        passages = self._plan.passages
        number = passages[0].number if passages else 0
        leg = self._timeline.leg_at(self._end())
        if leg is not None:
            number = leg.section.number
        time = max(self._now, micros(self._end()))
        self._stopped = ArmEvent(time, "stopped", number)
        self._agenda = None

    def _end(self) -> float:
        """Return the end of the last leg in seconds, or now."""
        return max(self._timeline.end, self._now * MICROSECOND)

    @property
    def _is_braked(self) -> bool:
        """Whether the last brake still holds what it has interrupted."""
        return bool(self._brakes) and self._brakes[-1] is None

    def _observe(self, now: int) -> None:
        """Advance the time: remove from the route what was travelled."""
        self._now = max(self._now, now)
        route = self._plan.route
        ahead = self._execution.ahead(route, self._now * MICROSECOND)
        if len(ahead) < len(route):
            self._plan = replace(self._plan, route=ahead)

    def _left_at(self, plan: _Plan) -> Array:
        """Return the axes at which a plan was interrupted."""
        if not plan.route:
            return plan.programmed.axes
        section = plan.route[0]
        axes: Array = section.curve.axes(np.array([self._execution.stood_at(section)]))[0]
        return axes

    def _reschedule(self, route: Sequence[Section], *, new_behind: Section | None = None) -> bool:
        """Plan a route from now on, unless the override is 0.

        If the route is new after a section, do so only if no seam is passed too fast; return
        whether it was done.
        """
        self._agenda = None
        if self._override == 0.0:
            return True
        time = self._now * MICROSECOND
        return self._execution.go(route, time, self._override, new_behind=new_behind)

    def _halt(self, *, is_hard: bool) -> None:
        """Stop on the path."""
        self._agenda = None
        self._execution.halt(self._plan.route, self._now * MICROSECOND, is_hard=is_hard)

    def _stop_from(self, time: float) -> tuple[Key, float] | None:
        """Return where a brake at a time would end; ``None`` if the arm stands then."""
        if self._is_braked:
            return None
        return self._execution.stop_from(self._plan.route, time)


def _sections(track: Track) -> tuple[Section, ...]:
    """Return the sections of a motion without blends."""
    return tuple(
        Section(
            track.motion.number,
            None,
            piece.curve,
            piece.limits,
            junction=piece.junction,
            is_still=piece.is_still,
            part=part,
        )
        for part, piece in enumerate(track.pieces)
    )
