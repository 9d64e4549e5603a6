"""A function applied to many tasks: in this process, in others of this machine, or on a cluster.

A few tasks are submitted ahead. Results come back in the order of the tasks, each exactly once. If
a worker dies, another one does its tasks. A task is then tried alone, so that one that kills every
worker is found.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from typing import TypeVar, TypeVarTuple

from support.parallel.dask_cluster import connected
from support.parallel.processes import LocalWorkers
from support.parallel.workers import Pending, Workers, WorkersError

_T = TypeVar("_T")
_Item = TypeVar("_Item")
_Ts = TypeVarTuple("_Ts")


def ordered_map(
    function: Callable[[*_Ts], _T],
    tasks: Iterable[tuple[*_Ts]],
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    lost: Callable[[*_Ts], _T] | None = None,
) -> Iterator[_T]:
    """What ``function`` returns for the arguments of each task, in the order of the tasks.

    ``jobs`` processes of this machine do it, one being the process that asks; or the workers of the
    Dask ``scheduler`` with this address. Function, arguments and results must be picklable.
    Exceptions of the function are raised here. ``lost`` gives the result of a task that kills every
    worker it is given to.

    Raises `support.parallel.workers.WorkersError` where there is no such scheduler, where its
    workers have other code than this process or have all gone, or, without ``lost``, where a task
    kills every worker it is given to.
    """
    if scheduler is None and jobs == 1:
        for task in tasks:
            yield function(*task)
        return
    with _workers(jobs, scheduler) as workers:
        submitted: deque[tuple[tuple[*_Ts], Pending[_T]]] = deque()
        for task in tasks:
            submitted.append((task, workers.submit(function, task)))
            if len(submitted) > workers.most_pending:
                yield _next(function, submitted, workers, lost)
        while submitted:
            yield _next(function, submitted, workers, lost)


def in_shares(
    function: Callable[[Sequence[_Item], *_Ts], _T],
    items: Sequence[_Item],
    *more: *_Ts,
    size: int,
    jobs: int = 1,
) -> Iterator[tuple[Sequence[_Item], _T]]:
    """Shares of so many items, each with what ``function`` returns for it and ``more``."""
    shares = [items[at : at + size] for at in range(0, len(items), size)]
    tasks = ((share, *more) for share in shares)
    return zip(shares, ordered_map(function, tasks, jobs=jobs), strict=True)


def check_scheduler(scheduler: str | None) -> None:
    """Raise `WorkersError` where there is no such scheduler, or no workers with code like ours."""
    if scheduler is not None:
        with connected(scheduler):
            pass


@contextmanager
def _workers(jobs: int, scheduler: str | None) -> Iterator[Workers]:
    if scheduler is not None:
        with connected(scheduler) as cluster:
            yield cluster
    else:
        with closing(LocalWorkers(jobs)) as local:
            yield local


def _next(
    function: Callable[[*_Ts], _T],
    submitted: deque[tuple[tuple[*_Ts], Pending[_T]]],
    workers: Workers,
    lost: Callable[[*_Ts], _T] | None,
) -> _T:
    """The result of the first task, retried if a worker died."""
    task, pending = submitted.popleft()
    try:
        return pending.result()
    except workers.deaths:
        _wait_for(pending for _, pending in submitted)
    for _ in range(workers.retries):
        workers.restart()
        try:
            return workers.submit(function, task).result()
        except workers.deaths:
            continue
    workers.restart()
    if lost is None:
        raise WorkersError("workers die again and again over the same work (out of memory?)")
    return lost(*task)


def _wait_for(submitted: Iterable[Pending[object]]) -> None:
    """Wait until all are done; an error is raised later, when its result is taken."""
    for pending in submitted:
        try:
            pending.result()
        except WorkersError:
            raise
        except Exception:
            continue
