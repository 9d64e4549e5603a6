"""What the tests of several commands share."""

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from conformance.suite import case
from krl.running import project_folders


@pytest.fixture(scope="session", autouse=True)
def _own_cases_are_read_once() -> Iterator[None]:
    """Each command that runs cases reads all of the project first: here the first one only."""
    read: Callable[..., list[case.Case]] = case.find_cases
    own = cache(read)

    def find_cases(*given: Any) -> list[case.Case]:
        return read(*given) if given else list(own())

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(case, "find_cases", find_cases)
        yield


@pytest.fixture(scope="session", autouse=True)
def _few_files_are_looked_at_around_one() -> Iterator[None]:
    """The folders of thousands of tests lie beside one another: some hundreds are looked at."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(project_folders, "_MOST", 300)
        yield


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory of its own, in which nothing lies, and a cache of its own."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    monkeypatch.delenv("KRL_TRACEBACK", raising=False)
    return folder
