"""Processes that remember: what is sent to the same lane meets what it left there.

A pool gives work to whichever process is free. Here each process has a queue of its own, so that
what is read into one, syntax trees above all, is there when it is asked for and never travels.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from types import TracebackType
from typing import ParamSpec, TypeVar

from support.parallel.parent_watch import end_with_parent

__all__ = ["Lanes"]

_P = ParamSpec("_P")
_T = TypeVar("_T")


class Lanes:
    """So many processes, numbered from 0; one alone is the process that asks. A context manager.

    What is submitted, and what comes back, must be picklable.
    """

    def __init__(self, count: int) -> None:
        # 'spawn' behaves the same on every system and never copies a process with threads in it
        context = multiprocessing.get_context("spawn")
        self.count = max(1, count)
        self._pools = [
            ProcessPoolExecutor(1, context, end_with_parent)
            for _ in range(self.count if count > 1 else 0)
        ]
        self._loads = [0] * self.count

    def __enter__(self) -> Lanes:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for pool in self._pools:
            pool.shutdown(wait=error is None, cancel_futures=True)

    def least(self, load: int) -> int:
        """The lane with the least to do, to which ``load`` is added."""
        lane = self._loads.index(min(self._loads))
        self._loads[lane] += load
        return lane

    def submit(
        self, lane: int, function: Callable[_P, _T], *arguments: _P.args, **named: _P.kwargs
    ) -> Future[_T]:
        """Have a function called in a lane, after all that was submitted there before."""
        if self._pools:
            return self._pools[lane].submit(function, *arguments, **named)
        done: Future[_T] = Future()
        try:
            done.set_result(function(*arguments, **named))
        except BaseException as error:
            done.set_exception(error)
        return done
