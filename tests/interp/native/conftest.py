"""The machine in C; without it, what is here is left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

from conformance.differential.random_world import QuietWorld
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.verifier.verify import Verified, verify
from interp.bytecode.vm import executor
from interp.native import AVAILABLE
from interp.port.events import Recorder
from interp.port.requests import Crash, End, Fail, Request
from interp.program.load import Limits

if TYPE_CHECKING:
    from interp.native._core import Core


@pytest.fixture(autouse=True)
def _built() -> None:
    if not AVAILABLE:
        pytest.skip("the machine in C was not built")


@pytest.fixture
def native() -> type[executor.Machine]:
    """The machine in C."""
    from interp.native.machine import Machine

    return Machine


@pytest.fixture
def core() -> type[Core]:
    """The type that C makes."""
    from interp.native._core import Core

    return Core


def steps_of(
    kind: type[executor.Machine], verified: Verified, is_traced: bool, most: int
) -> list[Any]:
    """What a machine asks, and tells if it is to, as text: so that faults can be compared."""
    recorder = Recorder() if is_traced else None
    machine = kind(verified, "MAIN", Limits(statements=400, per_slice=30, depth=6), recorder)
    world, reply = QuietWorld(), None
    found: list[str] = []
    for _ in range(most):
        request: Request = machine.advance(reply)
        if recorder is not None:
            found += map(repr, recorder.events)
            recorder.events.clear()
        found.append(repr(request))
        if isinstance(request, End | Fail | Crash):
            assert not isinstance(request, Crash), request
            break
        reply = world.reply(request)
    return [*found, repr(machine.data())]


Compare = Callable[[str], list[Any]]


@pytest.fixture(scope="session")
def agreed() -> Compare:
    """Runs a text on both machines, with and without a trace; gives what all of them ask."""

    def compare(text: str, most: int = 400) -> list[Any]:
        from interp.native.machine import Machine

        verified = verify(assemble(text))
        for is_traced in (True, False):
            expected = steps_of(executor.Machine, verified, is_traced, most)
            assert expected == steps_of(Machine, verified, is_traced, most)
        return expected

    return compare
