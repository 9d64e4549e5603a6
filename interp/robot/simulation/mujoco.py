"""A simulated arm with masses, which follows set-points by computed torque at steps of 1 ms.

The torque of each step is what the model's inverse dynamics asks for to get from one set-point to
the next, plus what a spring and a damper add for where the arm really is. Speed and acceleration
are the differences of the set-points over a step, since that is how the integrator moves: those of
the planned path, half a step away, would leave half a millimetre at 1 m/s to the spring. The
controller knows the masses but not the friction, so that is what measured positions show.

Steps run in MuJoCo itself, a chunk of set-points at a time: spring and damper are part of the
actuators, and their input is the torque plus the set-point times their gains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco import rollout

from interp.robot.arm import Load, Samples
from interp.robot.simulation.cell import Cell, put_loads
from interp.robot.simulation.robot import Measured, RobotFault, check_samples

Array = npt.NDArray[np.float64]

_STEP = 1_000  # µs
_CHUNK = 120_000  # µs
_STIFFNESS = 250.0  # 1/s: how fast an error goes; a quarter of a step, far from what would swing
_LOST = 2.0
"""Degrees or mm off the set-point at which the arm no longer follows; nothing is known to reach it
but a model that is too stiff for its steps."""

_STILL = 1e-9  # rad or m, and a second: below this a joint rests, its error has gone

_STATE = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
_NO_CONTACT = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
_NO_FORCES = int(
    mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_ACTUATION
    | mujoco.mjtDisableBit.mjDSBL_SENSOR
)


class MujocoRobot:
    """The arm of a cell. What it touches does not stop it: `interp.robot.simulation.contacts`.

    It stands still from a fault on, until `stand` puts it somewhere else.
    """

    step = _STEP
    chunk = _CHUNK

    def __init__(self, cell: Cell) -> None:
        _be_quiet()
        self._machine = cell.machine
        self._model, self._free = cell.model(), cell.model()
        self._data = mujoco.MjData(self._model)
        self._model.opt.disableflags |= _NO_CONTACT
        self._free.opt.disableflags |= _NO_FORCES
        self._free.dof_damping[:] = 0.0
        self._free_data = mujoco.MjData(self._free)
        self._columns, self._units = cell.columns(self._model)
        self._count = len(cell.machine.axes) + len(cell.machine.externals)
        self._rest = np.zeros(self._count)
        self._stopped: RobotFault | None = None
        self.stand([0.0] * self._count)

    @property
    def axes(self) -> Array:
        """Where it is: shape (axes,), degrees or mm."""
        place = self._rest.copy()
        place[self._columns] = self._data.qpos / self._units
        return place

    def stand(self, axes: Sequence[float]) -> None:
        """It stands at axes, with nothing of what was before."""
        mujoco.mj_resetData(self._model, self._data)
        self._rest = np.asarray(axes, dtype=np.float64)
        self._data.qpos[:] = self._rest[self._columns] * self._units
        self._set_point = self._data.qpos.copy()
        self._speed = np.zeros_like(self._set_point)
        self._stopped = None

    def carry(self, loads: Mapping[str, Load]) -> None:
        """See `interp.robot.simulation.robot.Robot.carry`."""
        for model in (self._model, self._free):
            put_loads(model, self._machine, loads)

    def follow(self, samples: Samples) -> Measured:
        """Follow set-points 1 ms apart; torques are those that the set-points ask for.

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
        """Whether it and its set-point stand still: each step then equals the one before."""
        return (
            not self._speed.any()
            and bool((targets == self._set_point).all())
            and bool((np.abs(self._data.qvel) < _STILL).all())
            and bool((np.abs(self._data.qpos - self._set_point) < _STILL).all())
        )

    def _resting(self, count: int) -> Measured:
        """As many steps at rest: the place stays, and torques hold what is carried."""
        data = self._free_data
        data.qpos[:], data.qvel[:], data.qacc[:] = self._set_point, 0.0, 0.0
        mujoco.mj_inverse(self._free, data)
        torques = np.zeros(self._count)
        torques[self._columns] = data.qfrc_inverse
        return Measured(np.tile(self.axes, (count, 1)), np.tile(torques, (count, 1)))

    def _control(self, targets: Array) -> tuple[Array, Array]:
        """Torques and the inputs of actuators, for steps that end at ``targets`` (n, joints)."""
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
        return torques, control

    def _inertia(self) -> Array:
        """Of each joint in kg m² or kg, at the last set-point and with all others free to go along.

        That is the least that a spring may find; with the others locked it would be more.
        """
        free, data = self._free, self._free_data
        mujoco.mj_makeM(free, data)
        inertia = np.empty((free.nv, free.nv))
        mujoco.mj_fullM(free, data, inertia)
        found: Array = 1.0 / np.diag(np.linalg.inv(inertia))
        return found

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


def _be_quiet() -> None:
    """MuJoCo writes warnings to a file in the working directory; what matters is a fault here."""
    mujoco.set_mju_user_warning(_forget)


def _forget(_: str) -> None:
    return
