"""The control core: what transactions do, when, and what happens if they cannot."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.port.requests import Path, Value
from interp.robot.api.commands import (
    CallCommand,
    Command,
    CommandError,
    CommandState,
    CoreEvent,
    MotionCommand,
    OutputCommand,
    Transaction,
    WaitCommand,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Place
from interp.values.faults import Fault

Make = Callable[..., MotionCommand]


class Outputs(list[tuple[int, Path, Value]]):
    """What was switched, and when."""

    def __call__(self, path: Path, value: Value, time: int) -> None:
        """Keep it; there is no output 0."""
        if path == ("$OUT", 0):
            raise Fault("index", "an array index lies outside the array", number=1444)
        self.append((time, path, value))


@pytest.fixture
def outputs() -> Outputs:
    return Outputs()


@pytest.fixture
def core(paced: Any, outputs: Outputs) -> ControlCore:
    return ControlCore(paced, outputs, cycle=1)


def brief(events: list[CoreEvent]) -> list[tuple[int, str, str]]:
    return [(event.time, str(event.command), event.what) for event in events]


def output(number: int = 1) -> OutputCommand:
    return OutputCommand(("$OUT", number), True)


def test_gas_on_when_the_ignition_ends(
    core: ControlCore, outputs: Outputs, make_motion: Make
) -> None:
    """What is linked to the end of a motion happens at the very microsecond of it."""
    ignite, gas = make_motion(1, 1_234_567), output()
    core.load(1_000, Transaction(ignite, gas).link(ignite.ended, "start", gas))
    assert 1_000 == core.next_time()
    assert [(1_000, "motion 1 (LIN)", "started")] == brief(core.run_until(1_235_566))
    assert (CommandState.ACTIVE, CommandState.LINKED) == (ignite.state, gas.state)
    assert [
        (1_235_567, "motion 1 (LIN)", "ended"),
        (1_235_567, "output $OUT.1", "started"),
        (1_235_567, "output $OUT.1", "ended"),
    ] == brief(core.run_until(5_000_000))
    assert [(1_235_567, ("$OUT", 1), True)] == outputs
    assert (CommandState.ENDED, CommandState.ENDED) == (ignite.state, gas.state)
    assert core.next_time() is None


def test_a_delay_and_a_place(core: ControlCore, outputs: Outputs, make_motion: Make) -> None:
    """A place has its own delay, which may be negative; a link adds one that may not."""
    place = Place(7, "DISTANCE", 0.5, delay=-20_000)
    motion, first, second = make_motion(1, 1_000_000, place), output(1), output(2)
    core.load(
        0,
        Transaction(motion, first, second)
        .link(motion.reached(place), "start", first)
        .link(motion.reached(place), "start", second, delay=5_000),
    )
    core.run_until(1_000_000)
    assert [(480_000, ("$OUT", 1), True), (485_000, ("$OUT", 2), True)] == outputs


def test_a_transaction_takes_effect_on_the_cycle(
    paced: Any, outputs: Outputs, make_motion: Make
) -> None:
    """What is loaded between two interpolation cycles begins with the next one, all of it."""
    core = ControlCore(paced, outputs, cycle=12_000)
    motion, gas = make_motion(1), output()
    assert 24_000 == core.load(12_001, Transaction(motion, gas))
    assert [(24_000, ("$OUT", 1), True)] == outputs
    assert 24_000 == core.next_time()
    assert 24_000 == core.load(24_000, Transaction(WaitCommand(1)))


def test_all_or_nothing(core: ControlCore, outputs: Outputs, make_motion: Make) -> None:
    """Where the last motion of a transaction has a fault, the first never starts."""
    before = make_motion(1)
    core.load(0, Transaction(before))
    good, bad, gas = make_motion(2), make_motion(3, kind="CIRC"), output()
    with pytest.raises(Fault, match="circle"):
        core.load(500, Transaction(gas, good, bad).link(before.ended, "cancel", good))
    assert [CommandState.CREATED] * 3 == [good.state, bad.state, gas.state]
    assert [] == outputs
    assert (1, [(0, "started"), (1_000_000, "ended")]) == (
        core.pending(),
        [(event.time, event.what) for event in core.run_until(5_000_000)],
    )
    core.load(5_000_000, Transaction(good))
    assert 1 == core.pending()


def test_a_chain(core: ControlCore, outputs: Outputs, make_motion: Make) -> None:
    """Motion, wait, output, motion: each starts the next; the effects of one come at once."""
    first, wait, gas, second = make_motion(1), WaitCommand(250_000), output(), make_motion(2)
    core.load(
        0,
        Transaction(first, wait, gas, second)
        .link(first.ended, "start", wait)
        .link(wait.ended, "start", gas)
        .link(gas.ended, "start", second),
    )
    core.run_until(10_000_000)
    assert [(1_250_000, ("$OUT", 1), True)] == outputs
    assert [CommandState.ENDED] * 4 == [first.state, wait.state, gas.state, second.state]


def test_causes_come_before_the_next_event_of_the_path(
    core: ControlCore, make_motion: Make
) -> None:
    """Two motions follow without a gap: what the end of one starts comes before the other."""
    first, second, gas = make_motion(1), make_motion(2), output()
    core.load(0, Transaction(first, second, gas).link(first.ended, "start", gas))
    assert [
        ("motion 1 (LIN)", "started"),
        ("motion 1 (LIN)", "ended"),
        ("output $OUT.1", "started"),
        ("output $OUT.1", "ended"),
        ("motion 2 (LIN)", "started"),
    ] == [(command, what) for _, command, what in brief(core.run_until(1_500_000))]


def test_a_place_behind_the_end_outlasts_an_interruption(
    core: ControlCore, paced: Any, outputs: Outputs, make_motion: Make
) -> None:
    """Braked in a blend, and moved elsewhere meanwhile, the place is still reached afterwards."""
    place = Place(1, "DISTANCE", 1.0, delay=50_000)
    first, second, gas = make_motion(1, 1_000_000, place), make_motion(2), output()
    core.load(0, Transaction(first, second, gas).link(first.reached(place), "start", gas))
    core.brake(1_020_000, is_hard=True)
    core.run_until(1_030_000)
    rest, paced.standing, paced.free_from = paced.standing, [], 1_030_000
    aside = make_motion(3, 100_000)
    core.load(1_030_000, Transaction(aside))
    core.run_until(1_200_000)
    assert (CommandState.ENDED, CommandState.LINKED) == (aside.state, gas.state)
    paced.standing = [replace(event, time=event.time + 200_000) for event in rest]
    core.proceed(1_200_000)
    core.run_until(9_000_000)
    assert [(1_260_000, ("$OUT", 1), True)] == outputs


def test_cancelling_a_motion_brakes(core: ControlCore, paced: Any, make_motion: Make) -> None:
    """The arm brakes on its path; then that motion and those behind it are cancelled."""
    first, second, gas, alarm = make_motion(1), make_motion(2), output(1), output(2)
    watch = WaitCommand(300_000)
    core.load(
        0,
        Transaction(first, second, gas, watch, alarm)
        .link(watch.ended, "cancel", first)
        .link(second.ended, "start", gas)
        .link(first.cancelled, "start", alarm),
    )
    events = brief(core.run_until(2_000_000))
    assert ["brake at 300000", "discard at 310000"] == paced.calls
    assert (310_000, "None", "stopped") in events
    assert (310_000, "motion 2 (LIN)", "cancelled") in events
    assert (310_000, "output $OUT.1", "cancelled") in events
    assert (CommandState.CANCELLED, CommandState.CANCELLED) == (first.state, second.state)
    assert (CommandState.CANCELLED, CommandState.ENDED) == (gas.state, alarm.state)
    assert core.next_time() is None


def test_brake_and_proceed(core: ControlCore, paced: Any, make_motion: Make) -> None:
    """A brake ends nothing by itself: events come later by the time it took."""
    motion = make_motion(1)
    core.load(0, Transaction(motion))
    core.brake(500_000, is_hard=True)
    assert (510_000, "None", "stopped") == brief(core.run_until(510_000))[-1]
    assert (None, 1, CommandState.ACTIVE) == (core.next_time(), core.pending(), motion.state)
    core.proceed(510_000)
    assert [(1_010_000, "motion 1 (LIN)", "ended")] == brief(core.run_until(2_000_000))
    assert ["stop at 500000", "proceed at 510000"] == paced.calls


def test_discard(core: ControlCore, outputs: Outputs, make_motion: Make) -> None:
    """All motions are cancelled, and triggers of theirs never fire."""
    place = Place(1, "DISTANCE", 1.0)
    motion, gas = make_motion(1, 1_000_000, place), output()
    core.load(0, Transaction(motion, gas).link(motion.reached(place), "start", gas))
    core.brake(500_000, is_hard=False)
    core.discard(510_000)
    core.run_until(9_000_000)
    assert ([], CommandState.CANCELLED, CommandState.CANCELLED) == (
        outputs,
        motion.state,
        gas.state,
    )
    assert 0 == core.pending()


def test_a_linked_motion_that_cannot_be_planned(core: ControlCore, make_motion: Make) -> None:
    """Its fault is told as an event, which others can be linked to; the arm stands by then."""
    first, bad, alarm = make_motion(1), make_motion(2, kind="CIRC"), output()
    core.load(
        0,
        Transaction(first, bad, alarm)
        .link(first.ended, "start", bad)
        .link(bad.failed, "start", alarm),
    )
    failed = [event for event in core.run_until(2_000_000) if event.what == "failed"]
    assert [(1_000_000, bad)] == [(event.time, event.command) for event in failed]
    assert failed[0].fault is not None
    assert (1456, CommandState.ENDED) == (failed[0].fault.number, alarm.state)


def test_an_output_that_cannot_be_switched(core: ControlCore) -> None:
    """Its fault is told as an event and ends the command."""
    bad = output(0)
    core.load(0, Transaction(bad))
    last = core.run_until(0)[-1]
    assert ("failed", CommandState.FAILED) == (last.what, bad.state)
    assert last.fault is not None
    assert 1444 == last.fault.number


def test_a_call_lasts_until_it_is_completed(core: ControlCore, make_motion: Make) -> None:
    """The owner is told that a call starts, with what it is for, and says when it has ended."""
    motion, call, gas = make_motion(1), CallCommand("routine 5"), output()
    core.load(
        0,
        Transaction(motion, call, gas)
        .link(motion.started, "start", call)
        .link(call.ended, "start", gas),
    )
    assert [(0, "call routine 5", "started")] == brief(core.run_until(10))[1:]
    core.complete(700, call)
    assert (CommandState.ENDED, CommandState.ENDED) == (call.state, gas.state)
    core.complete(800, call)
    assert ["ended", "started", "ended"] == [event.what for event in core.run_until(900)]


def test_either_of_two_causes(core: ControlCore, outputs: Outputs) -> None:
    """A command with two causes starts with the first, once; it is cancelled only without both."""
    one, two, three, gas = WaitCommand(10), WaitCommand(20), WaitCommand(5), output()
    core.load(
        0,
        Transaction(one, two, three, gas)
        .link(three.ended, "cancel", one)
        .link(one.ended, "start", gas)
        .link(two.ended, "start", gas),
    )
    core.run_until(15)
    assert (CommandState.CANCELLED, CommandState.LINKED) == (one.state, gas.state)
    core.run_until(30)
    assert [(20, ("$OUT", 1), True)] == outputs


def test_links_to_what_is_loaded(core: ControlCore, outputs: Outputs, make_motion: Make) -> None:
    """A later transaction may wait for commands of an earlier one, and links can be added."""
    motion, gas, off = make_motion(1), output(1), output(2)
    core.load(0, Transaction(motion))
    core.load(
        100, Transaction(gas, off).link(motion.ended, "start", gas).link(gas.failed, "start", off)
    )
    core.link(gas.ended, "start", off, delay=7)
    core.run_until(2_000_000)
    assert [(1_000_000, ("$OUT", 1), True), (1_000_007, ("$OUT", 2), True)] == outputs


def nonsense(make: Make) -> dict[str, tuple[Transaction, str]]:
    """Transactions that make no sense, and what is said of them."""
    one, two, three = output(1), output(2), output(3)
    return {
        "twice": (Transaction(one, one), "occurs in it twice"),
        "number": (Transaction(make(2), make(1)), "its number is not above 2"),
        "stranger": (Transaction(one).link(two.ended, "start", one), "is not loaded"),
        "foreign": (Transaction(one).link(one.ended, "start", two), "not of this transaction"),
        "circle": (
            Transaction(one, two, three)
            .link(one.ended, "start", two)
            .link(two.ended, "start", one),
            "waits for it",
        ),
    }


@pytest.mark.parametrize("name", ["twice", "number", "stranger", "foreign", "circle"])
def test_nonsense(core: ControlCore, outputs: Outputs, make_motion: Make, name: str) -> None:
    """A transaction that makes no sense is refused in one line, and nothing of it happens."""
    transaction, said = nonsense(make_motion)[name]
    with pytest.raises(CommandError, match=said):
        core.load(0, transaction)
    assert [] == outputs
    assert {CommandState.CREATED} == {command.state for command in transaction.commands}


def test_what_is_past(core: ControlCore, make_motion: Make) -> None:
    """A command is loaded once, and nothing waits for what has happened."""
    motion: Command = make_motion(1)
    core.load(0, Transaction(motion))
    with pytest.raises(CommandError, match="it was loaded before"):
        core.load(0, Transaction(motion))
    core.run_until(10)
    gas = output()
    with pytest.raises(CommandError, match="can no longer happen"):
        core.load(20, Transaction(gas).link(motion.started, "start", gas))
    core.run_until(2_000_000)
    with pytest.raises(CommandError, match="can no longer happen"):
        core.load(2_000_000, Transaction(gas).link(motion.ended, "start", gas))
    with pytest.raises(ValueError, match="time goes back"):
        core.run_until(1_000)


def test_places_and_delays_are_checked(make_motion: Make) -> None:
    """A place has to be the motion's own; a link does not act before its cause."""
    motion = make_motion(1)
    with pytest.raises(CommandError, match="no such place"):
        motion.reached(Place(1, "DISTANCE", 0.0))
    with pytest.raises(CommandError, match="cannot precede its cause"):
        Transaction(motion).link(motion.started, "start", output(), delay=-1)
    with pytest.raises(CommandError, match="backwards"):
        WaitCommand(-1)


def test_the_override_is_passed_on(core: ControlCore, paced: Any) -> None:
    """An override that changes reaches the arm when the owner says so."""
    core.override(3, 50)
    assert ["override 50 at 3"] == paced.calls
