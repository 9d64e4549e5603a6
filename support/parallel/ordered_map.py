"""An ordered parallel map: in this process, in local processes, or on a cluster.

A few tasks are submitted ahead. Results are returned in the order of the tasks, each exactly once.
If a worker dies, its tasks are given to another one. A task during which a worker died is then
retried alone, so that a task that kills every worker is found.
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
    """Yield the results of ``function`` for the arguments of each task, in the order of the tasks.

    With ``jobs`` of 1 the work is done in this process, otherwise by that many local processes or,
    if ``scheduler`` is the address of a Dask scheduler, by its workers. Function, arguments and
    results must be picklable. Exceptions of the function are raised here. ``lost`` computes the
    result of a task that kills every worker.

    Raises `support.parallel.workers.WorkersError` if there is no such scheduler, if its workers run
    other code than this process or have all gone, or, without ``lost``, if a task kills every
    worker.
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
                yield _result_or_retry(function, submitted, workers, lost)
        while submitted:
            yield _result_or_retry(function, submitted, workers, lost)


def in_shares(
    function: Callable[[Sequence[_Item], *_Ts], _T],
    items: Sequence[_Item],
    *more: *_Ts,
    size: int,
    jobs: int = 1,
) -> Iterator[tuple[Sequence[_Item], _T]]:
    """Yield the items in slices of ``size``, each with the result of ``function`` for it.

    ``more`` are further arguments of the function.
    """
    shares = [items[at : at + size] for at in range(0, len(items), size)]
    tasks = ((share, *more) for share in shares)
    return zip(shares, ordered_map(function, tasks, jobs=jobs), strict=True)


def check_scheduler(scheduler: str | None) -> None:
    """Raise `WorkersError` if the scheduler has no workers with the same code as this process."""
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
            try:
                yield local
            except BaseException:
                local.kill()
                raise


def _result_or_retry(
    function: Callable[[*_Ts], _T],
    submitted: deque[tuple[tuple[*_Ts], Pending[_T]]],
    workers: Workers,
    lost: Callable[[*_Ts], _T] | None,
) -> _T:
    """Return the result of the first task; retry it if a worker died."""
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
        raise WorkersError("workers repeatedly die on the same work (out of memory?)")
    return lost(*task)


def _wait_for(submitted: Iterable[Pending[object]]) -> None:
    """Wait until all tasks are done; their errors are raised later, with their results."""
    for pending in submitted:
        try:
            pending.result()
        except WorkersError:
            raise
        except Exception:
            continue
