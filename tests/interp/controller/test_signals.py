"""Groups of signals that a check would refuse, and that a program which runs all the same meets."""

import pytest

from interp.controller.state.clock import Clock
from interp.controller.state.profile import Profile
from interp.controller.state.signals import Signals
from interp.values.faults import Fault


@pytest.fixture
def signals() -> Signals:
    """Signals that nobody watches."""
    return Signals(Profile.load("kss8"), Clock(12_000), lambda *_: None, lambda *_: None)


@pytest.mark.parametrize(
    ("array", "first", "last", "fault"),
    [
        ("$OUT", 1, 33, "index"),
        ("$OUT", 1, 40, "index"),
        ("$OUT", 2, 1, "index"),
        ("$OUT", 0, 3, "index"),
        ("$ANOUT", 1, 2, "inadmissible"),
    ],
)
def test_no_such_group(signals: Signals, array: str, first: int, last: int, fault: str) -> None:
    """A group has up to 32 digital signals [IOT-03]; reading and writing another is a fault."""
    path = (array, first, "TO", last)
    for act in (lambda: signals.read(path), lambda: signals.write(path, 1)):
        with pytest.raises(Fault) as raised:
            act()
        assert fault == raised.value.slug


def test_largest_group(signals: Signals) -> None:
    """32 signals are one group."""
    signals.write(("$OUT", 2, "TO", 33), -1)
    assert -1 == signals.read(("$OUT", 2, "TO", 33))
    assert False is signals.read(("$OUT", 1))
