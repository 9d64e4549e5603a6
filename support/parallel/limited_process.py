"""A command with limits of time and memory; no process of it survives its end."""

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
    """The exit status of a command; ``None`` where it took longer than so many seconds.

    ``memory`` is how many bytes of addresses each of its processes may have, which only Linux
    enforces. ``hear`` is given what it writes to standard error, piece by piece, from a thread;
    all of it has been given when this returns. Ends with all processes of the command, also when
    this process receives a signal to end. A command that cannot be started raises OSError; on Linux
    it has the status 127 instead.
    """
    if sys.platform == "linux":  # a limit set from here could come after the command has begun
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
    """End a process and, where a system has groups of processes, all that it started."""
    if sys.platform == "win32":
        process.kill()
        return
    with suppress(ProcessLookupError, PermissionError):  # all of them have ended
        os.killpg(process.pid, signal.SIGKILL)


@contextmanager
def _ended_by_termination() -> Iterator[Callable[[subprocess.Popen[bytes]], None]]:
    """SIGTERM kills the process given to what this yields, even if it came before, and this one."""
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
