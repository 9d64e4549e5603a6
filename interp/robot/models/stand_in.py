"""The arm that stands in for one whose machine data is missing, as large as the taught points ask.

Points of a large robot lie out of reach of a small one. The stand-in is the default arm as long as
its outstretched length covers the points of the project, measured from its shoulder. Where it does
not, its links are longer by one factor, so that they do with any orientation. Its axis limits are
wide enough for the taught axis positions. Nothing else is known of the arm; its dynamics are those
of the default.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from interp.robot.kinematics.machine_data import MachineData, WristLink
from interp.values.poses import Pose

__all__ = ["fitting_arm"]

_NUMBER: Final = r"\s*([-+]?\d*\.?\d+(?:E[-+]?\d+)?)\b"
_POSE: Final = re.compile(rf"\{{[^{{}}]*?\bX{_NUMBER}\s*,\s*Y{_NUMBER}\s*,\s*Z{_NUMBER}", re.I)
_AXIS: Final = re.compile(rf"[{{,]\s*A([1-6]){_NUMBER}", re.I)
#: Points fewer than these may be anything: the arm stays what it is.
_FEWEST: Final = 3
#: The share of the points that is to be reached: a few may be garbage.
_SHARE: Final = 0.95
#: How much of its outstretched length an arm uses to reach a point with any orientation.
_USABLE: Final = 0.8
_LARGEST: Final = 5.0
_MOST_DEGREES: Final = 360.0


def fitting_arm(
    machine: MachineData, programs: Iterable[str], data_lists: Iterable[str]
) -> MachineData:
    """The machine itself where it reaches the points in some texts, else a larger one.

    Points are aggregates of numbers with X, Y, Z in mm; only those in data lists, which were
    taught, tell of the limits of axes too, as A1 to A6 in degrees.
    """
    distances: list[float] = []  # from the shoulder, in mm
    lower = [axis.lower for axis in machine.axes]
    upper = [axis.upper for axis in machine.axes]
    lists = list(data_lists)
    for text in (*programs, *lists):
        distances += (
            math.dist(map(float, one.groups()), machine.tiroro.position)
            for one in _POSE.finditer(text)
        )
    for text in lists:
        for found in _AXIS.finditer(text):
            number, value = int(found[1]) - 1, float(found[2])
            if abs(value) <= _MOST_DEGREES:
                lower[number] = min(lower[number], value)
                upper[number] = max(upper[number], value)
    axes = tuple(
        replace(axis, lower=low, upper=high)
        for axis, low, high in zip(machine.axes, lower, upper, strict=True)
    )
    if axes != machine.axes:
        machine = replace(machine, axes=axes)
    factor = _factor(machine, distances)
    return machine if factor == 1.0 else _scaled(machine, factor)


def _factor(machine: MachineData, distances: list[float]) -> float:
    """How much longer its links have to be, in steps of a tenth."""
    if len(distances) < _FEWEST:
        return 1.0
    far = sorted(distances)[math.ceil(_SHARE * len(distances)) - 1]
    forearm = math.hypot(*(row[3] for row in machine.tx3p3.rows))
    reach = machine.length_a + machine.length_b + forearm
    if far <= reach:
        return 1.0
    return min(math.ceil(10 * far / (_USABLE * reach)) / 10, _LARGEST)


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
