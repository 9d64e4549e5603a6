"""Work that is killed at any moment goes on where it was: nothing lost, nothing half-written.

Not part of `make test`: `make killed` runs it and tells how often what was killed. A kill counts
only where it met a command at work; the moments are drawn from a seed.
"""

from __future__ import annotations

import json
import random
import shutil
import sqlite3
import subprocess
import sys
import time
import zlib
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from grammar.generation.synthetic_corpus import write_cells

pytestmark = pytest.mark.soak

REPOSITORY = Path(__file__).parents[2]
SEED = 20_261_121
#: Runs that ended before their moment came, for each that was killed.
MOST_IN_TIME = 4


class Killer:
    """Runs a command and kills it at moments drawn from a seed."""

    def __init__(self, command: list[str], folder: Path) -> None:
        self.command = [sys.executable, "-m", "krl", *command]
        self.folder = folder
        self.killed = 0
        self._moments = random.Random(f"{SEED} {folder.name}")  # nobody's secret depends on it

    def run(self, seconds: float) -> bool:
        """Start it, kill it within so many seconds; whether it was still at work then."""
        process = subprocess.Popen(
            self.command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        time.sleep(self._moments.uniform(0.2, seconds))
        was_at_work = process.poll() is None
        process.kill()
        process.wait()
        self.killed += was_at_work
        return was_at_work

    def finish(self, *statuses: int) -> float:
        """Run it to its end, with status 0 or one of those; returns the seconds that took."""
        began = time.monotonic()
        done = subprocess.run(
            self.command, cwd=self.folder, capture_output=True, text=True, check=False, timeout=600
        )
        assert done.returncode in (0, *statuses), done.stderr
        assert "Traceback" not in done.stderr
        return time.monotonic() - began


def _corpus(folder: Path, size: int) -> Path:
    """Programs of so many bytes, some of them with failures."""
    write_cells(folder, size, seed=7)
    for file in sorted(folder.rglob("*.src"))[::12]:
        file.write_bytes(file.read_bytes() + b"\nWAT 1\n")
    return folder


def _whole_records(out: Path) -> Iterator[Any]:
    """Records and pages are whole wherever they are, or they are not there."""
    for file in sorted(out.glob("*.json")):
        yield json.loads(file.read_text(encoding="utf-8"))
    for page in out.glob("*.html"):
        assert page.read_text(encoding="utf-8").rstrip().endswith("</html>")


#: Notes each result that is written a second time, which is what reading a file again comes to.
WATCHED = """
CREATE TABLE IF NOT EXISTS again (digest TEXT, old BLOB, new BLOB);
CREATE TRIGGER IF NOT EXISTS watch BEFORE INSERT ON result
WHEN EXISTS (SELECT 1 FROM result WHERE key = NEW.key AND digest = NEW.digest)
BEGIN
  INSERT INTO again SELECT digest, body, NEW.body FROM result
  WHERE key = NEW.key AND digest = NEW.digest;
END;
"""


def _knows_more(old: bytes, new: bytes) -> bool:
    """Whether a file was read under further grammars, which is all that growth may do again."""
    before, after = (json.loads(zlib.decompress(body)) for body in (old, new))
    return "grammars" in before and set(before["grammars"]) < set(after["grammars"])


def _kept(out: Path) -> set[str]:
    """The contents of which something is remembered; what is read again from now on is noted."""
    base = out / "cache" / "results.sqlite"
    if not base.is_file():
        return set()
    with closing(sqlite3.connect(base, timeout=30)) as opened:
        if not opened.execute("SELECT 1 FROM sqlite_master WHERE name = 'result'").fetchall():
            return set()
        opened.executescript(WATCHED)
        assert opened.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        again = opened.execute("SELECT old, new FROM again").fetchall()
        assert all(_knows_more(old, new) for old, new in again), "read again"
        return {key for (key,) in opened.execute("SELECT digest FROM result")}


@pytest.mark.parametrize(
    ("name", "size", "times"), [("recover", 600_000, 30), ("growth", 400_000, 8)]
)
def test_surveys_go_on_where_they_were_killed(
    tmp_path: Path, name: str, size: int, times: int
) -> None:
    """What was read before a kill is not read again, and the record is that of a quiet run."""
    corpus = _corpus(tmp_path / "corpus", size)
    options = [str(corpus), "--jobs", "2", *(["--no-start"] if name == "recover" else []), "--out"]
    quiet, disturbed = tmp_path / "quiet", tmp_path / "disturbed"
    seconds = Killer([name, *options, str(quiet)], REPOSITORY).finish()
    [wanted] = map(_timeless, _whole_records(quiet))
    killer = Killer([name, *options, str(disturbed)], REPOSITORY)
    known: set[str] = set()
    most = finished = 0
    while killer.killed < times and finished < times * MOST_IN_TIME:
        was_at_work = killer.run(seconds * 0.9)
        list(_whole_records(disturbed))
        now = _kept(disturbed)
        assert known <= now, "what was known is lost"
        known, most = now, max(most, len(now))
        if not was_at_work:  # it came to its end with what it knew: begin anew
            finished += 1
            assert [wanted] == list(map(_timeless, _whole_records(disturbed)))
            shutil.rmtree(disturbed)
            known = set()
    killer.finish()
    assert [wanted] == list(map(_timeless, _whole_records(disturbed)))
    assert _kept(quiet) == _kept(disturbed)
    assert most > 0, "nothing was kept before any kill"
    assert killer.killed >= times
    print(f"\nkrl {name}: killed {killer.killed} times at work, {most} results kept meanwhile")


#: What a record says of when it was made, and how long that took.
VARIES = ("seconds", "generated")


def _timeless(value: Any) -> Any:
    """A record without what depends on how quick the machine was."""
    if isinstance(value, dict):
        return {k: _timeless(v) for k, v in value.items() if not k.endswith(VARIES)}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


def test_a_night_that_is_killed_goes_on(tmp_path: Path) -> None:
    """Its records are whole, what is done is not done again, and it is one line of the history."""
    corpus = _corpus(tmp_path / "corpus", 40_000)
    options = ["--minutes", "30", "--date", "2026-01-02", "--only", "recover", "--only", "growth"]
    for folder in ("quiet", "disturbed"):
        (tmp_path / folder).mkdir()
    command = ["nightly", str(corpus), *options]
    places = ["--out", "out", "--history", "history.jsonl"]
    seconds = Killer([*command, *places], tmp_path / "quiet").finish(1)
    killer = Killer([*command, *places], tmp_path / "disturbed")
    night = tmp_path / "disturbed" / "out" / "2026-01-02"
    known: dict[str, float] = {}
    finished = 0
    while killer.killed < 5 and finished < 5 * MOST_IN_TIME:
        if not killer.run(seconds * 0.9):  # it came to its end: begin another night
            finished += 1
            shutil.rmtree(night)
            known = {}
            continue
        list(_whole_records(night))
        now = {file.name: file.stat().st_mtime for file in night.glob("*.json")}
        assert known.items() <= now.items(), "a step that was done is done again"
        known = {name: at for name, at in now.items() if name != "nightly.json"}
    killer.finish(1)
    lines = (tmp_path / "disturbed" / "history.jsonl").read_text(encoding="utf-8").splitlines()
    assert ["2026-01-02"] == [json.loads(line)["date"] for line in lines]
    wanted = json.loads((tmp_path / "quiet" / "history.jsonl").read_text(encoding="utf-8"))
    for step in ("recover", "growth"):
        assert _timeless(wanted[step]) == _timeless(json.loads(lines[0])[step])
    print(f"\nkrl nightly: killed {killer.killed} times at work")
    assert killer.killed == 5


def test_an_acceptance_that_is_killed_is_made_or_not(tmp_path: Path) -> None:
    """Ledger, grammar and parser are all those before or all those after."""
    killed, states, seconds = 0, set(), 0.0
    for turn in range(7 * MOST_IN_TIME):
        if killed == 7:
            break
        folder = tmp_path / str(turn)
        for name in ("constructs", "_generated"):
            shutil.copytree(REPOSITORY / "grammar" / name, folder / "grammar" / name)
        for name in ("preliminary.g4", "KRL.g4"):
            shutil.copyfile(REPOSITORY / "grammar" / name, folder / "grammar" / name)
        shutil.copytree(REPOSITORY / "corpus" / "programs", folder / "corpus" / "programs")
        proposed = tmp_path / "weave.toml"
        proposed.write_text(_weave(), encoding="utf-8")
        killer = Killer(["construct", "accept", str(proposed)], folder)
        if turn == 0:
            seconds = killer.finish()
        else:
            killer.run(seconds)
        killed += killer.killed
        Killer(["construct", "replay", "--check"], folder).finish()
        states.add("WEAVE" in (folder / "grammar" / "KRL.g4").read_text(encoding="utf-8"))
        shutil.rmtree(folder)
    print(f"\nkrl construct accept: killed {killed} times at work, ended in {len(states)} states")
    assert killed == 7


def _weave() -> str:
    """A construct that an acceptance takes, as its file."""
    from grammar.notation.edits import AddAlternative, AddToken
    from recovery.ledger.construct import Construct, Evidence
    from recovery.ledger.construct_file import text_of

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
