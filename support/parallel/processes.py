"""Worker processes on this machine: spawned afresh, and ended with their parent."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.context import SpawnContext, SpawnProcess
from types import ModuleType
from typing import TypeVar, TypeVarTuple

_T = TypeVar("_T")
_Ts = TypeVarTuple("_Ts")


def process_pool(
    count: int, prepare: Callable[[*_Ts], object] | None = None, *arguments: *_Ts
) -> ProcessPoolExecutor:
    """Return a pool of fresh processes; each first calls ``prepare`` with the arguments."""
    return ProcessPoolExecutor(count, _Context(), _begin, (prepare, arguments))


class _Process(SpawnProcess):
    """A process with interrupts blocked until it is ready, because it would print a traceback.

    It does not import the main script of its parent either, which would start again if it has no
    main guard.
    """

    def start(self) -> None:
        with _interrupts_held(), _script_hidden():
            super().start()


class _Context(SpawnContext):
    """Creates processes by 'spawn', which is the same on every system and copies no threads."""

    Process = _Process


@contextmanager
def _script_hidden() -> Iterator[None]:
    """Hide the main module from new processes, which would import it; tasks are elsewhere."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Block SIGINT in processes started in the context, if the system can."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(prepare: Callable[..., object] | None, arguments: tuple[object, ...]) -> None:
    """Initialise a process of a pool."""
    # Ctrl-C reaches all processes of a terminal; the parent reports it
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # as a script runs `krl … &`
        signal.signal(signal.SIGINT, lambda *_: os._exit(130))
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if prepare is not None:
        prepare(*arguments)


def _end_with_parent() -> None:
    """Wait until the parent process has ended, then exit.

    A killed parent does not close its pool, and its workers would wait for tasks for ever.
    """
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


class LocalWorkers:
    """Processes of this machine that implement `support.parallel.workers.Workers`."""

    deaths: tuple[type[BaseException], ...] = (BrokenExecutor,)
    retries = 2  # a second death may still be chance

    def __init__(self, count: int) -> None:
        self._count = count
        self.most_pending = 2 * count
        self.restart()

    def submit(self, function: Callable[..., _T], task: tuple[object, ...]) -> Future[_T]:
        """See `Workers.submit`; the death of a worker is raised by the result."""
        try:
            return self._pool.submit(function, *task)
        except BrokenExecutor as error:
            dead: Future[_T] = Future()
            dead.set_exception(error)
            return dead

    def restart(self) -> None:
        """Start new processes, because a pool in which one died accepts no more tasks."""
        self._pool = process_pool(self._count)

    def kill(self) -> None:
        """Kill the processes, as nobody waits for their results any more."""
        for process in multiprocessing.active_children():
            if isinstance(process, _Process):
                process.kill()

    def close(self) -> None:
        """End the processes; tasks that have not begun are cancelled."""
        self._pool.shutdown(wait=True, cancel_futures=True)
