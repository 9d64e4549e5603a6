"""The torques that a motion of an arm requires, from its masses, without friction and contacts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from interp.robot.arm import Load
from interp.robot.kinematics.kinematics import Array
from interp.robot.simulation.cell import Cell, put_loads

_NO_FORCES = int(
    mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_ACTUATION
    | mujoco.mjtDisableBit.mjDSBL_SENSOR
)


class InverseDynamics:
    """Inverse dynamics of a cell, in its axes or in the joints of its model.

    ``columns`` are the axes of the joints, ``units`` an axis unit in radians or metres.
    """

    def __init__(self, cell: Cell) -> None:
        self._machine = cell.machine
        self._model: Any = cell.model()
        self._model.opt.disableflags |= _NO_FORCES
        self._model.dof_damping[:] = 0.0
        self._data = mujoco.MjData(self._model)
        self.columns, self.units = cell.columns(self._model)
        self._loads: Mapping[str, Load] = {}

    def carry(self, loads: Mapping[str, Load]) -> None:
        """Set what the arm carries from now on."""
        if loads != self._loads:
            put_loads(self._model, self._machine, loads)
            self._loads = loads

    def torques(
        self, axes: Array, speeds: Array, accelerations: Array, loads: Mapping[str, Load]
    ) -> Array:
        """Return the torques of all axes in Nm (N for linear axes), 0 for one without a joint.

        All arrays are ``(n, axes)``, in degrees or mm, and seconds.
        """
        self.carry(loads)
        moved = (rows[:, self.columns] * self.units for rows in (axes, speeds, accelerations))
        torques = np.zeros_like(axes)
        torques[:, self.columns] = self.of_joints(*moved)
        return torques

    def of_joints(self, places: Array, speeds: Array, accelerations: Array) -> Array:
        """Return torques in Nm or N; all arrays are ``(n, joints)``, in radians or metres."""
        data, torques = self._data, np.empty_like(places)
        for row, state in enumerate(zip(places, speeds, accelerations, strict=True)):
            data.qpos[:], data.qvel[:], data.qacc[:] = state
            mujoco.mj_inverse(self._model, data)
            torques[row] = data.qfrc_inverse
        return torques

    def inertia(self) -> Array:
        """Return the inertia of each joint in kg m² or kg where `of_joints` was asked last.

        The other joints are free to move. This is the smallest inertia that a spring may act on;
        with the other joints locked it would be larger.
        """
        mujoco.mj_makeM(self._model, self._data)
        inertia = np.empty((self._model.nv, self._model.nv))
        mujoco.mj_fullM(self._model, self._data, inertia)
        found: Array = 1.0 / np.diag(np.linalg.inv(inertia))
        return found
