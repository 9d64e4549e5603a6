"""Worker processes on this machine: started afresh, ended with their parent."""

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
    """So many processes that know nothing of this one; ``prepare`` is called first in each."""
    return ProcessPoolExecutor(count, _Context(), _begin, (prepare, arguments))


class _Process(SpawnProcess):
    """A process that hears of no interrupt until it has begun: it would print a traceback.

    Nor does it import the script that this one runs, which without a guard would begin anew there.
    """

    def start(self) -> None:
        with _interrupts_held(), _script_hidden():
            super().start()


class _Context(SpawnContext):
    """How processes are made: 'spawn' behaves the same on every system and copies no threads."""

    Process = _Process


@contextmanager
def _script_hidden() -> Iterator[None]:
    """What is started now finds no main module to import; its tasks are functions of others."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """What is started inherits that interrupts wait; where a system has no such thing, nothing."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(prepare: Callable[..., object] | None, arguments: tuple[object, ...]) -> None:
    """Begin a process of a pool."""
    # an interrupt reaches all processes of a terminal; the one that asked for the work reports it
    signal.signal(signal.SIGINT, lambda *_: os._exit(130))
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if prepare is not None:
        prepare(*arguments)


def _end_with_parent() -> None:
    """Wait for the end of the process that made the pool.

    A killed process ends no pool, and a worker that waits for a task would wait for ever.
    """
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


class LocalWorkers:
    """Processes of this machine as `support.parallel.workers.Workers`."""

    deaths: tuple[type[BaseException], ...] = (BrokenExecutor,)
    retries = 2  # one death more may be bad luck

    def __init__(self, count: int) -> None:
        self._count = count
        self.most_pending = 2 * count
        self.restart()

    def submit(self, function: Callable[..., _T], task: tuple[object, ...]) -> Future[_T]:
        """See `Workers.submit`; a death is raised when the result is asked for, as all are."""
        try:
            return self._pool.submit(function, *task)
        except BrokenExecutor as error:
            dead: Future[_T] = Future()
            dead.set_exception(error)
            return dead

    def restart(self) -> None:
        """Start other processes: a pool in which one died takes no more tasks."""
        self._pool = process_pool(self._count)

    def close(self) -> None:
        """End the processes; tasks that none of them has begun are not done."""
        self._pool.shutdown(wait=True, cancel_futures=True)
