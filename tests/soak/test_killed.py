"""Work that is killed at any moment goes on where it was: nothing lost, nothing half-written.

Not part of `make test`: `make killed` runs it and tells how often what was killed.
"""

import json
import random
import shutil
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from recovery.synth import write_cells

pytestmark = pytest.mark.soak

REPOSITORY = Path(__file__).parents[2]
SEED = 20_261_121


class Killer:
    """Runs a command and kills it at a moment drawn from a seed, again and again."""

    def __init__(self, command: list[str], folder: Path, seconds: float) -> None:
        self.command = command
        self.folder = folder
        self.seconds = seconds
        self.killed = 0
        self._moments = random.Random(SEED)  # nobody's secret depends on it

    def run(self) -> bool:
        """Start it and kill it; whether it was still at work then."""
        process = self._start()
        time.sleep(self._moments.uniform(0.1, self.seconds))
        process.kill()
        was_alive = process.wait() != 0
        process.communicate()
        self.killed += was_alive
        return was_alive

    def finish(self) -> None:
        """Run it to its end."""
        process = self._start()
        _, told = process.communicate(timeout=600)
        assert process.returncode == 0, told
        assert "Traceback" not in told

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self.command,
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Programs enough for some seconds, some of them with failures."""
    folder = tmp_path_factory.mktemp("corpus")
    write_cells(folder, 3_000_000, seed=7)
    for file in sorted(folder.rglob("*.src"))[::25]:
        file.write_bytes(file.read_bytes() + b"\nWAT 1\n")
    return folder


def _whole_records(out: Path) -> Iterator[Any]:
    """Records and pages are whole wherever they are, or they are not there."""
    for file in out.glob("*.json"):
        yield json.loads(file.read_text(encoding="utf-8"))
    for page in out.glob("*.html"):
        assert page.read_text(encoding="utf-8").rstrip().endswith("</html>")


def _kept(out: Path) -> dict[str, bytes]:
    """What is remembered of which content."""
    base = out / "cache" / "results.sqlite"
    if not base.is_file():
        return {}
    with closing(sqlite3.connect(base)) as opened:
        rows = opened.execute("SELECT key || digest, body FROM result").fetchall()
    return dict(rows)


@pytest.mark.parametrize(("name", "times", "seconds"), [("recover", 30, 5.0), ("growth", 10, 9.0)])
def test_surveys_go_on_where_they_were_killed(
    corpus: Path, tmp_path: Path, name: str, times: int, seconds: float
) -> None:
    """What was read before a kill is known after it, and the record is that of a quiet run."""
    options = ["--no-start"] if name == "recover" else []
    command = [sys.executable, "-m", "krl", name, str(corpus), "--jobs", "2", *options, "--out"]
    quiet, disturbed = tmp_path / "quiet", tmp_path / "disturbed"
    Killer([*command, str(quiet)], REPOSITORY, 0).finish()
    killer = Killer([*command, str(disturbed)], REPOSITORY, seconds)
    known: dict[str, bytes] = {}
    for _ in range(times):
        killer.run()
        list(_whole_records(disturbed))
        now = _kept(disturbed)
        assert known == {key: now.get(key) for key in known}, "what was known is lost"
        known = now
    killer.finish()
    varies = {"seconds", "analysis_seconds", "generated", "lookahead_seconds"}
    left, right = (
        [{k: v for k, v in record.items() if k not in varies} for record in _whole_records(out)]
        for out in (quiet, disturbed)
    )
    assert _timeless(left) == _timeless(right)
    assert set(_kept(quiet)) == set(_kept(disturbed))
    print(
        f"\nkrl {name}: killed {killer.killed} times at work, {len(known)} results kept meanwhile"
    )


def _timeless(value: Any) -> Any:
    """A record without what depends on how quick the machine was."""
    if isinstance(value, dict):
        return {k: _timeless(v) for k, v in value.items() if not k.endswith("seconds")}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


def test_an_acceptance_that_is_killed_is_made_or_not(tmp_path: Path) -> None:
    """Ledger, grammar and parser are all those before or all those after."""
    killed, states = 0, set()
    for turn in range(15):
        folder = tmp_path / str(turn)
        ledger = folder / "grammar" / "constructs"
        shutil.copytree(REPOSITORY / "grammar" / "constructs", ledger)
        for name in ("preliminary.g4", "KRL.g4"):
            shutil.copyfile(REPOSITORY / "grammar" / name, folder / "grammar" / name)
        shutil.copytree(REPOSITORY / "grammar" / "_generated", folder / "grammar" / "_generated")
        shutil.copytree(REPOSITORY / "corpus" / "programs", folder / "corpus" / "programs")
        proposed = tmp_path / f"{turn}.toml"
        proposed.write_text(_weave(), encoding="utf-8")
        command = [sys.executable, "-m", "krl", "construct", "accept", str(proposed)]
        killer = Killer(command, folder, 0.1 + turn)
        killer.run()
        killed += killer.killed
        check = subprocess.run(
            [sys.executable, "-m", "krl", "construct", "replay", "--check"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        assert check.returncode == 0, check.stderr
        states.add("WEAVE" in (folder / "grammar" / "KRL.g4").read_text(encoding="utf-8"))
        shutil.rmtree(folder)
    print(f"\nkrl construct accept: killed {killed} times at work, ended in {len(states)} states")
    assert killed > 0


def _weave() -> str:
    """A construct that an acceptance takes, as its file."""
    from grammar.edits import AddAlternative, AddToken
    from recovery.construct import Construct, Evidence
    from recovery.construct_file import text_of

    return text_of(
        Construct(
            name="weave",
            title="WEAVE",
            summary="Made up.",
            edits=(AddToken("WEAVE"), AddAlternative("simpleStatement", "WEAVE expression")),
            evidence=Evidence(rules=("CTL-05",)),
            accept=("DEF A()\nWEAVE 7\nEND\n",),
            reject=("DEF A()\nWEAVE\nEND\n",),
        )
    )
