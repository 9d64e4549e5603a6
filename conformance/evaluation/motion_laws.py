"""Laws that hold for every motion of every program: it does what was programmed.

A motion ends at its target, with the Status and Turn of the target. A CIRC is the programmed
circle. Nothing is faster than programmed. The tool is where axes and machine data put it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from conformance.evaluation.motions import (
    NEAR_DEGREES,
    NEAR_MM,
    ROUNDING,
    Array,
    EndedMotion,
    flanges_of,
    follows,
)
from conformance.evaluation.observation import Observation
from conformance.evaluation.path_geometry import (
    RATE_MARGIN,
    change_rates,
    circle_of,
    from_circle,
    nearest,
    refined,
    rotations,
)
from conformance.evaluation.run_laws import Violation
from interp.robot.kinematics.chain import Chain
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.kinematics.placement import IpoMode
from interp.robot.simulation.tracking import PathRecord
from interp.values.poses import Pose

_POINT: Final = ("X", "Y", "Z")
_ANGLES: Final = ("A", "B", "C")
#: The smallest number of samples in a blend that is checked.
_FEWEST: Final = 4
#: The smallest number that shows accelerations and jerks in a blend; the share of its speed that a
#: motion has lost where a blend slows it down; the shares of a limit that is used then, between PTP
#: and between lines: samples miss peaks, and the axes of lines have splines.
_MANY: Final = 20
_SLOWED: Final = 0.88
_USED_BY_AXES, _USED_BY_TOOL = 0.77, 0.7
#: Shares of a speed from which it counts as steady, and as the programmed one.
_STEADY, _FULL = 0.97, 0.99


def motion_violations(seen: Observation, motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield what the motions of a run do against their program."""
    path, machine = seen.path, seen.machine
    if path is not None and machine is not None:
        yield from _wrong_tool_pose(path, machine)
    for one in motions:
        laws = (_wrong_end, _wrong_posture, _wrong_circle, _wrong_turn, _missed_points)
        for law in laws if one.is_held else (*laws, _not_at_rest, _too_fast):
            yield from law(one)


def _wrong_tool_pose(path: PathRecord, machine: MachineData) -> Iterator[Violation]:
    """Yield the first set-point whose tool is not where machine data and axes put it [POS-11]."""
    flanges = flanges_of(machine.chain, path.axes[:, :ROBOT_AXES])
    bounds = [int(np.searchsorted(path.times, time)) for time, _ in path.placements]
    for first, last, (_, placement) in zip(
        bounds, [*bounds[1:], len(path.times)], path.placements, strict=False
    ):
        rows = slice(first, last)
        if first < last:
            own = path.axes[rows, ROBOT_AXES:]
            tools = flanges[rows] @ matrix_of(placement.tool)
            poses = np.linalg.inv(placement.chains_before(own)) @ tools
            off = np.abs(poses[:, :3, 3] - path.points[rows, :3]).max(axis=1)
            turned = np.abs(rotations(path.points[rows, 3:]) - poses[:, :3, :3]).max(axis=(1, 2))
            off = np.maximum(off, np.degrees(turned))
            if not off.max() <= ROUNDING:
                place = first + int(np.argmax(~(off <= ROUNDING)))
                law = "the tool is where axes and machine data put it"
                yield Violation(
                    None, law, f"{off.max():.4f} off at {path.times[place] / 1e6:.3f} s", "POS-11"
                )
                return


def _wrong_end(one: EndedMotion) -> Iterator[Violation]:
    """Yield components of the target that a motion does not reach [MOT-20]."""
    motion = one.motion
    target = dict(motion.target)
    if not one.stops or motion.is_relative or motion.angle is not None or motion.parts:
        return
    names = [axis.name for axis in one.machine.every_axis]
    is_free = one.machine.palletising is None
    wanted = {name: target[name] for name in names if name in target}
    for name, value in wanted.items():
        reached = float(one.ends[1, names.index(name)])
        if abs(reached - value) > NEAR_DEGREES and (is_free or name not in ("A4", "A5")):
            yield one.broken("a motion ends at its target", f"{name} at {reached:.4f}", "MOT-20")
    (pose,) = one.poses(one.ends[1:])
    for name, value in zip(_POINT, pose[:3, 3].tolist(), strict=True):
        if abs(target.get(name, value) - value) > NEAR_MM:
            yield one.broken("a motion ends at its target", f"{name} {value:.4f}", "MOT-20")
    turns = motion.kind in ("PTP", "SPTP") or motion.settings.orientation in ("#VAR", "#JOINT")
    if turns and all(name in target for name in _ANGLES) and _has_six(one.machine):
        other = matrix_of(Pose.of(0.0, 0.0, 0.0, *(target[name] for name in _ANGLES)))
        off = math.degrees(float(np.abs(other - pose)[:3, :3].max()))
        if off > NEAR_DEGREES:
            yield one.broken("a motion ends at its target", f"turned {off:.4f} beside it", "MOT-20")


def _not_at_rest(one: EndedMotion) -> Iterator[Violation]:
    """Yield a motion that is not at rest when it begins after, or ends with, an exact stop.

    At a distance of t from rest, an axis can have moved by at most j·t³/6, with the largest jerk j.
    """
    axes, times = one.machine.every_axis, one.path.times
    jerks = np.array([axis.dynamics.jerk if axis.dynamics else math.inf for axis in axes])
    for moment, rests in ((one.start, one.begins), (one.end, one.stops)):
        place = int(np.searchsorted(times, moment))
        if not rests or not 0 < place < len(times):
            continue
        before, after = (moment - times[place - 1]) / 1e6, (times[place] - moment) / 1e6
        most = jerks * (before**3 + after**3) / 6.0 * RATE_MARGIN + ROUNDING
        moved = np.abs(one.path.axes[place] - one.path.axes[place - 1])
        axis = int(np.argmax(moved - most))
        if moved[axis] > most[axis]:
            law = "the arm is at rest where a motion begins after an exact stop, and where it ends"
            actual = f"{axes[axis].name} moves by {moved[axis]:.4f} at {moment / 1e6:.3f} s"
            yield one.broken(law, actual)
            return


def _has_six(machine: MachineData) -> bool:
    """Return whether an arm can take any orientation."""
    return machine.palletising is None and len(machine.chain.joints) == ROBOT_AXES


def _wrong_posture(one: EndedMotion) -> Iterator[Violation]:
    """Yield a PTP that ends with another Status or Turn [POS-03, POS-04, POS-05, POS-07]."""
    target, machine = one.motion.target, one.machine
    if not one.stops or one.motion.kind not in ("PTP", "SPTP") or not {"X", "Y", "Z"} & set(target):
        return
    axes = one.ends[1].tolist()
    status = target.get("S")
    if status is not None and machine.own_chain is None and _has_six(machine):
        ahead = _wrist_ahead(machine, axes[:ROBOT_AXES])
        for bit, rule, value in (
            (1, "POS-03", -ahead),
            (2, "POS-04", axes[2] - machine.elbow),
            (4, "POS-05", -axes[4]),
        ):
            if abs(value) > NEAR_MM and (value > 0.0) is not bool(int(status) & bit):
                yield one.broken("a PTP has the Status of its target", f"bit of {bit}", rule)
    turn = target.get("T")
    for place, (axis, value) in enumerate(zip(machine.axes, axes, strict=False)):
        if turn is None or abs(value) < NEAR_DEGREES or machine.palletising is not None:
            continue
        other = value - math.copysign(360.0, value)
        if (value < 0.0) is not bool(int(turn) >> place & 1) and axis.lower <= other <= axis.upper:
            yield one.broken(
                "a PTP has the Turn of its target", f"{axis.name} {value:.3f}", "POS-07"
            )


def _wrist_ahead(machine: MachineData, axes: Sequence[float]) -> float:
    """Return how far the wrist centre is in front of axis 1 in mm, along the turned X axis."""
    chain = machine.chain
    wrist = Chain(chain.joints[:4], Pose.of())
    still = np.array([[0.0, *axes[1:]]])
    centre = np.linalg.inv(matrix_of(chain.joints[0].frame)) @ flanges_of(wrist, still)[0]
    return float(centre[0, 3])


def _wrong_circle(one: EndedMotion) -> Iterator[Violation]:
    """Yield a CIRC whose auxiliary or end point is not on its circle [MOT-20]."""
    motion = one.motion
    points = [motion.auxiliary or {}, motion.target]
    if motion.kind not in ("CIRC", "SCIRC") or motion.is_relative or not one.begins:
        return
    if not all(name in point for point in points for name in _POINT):
        return
    if motion.settings.placement.mode is not IpoMode.BASE:
        return
    wanted = np.array([[point[name] for name in _POINT] for point in points])
    rows = one.tools[:, :3, 3]
    start = one.poses(one.ends[:1])[0, :3, 3]
    try:
        off = float(from_circle(rows, start, *wanted).max(initial=0.0))
    except ValueError:
        return
    if off > NEAR_MM:
        law = "a CIRC is the circle through its start, auxiliary and end point"
        yield one.broken(law, f"{off:.4f} mm off", "MOT-20")


def _wrong_turn(one: EndedMotion) -> Iterator[Violation]:
    """Yield a circular angle at whose end the tool is turned otherwise than docs/motion.md says.

    The programmed orientation is that of the programmed end point: swivel and rotation grow evenly
    up to there, and on behind it.
    """
    motion, settings = one.motion, one.motion.settings
    points = [motion.auxiliary or {}, motion.target]
    if motion.angle is None or motion.is_relative or not (one.begins and one.stops):
        return
    if (settings.orientation, settings.circle) != ("#VAR", "#BASE") or not _has_six(one.machine):
        return
    if settings.placement.mode is not IpoMode.BASE or not {*_POINT, *_ANGLES} <= set(motion.target):
        return
    if not set(_POINT) <= set(points[0]):
        return
    first, last = one.poses(one.ends)
    middle, end = (np.array([point[name] for name in _POINT]) for point in points)
    centre, axis = circle_of(first[:3, 3], middle, end)
    ahead, onward = first[:3, 3] - centre, end - centre
    angle = math.atan2(float(np.cross(ahead, onward) @ axis), float(ahead @ onward)) % math.tau
    share = math.radians(motion.angle) / (angle - math.tau * (motion.angle < 0.0))
    wanted = matrix_of(Pose.of(0.0, 0.0, 0.0, *(motion.target[name] for name in _ANGLES)))
    off = np.abs(_turned(first[:3, :3], wanted[:3, :3], share) - last[:3, :3]).max()
    if math.degrees(float(off)) > NEAR_DEGREES:
        law = "the orientation of a circular angle is that of its place on the circle"
        yield one.broken(law, f"turned {math.degrees(float(off)):.4f} beside it")


def _turned(start: Array, end: Array, share: float) -> Array:
    """Return the orientation at a share of a swivel of the X axis and a rotation about it."""
    from scipy.spatial.transform import Rotation

    change = start.T @ end
    across = np.cross([1.0, 0.0, 0.0], change[:, 0])
    sine = max(float(np.linalg.norm(across)), 1e-12)
    swivel = across / sine * math.atan2(sine, change[0, 0])
    rest = Rotation.from_rotvec(-swivel).as_matrix() @ change
    twist = np.array([math.atan2(rest[2, 1], rest[1, 1]), 0.0, 0.0])
    first, second = Rotation.from_rotvec(share * np.stack((swivel, twist))).as_matrix()
    turned: Array = start @ first @ second
    return turned


def _missed_points(one: EndedMotion) -> Iterator[Violation]:
    """Yield a spline block that does not pass through one of its points [SPL-03]."""
    motion = one.motion
    parts = motion.parts if one.stops else motion.parts[:-1]  # a blend may cut the last part
    if motion.kind != "SPLINE" or motion.settings.placement.mode is not IpoMode.BASE:
        return
    known = (part for part in parts if not part.is_relative)
    targets = [target for part in known for target in (part.auxiliary, part.target) if target]
    rows = refined(one.path.times, one.path.axes, one.start, one.end, 8 * len(one.tools) + 2)
    points = one.poses(rows)[:, :3, 3]
    for target in targets:
        if all(name in target for name in _POINT):
            point = np.array([target[name] for name in _POINT])
            off = float(nearest(points[:-1], points[1:], point).min())
            if off > NEAR_MM:
                yield one.broken("a spline passes its points", f"{off:.4f} mm beside one", "SPL-03")


def _too_fast(one: EndedMotion) -> Iterator[Violation]:
    """Yield a path faster than programmed [MOT-04], or a PTP with a faster axis [MOT-02]."""
    motion, settings = one.motion, one.motion.settings
    if motion.kind == "PTP_SPLINE" or one.rows.stop - one.rows.start < 3:
        return
    times = one.path.times[one.rows]
    if motion.kind in ("PTP", "SPTP"):
        most = one.axis_rates
        if most is None:
            return
        share = np.abs(change_rates(times, one.path.axes[one.rows])).max(axis=0) / most[0]
        axis = int(np.argmax(share))
        if share[axis] > RATE_MARGIN:
            yield one.broken("axes keep $VEL_AXIS", f"{share[axis]:.1%} of it", "MOT-02")
        return
    is_fixed = settings.placement.mode is not IpoMode.BASE  # then the base has the speed [ORI-07]
    poses = np.linalg.inv(one.tools).astype(np.float64) if is_fixed else one.tools
    speeds = np.linalg.norm(change_rates(times, poses[:, :3, 3]), axis=1) / 1000.0
    every = [settings, *(part.settings for part in motion.parts if part.settings is not None)]
    most_path = min(max(each.velocity for each in every), one.machine.velocity.path)
    if settings.is_reduced:
        most_path = min(most_path, one.machine.t1_speed)
    if speeds.max() > most_path * RATE_MARGIN:
        yield one.broken("the tool keeps $VEL.CP", f"{speeds.max():.4f} m/s", "MOT-04")
    gains = np.abs(np.diff(speeds) / (np.diff(times)[1:] / 1e6))
    most_gain = min(max(each.acceleration for each in every), one.machine.acceleration.path)
    if gains.max() > most_gain * RATE_MARGIN:
        yield one.broken("the tool keeps $ACC.CP", f"{gains.max():.4f} m/s²", "MOT-04")


def blend_speed_violations(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield blends that are faster than both motions beside them.

    Between two paths of the tool that is said of the tool, which also keeps the acceleration of the
    machine data, and between two PTP of each axis.
    """
    for one, other in pairwise(motions):
        if one.stops or other.begins or not follows(one, other) or one.motion.kind == "PTP_SPLINE":
            continue
        first, last = np.searchsorted(one.path.times, [one.end, other.start])
        times, axes = one.path.times[first:last], one.path.axes[first:last]
        are_ptp = [each.motion.kind in ("PTP", "SPTP") for each in (one, other)]
        if len(times) < _FEWEST or are_ptp[0] is not are_ptp[1]:
            continue
        if are_ptp[0]:
            limits = [each.axis_rates for each in (one, other)]
            rates = np.abs(change_rates(times, axes)).max(axis=0)
            if limits[0] is not None and limits[1] is not None:
                share = float((rates / np.maximum(limits[0][0], limits[1][0])).max())
                if share > RATE_MARGIN:
                    law = "in a blend of PTP no axis is faster than beside it"
                    yield one.broken(law, f"{share:.1%} of it")
            continue
        placement = one.motion.settings.placement
        if placement != other.motion.settings.placement or placement.mode is not IpoMode.BASE:
            continue
        moves = change_rates(times, one.poses(axes)[:, :3, 3]) / 1000.0
        speed = float(np.linalg.norm(moves, axis=1).max())
        most = max(each.motion.settings.velocity for each in (one, other))
        most = max(
            most,
            *(
                part.settings.velocity
                for each in (one, other)
                for part in each.motion.parts
                if part.settings is not None
            ),
            0.0,
        )
        if speed > most * RATE_MARGIN:
            law = "in a blend the tool is no faster than beside it"
            yield one.broken(law, f"{speed:.4f} m/s", "BLD-15")
        gain = float(np.linalg.norm(change_rates(times[1:], moves), axis=1).max())
        if gain > one.machine.acceleration.path * RATE_MARGIN:
            yield one.broken("in a blend the tool keeps $ACC_MA.CP", f"{gain:.4f} m/s²")


def slow_blends(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield blends that slow both motions down further than docs/motion.md says of our simulator.

    Where the arm was faster before and is faster behind, an axis or the path nearly uses its speed,
    acceleration or jerk; and C_VEL keeps the speed between two lines that have the same.
    """
    for one, other in pairwise(motions):
        sides = one, other
        are_ptp = all(each.motion.kind in ("PTP", "SPTP") for each in sides)
        are_lines = all(each.motion.kind in ("LIN", "SLIN") for each in sides)
        if one.stops or other.begins or not follows(one, other) or not (are_ptp or are_lines):
            continue
        first, last = np.searchsorted(one.path.times, [one.end, other.start])
        own, next_own = (each.axis_rates for each in sides)
        if last - first < _MANY or own is None or next_own is None or _is_uneven(one, other):
            continue
        times, rows = one.path.times[first:last], one.path.axes[first:last]
        before, behind = (_shares_of_speed(each, are_ptp=are_ptp) for each in sides)
        poses, used = one.poses(rows), 0.0
        for order, most in enumerate(np.maximum(own, next_own)):
            rows = change_rates(times[order:], rows)
            used = max(used, float((np.abs(rows) / most).max()))
        if are_lines:
            moves, settings = change_rates(times, poses[:, :3, 3]) / 1000.0, one.motion.settings
            speeds = np.linalg.norm(moves, axis=1)
            gain = float(np.linalg.norm(change_rates(times[1:], moves), axis=1).max())
            used = max(used, gain / settings.acceleration, speeds.max() / settings.velocity)
            is_steady = speeds.min() > _STEADY * speeds.max()
            is_fast = min(before.max(), behind.max()) > _FULL
            if one.motion.criteria[0] == "C_VEL" and is_fast and not is_steady:
                yield one.broken(
                    "C_VEL keeps the speed between two lines", f"{speeds.min():.4f} m/s"
                )
        is_slowed = before[-1] < _SLOWED * before.max() and behind[0] < _SLOWED * behind.max()
        if is_slowed and used < (_USED_BY_AXES if are_ptp else _USED_BY_TOOL):
            law = "a blend is no slower than an axis or the path makes it"
            yield one.broken(law, f"{used:.1%} of them")


def _is_uneven(one: EndedMotion, other: EndedMotion) -> bool:
    """Return whether two motions differ in frames or speed, or have those of T1 or a fixed tool."""
    first, second = one.motion.settings, other.motion.settings
    return (
        first.placement != second.placement
        or (first.velocity, first.acceleration) != (second.velocity, second.acceleration)
        or first.is_reduced
        or first.placement.mode is not IpoMode.BASE
    )


def _shares_of_speed(one: EndedMotion, *, are_ptp: bool) -> Array:
    """Return the shares of its programmed speed that a motion has between its samples, or 0."""
    rows = one.path.axes[one.rows]
    if len(rows) < _FEWEST or one.axis_rates is None:
        return np.zeros(1)
    times = one.path.times[one.rows]
    if are_ptp:
        return np.asarray((np.abs(change_rates(times, rows)) / one.axis_rates[0]).max(axis=1))
    moves = change_rates(times, one.tools[:, :3, 3])
    return np.asarray(np.linalg.norm(moves, axis=1) / (one.motion.settings.velocity * 1000.0))
