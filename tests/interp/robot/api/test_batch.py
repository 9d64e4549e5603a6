"""The batch strategy: what waits, what goes, and when."""

from collections.abc import Callable
from typing import Any

import pytest

from interp.port.requests import Path, Value
from interp.robot.api.batch import BatchCore
from interp.robot.api.commands import (
    CommandError,
    CommandState,
    MotionCommand,
    OutputCommand,
    Transaction,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Place
from interp.values.faults import Fault

Make = Callable[..., MotionCommand]
BLENDED = ("C_DIS",)


@pytest.fixture
def switched() -> list[tuple[int, Path]]:
    return []


@pytest.fixture
def core(paced: Any, switched: list[tuple[int, Path]]) -> BatchCore:
    def switch(path: Path, value: Value, time: int) -> None:
        assert value is True
        switched.append((time, path))

    return BatchCore(paced, switch, cycle=1)


def test_the_batch_goes_with_its_last_motion(core: BatchCore, make_motion: Make) -> None:
    """Motions that are to be blended wait for the first that is not; the delay shows."""
    first, second, last = make_motion(1, criteria=BLENDED), make_motion(2, criteria=BLENDED), None
    assert core.load(0, Transaction(first)) is None
    assert core.load(50_000, Transaction(second)) is None
    assert (2, 0, None) == (core.held, core.pending(), core.next_time())
    last = make_motion(3)
    assert 90_000 == core.load(90_000, Transaction(last))
    assert (0, 3, 90_000) == (core.held, core.pending(), core.next_time())
    core.run_until(4_000_000)
    assert [CommandState.ENDED] * 3 == [first.state, second.state, last.state]


def test_look_ahead_has_no_such_delay(paced: Any, make_motion: Make) -> None:
    """The same motions start with the first of them where nothing is held back."""
    core = ControlCore(paced, lambda *_: None, cycle=1)
    core.load(0, Transaction(make_motion(1, criteria=BLENDED)))
    core.release(0)
    core.load(50_000, Transaction(make_motion(2)))
    events = core.run_until(5_000_000)
    assert [0, 1_000_000] == [event.time for event in events if event.what == "started"]


def test_release(core: BatchCore, switched: list[tuple[int, Path]], make_motion: Make) -> None:
    """An advance stop lets the batch go, with the triggers that wait in it."""
    place = Place(1, "DISTANCE", 0.5)
    motion = make_motion(1, 1_000_000, place, criteria=BLENDED)
    gas = OutputCommand(("$OUT", 1), True)
    core.load(0, Transaction(motion, gas).link(motion.reached(place), "start", gas))
    core.release(20_000)
    core.run_until(2_000_000)
    assert [(520_000, ("$OUT", 1))] == switched


def test_what_has_no_motion(
    core: BatchCore, switched: list[tuple[int, Path]], make_motion: Make
) -> None:
    """An output is switched at once, but waits where it is linked to a motion that waits."""
    motion = make_motion(1, criteria=BLENDED)
    core.load(0, Transaction(motion))
    at_once, later = OutputCommand(("$OUT", 1), True), OutputCommand(("$OUT", 2), True)
    assert 10 == core.load(10, Transaction(at_once))
    assert core.load(10, Transaction(later).link(motion.started, "start", later)) is None
    core.release(30)
    core.run_until(40)
    assert [(10, ("$OUT", 1)), (30, ("$OUT", 2))] == switched


def test_a_fault_cancels_the_batch(core: BatchCore, make_motion: Make) -> None:
    """A fault is found when the batch goes; then none of its motions is executed."""
    first, bad, last = (
        make_motion(1, criteria=BLENDED),
        make_motion(2, kind="CIRC", criteria=BLENDED),
        make_motion(3),
    )
    core.load(0, Transaction(first))
    core.load(0, Transaction(bad))
    with pytest.raises(Fault, match="circle"):
        core.load(5, Transaction(last))
    assert [CommandState.CANCELLED, CommandState.CANCELLED, CommandState.CREATED] == [
        *(first.state, bad.state),
        last.state,
    ]
    assert (0, None) == (core.held, core.next_time())
    assert ["cancelled"] * 2 == [event.what for event in core.run_until(5)]
    assert 6 == core.load(6, Transaction(last))


def test_nonsense_is_refused_before_it_is_held(core: BatchCore, make_motion: Make) -> None:
    """The numbers of motions rise over the whole batch."""
    core.load(0, Transaction(make_motion(2, criteria=BLENDED)))
    with pytest.raises(CommandError, match="not above 2"):
        core.load(0, Transaction(make_motion(1, criteria=BLENDED)))
    assert 1 == core.held


def test_discard(core: BatchCore, make_motion: Make) -> None:
    """What is held is forgotten with what is planned."""
    motion = make_motion(1, criteria=BLENDED)
    core.load(0, Transaction(motion))
    core.discard(10)
    core.release(20)
    assert (CommandState.CANCELLED, 0, None) == (motion.state, core.pending(), core.next_time())
