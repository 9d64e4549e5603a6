"""Closed-form kinematics of a six-axis arm with a central (spherical) wrist.

Inverse kinematics separates position and orientation (Pieper): the wrist centre determines the main
axes by the law of cosines, and the remaining rotation determines the wrist axes as Euler angles.

Inside this module, the *upright arm* is the same arm with the senses and zero positions of its axes
removed. Arrays are those of `interp.robot.kinematics.kinematics`.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of, nearest_turns, wrapped
from interp.robot.kinematics.machine_data import MachineData, MachineDataError

_SHOULDER = np.array([1.0, 1.0, -1.0, -1.0])  # wrist centre in front of axis 1, or behind it
_ELBOW = np.array([-1.0, 1.0, -1.0, 1.0])  # sign of the bend
#: Sine of A5 below which axes 4 and 6 are collinear.
_STRAIGHT = 1e-12
#: Sine of A5 below which A4 is free and stays where it is: 1e-7 degrees.
_UNDETERMINED = 2e-9
#: mm of reach that may be lost by rounding.
_MARGIN = 1e-7
#: mm from axis 1 within which a point counts as on it; a REAL resolves 1e-4 mm at 1 m.
_OVERHEAD = 1e-3
#: mm beyond which a pose counts as unreachable, like one that is NaN.
_FAR = 1e9


class CentralWrist(Kinematics):
    """The kinematics of one machine.

    Raises `MachineDataError` for a wrist that is not central, and for impossible lengths.
    """

    has_wrist_singularity = True

    def __init__(self, machine: MachineData) -> None:
        if not machine.is_wrist_central:
            raise MachineDataError("the wrist is not central, with axis 4 along the forearm")
        super().__init__(machine)
        self.elbow = machine.elbow
        self._to_inner = matrix_of(machine.tiroro.inverse())
        self._to_wrist = matrix_of(machine.tflwp.inverse())
        directions = np.array([axis.direction for axis in machine.axes], dtype=np.float64)
        self._angles = np.radians(directions)  # radians about Z for a degree
        self._forearm = np.array(machine.tx3p3.position)
        self._check_lengths()
        along, turned = self._forearm_axis()
        sense = math.copysign(1.0, machine.dh_4.alpha)
        #: Degrees for a radian of the upright arm.
        self._senses = np.degrees([1.0, 1.0, 1.0, along, -sense, along]) * directions
        self._zeros = np.array([0.0, math.pi / 2, 0.0, along * turned, 0.0, 0.0])
        self._reverse = np.diag([along, 1.0, along])

    def inverse(self, poses: npt.ArrayLike) -> Array:
        """Return all solutions for poses ``(..., 4, 4)`` as axes ``(..., 8, 6)``; NaN if none.

        Angles are in (-180, 180] degrees, whatever the software limits. The first four solutions
        differ in shoulder and elbow; the other four have the wrist flipped. If the wrist is
        straight, A4 is 0.
        """
        given = np.asarray(poses, dtype=np.float64)
        is_sound = (np.abs(given) < _FAR).all(axis=(-2, -1), keepdims=True)
        inner = self._to_inner @ np.where(is_sound, given, math.nan) @ self._to_wrist
        inner[np.hypot(inner[..., 0, 3], inner[..., 1, 3]) < _OVERHEAD, :2, 3] = 0.0
        inner = inner[..., None, :, :]
        main = self._main_axes(inner[..., :3, 3], _SHOULDER, _ELBOW)
        wrist = self._wrist_of(main, inner)
        sine = np.hypot(wrist[..., 0, 2], wrist[..., 1, 2])
        is_straight = sine < _STRAIGHT
        sine[is_straight] = 0.0
        solutions = []
        for sign in (1.0, -1.0):
            a4 = np.arctan2(sign * wrist[..., 1, 2], sign * wrist[..., 0, 2])
            a5 = sign * np.arctan2(sine, wrist[..., 2, 2])
            a4 = np.where(is_straight, self._zeros[3], a4)
            solutions.append(self._degrees(main, a4, a5, wrist))
        return wrapped(np.concatenate(solutions, axis=-2))

    def inverse_near(self, poses: Array, references: Array) -> Array:
        """Return the solution with the configuration of a reference: axes ``(n, 6)``, NaN if none.

        ``poses`` are ``(n, 4, 4)``. ``references`` ``(n, 6)`` are axes near the solution: they
        determine shoulder, elbow, and the full turns of each axis. The wrist is flipped if that is
        nearer; if it is straight, A4 is that of the reference.
        """
        main, wrist = self._main_and_wrist(poses, references * self._angles)
        own = references[:, 3] / self._senses[3] + self._zeros[3]
        bent = references[:, 4] / self._senses[4]
        sine = np.hypot(wrist[:, 0, 2], wrist[:, 1, 2])
        a4 = np.arctan2(wrist[:, 1, 2], wrist[:, 0, 2])
        a5 = np.arctan2(sine, wrist[:, 2, 2])
        there = np.abs(np.sin((a4 - own) / 2.0)) + np.abs(a5 - bent)
        over = np.abs(np.cos((a4 - own) / 2.0)) + np.abs(a5 + bent)
        is_flipped = over < there
        sign = np.where(is_flipped, -1.0, 1.0)
        a4 = np.where(is_flipped, a4 + math.pi, a4)
        a4 = np.where(sine < _UNDETERMINED, own, a4)
        found = self._degrees(main, a4, sign * a5, wrist)
        return nearest_turns(found, references)

    def _main_and_wrist(self, poses: Array, theta: Array) -> tuple[Array, Array]:
        """Return the main axes of the upright arm, and the rotation that remains for its wrist."""
        inner = self._to_inner @ poses @ self._to_wrist
        forward, _, up = self._forearm
        bend = np.sin(math.atan2(up, forward) - theta[:, 2])
        main = self._main_axes(inner[:, :3, 3], self._ahead(theta), bend)
        return main, self._wrist_of(main, inner)

    def _wrist_of(self, main: Array, inner: Array) -> Array:
        """Return the rotation that main axes leave for the wrist, for poses relative to $TIRORO."""
        upper = _about_z(main[..., 0]) @ _about_y(main[..., 1] + main[..., 2])
        wrist: Array = np.swapaxes(upper, -1, -2) @ inner[..., :3, :3] @ self._reverse
        return wrist

    def _degrees(self, main: Array, a4: Array, a5: Array, wrist: Array) -> Array:
        """Return axes in degrees; A6 completes the rotation of the wrist after A4 and A5."""
        s4, c4 = np.sin(a4), np.cos(a4)
        a6 = np.arctan2(
            c4 * wrist[..., 1, 0] - s4 * wrist[..., 0, 0],
            c4 * wrist[..., 1, 1] - s4 * wrist[..., 0, 1],
        )
        angles = np.concatenate((main, np.stack((a4, a5, a6), axis=-1)), axis=-1)
        degrees: Array = (angles - self._zeros) * self._senses
        return degrees

    def _main_axes(self, places: Array, shoulder: Array, elbow: Array) -> Array:
        """Return the main axes of the upright arm in radians, ``(..., 3)``, for wrist centres.

        ``shoulder`` and ``elbow`` have the signs of the solutions. NaN if out of reach.
        """
        forward, aside, up = self._forearm
        upper, lower = self.machine.length_b, math.hypot(forward, up)
        x, y, height = np.moveaxis(places, -1, 0)
        beyond = x**2 + y**2 - aside**2
        beyond = np.where((beyond < 0.0) & (beyond > -_MARGIN), 0.0, beyond)
        with np.errstate(invalid="ignore"):
            ahead = np.copysign(np.sqrt(beyond), shoulder)
            a1 = np.arctan2(y, x) - np.arctan2(aside, ahead)
            out = ahead - self.machine.length_a
            distance = np.hypot(out, height)
            within = np.clip(distance, abs(upper - lower), upper + lower)
            within = np.where(np.abs(within - distance) < _MARGIN, within, math.nan)
            sides = (upper + lower) ** 2 - within**2, within**2 - (upper - lower) ** 2
            bent = np.copysign(2.0 * np.arctan2(*np.sqrt(sides)), elbow)  # the law of cosines
        a2 = np.arctan2(lower * np.sin(bent), upper + lower * np.cos(bent))
        a3 = math.atan2(up, forward) - bent
        main: Array = np.stack((a1, a2 - np.arctan2(height, out), a3), axis=-1) + self._zeros[:3]
        main[np.isnan(a3)] = math.nan
        return main

    # ------------------------------------------------------------------------------- the geometry

    def _wrist(self, axes: Array) -> tuple[Array, Array]:
        return self._ahead(axes * self._angles), self._forearm[1]

    def _ahead(self, theta: Array) -> Array:
        """Return how far the wrist centre is in front of axis 1, in mm, along the turned X axis."""
        lean, both = theta[..., 1], theta[..., 1] + theta[..., 2]
        forward, _, up = self._forearm
        ahead: Array = (
            self.machine.length_a
            + self.machine.length_b * np.cos(lean)
            + forward * np.cos(both)
            + up * np.sin(both)
        )
        return ahead

    def _check_lengths(self) -> None:
        machine = self.machine
        if machine.length_b < _MARGIN:
            raise MachineDataError(f"$LENGTH_B is {machine.length_b:g}: the arm has no upper arm")
        if math.hypot(self._forearm[0], self._forearm[2]) < _MARGIN:
            raise MachineDataError("X and Z of $TX3P3 are 0: the arm has no forearm")

    def _forearm_axis(self) -> tuple[float, float]:
        """Return the sense of axis 4 and the zero position of the wrist.

        The sense is 1 if axis 4 points along the forearm, -1 if against it. The zero position is
        the angle of the first wrist axis about axis 4 in radians.
        """
        ahead, aside, up = self.machine.tx3p3.rows
        along = math.copysign(1.0, ahead[2])
        return along, math.atan2(aside[0], -along * up[0])


def _about_y(radians: Array) -> Array:
    turn = np.zeros((*radians.shape, 3, 3))
    turn[..., 0, 0] = turn[..., 2, 2] = np.cos(radians)
    turn[..., 0, 2] = np.sin(radians)
    turn[..., 2, 0] = -turn[..., 0, 2]
    turn[..., 1, 1] = 1.0
    return turn


def _about_z(radians: Array) -> Array:
    turn = np.zeros((*radians.shape, 3, 3))
    turn[..., 0, 0] = turn[..., 1, 1] = np.cos(radians)
    turn[..., 1, 0] = np.sin(radians)
    turn[..., 0, 1] = -turn[..., 1, 0]
    turn[..., 2, 2] = 1.0
    return turn
