"""Who does the work: this process, processes of this machine, or a Dask cluster.

Tasks go out a few ahead and their results come back in the order of the tasks, each exactly once,
whoever did them. A process that dies takes no result with it: what it had is given to another one.
"""

from __future__ import annotations

import hashlib
import multiprocessing
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from functools import cache
from importlib import resources
from typing import Any, Protocol, TypeVar, TypeVarTuple

__all__ = ["WorkersError", "code_digest", "in_order", "meet"]

_T = TypeVar("_T")
_Ts = TypeVarTuple("_Ts")

# So often a process may die over the same tasks before they are taken for what kills it.
_MOST_DEATHS = 3
_PACKAGES = ("grammar", "interp", "recovery", "conformance")


class WorkersError(Exception):
    """The work cannot be done by whom it was given to; the text is one line for a person."""


def in_order(
    function: Callable[[*_Ts], _T],
    tasks: Iterable[tuple[*_Ts]],
    *,
    jobs: int = 1,
    scheduler: str | None = None,
) -> Iterator[_T]:
    """What ``function`` returns for the arguments of each task, in the order of the tasks.

    ``jobs`` processes of this machine do it, one being the process that asks; or the workers of the
    Dask ``scheduler`` with this address. Function, arguments and results must be picklable.
    Exceptions of the function are raised here.

    Raises `WorkersError` where there is no such scheduler, where its workers have other code than
    we, or where workers die again and again.
    """
    if scheduler is None and jobs == 1:
        for task in tasks:
            yield function(*task)
        return
    with _crew(jobs, scheduler) as crew:
        waiting: deque[tuple[tuple[*_Ts], _Promise]] = deque()
        for task in tasks:
            waiting.append((task, crew.submit(function, task)))
            if len(waiting) > crew.ahead:
                yield _next(function, waiting, crew)
        while waiting:
            yield _next(function, waiting, crew)


def meet(scheduler: str | None) -> None:
    """See whether a scheduler is there and has workers like us; raises `WorkersError`."""
    if scheduler is not None:
        with _cluster(scheduler):
            pass


class _Promise(Protocol):
    """What both kinds of future have."""

    def result(self) -> Any: ...


class _Crew(Protocol):
    """Takes tasks; ``ahead`` is how many may be out, ``broken`` what says that workers died."""

    ahead: int
    broken: tuple[type[BaseException], ...]

    def submit(self, function: Callable[..., Any], task: tuple[Any, ...]) -> _Promise: ...

    def renew(self) -> None: ...


def _next(function: Callable[..., _T], waiting: deque[tuple[Any, _Promise]], crew: _Crew) -> _T:
    """The result of the first task; where its process has died, all that wait go out again."""
    for _ in range(_MOST_DEATHS):
        task, promise = waiting.popleft()
        try:
            return promise.result()  # type: ignore[no-any-return]
        except crew.broken:
            crew.renew()
            again = [task, *(one for one, _ in waiting)]
            waiting.clear()
            waiting.extend((one, crew.submit(function, one)) for one in again)
    raise WorkersError(f"workers died {_MOST_DEATHS} times over the same files (out of memory?)")


@contextmanager
def _crew(jobs: int, scheduler: str | None) -> Iterator[_Crew]:
    if scheduler is not None:
        with _cluster(scheduler) as cluster:
            yield cluster
        return
    local = _Local(jobs)
    try:
        yield local
    finally:
        local.close()


class _Local:
    """Processes of this machine."""

    broken: tuple[type[BaseException], ...] = (BrokenExecutor,)

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self.ahead = 2 * jobs
        self.renew()

    def submit(self, function: Callable[..., _T], task: tuple[Any, ...]) -> Future[_T]:
        try:
            return self._pool.submit(function, *task)
        except BrokenExecutor as error:  # told when the result is asked for, as all deaths are
            dead: Future[_T] = Future()
            dead.set_exception(error)
            return dead

    def renew(self) -> None:
        """Start afresh after a death."""
        # 'spawn' behaves the same on every system and never copies a process with threads in it
        context = multiprocessing.get_context("spawn")
        self._pool = ProcessPoolExecutor(self._jobs, mp_context=context)

    def close(self) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)


# --------------------------------------------------------------------------------- a Dask cluster


@contextmanager
def _cluster(address: str) -> Iterator[_Crew]:
    try:
        from distributed import Client
    except ModuleNotFoundError as error:
        text = f"a scheduler needs {error.name}: pip install 'krl-workbench[cluster]'"
        raise WorkersError(text) from error
    try:
        connect: Callable[..., Any] = Client
        client = connect(address, timeout="5s", set_as_default=False)
    except (OSError, TimeoutError, ValueError, ImportError) as error:
        raise WorkersError(f"no Dask scheduler answers at {address}") from error
    try:
        yield _Cluster(client, address)
    finally:
        client.close()


class _Cluster:
    """The workers of a scheduler, which gives the tasks of a dead one to others by itself."""

    def __init__(self, client: Any, address: str) -> None:
        from distributed import KilledWorker

        self._client = client
        self.broken: tuple[type[BaseException], ...] = (KilledWorker,)
        cores = sum(client.ncores().values())
        if not cores:
            raise WorkersError(f"the scheduler at {address} has no workers")
        self.ahead = 2 * cores
        others = [
            worker for worker, code in client.run(code_digest).items() if code != code_digest()
        ]
        if others:
            raise WorkersError(f"the worker at {min(others)} has another release of krl than this")

    def submit(self, function: Callable[..., Any], task: tuple[Any, ...]) -> _Promise:
        # not pure: Dask would keep what it takes for the same and answer from memory
        promise: _Promise = self._client.submit(function, *task, pure=False)
        return promise

    def renew(self) -> None:
        """Nothing: the scheduler has found other workers, or waits for some."""


@cache
def code_digest() -> str:
    """The SHA-256 of all modules that a result may depend on."""
    code = hashlib.sha256()
    for package in _PACKAGES:
        todo = [resources.files(package)]
        while todo:
            for entry in sorted(todo.pop().iterdir(), key=lambda entry: entry.name):
                if entry.name.endswith((".py", ".g4", ".tsv", ".toml")):
                    code.update(entry.name.encode() + entry.read_bytes())
                elif entry.is_dir() and entry.name != "cases":
                    todo.append(entry)
    return code.hexdigest()
