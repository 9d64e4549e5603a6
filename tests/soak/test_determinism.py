"""The same input gives the same record, whatever else differs (`make determinism`).

Each command runs twenty times: with other numbers of processes, hash seeds, orders in which files
were made, time zones, languages and widths of the terminal, on the programs of the corpus, some of
them damaged by a seed. Only times and durations may differ.
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.soak.given import REPOSITORY

pytestmark = pytest.mark.soak

RUNS = int(os.environ.get("KRL_DETERMINISM_RUNS", "20"))
SEED = int(os.environ.get("KRL_DETERMINISM_SEED", "1"))
#: Fields of records that say when, or for how long.
TIMES = {"analysis_seconds", "generated", "seconds"}
#: What each command line writes, the words of a command with ``{in}``, ``{out}`` and ``{jobs}``.
COMMANDS = {
    "recover": "recover --jobs {jobs} --no-start --out {out} {in}",
    "recover under the start": "recover --jobs {jobs} --out {out} {in}/machine_tending",
    "recover --auto": "recover --auto --hold-out 0.3 --target grammar/KRL.g4 --out {out} {in}",
    "check": "check --no-cache --jobs {jobs} --format json --out {out}/c.json {in}",
    "check as SARIF": "check --no-cache --jobs {jobs} --format sarif --out {out}/c.sarif {in}",
    "diff": "diff --json {out}/d.json --html {out}/d.html {in} {in}/machine_tending",
    "growth": "growth --jobs {jobs} --out {out} {in}/machine_tending",
    "conform": "conform --jobs {jobs} --robot none --json {out}/c.json --junit {out}/c.xml types",
    "fuzz": "fuzz --programs 40 --seed 3 --jobs {jobs} --json {out}/f.json",
    "run": "run --trace {out}/t.jsonl --html {out}/r.html --max-time 20 {program}",
    "compile": "compile -o {out}/p.krlb {program}",
}


def _copied(source: Path, target: Path, order: int) -> Path:
    """The files, made in another order, some of them cut or with lines exchanged by the seed."""
    files = sorted(path for path in source.rglob("*") if path.is_file())
    damage = random.Random(SEED)
    damaged = {path: damage.random() for path in files if damage.random() < 0.15}
    random.Random(order).shuffle(files)
    for path in files:
        data = path.read_bytes()
        if path in damaged:
            data = data[: int(len(data) * damaged[path])]
        copy = target / path.relative_to(source)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(data)
    return target


def _written(words: str, folder: Path, run: int) -> dict[str, Any]:
    """What a command writes in one of the ways, by file; and its exit status."""
    corpus = _copied(REPOSITORY / "corpus" / "programs", folder / "in", run)
    out = folder / "out"
    out.mkdir()
    program = next(iter(sorted(corpus.rglob("*.src"))))
    places = {"in": corpus, "out": out, "jobs": (1, 2, 4)[run % 3], "program": program}
    environment = os.environ | {
        "PYTHONHASHSEED": str(run * 7919 % 4_000_000),
        "TZ": ("UTC", "Asia/Kolkata", "America/Los_Angeles")[run % 3],
        "LC_ALL": ("C.UTF-8", "C")[run % 2],
        "COLUMNS": ("80", "200")[run % 2],
        "XDG_CACHE_HOME": str(folder / "cache"),
    }
    done = subprocess.run(
        [sys.executable, "-m", "krl", *(word.format(**places) for word in words.split())],
        cwd=REPOSITORY,
        env=environment,
        capture_output=True,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr.decode()
    return {"status": done.returncode} | {
        str(path.relative_to(out)): _content(path, str(folder))
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.parent.name != "cache"
    }


def _content(path: Path, folder: str) -> Any:
    text = path.read_bytes().replace(folder.encode(), b"FOLDER")
    if path.suffix in (".json", ".sarif"):
        return _timeless(json.loads(text))
    if path.suffix in (".html", ".xml"):
        return re.sub(rb"[0-9][0-9.,:T-]*[0-9]( ?m?s)?", b"N", text)
    return text


def _timeless(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _timeless(one) for key, one in value.items() if key not in TIMES}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


@pytest.mark.parametrize("command", COMMANDS)
def test_same_record(command: str, tmp_path: Path) -> None:
    """All runs of the command write the same."""
    first, *others = _runs(command, tmp_path)
    for run, other in enumerate(others, 1):
        assert {name: other[name] for name in other if other[name] != first.get(name)} == {}, run
        assert first.keys() == other.keys()


def _runs(command: str, tmp_path: Path) -> Iterator[dict[str, Any]]:
    for run in range(RUNS):
        folder = tmp_path / "same"  # the same place, so that no path differs
        yield _written(COMMANDS[command], folder, run)
        shutil.rmtree(folder)
