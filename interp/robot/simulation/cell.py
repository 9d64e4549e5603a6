"""A robot cell for MuJoCo: the arm with its loads, and the scene around it, as one model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from interp.robot.arm import Load
from interp.robot.kinematics.kinematics import Array, matrix_of
from interp.robot.kinematics.machine_data import AxisKind, MachineData
from interp.robot.path.orientation import rotations_about
from interp.robot.simulation.mujoco_model import mjcf_of
from interp.robot.simulation.scene import Scene, SceneError, SceneObject
from interp.values.poses import Pose

if TYPE_CHECKING:
    from interp.robot.simulation.robot_files import RobotFile

#: For each load, the number of the link that carries it.
_LOADS: Final = {"$LOAD": 6, "$LOAD_A1": 1, "$LOAD_A2": 2, "$LOAD_A3": 3}
_SHAPES: Final = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "mesh": mujoco.mjtGeom.mjGEOM_MESH,
}
_STANDING, _HELD = (0.45, 0.55, 0.65, 1.0), (0.35, 0.65, 0.4, 1.0)
_HAND = "flange of the arm"
#: Prefixes of the names of geoms and meshes of a scene, which keep them distinct from others.
OBJECT, MESH = "object ", "mesh of "


@dataclass(frozen=True, slots=True)
class Cell:
    """An arm, given by its machine data or by its own model file, in a scene.

    `model` raises `SceneError` for objects that MuJoCo rejects.
    """

    machine: MachineData
    scene: Scene = field(default_factory=Scene)
    robot: RobotFile | None = None

    def model(self) -> Any:
        """Return the compiled model, an ``MjModel``.

        Its joints are the axes that move. Each has an actuator that applies the torque it receives,
        minus spring and damper. The loads have no mass until `put_loads` sets it.
        """
        try:
            return self._spec().compile()
        except ValueError as error:
            said = " ".join(str(error).split())
            meshes = (one for one in self.scene.objects if f"{MESH}{one.name}'" in said)
            where = next((one.where for one in meshes), "the scene")
            raise SceneError(f"{where}: {said}") from None

    def xml(self) -> str:
        """Return the model as MJCF."""
        spec = self._spec()
        spec.compile()
        return str(spec.to_xml())

    def _spec(self) -> Any:
        if self.robot is None:
            spec = mujoco.MjSpec.from_string(mjcf_of(self.machine))
        else:
            spec = self.robot.spec.copy()
            spec.option.timestep = 0.001
            spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
            for name in self.robot.joints:
                drive = spec.add_actuator(
                    name=f"drive of {name}", target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT
                )
                drive.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        hands = self._bodies()
        self._add_hand(spec, hands[-1])
        for name, link in _LOADS.items():
            if link <= len(hands):
                spec.body(hands[link - 1]).add_body(name=name, mass=0.0)
        for one in self.scene.objects:
            self._add(spec, one)
        return spec

    def columns(self, model: Any) -> tuple[npt.NDArray[np.int64], Array]:
        """Return the axis of each joint of the model, and its unit in radians or metres."""
        names = [axis.name for axis in self.machine.every_axis]
        if self.robot is not None:
            names[: len(self.robot.joints)] = self.robot.joints
        columns = [names.index(model.joint(place).name) for place in range(model.njnt)]
        every = self.machine.every_axis
        is_linear = [every[column].kind is AxisKind.LINEAR for column in columns]
        return np.array(columns), np.where(is_linear, 1e-3, math.pi / 180.0)

    def _bodies(self) -> list[str]:
        """Return the bodies that the robot axes move, in their order."""
        if self.robot is None:
            return [f"link_{number}" for number in range(1, len(self.machine.axes) + 1)]
        spec = self.robot.spec
        return [spec.joint(name).parent.name for name in self.robot.joints]

    def _add_hand(self, spec: Any, last: str) -> None:
        """Add a body at the flange, for what the arm holds."""
        anchor = np.zeros(3)
        if self.robot is not None:
            anchor = np.array(spec.joint(self.robot.joints[-1]).pos)
        end = self.machine.chain.end
        body = spec.body(last).add_body(name=_HAND)
        _place(body, end, anchor)
        for other in self._bodies()[-3:-1]:
            spec.add_exclude(bodyname1=_HAND, bodyname2=other)

    def _add(self, spec: Any, one: SceneObject) -> None:
        body = spec.body(_HAND) if one.is_held else spec.worldbody
        geom = body.add_geom(name=f"{OBJECT}{one.name}", type=_SHAPES[one.shape])
        geom.rgba = _HELD if one.is_held else _STANDING
        geom.mass = one.mass
        x, y, z = (edge / 2000.0 for edge in one.edges)
        geom.size = (x, z, 0.0) if one.shape == "cylinder" else (x, y, z)
        if one.file is not None:
            name = f"{MESH}{one.name}"
            scale = one.scale / 1000.0
            spec.add_mesh(name=name, file=str(one.file.resolve()), scale=(scale,) * 3)
            geom.meshname = name
        _place(geom, one.frame)


def put_loads(model: Any, machine: MachineData, loads: Mapping[str, Load]) -> None:
    """Set the loads that a model carries."""
    frames = _load_frames(machine)
    for name in _LOADS:
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        if body < 0:
            continue
        load = loads.get(name)
        model.body_mass[body] = load.mass if load else 0.0
        model.body_inertia[body] = load.inertia if load else (0.0, 0.0, 0.0)
        centre = frames[name] @ matrix_of(load.centre) if load else np.eye(4)
        model.body_ipos[body] = centre[:3, 3] / 1000.0
        model.body_iquat[body] = _quaternion(centre)
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _load_frames(machine: MachineData) -> dict[str, Array]:
    """Return the frames of the loads relative to the links that carry them, by name."""
    joints = machine.chain.joints
    frames = [matrix_of(joint.frame) for joint in joints]
    flange = matrix_of(machine.chain.end)
    found: dict[str, Array] = {"$LOAD": flange}
    if len(joints) > 3:
        found["$LOAD_A3"] = reduce(np.matmul, frames[3:]) @ flange
    found["$LOAD_A1"] = np.linalg.inv(frames[0]).astype(np.float64)
    if len(joints) > 1:
        upright = np.eye(4)  # A2 at -90
        upright[:3, :3] = rotations_about(np.array(joints[1].axis), np.array([-math.pi / 2]))[0]
        inverse = np.linalg.inv(frames[0] @ frames[1] @ upright)
        found["$LOAD_A2"] = inverse.astype(np.float64)
    return found


def _place(part: Any, frame: Pose, origin: Array | None = None) -> None:
    """Place a body or geom at a frame in mm, relative to an origin in metres."""
    part.pos = np.array(frame.position) / 1000.0 + (0.0 if origin is None else origin)
    part.quat = _quaternion(matrix_of(frame))


def _quaternion(pose: Array) -> Array:
    found = np.empty(4)
    mujoco.mju_mat2Quat(found, pose[:3, :3].ravel())
    return found
