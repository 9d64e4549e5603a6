"""Hostile input at every entry point: no traceback, no hang, nothing written elsewhere.

Not part of `make test`: `make hostile` runs it and tells how many inputs went where. Each input is
made from a seed, so what fails can be made again. The environment chooses:

- KRL_HOSTILE_INPUTS: how many inputs there are, which decides what each is;
- KRL_HOSTILE_PART: `2/3` for the second third of them, so that they can be tried in slices;
- KRL_HOSTILE_ONLY: entry points or single numbers to try.

The counts go to reports/out/hostile/; `python -m tests.soak.hostile_page` makes docs/hostile.md.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from grammar.notation import g4
from krl.cli import main
from tests.soak.entries import ENTRIES
from tests.soak.foundry import Foundry
from tests.soak.given import Given, put
from tests.soak.hostile_page import table

pytestmark = [
    pytest.mark.soak,
    pytest.mark.filterwarnings("ignore:Duplicate name"),  # archives that name a file twice
]

REPOSITORY = Path(__file__).parents[2]
SEED = 20_261_121
#: Inputs in all, over all entry points; the environment may ask for fewer or more.
INPUTS = int(os.environ.get("KRL_HOSTILE_INPUTS", "10000"))
#: Entry points or numbers of inputs to try, separated by commas; all where it is empty.
ONLY = [name.strip() for name in os.environ.get("KRL_HOSTILE_ONLY", "").split(",") if name.strip()]
#: Which part of them, of how many.
PART, PARTS = map(int, os.environ.get("KRL_HOSTILE_PART", "1/1").split("/"))
#: Where the counts go.
COUNTS = REPOSITORY / "reports" / "out" / "hostile"
#: Seconds of processor time that no input may take, and seconds by the clock, for what waits.
LONGEST = 60.0
LONGEST_WAIT = 300.0
#: Failures after which it is time to stop.
MOST_LISTED = 12
#: What must not reach a terminal raw: it could steer it, or turn the order of what is read.
STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


#: Standard error as it is before anything captures it.
_STDERR = os.dup(2)


class Watch:
    """Tells which input hangs: a hang in C cannot be broken off from inside."""

    def __init__(self) -> None:
        self.doing = ""
        self.since = self.worked = 0.0
        threading.Thread(target=self._look, daemon=True).start()

    def begin(self, doing: str) -> None:
        """An input begins; an empty text: none does."""
        self.since, self.worked = time.monotonic(), time.process_time()
        self.doing = doing

    def _look(self) -> None:
        while True:
            time.sleep(1)
            worked, waited = time.process_time() - self.worked, time.monotonic() - self.since
            if self.doing and (worked > LONGEST or waited > LONGEST_WAIT):
                os.write(_STDERR, f"\nHANG: {self.doing}\n".encode("utf-8", "replace"))
                os._exit(1)


class Guard:
    """Hears of every file that this process opens for writing, renames, makes or removes."""

    def __init__(self, allowed: Path) -> None:
        self.allowed = str(allowed)
        self.elsewhere: list[str] = []
        self.is_on = True
        sys.addaudithook(self._hear)  # there is no way to take one off again

    def _hear(self, event: str, given: tuple[Any, ...]) -> None:
        if not self.is_on:
            return
        if event == "open":
            path, mode, flags = given
            writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT) if flags else "w" in str(mode)
            named = [path] if writes else []
        elif event in ("os.rename", "os.link", "os.symlink"):
            named = list(given[:2])
        elif event in ("os.remove", "os.mkdir", "os.rmdir", "os.truncate", "os.chmod"):
            named = [given[0]]
        else:
            return
        self.elsewhere += [f"{event} {one!r}" for one in named if not self._is_allowed(one)]

    def _is_allowed(self, path: Any) -> bool:
        if not isinstance(path, str | bytes | os.PathLike):
            return True  # a descriptor, which somebody opened
        text = os.path.abspath(os.fsdecode(path))  # noqa: PTH100  a Path would cost much
        return text.startswith(self.allowed) or text == os.devnull or "__pycache__" in text


def _plan() -> Iterator[tuple[str, int]]:
    """Entry points with the numbers of their inputs."""
    shares = sum(entry.share for entry in ENTRIES.values())
    number = 0
    for name, entry in ENTRIES.items():
        for _ in range(max(1, -(-INPUTS * entry.share // shares))):
            is_named = name in ONLY or str(number) in ONLY
            if is_named or (not ONLY and number % PARTS == PART - 1):
                yield name, number
            number += 1


def _go(given: Given, capfd: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """The status, and what was said on stdout and stderr."""
    if given.stdin is None:
        status = main(given.arguments)
        return status, *capfd.readouterr()
    done = subprocess.run(
        [sys.executable, "-m", "krl", *given.arguments],
        input=given.stdin,
        capture_output=True,
        check=False,
        timeout=LONGEST_WAIT,
        cwd=REPOSITORY,
    )
    # what the server answers goes to a program, not to a terminal
    return done.returncode, "", done.stderr.decode("utf-8", "replace")


def test_nothing_breaks_and_nothing_escapes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Every input ends with 0, 1 or 2, one clear line on stderr for 2, and nothing outside."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "reports"))
    scratch = tmp_path / "reports" / "scratch"
    scratch.mkdir(parents=True)
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    monkeypatch.setattr(g4, "read", cache(g4.read))  # the same text thousandfold
    canary = put(tmp_path, "canary", b"alive")
    foundry, watch, guard = Foundry(), Watch(), Guard(tmp_path)
    went, kinds, worked = Counter[tuple[str, int]](), Counter[str](), dict.fromkeys(ENTRIES, 0.0)
    slowest = (0.0, "")
    failures: list[str] = []
    began = time.monotonic()
    for name, number in _plan():
        folder = tmp_path / "input"
        folder.mkdir()
        foundry.begin(SEED + number)
        given = ENTRIES[name].make(folder, foundry)
        capfd.readouterr()
        said = f"{name}, input {number}: {given.arguments}"
        watch.begin(said)
        before = _processor_time()
        status, out, err = _go(given, capfd)
        took = _processor_time() - before
        watch.begin("")
        slowest = max(slowest, (took, f"{name} {number}"))
        worked[name] += took
        os.chdir(tmp_path)
        went[name, status] += 1
        kinds.update(foundry.kinds)
        wrong = [*_wrong_of(status, out, err), *_wrong_in(folder)]
        there = {p.name for p in tmp_path.iterdir()} - {"input", "reports", "canary"}
        wrong += [f"written outside: {one}" for one in (*sorted(there), *guard.elsewhere)]
        if canary.read_bytes() != b"alive":
            wrong.append("written over what lies outside")
        failures += [f"{said}: {one}: {err[-300:]!r}" for one in wrong]
        if len(failures) > MOST_LISTED:
            break
        guard.elsewhere.clear()
        shutil.rmtree(folder)
    guard.is_on = False
    counts = {
        "inputs": INPUTS,
        "part": f"{PART}/{PARTS}",
        "entries": {
            name: {
                "seconds": round(worked[name], 1),
                **{str(status): went[name, status] for status in (0, 1, 2)},
            }
            for name in ENTRIES
        },
        "kinds": dict(kinds),
        "slowest": {"seconds": round(slowest[0], 1), "input": slowest[1]},
        "seconds": round(time.monotonic() - began),
    }
    with capfd.disabled():
        print(f"\n{table(counts)}")
    assert not failures, "\n".join(failures)
    if not ONLY:
        COUNTS.mkdir(parents=True, exist_ok=True)
        text = json.dumps(counts, indent=1, ensure_ascii=False)
        (COUNTS / f"{PART}-of-{PARTS}.json").write_text(text, encoding="utf-8")
        assert went.total() >= INPUTS // PARTS


def _processor_time() -> float:
    """Seconds that this process and those it has started and met the end of have worked."""
    return sum(os.times()[:4])


def _wrong_of(status: int, out: str, err: str) -> Iterator[str]:
    """What is wrong with how a command ended and what it said."""
    if status not in (0, 1, 2):
        yield f"status {status}"
    if "defect in krl" in err or "Traceback" in err:
        yield "a defect"
    if ": crash after" in out:  # what executors raised that is none of the faults of KRL
        yield f"a defect: {out[-200:]!r}"
    steering = STEERING.search(out + err)
    if steering is not None:
        yield f"raw on the terminal: {steering[0]!r}"
    if status == 2 and len(err.strip().splitlines()) != 1:
        yield "not one line on stderr"


def _wrong_in(folder: Path) -> Iterator[str]:
    """What is wrong with the files that a command wrote."""
    for page in folder.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        if "<script>alert(1)" in text or "<img src=x" in text:
            yield f"{page.name} holds what would run in it"
    for record in folder.rglob("out/*.json"):
        try:
            json.loads(record.read_text(encoding="utf-8"))
        except ValueError as error:
            yield f"{record.name}: {error}"
