"""The Robotics API: commands, their events, and transactions that link them.

After the paper "On reverse-engineering the KUKA Robot Language" (Mühe, Angerer, Hoffmann, Reif
2010). A command is something to do once: a motion, an output, a wait, a call. What it goes through
are events, and an event of one command may start, cancel or stop another one. Commands and links
that belong together are a transaction, which `interp.robot.api.control_core` loads as a whole or
not at all.

    ignite = MotionCommand(motion)
    gas = OutputCommand(("$OUT", 1), True)
    core.load(now, Transaction(ignite, gas).link(ignite.ended, "start", gas))

A command goes its way once: ``created``, ``linked`` once it is loaded, ``active`` from its start
on, and then ``ended``, ``cancelled`` or ``failed``. Times are whole microseconds.
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

#: What an event does to a command: ``cancel`` ends it gently, a motion by its own braking ramp;
#: ``stop`` ends it at once, a motion by the hardest ramp.
Effect = Literal["start", "cancel", "stop"]

#: What happens to a command. ``reached`` is a place of a motion, ``apex`` the middle of the blend
#: behind it; ``stopped`` is the arm's, which stands still after it braked.
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
    """Commands or links make no sense together; the text is one line for a person."""


class CommandState(Enum):
    """How far a command is."""

    CREATED = "created"
    LINKED = "linked"
    ACTIVE = "active"
    ENDED = "ended"
    CANCELLED = "cancelled"
    FAILED = "failed"

    @property
    def is_over(self) -> bool:
        """Whether nothing can happen to the command any more."""
        return self in {CommandState.ENDED, CommandState.CANCELLED, CommandState.FAILED}


@dataclass(slots=True, eq=False)
class Command:
    """Something to do once. Its state is changed by the control core only."""

    state: CommandState = field(default=CommandState.CREATED, init=False)

    @property
    def started(self) -> Event:
        """It begins: a motion leaves its start, or the apex of the blend before it."""
        return Event(self, "started")

    @property
    def ended(self) -> Event:
        """It is done: a motion is at its end, or at the apex of the blend behind it."""
        return Event(self, "ended")

    @property
    def cancelled(self) -> Event:
        """It was ended before its time, or can never begin any more."""
        return Event(self, "cancelled")

    @property
    def failed(self) -> Event:
        """A fault kept it from being done."""
        return Event(self, "failed")


@dataclass(slots=True, eq=False)
class MotionCommand(Command):
    """Append a motion to the path. One that is not linked to an event is planned when loaded.

    ``notices`` are the numbers of messages that planning gave and that stop nothing.
    """

    motion: Motion
    notices: tuple[int, ...] = field(default=(), init=False)

    def reached(self, place: Place) -> Event:
        """The path passes one of the motion's places. Raises `CommandError` for any other."""
        event = Event(self, "reached", place.key)
        if place.key not in self.place_keys():
            raise CommandError(f"{event}: the motion has no such place")
        return event

    @property
    def apex(self) -> Event:
        """The middle of the blend behind the motion; nothing where it ends exactly."""
        return Event(self, "apex")

    def place_keys(self) -> frozenset[int]:
        """The keys of all places of the motion and of its parts."""
        motion = self.motion
        parts = (place for part in motion.parts for place in part.places)
        return frozenset(place.key for place in (*motion.places, *motion.stop_places, *parts))

    def __str__(self) -> str:
        return f"motion {self.motion.number} ({self.motion.kind})"


@dataclass(slots=True, eq=False)
class OutputCommand(Command):
    """Switch an output, or set any system variable; takes no time."""

    path: Path
    value: Value

    def __str__(self) -> str:
        return f"output {'.'.join(map(str, self.path))}"


@dataclass(slots=True, eq=False)
class WaitCommand(Command):
    """Let ``duration`` µs pass."""

    duration: int

    def __post_init__(self) -> None:
        if self.duration < 0:
            raise CommandError(f"{self}: no time passes backwards")

    def __str__(self) -> str:
        return f"wait of {self.duration} µs"


@dataclass(slots=True, eq=False)
class CallCommand(Command):
    """Have the core's owner do something: it receives ``started`` and calls `complete` at the end.

    ``what`` means something to the owner only, such as the routine of a trigger.
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
    """When ``event`` happens, and ``delay`` µs after it, ``effect`` is done to ``command``."""

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
    """Commands, and links between events and commands, that are loaded as one.

    What no link starts is started when the transaction is loaded, in the order given here.
    """

    def __init__(self, *commands: Command) -> None:
        self.commands: list[Command] = list(commands)
        self.links: list[Link] = []

    def add(self, *commands: Command) -> Transaction:
        """Further commands; returns the transaction."""
        self.commands += commands
        return self

    def link(self, event: Event, effect: Effect, command: Command, delay: int = 0) -> Transaction:
        """A link; its event may be that of a command loaded before. Returns the transaction."""
        self.links.append(Link(event, effect, command, delay))
        return self

    def unlinked(self) -> Iterator[Command]:
        """The commands that no link starts."""
        started = {link.command for link in self.links if link.effect == "start"}
        return (command for command in self.commands if command not in started)

    def check(self) -> None:
        """Raise `CommandError` where it makes no sense whatever else is loaded.

        A command stands in it once, and is started by the load or by something that can happen;
        links start no command of another transaction.
        """
        mine = set(self.commands)
        if len(mine) < len(self.commands):
            raise CommandError(f"{self}: a command occurs in it twice")
        starts = [link for link in self.links if link.effect == "start"]
        for link in starts:
            if link.command not in mine:
                raise CommandError(f"{link}: {link.command} is not of this transaction")
        reached = set(self.unlinked())
        while (
            further := {
                link.command
                for link in starts
                if link.event.command in reached or link.event.command not in mine
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
    """Something happened at ``time``.

    ``command`` is ``None`` for what only the arm knows of. ``key`` is that of a place, ``arm`` the
    arm's own word for it, and ``fault`` why a command failed.
    """

    time: int
    command: Command | None
    what: What
    key: int | None = None
    arm: ArmEvent | None = None
    fault: Fault | None = None
