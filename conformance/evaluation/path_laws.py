"""Laws that every path of set-points obeys: limits of the axes, and the shape of each motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_geometry import (
    RATE_MARGIN,
    change_rates,
    from_circle,
    from_line,
    from_synchronous,
)
from conformance.evaluation.run_laws import Violation
from interp.robot.kinematics.placement import IpoMode
from interp.robot.simulation.tracking import PathRecord

Array = npt.NDArray[np.float64]

#: The smallest number of rows of a path that is checked.
_FEWEST: Final = 4
#: mm of the tool and degrees of an axis by which rounding may put a set-point off its path.
_NEAR_MM, _NEAR_DEGREES = 0.002, 0.0005
_LIMITS: Final = "set-points keep the limits of the axes"


def path_violations(seen: Observation) -> Iterator[Violation]:
    """Yield violations of axis limits, at most one of each kind, and motions of a wrong shape.

    Yield nothing if there is no path, and no limits if the machine data is unknown.
    """
    path = seen.path
    if path is not None and len(path.times) >= _FEWEST:
        yield from _limit_violations(seen, path)
        yield from _drift_violations(seen, path)
        yield from _shape_violations(seen, path)


def _limit_violations(seen: Observation, path: PathRecord) -> Iterator[Violation]:
    """Check software limits [MOT-15], speeds [MOT-06], accelerations [MOT-02] and jerks."""
    if seen.machine is None:
        return
    axes = seen.machine.every_axis[: path.axes.shape[1]]
    limits = [one.dynamics for one in axes]
    rows = path.axes
    for order, (rule, what) in enumerate(
        (("MOT-06", "velocity"), ("MOT-02", "acceleration"), ("", "jerk"))
    ):
        rows = change_rates(path.times[order:], rows)
        most = [getattr(one, what) if one else math.inf for one in limits]
        share = np.abs(rows) / np.array(most)
        row, axis = np.unravel_index(int(np.argmax(share)), share.shape)
        if not share[row, axis] <= RATE_MARGIN:
            actual = f"{axes[axis].name} has {share[row, axis] * 100:.1f} % of its {what}"
            yield _violation(seen, int(path.times[row]), _LIMITS, actual, rule)
    for column, one in enumerate(axes):
        places = path.axes[:, column]
        outside = ~((places >= one.lower - _NEAR_DEGREES) & (places <= one.upper + _NEAR_DEGREES))
        if outside.any():
            first = int(np.argmax(outside))
            actual = f"{one.name} stands at {places[first]:.3f}"
            yield _violation(seen, int(path.times[first]), _LIMITS, actual, "MOT-15")
            return


def _violation(seen: Observation, time: int, law: str, actual: str, rule: str) -> Violation:
    """Return a violation at the motion that runs at a time in µs."""
    begun = [one for one in seen.of_kind("motion_start") if (one.time or 0) <= time]
    return Violation(begun[-1] if begun else None, law, f"{actual} at {time / 1e6:.3f} s", rule)


def _drift_violations(seen: Observation, path: PathRecord) -> Iterator[Violation]:
    """Yield the first movement of the arm between motions, up to a BRAKE or RESUME."""
    since: int | None = 0
    for one in seen.of_kind("motion_start", "motion_end", "brake", "resume", "end"):
        if one.kind == "motion_end":
            since = one.time
        elif since is not None and one.time is not None:
            rows = path.axes[(path.times >= since) & (path.times <= one.time)]
            most = float(np.ptp(rows, axis=0).max()) if len(rows) else 0.0
            if not most <= _NEAR_DEGREES:
                law = "the arm stands where no motion is under way"
                yield Violation(one, law, f"an axis moves by {most:.4f} before it")
                return
            since = None
        if one.kind in ("brake", "resume"):
            return


def _shape_violations(seen: Observation, path: PathRecord) -> Iterator[Violation]:
    """Yield motions that are no line, no circle, or not synchronous [MOT-01] between their blends.

    With a fixed tool, the base relative to the tool has the shape [ORI-07]; it is not checked.
    """
    if any(placement.mode is not IpoMode.BASE for _, placement in path.placements):
        return
    # A change of frames, or a motion of an interrupt routine in between, changes the shape.
    changes = [time for time, _ in path.placements]
    changes += [one.time for one in seen.of_kind("motion_start") if one.time is not None]
    for start, first, last in _unblended_parts(seen):
        kept = (path.times >= first) & (path.times <= last)
        if kept.sum() < _FEWEST or any(first < time < last for time in changes):
            continue
        points, axes = path.points[kept][:, :3], path.axes[kept]
        match str(start.fields.get("motion_kind")).removesuffix("_REL"):
            case "LIN" | "SLIN":
                off = float(from_line(points, points[0], points[-1]).max())
                law, most, rule = "the path of a LIN is a line", _NEAR_MM, ""
            case "CIRC" | "SCIRC":
                off = _off_circle(points)
                law, most, rule = "the path of a CIRC is a circle", _NEAR_MM, ""
            case "PTP" | "SPTP":
                off = from_synchronous(axes) or 0.0
                law, most, rule = "the axes of a PTP are synchronous", _NEAR_DEGREES, "MOT-01.b"
            case _:
                continue
        if not off <= most:
            yield _violation(seen, start.time or 0, law, f"{off:.4f} off", rule)


def _unblended_parts(seen: Observation) -> Iterator[tuple[Event, int, int]]:
    """Yield each ended motion with the times in µs between which it was in no blend."""
    found: dict[tuple[str, object], Event] = {}
    for one in seen.of_kind("motion_start", "motion_end", "blend_start", "blend_end"):
        found.setdefault((one.kind, one.fields.get("motion")), one)
    for (kind, number), start in found.items():
        if kind == "motion_start" and ("motion_end", number) in found:
            entered = found.get(("blend_end", number), start)
            left = found.get(("blend_start", number), found["motion_end", number])
            if entered.time is not None and left.time is not None:
                yield start, entered.time, left.time


def _off_circle(points: Array) -> float:
    """Return the deviation of points from a circle through three of them; 0 if collinear."""
    try:
        return float(from_circle(points, points[0], points[len(points) // 2], points[-1]).max())
    except ValueError:
        return 0.0
