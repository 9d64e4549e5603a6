"""An arm that needs no machine, so that only the core is tested."""

from bisect import insort
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from interp.port.requests import At
from interp.robot.api.commands import MotionCommand
from interp.robot.arm import ArmEvent, Motion, Place, Position, Samples, Settings
from interp.values.faults import Fault
from interp.values.poses import IDENTITY

BRAKING = 10_000  # µs until the arm stands


class PacedArm:
    """Each motion takes ``target["X"]`` µs; one of kind CIRC cannot be planned."""

    def __init__(self) -> None:
        self.ahead: list[ArmEvent] = []
        self.calls: list[str] = []
        self.standing: list[ArmEvent] = []
        self.free_from = 0

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """Append a motion; one that takes no time is worth a message."""
        if motion.kind == "CIRC":
            raise Fault("circle", "start and end of a circle are equal", number=1456)
        start = max(now, self.free_from)
        duration = int(motion.target["X"])
        self.free_from = start + duration
        events = [
            ArmEvent(start, "motion_start", motion.number),
            ArmEvent(self.free_from, "motion_end", motion.number),
        ]
        for place in motion.places:
            time = start + round(place.position * duration) + place.delay
            events.append(ArmEvent(time, "place", motion.number, place.key))
        for event in events:
            insort(self.ahead, event, key=lambda one: one.time)
        return () if duration else (3171,)

    def mark(self) -> Callable[[], None]:
        """What undoes all that is planned from here on."""
        ahead, free_from = list(self.ahead), self.free_from

        def rewind() -> None:
            self.ahead, self.free_from = ahead, free_from

        return rewind

    def next_event(self) -> ArmEvent | None:
        """The first event ahead."""
        return self.ahead[0] if self.ahead else None

    def take(self) -> ArmEvent:
        """The first event ahead happens."""
        return self.ahead.pop(0)

    def pending(self) -> int:
        """Motions that have not ended."""
        return sum(event.kind == "motion_end" for event in (*self.ahead, *self.standing))

    def position(self, time: int) -> Position:
        """Its time, as a place."""
        return Position((float(time),) * 6, IDENTITY)

    def speed(self, time: int) -> float:
        """It moves once it has begun."""
        return float(time > 0)

    def distances(self, time: int) -> tuple[float, float]:
        """Its time."""
        return float(time), 0.0

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """It stands."""
        still = np.zeros((len(times), 6))
        return Samples(times, still)

    def forget(self, time: int) -> None:
        """It keeps no path."""

    def override(self, now: int, percent: float) -> None:
        """Only noted."""
        self.calls.append(f"override {percent:g} at {now}")

    def brake(self, now: int, is_hard: bool) -> None:
        """All that is ahead waits."""
        self.calls.append(f"{'stop' if is_hard else 'brake'} at {now}")
        self.standing = [replace(event, time=event.time + BRAKING) for event in self.ahead]
        self.ahead = [ArmEvent(now + BRAKING, "stopped", 0)] if self.ahead else []

    def proceed(self, now: int) -> None:
        """All that waits goes on, later by the braking."""
        self.calls.append(f"proceed at {now}")
        self.ahead, self.standing = self.standing, []

    def discard(self, now: int) -> None:
        """Nothing is ahead."""
        self.calls.append(f"discard at {now}")
        self.ahead, self.standing, self.free_from = [], [], now


@pytest.fixture
def paced() -> PacedArm:
    """An arm at rest."""
    return PacedArm()


@pytest.fixture
def make_motion() -> Callable[..., MotionCommand]:
    """A motion that takes so many µs, with places and criteria."""

    def make(
        number: int,
        duration: int = 1_000_000,
        *places: Place,
        kind: str = "LIN",
        criteria: tuple[str, ...] = (),
    ) -> MotionCommand:
        return MotionCommand(
            Motion(
                number,
                At("p.src", number, 0),
                kind,
                Settings(),
                target={"X": duration},
                criteria=criteria,
                places=places,
            )
        )

    return make
