"""A simulated arm with masses, which follows set-points by computed torque at steps of 1 ms.

The torque of each step is what the model's inverse dynamics asks for to get from one set-point to
the next, plus what a spring and a damper add for where the arm really is. Speed and acceleration
are the differences of the set-points over a step, since that is how the integrator moves: those of
the planned path, half a step away, would leave half a millimetre at 1 m/s to the spring. The
controller knows the masses but not the friction, so that is what measured positions show.

Steps run in MuJoCo itself, a chunk of set-points at a time: spring and damper are part of the
actuators, and what they are told is the torque plus the set-point times their gains.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco import rollout

from interp.robot.arm import Samples
from interp.robot.kinematics.machine_data import AxisKind, MachineData
from interp.robot.simulation.mujoco_model import TOUCH, Box, mjcf_of
from interp.robot.simulation.robot import RobotFault, check_samples

__all__ = ["MujocoRobot"]

Array = npt.NDArray[np.float64]

_STEP = 1_000  # µs
_CHUNK = 120_000  # µs
_STIFFNESS = 250.0  # 1/s: how fast an error goes; a quarter of a step, far from what would swing
_LOST = 2.0
"""Degrees or mm off the set-point at which the arm no longer follows; nothing is known to reach it
but a model that is too stiff for its steps."""

_STATE = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
_NO_FORCES = int(
    mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_ACTUATION
    | mujoco.mjtDisableBit.mjDSBL_SENSOR
)


class MujocoRobot:
    """The arm of some machine data, among obstacles.

    It stands still from a fault on, until `stand` puts it somewhere else.
    """

    step = _STEP
    chunk = _CHUNK

    def __init__(self, machine: MachineData, boxes: Sequence[Box] = ()) -> None:
        _be_quiet()
        text = mjcf_of(machine, boxes)
        self._model = mujoco.MjModel.from_xml_string(text)
        self._data = mujoco.MjData(self._model)
        self._free = mujoco.MjModel.from_xml_string(text)
        self._free.opt.disableflags |= _NO_FORCES
        self._free.dof_damping[:] = 0.0
        self._free_data = mujoco.MjData(self._free)
        axes = (*machine.axes, *machine.externals)
        is_linear = np.array([axis.kind is AxisKind.LINEAR for axis in axes])
        self._units = np.where(is_linear, 1e-3, math.pi / 180.0)
        self._touch = int(self._model.sensor(TOUCH).adr[0])
        self._stopped: RobotFault | None = None
        self.stand([0.0] * len(axes))

    @property
    def axes(self) -> Array:
        """Where it is: shape (axes,), degrees or mm."""
        place: Array = self._data.qpos / self._units
        return place

    def stand(self, axes: Sequence[float]) -> None:
        """It stands at axes, with nothing of what was before."""
        mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[:] = np.asarray(axes, dtype=np.float64) * self._units
        self._set_point = self._data.qpos.copy()
        self._speed = np.zeros_like(self._set_point)
        self._stopped = None

    def follow(self, samples: Samples) -> Array:
        """Follow set-points 1 ms apart; returns measured axes (n, axes). Raises `RobotFault`."""
        check_samples(samples)
        count = len(samples.times)
        if self._stopped is not None or not count:
            return np.tile(self.axes, (count, 1))
        control = self._control(samples.axes * self._units)
        start = np.empty((1, mujoco.mj_stateSize(self._model, _STATE)))
        mujoco.mj_getState(self._model, self._data, start[0], _STATE)
        states, sensors = rollout.rollout(
            self._model, self._data, initial_state=start, control=control[None]
        )
        places: Array = states[0, :, 1 : 1 + self._model.nq] / self._units  # behind the time
        self._check(samples, states[0], places, sensors[0, :, self._touch] > 0.0)
        mujoco.mj_setState(self._model, self._data, states[0, -1], _STATE)
        return places

    def _control(self, targets: Array) -> Array:
        """What the actuators are told, for steps that end at ``targets`` (n, axes)."""
        data = self._free_data
        before = np.vstack((self._set_point, targets[:-1]))
        speeds = (targets - before) / (_STEP * 1e-6)
        earlier = np.vstack((self._speed, speeds[:-1]))
        pushes = (speeds - earlier) / (_STEP * 1e-6)
        torques = np.empty_like(targets)
        qpos, qvel, qacc, found = data.qpos, data.qvel, data.qacc, data.qfrc_inverse
        for place in range(len(targets)):
            qpos[:], qvel[:], qacc[:] = before[place], earlier[place], pushes[place]
            mujoco.mj_inverse(self._free, data)
            torques[place] = found
        inertia = self._inertia()
        spring, damper = inertia * _STIFFNESS**2, inertia * _STIFFNESS * 2.0
        self._model.actuator_biasprm[:, 1] = -spring
        self._model.actuator_biasprm[:, 2] = -damper
        self._set_point, self._speed = targets[-1].copy(), speeds[-1].copy()
        control: Array = torques + spring * before + damper * earlier
        return control

    def _inertia(self) -> Array:
        """Of each axis in kg m² or kg, at the last set-point and with all others locked."""
        data = self._free_data
        inertia = np.empty(self._free.nv)
        data.qvel[:] = 0.0
        for axis in range(self._free.nv):
            data.qacc[:] = 0.0
            mujoco.mj_inverse(self._free, data)
            still = data.qfrc_inverse[axis]
            data.qacc[axis] = 1.0
            mujoco.mj_inverse(self._free, data)
            inertia[axis] = data.qfrc_inverse[axis] - still
        return inertia

    # --------------------------------------------------------------------------------- what fails

    def _check(
        self, samples: Samples, states: Array, places: Array, touches: npt.NDArray[np.bool_]
    ) -> None:
        off = np.abs(places - samples.axes).max(axis=1)
        lost = ~(off < _LOST)
        failed = touches | lost
        if not failed.any():
            return
        first = int(np.argmax(failed))
        time = int(samples.times[first])
        # A contact is found where a step begins, so the state before shows it.
        mujoco.mj_setState(self._model, self._data, states[max(first - 1, 0)], _STATE)
        if touches[first]:
            slug, text = "collision", self._touching()
        else:
            slug, text = "tracking", "the arm does not follow its set-points"
        self._data.qvel[:] = 0.0
        self._stopped = RobotFault(slug, f"{text}, at {time / 1e6:.3f} s", time)
        raise self._stopped

    def _touching(self) -> str:
        mujoco.mj_forward(self._model, self._data)
        pairs = [self._data.contact[place].geom for place in range(self._data.ncon)]
        if not pairs:
            return "the arm touches something"
        first, second = (self._name(int(geom)) for geom in pairs[0])
        return f"{first} touches {second}"

    def _name(self, geom: int) -> str:
        name = self._model.geom(geom).name or self._model.body(self._model.geom_bodyid[geom]).name
        return str(name).replace("_", " ")


def _be_quiet() -> None:
    """MuJoCo writes warnings to a file in the working directory; what matters is a fault here."""
    mujoco.set_mju_user_warning(_forget)


def _forget(_: str) -> None:
    return
