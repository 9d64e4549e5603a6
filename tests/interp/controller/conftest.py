"""Programs run by the controller: the tree executor, and an arm that takes a second a motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grammar.syntax.source import Source
from interp.controller.controller import Controller
from interp.controller.inputs.input_script import Script
from interp.controller.scheduler import RunOutcome, Scheduler
from interp.controller.state.profile import Profile
from interp.controller.state.trace import Trace, TraceEvent
from interp.executors import Prepared
from interp.port.events import EVERY_KIND
from interp.program.load import Limits, load
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import ArmEvent, Motion, Position, Samples
from interp.robot.models import default_machine
from interp.values.faults import Fault
from interp.values.poses import IDENTITY

SECOND = 1_000_000
BLEND = 100_000  # µs before and after an approximated point
BRAKING = 10_000  # µs until the arm stands


@dataclass
class _Queue:
    """Motions one behind the other, by their start in path time."""

    motions: list[tuple[int, Motion]]
    events: list[tuple[int, int, ArmEvent]]
    end: int
    axes: tuple[float, ...]
    ended: set[int]


class SecondArm:
    """Each motion takes a second of path time, and ends where its A1 says; no dynamics at all.

    An approximated one blends 0.1 s before to 0.1 s after its end, if the next is planned by then.
    """

    def __init__(self) -> None:
        self.path = 0.0
        self.since = 0
        self.rate = 1.0
        self.percent = 100.0
        self.is_braked = False
        self.standing: int | None = None
        self.queue = _Queue([], [], 0, (0.0,) * 6, set())
        self.rests: list[tuple[_Queue, float]] = []
        self.calls: list[str] = []

    # the path clock

    def _at(self, time: int) -> float:
        return self.path + (time - self.since) * self.rate

    def _run(self, now: int, rate: float) -> None:
        self.path, self.since, self.rate = self._at(now), now, rate

    def _time(self, place: float) -> int | None:
        if self.rate == 0:
            return None
        return self.since + round((place - self.path) / self.rate)

    # the port

    def mark(self) -> Callable[[], None]:
        """What undoes all that is planned from here on."""
        queue = self.queue
        known = list(queue.motions), list(queue.events), queue.end, set(queue.ended)

        def rewind() -> None:
            queue.motions, queue.events, queue.end, queue.ended = known

        return rewind

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; beyond 180 degrees it cannot be."""
        if motion.target.get("A1", 0.0) > 180:
            raise Fault("software_limit", "behind a software limit switch", number=1447)
        if self.is_braked and self.standing is None:
            axes = self.position(now).axes
            self.rests.append((self.queue, self._at(now)))
            self.queue = _Queue([], [], 0, axes, set())
            self.is_braked = False
            self.path, self.since, self.rate = 0.0, now, self.percent / 100
        queue = self.queue
        if not self.pending():
            queue.end = round(self._at(now))
        start = queue.end
        queue.motions.append((start, motion))
        queue.end = start + SECOND
        self._refresh(now)
        return (3171,) if motion.target.get("A6") == 99 else ()

    def _refresh(self, now: int) -> None:
        """The events of all motions that have not ended; a point once passed stays as it was."""
        queue, place = self.queue, self._at(now)
        passed = [one for one in queue.events if one[0] <= place and one[1] == 1]
        events_of = {(one[2].kind, one[2].motion, one[2].key) for one in passed}
        events: list[tuple[int, ArmEvent]] = []
        for index, (start, motion) in enumerate(queue.motions):
            end, number = start + SECOND, motion.number
            follows = index + 1 < len(queue.motions)
            next_start = queue.motions[index + 1][0] if follows else None
            blends = bool(motion.criteria) and next_start == end
            was_exact = ("motion_end", number, None) in events_of
            if blends and place > end - BLEND and ("blend_start", number, None) not in events_of:
                blends = False
            events.append((start, ArmEvent(0, "motion_start", number)))
            if blends and not was_exact:
                events.append((end - BLEND, ArmEvent(0, "blend_start", number)))
                events.append((end, ArmEvent(0, "blend_apex", number)))
            unwanted = bool(motion.criteria) and not blends
            events.append((end, ArmEvent(0, "motion_end", number, None, unwanted)))
            if blends:
                after = queue.motions[index + 1][1].number
                events.append((end + BLEND, ArmEvent(0, "blend_end", after)))
            inner = [place for part in motion.parts for place in part.places]
            for one in (*motion.places, *inner, *motion.stop_places):
                at = (
                    one.position * SECOND if one.kind == "DISTANCE" else SECOND + one.position * 1e3
                )
                events.append(
                    (start + round(at) + one.delay, ArmEvent(0, "place", number, one.key))
                )
        order = ["blend_start", "blend_apex", "motion_end", "motion_start", "place", "blend_end"]
        events.sort(key=lambda one: (one[0], order.index(one[1].kind)))
        queue.events = passed + [
            (at, 0, one) for at, one in events if (one.kind, one.motion, one.key) not in events_of
        ]

    def _next(self) -> tuple[int, int, ArmEvent] | None:
        return next((one for one in self.queue.events if one[1] == 0), None)

    def next_event(self) -> ArmEvent | None:
        """The first event ahead."""
        if self.standing is not None:
            return ArmEvent(self.standing, "stopped", 0)
        found = self._next()
        time = None if found is None else self._time(found[0])
        if found is None or time is None:
            return None
        event = found[2]
        return ArmEvent(
            max(time, self.since), event.kind, event.motion, event.key, event.is_exact_unwanted
        )

    def take(self) -> ArmEvent:
        """It happens."""
        event = self.next_event()
        assert event is not None
        if self.standing is not None:
            self.standing = None
            return event
        place = self.queue.events.index(self._next())  # type: ignore[arg-type]
        at, _, kept = self.queue.events[place]
        self.queue.events[place] = (at, 1, kept)
        if event.kind == "motion_end":
            self.queue.ended.add(event.motion)
        return event

    def pending(self) -> int:
        """Motions that have not ended."""
        queues = [self.queue, *(rest for rest, _ in self.rests)]
        return sum(len(one.motions) - len(one.ended) for one in queues)

    def position(self, time: int) -> Position:
        """A1, by the share of the second that has passed."""
        place, axes = self._at(time), self.queue.axes
        for start, motion in self.queue.motions:
            share = min(max((place - start) / SECOND, 0.0), 1.0)
            target = motion.target.get("A1", axes[0])
            axes = (axes[0] + (target - axes[0]) * share, *axes[1:])
        return Position(axes, IDENTITY)

    def speed(self, _time: int) -> float:
        """1 while it moves."""
        return 1.0 if self.rate and self.pending() else 0.0

    def distances(self, _time: int) -> tuple[float, float]:
        """Nothing is known of them."""
        return 0.0, 0.0

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Nothing is known of them."""
        zeros = np.zeros((len(times), 6))
        return Samples(times, zeros)

    def forget(self, time: int) -> None:
        """It keeps no path."""

    def override(self, now: int, percent: float) -> None:
        """The path clock goes slower."""
        self.percent = percent
        if not self.is_braked:
            self._run(now, percent / 100)

    def brake(self, now: int, is_hard: bool) -> None:
        """Stand at once, tell it after the braking time."""
        self.calls.append("hard" if is_hard else "brake")
        if not self.pending():
            return
        self._run(now, 0.0)
        self.is_braked = True
        self.standing = now + BRAKING

    def proceed(self, now: int) -> None:
        """Go on, with what a nested motion interrupted as well."""
        self.calls.append("proceed")
        if self.rests and len(self.queue.motions) == len(self.queue.ended) and not self.is_braked:
            self.queue, self.path = self.rests.pop()
        self.is_braked = False
        self.since, self.rate = now, self.percent / 100

    def discard(self, now: int) -> None:
        """Forget the path."""
        self.calls.append("discard")
        is_moving = self.pending() > 0 and not self.is_braked and self.rate > 0
        axes = self.position(now).axes
        self.rests.clear()
        self.queue = _Queue([], [], 0, axes, set())
        self.is_braked = False
        self.path, self.since, self.rate = 0.0, now, self.percent / 100
        self.standing = now + BRAKING if is_moving else None


@dataclass
class Ran:
    """A run: how it ended, and its trace."""

    outcome: RunOutcome
    events: list[TraceEvent]
    controller: Controller
    arm: SecondArm

    def events_of(self, *kinds: str) -> list[TraceEvent]:
        """The events of some kinds."""
        return [one for one in self.events if one.kind in kinds]

    def times(self, kind: str, **fields: Any) -> list[float]:
        """The times in seconds of the events of a kind that have these fields."""
        return [
            one.time / SECOND
            for one in self.events_of(kind)
            if fields.items() <= dict(one.fields).items()
        ]

    def outputs(self) -> list[tuple[float, int, object]]:
        """Changes of digital outputs: time in seconds, number, value."""
        return [
            (one.time / SECOND, one.fields["number"], one.fields["value"])
            for one in self.events_of("out")
        ]

    def messages(self) -> list[int]:
        """The numbers of messages."""
        return [one.fields["number"] for one in self.events_of("message")]

    def value(self, *path: str | int) -> Any:
        """The value of a system variable at the end."""
        return self.controller.variables.read(path)

    def last(self, name: str) -> Any:
        """What was assigned to a variable of the program last."""
        return [
            one.fields["value"] for one in self.events_of("assign") if one.fields["name"] == name
        ][-1]


Runner = Callable[..., Ran]


def made(
    text: str,
    script: str = "",
    *,
    profile: Profile | None = None,
    submit: str | None = None,
    files: dict[str, str] | None = None,
    limits: Limits | None = None,
    executor: str = "tree",
    core: type[ControlCore] = ControlCore,
    **more: Any,
) -> tuple[Controller, Trace, SecondArm]:
    """A controller for ``main.src`` and other files."""
    profile = profile or Profile.load()
    sources = {"main.src": text, **(files or {})}
    program = load([Source(one, name) for name, one in sources.items()], "main.src", strict=False)
    trace = Trace(kinds=EVERY_KIND)
    sink = trace.sink("robot")
    limits = limits or Limits(per_slice=profile.statements)
    runs = Prepared(program).executor(executor, limits, sink)
    beside, beside_sink = None, None
    if submit is not None:
        beside_sink = trace.sink("submit")
        beside = runs.companion(submit, beside_sink)
    arm = SecondArm()
    controller = Controller(
        runs,
        lambda switch: core(arm, switch, 1),
        profile=profile,
        script=Script.read(script),
        trace=trace,
        sink=sink,
        submit=beside,
        submit_sink=beside_sink,
        machine=default_machine(),
        **more,
    )
    return controller, trace, arm


@pytest.fixture(scope="session")
def go() -> Runner:
    """Runs ``main.src`` and gives what happened."""

    def ran(text: str, script: str = "", until: float = 60.0, pieces: int = 1, **more: Any) -> Ran:
        controller, trace, arm = made(text, script, **more)
        end, ends = round(until * SECOND), 0
        while True:
            ends += 1
            outcome = controller.run(end * ends // pieces)
            if ends == pieces or outcome.ending != "time":
                break
        return Ran(outcome, trace.events, controller, arm)

    return ran


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The times in µs at which the controller has looked whether anything is to be done."""
    times: list[int] = []
    settle = Scheduler._settle

    def counted(self: Scheduler) -> None:
        times.append(self.state.clock.now)
        settle(self)

    monkeypatch.setattr(Scheduler, "_settle", counted)
    return times
