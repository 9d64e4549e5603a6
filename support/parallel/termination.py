"""Handling of SIGTERM, with which other processes ask this one to end."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread


@contextmanager
def on_termination(handler: Callable[[int, object], object]) -> Iterator[None]:
    """Have SIGTERM call a handler within the context.

    In another thread than the main one nothing changes, as only that one may set handlers.
    """
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
