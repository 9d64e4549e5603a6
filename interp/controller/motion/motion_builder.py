"""The builder of motions: from motion instructions to motions of the arm [MOT-10 to MOT-16].

A motion includes the values of all system variables that affect it. What a program has not set
results in a documented message: no tool 1419, no base 1516, a first motion that is not a complete
PTP 1443.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from grammar.motion_kinds import AXIS_MOTIONS
from interp.controller.motion.positions import FramesInForce, constant_text, pose_of
from interp.controller.state.messages import message_fault, own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.variables import Snapshot
from interp.port.requests import (
    At,
    Move,
    MoveSpline,
    SetTrigger,
    SplineRange,
    SplineStop,
    Value,
)
from interp.robot.arm import (
    Approximation,
    Load,
    Motion,
    Place,
    Settings,
    SplinePart,
    Target,
)
from interp.robot.kinematics.machine_data import AXIS_NAMES, EXTERNAL_NAMES
from interp.values.poses import IDENTITY
from interp.values.values import StructureValue, known

_LOADS: Final = ("$LOAD", "$LOAD_A1", "$LOAD_A2", "$LOAD_A3")
#: The motion that brings the arm to the end of a line with which a program begins.
_BROUGHT: Final = {"LIN": "PTP", "SLIN": "SPTP"}
#: How a first motion that is not replaced is executed.
_FROM_HERE: Final = "from where the arm is"
#: The motion that replaces one that cannot be planned.
_REPLACED: Final = {**_BROUGHT, "CIRC": "PTP", "SCIRC": "SPTP"}


@dataclass(frozen=True, slots=True, eq=False)
class PlannedMotion:
    """A motion, the system variables it was planned with, and its triggers and stops by key."""

    motion: Motion
    snapshot: Snapshot
    triggers: dict[int, SetTrigger] = field(default_factory=dict)
    stops: dict[int, SplineStop] = field(default_factory=dict)


def target_of(value: Value) -> Target:
    """Return the components of a position that have a value."""
    if not isinstance(value, StructureValue):
        raise own_fault("motion_kind")
    members: list[Any] = value.members
    return {
        member.name.upper(): float(number)
        for member, number in zip(value.type.members, members, strict=True)
        if number is not None
    }


def is_complete(target: Target) -> bool:
    """Return whether a target has all six axes, or a pose with Status and Turn [MOT-10]."""
    return set(AXIS_NAMES) <= set(target) or set("XYZABCST") <= set(target)


def _numbers(value: Any) -> tuple[float, ...]:
    """Return the elements of an array; faults ``uninitialised`` if one has no value [TYP-13]."""
    found: list[Any] = [known(one) for one in value]
    return tuple(map(float, found))


def _loads(values: Snapshot) -> dict[str, Load]:
    """Return the loads that have a mass, by the names of their variables."""
    found = {name: _load(values.get(name)) for name in _LOADS}
    return {name: load for name, load in found.items() if load is not None}


def _load(value: Any) -> Load | None:
    """Return a load that has a mass, else ``None``; -1 kg means that the load is unknown."""
    mass = value.get("M") if isinstance(value, StructureValue) else None
    if not isinstance(mass, int | float) or not 0.0 < mass < math.inf:
        return None
    inertia: Any = value.get("J")
    about = [inertia.get(name) or 0.0 for name in "XYZ"] if inertia is not None else [0.0] * 3
    x, y, z = (max(float(one), 0.0) for one in about)
    return Load(float(mass), pose_of(value.get("CM")) or IDENTITY, (x, y, z))


def _number(structure: Any, member: str) -> float:
    """Return a member as a number; 0 if it has no value."""
    return float(structure.get(member) or 0.0)


def _pair(velocity: Any, acceleration: Any, name: str) -> tuple[float, float]:
    return _number(velocity, name), _number(acceleration, name)


def _reference(request: Move) -> str | None:
    """Return the reference of a relative motion, ``#BASE`` or ``#TOOL``, if it names one."""
    return None if request.reference is None else f"#{request.reference.lstrip('#')}"


def _begins_completely(block: MoveSpline) -> bool:
    """Return whether a block may be the first motion: its first segment is a complete SPTP."""
    first = next((item for item in block.items if isinstance(item, Move)), None)
    return first is not None and first.kind == "SPTP" and is_complete(target_of(first.target))


class MotionBuilder:
    """Builds motions; numbers them, and gives each of their places a key."""

    def __init__(self, state: ControllerState, frames: FramesInForce) -> None:
        self._state = state
        self._variables = state.variables
        self._frames = frames
        self._number = 0
        self._key = 0

    @property
    def count(self) -> int:
        """The number of motions that were built."""
        return self._number

    def forget(self) -> None:
        """Take back the number of the last motion, because it was not planned."""
        self._number -= 1

    def build(
        self, request: Move, triggers: Sequence[SetTrigger], *, is_replaced: bool = False
    ) -> PlannedMotion:
        """Build a single motion with the triggers before it. Raises `Fault`.

        With ``is_replaced``, build a PTP to the same point with any Status instead.
        """
        kind, _, suffix = request.kind.partition("_")
        if kind == "SPL":  # it belongs into a block
            raise own_fault("motion_kind")
        target = target_of(request.target)
        criteria = request.criteria
        if self._is_first and (suffix or kind not in AXIS_MOTIONS or not is_complete(target)):
            is_brought = not suffix and kind in _BROUGHT
            if is_brought:
                kind, criteria = _BROUGHT[kind], ()
            self._refuse_start(request.at, f"as {kind}" if is_brought else _FROM_HERE)
        snapshot = self._variables.snapshot(request.values)
        self._check_frames(snapshot, kind, target)
        settings = self._settings(snapshot)
        auxiliary = None if request.auxiliary is None else target_of(request.auxiliary)
        angle = request.angle
        if is_replaced:
            kind, criteria, auxiliary, angle = _REPLACED.get(kind, kind), (), None, None
            settings = replace(settings, target_status="#BEST")
            target = {name: value for name, value in target.items() if name not in ("S", "T")}
        set_triggers: dict[int, SetTrigger] = {}
        places = self._places(set_triggers, triggers)
        motion = Motion(
            self._next(),
            request.at,
            kind,
            settings,
            target,
            auxiliary,
            angle,
            bool(suffix),
            _reference(request),
            criteria,
            places,
        )
        return PlannedMotion(motion, snapshot, set_triggers)

    def block(self, request: MoveSpline, triggers: Sequence[SetTrigger]) -> PlannedMotion:
        """Build the motion of a spline block. Raises `Fault`."""
        if self._is_first and not _begins_completely(request):
            self._refuse_start(request.at, _FROM_HERE)
        snapshot = self._variables.snapshot(request.values)
        set_triggers: dict[int, SetTrigger] = {}
        set_stops: dict[int, SplineStop] = {}
        outside = self._places(set_triggers, triggers)
        parts: list[SplinePart] = []
        ranges: list[SplineRange] = []
        places: list[Place] = []
        stops: list[Place] = []
        for item in request.items:
            match item:
                case Move():
                    part = self._part(item, request, ranges, places)
                    parts.append(replace(part, stop_places=tuple(stops)))
                    ranges, places, stops = [], [], []
                case SetTrigger():
                    places += self._places(set_triggers, [item])
                case SplineStop(place, on_start, _):
                    stops.append(self._place("PATH", place, on_start, 0.0))
                    set_stops[stops[-1].key] = item
                case SplineRange():
                    ranges.append(item)
        motion = Motion(
            self._next(),
            request.at,
            request.keyword,
            self._settings(snapshot),
            criteria=("C_SPL",) if request.is_approximated else (),
            places=(*outside, *places),
            parts=tuple(parts),
            ranges=tuple(ranges),
            stop_places=tuple(stops),
        )
        return PlannedMotion(motion, snapshot, set_triggers, set_stops)

    @property
    def _is_first(self) -> bool:
        """Whether this is the first motion, in a program that is complete."""
        return self._number == 0 and not self._state.profile.is_tolerant

    def _refuse_start(self, at: At, how: str) -> None:
        """Reject a motion with which no program may begin [MOT-10].

        If the profile brings the arm to the first point, post a message instead; the motion is then
        executed as ``how`` says.
        """
        error = message_fault(1443)
        if not self._state.profile.brings_arm:
            raise error
        self._state.messages.post("robot", at, 1443, f"{error}: executed {how}")

    def back_to(self, at: At, axes: Sequence[float]) -> PlannedMotion:
        """Build the motion back to where an interrupt routine has stopped the arm."""
        snapshot = self._variables.snapshot()
        target = dict(zip((*AXIS_NAMES, *EXTERNAL_NAMES), axes, strict=False))
        return PlannedMotion(
            Motion(self._next(), at, "PTP", self._settings(snapshot), target), snapshot
        )

    def _next(self) -> int:
        self._number += 1
        return self._number

    def _part(
        self,
        item: Move,
        block: MoveSpline,
        ranges: Sequence[SplineRange],
        places: Sequence[Place],
    ) -> SplinePart:
        snapshot = self._variables.snapshot((*block.values, *item.values))
        target = target_of(item.target)
        self._check_frames(snapshot, item.kind, target)
        kind, _, suffix = item.kind.partition("_")
        return SplinePart(
            kind,
            target,
            None if item.auxiliary is None else target_of(item.auxiliary),
            item.angle,
            self._settings(snapshot),
            bool(suffix),
            _reference(item),
            tuple(ranges),
            tuple(places),
        )

    @staticmethod
    def _check_frames(snapshot: Snapshot, kind: str, target: Target) -> None:
        """Check that a Cartesian motion has a tool and a base [MOT-15]."""
        if kind in AXIS_MOTIONS and not set("XYZABC") & set(target):
            return
        if pose_of(snapshot["$TOOL"]) is None:
            raise message_fault(1419)
        if pose_of(snapshot["$BASE"]) is None:
            raise message_fault(1516)

    def _settings(self, values: Snapshot) -> Settings:
        velocity, acceleration, apo = values["$VEL"], values["$ACC"], values["$APO"]
        return Settings(
            self._frames.of(values),
            *_pair(velocity, acceleration, "CP"),
            _pair(velocity, acceleration, "ORI1"),
            _pair(velocity, acceleration, "ORI2"),
            _numbers(values["$VEL_AXIS"]) + _numbers(values["$VEL_EXTAX"]),
            _numbers(values["$ACC_AXIS"]) + _numbers(values["$ACC_EXTAX"]),
            _numbers(values["$GEAR_JERK"]),
            Approximation(
                *(max(_number(apo, name), 0.0) for name in ("CDIS", "CPTP", "CVEL", "CORI"))
            ),
            constant_text(values["$ORI_TYPE"]),
            constant_text(values["$CIRC_TYPE"]),
            self._state.mode == "T1",
            constant_text(self._variables.read(("$CP_VEL_TYPE",))),
            constant_text(self._variables.read(("$TARGET_STATUS",))),
            _loads(values),
        )

    def _places(
        self, by_key: dict[int, SetTrigger], triggers: Iterable[SetTrigger]
    ) -> tuple[Place, ...]:
        """Return the places of triggers, and note each trigger by the key of its place."""
        places = []
        for one in triggers:
            place = self._place(one.place_kind, one.place, one.on_start, one.delay)
            by_key[place.key] = one
            places.append(place)
        return tuple(places)

    def _place(self, kind: str, position: float, on_start: bool, delay: float) -> Place:
        """Return a place with a new key; ``delay`` is in ms, as in TRIGGER [TRG-03]."""
        self._key += 1
        return Place(self._key, kind, position, on_start, round(delay * 1000))
