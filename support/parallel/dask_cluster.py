"""The workers of a Dask cluster, which must run the same code as this process."""

from __future__ import annotations

import logging
import platform
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, Final, Generic, TypeVar

from support.files.code_digest import code_digest
from support.parallel.workers import Workers, WorkersError

_T = TypeVar("_T")

#: The packages on whose code a result may depend.
_PACKAGES: Final = ("support", "grammar", "interp", "recovery", "conformance")
#: Seconds of waiting for a result after which the client checks that there are still workers.
_PATIENCE: Final = 20.0
#: Seconds that a scheduler may take to accept a connection.
_GREETING: Final = 10.0


@contextmanager
def connected(address: str) -> Iterator[Workers]:
    """Yield the workers of the scheduler at an address; raise `WorkersError` if there are none."""
    from distributed import Client

    try:
        _greet(address)
        connect: Callable[..., Any] = Client
        client = connect(address, timeout=_GREETING, set_as_default=False)
    except Exception as error:  # also whatever Dask makes of a server that is no scheduler
        raise WorkersError(f"no Dask scheduler answers at {address}") from error
    with _silent("distributed.client", "distributed.utils"):
        try:
            yield _Cluster(client, address)
        finally:
            client.close()


def _greet(address: str) -> None:
    """Connect once with a time limit, because a Dask client waits for ever for a silent server."""
    import asyncio

    from distributed import Security
    from distributed.comm.core import connect

    security: Callable[..., Any] = Security
    meet: Callable[..., Any] = connect

    async def greet() -> None:
        secured = security().get_connection_args("client")  # as a client finds it configured
        greeted = await asyncio.wait_for(meet(address, **secured), _GREETING)
        await greeted.close()

    with ThreadPoolExecutor(1) as beside:  # a notebook may run a loop of its own in this thread
        beside.submit(asyncio.run, greet()).result()


@contextmanager
def _silent(*names: str) -> Iterator[None]:
    """Keep Dask's loggers from printing errors that are raised here anyway."""
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
    """The workers of a scheduler, which itself gives the tasks of a dead worker to others."""

    retries = 1  # Dask itself has retried the task before it reports the death

    def __init__(self, client: Any, address: str) -> None:
        from distributed import KilledWorker

        self._client = client
        self._address = address
        self._release = code_digest(*_PACKAGES)
        self.deaths: tuple[type[BaseException], ...] = (KilledWorker,)
        cores = sum(client.ncores().values())
        if not cores:
            raise WorkersError(f"the scheduler at {address} has no workers")
        self.most_pending = 2 * cores
        try:
            client.run(_check_release, self._release)
        except WorkersError:
            raise
        except Exception as error:  # whatever a worker without us makes of it
            raise WorkersError(f"the workers at {address} have no krl: {error}") from error

    def submit(self, function: Callable[..., _T], task: tuple[object, ...]) -> _Awaited[_T]:
        # not pure, or Dask would answer from cached results
        future = self._client.submit(_perform, self._release, function, task, pure=False)
        return _Awaited(future, self._client, self._address)

    def restart(self) -> None:
        """Do nothing: the scheduler has found other workers, or waits for some."""


class _Awaited(Generic[_T]):
    """A submitted task; waiting for its result ends when no worker is left."""

    def __init__(self, future: Any, client: Any, address: str) -> None:
        from distributed.comm.core import CommClosedError

        self._gone: tuple[type[BaseException], ...] = (CancelledError, CommClosedError)
        self._future = future
        self._client = client
        self._address = address

    def result(self) -> _T:
        deserted = 0
        while True:
            try:
                result: _T = self._future.result(timeout=_PATIENCE)
            except self._gone as error:
                raise WorkersError(f"the scheduler at {self._address} has gone") from error
            except TimeoutError:
                if self._future.done():  # it ended just now, or the task's own time was up
                    own: _T = self._future.result()
                    return own
                # once may be the moment between the death of a worker and its replacement
                deserted = 0 if self._client.ncores() else deserted + 1
                if deserted == 2:
                    text = f"the scheduler at {self._address} has no workers left"
                    raise WorkersError(text) from None
            else:
                return result


# ---------------------------------------------------------------------------------- on a worker

_one_at_a_time = threading.Lock()


def _perform(release: str, function: Callable[..., _T], task: tuple[object, ...]) -> _T:
    """Run a task on a worker, one at a time, because the caches are not thread-safe."""
    _check_release(release)
    with _one_at_a_time:
        return function(*task)


def _check_release(release: str) -> None:
    """Raise `WorkersError` if this worker has other code than the submitting process."""
    if release != code_digest(*_PACKAGES):
        raise WorkersError(f"a worker on {platform.node()} has a different release of krl")
