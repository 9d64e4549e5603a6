"""A simulated arm with masses that follows its set-points by computed-torque control, at 1 kHz.

The torque of each step is that of inverse dynamics for the motion from one set-point to the next,
plus a spring and a damper for the tracking error. Velocity and acceleration are differences of
set-points over a step, because the integrator moves in this way. Those of the planned path, half a
step away, would leave an error of half a millimetre at 1 m/s to the spring. The controller knows
the masses but not the friction, so measured positions show the effect of friction.

Steps run inside MuJoCo, a chunk of set-points at a time: spring and damper are part of the
actuators, whose input is the torque plus the set-point times their gains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from mujoco import rollout

from interp.robot.arm import Load, Samples
from interp.robot.kinematics.kinematics import Array
from interp.robot.simulation.cell import Cell, put_loads
from interp.robot.simulation.inverse_dynamics import InverseDynamics
from interp.robot.simulation.robot import Measured, RobotFault, check_samples

_STEP = 1_000  # µs
_CHUNK = 120_000  # µs
_STIFFNESS = 250.0  # 1/s: decay rate of an error; 1/4 per step, far from instability
#: Degrees or mm of tracking error at which the arm counts as lost; only a model that is too stiff
#: for its steps is known to reach it.
_LOST = 2.0

_STILL = 1e-9  # rad or m, and per second: below this a joint is at rest without an error

_STATE = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
_NO_CONTACT = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)


class MujocoRobot:
    """The arm of a cell. Contacts do not stop it: see `interp.robot.simulation.contacts`.

    After a fault it stands still until `stand` places it somewhere else.
    """

    step = _STEP
    chunk = _CHUNK

    def __init__(self, cell: Cell) -> None:
        mujoco.set_mju_user_warning(_forget)
        self._machine = cell.machine
        self._model = cell.model()
        self._data = mujoco.MjData(self._model)
        self._model.opt.disableflags |= _NO_CONTACT
        self._dynamics = InverseDynamics(cell)
        self._columns, self._units = self._dynamics.columns, self._dynamics.units
        self._count = len(cell.machine.axes) + len(cell.machine.externals)
        self._rest = np.zeros(self._count)
        self._stopped: RobotFault | None = None
        self.stand([0.0] * self._count)

    @property
    def axes(self) -> Array:
        """The present axes, shape (axes,), in degrees or mm."""
        place = self._rest.copy()
        place[self._columns] = self._data.qpos / self._units
        return place

    def stand(self, axes: Sequence[float]) -> None:
        """Place the arm at rest at axes, and forget all earlier state."""
        mujoco.mj_resetData(self._model, self._data)
        self._rest = np.asarray(axes, dtype=np.float64)
        self._data.qpos[:] = self._rest[self._columns] * self._units
        self._set_point = self._data.qpos.copy()
        self._speed = np.zeros_like(self._set_point)
        self._stopped = None

    def carry(self, loads: Mapping[str, Load]) -> None:
        """See `interp.robot.simulation.robot.Robot.carry`."""
        put_loads(self._model, self._machine, loads)
        self._dynamics.carry(loads)

    def follow(self, samples: Samples) -> Measured:
        """Follow set-points 1 ms apart; the torques are those that the set-points require.

        Raises `RobotFault`.
        """
        check_samples(samples)
        count = len(samples.times)
        if self._stopped is not None or not count:
            return Measured(np.tile(self.axes, (count, 1)), np.zeros((count, self._count)))
        targets = samples.axes[:, self._columns] * self._units
        if self._rests(targets):
            return self._resting(count)
        torques, control = self._control(targets)
        start = np.empty((1, mujoco.mj_stateSize(self._model, _STATE)))
        mujoco.mj_getState(self._model, self._data, start[0], _STATE)
        states, _ = rollout.rollout(
            self._model, self._data, initial_state=start, control=control[None]
        )
        places = samples.axes.copy()  # axes without a joint are at their set-points
        places[:, self._columns] = states[0, :, 1 : 1 + self._model.nq] / self._units
        self._check(samples, states[0], places)
        mujoco.mj_setState(self._model, self._data, states[0, -1], _STATE)
        every = np.zeros((count, self._count))
        every[:, self._columns] = torques
        return Measured(places, every)

    def _rests(self, targets: Array) -> bool:
        """Return whether arm and set-point are at rest, so that each step equals the previous."""
        return (
            not self._speed.any()
            and bool((targets == self._set_point).all())
            and bool((np.abs(self._data.qvel) < _STILL).all())
            and bool((np.abs(self._data.qpos - self._set_point) < _STILL).all())
        )

    def _resting(self, count: int) -> Measured:
        """Return so many steps at rest, with the torques that hold what is carried."""
        rest = np.zeros_like(self._set_point)[None]
        torques = np.zeros(self._count)
        torques[self._columns] = self._dynamics.of_joints(self._set_point[None], rest, rest)[0]
        return Measured(np.tile(self.axes, (count, 1)), np.tile(torques, (count, 1)))

    def _control(self, targets: Array) -> tuple[Array, Array]:
        """Return torques and actuator inputs for steps that end at ``targets`` (n, joints)."""
        before = np.vstack((self._set_point, targets[:-1]))
        speeds = (targets - before) / (_STEP * 1e-6)
        earlier = np.vstack((self._speed, speeds[:-1]))
        pushes = (speeds - earlier) / (_STEP * 1e-6)
        torques = self._dynamics.of_joints(before, earlier, pushes)
        inertia = self._dynamics.inertia()
        spring, damper = inertia * _STIFFNESS**2, inertia * _STIFFNESS * 2.0
        self._model.actuator_biasprm[:, 1] = -spring
        self._model.actuator_biasprm[:, 2] = -damper
        self._set_point, self._speed = targets[-1].copy(), speeds[-1].copy()
        control: Array = torques + spring * before + damper * earlier
        return torques, control

    # --------------------------------------------------------------------------------- what fails

    def _check(self, samples: Samples, states: Array, places: Array) -> None:
        off = np.abs(places - samples.axes).max(axis=1)
        lost = ~(off < _LOST)
        if not lost.any():
            return
        first = int(np.argmax(lost))
        time = int(samples.times[first])
        mujoco.mj_setState(self._model, self._data, states[max(first - 1, 0)], _STATE)
        self._data.qvel[:] = 0.0
        text = f"the arm does not follow its set-points, at {time / 1e6:.3f} s"
        self._stopped = RobotFault("tracking", text, time)
        raise self._stopped


def _forget(_: str) -> None:
    """Suppress a warning that MuJoCo would write to a file in the working directory."""
