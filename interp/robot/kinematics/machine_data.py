"""Machine data: what a `$machine.dat` says about an arm [POS-11, MOT-05, MOT-06].

The meaning of each variable is that of KUKA's operating handbook *KR C2, Machine Data* (2005),
which later releases keep. Lengths are in mm, angles in degrees, times in seconds.

The chain from the robot's foot to its flange, each step relative to the previous one::

    $TIRORO · Rz(A1) · x $LENGTH_A · Ry(A2) · x $LENGTH_B · Ry(A3)
            · $TX3P3 · Rz(A4) · $DH_4 · Rz(A5) · $DH_5 · Rz(A6) · $TFLWP

with every angle multiplied by its $AXIS_DIR. With all axes at zero the arm is stretched forward.
$MAMES says where the axes are mastered and does not affect the chain.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from enum import Enum

from interp.robot.kinematics.carrier import Carrier
from interp.robot.kinematics.chain import Chain, Joint
from interp.values.poses import IDENTITY, Pose
from support.lazy_dataclass import dataclass

ROBOT_AXES = 6
#: The names of the axes in positions.
AXIS_NAMES = ("A1", "A2", "A3", "A4", "A5", "A6")
EXTERNAL_NAMES = ("E1", "E2", "E3", "E4", "E5", "E6")
#: Seconds to full speed if the data has no run-up time; assumed, similar to that of other arms.
RUN_UP_TIME = 0.4
FILTER_TIME = 0.1  # seconds over which acceleration builds up; assumed too
T1_SPEED, T1_PERCENT = 0.25, 7.0
_TOLERANCE = 1e-9  # mm, or of a cosine
_ANGLE = 5e-8  # degrees: a point at 1 m is off by 1e-6 mm


class MachineDataError(Exception):
    """The data does not describe an arm; the text is one line."""


class AxisKind(Enum):
    """The kind of an axis; the values are those of $AXIS_TYPE."""

    LINEAR = 1
    ROTARY = 3
    ENDLESS = 5


@dataclass(frozen=True, slots=True)
class AxisDynamics:
    """The limits of an axis: velocity, acceleration and jerk, in degrees or mm and seconds."""

    velocity: float
    acceleration: float
    jerk: float

    @classmethod
    def ramped(
        cls, velocity: float, run_up: float = RUN_UP_TIME, filtered: float = FILTER_TIME
    ) -> AxisDynamics:
        """Return those of an axis with a time to full speed and one to full acceleration, in s."""
        acceleration = velocity / run_up
        return cls(velocity, acceleration, acceleration / filtered)


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis. ``lower`` and ``upper`` are its software limit switches in degrees or mm.

    ``direction`` is 1 or -1: the sense of rotation of a positive angle in the kinematic chain.
    ``dynamics`` is ``None`` if the data has no velocity. ``approximation`` is the largest distance
    over which a PTP motion may be blended. Limits that are ``assumed``, for a stand-in arm, only
    help to choose between solutions, and no motion is rejected for them.
    """

    name: str
    kind: AxisKind
    direction: int
    lower: float
    upper: float
    dynamics: AxisDynamics | None
    approximation: float
    assumed: bool = False

    def unlimited(self) -> Axis:
        """Return the axis without limits if they are assumed, else the axis itself."""
        return replace(self, lower=-math.inf, upper=math.inf) if self.assumed else self


class Palletising(Enum):
    """What constrains the wrist of a palletiser: $DEF_A4FIX alone, or $DEF_A5LINK too."""

    FIXED_A4 = "A4"
    LINKED_A5 = "A5"


@dataclass(frozen=True, slots=True)
class WristLink:
    """Denavit-Hartenberg parameters between two wrist axes, in mm and degrees."""

    a: float
    d: float
    alpha: float

    @property
    def pose(self) -> Pose:
        """The transform after the rotation about Z."""
        return Pose.of(z=self.d) @ Pose.of(x=self.a, c=self.alpha)


_NO_LINK = WristLink(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class CartesianLimits:
    """Limits of path, swivel and rotation: m or degrees, per second or second squared [MOT-05]."""

    path: float
    swivel: float
    rotation: float


DEFAULT_VELOCITY = CartesianLimits(3.0, 400.0, 400.0)
#: Those of an arm whose data has none.
DEFAULT_ACCELERATION = CartesianLimits(10.0, 1000.0, 1000.0)


@dataclass(frozen=True, slots=True)
class MachineData:
    """An arm and its external axes; most attributes are named as in $machine.dat.

    ``singul_pos`` is $SINGUL_POS [POS-08]. ``t1_speed`` is in m/s, ``t1_reduction`` a fraction of 1
    [MOT-07]. ``carrier`` is the external kinematic system that carries the robot [#ERSYS].
    ``tables`` are those that carry bases, by names such as #EASYS, each from the root that EK gives
    it. ``torques`` are the largest that the robot axes can bear, in Nm (N for linear axes): empty
    if all are unknown, infinite for a single unknown one. ``palletising`` is ``None`` if all axes
    are free. ``own_chain`` is set for an arm that was described joint by joint; its wrist lengths
    and frames have no meaning.
    """

    name: str
    axes: tuple[Axis, ...]
    version: str = ""
    externals: tuple[Axis, ...] = ()
    robroot: Pose = IDENTITY
    tiroro: Pose = IDENTITY
    length_a: float = 0.0
    length_b: float = 0.0
    tx3p3: Pose = IDENTITY
    dh_4: WristLink = _NO_LINK
    dh_5: WristLink = _NO_LINK
    tflwp: Pose = IDENTITY
    singul_pos: tuple[int, ...] = (0, 0, 0)
    velocity: CartesianLimits = DEFAULT_VELOCITY
    acceleration: CartesianLimits = DEFAULT_ACCELERATION
    t1_speed: float = T1_SPEED
    t1_reduction: float = T1_PERCENT / 100.0
    carrier: Carrier | None = None
    tables: Mapping[str, Carrier] = field(default_factory=dict)
    torques: tuple[float, ...] = ()
    palletising: Palletising | None = None
    own_chain: Chain | None = None

    @property
    def every_axis(self) -> tuple[Axis, ...]:
        """The axes of the robot, then the external axes."""
        return (*self.axes, *self.externals)

    def standing(self, axes: Sequence[float]) -> tuple[float, ...]:
        """Return values for all axes, beginning with the given ones.

        The others are at 0, or at the limit nearest to 0. Values are in degrees, or mm if linear,
        robot axes first; surplus values are dropped.
        """
        every = self.every_axis
        rest = (min(max(0.0, axis.lower), axis.upper) for axis in every[len(axes) :])
        return (*(float(value) for value in axes[: len(every)]), *rest)

    def foot(self, externals: Sequence[float]) -> Pose:
        """Return the foot of the robot relative to $WORLD, for external axes in degrees or mm."""
        return self.robroot if self.carrier is None else self.carrier.pose(externals)

    @property
    def chain(self) -> Chain:
        """The joints of the robot axes from the foot, $ROBROOT, to the flange."""
        if self.own_chain is not None:
            return self.own_chain
        frames = (
            (self.tiroro, (0.0, 0.0, 1.0)),
            (Pose.of(x=self.length_a), (0.0, 1.0, 0.0)),
            (Pose.of(x=self.length_b), (0.0, 1.0, 0.0)),
            (self.tx3p3, (0.0, 0.0, 1.0)),
            (self.dh_4.pose, (0.0, 0.0, 1.0)),
            (self.dh_5.pose, (0.0, 0.0, 1.0)),
        )
        joints = (
            Joint(axis.name, frame, (x, y * axis.direction, z * axis.direction))
            for axis, (frame, (x, y, z)) in zip(self.axes, frames, strict=True)
        )
        return Chain(tuple(joints), self.tflwp)

    @property
    def is_wrist_central(self) -> bool:
        """Whether the wrist axes meet in one point at right angles, axis 4 along the forearm."""
        links = self.dh_4, self.dh_5
        if any(abs(link.a) > _TOLERANCE or abs(link.d) > _TOLERANCE for link in links):
            return False
        twist = abs(abs(self.dh_4.alpha) - 90.0), abs(self.dh_4.alpha + self.dh_5.alpha)
        return max(twist) < _ANGLE and abs(abs(self.tx3p3.rows[0][2]) - 1.0) < _TOLERANCE

    @property
    def elbow(self) -> float:
        """The angle of A3 in degrees at which the arm is stretched, where bit 1 of S changes.

        It is 0 if A3 and A4 intersect; an offset between them shifts it [POS-04]. The two elbow
        positions that reach a point lie on either side of it, as POS-12 requires.
        """
        forward, _, up = self.tx3p3.position
        return self.axes[2].direction * math.degrees(math.atan2(up, forward))
