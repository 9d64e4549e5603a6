"""Programs from texts, run in the stub world."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from conformance.differential.observation import Observed, observe
from conformance.differential.random_world import QuietWorld
from grammar.syntax.source import Source
from interp.program.load import Limits, load
from interp.tree import TreeExecutor

Runner = Callable[..., Observed]


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

    def ran(text: str, limits: Limits | None = None, most: int = 10_000, **more: str) -> Observed:
        return observe(lambda sink: make(text, limits, sink, **more), QuietWorld(), most)

    return ran
