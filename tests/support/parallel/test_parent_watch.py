"""Processes of a pool end where the process that made it was killed."""

import subprocess
import sys

PROGRAM = """
import os, sys
from support.parallel.sticky_pool import Lanes
if __name__ == "__main__":
    with Lanes(2) as lanes:
        print(lanes.submit(1, os.getpid).result(), flush=True)
        sys.stdin.read()
"""


def test_processes_end_with_a_killed_parent() -> None:
    """What reads their output comes to its end, which it does not while one of them lives."""
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    assert int(process.stdout.readline()) != process.pid
    process.kill()
    out, _ = process.communicate(timeout=60)
    assert b"" == out
