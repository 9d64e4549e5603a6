"""Processes of a pool end with the process that made it."""

import os
import signal
import subprocess
import sys

import pytest

IDLE = """
import os, sys
from support.parallel.processes import process_pool
if __name__ == "__main__":
    with process_pool(2) as pool:
        print(pool.submit(os.getpid).result(), flush=True)
        sys.stdin.read()
"""
BUSY = """
import signal, sys, time
from support.parallel.ordered_map import ordered_map
if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it
    try:
        for _ in ordered_map(time.sleep, [(0,), *[(300,)] * 5], jobs=2):
            print("begun", flush=True)
    except KeyboardInterrupt:
        sys.exit(130)
"""


def test_processes_end_with_a_killed_parent() -> None:
    """What reads their output comes to its end, which it does not while one of them lives."""
    process = subprocess.Popen(
        [sys.executable, "-c", IDLE], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    assert int(process.stdout.readline()) != process.pid
    process.kill()
    out, _ = process.communicate()
    assert b"" == out


@pytest.mark.skipif(os.name == "nt", reason="there are no groups of processes")
def test_an_interrupt_ends_all_at_once() -> None:
    """As Ctrl-C does in a terminal: no task is waited for, and only the parent reports it."""
    process = subprocess.Popen(
        [sys.executable, "-c", BUSY],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert b"begun\n" == process.stdout.readline()
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate()
    assert (130, b"") == (process.returncode, errors)
