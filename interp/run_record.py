"""The record of a run as plain data, ready for JSON, for the page of a run and for notebooks."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any, Final, NotRequired, TypedDict

import numpy as np
import numpy.typing as npt

from interp.controller.motion.motion_queue import PlannedPoint
from interp.controller.state.trace import TraceEvent
from interp.port.requests import At
from interp.program.load import CheckedProgram
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.simulation.links import hand_of, links_of
from interp.robot.simulation.observations import ObservationRecord
from interp.robot.simulation.scene import Scene
from interp.robot.simulation.tracking import PathRecord
from interp.session import RunResult, RunSetup
from interp.values.poses import Pose

#: How many times a branch of one line is recorded.
_MOST_BRANCHES: Final = 1000

Array = npt.NDArray[np.float64]


class OutcomeRecord(TypedDict):
    """The end of the run; ``at`` is ``file:line`` or empty."""

    kind: str
    time: int
    text: str
    at: str


class FileRecord(TypedDict):
    """A source file that the trace names."""

    path: str
    text: str


class LimitsRecord(TypedDict):
    """Software limit switches, speeds, accelerations and torques of the axes; speed of the tool.

    0 if the machine data has no limit.
    """

    axes: list[list[float]]
    axis_speeds: list[float]
    axis_accelerations: list[float]
    speed: float
    axis_torques: list[float]


class PointRecord(TypedDict):
    """The end point of a motion; ``place`` is empty if it is unknown."""

    motion: int
    kind: str
    at: str
    place: list[float]
    blended: bool


class SkippedRecord(TypedDict):
    """A line ``file:line`` that failed and was skipped, with the reason of its first failure."""

    at: str
    text: str


class ShapeRecord(TypedDict):
    """A capsule between two points of its link; a ball if both are the same."""

    start: list[float]
    end: list[float]
    radius: float
    colour: list[float]


class LinkRecord(TypedDict):
    """A body of the arm.

    ``parent`` is the index of the link that carries it, -1 for the world. ``frame`` is its frame
    relative to that link with its axis at zero, as sixteen numbers row by row. ``joint`` is the
    index of its axis in the columns of the path, -1 if it does not move. The axis turns the body
    about ``axis`` of its own frame by degrees, or shifts it along ``axis`` by mm if ``linear``.
    """

    name: str
    parent: int
    frame: list[float]
    joint: int
    axis: list[float]
    linear: bool
    shapes: list[ShapeRecord]


class ObjectRecord(TypedDict):
    """An object of the scene; ``frame`` is its centre in $WORLD, or on the flange if ``held``.

    ``shape`` is box, cylinder, sphere or mesh. ``edges`` are those of the bounding box in mm; 0 for
    a mesh, whose geometry is in a file.
    """

    name: str
    shape: str
    frame: list[float]
    edges: list[float]
    held: bool


class ToolRecord(TypedDict):
    """$TOOL on the flange and $BASE in $WORLD from time ``t``, sixteen numbers row by row each."""

    t: int
    tool: list[float]
    base: list[float]


class ArmRecord(TypedDict):
    """The parts of the arm, for drawing it; in mm, relative to $WORLD.

    ``flange`` is the flange relative to the link ``hand``. ``tools`` are the frames in force; empty
    if no set-points were sent.
    """

    axes: list[str]
    links: list[LinkRecord]
    hand: int
    flange: list[float]
    tools: list[ToolRecord]
    objects: list[ObjectRecord]


class PathSamples(TypedDict):
    """Set-points in columns; ``tool_measured`` is present if the robot measures.

    ``axes`` has a column for each axis in degrees or mm, robot axes first. ``axis_speeds`` and
    ``axis_accelerations`` have the same columns, as difference quotients of the set-points. A
    change of the tool does not count as speed. ``axis_torques``, in Nm or N, are those that the
    set-points require; present if the robot has masses.
    """

    t: list[int]
    axes: list[list[float]]
    tool: list[list[float]]
    speed: list[float]
    axis_speeds: list[list[float]]
    axis_accelerations: list[list[float]]
    tool_measured: NotRequired[list[list[float]]]
    axis_torques: NotRequired[list[list[float]]]


class DeviationRecord(TypedDict):
    """The distance of the measured tool from its set-point in mm."""

    most: float
    mean: float


class RunRecord(TypedDict):
    """A run; ``path`` and ``deviation`` are present if set-points were sent to a robot."""

    main: str
    executor: str
    robot: str
    profile: str
    machine: str
    outcome: OutcomeRecord
    events: list[dict[str, Any]]
    files: list[FileRecord]
    limits: LimitsRecord
    arm: ArmRecord
    points: list[PointRecord]
    skipped: list[SkippedRecord]
    observations: list[ObservationRecord]
    path: NotRequired[PathSamples]
    deviation: NotRequired[DeviationRecord | None]


def record_of(run: RunResult, program: CheckedProgram, setup: RunSetup) -> RunRecord:
    """Return outcome, trace, sources, path, limits and programmed points of a run.

    Times are in µs, lengths in mm in $WORLD, axis speeds in deg/s or mm/s, axis accelerations in
    deg/s² or mm/s², and tool speeds in m/s. If a line takes the same branch again and again, as in
    a waiting loop, only the first thousand times are recorded; the trace has them all.
    """
    outcome = run.outcome
    events = [json.loads(event.line()) for event in _events(run.events)]
    blended = {event["motion"] for event in events if event["kind"] == "blend_apex"}
    record: RunRecord = {
        "main": program.main.module.path,
        "executor": setup.executor,
        "robot": setup.robot,
        "profile": setup.profile.name,
        "machine": run.machine.name,
        "outcome": {
            "kind": outcome.ending,
            "time": outcome.time,
            "text": "" if outcome.error is None else str(outcome.error),
            "at": "" if outcome.at is None else f"{outcome.at.file}:{outcome.at.line}",
        },
        "events": events,
        "files": _files(
            program, {event["at"].rpartition(":")[0] for event in events if event["at"]}
        ),
        "limits": _limits(run.machine),
        "arm": _arm(run.machine, run.path, setup.scene or Scene()),
        "skipped": [
            {"at": f"{file}:{line}", "text": str(error)}
            for (file, line), error in run.controller.skipped.items()
        ],
        "observations": [one.record() for one in run.observations],
        "points": [
            {
                "motion": point.number,
                "kind": point.kind,
                "at": f"{point.at.file}:{point.at.line}",
                "place": tip_of(point, run.machine),
                "blended": point.number in blended,
            }
            for point in run.controller.points
        ],
    }
    if run.path is not None:
        record["path"] = _path(run.path)
        record["deviation"] = _deviation(run.path)
    return record


def _events(events: Iterable[TraceEvent]) -> Iterator[TraceEvent]:
    """Yield the events, without later repetitions of the same branch of a line."""
    taken: Counter[tuple[At | None, Any]] = Counter()
    for event in events:
        if event.kind == "branch":
            way = (event.at, event.fields["way"])
            taken[way] += 1
            if taken[way] > _MOST_BRANCHES:
                continue
        yield event


def _files(program: CheckedProgram, named: set[str]) -> list[FileRecord]:
    """Return the sources that the trace names, the main file first."""
    units = [program.main, *(unit for unit in program.units.values() if unit is not program.main)]
    return [
        {
            "path": unit.source.name if unit.source.name in named else unit.module.path,
            "text": unit.source.text,
        }
        for unit in units
        if unit is program.main or {unit.module.path, unit.source.name} & named
    ]


def tip_of(point: PlannedPoint, machine: MachineData) -> list[float]:
    """Return X, Y, Z of the tool in $WORLD in mm at the end of a motion; empty if unknown."""
    if point.position is None:
        return []
    foot = machine.foot(point.position.axes[len(machine.axes) :])
    tip = foot @ point.position.flange @ point.tool
    return [round(value, 4) for value in tip.position]


def _arm(machine: MachineData, path: PathRecord | None, scene: Scene) -> ArmRecord:
    frames = () if path is None else path.placements
    return {
        "axes": [axis.name for axis in machine.every_axis],
        "links": [
            {
                "name": link.name,
                "parent": -1 if link.parent is None else link.parent,
                "frame": _numbers(link.frame),
                "joint": -1 if link.joint is None else link.joint,
                "axis": list(link.axis),
                "linear": link.is_linear,
                "shapes": [
                    {
                        "start": [round(value, 2) for value in shape.start],
                        "end": [round(value, 2) for value in shape.end],
                        "radius": round(shape.radius, 2),
                        "colour": [float(part) for part in shape.colour.split()],
                    }
                    for shape in link.shapes
                ],
            }
            for link in links_of(machine)
        ],
        "hand": hand_of(links_of(machine)),
        "flange": _numbers(machine.chain.end),
        "tools": [
            {"t": time, "tool": _numbers(placement.tool), "base": _numbers(placement.base)}
            for time, placement in frames
        ],
        "objects": [
            {
                "name": one.name,
                "shape": one.shape,
                "frame": _numbers(one.frame),
                "edges": list(one.edges),
                "held": one.is_held,
            }
            for one in scene.objects
        ],
    }


def _numbers(pose: Pose) -> list[float]:
    return [round(value, 9) + 0.0 for row in pose.matrix for value in row]


def _limits(machine: MachineData) -> LimitsRecord:
    axes = machine.every_axis
    dynamics = [axis.dynamics for axis in axes]
    torques = (*machine.torques, *(math.inf,) * (len(axes) - len(machine.torques)))
    return {
        "axes": [[axis.lower, axis.upper] for axis in axes],
        "axis_speeds": [0.0 if one is None else one.velocity for one in dynamics],
        "axis_accelerations": [0.0 if one is None else one.acceleration for one in dynamics],
        "speed": machine.velocity.path,
        "axis_torques": [torque if torque < math.inf else 0.0 for torque in torques],
    }


def _path(path: PathRecord) -> PathSamples:
    seconds = path.times / 1e6
    speeds = accelerations = np.zeros_like(path.axes)
    tip_speed = np.zeros(len(path.times))
    if len(path.times) > 1:
        speeds = np.gradient(path.axes, seconds, axis=0)
        accelerations = np.gradient(speeds, seconds, axis=0)
        for rows in _same_tool(path):
            if rows.stop - rows.start > 1:
                steps: Array = np.gradient(path.tips[rows], seconds[rows], axis=0)
                tip_speed[rows] = np.linalg.norm(steps, axis=1) / 1000
    record: PathSamples = {
        "t": path.times.tolist(),
        "axes": [column.round(4).tolist() for column in path.axes.T],
        "tool": path.tips.round(4).tolist(),
        "speed": tip_speed.round(6).tolist(),
        "axis_speeds": [column.round(4).tolist() for column in speeds.T],
        "axis_accelerations": [column.round(4).tolist() for column in accelerations.T],
    }
    if path.tips_measured is not None:
        record["tool_measured"] = path.tips_measured.round(4).tolist()
    if path.torques is not None:
        record["axis_torques"] = [column.round(2).tolist() for column in path.torques.T]
    return record


def _same_tool(path: PathRecord) -> Iterator[slice]:
    """Yield rows with the same tool: a change of the tool moves the tip without a motion."""
    changes = [
        time for (_, before), (time, now) in pairwise(path.placements) if before.tool != now.tool
    ]
    bounds = [0, *np.searchsorted(path.times, changes).tolist(), len(path.times)]
    for first, last in pairwise(bounds):
        yield slice(first, last)


def _deviation(path: PathRecord) -> DeviationRecord | None:
    """Return the distance of the measured tool from its set-point; ``None`` if not measured."""
    if path.tips_measured is None:
        return None
    off = np.linalg.norm(path.tips_measured - path.tips, axis=1)
    return {"most": float(off.max()), "mean": float(off.mean())}
