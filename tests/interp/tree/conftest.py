"""Programs from texts, run in the stub world."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pytest

from grammar.syntax.source import Source
from interp.bench.stub_controller import Outcome, StubController, run
from interp.port.events import Recorder
from interp.port.requests import Path, Request
from interp.program.load import Limits, load
from interp.tree import TreeExecutor


@dataclass(frozen=True)
class Ran:
    """A run: what was asked, and what was told."""

    outcome: Outcome
    recorder: Recorder

    @property
    def last(self) -> Request:
        """The request it ended with."""
        return self.outcome.last

    def asked(self, kind: type[Any]) -> list[Any]:
        """All requests of a kind."""
        return [one for one in self.outcome.requests if isinstance(one, kind)]

    def told(self, kind: str) -> list[Any]:
        """All events of a kind."""
        return [one for one in self.recorder.events if one.kind == kind]

    def values(self, *path: str | int) -> list[Any]:
        """What was assigned to a variable, one after the other."""
        wanted: Path = path
        return [one.value for one in self.told("assign") if one.path == wanted]


Runner = Callable[..., Ran]


def executor_of(
    files: Mapping[str, str], limits: Limits | None = None, sink: Any = None
) -> TreeExecutor:
    """An executor for files by name; the first of them is the one to begin with."""
    sources = [Source(text, path) for path, text in files.items()]
    return TreeExecutor(load(sources, next(iter(files))), limits=limits, sink=sink)


@pytest.fixture
def make() -> Callable[..., TreeExecutor]:
    """Makes an executor from the text of ``main.src`` and of other files."""

    def made(text: str, limits: Limits | None = None, sink: Any = None, **more: str) -> Any:
        files = {"main.src": text}
        files |= {name.replace("_", "."): other for name, other in more.items()}
        return executor_of(files, limits, sink)

    return made


@pytest.fixture
def go(make: Callable[..., TreeExecutor]) -> Runner:
    """Runs ``main.src`` and gives what happened."""

    def ran(text: str, limits: Limits | None = None, most: int = 10_000, **more: str) -> Ran:
        recorder = Recorder()
        executor = make(text, limits, recorder, **more)
        return Ran(run(executor, StubController(), most), recorder)

    return ran
