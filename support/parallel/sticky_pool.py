"""A pool with processes chosen by number, so that a task finds its process's earlier state.

A pool gives a task to whichever process is free. Here each process is a pool of its own: what is
read into one, syntax trees above all, is there when it is asked for and is never sent.
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
    """So many processes, numbered from 0; one alone is the process that asks. A context manager.

    What is submitted, and what comes back, must be picklable.
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
        """The process that was given the least to do so far, to which ``load`` is added."""
        number = self._loads.index(min(self._loads))
        self._loads[number] += load
        return number

    def submit(
        self, number: int, function: Callable[_P, _T], *arguments: _P.args, **named: _P.kwargs
    ) -> Future[_T]:
        """Have a function called in a process, after all that was submitted to it before."""
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
