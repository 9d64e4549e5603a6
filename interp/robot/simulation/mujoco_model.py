"""The conversion of an arm's machine data to a MuJoCo model (MJCF) of primitive shapes.

The chain of bodies is exactly that of `interp.robot.kinematics.machine_data`, so the flange of the
model is where the kinematics says. Masses and shapes are those of `interp.robot.simulation.links`.
The rest is assumed, because machine data does not contain it:

- The floor is one reach below the foot, out of the way. A pedestal is displayed that nothing
  touches, because the data does not say what the arm stands on. If the arm hangs from a ceiling or
  a wall, the floor is two reaches below, and the pedestal is a short piece behind the foot.

Links may touch one another and the floor. Links that are neighbours or next neighbours are
excluded, because their shapes overlap. External axes stand beside the arm and touch nothing:
machine data does not say what they carry. MJCF is in metres and radians, relative to $WORLD.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from interp.robot.kinematics.chain import Point
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.simulation.links import DARK, Capsule, Link, hand_of, links_of, reach_of
from interp.robot.simulation.model_names import FLANGE, GROUND, UPRIGHT
from interp.values.poses import IDENTITY, Pose

_FRICTION = 4.0  # 1/s: torque per speed, as a fraction of the rotor's inertia


def mjcf_of(machine: MachineData) -> str:
    """Return the model as text; joints and actuators have the names of their axes.

    Joints are in the order of the axes: first those that carry the robot, then its own, then other
    external axes. Actuators are in the order of the joints. An actuator applies the torque at its
    input to its joint, plus the bias that a controller configures
    (`interp.robot.simulation.mujoco`).
    """
    reach = reach_of(machine)
    links = links_of(machine)
    names = [link.name for link in links if link.touches]
    axes = machine.every_axis
    driven = [axes[link.joint].name for link in links if link.joint is not None]
    lines = [
        f'<mujoco model="{_escaped(machine.name) or "arm"}">',
        '  <compiler angle="radian" autolimits="true"/>',
        '  <option timestep="0.001" integrator="Euler" cone="pyramidal"/>',
        "  <visual>",
        '    <global offwidth="1920" offheight="1080" azimuth="130" elevation="-20"/>',
        '    <headlight ambient="0.4 0.4 0.4" diffuse="0.5 0.5 0.5"/>',
        "  </visual>",
        f'  <statistic extent="{_number(1.6 * reach / 1000.0)}" '
        f'center="{_metres(_middle(machine, reach))}"/>',
        "  <asset>",
        '    <texture type="skybox" builtin="gradient" rgb1="0.9 0.93 0.96" rgb2="0.6 0.66 0.72" '
        'width="64" height="256"/>',
        '    <texture name="tiles" type="2d" builtin="checker" rgb1="0.82 0.83 0.84" '
        'rgb2="0.74 0.75 0.76" width="256" height="256"/>',
        '    <material name="tiles" texture="tiles" texrepeat="4 4" texuniform="true"/>',
        "  </asset>",
        "  <worldbody>",
        f'    <light pos="0 0 {_number(4 * reach / 1000.0)}" dir="0 0 -1" diffuse="0.5 0.5 0.5"/>',
        f'    <geom name="{GROUND[0]}" type="plane" size="0 0 0.05" material="tiles" '
        f'pos="0 0 {_number(_floor(machine) / 1000.0)}"/>',
        _pedestal(machine),
        *_nested(links, None, machine, "    "),
        "  </worldbody>",
        "  <contact>",
        *(
            f'    <exclude body1="{first}" body2="{second}"/>'
            for gap in (1, 2)
            for first, second in zip(names, names[gap:], strict=False)
        ),
        "  </contact>",
        "  <actuator>",
        *(f'    <general name="{name}" joint="{name}" biastype="affine"/>' for name in driven),
        "  </actuator>",
        "</mujoco>",
    ]
    return "\n".join(lines) + "\n"


# ---------------------------------------------------------------------------------------- the arm


def _nested(
    links: Sequence[Link], parent: int | None, machine: MachineData, indent: str
) -> list[str]:
    """Return the bodies that a link carries, recursively; the last one has the flange site."""
    lines: list[str] = []
    for place, link in enumerate(links):
        if link.parent == parent:
            lines += (
                f'{indent}<body name="{link.name}" {_placed(link.frame)}>',
                *_joint(link, machine, f"{indent}  "),
                *(f"{indent}  {_geom(shape, link.touches)}" for shape in link.shapes),
                *_nested(links, place, machine, f"{indent}  "),
            )
            if place == hand_of(links):
                lines.append(
                    f'{indent}  <site name="{FLANGE}" size="0.005" {_placed(machine.chain.end)}/>'
                )
            lines.append(f"{indent}</body>")
    return lines


def _joint(link: Link, machine: MachineData, indent: str) -> list[str]:
    if link.joint is None:
        return []
    axis = machine.every_axis[link.joint]
    kind = 'type="slide" ' if link.is_linear else ""
    drive = ""
    if link.rotor:
        drive = (
            f' armature="{_number(link.rotor, 6)}" damping="{_number(_FRICTION * link.rotor, 6)}"'
        )
    return [f'{indent}<joint name="{axis.name}" {kind}axis="{_numbers(link.axis)}"{drive}/>']


def _middle(machine: MachineData, reach: float) -> Point:
    """Return what a camera looks at: a point in front of the foot, at the height of axis 2."""
    return (machine.robroot @ machine.tiroro @ Pose.of(x=0.2 * reach)).position


# --------------------------------------------------------------------------------------- the words


def _geom(shape: Capsule, touches: bool) -> str:
    radius = _number(shape.radius / 1000.0, 6)
    if math.dist(shape.start, shape.end) < 1.0:  # mm; too short for a capsule
        form = f'type="sphere" pos="{_metres(shape.start)}"'
    else:
        form = f'type="capsule" fromto="{_metres(shape.start)} {_metres(shape.end)}"'
    contact = "" if touches else ' contype="0" conaffinity="0"'
    mass = _number(shape.mass, 6)
    return f'<geom {form} size="{radius}" mass="{mass}"{contact} rgba="{shape.colour}"/>'


def _is_upright(machine: MachineData) -> bool:
    return machine.robroot.rows[2][2] > UPRIGHT


def _floor(machine: MachineData) -> float:
    """Return the height of the floor in mm."""
    return machine.robroot.position[2] - (1 if _is_upright(machine) else 2) * reach_of(machine)


def _pedestal(machine: MachineData) -> str:
    x, y, _ = foot = machine.robroot.position
    reach = reach_of(machine)
    behind = (machine.robroot @ Pose.of(z=-0.2 * reach)).position
    start = (x, y, _floor(machine)) if _is_upright(machine) else behind
    return (
        f'    <geom name="{GROUND[1]}" type="cylinder" fromto="{_metres(start)} {_metres(foot)}" '
        f'size="{_number(0.12 * reach / 1000.0, 6)}" contype="0" conaffinity="0" rgba="{DARK}"/>'
    )


def _placed(pose: Pose) -> str:
    """Return a pose as attributes: the position, and the X and Y axes of the orientation."""
    if pose == IDENTITY:
        return 'pos="0 0 0"'
    columns = [tuple(row[column] for row in pose.rows) for column in (0, 1)]
    return f'pos="{_metres(pose.position)}" xyaxes="{_numbers((*columns[0], *columns[1]))}"'


def _metres(point: Sequence[float]) -> str:
    return _numbers([value / 1000.0 for value in point])


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))


def _number(value: float, digits: int = 17) -> str:
    """Return a number as short as possible without loss, or rounded to ``digits``."""
    text = f"{round(value, digits) + 0.0:.{digits}g}" if digits < 17 else repr(value + 0.0)
    return text.removesuffix(".0")


def _escaped(text: str) -> str:
    return "".join(sign if sign.isalnum() or sign in " -_." else "_" for sign in text)
