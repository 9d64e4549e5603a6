"""Whether executors agree: what they ask and what they tell, side by side.

Executors that run the same program in the same world make the same requests and tell the same
events, in the same order [design section 6]. `observe` writes both down as one list of steps,
`difference` compares two such lists.

What executors hand over as `CodeHandle` they number as they like; a world that enters it is
`conformance.differential.runs`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Any

from interp.bench.stub_controller import StubController
from interp.port.events import ExecutorEvent, Recorder, Sink
from interp.port.executor import Executor
from interp.port.requests import (
    At,
    CodeHandle,
    Crash,
    End,
    Fail,
    Request,
)
from interp.values.faults import RuntimeFailure
from interp.values.values import ArrayValue, EnumValue, StructureValue

Step = ExecutorEvent | Request


@dataclass(frozen=True, slots=True)
class Observed:
    """All that an executor asked and told; ``is_cut`` where it was stopped from outside."""

    steps: tuple[Step, ...]
    is_cut: bool

    @property
    def last(self) -> Step:
        """What it ended with."""
        return self.steps[-1]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first step at which two executors differ; ``None`` stands behind the last one."""

    place: int
    left: Step | None
    right: Step | None

    def __str__(self) -> str:
        return f"step {self.place}: {self.left} here, {self.right} there"


def observe(
    make: Callable[[Sink], Executor], world: StubController, most: int = 10_000
) -> Observed:
    """Run a program to its end, or until it has made so many requests.

    Raises `interp.values.faults.LinkError` where it cannot begin.
    """
    recorder = Recorder()
    executor = make(recorder)
    steps: list[Step] = []
    reply: Any = None
    for _ in range(most):
        request = executor.advance(reply)
        steps += [*recorder.events, request]
        recorder.events.clear()
        if isinstance(request, End | Fail | Crash):
            return Observed(tuple(steps), is_cut=False)
        reply = world.reply(request)
    return Observed(tuple(steps), is_cut=True)


def difference(left: Observed, right: Observed) -> Difference | None:
    """Where two executors begin to differ; ``None`` where they agree."""
    for place, (one, other) in enumerate(zip(left.steps, right.steps, strict=False)):
        if not _alike(one, other):
            return Difference(place, one, other)
    place = min(len(left.steps), len(right.steps))
    if len(left.steps) == len(right.steps):
        return None
    return Difference(place, _step(left.steps, place), _step(right.steps, place))


def _step(steps: Sequence[Step], place: int) -> Step | None:
    return steps[place] if place < len(steps) else None


def _alike(one: Any, other: Any) -> bool:
    """Whether two steps are the same to the last bit: 1 is not 1.0, and 0.0 not -0.0."""
    if type(one) is not type(other):
        return False
    match one:
        case CodeHandle():  # executors number them as they like
            return True
        case float():
            return one == other and math.copysign(1, one) == math.copysign(1, other)
        case RuntimeFailure():
            return repr(one) == repr(other)
        case StructureValue():
            return one.type == other.type and _all_alike(one.members, other.members)
        case ArrayValue():
            return one.type == other.type and _all_alike(list(one), list(other))
        case tuple():
            return _all_alike(one, other)
    kind: type = type(one)
    names = _names(kind)
    if names:
        return all(_alike(getattr(one, name), getattr(other, name)) for name in names)
    return bool(one == other)


def _all_alike(ones: Sequence[Any], others: Sequence[Any]) -> bool:
    return len(ones) == len(others) and all(map(_alike, ones, others))


@cache
def _names(kind: type) -> tuple[str, ...]:
    """The fields of a step or of a part of one; none of values and places, which are compared."""
    if not is_dataclass(kind) or kind in (At, EnumValue):
        return ()
    return tuple(one.name for one in fields(kind))
