"""Laws that hold for every motion of every program: it does what was programmed.

A motion ends at its target, with the Status and Turn of the target. A CIRC is the programmed
circle. Nothing is faster than programmed. The tool is where axes and machine data put it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Final

import numpy as np

from conformance.evaluation.laws import Deviations, Laws, Run, free_motions, motions, paths
from conformance.evaluation.motions import (
    ANGLES,
    NEAR_DEGREES,
    NEAR_MM,
    POINT,
    ROUNDING,
    Array,
    EndedMotion,
    flanges_of,
    point_of,
)
from conformance.evaluation.path_geometry import (
    RATE_MARGIN,
    change_rates,
    circle_of,
    from_circle,
    nearest,
    refined,
    rotations,
)
from interp.robot.kinematics.chain import Chain
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.values.poses import Pose

LAWS: Final = Laws()


@LAWS.law("the tool is where axes and machine data put it", "POS-11", of=paths)
def _wrong_tool_pose(run: Run) -> Deviations:
    path = run.path
    flanges = flanges_of(run.machine.chain, path.axes[:, :ROBOT_AXES])
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
                yield None, f"{off.max():.4f} off at {path.times[place] / 1e6:.3f} s"


# ------------------------------------------------------------------------------------- targets


@LAWS.law("a motion ends at its target", "MOT-20", of=motions)
def _wrong_end(one: EndedMotion) -> Deviations:
    motion = one.motion
    target = motion.target
    if not one.stops or motion.is_relative or motion.angle is not None or motion.parts:
        return
    is_free = one.machine.palletising is None
    for axis, reached in zip(one.machine.every_axis, one.ends[1].tolist(), strict=False):
        off = abs(reached - target.get(axis.name, reached))
        if off > NEAR_DEGREES and (is_free or axis.name not in ("A4", "A5")):
            yield f"{axis.name} at {reached:.4f}"
    (pose,) = one.poses(one.ends[1:])
    for name, value in zip(POINT, pose[:3, 3].tolist(), strict=True):
        if abs(target.get(name, value) - value) > NEAR_MM:
            yield f"{name} {value:.4f}"
    turns = one.is_ptp or motion.settings.orientation in ("#VAR", "#JOINT")
    if turns and all(name in target for name in ANGLES) and one.has_six:
        other = matrix_of(Pose.of(0.0, 0.0, 0.0, *(target[name] for name in ANGLES)))
        off = math.degrees(float(np.abs(other - pose)[:3, :3].max()))
        if off > NEAR_DEGREES:
            yield f"turned {off:.4f} beside it"


def _has_posture(one: EndedMotion) -> bool:
    """Return whether a motion is a PTP to a point, at which it stops."""
    return one.stops and one.is_ptp and not set(POINT).isdisjoint(one.motion.target)


def _wrong_status(
    bit: int, value_of: Callable[[EndedMotion], float], one: EndedMotion
) -> Deviations:
    """Yield a bit of Status that contradicts the sign of what it is about."""
    status = one.motion.target.get("S")
    if _has_posture(one) and status is not None and one.machine.own_chain is None and one.has_six:
        value = value_of(one)
        if abs(value) > NEAR_MM and (value > 0.0) is not bool(int(status) & bit):
            yield f"bit of {bit}"


def _wrist_behind(one: EndedMotion) -> float:
    """Return how far the wrist centre is behind axis 1 in mm, along the turned X axis."""
    chain = one.machine.chain
    wrist = Chain(chain.joints[:4], Pose.of())
    still = one.ends[1:, :ROBOT_AXES].copy()
    still[:, 0] = 0.0
    centre = np.linalg.inv(matrix_of(chain.joints[0].frame)) @ flanges_of(wrist, still)[0]
    return -float(centre[0, 3])


for _bit, _rule, _value in (
    (1, "POS-03", _wrist_behind),
    (2, "POS-04", lambda one: float(one.ends[1, 2]) - one.machine.elbow),
    (4, "POS-05", lambda one: -float(one.ends[1, 4])),
):
    LAWS.law("a PTP has the Status of its target", _rule, of=motions)(
        partial(_wrong_status, _bit, _value)
    )


@LAWS.law("a PTP has the Turn of its target", "POS-07", of=motions)
def _wrong_axis_turn(one: EndedMotion) -> Deviations:
    turn = one.motion.target.get("T")
    if turn is None or not _has_posture(one) or one.machine.palletising is not None:
        return
    for place, (axis, value) in enumerate(
        zip(one.machine.axes, one.ends[1].tolist(), strict=False)
    ):
        other = value - math.copysign(360.0, value)
        is_wrong = (value < 0.0) is not bool(int(turn) >> place & 1)
        if abs(value) >= NEAR_DEGREES and is_wrong and axis.lower <= other <= axis.upper:
            yield f"{axis.name} {value:.3f}"


@LAWS.law("a CIRC is the circle through its start, auxiliary and end point", "MOT-20", of=motions)
def _wrong_circle(one: EndedMotion) -> Deviations:
    motion = one.motion
    middle, end = point_of(motion.auxiliary), point_of(motion.target)
    if motion.kind not in ("CIRC", "SCIRC") or motion.is_relative or not one.begins:
        return
    if middle is None or end is None or not one.is_in_base:
        return
    try:
        off = from_circle(one.tools[:, :3, 3], one.points(one.ends[:1])[0], middle, end)
    except ValueError:  # collinear
        return
    if off.max(initial=0.0) > NEAR_MM:
        yield f"{off.max():.4f} mm off"


@LAWS.law("the orientation of a circular angle is that of its place on the circle", of=motions)
def _wrong_turn(one: EndedMotion) -> Deviations:
    """Yield that the tool is turned otherwise at the end than docs/motion.md says.

    The programmed orientation is that of the programmed end point: swivel and rotation grow evenly
    up to there, and on behind it.
    """
    motion, settings = one.motion, one.motion.settings
    middle, end = point_of(motion.auxiliary), point_of(motion.target)
    if motion.angle is None or motion.is_relative or not (one.begins and one.stops):
        return
    if (settings.orientation, settings.circle) != ("#VAR", "#BASE") or not one.has_six:
        return
    if not one.is_in_base or middle is None or end is None or not set(ANGLES) <= set(motion.target):
        return
    first, last = one.poses(one.ends)
    centre, axis = circle_of(first[:3, 3], middle, end)
    ahead, onward = first[:3, 3] - centre, end - centre
    angle = math.atan2(float(np.cross(ahead, onward) @ axis), float(ahead @ onward)) % math.tau
    share = math.radians(motion.angle) / (angle - math.tau * (motion.angle < 0.0))
    wanted = matrix_of(Pose.of(0.0, 0.0, 0.0, *(motion.target[name] for name in ANGLES)))
    off = np.abs(_turned(first[:3, :3], wanted[:3, :3], share) - last[:3, :3]).max()
    if math.degrees(float(off)) > NEAR_DEGREES:
        yield f"turned {math.degrees(float(off)):.4f} beside it"


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


@LAWS.law("a spline passes its points", "SPL-03", of=motions)
def _missed_points(one: EndedMotion) -> Deviations:
    motion = one.motion
    parts = motion.parts if one.stops else motion.parts[:-1]  # a blend may cut the last part
    if motion.kind != "SPLINE" or not one.is_in_base:
        return
    known = (part for part in parts if not part.is_relative)
    targets = [point_of(target) for part in known for target in (part.auxiliary, part.target)]
    rows = refined(one.path.times, one.path.axes, one.start, one.end, 8 * len(one.tools) + 2)
    points = one.points(rows)
    for point in (target for target in targets if target is not None):
        off = float(nearest(points[:-1], points[1:], point).min())
        if off > NEAR_MM:
            yield f"{off:.4f} mm beside one"


# ------------------------------------------------------------------------------- rest and speed


@LAWS.law(
    "the arm is at rest where a motion begins after an exact stop, and where it ends",
    of=free_motions,
)
def _not_at_rest(one: EndedMotion) -> Deviations:
    """At a distance of t from rest, an axis can have moved by at most j·t³/6, with its jerk j."""
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
            yield f"{axes[axis].name} moves by {moved[axis]:.4f} at {moment / 1e6:.3f} s"
            return


def _judged(one: EndedMotion) -> bool:
    """Return whether a motion has enough samples for its speed."""
    return one.motion.kind != "PTP_SPLINE" and len(one.times) >= 3


@LAWS.law("axes keep $VEL_AXIS", "MOT-02", of=free_motions)
def _too_fast_axis(one: EndedMotion) -> Deviations:
    if one.is_ptp and one.axis_rates is not None and _judged(one):
        rates = np.abs(change_rates(one.times, one.axes)).max(axis=0)
        share = float((rates / one.axis_rates[0]).max())
        if share > RATE_MARGIN:
            yield f"{share:.1%} of it"


@LAWS.law("the tool keeps $VEL.CP", "MOT-04", of=free_motions)
def _too_fast(one: EndedMotion) -> Deviations:
    if not one.is_ptp and _judged(one):
        most = min(max(each.velocity for each in one.settings), one.machine.velocity.path)
        if one.motion.settings.is_reduced:
            most = min(most, one.machine.t1_speed)
        if one.speeds.max() > most * RATE_MARGIN:
            yield f"{one.speeds.max():.4f} m/s"


@LAWS.law("the tool keeps $ACC.CP", "MOT-04", of=free_motions)
def _too_steep(one: EndedMotion) -> Deviations:
    if not one.is_ptp and _judged(one):
        gains = np.abs(np.diff(one.speeds) / (np.diff(one.times)[1:] / 1e6))
        most = min(max(each.acceleration for each in one.settings), one.machine.acceleration.path)
        if gains.max() > most * RATE_MARGIN:
            yield f"{gains.max():.4f} m/s²"
