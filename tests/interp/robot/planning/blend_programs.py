"""How well blends obey their laws, on programs drawn by seed.

Five laws: no program is slower for its blends; a point on a straight line costs nothing; no axis
exceeds its speed, acceleration or jerk; a path does not depend on the override; under a low one
nothing is faster than its share of what is programmed. Motions are planned all at once, and axes
differenced at every millisecond.
"""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import Any, Final

import numpy as np

from interp.port.requests import At
from interp.robot.arm import Approximation, Motion, Settings, Target
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.values.faults import Fault

#: What is measured of each program, and the most that keeps the law.
LAWS: Final[dict[str, float]] = {
    "time": 1.0,
    "straight": 1.0,
    "speed": 1.0,
    "acceleration": 1.0,
    "jerk": 1.0,
    "override_mm": 1e-6,
    "programmed": 1.0,
}

_HOME = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
_STEP = 1000  # µs
_SLACK = 1e-3
"""Share by which a figure may exceed a law: differences of sampled axes are no derivatives."""
_SECOND = 1e6
_LOW = 0.3  # the low override


@dataclass(frozen=True, slots=True)
class Travelled:
    """A program travelled: seconds, and the greatest share of each axis limit that was used."""

    seconds: float
    speed: float
    acceleration: float
    jerk: float
    blends: int


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


def travel(program: Sequence[Motion], override: float = 100.0) -> tuple[Travelled, PlannedArm]:
    """A program travelled from home. Raises `Fault` where a motion is refused."""
    machine = default_machine()
    arm = PlannedArm(machine, _HOME)
    first, *others = program
    arm.plan(0, first)
    now = 0
    while arm.next_event() is not None:
        now = arm.take().time
    arm.override(now, override)
    for motion in others:
        arm.plan(now, motion)
    end = math.ceil(arm.path()[-1].ends * _SECOND)
    used = _used(machine, arm.sample(np.arange(now, end + 20 * _STEP, _STEP)).axes)
    blends = len({leg.section.key for leg in arm.path() if leg.section.following is not None})
    return Travelled((end - now) / _SECOND, *used, blends), arm


def _used(machine: MachineData, axes: Array) -> tuple[float, float, float]:
    """Shares of speed, acceleration and jerk, by differences at every step."""
    known = [axis.dynamics for axis in (*machine.axes, *machine.externals) if axis.dynamics]
    shares = []
    for order, name in ((1, "velocity"), (2, "acceleration"), (3, "jerk")):
        limits = np.array([getattr(one, name) for one in known])
        rates = np.diff(axes, n=order, axis=0) / (_STEP / _SECOND) ** order
        shares.append(float((np.abs(rates) / limits).max(initial=0.0)))
    return shares[0], shares[1], shares[2]


def _override_mm(arm: PlannedArm, other: PlannedArm) -> float:
    """By how much the paths of two runs differ, in mm or degrees of their sections."""
    u = np.linspace(0.0, 1.0, 17)
    ours, theirs = (
        {leg.section.key: leg.section.curve for leg in each.path()} for each in (arm, other)
    )
    if ours.keys() != theirs.keys():
        return math.inf
    return max(float(np.abs(ours[key].axes(u) - theirs[key].axes(u)).max()) for key in ours)


def _programmed_share(program: Sequence[Motion], arm: PlannedArm, override: float) -> float:
    """The greatest share of the programmed speed: of the tool on its paths, of axes between PTP."""
    kinds = {motion.number: motion.kind for motion in program}
    settings = program[0].settings
    machine = default_machine()
    known = [axis.dynamics for axis in (*machine.axes, *machine.externals) if axis.dynamics]
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
    return max(shares) / override


def measure(
    count: int = 300, seed: int = 1, on_step: Callable[[], None] = lambda: None
) -> dict[str, Any]:
    """The record of so many programs of each sort, from a seed on."""
    found: dict[str, list[tuple[float, int]]] = {name: [] for name in LAWS}
    refused = blends = 0
    saved: list[float] = []
    begun = process_time()
    for number in range(seed, seed + count):
        on_step()
        program = draw(number)
        try:
            blended, arm = travel(program)
            stopped, _ = travel(exact(program))
            _, slow = travel(program, 100.0 * _LOW)
        except Fault:
            refused += 1
        else:
            blends += blended.blends
            ratio = blended.seconds / stopped.seconds
            saved.append(ratio)
            found["time"].append((ratio, number))
            found["override_mm"].append((_override_mm(arm, slow), number))
            found["programmed"].append((_programmed_share(program, slow, _LOW), number))
            for name in ("speed", "acceleration", "jerk"):
                found[name].append((getattr(blended, name), number))
        try:
            whole, parts = (travel(row)[0].seconds for row in straight(number))
        except Fault:
            refused += 1
        else:
            found["straight"].append((parts / whole, number))
    return {
        "programs": count,
        "seed": seed,
        "refused": refused,
        "blends": blends,
        "python": platform.python_version(),
        "seconds": process_time() - begun,
        "median_time": float(np.median(saved)) if saved else None,
        "laws": {
            name: {
                "most": LAWS[name],
                "worst": max(values)[0] if values else None,
                "seed": max(values)[1] if values else None,
                "broken": sum(value > LAWS[name] * (1.0 + _SLACK) for value, _ in values),
                "of": len(values),
            }
            for name, values in found.items()
        },
    }


def _point(rng: np.random.Generator, centre: Array, reach: float, turned: float) -> Target:
    """A point near a place, the tool down and turned by so many degrees at most."""
    x, y, z = centre + rng.uniform(-reach, reach, 3)
    a, b, c = np.array((0.0, 0.0, 180.0)) + rng.uniform(-turned, turned, 3)
    point = {"X": x, "Y": y, "Z": z, "A": a, "B": b, "C": c}
    return point if reach else {**point, "S": 2.0, "T": 2.0}
