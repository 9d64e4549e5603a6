"""The interface of workers, which processes of this machine and a Dask cluster implement."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from support.input_error import InputError

_T = TypeVar("_T")
_T_co = TypeVar("_T_co", covariant=True)


class WorkersError(InputError):
    """The workers cannot do the work; the message is one line for a person."""


class Pending(Protocol[_T_co]):
    """A task that was submitted."""

    def result(self) -> _T_co:
        """Return the result of the task; waits for it, and raises what the function raised."""


class Workers(Protocol):
    """Accepts tasks, and survives the death of a worker.

    ``most_pending`` is the number of tasks that may be submitted and not done. ``deaths`` are the
    exceptions by which `Pending.result` reports that a worker died. ``retries`` is how often such a
    task is tried again, with no other task submitted.
    """

    most_pending: int
    deaths: tuple[type[BaseException], ...]
    retries: int

    def submit(self, function: Callable[..., _T], task: tuple[object, ...]) -> Pending[_T]:
        """Submit a call of a function with the arguments of a task; all must be picklable."""

    def restart(self) -> None:
        """Continue after the death of a worker."""
