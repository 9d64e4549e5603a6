"""The first difference between two runs of a case in `krl conform`, with the state of both there.

Executors conform to each other if their traces are equal, at the full level too [docs/trace.md].
`first_divergence` finds the first event that differs. For both sides it reports the values of all
variables and outputs at that point, reconstructed from the trace.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any, Final

import numpy as np

from conformance.evaluation.observation import Event, Observation
from interp.robot.simulation.tracking import PathRecord

#: How many events before the divergence are kept for display.
_BEFORE: Final = 5
#: Degrees of tolerance between set-points of two executors, which come from one planner.
_SAME_AXES: Final = 1e-9


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two runs: its name, its event (``None`` if it has ended), and its state."""

    name: str
    event: dict[str, Any] | None
    variables: dict[str, Any]
    outputs: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Divergence:
    """The first difference: ``place`` counts events from 0; file and line are in the source.

    ``before`` are the last events that both runs have in common.
    """

    place: int
    file: str
    line: int
    before: tuple[dict[str, Any], ...]
    left: Side
    right: Side

    def __str__(self) -> str:
        left, right = self.left, self.right
        return (
            f"{self.file}:{self.line}: {left.name} {_described(left.event)}, "
            f"{right.name} {_described(right.event)}"
        )


def first_divergence(
    names: tuple[str, str], left: Observation, right: Observation
) -> Divergence | None:
    """Return the first difference of two runs, or ``None`` if they are equal."""
    pairs = zip_longest(left.events, right.events)
    for place, (one, other) in enumerate(pairs):
        if one != other or not _same_types(one, other):
            return _divergence(names, left.events, right.events, place)
    if left.ending != right.ending or not _same_path(left.path, right.path):
        return _divergence(names, left.events, right.events, len(left.events))
    return None


def _same_types(one: Event | None, other: Event | None) -> bool:
    """Return whether equal events have values of the same type: in Python, 1 == 1.0 == True."""
    if one is None or other is None:
        return one is other
    return type(one.fields.get("value")) is type(other.fields.get("value"))


def _same_path(left: PathRecord | None, right: PathRecord | None) -> bool:
    if left is None or right is None:
        return True
    same_times = np.array_equal(left.times, right.times)
    return same_times and bool(np.allclose(left.axes, right.axes, rtol=0, atol=_SAME_AXES))


def _divergence(
    names: tuple[str, str], left: Sequence[Event], right: Sequence[Event], place: int
) -> Divergence:
    at = next((events[place] for events in (left, right) if place < len(events)), None)
    if at is None or not at.file:
        at = next((event for event in reversed(left[:place]) if event.file), at)
    return Divergence(
        place,
        at.file if at else "",
        at.line if at else 0,
        tuple(event.record() for event in left[max(0, place - _BEFORE) : place]),
        _side(names[0], left, place),
        _side(names[1], right, place),
    )


def _side(name: str, events: Sequence[Event], place: int) -> Side:
    variables: dict[str, Any] = {}
    outputs: dict[str, Any] = {}
    for event in events[: place + 1]:
        if event.kind == "assign":
            variables[str(event.fields.get("name"))] = event.fields.get("value")
        elif event.kind in ("out", "anout"):
            outputs[f"{event.kind} {event.fields.get('number')}"] = event.fields.get("value")
    there = events[place].record() if place < len(events) else None
    return Side(name, there, variables, outputs)


def _described(event: dict[str, Any] | None) -> str:
    if event is None:
        return "has ended"
    fields = {key: value for key, value in event.items() if key not in ("task", "at", "t")}
    time = event.get("t")
    when = "" if time is None else f" at {time / 1e6:.6f} s"
    return f"says {' '.join(str(value) for value in fields.values())}{when}"
