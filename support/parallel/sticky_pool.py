"""A pool whose processes are chosen by number, so that a task finds state of earlier ones.

An ordinary pool gives a task to any free process. Here each process is a pool of its own, so
objects such as syntax trees that one has loaded are still there for later tasks and never sent.
A process that dies is not replaced: its tasks raise `concurrent.futures.BrokenExecutor`.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import TYPE_CHECKING, ParamSpec, Self, TypeVar

if TYPE_CHECKING:
    from concurrent.futures import ProcessPoolExecutor

_P = ParamSpec("_P")
_T = TypeVar("_T")


class StickyPool:
    """A context manager of numbered processes, from 0; if there is only one, it is this process.

    Functions, arguments and results must be picklable.
    """

    def __init__(self, count: int) -> None:
        self.count = max(1, count)
        self._pools = _processes(self.count) if count > 1 else []
        self._loads = [0] * self.count

    def __enter__(self) -> Self:
        return self

    def __exit__(self, _kind: object, error: object, _trace: object) -> None:
        for pool in self._pools:
            pool.shutdown(wait=error is None, cancel_futures=True)

    def least_loaded(self, load: int) -> int:
        """Return the process with the least load so far, and add ``load`` to it."""
        number = self._loads.index(min(self._loads))
        self._loads[number] += load
        return number

    def submit(
        self, number: int, function: Callable[_P, _T], *arguments: _P.args, **named: _P.kwargs
    ) -> Future[_T]:
        """Call a function in a process, after everything submitted to it before."""
        if self._pools:
            return self._pools[number].submit(function, *arguments, **named)
        done: Future[_T] = Future()
        try:
            done.set_result(function(*arguments, **named))
        except BaseException as error:
            done.set_exception(error)
        return done


def _processes(count: int) -> list[ProcessPoolExecutor]:
    from support.parallel.processes import process_pool  # only here, as it takes 5 ms

    return [process_pool(1) for _ in range(count)]
