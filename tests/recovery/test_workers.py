"""Work in other processes and on a cluster: every result once, in order, whoever dies."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from grammar import read_file
from grammar.generate import GRAMMAR
from recovery.survey import survey
from recovery.synth import write_cells
from recovery.workers import WorkersError, in_order


def _double(number: int, folder: str) -> int:
    """Twice the number; the first process that is given 3 dies of it."""
    mark = Path(folder, "died")
    if number == 3 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60)
    return 2 * number


def _dies(_number: int) -> int:
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(60)
    return 0


def test_results_come_in_order_though_a_process_dies(tmp_path: Path) -> None:
    """A process that is killed loses no result, and none comes twice."""
    tasks = ((number, str(tmp_path)) for number in range(12))
    assert [2 * n for n in range(12)] == list(in_order(_double, tasks, jobs=2))
    assert (tmp_path / "died").exists()


def test_work_that_kills_every_process_is_given_up() -> None:
    """A task that kills each process it is given to ends with one clear line."""
    with pytest.raises(WorkersError, match="workers died 3 times"):
        list(in_order(_dies, [(1,)], jobs=2))


def test_no_scheduler_is_one_clear_line() -> None:
    """An address where no scheduler answers is told as that."""
    pytest.importorskip("distributed")
    done = _recover("corpus/programs", "--scheduler", "tcp://127.0.0.1:9", "--no-start")
    assert 2 == done.returncode
    assert "krl: no Dask scheduler answers at tcp://127.0.0.1:9\n" == done.stderr


# ---------------------------------------------------------------------------------- a real cluster


def _recover(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "krl", "recover", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)


class _Cluster:
    """A scheduler and workers, each a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._processes: list[subprocess.Popen[str]] = []
        scheduler = self._start("scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1")
        self.address = self._address(scheduler)
        self.workers = [self._worker() for _ in range(3)]

    def _start(self, role: str, *arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", "distributed.cli.dask_" + role, *arguments]
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=self.folder
        )
        self._processes.append(process)
        return process

    def _worker(self) -> subprocess.Popen[str]:
        limits = ("--nthreads", "1", "--no-nanny", "--no-dashboard")
        worker = self._start("worker", self.address, *limits)
        threading.Thread(target=worker.communicate, daemon=True).start()
        return worker

    @staticmethod
    def _address(scheduler: subprocess.Popen[str]) -> str:
        assert scheduler.stderr is not None
        for line in scheduler.stderr:
            found = re.search(r"tcp://[\d.]+:\d+", line)
            if found:
                threading.Thread(target=scheduler.communicate, daemon=True).start()
                return found.group()
        raise AssertionError("the scheduler did not start")

    def stop(self) -> None:
        for process in self._processes:
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[_Cluster]:
    pytest.importorskip("distributed")
    started = _Cluster(tmp_path)
    yield started
    started.stop()


def test_a_cluster_gives_the_same_survey_though_a_worker_is_killed(
    cluster: _Cluster, tmp_path: Path
) -> None:
    """Three workers, one killed in the middle: nothing lost, nothing twice, the same order."""
    corpus = tmp_path / "corpus"
    write_cells(corpus, 4_000_000, seed=5)
    for file in sorted(corpus.rglob("*.src"))[::10]:  # so that there are failures to be ordered
        file.write_bytes(file.read_bytes() + b"\nWAT 1\n")
    grammar = read_file(GRAMMAR)
    alone = survey([corpus], grammar, jobs=1)
    done: list[int] = []

    def count(files: int) -> None:
        done.append(files)
        if sum(done) > 20:
            cluster.workers[1].kill()

    there = survey([corpus], grammar, scheduler=cluster.address, on_done=count)
    assert cluster.workers[1].poll() is not None
    assert len(done) > 3, "there was no middle to kill it in"
    assert alone.files == there.files
    assert alone.forms == there.forms
    assert alone.skipped == there.skipped
    assert any(file.failures for file in there.files)


def test_the_command_takes_a_scheduler(cluster: _Cluster, tmp_path: Path) -> None:
    """`krl recover --scheduler` gives the record that local processes give."""
    records = []
    for name, given in (("alone", ("--jobs", "1")), ("there", ("--scheduler", cluster.address))):
        done = _recover(*given, "corpus/programs", "--no-start", "--out", str(tmp_path / name))
        assert 0 == done.returncode, done.stderr
        record = json.loads((tmp_path / name / "survey.json").read_text(encoding="utf-8"))
        for varies in ("seconds", "analysis_seconds", "generated"):
            record.pop(varies, None)
        records.append(record)
    assert records[0] == records[1]
