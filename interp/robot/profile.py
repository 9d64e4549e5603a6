"""How a stretch of path is travelled: position, speed and acceleration over time.

A profile has one degree of freedom and bounded jerk. Ruckig finds it; here it becomes a row of
cubics that can be evaluated at many times at once. Positions are in whatever unit the caller has,
times in seconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import ruckig  # type: ignore[import-not-found]

from interp.robot.kinematics import Array

__all__ = ["Bounds", "Profile", "Ramp", "ramp", "standing", "stop", "travel"]

_SLACK = 1e-7
"""Share of a length within which speeding up or braking all the way is what fills it."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """The most that a profile may have: speed, acceleration, jerk."""

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Cubics one after the other: ``times`` has their starts and the end of the last.

    ``positions``, ``speeds``, ``accelerations`` and ``jerks`` are those at the starts.
    """

    times: Array
    positions: Array
    speeds: Array
    accelerations: Array
    jerks: Array

    @property
    def duration(self) -> float:
        """Seconds from start to end."""
        return float(self.times[-1])

    def at(self, times: Array) -> tuple[Array, Array, Array]:
        """Position, speed and acceleration; before the start and behind the end as there."""
        clipped = np.clip(times, 0.0, self.times[-1])
        place = np.clip(
            np.searchsorted(self.times, clipped, side="right") - 1, 0, len(self.jerks) - 1
        )
        dt = clipped - self.times[place]
        jerk, acceleration = self.jerks[place], self.accelerations[place]
        speed = self.speeds[place]
        return (
            self.positions[place] + dt * (speed + dt * (acceleration / 2 + dt * jerk / 6)),
            speed + dt * (acceleration + dt * jerk / 2),
            acceleration + dt * jerk,
        )

    def time_at(self, position: float) -> float:
        """When a position is reached first; the nearest end where it never is."""
        ends, _, _ = self.at(self.times)
        if position <= ends[0]:
            return 0.0
        beyond = np.nonzero(ends >= position)[0]
        if not len(beyond):
            return self.duration
        last = int(beyond[0])
        low, high = float(self.times[last - 1]), float(self.times[last])
        place = last - 1
        start, speed = float(self.positions[place]), float(self.speeds[place])
        acceleration, jerk = float(self.accelerations[place]), float(self.jerks[place])
        origin = low
        for _ in range(60):
            middle = (low + high) / 2
            dt = middle - origin
            if start + dt * (speed + dt * (acceleration / 2 + dt * jerk / 6)) < position:
                low = middle
            else:
                high = middle
        return high


@dataclass(frozen=True, slots=True)
class Ramp:
    """The quickest change of speed, with the acceleration at zero in the end."""

    duration: float
    distance: float


def ramp(speed: float, acceleration: float, target: float, bounds: Bounds) -> Ramp:
    """The change from a speed and acceleration to a target speed.

    The acceleration has to be within its bound.
    """
    jerk, most = bounds.jerk, bounds.acceleration
    eased = speed + acceleration * abs(acceleration) / (2 * jerk)
    sign = 1.0 if target >= eased else -1.0
    start = sign * acceleration  # as if speeding up
    change = sign * (target - speed)
    peak = math.sqrt(max(jerk * change + start * start / 2, 0.0))
    hold = 0.0
    if peak > most:
        hold = (change - (2 * most * most - start * start) / (2 * jerk)) / most
        peak = most
    rise, fall = max(peak - start, 0.0) / jerk, peak / jerk
    # Distances in the mirrored frame, from the speed at the start of each phase.
    first = sign * speed
    second = first + rise * (start + peak) / 2
    third = second + hold * peak
    travelled = (
        rise * (first + rise * (start / 2 + rise * jerk / 6))
        + hold * (second + hold * peak / 2)
        + fall * (third + fall * (peak / 2 - fall * jerk / 6))
    )
    return Ramp(rise + hold + fall, sign * travelled)


def travel(
    length: float, speed: float, acceleration: float, target: float, bounds: Bounds
) -> Profile:
    """The quickest way over a length, from a speed and acceleration to a target speed.

    The acceleration is zero in the end. The caller has seen by `ramp` that it can be done; where
    the length is just what the change of speed takes, that change is all there is.
    """
    direct = ramp(speed, acceleration, target, bounds)
    if direct.distance >= length * (1.0 - _SLACK) and target <= bounds.velocity:
        return _stretched(_change(speed, acceleration, target, bounds), length)
    asked = _asked(speed, acceleration, target, bounds)
    asked.target_position = [length]
    asked.max_velocity = [max(bounds.velocity, target)]
    found = _solved(asked)
    if found is None or float(found.speeds.min()) < -1e-6 * bounds.velocity - 1e-9:
        return _stretched(_change(speed, acceleration, target, bounds), length)
    return found


def stop(speed: float, acceleration: float, bounds: Bounds) -> Profile:
    """The quickest way to stand still, however far that is."""
    return _change(speed, acceleration, 0.0, bounds)


def standing(duration: float) -> Profile:
    """No motion at all."""
    zero = np.zeros(1)
    return Profile(np.array([0.0, duration]), zero, zero, zero, zero)


# --------------------------------------------------------------------------------------- ruckig


def _asked(
    speed: float, acceleration: float, target: float, bounds: Bounds
) -> ruckig.InputParameter:
    asked = ruckig.InputParameter(1)
    asked.current_position = [0.0]
    asked.current_velocity = [speed]
    asked.current_acceleration = [acceleration]
    asked.target_velocity = [target]
    asked.target_acceleration = [0.0]
    asked.max_acceleration = [bounds.acceleration]
    asked.max_jerk = [bounds.jerk]
    return asked


def _change(speed: float, acceleration: float, target: float, bounds: Bounds) -> Profile:
    """The quickest change of speed as a profile."""
    asked = _asked(speed, acceleration, target, bounds)
    asked.control_interface = ruckig.ControlInterface.Velocity
    found = _solved(asked)
    if found is None:
        raise ArithmeticError(f"no profile from {speed} ({acceleration}) to {target} in {bounds}")
    return found


def _solved(asked: ruckig.InputParameter) -> Profile | None:
    trajectory = ruckig.Trajectory(1)
    try:
        result = ruckig.Ruckig(1).calculate(asked, trajectory)
    except ruckig.RuckigError:
        return None
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        return None
    solved = trajectory.profiles[0][0]
    pieces = [
        *zip(solved.brake.t, solved.brake.j, solved.brake.a, strict=True),
        *zip(solved.t, solved.j, solved.a[:-1], strict=True),
    ]
    return _integrated(
        asked.current_velocity[0],
        [(t, jerk, acceleration) for t, jerk, acceleration in pieces if t > 0.0],
    )


def _integrated(speed: float, pieces: list[tuple[float, float, float]]) -> Profile:
    """A profile of durations, jerks, and accelerations at their starts."""
    if not pieces:
        return standing(0.0)
    times, positions, speeds = [0.0], [0.0], [speed]
    for duration, jerk, acceleration in pieces:
        before = speeds[-1]
        times.append(times[-1] + duration)
        positions.append(
            positions[-1]
            + duration * (before + duration * (acceleration / 2 + duration * jerk / 6))
        )
        speeds.append(before + duration * (acceleration + duration * jerk / 2))
    return Profile(
        np.array(times),
        np.array(positions[:-1]),
        np.array(speeds[:-1]),
        np.array([acceleration for _, _, acceleration in pieces]),
        np.array([jerk for _, jerk, _ in pieces]),
    )


def _stretched(profile: Profile, length: float) -> Profile:
    """The same with its end at a length that differs in rounding only."""
    (reached,), _, _ = profile.at(profile.times[-1:])
    if reached <= 0.0:
        return profile
    share = length / float(reached)
    return Profile(
        profile.times,
        profile.positions * share,
        profile.speeds * share,
        profile.accelerations * share,
        profile.jerks * share,
    )
