"""Observations of an arm besides its trace: contacts, and excessive torques.

Observations change nothing: a program has the same trace with and without them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, Protocol, TypedDict

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.solver import Array

_MOST = 1000  # observations of one kind

Times = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Observation:
    """Something that lasted from ``start`` to ``end``, in µs.

    ``parts`` are the two that touch, in the order of the alphabet, or the axis. ``value`` is the
    greatest torque and ``limit`` what the axis bears, in Nm (N for linear axes). ``at`` is the line
    whose motion it began in, as ``file:line``; empty before the first. An estimate rests on masses
    that are assumed.
    """

    kind: Literal["collision", "torque"]
    start: int
    end: int
    parts: tuple[str, ...]
    value: float = 0.0
    limit: float = 0.0
    at: str = ""
    is_estimate: bool = False

    def __str__(self) -> str:
        when = f"{self.start / 1e6:.3f} to {self.end / 1e6:.3f} s"
        when += f", at {self.at}" if self.at else ""
        if self.kind == "collision":
            first, second = self.parts
            return f"{first} touches {second}, {when}"
        return f"{self.parts[0]} needs {self.value:.0f} Nm and bears {self.limit:.0f}, {when}"

    def record(self) -> ObservationRecord:
        """It as plain data."""
        return {
            "t": self.start,
            "end": self.end,
            "kind": self.kind,
            "at": self.at,
            "parts": list(self.parts),
            "value": round(self.value, 3),
            "limit": round(self.limit, 3),
            "estimate": self.is_estimate,
        }


class ObservationRecord(TypedDict):
    """An observation as JSON: times in µs, `Observation` names the rest."""

    t: int
    end: int
    kind: str
    at: str
    parts: list[str]
    value: float
    limit: float
    estimate: bool


class Observer(Protocol):
    """Looks at set-points as they pass."""

    def observe(self, times: Times, axes: Array) -> None:
        """Look at axes (n, axes), one interpolation cycle apart."""
        ...

    def observations(self) -> tuple[Observation, ...]:
        """All so far, in the order in which they began."""
        ...


class Periods:
    """Turns moments at which something holds into periods."""

    def __init__(self, kind: Literal["collision", "torque"], is_estimate: bool = False) -> None:
        self._kind = kind
        self._is_estimate = is_estimate
        self._open: dict[tuple[str, ...], Observation] = {}
        self._closed: list[Observation] = []

    def at(self, time: int, found: Iterable[tuple[tuple[str, ...], float, float]]) -> None:
        """What holds at a time that is not before the last one: parts, value and limit."""
        now: dict[tuple[str, ...], Observation] = {}
        for parts, value, limit in found:
            before = self._open.pop(parts, None)
            start = time if before is None else before.start
            most = value if before is None else max(value, before.value)
            now[parts] = Observation(
                self._kind, start, time, parts, most, limit, is_estimate=self._is_estimate
            )
        self._closed += self._open.values()
        self._open = now

    def observations(self) -> tuple[Observation, ...]:
        """All periods, those that still last too."""
        every = sorted(
            [*self._closed, *self._open.values()], key=lambda one: (one.start, one.parts)
        )
        return tuple(every[:_MOST])


class TorqueCheck:
    """Compares torques with what the axes of a machine bear."""

    def __init__(self, machine: MachineData) -> None:
        self._names = [axis.name for axis in machine.axes]
        self._limits = np.array(machine.torques or (np.inf,) * len(self._names))
        self._periods = Periods("torque", is_estimate=machine.own_chain is None)

    def check(self, times: Times, torques: Array) -> None:
        """Look at torques (n, axes) in Nm."""
        robot = np.abs(torques[:, : len(self._names)])
        over = robot > self._limits
        for place in range(len(times)):
            found = [
                ((self._names[axis],), float(robot[place, axis]), float(self._limits[axis]))
                for axis in np.flatnonzero(over[place]).tolist()
            ]
            self._periods.at(int(times[place]), found)

    def observations(self) -> tuple[Observation, ...]:
        """See `Observer.observations`."""
        return self._periods.observations()
