"""A real Dask cluster: the same results as from local processes, whichever worker is killed."""

import json
import os
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from grammar.generation.synthetic_corpus import write_cells
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from krl.cli import main
from recovery.survey.survey import survey
from support.parallel import dask_cluster
from support.parallel.ordered_map import check_scheduler, ordered_map
from support.parallel.workers import WorkersError

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow


#: What workers run first: whoever edits this checkout while it is tested is not another release.
_SAME_RELEASE = (
    "from support.parallel import dask_cluster; dask_cluster.code_digest = lambda *_: 'ours'"
)


@pytest.fixture(autouse=True)
def _same_release(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_cluster, "code_digest", lambda *_: "ours")
    monkeypatch.setattr(dask_cluster, "_GREETING", 900.0)  # however busy this machine is


class _Cluster:
    """A scheduler and workers, each a process of its own.

    Workers have two threads, so that tasks could get into each other's way. ``failures`` is how
    many deaths over a task Dask bears before it tells.
    """

    def __init__(
        self, folder: Path, workers: int, failures: int = 3, protocol: str = "tcp"
    ) -> None:
        self.folder = folder
        # workers unpickle functions of this very file
        paths = os.pathsep.join([str(Path(__file__).parent), *filter(None, sys.path)])
        self._environment = {
            **os.environ,
            "PYTHONPATH": paths,
            "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(failures),
        }
        self._processes: list[subprocess.Popen[str]] = []
        self.scheduler = self._start(
            *("scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1"),
            *("--protocol", protocol),
        )
        self.address = self._address()
        self.workers: list[subprocess.Popen[str]] = []
        for _ in range(workers):
            self.hire()

    def hire(self) -> None:
        """One worker more."""
        limits = ("--nthreads", "2", "--no-nanny", "--no-dashboard", "--preload", _SAME_RELEASE)
        worker = self._start("worker", self.address, *limits)
        threading.Thread(target=worker.communicate, daemon=True).start()
        self.workers.append(worker)

    def wait(self) -> None:
        """Until all workers have reported."""
        from distributed import Client

        connect: Callable[..., Any] = Client
        with connect(self.address, set_as_default=False) as client:
            client.wait_for_workers(len(self.workers))

    def kill_a_worker(self) -> None:
        """Without a chance to say goodbye."""
        worker = self.workers.pop(0)
        worker.kill()
        worker.wait()

    def stop(self) -> None:
        for process in self._processes:
            process.kill()
            process.wait()

    def _start(self, role: str, *arguments: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_" + role, *arguments],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            cwd=self.folder,
            env=self._environment,
        )
        self._processes.append(process)
        return process

    def _address(self) -> str:
        assert self.scheduler.stderr is not None
        for line in self.scheduler.stderr:
            found = re.search(r"t(cp|ls)://[\d.]+:\d+", line)
            if found:
                threading.Thread(target=self.scheduler.communicate, daemon=True).start()
                return found.group()
        raise AssertionError("the scheduler did not start")


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[_Cluster]:
    started = _Cluster(tmp_path_factory.mktemp("cluster"), workers=0)
    yield started
    started.stop()


@pytest.fixture
def cluster(standing: _Cluster) -> _Cluster:
    """Two workers, whatever the test before did to them."""
    while len(standing.workers) < 2:
        standing.hire()
    standing.wait()
    return standing


@pytest.fixture
def of_one(tmp_path: Path) -> Iterator[_Cluster]:
    """One worker, and a scheduler that tells of the first death."""
    started = _Cluster(tmp_path, workers=1, failures=0)
    started.wait()
    yield started
    started.stop()


def _killing(cluster: _Cluster, after: int, done: list[int]) -> Callable[[int], None]:
    """What is told of progress: kills a worker once so much is done."""

    def count(number: int) -> None:
        done.append(number)
        if sum(done) >= after and len(cluster.workers) == 2:
            cluster.kill_a_worker()

    return count


# ------------------------------------------------------------- one worker killed in the middle


def test_survey_is_the_same_though_a_worker_is_killed(
    cluster: _Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is lost, nothing comes twice, and the order is that of local processes."""
    monkeypatch.setattr("recovery.survey.survey._TASK_FILES", 4)
    corpus = tmp_path / "corpus"
    write_cells(corpus, 150_000, seed=5)
    for file in sorted(corpus.rglob("*.src"))[::10]:  # so that there are failures to be ordered
        file.write_bytes(file.read_bytes() + b"\nWAT 1\n")
    grammar = read_file(GRAMMAR)
    alone = survey([corpus], grammar, jobs=1)
    done: list[int] = []
    there = survey(
        [corpus], grammar, scheduler=cluster.address, on_done=_killing(cluster, 12, done)
    )
    assert 1 == len(cluster.workers)
    assert len(done) > 3, "there was no middle to kill it in"
    assert list(alone.files) == list(there.files)
    assert alone.forms == there.forms
    assert alone.skipped == there.skipped
    assert any(file.failures for file in there.files)


# ------------------------------------------------------------------------------- the commands


def _record(file: Path) -> dict[str, Any]:
    """A record without what the clock says."""
    record: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    for varies in ("seconds", "analysis_seconds", "generated"):
        record.pop(varies, None)
    for case in record.get("cases", ()):
        for result in case["results"]:
            result.pop("seconds", None)
    return record


@pytest.mark.parametrize(
    "command",
    [
        "recover corpus/programs --no-start --out {out}",
        "conform control/exit_for --executor tree --executor vm --robot none",
        "fuzz --programs 2 --executor tree --executor vm",
    ],
)
def test_commands_take_a_scheduler(cluster: _Cluster, tmp_path: Path, command: str) -> None:
    """With ``--scheduler`` the record is that of local processes."""
    records = []
    for name, whom in (("alone", ("--jobs", "1")), ("there", ("--scheduler", cluster.address))):
        file = tmp_path / f"{name}.json"
        words = command.format(out=tmp_path / name).split()
        assert 0 == main([*words, "--json", str(file), *whom])
        records.append(_record(file))
    assert records[0] == records[1]


# ----------------------------------------------------------------------------- what goes wrong


def _deadly(number: int) -> int:
    """Twice the number; whoever is given 4 dies of it."""
    if number == 4:
        os._exit(9)
    return 2 * number


def test_what_kills_workers_is_separated_from_what_was_beside_it(of_one: _Cluster) -> None:
    """Only the result of the task that kills is lost, and another worker goes on."""
    for _ in range(2):  # the task that kills is given to a second one
        of_one.hire()
    of_one.wait()
    tasks = ((number,) for number in range(7))
    done = ordered_map(_deadly, tasks, scheduler=of_one.address, lost=lambda n: -n)
    assert [0, 2, 4, 6, -4, 10, 12] == list(done)


class _EndsLate:
    """A future of Dask that ends right after the wait for it has ended."""

    def result(self, timeout: float | None = None) -> int:
        if timeout is not None:
            raise TimeoutError
        return 8

    def done(self) -> bool:
        return True


def test_result_that_comes_as_the_wait_ends_is_taken() -> None:
    """Patience that ran out at the wrong moment is no failure of the task."""
    assert 8 == dask_cluster._Awaited(_EndsLate(), None, "tcp://nobody").result()


def test_scheduler_that_goes_away_is_one_clear_line(of_one: _Cluster) -> None:
    """Work does not wait for a scheduler that was killed."""
    results = ordered_map(_deadly, ((9,) for _ in range(50)), scheduler=of_one.address)
    assert 18 == next(results)
    of_one.scheduler.kill()
    with pytest.raises(WorkersError, match=r"the scheduler at .* has gone"):
        list(results)


def test_workers_that_all_go_are_one_clear_line(
    of_one: _Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Work does not wait for ever where nobody is left to do it."""
    monkeypatch.setattr(dask_cluster, "_PATIENCE", 1.0)
    results = ordered_map(_deadly, ((9,) for _ in range(50)), scheduler=of_one.address)
    assert 18 == next(results)
    of_one.kill_a_worker()
    with pytest.raises(WorkersError, match=r"has no workers left|again and again"):
        list(results)


def test_a_cluster_asks_for_a_certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With TLS whoever has the certificate is served; whoever has none gets one clear line."""
    from dask import config

    openssl = shutil.which("openssl") or pytest.skip("no openssl makes a certificate")
    key, certificate = (str(tmp_path / name) for name in ("key.pem", "certificate.pem"))
    made = [openssl, "req", "-x509", "-nodes", "-newkey", "rsa:2048", "-subj", "/CN=krl"]
    subprocess.run([*made, "-keyout", key, "-out", certificate], check=True, capture_output=True)
    settings = {"ca-file": certificate}
    for whose in ("client", "scheduler", "worker"):
        settings |= {f"{whose}.cert": certificate, f"{whose}.key": key}
    settings = {f"distributed.comm.tls.{name}": value for name, value in settings.items()}
    for name, value in settings.items():
        variable = name.replace(".", "__").replace("-", "_").upper()
        monkeypatch.setenv(f"DASK_{variable}", value)
    secured = _Cluster(tmp_path, workers=1, protocol="tls")
    try:
        with pytest.raises(WorkersError, match="no Dask scheduler answers at tls://"):
            check_scheduler(secured.address)
        with config.set(settings):
            secured.wait()
            assert [14] == list(ordered_map(_deadly, [(7,)], scheduler=secured.address))
    finally:
        secured.stop()


def test_workers_of_another_release_are_refused(
    cluster: _Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What other code finds is not mixed with ours."""
    monkeypatch.setattr(dask_cluster, "code_digest", lambda *_: "another")
    with pytest.raises(WorkersError, match="has a different release of krl"):
        check_scheduler(cluster.address)
