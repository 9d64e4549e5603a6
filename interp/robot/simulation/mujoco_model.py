"""An arm's machine data as a model for MuJoCo (MJCF), of primitive shapes only.

The chain of bodies is that of `interp.robot.kinematics.machine_data`, number by number, so the
flange of the model stands where the kinematics have it. What machine data does not say is assumed,
and scaled by the arm's reach from an arm of the size of a KR 6 R900:

- masses: 52 kg in all for a reach of 901.5 mm, as published; by the cube of the reach for others.
  How they are shared among the links is a guess, and so are the shapes, which are filled evenly.
- rotors: they add inertia to an axis, and friction that grows with its speed.
- the floor lies one reach below the foot, out of the way, with a pedestal to look at that nothing
  touches, since the data does not say what the arm stands on. What else there is are boxes.
- there is no load on the flange.

Links touch one another and the floor, except for links next to one another or next but one, whose
shapes overlap. External axes stand beside the arm and touch nothing: machine data does not say what
they carry. MJCF counts in metres and radians, in $WORLD.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from interp.robot.kinematics.machine_data import Axis, AxisKind, MachineData, WristLink
from interp.values.poses import IDENTITY, Pose

__all__ = ["FLANGE", "TOUCH", "Box", "mjcf_of", "reach_of"]

#: The site of the flange, and the sensor that counts contacts.
FLANGE: Final = "flange"
TOUCH: Final = "touch"

_KNOWN_MASS = 52.0  # kg, of an arm with this reach:
_KNOWN_REACH = 901.5  # mm
_ORANGE, _DARK = "1 0.45 0.1 1", "0.25 0.26 0.28 1"
_EXTERNAL_MASS = 20.0  # kg, for an arm of the known reach
_FRICTION = 4.0  # 1/s: torque by speed, as a share of the rotor's inertia

Point = tuple[float, float, float]
_ORIGIN: Point = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Box:
    """An obstacle: a box with its middle at ``pose`` in $WORLD; edges in mm along X, Y and Z."""

    name: str
    pose: Pose
    edges: Point


@dataclass(frozen=True, slots=True)
class _Shape:
    """A capsule from one point to another in the frame of its link; mm."""

    start: Point
    end: Point
    #: As a share of the arm's reach.
    radius: float
    #: As a share of the arm's mass.
    mass: float
    colour: str


@dataclass(frozen=True, slots=True)
class _Body:
    """A link that turns about ``axis`` of its own frame, which stands at ``pose`` in the last."""

    name: str
    pose: Pose
    joint: str
    axis: Point
    #: Rotor inertia as a share of the arm's mass times the square of its reach.
    rotor: float
    shapes: tuple[_Shape, ...]


def reach_of(machine: MachineData) -> float:
    """From axis 1 to the wrist centre of the stretched arm, in mm."""
    forward, aside, up = machine.tx3p3.position
    return abs(machine.length_a) + machine.length_b + math.hypot(forward, aside, up)


def mjcf_of(machine: MachineData, boxes: Sequence[Box] = ()) -> str:
    """The text of the model; joints are called as the axes are, and so are their actuators.

    Joints stand in the order of the axes, external ones last. An actuator gives its joint the
    torque that it is told, less what a controller adds to its gains
    (`interp.robot.simulation.mujoco`).
    """
    reach = reach_of(machine)
    bodies = _chain(machine)
    names = ["foot", *(body.name for body in bodies)]
    axes = (*machine.axes, *machine.externals)
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
        f'    <geom name="floor" type="plane" size="0 0 0.05" material="tiles" '
        f'pos="0 0 {_number((machine.robroot.position[2] - reach) / 1000.0)}"/>',
        _pedestal(machine),
        *(_box(box) for box in boxes),
        f'    <body name="foot" {_placed(machine.robroot)}>',
        *(f"      {_geom(shape, machine)}" for shape in _foot(machine)),
        *_nested(bodies, machine, "      "),
        "    </body>",
        *_externals(machine),
        "  </worldbody>",
        "  <contact>",
        *(
            f'    <exclude body1="{first}" body2="{second}"/>'
            for gap in (1, 2)
            for first, second in zip(names, names[gap:], strict=False)
        ),
        "  </contact>",
        "  <actuator>",
        *(
            f'    <general name="{axis.name}" joint="{axis.name}" biastype="affine"/>'
            for axis in axes
        ),
        "  </actuator>",
        "  <sensor>",
        f'    <contact name="{TOUCH}" data="found" reduce="none" num="1"/>',
        "  </sensor>",
        "</mujoco>",
    ]
    return "\n".join(lines) + "\n"


# ---------------------------------------------------------------------------------------- the arm


def _foot(machine: MachineData) -> tuple[_Shape, ...]:
    middle = _scaled(machine.tiroro.position, 0.5)
    return (_Shape(_ORIGIN, middle, 0.105, 0.22, _DARK),)


def _chain(machine: MachineData) -> tuple[_Body, ...]:
    forward, aside, up = machine.tx3p3.position
    inner = machine.tiroro.inverse()
    elbow = (0.0, aside, up)
    half = (forward / 2.0, aside, up)
    back = _point(machine.tx3p3.inverse(), half)
    hand = machine.tflwp.position
    links = (
        (machine.tiroro, (0.0, 0.0, 1.0), 0.012),
        (Pose.of(x=machine.length_a), (0.0, 1.0, 0.0), 0.012),
        (Pose.of(x=machine.length_b), (0.0, 1.0, 0.0), 0.008),
        (machine.tx3p3, (0.0, 0.0, 1.0), 0.001),
        (_twisted(machine.dh_4), (0.0, 0.0, 1.0), 0.001),
        (_twisted(machine.dh_5), (0.0, 0.0, 1.0), 0.0006),
    )
    middle = _point(inner, _scaled(machine.tiroro.position, 0.6))
    shapes: tuple[tuple[_Shape, ...], ...] = (
        (
            _Shape(middle, _ORIGIN, 0.095, 0.18, _ORANGE),
            _Shape(_ORIGIN, (machine.length_a, 0.0, 0.0), 0.085, 0.06, _ORANGE),
        ),
        (_Shape(_ORIGIN, (machine.length_b, 0.0, 0.0), 0.068, 0.24, _ORANGE),),
        (
            _Shape(_ORIGIN, elbow, 0.064, 0.08, _ORANGE),
            _Shape(elbow, half, 0.056, 0.08, _ORANGE),
        ),
        (_Shape(back, _ORIGIN, 0.045, 0.09, _ORANGE),),
        (_Shape(_ORIGIN, _scaled(hand, 0.3), 0.042, 0.035, _DARK),),
        (_Shape(_scaled(hand, 0.5), _scaled(hand, 0.75), 0.03, 0.015, _DARK),),
    )
    return tuple(
        _Body(
            f"link_{number}",
            pose,
            axis.name,
            _scaled(direction, float(axis.direction)),
            rotor,
            shape,
        )
        for number, (axis, (pose, direction, rotor), shape) in enumerate(
            zip(machine.axes, links, shapes, strict=True), start=1
        )
    )


def _twisted(link: WristLink) -> Pose:
    """A Denavit-Hartenberg step behind its turn about Z."""
    return Pose.of(z=link.d) @ Pose.of(x=link.a, c=link.alpha)


def _nested(bodies: Sequence[_Body], machine: MachineData, indent: str) -> list[str]:
    """The bodies, each within the one before it; the flange is in the last."""
    if not bodies:
        return [f'{indent}<site name="{FLANGE}" size="0.005" {_placed(machine.tflwp)}/>']
    body = bodies[0]
    inertia = body.rotor * _mass(machine) * (reach_of(machine) / 1000.0) ** 2
    return [
        f'{indent}<body name="{body.name}" {_placed(body.pose)}>',
        f'{indent}  <joint name="{body.joint}" axis="{_numbers(body.axis)}" '
        f'armature="{_number(inertia, 6)}" damping="{_number(_FRICTION * inertia, 6)}"/>',
        *(f"{indent}  {_geom(shape, machine)}" for shape in body.shapes),
        *_nested(bodies[1:], machine, f"{indent}  "),
        f"{indent}</body>",
    ]


def _externals(machine: MachineData) -> Iterable[str]:
    reach = reach_of(machine)
    for number, axis in enumerate(machine.externals, start=1):
        pose = machine.robroot @ Pose.of(y=-1.2 * reach * number)
        edge = 0.12 * reach / 1000.0
        yield (
            f'    <body name="{axis.name}" {_placed(pose)}><joint name="{axis.name}" '
            f'{_moved(axis)}/><geom type="box" size="{_numbers((edge, edge, edge))}" '
            f'mass="{_number(_EXTERNAL_MASS * (reach / _KNOWN_REACH) ** 3, 6)}" '
            f'contype="0" conaffinity="0" rgba="{_DARK}"/></body>'
        )


def _moved(axis: Axis) -> str:
    if axis.kind is AxisKind.LINEAR:
        return f'type="slide" axis="{_numbers((float(axis.direction), 0.0, 0.0))}"'
    return f'type="hinge" axis="{_numbers((0.0, 0.0, float(axis.direction)))}"'


def _mass(machine: MachineData) -> float:
    """Of the whole arm, in kg."""
    return _KNOWN_MASS * (reach_of(machine) / _KNOWN_REACH) ** 3


def _middle(machine: MachineData, reach: float) -> Point:
    """What a camera looks at: in front of the foot, at the height of axis 2."""
    return (machine.robroot @ machine.tiroro @ Pose.of(x=0.2 * reach)).position


# --------------------------------------------------------------------------------------- the words


def _geom(shape: _Shape, machine: MachineData) -> str:
    radius = _number(shape.radius * reach_of(machine) / 1000.0, 6)
    mass = _number(shape.mass * _mass(machine), 6)
    if math.dist(shape.start, shape.end) < 1.0:  # mm; too short for a capsule
        form = f'type="sphere" pos="{_metres(shape.start)}"'
    else:
        form = f'type="capsule" fromto="{_metres(shape.start)} {_metres(shape.end)}"'
    return f'<geom {form} size="{radius}" mass="{mass}" rgba="{shape.colour}"/>'


def _pedestal(machine: MachineData) -> str:
    x, y, z = machine.robroot.position
    reach = reach_of(machine)
    return (
        f'    <geom type="cylinder" fromto="{_metres((x, y, z - reach))} {_metres((x, y, z))}" '
        f'size="{_number(0.12 * reach / 1000.0, 6)}" contype="0" conaffinity="0" rgba="{_DARK}"/>'
    )


def _box(box: Box) -> str:
    halves = _metres(_scaled(box.edges, 0.5))
    return (
        f'    <geom name="{_escaped(box.name)}" type="box" size="{halves}" {_placed(box.pose)} '
        'rgba="0.45 0.55 0.65 1"/>'
    )


def _placed(pose: Pose) -> str:
    """Position, and orientation as the X and the Y axis."""
    if pose == IDENTITY:
        return 'pos="0 0 0"'
    columns = [tuple(row[column] for row in pose.rows) for column in (0, 1)]
    return f'pos="{_metres(pose.position)}" xyaxes="{_numbers((*columns[0], *columns[1]))}"'


def _point(pose: Pose, point: Point) -> Point:
    return (pose @ Pose.of(*point)).position


def _scaled(point: Sequence[float], factor: float) -> Point:
    x, y, z = point
    return x * factor, y * factor, z * factor


def _metres(point: Sequence[float]) -> str:
    return _numbers([value / 1000.0 for value in point])


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))


def _number(value: float, digits: int = 17) -> str:
    """As short as it can be without loss; without digits of rounding where fewer are asked for."""
    text = f"{round(value, digits) + 0.0:.{digits}g}" if digits < 17 else repr(value + 0.0)
    return text.removesuffix(".0")


def _escaped(text: str) -> str:
    return "".join(sign if sign.isalnum() or sign in " -_." else "_" for sign in text)
