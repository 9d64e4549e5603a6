"""An undisturbed run of an executor as a sequence of requests and events.

Executors that run the same program in the same world make the same requests and report the same
events, in the same order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from conformance.differential import divergence
from conformance.differential.random_world import QuietWorld
from conformance.differential.traces import fact_of
from interp.port.events import ExecutorEvent, Recorder, Sink
from interp.port.executor import Executor
from interp.port.requests import Crash, End, Fail, Request

Step = ExecutorEvent | Request


@dataclass(frozen=True, slots=True)
class Observed:
    """All requests and events of an executor; ``is_cut`` is set if it was stopped from outside."""

    steps: tuple[Step, ...]
    is_cut: bool

    @property
    def last(self) -> Step:
        """The last step."""
        return self.steps[-1]

    def asked(self, kind: type[Any]) -> list[Any]:
        """Return all requests of a kind."""
        return [one for one in self.steps if isinstance(one, kind)]

    def values(self, *path: str | int) -> list[Any]:
        """Return the values that were assigned to a variable, in order."""
        return [one.value for one in self.events_of("assign") if one.path == path]

    def events_of(self, kind: str) -> list[ExecutorEvent]:
        """Return all events of a kind."""
        return [one for one in self.steps if isinstance(one, ExecutorEvent) and one.kind == kind]


def observe(make: Callable[[Sink], Executor], world: QuietWorld, most: int = 10_000) -> Observed:
    """Run a program to its end, or until it has made ``most`` requests.

    No interrupt and no trigger ever happens; a RESUME is ignored. Raises
    `interp.values.faults.LinkError` if the program cannot begin.
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


def difference(executor: str, expected: Observed, actual: Observed) -> divergence.Difference | None:
    """Return the first difference of an executor from the reference, ``None`` if they agree."""
    facts = ([fact_of(step) for step in one.steps] for one in (expected, actual))
    return divergence.difference(executor, *facts)
