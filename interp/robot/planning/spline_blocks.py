"""Spline blocks as tracks: each segment becomes a piece, with the speeds that its ranges require.

A block is planned as a whole [SPL-01]. Its points are given in the frames of the block; speeds can
differ between segments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from interp.robot.arm import Motion, Settings, SplinePart
from interp.robot.kinematics.kinematics import Array, matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.solution_choice import check_path
from interp.robot.path.axis_path import splined
from interp.robot.path.circle import circle_through
from interp.robot.path.programmed_targets import Programmed
from interp.robot.path.spline import Knot, Segment, chains_of, pose_paths_of
from interp.robot.planning.junctions import STOP, Junction
from interp.robot.planning.spline_ranges import with_ranges
from interp.robot.planning.tracks import STILL, Piece, Track, Tracks
from interp.values.faults import Fault
from interp.values.poses import Pose

#: Of u, where a spline of axes is looked at for software limits: it may swing beyond its points.
_CLOSE = np.linspace(0.0, 1.0, 257)
#: Segments of one block; where the limit of a controller lies is not published.
_MOST_SEGMENTS = 1000


def block(tracks: Tracks, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
    """Return the track of a spline block, and the target to which it leads.

    Raises `Fault`: 2359 or 2380 for a segment of the wrong type [SPL-04], 3273 for too many
    segments, 3214 to 3217 if a constant speed cannot be kept [SPL-05], and as `Tracks.track` does.
    """
    is_ptp = motion.kind == "PTP_SPLINE"
    for part in motion.parts:
        if (part.kind == "SPTP") is not is_ptp:
            text = f"{part.kind} is not allowed in this spline block"
            raise Fault("spline", text, number=2380 if is_ptp else 2359, rules=("SPL-04",))
    if len(motion.parts) > _MOST_SEGMENTS:
        raise Fault("spline", "the spline block is too long", number=3273, rules=("SPL-06",))
    if not motion.parts:
        still = tracks.still(before.axes, motion.settings)
        return Track(motion, (still,), tracks.limits), before
    if is_ptp:
        return _ptp_block(tracks, motion, before)
    return _cp_block(tracks, motion, before)


# ------------------------------------------------------------------------------------- CP blocks


def _cp_block(tracks: Tracks, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
    """SPL, SLIN and SCIRC."""
    settings = motion.settings
    placement = settings.placement
    knot = _knot(placement.in_path(before.pose_in(placement)))
    target, segments, externals = before, [], [before.axes[ROBOT_AXES:]]
    for part in motion.parts:
        components = target.components_of(part.target, placement, part.is_relative, part.reference)
        following = _knot(placement.in_path(Pose.of(*components)))
        if (part.settings or settings).orientation == "#CONSTANT":
            following = Knot(following.position, knot.rotation)
        segment = _segment(part, knot, following, target, settings)
        externals.append(target.externals(part.target, part.is_relative))
        axes = np.concatenate((target.axes[:ROBOT_AXES], externals[-1]))
        target, knot = target.reached(axes, components, placement), segment.end
        segments.append(segment)
    pieces = _pieces(tracks, motion, segments, np.array(externals), before.axes)
    track = Track(motion, with_ranges(motion, pieces), tracks.limits)
    axes = pieces[-1].curve.end
    is_at_target = motion.parts[-1].angle is None
    point = target.components if is_at_target else None
    return track, before.reached(axes, point, placement)


def _segment(
    part: SplinePart, start: Knot, end: Knot, before: Programmed, settings: Settings
) -> Segment:
    """Return a segment of a block; SCIRC ends on its circle at the angle that it states."""
    if part.kind != "SCIRC":
        return Segment(part.kind, start, end)
    placement = settings.placement
    components = before.components_of(
        part.auxiliary or {}, placement, part.is_relative, part.reference
    )
    middle = placement.in_path(Pose.of(*components))
    circle = circle_through(start.position, np.array(middle.position), end.position, part.angle)
    (place,) = circle.at(np.ones(1))
    return Segment(part.kind, start, Knot(place, end.rotation), circle)


def _pieces(
    tracks: Tracks, motion: Motion, segments: Sequence[Segment], externals: Array, start: Array
) -> tuple[Piece, ...]:
    """Return a piece for each segment, continuous from the axes at the start on."""
    pieces: list[Piece] = []
    axes = start[:ROBOT_AXES]
    number = 0
    for chain in chains_of(segments):
        pose_paths = pose_paths_of(chain)
        travelled = externals[number : number + len(chain) + 1]
        ways = splined([pose_path.length for pose_path in pose_paths], travelled)
        for place, (pose_path, others) in enumerate(zip(pose_paths, ways, strict=True)):
            settings = motion.parts[number].settings or motion.settings
            # Wrist axes in step would change their speed at each point, so they are not [ORI-03].
            settings = replace(settings, orientation="#VAR")
            length = max(pose_path.length, *np.degrees(pose_path.angles))
            if (
                length < STILL
                and np.abs(travelled[place + 1] - travelled[place]).max(initial=0.0) < STILL
            ):
                piece = tracks.still(np.concatenate((axes, travelled[place])), settings)
            else:
                check_path(tracks.machine.externals, others.axes(_CLOSE))
                piece = tracks.along(pose_path, axes, others, "SPL", settings)
                if place:
                    gear = pose_paths[place - 1].length / pose_path.length
                    piece = replace(piece, junction=Junction(gear))
                axes = piece.curve.end[:ROBOT_AXES]
            pieces.append(piece)
            number += 1
    return tuple(pieces)


def _knot(pose: Pose) -> Knot:
    matrix = matrix_of(pose)
    return Knot(matrix[:3, 3], matrix[:3, :3])


# ------------------------------------------------------------------------------------ PTP blocks


def _ptp_block(tracks: Tracks, motion: Motion, before: Programmed) -> tuple[Track, Programmed]:
    """Return a spline of all axes through the targets, over the times of the leading axes."""
    target, points, spans, is_singular = before, [before.axes], [], False
    for part in motion.parts:
        own = part.settings or motion.settings
        own_motion = replace(motion, is_relative=part.is_relative, reference=part.reference)
        goal = target.goal(own_motion, part.target, motion.settings.placement)
        is_singular = is_singular or goal.is_singular
        travel = np.abs(goal.axes - points[-1])
        is_still = bool(travel.max() < STILL)
        spans.append(0.0 if is_still else float((travel / tracks.programmed(own).velocity).max()))
        points.append(points[-1] if is_still else goal.axes)
        target = target.reached(goal.axes, None, motion.settings.placement)
    pieces: list[Piece] = []
    settings = [part.settings or motion.settings for part in motion.parts]
    for moves, group in groupby(range(len(spans)), key=lambda place: spans[place] > 0.0):
        first, *others = group
        last = first + len(others) + 1
        if not moves:
            pieces += (tracks.still(points[place], settings[place]) for place in range(first, last))
            continue
        paths = splined(spans[first:last], np.array(points[first : last + 1]))
        for place, path in enumerate(paths, start=first):
            check_path(tracks.machine.every_axis, path.axes(_CLOSE))
            junction = Junction(spans[place - 1] / spans[place]) if place > first else STOP
            pieces.append(tracks.axis_piece(path, settings[place], junction))
    track = Track(motion, tuple(pieces), tracks.programmed(settings[-1]), is_singular)
    return track, target
