"""The bodies of an arm: links along its kinematic chain, with shapes and masses.

Machine data has neither shapes nor masses. They are assumed, and scaled from an arm of the size of
a KR 6 R900 by the reach:

- masses: 52 kg in total for a reach of 901.5 mm, as published; proportional to the cube of the
  reach for other arms. The distribution among the links is a guess, and so are the shapes, which
  have uniform density.
- rotors: they add inertia to an axis, and friction proportional to its speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from interp.robot.kinematics.chain import Point
from interp.robot.kinematics.machine_data import AxisKind, MachineData
from interp.values.poses import Pose

_KNOWN_MASS: Final = 52.0  # kg, of an arm with the following reach
_KNOWN_REACH: Final = 901.5  # mm
ORANGE, DARK = "1 0.45 0.1 1", "0.25 0.26 0.28 1"
_EXTERNAL_MASS = 20.0  # kg, for an arm of the known reach
_ORIGIN: Point = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Capsule:
    """A cylinder with hemispherical ends, relative to its link; lengths in mm, mass in kg."""

    start: Point
    end: Point
    radius: float
    mass: float
    colour: str = ORANGE


@dataclass(frozen=True, slots=True)
class Link:
    """A body that an axis moves.

    ``parent`` is the index of the link that carries it, ``None`` for the world. ``frame`` is its
    frame relative to that link with its axis at zero. ``joint`` is the index of its axis among all
    axes, robot axes first; ``None`` if it does not move. The axis turns the body about ``axis`` of
    its own frame, or shifts it along ``axis`` if ``is_linear``. ``rotor`` is the inertia that the
    drive adds, in kg m² (kg if linear). A link without ``touches`` is displayed, but has no
    contacts.
    """

    name: str
    parent: int | None
    frame: Pose
    joint: int | None = None
    axis: Point = (0.0, 0.0, 1.0)
    is_linear: bool = False
    rotor: float = 0.0
    shapes: tuple[Capsule, ...] = ()
    touches: bool = True


def links_of(machine: MachineData) -> tuple[Link, ...]:
    """Return the bodies of an arm and its external axes, each after the one that carries it.

    The bodies that carry the robot come first, then ``foot``, then the links of the robot axes, the
    last of which has the flange. Other external axes stand beside the arm, because machine data
    does not say what they carry.
    """
    scale = reach_of(machine) / _KNOWN_REACH
    mass = _KNOWN_MASS * scale**3
    inertia = mass * (reach_of(machine) / 1000.0) ** 2
    links = [*_carriage(machine, scale)]
    standing = machine.robroot if machine.carrier is None else machine.carrier.chain.end
    links.append(
        Link("foot", len(links) - 1 if links else None, standing, shapes=_foot(machine, mass))
    )
    first = len(links)
    bodies = _shapes(machine, mass) if machine.own_chain is None else _rods(machine, mass)
    for place, (joint, rotor, shapes) in enumerate(
        zip(machine.chain.joints, _ROTORS, bodies, strict=False)
    ):
        name, parent, drive = f"link_{place + 1}", first + place - 1, rotor * inertia
        axis = place, joint.axis, joint.is_linear
        links.append(Link(name, parent, joint.frame, *axis, drive, shapes))
    return (*links, *_externals(machine, scale))


def hand_of(links: Sequence[Link]) -> int:
    """Return the index of the link that has the flange."""
    return max(place for place, link in enumerate(links) if link.name.startswith("link_"))


def reach_of(machine: MachineData) -> float:
    """Return the distance of axis 1 from the wrist centre of the stretched arm in mm.

    For an arm described joint by joint, the distance is that of the last joint.
    """
    if machine.own_chain is not None:
        lengths = [math.hypot(*joint.frame.position) for joint in machine.own_chain.joints[1:]]
        return max(sum(lengths), math.hypot(*machine.own_chain.end.position), 1.0)
    forward, aside, up = machine.tx3p3.position
    return abs(machine.length_a) + machine.length_b + math.hypot(forward, aside, up)


#: Rotor inertia as a fraction of the arm's mass times the square of its reach.
_ROTORS = (0.012, 0.012, 0.008, 0.001, 0.001, 0.0006)


def _foot(machine: MachineData, mass: float) -> tuple[Capsule, ...]:
    top, radius = _scaled(machine.tiroro.position, 0.5), 0.105
    if machine.own_chain is not None:
        top, radius = machine.own_chain.joints[0].frame.position, 0.1
    return (Capsule(_ORIGIN, top, radius * reach_of(machine), 0.22 * mass, DARK),)


def _shapes(machine: MachineData, mass: float) -> tuple[tuple[Capsule, ...], ...]:
    """Return the shapes of the links; radii are fractions of the reach, masses of the arm's."""
    forward, aside, up = machine.tx3p3.position
    elbow = (0.0, aside, up)
    half = (forward / 2.0, aside, up)
    back = _point(machine.tx3p3.inverse(), half)
    hand = machine.tflwp.position
    middle = _point(machine.tiroro.inverse(), _scaled(machine.tiroro.position, 0.6))
    shares: tuple[tuple[tuple[Point, Point, float, float, str], ...], ...] = (
        (
            (middle, _ORIGIN, 0.095, 0.18, ORANGE),
            (_ORIGIN, (machine.length_a, 0.0, 0.0), 0.085, 0.06, ORANGE),
        ),
        ((_ORIGIN, (machine.length_b, 0.0, 0.0), 0.068, 0.24, ORANGE),),
        ((_ORIGIN, elbow, 0.064, 0.08, ORANGE), (elbow, half, 0.056, 0.08, ORANGE)),
        ((back, _ORIGIN, 0.045, 0.09, ORANGE),),
        ((_ORIGIN, _scaled(hand, 0.3), 0.042, 0.035, DARK),),
        ((_scaled(hand, 0.5), _scaled(hand, 0.75), 0.03, 0.015, DARK),),
    )
    reach = reach_of(machine)
    return tuple(
        tuple(
            Capsule(start, end, radius * reach, share * mass, colour)
            for start, end, radius, share, colour in link
        )
        for link in shares
    )


def _rods(machine: MachineData, mass: float) -> tuple[tuple[Capsule, ...], ...]:
    """Return a rod from each joint to the next, thinner towards the flange."""
    joints, reach = machine.chain.joints, reach_of(machine)
    ends = [*(joint.frame.position for joint in joints[1:]), machine.chain.end.position]
    share = mass / len(ends)
    return tuple(
        (Capsule(_ORIGIN, end, (0.08 - 0.009 * place) * reach, share),)
        for place, end in enumerate(ends)
    )


def _carriage(machine: MachineData, scale: float) -> Iterable[Link]:
    """Yield the bodies of external axes that carry the robot, from the world upwards."""
    if machine.carrier is None:
        return
    carrier = machine.carrier
    radius, mass = 0.12 * reach_of(machine), _EXTERNAL_MASS * scale**3
    for place, (joint, column) in enumerate(
        zip(carrier.chain.joints, carrier.columns, strict=True)
    ):
        yield Link(
            joint.name,
            place - 1 if place else None,
            joint.frame if place else carrier.root @ joint.frame,
            len(machine.axes) + column,
            joint.axis,
            joint.is_linear,
            shapes=(Capsule(_ORIGIN, _ORIGIN, radius, mass, DARK),),
            touches=False,
        )


def _externals(machine: MachineData, scale: float) -> Iterable[Link]:
    reach = reach_of(machine)
    carried = () if machine.carrier is None else machine.carrier.columns
    for number, axis in enumerate(machine.externals, start=1):
        if number - 1 in carried:
            continue
        is_linear = axis.kind is AxisKind.LINEAR
        direction = (1.0, 0.0, 0.0) if is_linear else (0.0, 0.0, 1.0)
        yield Link(
            axis.name,
            None,
            machine.robroot @ Pose.of(y=-1.2 * reach * number),
            len(machine.axes) + number - 1,
            _scaled(direction, float(axis.direction)),
            is_linear,
            shapes=(Capsule(_ORIGIN, _ORIGIN, 0.12 * reach, _EXTERNAL_MASS * scale**3, DARK),),
            touches=False,
        )


def _point(pose: Pose, point: Point) -> Point:
    return (pose @ Pose.of(*point)).position


def _scaled(point: Sequence[float], factor: float) -> Point:
    x, y, z = point
    return x * factor, y * factor, z * factor
