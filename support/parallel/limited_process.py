"""Running a command with limits on time and memory; none of its processes outlives it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from threading import Thread

from support.parallel.termination import on_termination

_GRACE = 30.0
#: A shell kills its process group as soon as nobody holds the other end of standard input.
_WATCHED = "exec 3<&0 </dev/null; (read _ <&3; kill -9 0) & "


def run_limited(
    command: Sequence[str],
    seconds: float,
    memory: int,
    hear: Callable[[str], object],
    environment: Mapping[str, str] | None = None,
) -> int | None:
    """Return the exit status of a command, or ``None`` if it took longer than ``seconds``.

    It is then asked to end (SIGTERM), and has half a minute to write what it has. ``memory`` limits
    the address space of each of its processes in bytes; only Linux enforces it. ``hear`` is called
    from a thread with everything the command writes to standard error, piece by piece, before this
    function returns. All processes of the command are killed at the end, also if this process
    receives SIGTERM, and, except on Windows, if this process is killed. A command that cannot be
    started has the status 127; on Windows it raises OSError.
    """
    if sys.platform != "win32":
        # by a shell: set from here, the limit could come too late
        limit = f"ulimit -v {memory // 1024} && " if sys.platform == "linux" else ""
        command = ["/bin/sh", "-c", f'{_WATCHED}{limit}exec "$@" 3<&-', "sh", *command]
    with _ended_by_termination() as started:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,  # open as long as this process lives
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
            process.terminate()
            with suppress(subprocess.TimeoutExpired):
                process.wait(_GRACE)
            return None
        finally:
            _kill(process)
            process.wait()
            reader.join()
            assert process.stdin is not None, "it is a pipe"
            process.stdin.close()


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

    try:
        with on_termination(end):
            yield started
    finally:
        if signals:
            raise SystemExit(128 + signals[0])


def _pass_on(process: subprocess.Popen[bytes], hear: Callable[[str], object]) -> None:
    decoder = getincrementaldecoder("utf-8")("replace")
    assert process.stderr is not None, "it is a pipe"
    with process.stderr as stream:
        while chunk := os.read(stream.fileno(), 65_536):
            hear(decoder.decode(chunk))
