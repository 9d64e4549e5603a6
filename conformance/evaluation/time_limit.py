"""A limit of processor time and of wall-clock time for code that may not end."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import NoReturn


class TimeOver(BaseException):
    """Code needs too much time; a ``BaseException``, so that no handler in it catches it.

    The message says how much it took.
    """


@contextmanager
def time_limited(computing: float, lasting: float) -> Iterator[None]:
    """Raise `TimeOver` if the context needs more seconds of processor or wall-clock time."""
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or not hasattr(signal, "setitimer"):
        yield
        return
    limits = (
        (signal.SIGPROF, signal.ITIMER_PROF, computing, time.process_time, " of computing"),
        (signal.SIGALRM, signal.ITIMER_REAL, lasting, time.monotonic, ""),
    )
    with ExitStack() as stack:
        for number, timer, seconds, clock, kind in limits:
            stack.enter_context(_timer(number, timer, seconds, clock, f"{seconds:g} seconds{kind}"))
        yield


@contextmanager
def _timer(
    number: int, timer: int, seconds: float, clock: Callable[[], float], told: str
) -> Iterator[None]:
    """Raise `TimeOver` by a signal when the clock of a timer has advanced by ``seconds``."""

    def end(_signal: int, _frame: object) -> NoReturn:
        raise TimeOver(told)

    latest = clock() + seconds
    before = signal.signal(number, end)
    try:
        signal.setitimer(timer, seconds, 1.0)  # repeats, if a callback swallows it
        yield
        if clock() > latest:  # the timer may be late
            raise TimeOver(told)
    finally:
        signal.setitimer(timer, 0)
        signal.signal(number, before)
