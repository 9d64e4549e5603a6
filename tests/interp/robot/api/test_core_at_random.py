"""Transactions made at random: what holds of each of them, whatever it is."""

from collections import defaultdict
from random import Random
from typing import Any

import pytest

from interp.robot.api.commands import (
    Command,
    CommandError,
    CommandState,
    CoreEvent,
    Effect,
    Event,
    MotionCommand,
    OutputCommand,
    Transaction,
    WaitCommand,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Place

EFFECTS: tuple[Effect, ...] = ("start", "start", "start", "cancel", "stop")


def made(random: Random, make_motion: Any) -> tuple[Transaction, dict[Command, list[Event]]]:
    """A transaction, and which events start its commands."""
    commands: list[Command] = []
    for number in range(1, 9):
        match random.randrange(4):
            case 0:
                place = Place(number, "DISTANCE", 0.5, delay=random.randrange(-9, 700_000))
                commands.append(make_motion(number, random.randrange(1_000_000), place))
            case 1:
                commands.append(WaitCommand(random.choice((0, 0, random.randrange(900_000)))))
            case _:
                commands.append(OutputCommand(("$OUT", number), True))
    transaction, causes = Transaction(*commands), defaultdict(list)
    for _ in range(random.randrange(9)):
        cause, target = random.sample(commands, 2)
        events = [cause.started, cause.ended, cause.cancelled]
        if isinstance(cause, MotionCommand):
            events.append(cause.reached(cause.motion.places[0]))
        event, effect = random.choice(events), random.choice(EFFECTS)
        transaction.link(event, effect, target, random.choice((0, 0, 5_000)))
        if effect == "start":
            causes[target].append(event)
    return transaction, causes


def run(seed: int, arm: Any, make_motion: Any) -> tuple[Transaction, list[CoreEvent], Any] | None:
    transaction, causes = made(Random(seed), make_motion)
    core = ControlCore(arm, lambda *_: None, 1)
    try:
        core.load(0, transaction)
    except CommandError:
        assert {CommandState.CREATED} == {command.state for command in transaction.commands}
        return None
    return transaction, core.run_out(), causes


@pytest.mark.parametrize("first", range(0, 600, 100))
def test_what_holds_of_every_transaction(first: int, paced: Any, make_motion: Any) -> None:
    """Time never goes back, a command goes its way once, and it has a cause.

    Nothing that has been started lacks an end, and nothing waits for what cannot happen any more.
    """
    loaded = 0
    for seed in range(first, first + 100):
        done = run(seed, type(paced)(), make_motion)
        if done is None:
            continue
        transaction, events, causes = done
        loaded += 1
        assert sorted(event.time for event in events) == [event.time for event in events]
        seen: dict[Command, list[str]] = defaultdict(list)
        happened: set[Event] = set()
        for event in events:
            if event.command is None:
                continue
            if event.what == "started" and causes[event.command]:
                assert happened & set(causes[event.command]), seed
            happened.add(Event(event.command, event.what, event.key))
            if event.what != "reached":
                seen[event.command].append(event.what)
        for command in transaction.commands:
            assert command.state.is_over, (seed, str(command))
            assert seen[command] in (
                ["started", "ended"],
                ["started", "cancelled"],
                ["cancelled"],
            ), seed
            assert command.state.value == seen[command][-1]
    assert loaded > 30


def test_the_same_again(paced: Any, make_motion: Any) -> None:
    """Two runs of one transaction tell the same, event by event."""
    for seed in range(40):
        told = []
        for _ in range(2):
            done = run(seed, type(paced)(), make_motion)
            events = [] if done is None else done[1]
            told.append([(event.time, str(event.command), event.what) for event in events])
        assert told[0] == told[1]
