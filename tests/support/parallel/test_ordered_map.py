"""Work in other processes: every result once, in order, whoever dies."""

import os
import signal
import socketserver
import threading
import time
from contextlib import nullcontext
from pathlib import Path

import pytest

from krl.cli import main
from support.parallel import ordered_map as module
from support.parallel.ordered_map import check_scheduler, in_shares, ordered_map
from support.parallel.workers import WorkersError


def _double(number: int, folder: str) -> int:
    """Twice the number; the first process that is given 3 dies of it."""
    mark = Path(folder, "died")
    if number == 3 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60)
    return 2 * number


def test_results_come_in_order_though_a_process_dies(tmp_path: Path) -> None:
    """A process that is killed loses no result, and none comes twice."""
    tasks = ((number, str(tmp_path)) for number in range(12))
    assert [2 * n for n in range(12)] == list(ordered_map(_double, tasks, jobs=2))
    assert (tmp_path / "died").exists()


def _deadly(number: int) -> int:
    """Twice the number; whoever is given 4 dies of it."""
    if number == 4:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60)
    return 2 * number


def test_work_that_kills_every_process_is_given_up() -> None:
    """A task that kills each process it is given to ends with one clear line."""
    with pytest.raises(WorkersError, match="workers repeatedly die on the same work"):
        list(ordered_map(_deadly, [(4,)], jobs=2))


def test_what_kills_is_separated_from_what_was_beside_it() -> None:
    """Where a lost result can be replaced, only that of the task that kills is."""
    done = ordered_map(_deadly, ((number,) for number in range(7)), jobs=2, lost=lambda n: -n)
    assert [0, 2, 4, 6, -4, 10, 12] == list(done)


@pytest.mark.parametrize("command", ["recover corpus/programs --no-start", "conform", "fuzz"])
def test_no_scheduler_is_one_clear_line(
    monkeypatch: pytest.MonkeyPatch, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """An address where no scheduler answers is told as that."""
    pytest.importorskip("distributed")
    monkeypatch.setattr("support.parallel.dask_cluster._GREETING", 0.2)
    assert 2 == main([*command.split(), "--scheduler", "tcp://127.0.0.1:9"])
    assert "krl: no Dask scheduler answers at tcp://127.0.0.1:9\n" == capsys.readouterr().err


@pytest.mark.parametrize("answer", [b"", b"\xff" * 64, b"\x00" * 64, b"HTTP/1.1 400 Bad\r\n\r\n"])
def test_what_answers_and_is_no_scheduler_is_reported(
    monkeypatch: pytest.MonkeyPatch, answer: bytes
) -> None:
    """A server that says nothing, or something else than a scheduler, is not waited for."""

    class Reply(socketserver.BaseRequestHandler):
        def handle(self) -> None:
            self.request.sendall(answer)
            while self.request.recv(1000):  # until the caller has gone
                pass

    monkeypatch.setattr("support.parallel.dask_cluster._GREETING", 0.2)
    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), Reply) as server:
        serving = threading.Thread(target=server.serve_forever, args=(0.01,))
        serving.start()
        address = f"tcp://127.0.0.1:{server.server_address[1]}"
        with pytest.raises(WorkersError, match=f"^no Dask scheduler answers at {address}$"):
            check_scheduler(address)
        server.shutdown()
        serving.join()


class _Death(Exception):
    """Whoever did a task has died."""


class _Told:
    """Takes tasks and tells of it; whoever is first given 0 dies of it."""

    most_pending = 4
    retries = 1
    deaths: tuple[type[BaseException], ...] = (_Death,)

    def __init__(self) -> None:
        self.log: list[tuple[str, int]] = []

    def submit(self, _function: object, task: tuple[int]) -> "_Result":
        is_deadly = task == (0,) and ("out", 0) not in self.log
        self.log.append(("out", task[0]))
        return _Result(self.log, task[0], is_deadly)

    def restart(self) -> None:
        """Do nothing."""


class _Result:
    def __init__(self, log: list[tuple[str, int]], number: int, is_deadly: bool) -> None:
        self._log, self._number, self._is_deadly = log, number, is_deadly

    def result(self) -> int:
        self._log.append(("back", self._number))
        if self._is_deadly:
            raise _Death
        return self._number


def test_what_died_is_tried_again_when_nothing_else_is_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then it is known whether the task itself kills, and nobody beside it is taken along."""
    workers = _Told()
    monkeypatch.setattr(module, "_workers", lambda _jobs, _scheduler: nullcontext(workers))
    assert [0, 1, 2] == list(ordered_map(abs, ((n,) for n in range(3)), jobs=2))
    again = len(workers.log) - 1 - workers.log[::-1].index(("out", 0))
    assert {("back", 1), ("back", 2)} <= set(workers.log[:again])


def test_items_are_shared_out_in_their_order() -> None:
    """Each share is as large as wanted, but for the last, and comes with its result."""
    found = list(in_shares(lambda share, more: sum(share) + more, [1, 2, 3, 4, 5], 10, size=2))
    assert [([1, 2], 13), ([3, 4], 17), ([5], 15)] == found
