"""A function called in a process of its own, so that a measurement meets nothing remembered."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import ParamSpec, TypeVar

from support.parallel.parent_watch import end_with_parent

__all__ = ["apart"]

_P = ParamSpec("_P")
_T = TypeVar("_T")


def apart(function: Callable[_P, _T], *arguments: _P.args, **named: _P.kwargs) -> _T:
    """What the function returns in a fresh process, the only one at work meanwhile."""
    # 'spawn' is the same on every system, and takes over nothing that this process remembers
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, context, end_with_parent) as pool:
        return pool.submit(function, *arguments, **named).result()
