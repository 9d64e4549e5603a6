"""Workers for tasks: processes of this machine or a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

_T = TypeVar("_T")
_T_co = TypeVar("_T_co", covariant=True)


class WorkersError(Exception):
    """The workers cannot do what they were asked for; the text is one line for a person."""


class Pending(Protocol[_T_co]):
    """A task that was submitted."""

    def result(self) -> _T_co:
        """What came of it; waits, and raises what the function raised."""


class Workers(Protocol):
    """Take tasks.

    ``most_pending`` is how many tasks may be submitted and not done, ``deaths`` are the exceptions
    by which `Pending.result` says that a worker died, and ``retries`` is how often a task over
    which one died is tried again, with no other task submitted.
    """

    most_pending: int
    deaths: tuple[type[BaseException], ...]
    retries: int

    def submit(self, function: Callable[..., _T], task: tuple[object, ...]) -> Pending[_T]:
        """Have the function called with the arguments of a task; all of it must be picklable."""

    def restart(self) -> None:
        """Continue after a death."""
