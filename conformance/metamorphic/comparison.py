"""Comparison of two runs under a law: what must be equal, and the first difference.

Each comparison returns the first difference as one line, or "" if there is none. Line numbers are
never compared, because laws change them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import zip_longest
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.observation import Event, Observation

Compare = Callable[[Observation, Observation], str]
Array = npt.NDArray[np.float64]

#: The events of what a program computes and does to the world, regardless of its statements.
_EFFECTS: Final = frozenset(
    {
        "assign",
        "out",
        "anout",
        "motion_planned",
        "motion_start",
        "motion_end",
        "blend_start",
        "blend_apex",
        "blend_end",
        "trigger",
        "message",
        "brake",
        "halt",
        "end",
        "fault",
    }
)
#: Tolerance in degrees between axes that were computed in different ways.
_SAME: Final = 1e-3
#: Tolerance of times that must not increase, as a fraction.
_LATER: Final = 1e-3
#: Tolerance in degrees between a point and the other path, which is sampled and joined by chords.
_NEAR: Final = 0.05


def same_trace(left: Observation, right: Observation) -> str:
    """Compare the whole trace including times, except line numbers."""
    return _first_difference(left, right, _timed)


def same_trace_renamed(names: Mapping[str, str]) -> Compare:
    """Return a comparison of whole traces after renaming; ``names`` maps new names to old ones.

    All names are in upper case.
    """

    def compare(left: Observation, right: Observation) -> str:
        def old(event: Event) -> Any:
            fields = dict(event.fields)
            if event.kind == "assign":
                root, *rest = _split(str(fields["name"]))
                fields["name"] = "".join((names.get(root.upper(), root), *rest))
            return _timed(Event(event.time, event.task, event.kind, "", 0, fields))

        return _first_difference(left, right, _timed, old)

    return compare


def same_effects(left: Observation, right: Observation) -> str:
    """Compare what was assigned, switched, moved and reported in each task; order but not times.

    A changed number of statements changes the cycle in which they are executed.
    """
    for task in ("robot", "submit"):
        one, other = (_of_task(run, task, _EFFECTS) for run in (left, right))
        difference = _first_difference(one, other, _untimed)
        if difference:
            return difference
    return ""


def same_outputs(left: Observation, right: Observation) -> str:
    """Compare the outputs in their order, and the path of the arm, but not times."""
    kinds = frozenset({"out", "anout", "motion_end", "fault"})
    one, other = (_of_task(run, "robot", kinds) for run in (left, right))
    return _first_difference(one, other, _untimed) or same_geometry(left, right)


def same_axes(left: Observation, right: Observation) -> str:
    """Compare the axes at each set-point, and the trace except assignments."""
    kinds = _EFFECTS - {"assign"}
    one, other = (_of_task(run, "robot", kinds) for run in (left, right))
    difference = _first_difference(one, other, lambda event: (event.time, *_untimed(event)))
    if difference or left.path is None or right.path is None:
        return difference
    if len(left.path.times) != len(right.path.times):
        return f"{len(left.path.times)} set-points, then {len(right.path.times)}"
    off = np.abs(left.path.axes - right.path.axes).max(axis=1)
    if not len(off) or off.max() <= _SAME:
        return ""
    place = int(np.argmax(off > _SAME))
    return f"at {left.path.times[place] / 1e6:.3f} s axes differ by {off[place]:.4f} degrees"


def same_geometry(left: Observation, right: Observation) -> str:
    """Compare the geometry of the path, regardless of its speed.

    Nothing is compared if a fault ends the first run, because it stops the arm at a time and not at
    a place.
    """
    if left.ending == "fault":
        return ""
    if left.path is None or right.path is None or not len(left.path.axes):
        return ""
    one, other = (_thinned(run.path.axes) for run in (left, right) if run.path is not None)
    # The last set-point is that of the last cycle, which is slightly before the end.
    if max(np.abs(one[place] - other[place]).max() for place in (0, -1)) > _NEAR:
        return "the path does not begin and end where it did"
    for mine, theirs, which in ((one, other, "old"), (other, one, "new")):
        off = _distances(mine, theirs)
        if off.max() > _NEAR:
            place = mine[int(np.argmax(off))]
            return f"the {which} path has {_axes(place)}, {off.max():.4f} degrees beside the other"
    return ""


def no_sooner(left: Observation, right: Observation) -> str:
    """Check that the last motion of the changed program ends no earlier than before."""
    one, other = _end_of_motion(left), _end_of_motion(right)
    if one is None or other is None or one <= other * (1.0 + _LATER):
        return ""
    return f"motions end after {one / 1e6:.4f} s, then after {other / 1e6:.4f} s"


def at_most_twice(left: Observation, right: Observation) -> str:
    """Check that its motions end no earlier than before, and take at most twice as long."""
    one, other = _end_of_motion(left), _end_of_motion(right)
    if one is None or other is None or other <= 2.0 * one * (1.0 + _LATER):
        return no_sooner(left, right)
    return f"motions end after {one / 1e6:.4f} s, then after {other / 1e6:.4f} s"


def _end_of_motion(run: Observation) -> int | None:
    """Return when the last motion ended in µs; ``None`` if the run did not come to its end."""
    times = [one.time for one in run.of_kind("motion_end") if one.time is not None]
    return max(times, default=0) if run.ending == "end" else None


# ------------------------------------------------------------------------------------ events


def _first_difference(
    left: Observation,
    right: Observation,
    old: Callable[[Event], Any],
    new: Callable[[Event], Any] | None = None,
) -> str:
    """Return the first difference between events, unless a run was only cut off by its time."""
    is_cut = "running" in (left.ending, right.ending)
    for one, other in zip_longest(left.events, right.events):
        if one is None or other is None:
            return "" if is_cut else f"{_event(one)}, then {_event(other)}"
        if old(one) != (new or old)(other):
            return f"{_event(one)}, then {_event(other)}"
    if left.ending != right.ending and not is_cut:
        return f"it ended with {left.ending} {left.note}, then with {right.ending} {right.note}"
    return ""


def _of_task(run: Observation, task: str, kinds: Iterable[str]) -> Observation:
    wanted = frozenset(kinds)
    events = tuple(one for one in run.events if one.task == task and one.kind in wanted)
    return Observation(events=events, ending=run.ending, note=run.note)


def _timed(event: Event) -> Any:
    return event.time, event.task, event.kind, _fields(event)


def _untimed(event: Event) -> Any:
    return event.kind, _fields(event)


def _fields(event: Event) -> tuple[tuple[str, str], ...]:
    """Return names and texts in upper case, because letter case of names is not compared."""
    return tuple((key, repr(value).upper()) for key, value in sorted(event.fields.items()))


def _event(event: Event | None) -> str:
    if event is None:
        return "nothing more"
    where = f" ({event.file}:{event.line})" if event.file else ""
    values = " ".join(str(value) for value in event.fields.values())
    when = "" if event.time is None else f" at {event.time / 1e6:.6f} s"
    return f"{event.kind} {values}{when}{where}"


def _split(path: str) -> list[str]:
    """Return a name, and the text of the indices and members after it."""
    end = next((place for place, letter in enumerate(path) if letter in "[."), len(path))
    return [path[:end], path[end:]]


# ------------------------------------------------------------------------------------ paths


def _thinned(axes: Array) -> Array:
    """Return the axes without set-points at which the arm rests."""
    moves = np.abs(np.diff(axes, axis=0)).max(axis=1) > 0.0
    return axes[np.concatenate(([True], moves))]


def _distances(points: Array, path: Array) -> Array:
    """Return the distance of each point from a path, following both in the same direction."""
    if len(path) < 2:
        return np.asarray(np.abs(points - path[0]).max(axis=1))
    starts, ways = path[:-1], np.diff(path, axis=0)
    squares = np.maximum((ways * ways).sum(axis=1), 1e-18)
    found = np.empty(len(points))
    first = 0
    for number, point in enumerate(points):
        window = slice(first, None)
        along = ((point - starts[window]) * ways[window]).sum(axis=1)
        share = np.clip(along / squares[window], 0.0, 1.0)
        off = np.abs(starts[window] + share[:, None] * ways[window] - point).max(axis=1)
        nearest = int(np.argmin(off))
        found[number] = off[nearest]
        # Continue at the first place that is near: a path that reverses passes a place twice.
        near = np.flatnonzero(off <= max(off[nearest], _NEAR))
        first += max(0, int(near[0]) - 1)
    return found


def _axes(axes: Sequence[float] | Array) -> str:
    return "{" + ", ".join(f"A{place} {value:.3f}" for place, value in enumerate(axes[:6], 1)) + "}"
