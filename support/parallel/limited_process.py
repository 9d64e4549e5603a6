"""Running a command with limits on time and memory; none of its processes outlives it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from threading import Thread, current_thread, main_thread


def run_limited(
    command: Sequence[str],
    seconds: float,
    memory: int,
    hear: Callable[[str], object],
    environment: Mapping[str, str] | None = None,
) -> int | None:
    """Return the exit status of a command, or ``None`` if it took longer than ``seconds``.

    ``memory`` limits the address space of each of its processes in bytes; only Linux enforces it.
    ``hear`` is called from a thread with everything the command writes to standard error, piece by
    piece, before this function returns. All processes of the command are killed at the end, also if
    this process receives SIGTERM. A command that cannot be started raises OSError; on Linux it has
    the status 127 instead.
    """
    if sys.platform == "linux":  # by a shell: set from here, the limit could come too late
        limited = f'ulimit -v {memory // 1024} && exec "$@"'
        command = ["/bin/sh", "-c", limited, "sh", *command]
    with _ended_by_termination() as started:
        process = subprocess.Popen(
            command,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env=environment,
            start_new_session=True,
        )
        reader = Thread(target=_pass_on, args=(process, hear), daemon=True)
        try:
            reader.start()
            started(process)
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None
        finally:
            _kill(process)
            process.wait()
            reader.join()


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and, on systems with process groups, everything it started."""
    if sys.platform == "win32":
        process.kill()
        return
    with suppress(ProcessLookupError, PermissionError):  # all of them have ended
        os.killpg(process.pid, signal.SIGKILL)


@contextmanager
def _ended_by_termination() -> Iterator[Callable[[subprocess.Popen[bytes]], None]]:
    """Yield a function that registers a process to be killed when this process gets SIGTERM.

    SIGTERM also ends this process. It may have arrived before the registration.
    """
    running: list[subprocess.Popen[bytes]] = []
    signals: list[int] = []

    def started(process: subprocess.Popen[bytes]) -> None:
        running.append(process)
        if signals:
            _kill(process)

    def end(number: int, _frame: object) -> None:
        signals.append(number)
        for process in running:
            _kill(process)

    if current_thread() is not main_thread():  # only the main thread may set a handler
        yield started
        return
    before = signal.signal(signal.SIGTERM, end)
    try:
        yield started
    finally:
        signal.signal(signal.SIGTERM, before)
        if signals:
            raise SystemExit(128 + signals[0])


def _pass_on(process: subprocess.Popen[bytes], hear: Callable[[str], object]) -> None:
    decoder = getincrementaldecoder("utf-8")("replace")
    assert process.stderr is not None, "it is a pipe"
    with process.stderr as stream:
        while chunk := os.read(stream.fileno(), 65_536):
            hear(decoder.decode(chunk))
