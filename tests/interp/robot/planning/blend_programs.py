"""Programs of blended motions, drawn by seed, and what is measured of them.

Motions are planned all at once or a few ahead, and axes differenced at every millisecond.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from interp.port.requests import At
from interp.robot.arm import Approximation, Motion, Settings, Target
from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.planning.profile import travel as whole_way
from interp.robot.planning.ramps import Bounds, ramp
from interp.robot.planning.torque_limits import Dynamics

_HOME = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
_STEP = 1000  # µs
_SECOND = 1e6


@dataclass(frozen=True, slots=True)
class Travelled:
    """A program travelled: seconds, and the greatest share of each axis limit that was used."""

    seconds: float
    speed: float
    acceleration: float
    jerk: float


def draw(seed: int) -> list[Motion]:
    """A program of a few motions of any kind, points near and far, zones small and large."""
    rng = np.random.default_rng(seed)
    centre = np.array([rng.uniform(400, 550), rng.uniform(-200, 200), rng.uniform(450, 650)])
    reach = rng.choice([15.0, 60.0, 200.0])
    settings = Settings(
        velocity=float(rng.choice([0.1, 0.5, 1.0, 2.0])),
        acceleration=float(rng.choice([1.0, 2.3, 5.0, 10.0])),
        axis_velocity=(float(rng.choice([20.0, 60.0, 100.0])),) * 12,
        axis_acceleration=(float(rng.choice([20.0, 60.0, 100.0])),) * 12,
        speed_type="#VAR_ALL",
        approximation=Approximation(
            cdis=float(rng.choice([1.0, 3.0, 10.0, 40.0, 300.0])),
            cptp=float(rng.choice([5.0, 20.0, 50.0, 100.0])),
            cvel=float(rng.choice([20.0, 50.0, 100.0])),
            cori=float(rng.choice([2.0, 10.0])),
        ),
    )
    turned = float(rng.choice([0.0, 0.0, 10.0, 40.0]))
    kinds = rng.choice(["PTP", "LIN", "CIRC"], p=rng.dirichlet([1.0, 1.0, 0.3]), size=8)
    made = [Motion(1, At("bench", 1, 0), "PTP", settings, _point(rng, centre, 0.0, 0.0))]
    for kind in kinds[: rng.integers(2, 8)]:
        number = len(made) + 1
        criteria = {
            "PTP": (str(rng.choice(["C_PTP", "C_DIS"])), "C_DIS"),
            "LIN": (str(rng.choice(["C_DIS", "C_DIS", "C_VEL", "C_ORI"])), "C_PTP"),
            "CIRC": ("C_DIS", "C_PTP"),
        }[kind]
        target = _point(rng, centre, reach, turned)
        auxiliary = _point(rng, centre, reach, turned) if kind == "CIRC" else None
        if kind == "PTP" and rng.random() < 0.5:
            target = {"A1": rng.uniform(-60, 60), "A4": rng.uniform(-90, 90)}
        at = At("bench", number, 0)
        made.append(Motion(number, at, str(kind), settings, target, auxiliary, criteria=criteria))
    return made


def straight(seed: int) -> tuple[list[Motion], list[Motion]]:
    """A straight way in one motion, and with points on it that are blended.

    A line or a PTP, at any speed, with two to twenty points anywhere on it.
    """
    rng = np.random.default_rng(seed)
    settings = Settings(
        velocity=float(rng.choice([0.1, 0.5, 1.0, 2.0])),
        acceleration=float(rng.choice([1.0, 2.3, 10.0])),
        approximation=Approximation(
            cdis=float(rng.choice([1.0, 10.0, 300.0])), cptp=float(rng.choice([5.0, 50.0, 100.0]))
        ),
        speed_type="#VAR_ALL",
    )
    shares = np.sort(rng.uniform(0.02, 0.98, int(rng.integers(2, 21))))
    if rng.random() < 0.5:  # evenly
        shares = np.linspace(0.0, 1.0, len(shares) + 2)[1:-1]
    is_line = bool(rng.random() < 0.5)
    names, kind = (("X", "Y", "Z"), "LIN") if is_line else (("A1", "A2", "A4"), "PTP")
    middle = (500.0, 0.0, 600.0) if is_line else (0.0, -80.0, 0.0)
    reach = (80.0, 250.0, 100.0) if is_line else (60.0, 30.0, 60.0)
    start, end = (np.array(middle) + rng.uniform(-1.0, 1.0, 3) * np.array(reach) for _ in range(2))
    first: dict[str, float] = dict(zip(names, start.tolist(), strict=True))
    if is_line:
        first = {**first, "A": 0.0, "B": 0.0, "C": 180.0, "S": 2.0, "T": 2.0}
    else:
        home = {f"A{number}": value for number, value in enumerate(_HOME, start=1)}
        first = {**home, **first}
    rows: list[list[Motion]] = []
    for points in ((), shares):
        row = [Motion(1, At("bench", 1, 0), "PTP", settings, first)]
        for share in (*points, 1.0):
            number = len(row) + 1
            place = start + share * (end - start)
            criteria = () if share == 1.0 else ("C_DIS",) if is_line else ("C_PTP",)
            target = dict(zip(names, place.tolist(), strict=True))
            at = At("bench", number, 0)
            row.append(Motion(number, at, kind, settings, target, criteria=criteria))
        rows.append(row)
    return rows[0], rows[1]


def exact(program: Sequence[Motion]) -> list[Motion]:
    """The same motions without approximation."""
    return [replace(motion, criteria=()) for motion in program]


def travel(
    program: Sequence[Motion],
    override: float = 100.0,
    machine: MachineData | None = None,
    dynamics: Dynamics | None = None,
    ahead: float = math.inf,
) -> tuple[Travelled, PlannedArm]:
    """A program travelled from home, of which so many motions ahead of the running one are known.

    Raises `Fault` where a motion is refused.
    """
    machine = machine or default_machine()
    arm = PlannedArm(machine, _HOME, dynamics)
    first, *others = program
    arm.plan(0, first)
    now = 0
    while arm.next_event() is not None:
        now = arm.take().time
    begin = now
    arm.override(now, override)
    while others:
        if arm.pending() <= ahead:
            arm.plan(now, others.pop(0))
        else:
            now = arm.take().time
    end = math.ceil(arm.path()[-1].ends * _SECOND)
    used = _used(machine, arm.sample(np.arange(begin, end + 20 * _STEP, _STEP)).axes)
    return Travelled((end - begin) / _SECOND, *used), arm


def longest(line: PlannedArm, program: Sequence[Motion], ahead: int) -> float:
    """The seconds that a straight way may take of which so many motions ahead are known.

    ``line`` has travelled it in one motion, ``program`` has points on it. At each point the arm has
    to be able to stop within what is known, also while it still accelerates. If it can do so from
    the speed of the line, points cost nothing; else they cost at most what the speed costs from
    which it can, with the least acceleration and jerk along the line.
    """
    leg = line.path()[-1]
    stretches, size = leg.section.limits.stretches, leg.section.limits.stretches[0].size
    speeds = [min(one.normal.velocity, one.programmed) * size for one in stretches]
    acceleration = min(one.normal.acceleration for one in stretches) * size
    jerk = min(one.normal.jerk for one in stretches) * size
    names = program[1].target or {}
    points = np.array([[(motion.target or {})[name] for name in names] for motion in program])
    ways = np.linalg.norm(points - points[0], axis=1)
    places = ways / ways[-1] * size
    known = float((places[1 + ahead : -1] - places[1 : -1 - ahead]).min(initial=math.inf))

    def needed(speed: float) -> float:
        braking = ramp(speed, 0.0, Bounds(speed, acceleration, jerk)).length
        return braking + speed * min(acceleration / jerk, math.sqrt(speed / jerk))

    whole = leg.ends - leg.begins
    if needed(max(speeds)) <= known:
        return whole
    tried = np.linspace(0.0, max(speeds), 10_000)[1:]
    speed = max((one for one in tried.tolist() if needed(one) <= known), default=tried[0])
    bounds = Bounds(min(speed, *speeds), acceleration, jerk)
    return max(whole, whole_way(size, 0.0, 0.0, 0.0, bounds).duration)


def _used(machine: MachineData, axes: Array) -> tuple[float, float, float]:
    """Shares of speed, acceleration and jerk, by differences at every step."""
    known = [axis.dynamics for axis in machine.every_axis if axis.dynamics]
    shares = []
    for order, name in ((1, "velocity"), (2, "acceleration"), (3, "jerk")):
        limits = np.array([getattr(one, name) for one in known])
        rates = np.diff(axes, n=order, axis=0) / (_STEP / _SECOND) ** order
        shares.append(float((np.abs(rates) / limits).max(initial=0.0)))
    return shares[0], shares[1], shares[2]


def programmed_share(program: Sequence[Motion], arm: PlannedArm) -> float:
    """The greatest share of the programmed speed: of the tool on its paths, of axes between PTP."""
    kinds = {motion.number: motion.kind for motion in program}
    settings = program[0].settings
    machine = default_machine()
    known = [axis.dynamics for axis in machine.every_axis if axis.dynamics]
    most = np.array([one.velocity for one in known]) * settings.axis_velocity[0] / 100.0
    shares = [0.0]
    for leg in arm.path():
        section = leg.section
        states = [leg.state(time) for time in np.linspace(leg.begins, leg.ends, 17).tolist()]
        u, speeds = np.array([(one.u, one.speed) for one in states]).T
        if section.number == program[0].number:
            continue
        if section.curve.pose_path is not None:
            tool = np.linalg.norm(section.curve.pose_path.tangents(u), axis=1) * speeds
            shares.append(float(tool.max()) / (settings.velocity * 1000.0))
        elif {kinds[section.number], kinds[section.following or section.number]} == {"PTP"}:
            axes = np.abs(section.curve.rates(u)[0]) * speeds[:, None]
            shares.append(float((axes / most).max()))
    return max(shares)


def _point(rng: np.random.Generator, centre: Array, reach: float, turned: float) -> Target:
    """A point near a place, the tool down and turned by so many degrees at most."""
    x, y, z = centre + rng.uniform(-reach, reach, 3)
    a, b, c = np.array((0.0, 0.0, 180.0)) + rng.uniform(-turned, turned, 3)
    point = {"X": x, "Y": y, "Z": z, "A": a, "B": b, "C": c}
    return point if reach else {**point, "S": 2.0, "T": 2.0}
