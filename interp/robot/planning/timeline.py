"""The timeline of the arm: sections of path, and the legs in which they are travelled."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
import numpy.typing as npt

from interp.robot.arm import Samples
from interp.robot.kinematics.kinematics import Array
from interp.robot.path.axis_path import Curve
from interp.robot.path.speed_profile import SpeedProfile
from interp.robot.path.tool_path import tool_tangents
from interp.robot.planning.junctions import SAME_CURVE, STOP, JoinedStretch, Junction, PathState
from interp.robot.planning.limits import CurveLimits, Stretch

MICROSECOND = 1e-6
#: The parameter of a blend at which the first motion ends and the second begins [TRG-02].
APEX = 0.5
#: The number of a motion, whether it is the blend behind it, and the part of a spline block.
Key = tuple[int, bool, int]

_NOTHING = 1e-9  # of u


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """A part of the path: of one motion, or the blend between two.

    ``number`` is the number of the motion, or of the first motion of a blend; ``following`` is the
    second motion of a blend, otherwise ``None``. ``start`` and ``end`` are the parameters of the
    curve between which it is travelled, ``junction`` connects it to the previous section.
    ``is_still`` marks a motion of length zero, which takes no time. The segments of a spline block
    have a ``part`` from 0 on.
    """

    number: int
    following: int | None
    curve: Curve
    limits: CurveLimits
    start: float = 0.0
    end: float = 1.0
    junction: Junction = STOP
    is_still: bool = False
    part: int = 0

    @property
    def key(self) -> Key:
        """An identity that does not change when the section is cut; in the order of the path."""
        return self.number, self.following is not None, self.part

    @property
    def is_used_up(self) -> bool:
        """Whether the blends on either side have left nothing of a motion."""
        return self.end - self.start <= _NOTHING and not self.is_still

    def stretches(self, start: float, junction: Junction) -> list[JoinedStretch]:
        """Return the stretches from a parameter on, the first one with a junction."""
        parts = () if self.is_used_up else self.limits.between(start, self.end)
        return [
            JoinedStretch(part, SAME_CURVE if place else junction)
            for place, part in enumerate(parts)
        ]

    def motion_at(self, u: float) -> int:
        """Return the number of the motion that is on at a parameter."""
        return self.number if self.following is None or u < APEX else self.following


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """A section that is travelled from ``begins`` on, in seconds; it is cut off at ``ends``.

    Positions of the profile count from ``stretch.start`` in units of ``stretch.size``.
    """

    section: Section
    stretch: Stretch
    profile: SpeedProfile
    begins: float
    ends: float

    def at(self, times: Array) -> Array:
        """Return the parameters u at times."""
        states = self.profile.at(np.minimum(times, self.ends) - self.begins)
        parameters: Array = self.stretch.start + states[0] / self.stretch.size
        return parameters

    def state(self, time: float) -> PathState:
        """Return the state at a time."""
        position, speed, acceleration = self.profile.state(min(time, self.ends) - self.begins)
        stretch = self.stretch
        u = min(stretch.start + position / stretch.size, stretch.end)
        return PathState(u, max(speed, 0.0) / stretch.size, acceleration / stretch.size)

    @property
    def last(self) -> float:
        """The parameter at which it ends."""
        return self.state(self.ends).u

    def time_at(self, u: float) -> float:
        """Return the time in seconds at which a parameter is passed."""
        passed = self.profile.time_at((u - self.stretch.start) * self.stretch.size)
        return min(self.begins + passed, self.ends)

    def tool_speed(self, time: float) -> float:
        """Return the speed of the tool at a time in mm/s; 0 from its end on."""
        if time >= self.ends:
            return 0.0
        state = self.state(time)
        tangent = tool_tangents(self.section.curve, np.array([state.u]))
        return float(np.linalg.norm(tangent)) * state.speed


class Timeline:
    """Legs in the order of time. Between legs, and before and after them, the arm stands."""

    def __init__(self, start: Array) -> None:
        self.start = start
        self.legs: list[Leg] = []
        self._begins: list[float] = []
        self._of: dict[Key, list[Leg]] = {}

    @property
    def end(self) -> float:
        """When the last leg ends, in seconds; 0 if there is none."""
        return self.legs[-1].ends if self.legs else 0.0

    def append(self, leg: Leg) -> None:
        """Append a leg."""
        self.legs.append(leg)
        self._begins.append(leg.begins)
        self._of.setdefault(leg.section.key, []).append(leg)

    def cut(self, time: float) -> list[Leg]:
        """Forget what comes after a time; returns the legs that were ahead or under way."""
        place = bisect_right(self._begins, time)
        if place and self.legs[place - 1].ends > time:
            place -= 1
        removed = self._dropped(place)
        if removed and removed[0].begins < time:
            self.append(replace(removed[0], ends=time))
        return removed

    def restore(self, legs: Sequence[Leg]) -> None:
        """Replace all legs by these."""
        self._dropped(0)
        for leg in legs:
            self.append(leg)

    def forget(self, time: float, number: float) -> None:
        """Forget the legs before the one at a time, up to the first motion with a number or more.

        A program of 20,000 motions would keep 20,000 curves otherwise.
        """
        behind = max(bisect_right(self._begins, time) - 1, 0)
        while behind > 0 and self.legs[behind - 1].section.number >= number:
            behind -= 1
        self._remove(slice(behind))

    def _dropped(self, place: int) -> list[Leg]:
        """Remove the legs from an index on, and return them."""
        removed = self.legs[place:]
        self._remove(slice(place, None))
        return removed

    def _remove(self, rows: slice) -> None:
        for leg in self.legs[rows]:
            own = self._of[leg.section.key]
            own.remove(leg)
            if not own:
                del self._of[leg.section.key]
        del self.legs[rows]
        del self._begins[rows]

    def leg_at(self, time: float) -> Leg | None:
        """Return the last leg that begins by a time, or ``None`` if the arm has not moved yet."""
        place = bisect_right(self._begins, time)
        return self.legs[place - 1] if place else None

    def after(self, leg: Leg) -> Sequence[Leg]:
        """Return the legs that begin at the end of a leg or later."""
        return self.legs[bisect_left(self._begins, leg.ends) :]

    def of(self, key: Key) -> Sequence[Leg]:
        """Return the legs of a section, in order."""
        return self._of.get(key, ())

    def axes_at(self, time: float) -> Array:
        """Return all axes at a time."""
        leg = self.leg_at(time)
        if leg is None:
            return self.start
        axes: Array
        (axes,) = leg.section.curve.axes(leg.at(np.array([time])))
        return axes

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Return the set-points at increasing times in µs."""
        seconds: Array = np.asarray(times, dtype=np.float64) * MICROSECOND
        axes = np.empty((len(times), len(self.start)))
        places = np.searchsorted(np.array(self._begins), seconds, side="right") - 1
        axes[places < 0] = self.start
        passed = np.unique(places[places >= 0]).tolist()
        for curve, group in groupby(passed, key=lambda place: self.legs[place].section.curve):
            numbers = [*group]
            parts = [self.legs[number].at(seconds[places == number]) for number in numbers]
            first, behind = np.searchsorted(places, (numbers[0], numbers[-1] + 1))
            axes[first:behind] = curve.axes(np.concatenate(parts))
        return Samples(times, axes)


def micros(seconds: float) -> int:
    """Return the whole microsecond in which an event is reported."""
    return math.ceil(seconds / MICROSECOND - 1e-3)
