"""The same input gives the same output, whatever else differs (`make determinism`).

What a command writes and prints is compared. Each command runs ten times: with other numbers of
processes, hash seeds, orders in which files were made, time zones, languages and widths of the
terminal, on the programs of the corpus or of ``KRL_DETERMINISM_CORPUS``, some of them damaged by
``KRL_DETERMINISM_SEED``. Only times and durations may differ. That no option that writes is missing
here is a test of its own (`tests/krl/test_written_files.py`).
"""

from __future__ import annotations

import json
import os
import random
import re
import runpy
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from grammar.bench.damage import DAMAGES
from grammar.syntax.source import Source
from tests.soak.given import REPOSITORY

pytestmark = pytest.mark.soak

RUNS = int(os.environ.get("KRL_DETERMINISM_RUNS", "10"))
#: Of the terminal, by turns: what is printed may depend on it, what is written may not.
WIDTHS = (80, 200)
_PRINTED = "printed in {} columns"
SEED = int(os.environ.get("KRL_DETERMINISM_SEED", "1"))
#: Fields of records that say when, or for how long.
TIMES = {"analysis_seconds", "generated", "seconds", "wall"}
#: What each command line writes, the words of a command with ``{in}``, ``{out}`` and ``{jobs}``.
COMMANDS = {
    "recover": "recover --jobs {jobs} --no-start --out {out} {in}",
    "recover under the start": "recover --jobs {jobs} --out {out} --json {out}/r.json {some}",
    "recover --auto": "recover --auto --hold-out 0.3 --target grammar/KRL.g4 --out {out} {some}",
    "check": "check --no-cache --jobs {jobs} --format json --out {out}/c.json {in}",
    "check as SARIF": "check --no-cache --jobs {jobs} --format sarif --out {out}/c.sarif {in}",
    "check as JUnit": "check --no-cache --jobs {jobs} --format junit --out {out}/c.xml {in}",
    "check as text": "check --no-cache --jobs {jobs} {in}",
    "check, fixes": "check --no-cache --jobs {jobs} --diff {in}",
    "check for GitHub": "check --no-cache --jobs {jobs} --format github {in}",
    "check, kept": "check --cache {out}/cache --jobs {jobs} --write-baseline {out}/b.json {in}",
    "diff": "diff --json {out}/d.json --html {out}/d.html {in} {some}",
    "growth": "growth --jobs {jobs} --out {out} --json {out}/g.json {some}",
    "conform": "conform --jobs {jobs} --robot none --json {out}/c.json --junit {out}/c.xml "
    "--html {out} types",
    "fuzz": "fuzz --programs 40 --seed 3 --jobs {jobs} --json {out}/f.json",
    "run": "run --robot kinematic --trace {out}/t.jsonl --html {out}/r.html --path {out}/p.csv "
    "--max-time 20 {program}",
    "compile": "compile -o {out}/p.krlb {program}",
    "asm": "asm -o {out}/p.krlb {assembly}",
    "test": "test -n {jobs} --junit {out}/t.xml --cov-html {out} --lcov {out}/t.info {tests}",
    "construct list": "construct list --json {out}/l.json",
    "construct replay": "construct replay --out {out}/G.g4",
    "construct oracle": "construct oracle --bundle {out}/bundle",
    "corpus synth": "corpus synth --size 40kB --seed 7 --out {out}/synth",
    "format": "format {in}",
    "disasm": "disasm {image}",
    "steps": "disasm --steps {image}",
    "debug": "debug --io auto --max-time 20 {program}",
    "construct show": "construct show 40",
    "explain": "explain",
    "bench programs": "bench programs --jobs {jobs} --max-time 5 --cache {out}/cache "
    "--json {out}/p.json {some}",
    "bench real-code": "bench real-code --executor vm --json {out}/c.json {some}",
}
_TIMES_SHOWN = re.compile(rb"[0-9.,]+ ?[kMG]?B/s|[0-9][0-9.,:T+-]*[0-9]( ?m?s)?|[0-9] ?m?s\b")
_CORPUS = Path(os.environ.get("KRL_DETERMINISM_CORPUS") or REPOSITORY / "corpus" / "programs")
#: A program that can be begun.
_MAIN = re.compile(rb"(?:\s*[&;].*\n)*\s*DEF +\w+ *\( *\)", re.IGNORECASE)
_TESTS = REPOSITORY / "examples" / "cell-tests" / "tests"


def _copied(source: Path, target: Path, order: int) -> Path:
    """The files, made in another order, three of twenty damaged in ways that the seed draws."""
    files = sorted(path for path in source.rglob("*") if path.is_file())
    chance = random.Random(SEED)
    damaged = {path: chance.choice(list(DAMAGES)) for path in files if chance.random() < 0.15}
    random.Random(order).shuffle(files)
    for path in files:
        name = path.relative_to(source)
        data: bytes | None = path.read_bytes()
        if path in damaged and path.suffix.lower() in (".src", ".dat", ".sub"):
            text = path.read_bytes().decode("latin-1")
            changed = DAMAGES[damaged[path]](
                Source(text, name.as_posix()), random.Random(f"{SEED} {name.as_posix()}")
            )
            data = None if changed is None else changed.encode("latin-1")
        if data is not None:
            copy = target / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(data)
    return target


def _some(corpus: Path, target: Path) -> Path:
    """A few programs of the corpus with their data lists, for what is dear."""
    for path in random.Random(SEED).sample(sorted(corpus.rglob("*.src")), 12):
        for file in filter(Path.is_file, (path, path.with_suffix(".dat"))):
            copy = target / file.relative_to(corpus)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(file.read_bytes())
    return target


def _written(words: str, folder: Path, run: int) -> dict[str, Any]:
    """What a command writes in one of the ways, by file; and its exit status."""
    corpus = _copied(_CORPUS, folder / "in", run)
    out = folder / "out"
    out.mkdir()
    programs = [path for path in sorted(corpus.rglob("*.src")) if _MAIN.match(path.read_bytes())]
    places: dict[str, Any] = {
        "in": corpus,
        "out": out,
        "jobs": (1, 2, 4)[run % 3],
        "program": programs[SEED % len(programs)],
        "some": _some(corpus, folder / "some"),
        "assembly": folder / "p.krla",
        "image": folder / "p.krlb",
        "tests": _TESTS,
    }
    everything = runpy.run_path(str(REPOSITORY / "tests/interp/bytecode/conftest.py"))
    places["assembly"].write_text(everything["EVERYTHING"], encoding="utf-8")
    environment = os.environ | {
        "PYTHONHASHSEED": str(run * 7919 % 4_000_000),
        "TZ": ("UTC", "Asia/Kolkata", "America/Los_Angeles")[run % 3],
        "LC_ALL": ("C.UTF-8", "C")[run % 2],
        "COLUMNS": str(WIDTHS[run % 2]),
        "XDG_CACHE_HOME": str(folder / "cache"),
    }
    if "{image}" in words:
        _krl("asm -o {image} {assembly}", places, environment)
    done = _krl(words, places, environment)
    written = {
        str(path.relative_to(out)): _content(path, str(folder))
        for path in sorted(out.rglob("*"))
        if path.is_file() and "cache" not in path.parts
    }
    if words.startswith("format"):
        written |= {str(path): path.read_bytes() for path in sorted(corpus.rglob("*.*"))}
    # pytest prints the number of its workers; durations are columns of the other table
    if not words.startswith(("test", "bench programs")):
        printed = done.stdout.replace(str(folder).encode(), b"FOLDER")
        printed = re.sub(rb"[ \xe2\x94\x80]+", b" ", printed)  # as wide as a duration is long
        written[_PRINTED.format(WIDTHS[run % 2])] = _TIMES_SHOWN.sub(b"N", printed)
    return {"status": done.returncode} | written


def _krl(
    words: str, places: dict[str, Any], environment: dict[str, str]
) -> subprocess.CompletedProcess[bytes]:
    """A command that has run, with success or with findings."""
    done = subprocess.run(
        [sys.executable, "-m", "krl", *(word.format(**places) for word in words.split())],
        cwd=REPOSITORY,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr.decode()
    return done


def _content(path: Path, folder: str) -> Any:
    text = path.read_bytes().replace(folder.encode(), b"FOLDER")
    if path.suffix in (".json", ".sarif"):
        return _timeless(json.loads(text))
    if path.suffix in (".html", ".xml"):
        return _TIMES_SHOWN.sub(b"N", text)
    return text


def _timeless(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _timeless(one) for key, one in value.items() if key not in TIMES}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


@pytest.mark.parametrize("command", COMMANDS)
def test_same_record(command: str, tmp_path: Path) -> None:
    """All runs of the command write the same."""
    known: dict[str, Any] = {}
    for run, written in enumerate(_runs(command, tmp_path)):
        assert {} == {
            name: value for name, value in written.items() if known.setdefault(name, value) != value
        }, run
        assert [] == sorted(known.keys() - written.keys() - {_PRINTED.format(w) for w in WIDTHS})


def _runs(command: str, tmp_path: Path) -> Iterator[dict[str, Any]]:
    for run in range(RUNS):
        folder = tmp_path / "same"  # the same place, so that no path differs
        yield _written(COMMANDS[command], folder, run)
        shutil.rmtree(folder)
