"""Programs from texts, run on each executor in the stub world."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from conformance.differential.random_world import QuietWorld
from conformance.differential.undisturbed_run import Observed, observe
from grammar.syntax.source import Source
from interp.executors import EXECUTORS, Prepared, is_available
from interp.port.events import ExecutorEvent, Sink
from interp.port.executor import Executor
from interp.program.load import Limits, load

Make = Callable[..., Executor]
Run = Callable[..., Observed]


@pytest.fixture(params=EXECUTORS)
def executor_name(request: pytest.FixtureRequest) -> str:
    """An executor that can run here."""
    if not is_available(request.param):
        pytest.skip("the machine in C was not built")
    return str(request.param)


@pytest.fixture
def make(executor_name: str) -> Make:
    """Makes an executor from the text of ``main.src``; ``lib_dat`` is the text of ``lib.dat``."""

    def made(
        text: str,
        limits: Limits | None = None,
        sink: Sink | None = None,
        *,
        strict: bool = True,
        **more: str,
    ) -> Executor:
        sources = [Source(text, "main.src")]
        sources += [Source(other, file.replace("_", ".")) for file, other in more.items()]
        prepared = Prepared(load(sources, "main.src", strict=strict))
        return prepared.executor(executor_name, limits or Limits(), sink)

    return made


@pytest.fixture
def go(make: Make) -> Run:
    """Runs ``main.src``, and once more without a trace, which changes no request."""

    def ran(text: str, limits: Limits | None = None, most: int = 10_000, **more: Any) -> Observed:
        found = observe(lambda sink: make(text, limits, sink, **more), QuietWorld(), most)
        silent = observe(lambda _sink: make(text, limits, **more), QuietWorld(), most)
        asked = [repr(one) for one in found.steps if not isinstance(one, ExecutorEvent)]
        assert asked == list(map(repr, silent.steps))
        return found

    return ran
