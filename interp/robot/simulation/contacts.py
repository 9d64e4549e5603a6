"""Contacts of an arm on its planned path: with itself, the floor, and the objects of a scene.

The shapes of machine data are assumed (`interp.robot.simulation.links`), so their contacts are only
hints. Between set-points the axes are interpolated linearly, in steps in which nothing moves more
than `_STEP`. Parts of a robot's own model file that touch while all joints are at zero overlap by
design, and are not reported.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import AxisKind
from interp.robot.simulation.cell import OBJECT, Cell
from interp.robot.simulation.links import reach_of
from interp.robot.simulation.observations import Observation, Periods, Times

_STEP = 5.0  # mm
_MOST_STEPS = 200


class ContactCheck:
    """An `interp.robot.simulation.observations.Observer` of one cell.

    Raises `interp.robot.simulation.scene.SceneError` for a scene that MuJoCo rejects.
    """

    def __init__(self, cell: Cell) -> None:
        self._model = cell.model()
        self._data = mujoco.MjData(self._model)
        self._columns, self._units = cell.columns(self._model)
        every = cell.machine.every_axis
        reach = reach_of(cell.machine) * math.pi / 180.0
        self._travel = np.array([1.0 if a.kind is AxisKind.LINEAR else reach for a in every])
        self._before: tuple[int, Array] | None = None
        self._touched: frozenset[tuple[str, str]] = frozenset()
        self._periods = Periods("collision")
        self._usual: frozenset[tuple[str, str]] = frozenset()
        if cell.robot is not None:
            names = {one.name.replace("_", " ") for one in cell.scene.objects}
            self._usual = frozenset(pair for pair in self._pairs() if not names & set(pair))

    def observe(self, times: Times, axes: Array) -> None:
        """Check axes (n, axes) at times in µs."""
        for time, row in zip(times.tolist(), axes, strict=True):
            if self._before is None:
                self._look(time, row)
            else:
                start, last = self._before
                way = float((np.abs(row - last) * self._travel).max())
                steps = min(math.ceil(way / _STEP), _MOST_STEPS) if way > 0.0 else 0
                for step in range(1, steps + 1):
                    share = step / steps
                    self._look(start + round(share * (time - start)), last + share * (row - last))
                if not steps and self._touched:
                    self._note(time)
            self._before = time, row

    def observations(self) -> tuple[Observation, ...]:
        """See `interp.robot.simulation.observations.Observer.observations`."""
        return self._periods.observations()

    def _look(self, time: int, axes: Array) -> None:
        self._data.qpos[:] = axes[self._columns] * self._units
        self._touched = self._pairs() - self._usual
        self._note(time)

    def _pairs(self) -> frozenset[tuple[str, str]]:
        """Return the pairs of parts that touch now."""
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        touched = set()
        for place in range(self._data.ncon):
            contact = self._data.contact[place]
            if contact.dist < 0.0:
                first, second = sorted(self._name(int(geom)) for geom in contact.geom)
                touched.add((first, second))
        return frozenset(touched)

    def _note(self, time: int) -> None:
        self._periods.at(time, ((pair, 0.0, 0.0) for pair in sorted(self._touched)))

    def _name(self, geom: int) -> str:
        name = self._model.geom(geom).name or self._model.body(self._model.geom_bodyid[geom]).name
        return str(name).removeprefix(OBJECT).replace("_", " ")
