"""Robots from URDF and MJCF files, as machine data and as a model for MuJoCo.

The arm is the series of joints from the base to the first branch, such as the fingers of a gripper.
Its joints become A1 to A6 in their order, with the signs of the file. All other joints are fixed.
The flange is a site or body after the last joint that is named ``flange``, ``tool0`` or
``attachment_site``, else the frame of the last body. What such files do not contain, for example
the speeds in MJCF, is assumed as for machine data.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import mujoco
import numpy as np

from interp.robot.kinematics.chain import Chain, Joint
from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import (
    ROBOT_AXES,
    Axis,
    AxisDynamics,
    AxisKind,
    MachineData,
)
from interp.values.poses import Pose
from support.files.untrusted import read_bytes

_FLANGES: Final = ("flange", "tool0", "attachment_site")
_KINDS: Final = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


class RobotFileError(Exception):
    """The file does not describe an arm; the text is one line."""


@dataclass(frozen=True, slots=True)
class RobotFile:
    """An arm from a file; ``joints`` are the names of its joints, beginning with that of A1.

    ``spec`` is the model without all other joints, to be copied and completed.
    """

    machine: MachineData
    spec: Any
    joints: tuple[str, ...]


def read_robot(path: Path) -> RobotFile:
    """Return the arm of a URDF or MJCF file; raise `RobotFileError` and `OSError`."""
    data = read_bytes(path)
    try:
        tree = ET.fromstring(data)
    except ET.ParseError as error:
        line, column = error.position
        raise RobotFileError(f"{path}:{line}: not XML, at column {column + 1}") from None
    if tree.tag not in {"robot", "mujoco"}:
        raise RobotFileError(f"{path}: neither URDF nor MJCF: <{tree.tag}>")
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        spec.compiler.fusestatic = False
        _leave_out_missing_meshes(spec, path)
        model = spec.compile()
    except (ValueError, RuntimeError) as error:
        raise RobotFileError(f"{path}: {' '.join(str(error).split())}") from None
    joints = _arm_joints(model, path)
    names = tuple(model.joint(joint).name for joint in joints)
    if not all(names):
        raise RobotFileError(f"{path}: a joint of the arm has no name")
    hand = int(model.jnt_bodyid[joints[-1]])
    chain = _chain(model, joints, hand)
    machine = _machine(model, joints, chain, _speeds(tree), path)
    return RobotFile(machine, _completed(spec, names), names)


def _leave_out_missing_meshes(spec: Any, path: Path) -> None:
    """Remove shapes whose mesh files do not exist, as with the packages of a URDF."""
    folder = path.parent / (spec.meshdir or "")
    missing = {
        mesh.name for mesh in spec.meshes if mesh.file and not (folder / mesh.file).is_file()
    }
    for geom in list(spec.geoms):
        if geom.meshname in missing:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        if mesh.name in missing:
            spec.delete(mesh)


def _completed(spec: Any, joints: tuple[str, ...]) -> Any:
    """Return the model after removing everything that moves except the arm."""
    kept = set(joints)
    parts: Iterable[Any] = (
        *spec.actuators,
        *spec.sensors,
        *spec.keys,
        *spec.tendons,
        *spec.equalities,
        *(joint for joint in spec.joints if joint.name not in kept),
    )
    for part in parts:
        spec.delete(part)
    return spec


def _arm_joints(model: Any, path: Path) -> list[int]:
    """Return the joints of the arm, from the base outwards."""
    moved = [_joints_of(model, body) for body in range(model.nbody)]
    beyond = [sum(len(moved[b]) for b in _below(model, body)) for body in range(model.nbody)]
    body, found = 0, [*moved[0]]
    while going_on := [
        c for c in range(1, model.nbody) if model.body_parentid[c] == body and beyond[c]
    ]:
        if len(going_on) > 1 and found:
            break
        body = max(going_on, key=lambda child: beyond[child])
        found += moved[body]
    if not found:
        raise RobotFileError(f"{path}: no joint moves anything")
    if any(int(model.jnt_type[joint]) not in _KINDS for joint in found):
        raise RobotFileError(f"{path}: a joint of the arm neither turns nor slides")
    if len(found) > ROBOT_AXES:
        raise RobotFileError(f"{path}: {len(found)} joints in a row; an arm has six at most")
    return found


def _joints_of(model: Any, body: int) -> list[int]:
    first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    return list(range(first, first + count))


def _below(model: Any, body: int) -> Iterable[int]:
    """Yield a body and all bodies that it carries."""
    for other in range(model.nbody):
        above = other
        while above not in (body, 0):
            above = int(model.body_parentid[above])
        if above == body:
            yield other


def _chain(model: Any, joints: list[int], hand: int) -> Chain:
    """Return the chain of joints, with frames in mm at the joints' anchors."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    made: list[Joint] = []
    before = np.eye(4)
    for number, joint in enumerate(joints, start=1):
        here = _matrix(data.xanchor[joint], data.xmat[model.jnt_bodyid[joint]])
        x, y, z = model.jnt_axis[joint].tolist()
        is_linear = int(model.jnt_type[joint]) == _KINDS[1]
        made.append(Joint(f"A{number}", _between(before, here), (x, y, z), is_linear))
        before = here
    return Chain(tuple(made), _between(before, _flange(model, data, hand)))


def _flange(model: Any, data: Any, hand: int) -> Array:
    """Return the flange in the world."""
    carried = set(_below(model, hand))
    for name in _FLANGES:
        site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)
        if site >= 0 and int(model.site_bodyid[site]) in carried:
            return _matrix(data.site_xpos[site], data.site_xmat[site])
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        if body in carried:
            return _matrix(data.xpos[body], data.xmat[body])
    return _matrix(data.xpos[hand], data.xmat[hand])


def _matrix(place: Array, turn: Array) -> Array:
    """Return a frame in the world, in mm."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn.reshape(3, 3), 1000.0 * place
    return pose


def _between(before: Array, after: Array) -> Pose:
    return Pose.from_matrix((np.linalg.inv(before) @ after).tolist())


def _speeds(tree: ET.Element) -> dict[str, float]:
    """Return the largest speeds of joints in rad/s or m/s; MuJoCo does not read them."""
    found: dict[str, float] = {}
    for joint in tree.iter("joint"):
        limit = joint.find("limit")
        try:
            speed = float(limit.get("velocity", "")) if limit is not None else 0.0
        except ValueError:
            speed = 0.0
        if 0.0 < speed < math.inf:
            found[joint.get("name", "")] = speed
    return found


def _machine(
    model: Any, joints: list[int], chain: Chain, speeds: dict[str, float], path: Path
) -> MachineData:
    """Return machine data of the arm; axes that the arm does not have stay at 0."""
    axes = []
    for number in range(1, ROBOT_AXES + 1):
        if number > len(joints):
            axes.append(Axis(f"A{number}", AxisKind.ROTARY, 1, 0.0, 0.0, None, 90.0))
            continue
        joint = joints[number - 1]
        is_linear = chain.joints[number - 1].is_linear
        unit = 1000.0 if is_linear else math.degrees(1.0)
        lower, upper = -math.inf, math.inf
        if model.jnt_limited[joint]:
            lower, upper = (float(end) * unit for end in model.jnt_range[joint])
        speed = speeds.get(model.joint(joint).name, 0.0) * unit
        axes.append(
            Axis(
                name=f"A{number}",
                kind=AxisKind.LINEAR if is_linear else AxisKind.ROTARY,
                direction=1,
                lower=lower,
                upper=upper,
                dynamics=AxisDynamics.ramped(speed) if speed else None,
                approximation=90.0,
            )
        )
    most = [_torque(model, joint) for joint in joints]
    return MachineData(
        name=path.stem[:60],
        axes=tuple(axes),
        torques=(*most, *(math.inf,) * (ROBOT_AXES - len(most))),
        own_chain=chain,
    )


def _torque(model: Any, joint: int) -> float:
    """Return the largest torque of a joint in Nm or N, its own limit or that of its actuators."""
    if model.jnt_actfrclimited[joint]:
        return float(np.abs(model.jnt_actfrcrange[joint]).max())
    drives = [
        float(np.abs(model.actuator_forcerange[place]).max() * abs(model.actuator_gear[place, 0]))
        for place in range(model.nu)
        if model.actuator_trntype[place] == mujoco.mjtTrn.mjTRN_JOINT
        and model.actuator_trnid[place, 0] == joint
        and model.actuator_forcelimited[place]
    ]
    return max(drives, default=math.inf)
