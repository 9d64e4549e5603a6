"""The arm of a project, a stand-in if its machine data is missing, and stand-ins for points.

The points of a large robot may be out of reach of a small one. The stand-in is the default arm if
its stretched length, measured from the shoulder, covers the points of the project. Otherwise all
links are scaled by one factor, so that the points can be reached with any orientation. Nothing else
is known of the arm: its dynamics are those of the default arm, and its axis limits are assumed.

Points after a $BASE that a program writes out are relative to it. If the bases are lost too, points
may lie inside the arm or behind it. Then the foot of the arm is moved to where the arm reaches most
points in one posture, standing or hanging, from any side.

A point that no file contains gets a reachable position, derived from its name. All such positions
are near one posture, so that a straight line leads from each to every other.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import product
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Final

from grammar.syntax.source import Source
from interp.robot.kinematics.data_list import DataListError, located
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import (
    ROBOT_AXES,
    MachineData,
    MachineDataError,
    WristLink,
)
from interp.robot.kinematics.machine_reader import read_machine, with_axis_limits_of
from interp.robot.models import default_machine
from interp.values.poses import IDENTITY, Pose

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Array, Kinematics

_NUMBER: Final = r"\s*([-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:E[-+]?\d+)?)\b"
_POSE: Final = re.compile(rf"\{{[^{{}}]*?\bX{_NUMBER}\s*,\s*Y{_NUMBER}\s*,\s*Z{_NUMBER}", re.I)
_WHOLE: Final = re.compile(
    rf"{_POSE.pattern}\s*,\s*A{_NUMBER}\s*,\s*B{_NUMBER}\s*,\s*C{_NUMBER}", re.I
)
#: An assignment to $BASE, of a frame as an aggregate or of anything else.
_BASE: Final = re.compile(rf"\$BASE\s*=\s*(?:{_WHOLE.pattern})?", re.I)
NO_MACHINE: Final = "no machine data of an arm"
#: With fewer points, the foot of the arm is not moved: they may be anything.
_FEWEST: Final = 3
#: The fraction of the points that must be reached: a few may be garbage.
_SHARE: Final = 0.95
#: The fraction of its stretched length at which an arm reaches a point with any orientation.
_USABLE: Final = 0.8
_LARGEST: Final = 5.0
#: Distance from axis 1, as a fraction of the arm's length, that the arm itself occupies below its
#: shoulder.
_OWN: Final = 0.2
#: An arm is not moved if it reaches this fraction of the points.
_REACHED: Final = 0.75
#: Candidates for the middle of the points relative to the foot (ahead and up, as fractions of the
#: arm's length), and for A and C of the foot in degrees. The first are preferred.
_AHEAD: Final = tuple(product((0.75, 0.6), (0.4, 0.7, 0.1)))
_FEET: Final = tuple(product((0.0, 90.0, -90.0, 180.0), (0.0, 180.0)))
#: mm and degrees from which on a number in a point counts as garbage.
_GARBAGE: Final = 1e6
#: The largest number of points that are used to place an arm.
_MOST_POINTS: Final = 64
#: The posture near which positions lie, in degrees, and their largest distance from it: the forearm
#: is level, the hand half down.
_POSTURE: Final = (0.0, -90.0, 95.0, 0.0, 50.0, 0.0)
_SPREAD: Final = (35.0, 12.0, 12.0, 0.0, 15.0, 20.0)
_DECIMALS: Final = 3


def machine_data_of(sources: Iterable[Source]) -> Source | None:
    """Return the machine data of an arm among the files of a project, ``None`` if there is none.

    The dollar sign in its name may be missing, because some tools that copy files drop it. Of
    several, the one in Mada counts. A file without $LENGTH_A is taken only where no other has it,
    and not from STEU, whose file is not about the arm.
    """
    named = [
        one for one in sources if one.kind == "dat" and one.name.upper().lstrip("$") == "MACHINE"
    ]
    named.sort(key=lambda one: PurePosixPath(one.path.upper()).parent.name != "MADA")
    whole = [one for one in named if "$LENGTH_A" in one.text.upper()]
    others = [one for one in named if "STEU" not in PurePosixPath(one.path.upper()).parts]
    return next(iter(whole + others), None)


def understood(source: Source) -> MachineData:
    """Return the arm of machine data; raise `MachineDataError` if it cannot be solved."""
    machine = read_machine(source.text, source.path)
    try:
        kinematics_of(machine)
    except MachineDataError as error:
        raise MachineDataError(located(str(error), source.text, source.path)) from error
    return machine


def arm_or_stand_in(
    sources: Sequence[Source], default: MachineData, used: Iterable[Source] = ()
) -> tuple[MachineData, str]:
    """Return the arm of a project, or a stand-in with the reason.

    ``sources`` are the project's own files, and ``default`` the arm if they have no machine data.
    The points in files that are ``used`` by the program must be reached too, counted separately.
    """
    source = machine_data_of(sources)
    if source is None:
        machine = fitting_arm(default, (one.text for one in sources), (one.text for one in used))
        return machine, f"{NO_MACHINE}: {machine.name} is used instead"
    try:
        return understood(source), ""
    except (DataListError, MachineDataError) as error:
        machine = default_machine()
        note = f"{error}: {machine.name} is used instead"
        return with_axis_limits_of(machine, source.text, source.path), note


class Places:
    """Stand-ins for missing points: positions that the arm of a project reaches, by name."""

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = sources

    @cached_property
    def _arm(self) -> Kinematics:
        return kinematics_of(arm_or_stand_in(self._sources, default_machine())[0])

    def axes(self, name: str) -> tuple[float, ...]:
        """Return the six axes in degrees; names that differ only in case have the same axes."""
        digest = hashlib.sha256(name.upper().encode()).digest()
        wanted = []
        for place, axis in enumerate(self._arm.machine.axes):
            drawn = int.from_bytes(digest[4 * place : 4 * place + 4]) / 2**31 - 1.0
            value = _POSTURE[place] + _SPREAD[place] * drawn
            wanted.append(min(max(value, axis.lower), axis.upper))
        coupled = self._arm.coupled(wanted)
        return tuple(round(float(value), _DECIMALS) for value in coupled)

    def pose(self, name: str) -> tuple[float, ...]:
        """Return X, Y, Z in mm and A, B, C in degrees of the flange in $WORLD, at those axes."""
        machine = self._arm.machine
        flange = Pose.from_matrix(self._arm.forward(self.axes(name)).tolist())
        foot = machine.foot(machine.standing(self.axes(name))[ROBOT_AXES:])
        return tuple(round(value, _DECIMALS) for value in (foot @ flange).components)


def fitting_arm(
    machine: MachineData, every: Iterable[str], used: Iterable[str] = ()
) -> MachineData:
    """Return the machine if it reaches the points in some texts, else a larger one.

    Points are aggregates of numbers with X, Y, Z in mm. The points in texts that are ``used`` are
    reached, no matter how many other points are nearer.
    """
    factor = max(_factor(machine, texts) for texts in (every, used))
    return machine if factor == 1.0 else _scaled(machine, factor)


def with_assumed_limits(machine: MachineData) -> MachineData:
    """Return a machine whose axis limits reject no motion."""
    return replace(machine, axes=tuple(replace(axis, assumed=True) for axis in machine.axes))


def reaching(machine: MachineData, texts: Iterable[str]) -> MachineData:
    """Return the machine, moved to where it reaches the points in some texts if it does not.

    Points are aggregates of numbers with X, Y, Z in mm and A, B, C in degrees.
    """
    every = [  # an aggregate without a position is a base, an offset, or garbage
        base @ Pose.of(*numbers)
        for text in texts
        for base, part in _stretches(text)
        for numbers in (_numbers(one) for one in _WHOLE.finditer(part))
        if any(numbers[:3]) and all(abs(value) < _GARBAGE for value in numbers)
    ]
    some = every[:: len(every) // _MOST_POINTS + 1]
    if len(some) < _FEWEST:
        return machine
    import numpy as np  # only where an arm stands in for one that is lost

    poses = np.array([one.matrix for one in some])
    arm, length = kinematics_of(machine), _length(machine)
    lower, upper = (
        np.array([getattr(axis, end) for axis in machine.axes]) for end in ("lower", "upper")
    )

    def statuses(foot: Pose) -> Array:
        """Return the Status of each solution within the limits, else -1: (points, solutions).

        Points inside the arm itself have none.
        """
        flanges = np.array(foot.inverse().matrix) @ poses
        x, y, z = np.moveaxis(flanges[:, :3, 3], -1, 0)
        is_free = (np.hypot(x, y) > _OWN * length) | (z > machine.tiroro.position[2])
        ways = arm.inverse(flanges)
        inside = ((ways >= lower) & (ways <= upper)).all(axis=-1) & is_free[:, np.newaxis]
        return np.where(inside, arm.status(np.nan_to_num(ways)), -1)

    def reached(foot: Pose) -> int:
        """Return how many points can be reached with the Status that reaches most."""
        found = statuses(foot)
        return max(int((found == one).any(axis=-1).sum()) for one in range(8))

    if np.mean((statuses(IDENTITY) >= 0).any(axis=-1)) >= _REACHED:
        return machine
    middle = Pose.of(*np.median(poses[:, :3, 3], axis=0).tolist())
    feet = [
        middle @ Pose.of(a=a, c=c) @ Pose.of(x=-ahead * length, z=-up * length)
        for (ahead, up), (a, c) in product(_AHEAD, _FEET)
    ]
    best = max(feet, key=reached)
    if reached(best) <= reached(IDENTITY):
        return machine
    rounded = Pose.of(*(round(value) for value in best.components))
    where = ",".join(
        f"{name} {value:g}" for name, value in zip("XYZABC", rounded.components, strict=True)
    )
    return replace(machine, name=f"{machine.name} at {{{where}}}", robroot=rounded)


def _numbers(match: re.Match[str]) -> tuple[float, ...]:
    return tuple(map(float, match.groups()))


def _placed(base: Pose, point: tuple[float, ...]) -> Sequence[float]:
    """Return X, Y, Z of a point given in a base; garbage is returned as it is."""
    return (base @ Pose.of(*point)).position if max(map(abs, point)) < _GARBAGE else point


def _stretches(text: str) -> Iterator[tuple[Pose, str]]:
    """Yield the sections of a text, each with the base that an assignment before it has set.

    Offline programming systems write programs in this form: $BASE={X 800,...}, then points.
    """
    base, start = IDENTITY, 0
    for match in _BASE.finditer(text):
        yield base, text[start : match.start()]
        is_frame = match[1] is not None and all(abs(one) < _GARBAGE for one in _numbers(match))
        base, start = Pose.of(*_numbers(match)) if is_frame else IDENTITY, match.end()
    yield base, text[start:]


def _length(machine: MachineData) -> float:
    """Return the distance from the shoulder to the wrist of the stretched arm in mm."""
    forearm = math.hypot(*(row[3] for row in machine.tx3p3.rows))
    return machine.length_a + machine.length_b + forearm


def _factor(machine: MachineData, texts: Iterable[str]) -> float:
    """Return the factor by which the links must be longer to reach points, in steps of 0.1."""
    distances = [  # from the shoulder, in mm
        math.dist(_placed(base, _numbers(one)), machine.tiroro.position)
        for text in texts
        for base, part in _stretches(text)
        for one in _POSE.finditer(part)
    ]
    if not distances:
        return 1.0
    far = sorted(distances)[math.ceil(_SHARE * len(distances)) - 1]
    reach = _length(machine)
    if far <= reach:
        return 1.0
    return math.ceil(min(10 * far / (_USABLE * reach), 10 * _LARGEST)) / 10


def _scaled(machine: MachineData, factor: float) -> MachineData:
    def frame(pose: Pose) -> Pose:
        first, second, third = ((*row[:3], factor * row[3]) for row in pose.rows)
        return Pose((first, second, third))

    def link(one: WristLink) -> WristLink:
        return replace(one, a=factor * one.a, d=factor * one.d)

    return replace(
        machine,
        name=f"{machine.name} x {factor:g}",
        tiroro=frame(machine.tiroro),
        length_a=factor * machine.length_a,
        length_b=factor * machine.length_b,
        tx3p3=frame(machine.tx3p3),
        dh_4=link(machine.dh_4),
        dh_5=link(machine.dh_5),
        tflwp=frame(machine.tflwp),
    )
