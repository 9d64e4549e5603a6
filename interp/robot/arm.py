"""The port between whoever owns the motion queue and whatever plans motions.

A `Motion` is one motion instruction with all that was in force when the advance run met it. An
`Arm` appends motions to one unbroken path, decides where they blend, and reports when the path
passes which places. Times are whole microseconds of the virtual clock, lengths millimetres, angles
degrees, speeds as their system variables have them. What an arm will do may still change while it
is on its way (a further motion is appended, the override changes, it brakes), so `Arm.next_event`
is asked anew each time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Literal, Protocol

from interp.port.requests import At, SplineRange
from interp.robot.kinematics.placement import Placement
from interp.values.poses import IDENTITY, Pose
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: The members of a target that the program gave: X…C, S, T, E1…E6 or A1…A6, in upper case. What it
#: left out is missing and keeps the value of the target before [MOT-16].
Target = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Approximation:
    """$APO: mm, per cent of half the path, per cent of the speed, degrees [BLD-01 to BLD-06]."""

    cdis: float = 0.0
    cptp: float = 0.0
    cvel: float = 100.0
    cori: float = 0.0


@dataclass(frozen=True, slots=True)
class Load:
    """A mass in kg at ``centre``, in mm, with its own inertia about X, Y and Z in kg m² [TYP-14].

    ``centre`` counts in front of the flange for $LOAD and $LOAD_A3 (with axes 4 to 6 at 0), of the
    robot's foot for $LOAD_A1 (with A1 at 0) and $LOAD_A2 (with A2 at -90).
    """

    mass: float
    centre: Pose = IDENTITY
    inertia: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Settings:
    """The advance values of the motion parameters, as they stood when a motion was planned.

    ``velocity`` and ``acceleration`` are $VEL.CP and $ACC.CP in m/s and m/s², ``swivel`` and
    ``rotation`` the pairs ORI1 and ORI2 of both in deg/s and deg/s² [MOT-04]. ``axis_velocity``,
    ``axis_acceleration`` and ``axis_jerk`` are per cent of the machine data, robot axes first, then
    external ones [MOT-02]. ``is_reduced`` is T1 [MOT-07]. ``speed_type`` is $CP_VEL_TYPE, as
    delivered [MOT-08]; ``target_status`` is $TARGET_STATUS [POS-09]. ``loads`` are those of $LOAD,
    $LOAD_A1, $LOAD_A2 and $LOAD_A3 that have a mass, by these names.
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
    """A place of a motion whose passing is asked for: what a trigger is about [TRG-01 to TRG-11].

    ``kind`` DISTANCE: ``position`` 0 is the start, 1 the end; PATH: millimetres from the end, or
    from the start where ``on_start``. ``delay`` is in µs, negative for earlier. What lies outside
    the admissible range is moved to its nearest limit [TRG-07].
    """

    key: int
    kind: Literal["DISTANCE", "PATH"]
    position: float
    on_start: bool = False
    delay: int = 0


@dataclass(frozen=True, slots=True)
class SplinePart:
    """One segment of a spline block, with the ranges and places written before it.

    Places count from its end, or from its start. ``settings`` is ``None`` for those of the block.
    """

    kind: str
    target: Target
    auxiliary: Target | None = None
    angle: float | None = None
    settings: Settings | None = None
    ranges: tuple[SplineRange, ...] = ()
    places: tuple[Place, ...] = ()
    stop_places: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class Motion:
    """One motion instruction.

    ``number`` counts motions from 1 in the order they are planned. ``kind`` is PTP, LIN, CIRC,
    SPTP, SLIN, SCIRC, SPLINE or PTP_SPLINE; the last two have ``parts`` and no target of their own.
    ``is_relative`` and ``reference`` (#BASE or #TOOL) are those of the _REL forms [MOT-14].
    ``criteria`` are C_PTP, C_DIS and so on, in their order. ``stop_places`` are the STOP WHEN PATH
    of a block: the path can be left there. ``ranges`` are those behind the last of the parts.
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
    """The path passes something at ``time`` (µs).

    Between two motions that blend, ``blend_start`` and ``blend_apex`` have the number of the first
    and ``blend_end`` that of the second; the first has its ``motion_end`` and the second its
    ``motion_start`` at the apex. ``key`` is that of a `Place`. ``is_exact_unwanted`` marks the
    ``motion_end`` of a motion that should have blended and could not [ADV-12]. ``stopped`` comes
    when the arm stands still after `Arm.brake`.
    """

    time: int
    kind: EventKind
    motion: int
    key: int | None = None
    is_exact_unwanted: bool = False


@dataclass(frozen=True, slots=True)
class Position:
    """Where the arm is: axes in degrees (mm for linear ones), the flange in front of the foot."""

    axes: tuple[float, ...]
    flange: Pose


@dataclass(frozen=True, slots=True)
class Samples:
    """Set-points at ``n`` times, of shape (n, axes)."""

    times: npt.NDArray[np.int64]
    axes: npt.NDArray[np.float64]


class Arm(Protocol):
    """Plans motions and knows where it is at any time from the first motion to the last."""

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; it starts at once if the arm stands still with nothing before it.

        Returns the numbers of messages that stop nothing, such as 3171 for a motion that goes
        nowhere [MOT-11].

        Raises `interp.values.faults.Fault` (a point out of reach, a software limit, a degenerate
        circle and so on [MOT-10 to MOT-15]); then nothing is appended.
        """
        ...

    def mark(self) -> object:
        """What `rewind` needs to undo all that is planned from here on."""
        ...

    def rewind(self, mark: object) -> None:
        """Undo each `plan` since the mark; no time has passed and nothing else was called."""
        ...

    def next_event(self) -> ArmEvent | None:
        """The earliest event not taken yet, as planned today; ``None`` if nothing lies ahead."""
        ...

    def take(self) -> ArmEvent:
        """`next_event`, which has now happened."""
        ...

    def pending(self) -> int:
        """How many motions are planned and not yet ended, the running one included."""
        ...

    def position(self, time: int) -> Position:
        """The set-point at a time that is not after the last event planned; else where it stops."""
        ...

    def speed(self, time: int) -> float:
        """The speed of the tool on its path, m/s."""
        ...

    def distances(self, time: int) -> tuple[float, float]:
        """Of the running motion: mm travelled since its start, and mm left to its end [MOT-18]."""
        ...

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Set-points at rising times, all of them in the past or at `now`."""
        ...

    def override(self, now: int, percent: float) -> None:
        """$OV_PRO changes; 0 stops on the path, and any more continues from there."""
        ...

    def brake(self, now: int, is_hard: bool) -> None:
        """Stop on the path, with the ramp of the motion or the hardest one [INT-09]."""
        ...

    def proceed(self, now: int) -> None:
        """Continue with what a brake interrupted."""
        ...

    def discard(self, now: int) -> None:
        """Forget all that is not travelled yet; the arm stands, or stops on its path [INT-10].

        The next motion starts from where it stands [INT-14].
        """
        ...
