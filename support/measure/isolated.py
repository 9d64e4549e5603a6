"""Calls in a fresh process, so that no cached state influences a measurement."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from support.parallel.processes import process_pool

_P = ParamSpec("_P")
_T = TypeVar("_T")


def call_isolated(function: Callable[_P, _T], *arguments: _P.args, **named: _P.kwargs) -> _T:
    """Return the result of a function that is called in a process of its own."""
    with process_pool(1) as pool:
        return pool.submit(function, *arguments, **named).result()
