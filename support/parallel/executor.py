"""Who does the work: this process, processes of this machine, or a Dask cluster.

Tasks go out a few ahead and their results come back in the order of the tasks, each exactly once,
whoever did them. A process that dies takes no result with it: what it had is given to another one,
and a task that kills whoever is given it is found, since it is then done with nobody beside it.
"""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import platform
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from contextlib import contextmanager
from typing import Any, Final, Protocol, TypeVar, TypeVarTuple

from support.files.code_digest import code_digest
from support.parallel.parent_watch import end_with_parent

__all__ = ["WorkersError", "in_order", "meet"]

_T = TypeVar("_T")
_Ts = TypeVarTuple("_Ts")

_PACKAGES: Final = ("support", "grammar", "interp", "recovery", "conformance")
#: Seconds after which it is asked whether anybody is left who could bring a result.
_PATIENCE: Final = 20.0
#: Seconds that a scheduler may take to greet us.
_GREETING: Final = 5.0


class WorkersError(Exception):
    """The work cannot be done by whom it was given to; the text is one line for a person."""


def in_order(
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
    process it is given to.

    Raises `WorkersError` where there is no such scheduler, where its workers have other code than
    we or have all gone, or, without ``lost``, where a task kills whoever does it.
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
                yield _next(function, waiting, crew, lost)
        while waiting:
            yield _next(function, waiting, crew, lost)


def meet(scheduler: str | None) -> None:
    """See whether a scheduler is there and has workers like us; raises `WorkersError`."""
    if scheduler is not None:
        with _cluster(scheduler):
            pass


class _Promise(Protocol):
    """What both kinds of future have."""

    def result(self) -> Any: ...


class _Crew(Protocol):
    """Takes tasks.

    ``ahead`` is how many may be out, ``broken`` what says that workers died, ``chances`` how often
    a task over which one died is then tried alone.
    """

    ahead: int
    broken: tuple[type[BaseException], ...]
    chances: int

    def submit(self, function: Callable[..., Any], task: tuple[Any, ...]) -> _Promise: ...

    def renew(self) -> None: ...


def _next(
    function: Callable[[*_Ts], _T],
    waiting: deque[tuple[tuple[*_Ts], _Promise]],
    crew: _Crew,
    lost: Callable[[*_Ts], _T] | None,
) -> _T:
    """The result of the first task; where whoever did it has died, of another try."""
    task, promise = waiting.popleft()
    try:
        result: _T = promise.result()
        return result
    except crew.broken:
        _settle(promise for _, promise in waiting)
    found = _alone(function, task, crew)
    if found is not None:
        return found[0]
    if lost is None:
        raise WorkersError("workers die again and again over the same work (out of memory?)")
    return lost(*task)


def _settle(promises: Iterable[_Promise]) -> None:
    """Wait until nothing is out; what has failed is told when its turn comes."""
    for promise in promises:
        try:
            promise.result()
        except WorkersError:
            raise
        except Exception:
            continue


def _alone(function: Callable[[*_Ts], _T], task: tuple[*_Ts], crew: _Crew) -> tuple[_T] | None:
    """The result of a task while nothing else is out; ``None`` where it kills whoever does it."""
    for _ in range(crew.chances):
        crew.renew()
        try:
            return (crew.submit(function, task).result(),)
        except crew.broken:
            continue
    crew.renew()
    return None


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
    chances = 2  # one death more may be bad luck

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
        self._pool = ProcessPoolExecutor(self._jobs, context, end_with_parent)

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
        with ThreadPoolExecutor(1) as beside:  # here a notebook may have a loop of its own
            beside.submit(asyncio.run, _greet(address)).result()
        connect: Callable[..., Any] = Client
        client = connect(address, timeout="5s", set_as_default=False)
    except Exception as error:  # also whatever Dask makes of a server that is no scheduler
        raise WorkersError(f"no Dask scheduler answers at {address}") from error
    with _silent("distributed.client", "distributed.utils"):
        try:
            yield _Cluster(client, address)
        finally:
            client.close()


async def _greet(address: str) -> None:
    """Greet a scheduler: a client of Dask waits for ever for a server that says nothing."""
    from distributed import Security
    from distributed.comm.core import connect

    security: Callable[..., Any] = Security
    meet_with: Callable[..., Any] = connect
    secured = security().get_connection_args("client")  # as a client finds it configured
    greeted = await asyncio.wait_for(meet_with(address, **secured), _GREETING)
    await greeted.close()


@contextmanager
def _silent(*names: str) -> Iterator[None]:
    """Dask tells on the terminal what we raise; here it does not."""
    loggers = [logging.getLogger(name) for name in names]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


class _Cluster:
    """The workers of a scheduler, which gives the tasks of a dead one to others by itself."""

    chances = 1  # Dask has tried it four times before it tells

    def __init__(self, client: Any, address: str) -> None:
        from distributed import KilledWorker

        self._client = client
        self._address = address
        self.broken: tuple[type[BaseException], ...] = (KilledWorker,)
        cores = sum(client.ncores().values())
        if not cores:
            raise WorkersError(f"the scheduler at {address} has no workers")
        self.ahead = 2 * cores
        try:
            client.run(_is_like, _release())
        except WorkersError:
            raise
        except Exception as error:  # whatever a worker without us makes of it
            raise WorkersError(f"the workers at {address} have no krl: {error}") from error

    def submit(self, function: Callable[..., Any], task: tuple[Any, ...]) -> _Promise:
        # not pure: Dask would keep what it takes for the same and answer from memory
        future = self._client.submit(_there, _release(), function, task, pure=False)
        return _Awaited(future, self._client, self._address)

    def renew(self) -> None:
        """Nothing: the scheduler has found other workers, or waits for some."""


class _Awaited:
    """A result that a cluster owes us; it is not waited for where nobody is left to bring it."""

    def __init__(self, future: Any, client: Any, address: str) -> None:
        from distributed.comm.core import CommClosedError

        self._gone: tuple[type[BaseException], ...] = (CancelledError, CommClosedError)
        self._future = future
        self._client = client
        self._address = address

    def result(self) -> Any:
        deserted = 0
        while True:
            try:
                return self._future.result(timeout=_PATIENCE)
            except self._gone as error:
                raise WorkersError(f"the scheduler at {self._address} has gone") from error
            except TimeoutError:
                if self._future.done():
                    raise
                # once may be the moment between a worker that died and the one in its place
                deserted = 0 if self._client.ncores() else deserted + 1
                if deserted == 2:
                    text = f"the scheduler at {self._address} has no workers left"
                    raise WorkersError(text) from None


# ---------------------------------------------------------------------------------- on a worker

_one_at_a_time = threading.Lock()


def _there(code: str, function: Callable[..., _T], task: tuple[Any, ...]) -> _T:
    """Do a task on a worker; its threads take turns, as what we remember is made for one."""
    _is_like(code)
    with _one_at_a_time:
        return function(*task)


def _is_like(code: str) -> None:
    """Raises `WorkersError` where this worker has other code than who asks."""
    if code != _release():
        raise WorkersError(f"a worker on {platform.node()} has another release of krl than this")


def _release() -> str:
    """What a result may depend on: all modules and tables of ours."""
    return code_digest(*_PACKAGES)
