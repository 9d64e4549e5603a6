"""A disk that is full while a command writes: one line that names the file, and nothing is lost."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="has no limit of files"),
]

#: Runs a command that may write so many bytes to each file, as where a disk has no more.
_LIMITED = """
import resource, runpy, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv.pop(1)),) * 2)
runpy.run_module("krl", run_name="__main__")
"""


def krl(words: str, most: int | None = None) -> tuple[int, str]:
    """The status of a command, and the last line that it tells."""
    python = [sys.executable, "-m", "krl"]
    if most is not None:
        python = [sys.executable, "-c", _LIMITED, str(most)]
    done = subprocess.run(
        [*python, *shlex.split(words)], capture_output=True, text=True, check=False, timeout=120
    )
    lines = [line for line in done.stderr.splitlines() if not re.match("krl: .*: .* of ", line)]
    return done.returncode, "".join(lines)


def record(file: Path) -> dict[str, Any]:
    found = json.loads(file.read_text(encoding="utf-8"))
    return {name: found[name] for name in found if not name.endswith(("generated", "seconds"))}


def test_a_survey_goes_on_after_the_disk_was_full(tmp_path: Path) -> None:
    """It tells which file could not be written, leaves no half of one, and ends well afterwards."""
    given = tmp_path / "a.src"
    given.write_text("DEF A()\nWAT 1\nEND\n", encoding="ascii")
    out, quiet = tmp_path / "out", tmp_path / "quiet"
    words = f"recover --jobs 1 --no-start {given} --out"
    assert (2, f"krl: {out / 'index.html'}: File too large") == krl(f"{words} {out}", 20_000)
    assert ["cache"] == [one.name for one in out.iterdir()]
    assert 0 == krl(f"{words} {out}")[0] == krl(f"{words} {quiet}")[0]
    assert record(quiet / "survey.json") == record(out / "survey.json")
    assert 2 == krl(f"{words} {out}", 2_000)[0]
    assert not (out / "cache" / "results.damaged").exists()


@pytest.mark.parametrize(
    ("words", "file"),
    [
        ("check --no-cache --format json --out {out}/c.sarif {given}", "c.sarif"),
        ("corpus synth --size 40kB --out {out}", "assembly_1"),
        ("construct replay --out {out}/G.g4", "G.g4"),
    ],
)
def test_the_file_is_named(tmp_path: Path, words: str, file: str) -> None:
    """A person knows where there is no room."""
    given = tmp_path / "a.src"
    given.write_text("DEF A()\n?? ??\nEND\n", encoding="ascii")
    status, told = krl(words.format(out=tmp_path / "out", given=given), 100)
    assert 2 == status
    assert told.startswith(f"krl: {tmp_path / 'out' / file}")
    assert told.endswith(": File too large")
