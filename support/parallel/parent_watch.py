"""Processes of a pool end with the process that made it, also where that was killed."""

from __future__ import annotations

import multiprocessing
import os
import threading

__all__ = ["end_with_parent"]


def end_with_parent() -> None:
    """Watch, in a process of a pool, for the end of the one that made it.

    A killed process ends no pool, and one that waits for work would wait for ever.
    """
    threading.Thread(target=_wait, daemon=True).start()


def _wait() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)  # nobody is left who could hear of it
