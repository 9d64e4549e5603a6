"""The interface between the owner of the motion queue and a planner of motions.

A `Motion` is one motion instruction with all settings that were in force when the advance run
reached it. An `Arm` appends motions to one continuous path, decides where they are blended, and
reports when the path passes which places. Times are whole µs of the virtual clock, lengths mm,
angles degrees, and speeds in the units of their system variables.

The future of an arm may still change while it moves: another motion is appended, the override
changes, it brakes. So `Arm.next_event` must be called again each time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Literal, Protocol

from interp.port.requests import At, SplineRange
from interp.robot.kinematics.placement import Placement
from interp.values.poses import IDENTITY, Pose
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: The components of a target that the program gives: X…C, S, T, E1…E6 or A1…A6, in upper case. A
#: component that is missing keeps its value of the previous target [MOT-16].
Target = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Approximation:
    """$APO: mm, per cent of half the path, per cent of the speed, degrees [BLD-01 to BLD-06].

    None is below 0.
    """

    cdis: float = 0.0
    cptp: float = 0.0
    cvel: float = 100.0
    cori: float = 0.0


@dataclass(frozen=True, slots=True)
class Load:
    """A mass in kg at ``centre``, in mm, with its own inertia about X, Y and Z in kg m² [TYP-14].

    ``centre`` is relative to the flange for $LOAD and $LOAD_A3 (with axes 4 to 6 at 0), and to the
    robot's foot for $LOAD_A1 (with A1 at 0) and $LOAD_A2 (with A2 at -90).
    """

    mass: float
    centre: Pose = IDENTITY
    inertia: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Settings:
    """The values of the motion parameters in the advance run when a motion was planned.

    ``velocity`` and ``acceleration`` are $VEL.CP and $ACC.CP in m/s and m/s²; ``swivel`` and
    ``rotation`` are the pairs of velocity and acceleration for ORI1 and ORI2, in deg/s and deg/s²
    [MOT-04]. ``axis_velocity``, ``axis_acceleration`` and ``axis_jerk`` are per cent of the machine
    data, robot axes first, then external axes [MOT-02]. ``is_reduced`` is set in T1 [MOT-07].
    ``orientation`` is $ORI_TYPE, ``circle`` $CIRC_TYPE, ``speed_type`` $CP_VEL_TYPE [MOT-08], and
    ``target_status`` $TARGET_STATUS [POS-09]. ``loads`` has those of $LOAD, $LOAD_A1, $LOAD_A2 and
    $LOAD_A3 that have a mass, by these names.
    """

    placement: Placement = field(default_factory=Placement)
    velocity: float = 2.0
    acceleration: float = 2.3
    swivel: tuple[float, float] = (200.0, 100.0)
    rotation: tuple[float, float] = (200.0, 100.0)
    axis_velocity: tuple[float, ...] = (100.0,) * 12
    axis_acceleration: tuple[float, ...] = (100.0,) * 12
    axis_jerk: tuple[float, ...] = (100.0,) * 12
    approximation: Approximation = field(default_factory=Approximation)
    orientation: str = "#VAR"
    circle: str = "#BASE"
    is_reduced: bool = False
    speed_type: str = "#VAR_T1"
    target_status: str = "#SOURCE"
    loads: Mapping[str, Load] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Place:
    """A place of a motion whose passing is to be reported, for a trigger [TRG-01 to TRG-11].

    For ``kind`` DISTANCE, ``position`` 0 is the start and 1 the end. For PATH it is in mm from the
    end, or from the start with ``on_start``. ``delay`` is in µs, negative for earlier. A place
    outside the permitted range is moved to the nearest limit [TRG-07].
    """

    key: int
    kind: str
    position: float
    on_start: bool = False
    delay: int = 0


@dataclass(frozen=True, slots=True)
class SplinePart:
    """One segment of a spline block, with the ranges and places written before it.

    Places are relative to its end, or to its start. ``settings`` is ``None`` if the segment uses
    those of the block. ``is_relative`` and ``reference`` are as in `Motion`.
    """

    kind: str
    target: Target
    auxiliary: Target | None = None
    angle: float | None = None
    settings: Settings | None = None
    is_relative: bool = False
    reference: str | None = None
    ranges: tuple[SplineRange, ...] = ()
    places: tuple[Place, ...] = ()
    stop_places: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class Motion:
    """One motion instruction.

    ``number`` counts planned motions from 1. ``kind`` is PTP, LIN, CIRC, SPTP, SLIN, SCIRC, SPLINE
    or PTP_SPLINE; the last two have ``parts`` instead of a target. ``is_relative`` and
    ``reference`` (#BASE or #TOOL) belong to the _REL forms [MOT-14]. ``criteria`` are C_PTP, C_DIS
    and so on, in their order. ``stop_places`` are the STOP WHEN PATH places of a block, at which
    the motion may be stopped. ``ranges`` are those after the last part.
    """

    number: int
    at: At
    kind: str
    settings: Settings
    target: Target = field(default_factory=dict)
    auxiliary: Target | None = None
    angle: float | None = None
    is_relative: bool = False
    reference: str | None = None
    criteria: tuple[str, ...] = ()
    places: tuple[Place, ...] = ()
    parts: tuple[SplinePart, ...] = ()
    stop_places: tuple[Place, ...] = ()
    ranges: tuple[SplineRange, ...] = ()


EventKind = Literal[
    "motion_start", "blend_start", "blend_apex", "blend_end", "motion_end", "place", "stopped"
]


@dataclass(frozen=True, slots=True)
class ArmEvent:
    """The path passes a place, or reaches a stage of a motion, at ``time`` in µs.

    Between two motions that are blended, ``blend_start`` and ``blend_apex`` have the number of the
    first motion and ``blend_end`` that of the second. At the apex, the first has its
    ``motion_end`` and the second its ``motion_start``. ``key`` is that of a `Place`.
    ``is_exact_unwanted`` marks the ``motion_end`` of a motion that should have been blended and
    could not be [ADV-12]. ``is_late`` marks a place before which a brake no longer ends.
    ``stopped`` occurs when the arm is at rest after `Arm.brake`.
    """

    time: int
    kind: EventKind
    motion: int
    key: int | None = None
    is_exact_unwanted: bool = False
    is_late: bool = False


@dataclass(frozen=True, slots=True)
class Position:
    """A position of the arm: axes in degrees (mm if linear), the flange relative to the foot."""

    axes: tuple[float, ...]
    flange: Pose


@dataclass(frozen=True, slots=True)
class Samples:
    """Set-points at ``n`` times in µs, as an array of shape (n, axes)."""

    times: npt.NDArray[np.int64]
    axes: npt.NDArray[np.float64]


class Arm(Protocol):
    """Plans motions, and returns the set-points of the path at any time."""

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; it starts at once if the arm is at rest and nothing precedes it.

        Return the numbers of messages that stop nothing, such as 3171 for a motion to the present
        position [MOT-11].

        Raises `interp.values.faults.Fault` (a point out of reach, a software limit, a degenerate
        circle and so on [MOT-10 to MOT-15]); then nothing is appended.
        """
        ...

    def mark(self) -> Callable[[], None]:
        """Return what undoes each `plan` from here on.

        No time may pass and nothing else be called between.
        """
        ...

    def next_event(self) -> ArmEvent | None:
        """Return the next event not taken yet, by the present plan; ``None`` if there is none."""
        ...

    def take(self) -> ArmEvent:
        """Remove and return `next_event`, because it has happened."""
        ...

    def pending(self) -> int:
        """Return the number of motions that have not ended, including the running one."""
        ...

    def position(self, time: int) -> Position:
        """Return the set-point at a time in µs, which must not be after the last planned event.

        After that time the arm is at rest.
        """
        ...

    def speed(self, time: int) -> float:
        """Return the speed of the tool on its path in m/s."""
        ...

    def distances(self, time: int) -> tuple[float, float]:
        """Return how far the running motion is from its start and from its end, in mm [MOT-18]."""
        ...

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Return set-points at increasing times, none of them later than now."""
        ...

    def forget(self, time: int) -> None:
        """Forget the path before a time, which is not asked for again."""
        ...

    def override(self, now: int, percent: float) -> None:
        """Apply a change of $OV_PRO; 0 stops on the path, any other value continues from there."""
        ...

    def brake(self, now: int, is_hard: bool) -> None:
        """Brake on the path, with the ramp of the motion or the hardest possible one [INT-09]."""
        ...

    def proceed(self, now: int) -> None:
        """Continue the motion that a brake interrupted, from where the arm left its path.

        Raises `ValueError` if the arm is elsewhere. The controller moves it back before
        (`interp.controller.interrupts.levels`).
        """
        ...

    def discard(self, now: int) -> None:
        """Discard all that is not travelled yet [INT-10].

        The arm stays at rest, or comes to rest on its path. The next motion starts there [INT-14].
        """
        ...
