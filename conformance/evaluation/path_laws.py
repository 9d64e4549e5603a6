"""Laws of the path of set-points: limits of the axes, and the shape of each motion."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.laws import Deviations, Laws, Run, Subjects, paths
from conformance.evaluation.motions import stages
from conformance.evaluation.observation import Event
from conformance.evaluation.path_geometry import (
    RATE_MARGIN,
    from_circle,
    from_line,
    from_synchronous,
    rates_of,
)
from interp.robot.kinematics.placement import IpoMode

Array = npt.NDArray[np.float64]

LAWS: Final = Laws()
#: The smallest number of rows of a path, and of a motion, that is checked.
_FEWEST: Final = 4
#: mm of the tool and degrees of an axis by which rounding may put a set-point off its path.
_NEAR_MM, _NEAR_DEGREES = 0.002, 0.0005
_LIMITS: Final = "set-points keep the limits of the axes"


def _paths(run: Run) -> Subjects[Run]:
    return (row for row in paths(run) if len(run.path.times) >= _FEWEST)


def _at(run: Run, time: int, actual: str) -> tuple[Event | None, str]:
    """Return a deviation at the motion that runs at a time in µs."""
    begun = [one for one in run.seen.of_kind("motion_start") if (one.time or 0) <= time]
    return begun[-1] if begun else None, f"{actual} at {time / 1e6:.3f} s"


def _beyond(order: int, what: str, run: Run) -> Deviations:
    path = run.path
    axes = run.machine.every_axis[: path.axes.shape[1]]
    most = [getattr(one.dynamics, what) if one.dynamics else math.inf for one in axes]
    share = np.abs(rates_of(path.times, path.axes)[order]) / np.array(most)
    row, axis = np.unravel_index(int(np.argmax(share)), share.shape)
    if not share[row, axis] <= RATE_MARGIN:
        actual = f"{axes[axis].name} has {share[row, axis] * 100:.1f} % of its {what}"
        yield _at(run, int(path.times[row]), actual)


for _order, (_what, _rule) in enumerate(
    (("velocity", "MOT-06"), ("acceleration", "MOT-02"), ("jerk", ""))
):
    LAWS.law(_LIMITS, _rule, of=_paths)(partial(_beyond, _order, _what))


@LAWS.law(_LIMITS, "MOT-15", of=_paths)
def _outside(run: Run) -> Deviations:
    path = run.path
    for one, places in zip(run.machine.every_axis, path.axes.T, strict=False):
        outside = ~((places >= one.lower - _NEAR_DEGREES) & (places <= one.upper + _NEAR_DEGREES))
        if outside.any():
            first = int(np.argmax(outside))
            actual = f"{one.name} stands at {places[first]:.3f}"
            yield _at(run, int(path.times[first]), actual)


@LAWS.law("the arm stands where no motion is under way", of=_paths)
def _drift(run: Run) -> Deviations:
    """Up to a BRAKE or RESUME."""
    path = run.path
    since: int | None = 0
    for one in run.seen.of_kind("motion_start", "motion_end", "brake", "resume", "end"):
        if one.kind == "motion_end":
            since = one.time
        elif since is not None and one.time is not None:
            rows = path.axes[(path.times >= since) & (path.times <= one.time)]
            most = float(np.ptp(rows, axis=0).max()) if len(rows) else 0.0
            if not most <= _NEAR_DEGREES:
                yield one, f"an axis moves by {most:.4f} before it"
            since = None
        if one.kind in ("brake", "resume"):
            return


# ------------------------------------------------------------------------------------- shapes


@dataclass(frozen=True, slots=True)
class _Part:
    """The samples of a motion between its blends: its start in µs, kind, points (n, 3) and axes."""

    start: int
    kind: str
    points: Array
    axes: Array


def _parts(run: Run) -> Subjects[_Part]:
    """Yield the parts of ended motions in no blend during which nothing changes their shape.

    With a fixed tool, the base relative to the tool has the shape [ORI-07]; it is not checked.
    """
    path = run.seen.path
    if path is None or any(placement.mode is not IpoMode.BASE for _, placement in path.placements):
        return
    # A change of frames, or a motion of an interrupt routine in between, changes the shape.
    changes = [time for time, _ in path.placements]
    changes += [one.time for one in run.seen.of_kind("motion_start") if one.time is not None]
    for its in stages(run.seen).values():
        if "motion_start" not in its or "motion_end" not in its:
            continue
        start = its["motion_start"]
        first = its.get("blend_end", start).time
        last = its.get("blend_start", its["motion_end"]).time
        if first is None or last is None or any(first < time < last for time in changes):
            continue
        kept = (path.times >= first) & (path.times <= last)
        if kept.sum() >= _FEWEST:
            kind = str(start.fields.get("motion_kind")).removesuffix("_REL")
            part = _Part(start.time or 0, kind, path.points[kept][:, :3], path.axes[kept])
            yield start, part


def _misshapen(
    kinds: tuple[str, str], off_of: Callable[[_Part], float], most: float, part: _Part
) -> Deviations:
    off = off_of(part) if part.kind in kinds else 0.0
    if not off <= most:
        yield f"{off:.4f} off at {part.start / 1e6:.3f} s"


def _off_line(part: _Part) -> float:
    return float(from_line(part.points, part.points[0], part.points[-1]).max())


def _off_circle(part: _Part) -> float:
    """Return the deviation from a circle through three of its points; 0 if they are collinear."""
    points = part.points
    try:
        return float(from_circle(points, *points[[0, len(points) // 2, -1]]).max())
    except ValueError:
        return 0.0


for _states, _rule, _kinds, _off, _most in (
    ("the path of a LIN is a line", "", ("LIN", "SLIN"), _off_line, _NEAR_MM),
    ("the path of a CIRC is a circle", "", ("CIRC", "SCIRC"), _off_circle, _NEAR_MM),
    (
        "the axes of a PTP are synchronous",
        "MOT-01.b",
        ("PTP", "SPTP"),
        lambda part: from_synchronous(part.axes) or 0.0,
        _NEAR_DEGREES,
    ),
):
    LAWS.law(_states, _rule, of=_parts)(partial(_misshapen, _kinds, _off, _most))
