"""A command under limits: what it said, how it ended, and that nothing of it goes on."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from support.parallel.limited_process import run_limited

MUCH = 1 << 40


def ignore(_text: str) -> None:
    pass


def python(code: str) -> list[str]:
    return [sys.executable, "-c", code]


def test_status_and_what_was_said_are_known() -> None:
    """All that a command says is heard, though a piece ends within a character."""
    said: list[str] = []
    code = "import sys; sys.stderr.buffer.write('ä€'.encode()*50_000); sys.exit(3)"
    assert 3 == run_limited(python(code), 600, MUCH, said.append)
    assert "ä€" * 50_000 == "".join(said)


def test_what_takes_too_long_is_cut_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """It has no status; what it said until then is known."""
    said: list[str] = []
    has_spoken = Event()
    wait = subprocess.Popen.wait

    def hear(text: str) -> None:
        said.append(text)
        has_spoken.set()

    def time_is_up(process: subprocess.Popen[bytes], seconds: float | None = None) -> int:
        if seconds is None:
            return wait(process)
        has_spoken.wait()
        raise subprocess.TimeoutExpired("it", seconds)

    monkeypatch.setattr(subprocess.Popen, "wait", time_is_up)
    code = "import sys, time; print('far', end='', file=sys.stderr, flush=True); time.sleep(1e6)"
    assert None is run_limited(python(code), 1, MUCH, hear)
    assert ["far"] == said


def test_what_takes_too_long_may_write_what_it_has(tmp_path: Path) -> None:
    """It is asked to end first."""
    file = tmp_path / "had"
    code = (
        "import signal, sys, time; from pathlib import Path;"
        f" signal.signal(signal.SIGTERM, lambda *_: sys.exit(Path({str(file)!r}).touch()));"
        " print('ready', file=sys.stderr, flush=True); time.sleep(1e6)"
    )
    said: list[str] = []
    seconds = 0.5
    while not said:  # on a slow machine it may not have begun
        assert None is run_limited(python(code), seconds, MUCH, said.append)
        seconds *= 2
    assert file.exists()


def test_time_passes() -> None:
    """Who sleeps longer than allowed is not waited for."""
    assert None is run_limited(python("import time; time.sleep(1e6)"), 0.01, MUCH, ignore)


@pytest.mark.skipif(sys.platform != "linux", reason="only there the limit holds")
def test_memory_has_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """What wants more than allowed fails, though its parent goes on only when it has ended."""

    class Late(subprocess.Popen[bytes]):
        def __init__(self, command: list[str], **options: Any) -> None:
            super().__init__(command, **options)
            os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOWAIT)

    monkeypatch.setattr(subprocess, "Popen", Late)
    said: list[str] = []
    assert 1 == run_limited(python("bytearray(1 << 32)"), 600, 1 << 30, said.append)
    assert "MemoryError" in "".join(said)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize(
    ("ending", "status"),
    [("SIGTERM", 128 + signal.SIGTERM), ("SIGKILL", -signal.SIGKILL)],
)
def test_the_end_of_who_runs_it_ends_all(tmp_path: Path, ending: str, status: int) -> None:
    """Who runs a command and is told to end, or killed, leaves neither it nor what it has started.

    All of them hold one end of a pipe, whose other end is read until nobody does. The signal comes
    as early as can be: the command itself sends it to who runs it.
    """
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    sleeper = "import time; time.sleep(1e6)"
    step = (
        f"import os, signal, subprocess, sys; held = open({str(pipe)!r}, 'w');"
        f" subprocess.Popen([sys.executable, '-c', {sleeper!r}], stdout=held);"
        f" os.kill(os.getppid(), signal.{ending}); {sleeper}"
    )
    run = (
        "import sys; from support.parallel.limited_process import run_limited;"
        f" run_limited([sys.executable, '-c', {step!r}], 1e6, {MUCH}, print)"
    )
    with subprocess.Popen(python(run)) as process, pipe.open("rb") as stream:
        assert b"" == stream.read()
        assert status == process.wait()
