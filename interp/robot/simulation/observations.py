"""Observations of an arm in addition to its trace: contacts, and excessive torques.

Observations have no effect: a program has the same trace with and without them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, Protocol, TypedDict

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import MachineData

_MOST = 1000  # observations of one kind

Times = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Observation:
    """A contact or an excessive torque that lasted from ``start`` to ``end``, in µs.

    ``parts`` are the two parts that touch, in alphabetical order, or the axis. ``value`` is the
    largest torque, and ``limit`` what the axis can bear, in Nm (N for linear axes). ``at`` is the
    line of the motion in which it began, as ``file:line``; empty before the first motion. An
    estimate depends on assumed masses.
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
        """Return the observation as plain data."""
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
    """An observation as JSON, with times in µs; see `Observation` for the fields."""

    t: int
    end: int
    kind: str
    at: str
    parts: list[str]
    value: float
    limit: float
    estimate: bool


class Observer(Protocol):
    """Observes the set-points of an arm."""

    def observe(self, times: Times, axes: Array) -> None:
        """Observe axes (n, axes) at times one interpolation cycle apart."""
        ...

    def observations(self) -> tuple[Observation, ...]:
        """Return all observations so far, in the order in which they began."""
        ...


class Periods:
    """Merges consecutive moments at which something holds into periods."""

    def __init__(self, kind: Literal["collision", "torque"], is_estimate: bool = False) -> None:
        self._kind = kind
        self._is_estimate = is_estimate
        self._open: dict[tuple[str, ...], Observation] = {}
        self._closed: list[Observation] = []

    def at(self, time: int, found: Iterable[tuple[tuple[str, ...], float, float]]) -> None:
        """Add what holds at a time, as (parts, value, limit); times must not decrease."""
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
        """Return all periods, including those that have not ended."""
        every = sorted(
            [*self._closed, *self._open.values()], key=lambda one: (one.start, one.parts)
        )
        return tuple(every[:_MOST])


class TorqueCheck:
    """Compares torques with those that the axes of a machine can bear."""

    def __init__(self, machine: MachineData) -> None:
        self._names = [axis.name for axis in machine.axes]
        self._limits = np.array(machine.torques or (np.inf,) * len(self._names))
        self._periods = Periods("torque", is_estimate=machine.own_chain is None)

    def check(self, times: Times, torques: Array) -> None:
        """Check torques (n, axes) in Nm."""
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
