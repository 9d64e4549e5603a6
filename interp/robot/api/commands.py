"""The Robotics API: commands, their events, and transactions that link them.

It follows the paper "On reverse-engineering the KUKA Robot Language" (Mühe, Angerer, Hoffmann, Reif
2010). A command is an action that is executed once: a motion, an output, a wait, a call. Its
execution causes events, and an event of one command may start, cancel or stop another command.
Commands and links that belong together form a transaction, which `interp.robot.api.control_core`
loads as a whole or not at all.

    ignite = MotionCommand(motion)
    gas = OutputCommand(("$OUT", 1), True)
    core.load(now, Transaction(ignite, gas).link(ignite.ended, "start", gas))

The state of a command is ``created``, ``linked`` once it is loaded, ``active`` from its start on,
and finally ``ended``, ``cancelled`` or ``failed``. Times are whole µs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from enum import Enum
from typing import Literal

from interp.port.requests import Path, Value
from interp.robot.arm import ArmEvent, Motion, Place
from interp.values.faults import Fault
from support.lazy_dataclass import dataclass

#: The effect of an event on a command: ``cancel`` ends it gently, a motion with its own braking
#: ramp; ``stop`` ends it at once, a motion with the hardest ramp.
Effect = Literal["start", "cancel", "stop"]

#: What happens to a command. ``reached`` is a place of a motion, ``apex`` the middle of the blend
#: after it; ``stopped`` is an event of the arm, which is at rest after a brake.
What = Literal[
    "started",
    "ended",
    "cancelled",
    "failed",
    "reached",
    "blend_start",
    "apex",
    "blend_end",
    "stopped",
]


class CommandError(Exception):
    """Commands or links are inconsistent; the text is one line."""


class CommandState(Enum):
    """The state of a command."""

    CREATED = "created"
    LINKED = "linked"
    ACTIVE = "active"
    ENDED = "ended"
    CANCELLED = "cancelled"
    FAILED = "failed"

    @property
    def is_over(self) -> bool:
        """Whether nothing more can happen to the command."""
        return self in {CommandState.ENDED, CommandState.CANCELLED, CommandState.FAILED}


@dataclass(slots=True, eq=False)
class Command:
    """An action that is executed once; only the control core changes its state."""

    state: CommandState = field(default=CommandState.CREATED, init=False)

    @property
    def started(self) -> Event:
        """It begins: a motion leaves its start, or the apex of the blend before it."""
        return Event(self, "started")

    @property
    def ended(self) -> Event:
        """It is complete: a motion is at its end, or at the apex of the blend after it."""
        return Event(self, "ended")

    @property
    def cancelled(self) -> Event:
        """It was ended early, or can no longer begin."""
        return Event(self, "cancelled")

    @property
    def failed(self) -> Event:
        """A fault prevented it."""
        return Event(self, "failed")


@dataclass(slots=True, eq=False)
class MotionCommand(Command):
    """Append a motion to the path. If no event starts it, it is planned when it is loaded.

    ``notices`` are the numbers of messages from planning that stop nothing.
    """

    motion: Motion
    notices: tuple[int, ...] = field(default=(), init=False)

    def reached(self, place: Place) -> Event:
        """Return the event that the path passes a place; raise `CommandError` if it is unknown."""
        event = Event(self, "reached", place.key)
        if place.key not in self.place_keys():
            raise CommandError(f"{event}: the motion has no such place")
        return event

    @property
    def apex(self) -> Event:
        """The middle of the blend after the motion; it never happens if the motion ends exactly."""
        return Event(self, "apex")

    def place_keys(self) -> frozenset[int]:
        """Return the keys of all places of the motion and of its parts."""
        motion = self.motion
        parts = (place for part in motion.parts for place in part.places)
        return frozenset(place.key for place in (*motion.places, *motion.stop_places, *parts))

    def __str__(self) -> str:
        return f"motion {self.motion.number} ({self.motion.kind})"


@dataclass(slots=True, eq=False)
class OutputCommand(Command):
    """Switch an output or set a system variable; this takes no time."""

    path: Path
    value: Value

    def __str__(self) -> str:
        return f"output {'.'.join(map(str, self.path))}"


@dataclass(slots=True, eq=False)
class WaitCommand(Command):
    """Wait for ``duration`` µs."""

    duration: int

    def __post_init__(self) -> None:
        if self.duration < 0:
            raise CommandError(f"{self}: no time passes backwards")

    def __str__(self) -> str:
        return f"wait of {self.duration} µs"


@dataclass(slots=True, eq=False)
class CallCommand(Command):
    """Let the owner of the core act: it receives ``started``, and calls `complete` when done.

    ``what`` has a meaning only for the owner, such as the action of a trigger.
    """

    what: object

    def __str__(self) -> str:
        return f"call {self.what}"


@dataclass(frozen=True, slots=True)
class Event:
    """Something that may happen to a command; ``key`` is that of a place."""

    command: Command
    what: What
    key: int | None = None

    def __str__(self) -> str:
        key = "" if self.key is None else f" {self.key}"
        return f"{self.command} {self.what}{key}"


@dataclass(frozen=True, slots=True)
class Link:
    """Apply ``effect`` to ``command`` when ``event`` happens, after ``delay`` µs."""

    event: Event
    effect: Effect
    command: Command
    delay: int = 0

    def __post_init__(self) -> None:
        if self.delay < 0:
            raise CommandError(
                f"{self}: an effect cannot precede its cause; give the place a negative delay "
                f"instead"
            )

    def __str__(self) -> str:
        return f"{self.event} -> {self.effect} {self.command}"


class Transaction:
    """Commands, and links from events to commands, that are loaded together.

    Commands that no link starts are started when the transaction is loaded, in their order.
    """

    def __init__(self, *commands: Command) -> None:
        self.commands: list[Command] = list(commands)
        self.links: list[Link] = []

    def add(self, *commands: Command) -> Transaction:
        """Add commands; return the transaction."""
        self.commands += commands
        return self

    def link(self, event: Event, effect: Effect, command: Command, delay: int = 0) -> Transaction:
        """Add a link, whose event may be of a command loaded earlier; return the transaction."""
        self.links.append(Link(event, effect, command, delay))
        return self

    def unlinked(self) -> Iterator[Command]:
        """Return the commands that no link starts."""
        started = {link.command for link in self.links if link.effect == "start"}
        return (command for command in self.commands if command not in started)

    def check(self) -> None:
        """Raise `CommandError` if the transaction is inconsistent in itself.

        Each command must occur once, and must be started by the load or by an event that can
        happen. A link must not start a command of another transaction.
        """
        own = set(self.commands)
        if len(own) < len(self.commands):
            raise CommandError(f"{self}: a command occurs in it twice")
        starts = [link for link in self.links if link.effect == "start"]
        for link in starts:
            if link.command not in own:
                raise CommandError(f"{link}: {link.command} is not of this transaction")
        reached = set(self.unlinked())
        while (
            further := {
                link.command
                for link in starts
                if link.event.command in reached or link.event.command not in own
            }
            - reached
        ):
            reached |= further
        for command in self.commands:
            if command not in reached:
                raise CommandError(f"{command}: what should start it waits for it")

    def __str__(self) -> str:
        return f"a transaction of {len(self.commands)} commands"


@dataclass(frozen=True, slots=True)
class CoreEvent:
    """Something happened at ``time`` in µs.

    ``command`` is ``None`` for an event of the arm alone. ``key`` is that of a place, ``arm`` the
    event of the arm behind it, and ``fault`` the reason why a command failed.
    """

    time: int
    command: Command | None
    what: What
    key: int | None = None
    arm: ArmEvent | None = None
    fault: Fault | None = None
