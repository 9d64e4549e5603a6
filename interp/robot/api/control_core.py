"""The control core: it loads transactions, follows the path of the arm, and executes links.

The core has no clock. Its owner asks `ControlCore.next_time`, and advances it to any time with
`ControlCore.run_until`, which returns the events up to that time. An effect of an event happens at
the very microsecond of the event, on the path as planned at that moment.
"""

from __future__ import annotations

import heapq
from collections import defaultdict
from collections.abc import Callable, Iterable
from itertools import count
from typing import Final

from interp.port.requests import Path, Value
from interp.robot.api.commands import (
    CallCommand,
    Command,
    CommandError,
    CommandState,
    CoreEvent,
    Effect,
    Event,
    Link,
    MotionCommand,
    OutputCommand,
    Transaction,
    WaitCommand,
    What,
)
from interp.robot.arm import Arm, ArmEvent
from interp.values.faults import Fault

#: Switches an output at a time in µs; may raise `Fault`.
Switch = Callable[[Path, Value, int], None]

_WHAT: Final[dict[str, What]] = {
    "motion_start": "started",
    "blend_start": "blend_start",
    "blend_apex": "apex",
    "blend_end": "blend_end",
    "motion_end": "ended",
    "place": "reached",
    "stopped": "stopped",
}

#: What may still happen to a motion that has ended, in the blend after it.
_BEHIND: Final = frozenset({"reached", "apex"})


class ControlCore:
    """Executes commands on one arm.

    ``cycle`` is the interpolation cycle in µs: a transaction takes effect at the next multiple of
    it; it is 1 for an owner whose own times are exact. Events at the same time are in the order of
    their causes: the effects of an event come before the next event of the path. `ValueError` is
    raised for a time before the present one.
    """

    def __init__(self, arm: Arm, switch: Switch, cycle: int) -> None:
        if cycle < 1:
            raise ValueError(f"an interpolation cycle of {cycle} µs")
        self.arm = arm
        self.now = 0
        self._switch = switch
        self._cycle = cycle
        self._events: list[CoreEvent] = []
        self._due: list[tuple[int, int, Effect | None, Command]] = []
        self._order = count()
        self._links: dict[Event, list[Link]] = defaultdict(list)
        #: Commands that wait for an event to start them, in their order.
        self._waiting: dict[Command, None] = {}
        #: Planned motions that have not ended, by number, in their order.
        self._motions: dict[int, MotionCommand] = {}
        #: Ended motions, as long as places in the blend after them may still be passed.
        self._behind: dict[int, MotionCommand] = {}
        #: The number of the motion that was planned before a motion, by the number of the latter.
        self._before: dict[int, int] = {}
        self._newest = 0
        self._last_number = 0
        self._is_ending = False

    # ---------------------------------------------------------------------------------- the owner

    def load(self, now: int, transaction: Transaction) -> int | None:
        """Load a transaction; return the time at which it takes effect, ``None`` if it is held.

        Raises `CommandError` if it is inconsistent, and the `Fault` of a motion that cannot be
        planned. In both cases nothing was loaded and no state of a command has changed.
        """
        at = -(-now // self._cycle) * self._cycle
        self._advance(at)
        self._check(transaction)
        first = list(transaction.unlinked())
        motions = [command for command in first if isinstance(command, MotionCommand)]
        self._plan_all(at, motions)
        for command in transaction.commands:
            command.state = CommandState.LINKED
            if isinstance(command, MotionCommand):
                self._last_number = command.motion.number
        for link in transaction.links:
            self._attach(link)
        for command in first:
            self._start(command)
        self._settle()
        return at

    def link(self, event: Event, effect: Effect, command: Command, delay: int = 0) -> None:
        """Add a link between loaded commands; raise `CommandError` if it is inconsistent."""
        link = Link(event, effect, command, delay)
        self._check_link(link, frozenset())
        if effect == "start" and command not in self._waiting:
            raise CommandError(f"{link}: it is not waiting for a start")
        self._attach(link)

    def next_time(self) -> int | None:
        """Return the time of the next event by the present plan; ``None`` if there is none."""
        ahead = self.arm.next_event()
        times = [self._due[0][0]] if self._due else []
        if ahead is not None:
            times.append(ahead.time)
        return min(times, default=None)

    def run_until(self, time: int) -> list[CoreEvent]:
        """Advance to a time, and return the events since the last call, in their order."""
        self._advance(time)
        events, self._events = self._events, []
        return events

    def run_out(self) -> list[CoreEvent]:
        """Advance until nothing more happens by itself; return the events as `run_until` does."""
        while (time := self.next_time()) is not None:
            self._advance(time)
        return self.run_until(self.now)

    def complete(self, now: int, command: CallCommand) -> None:
        """End a command that the owner has executed, unless it was cancelled meanwhile."""
        self._advance(now)
        if command.state is CommandState.ACTIVE:
            self._finish(command, CommandState.ENDED, "ended")
            self._settle()

    def apply(self, now: int, effect: Effect, command: Command) -> None:
        """Start, cancel or stop a loaded command, as a link from an event would."""
        self._advance(now)
        self._act(effect, command)
        self._settle()

    def release(self, now: int) -> None:
        """Load what is held back: no motion will follow before the arm is at rest.

        This core holds nothing back; `interp.robot.api.batch` does.
        """

    def pending(self) -> int:
        """Return the number of planned motions that have not ended."""
        return self.arm.pending()

    def brake(self, now: int, *, is_hard: bool) -> None:
        """Brake on the path; the event ``stopped`` says that the arm is at rest."""
        self._advance(now)
        self.arm.brake(now, is_hard)

    def proceed(self, now: int) -> None:
        """Continue after a brake, unless the brake is to end the motions; see `Arm.proceed`."""
        self._advance(now)
        if not self._is_ending:
            self.arm.proceed(now)

    def discard(self, now: int) -> None:
        """Discard what is not travelled yet: all motions are cancelled."""
        self._advance(now)
        self._is_ending = False
        self.arm.discard(now)
        motions, self._motions = list(self._motions.values()), {}
        self._drop_behind(list(self._behind))
        self._before.clear()
        for command in motions:
            self._finish(command, CommandState.CANCELLED, "cancelled")
        self._settle()

    def override(self, now: int, percent: float) -> None:
        """Apply a change of $OV_PRO."""
        self._advance(now)
        self.arm.override(now, percent)

    # ---------------------------------------------------------------------------------- the checks

    def _check(self, transaction: Transaction) -> None:
        transaction.check()
        own = frozenset(transaction.commands)
        number = self._last_number
        for command in transaction.commands:
            if command.state is not CommandState.CREATED:
                raise CommandError(f"{command}: it was loaded before")
            if isinstance(command, MotionCommand):
                if command.motion.number <= number:
                    raise CommandError(f"{command}: its number is not above {number}")
                number = command.motion.number
        for link in transaction.links:
            self._check_link(link, own)

    def _check_link(self, link: Link, own: frozenset[Command]) -> None:
        for command in (link.event.command, link.command):
            if command not in own and command.state is CommandState.CREATED:
                raise CommandError(f"{link}: {command} is not loaded")
        cause = link.event.command
        is_past = cause.state is CommandState.ACTIVE and link.event.what == "started"
        is_ahead = cause in self._behind.values() and link.event.what in _BEHIND
        if is_past or (cause.state.is_over and not is_ahead):
            raise CommandError(f"{link}: that can no longer happen")

    # ---------------------------------------------------------------------------- what time brings

    def _advance(self, time: int) -> None:
        if time < self.now:
            raise ValueError(f"time goes back from {self.now} to {time} µs")
        while (due := self.next_time()) is not None and due <= time:
            self.now = max(self.now, due)
            if self._is_due(due):
                self._act_when_due()
            else:
                self._handle_arm_event(self.arm.take())
        self.now = time

    def _settle(self) -> None:
        """Execute effects that are due now; events of the path need time to pass."""
        while self._is_due(self.now):
            self._act_when_due()

    def _is_due(self, time: int) -> bool:
        return bool(self._due) and self._due[0][0] <= time

    def _act_when_due(self) -> None:
        _, _, effect, command = heapq.heappop(self._due)
        if effect is None:  # the end of a wait
            if command.state is CommandState.ACTIVE:
                self._finish(command, CommandState.ENDED, "ended")
            return
        self._act(effect, command)

    def _handle_arm_event(self, event: ArmEvent) -> None:
        """Handle an event of the path."""
        what = _WHAT[event.kind]
        if event.kind == "stopped":
            self._emit(None, what, arm=event)
            if self._is_ending:
                self.discard(self.now)
            return
        command = self._motions.get(event.motion) or self._behind.get(event.motion)
        if event.kind == "motion_start" and command is not None:
            command.state = CommandState.ACTIVE
        if event.kind != "motion_end" or command is None:
            self._emit(command, what, key=event.key, arm=event)
            return
        del self._motions[event.motion]
        self._behind[event.motion] = command
        self._drop_behind([self._before.pop(event.motion, 0)])
        self._finish(command, CommandState.ENDED, "ended", arm=event)
        if not self._motions and self.arm.next_event() is None:
            self._drop_behind(list(self._behind))

    # ------------------------------------------------------------------------------------ effects

    def _act(self, effect: Effect, command: Command) -> None:
        if effect == "start":
            if command.state is CommandState.LINKED and not self._is_planned(command):
                self._begin(command)
        elif command.state.is_over or command.state is CommandState.CREATED:
            return
        elif self._is_planned(command):
            self._end_path(is_hard=effect == "stop")
        else:
            self._finish(command, CommandState.CANCELLED, "cancelled")

    def _is_planned(self, command: Command) -> bool:
        return isinstance(command, MotionCommand) and command.motion.number in self._motions

    def _begin(self, command: Command) -> None:
        """Start a command because of an event; a motion is planned only now."""
        self._waiting.pop(command, None)
        if isinstance(command, MotionCommand):
            try:
                self._plan_all(self.now, [command])
            except Fault as fault:
                self._finish(command, CommandState.FAILED, "failed", fault=fault)
                return
        self._start(command)

    def _plan_all(self, now: int, commands: Iterable[MotionCommand]) -> None:
        """Plan all motions or none; raise the `Fault` of the first that cannot be planned."""
        rewind = self.arm.mark()
        planned: dict[int, MotionCommand] = {}
        notices: list[tuple[int, ...]] = []
        try:
            for command in commands:
                notices.append(self.arm.plan(now, command.motion))
                planned[command.motion.number] = command
        except Fault:
            if planned:
                rewind()
            raise
        for (number, command), words in zip(planned.items(), notices, strict=True):
            command.notices = words
            self._before[number], self._newest = self._newest, number
        self._motions |= planned

    def _start(self, command: Command) -> None:
        match command:
            case MotionCommand():
                return  # it is planned, and starts when the arm reaches it
            case OutputCommand(path=path, value=value):
                command.state = CommandState.ACTIVE
                self._emit(command, "started")
                try:
                    self._switch(path, value, self.now)
                except Fault as fault:
                    self._finish(command, CommandState.FAILED, "failed", fault=fault)
                else:
                    self._finish(command, CommandState.ENDED, "ended")
            case _:
                command.state = CommandState.ACTIVE
                self._emit(command, "started")
                if isinstance(command, WaitCommand):
                    self._schedule(command.duration, None, command)

    def _end_path(self, *, is_hard: bool) -> None:
        """Brake and cancel all motions: the path is one, so ending one motion ends them all."""
        self._is_ending = True
        self.arm.brake(self.now, is_hard)
        is_moving = any(one.state is CommandState.ACTIVE for one in self._motions.values())
        if not is_moving or self.arm.next_event() is None:
            self.discard(self.now)

    def _finish(
        self,
        command: Command,
        state: CommandState,
        what: What,
        *,
        arm: ArmEvent | None = None,
        fault: Fault | None = None,
    ) -> None:
        command.state = state
        self._waiting.pop(command, None)
        self._emit(command, what, arm=arm, fault=fault)
        is_behind = command in self._behind.values()
        self._drop(command, _BEHIND if is_behind else frozenset())

    # -------------------------------------------------------------------------------------- links

    def _attach(self, link: Link) -> None:
        self._links[link.event].append(link)
        if link.effect == "start":
            self._waiting[link.command] = None

    def _emit(
        self,
        command: Command | None,
        what: What,
        *,
        key: int | None = None,
        arm: ArmEvent | None = None,
        fault: Fault | None = None,
    ) -> None:
        """Record an event, and execute its links at once or after their delays."""
        self._events.append(CoreEvent(self.now, command, what, key, arm, fault))
        if command is None:
            return
        for link in self._links.pop(Event(command, what, key), ()):
            # Effects that are due at once are queued too, so that all effects are in order.
            self._schedule(link.delay, link.effect, link.command)

    def _schedule(self, delay: int, effect: Effect | None, command: Command) -> None:
        heapq.heappush(self._due, (self.now + delay, next(self._order), effect, command))

    def _drop(self, command: Command, but: frozenset[str] = frozenset()) -> None:
        """Remove links from the events of a command that can no longer happen, except ``but``."""
        lost = [e for e in self._links if e.command is command and e.what not in but]
        gone = [link for event in lost for link in self._links.pop(event)]
        if any(link.effect == "start" for link in gone):
            self._cancel_deadlocked()

    def _drop_behind(self, numbers: Iterable[int]) -> None:
        for number in numbers:
            command = self._behind.pop(number, None)
            if command is not None:
                self._drop(command)

    def _cancel_deadlocked(self) -> None:
        """Cancel commands that wait for nothing or only for one another, the first one first."""
        while (deadlocked := self._first_deadlocked()) is not None:
            self._finish(deadlocked, CommandState.CANCELLED, "cancelled")

    def _first_deadlocked(self) -> Command | None:
        coming = {command for _, _, effect, command in self._due if effect == "start"}
        links = [link for each in self._links.values() for link in each if link.effect == "start"]
        while (
            more := {
                link.command
                for link in links
                if link.event.command in coming or link.event.command not in self._waiting
            }
            - coming
        ):
            coming |= more
        return next((one for one in self._waiting if one not in coming), None)
