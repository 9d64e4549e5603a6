"""Commands on what Windows has: drives, CRLF, names in any case, cp1252, no fork, no tools.

Simulated: what Unix alone has is taken away, and each text that is opened without an encoding is an
error. What a command says and writes is what it is here. ``KRL_SYSTEMS_SEED`` draws other commands.
"""

import os
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

REPOSITORY = Path(__file__).parents[2]
DEMO = REPOSITORY / "corpus" / "programs" / "search_demo"
SEED = os.environ.get("KRL_SYSTEMS_SEED", "1")
COMMANDS = (
    "check --no-cache --jobs 2 {root}",
    "check --no-cache --jobs 1 --format sarif --out out/c.sarif {root}",
    "compile -o out/p.krlb {program}",
    "diff {root} {program}",
    "explain 2296",
    "format --check {root}",
    "recover --jobs 2 --no-start --out out {root}",
    "run --robot none --max-time 1 --trace out/t.jsonl {program}",
    "run --executor native --robot kinematic --max-time 1 --html out/r.html {program}",
    "run --executor vm --robot none --io {script} --max-time 1 {program}",
)
DRAWN = random.Random(SEED).sample(COMMANDS, 2)
STRANGER = """
import multiprocessing, os, signal, sys
for module, names in ((os, "fork forkpty getuid geteuid killpg setsid mkfifo sched_getaffinity"),
                      (signal, "SIGALRM SIGHUP SIGUSR1 alarm setitimer pthread_sigmask")):
    for name in names.split():
        if hasattr(module, name):
            delattr(module, name)
sys.modules["resource"] = None
multiprocessing.set_start_method("spawn")
from krl.__main__ import main
sys.exit(main())
"""
#: What opens texts without an encoding and is not ours.
STRICT = (
    "-X warn_default_encoding -W error::EncodingWarning -W ignore::EncodingWarning:glfw.library"
)


def laid_out(place: Path, words: str) -> list[str]:
    """The words for a copy of the demonstration on a drive, its names and line ends drawn."""
    chance = random.Random(f"{SEED} {words}")
    cases = (str.upper, str.lower, str.title)
    root = Path("C:", "Backup")
    copies = {}
    for file in sorted(path for path in DEMO.rglob("*") if path.is_file()):
        folder = root / file.parent.relative_to(DEMO)
        copy = folder / (file.name if file.suffix == ".io" else chance.choice(cases)(file.name))
        copies[file.name] = copy
        (place / folder).mkdir(parents=True, exist_ok=True)
        (place / copy).write_bytes(b"\r\n".join(file.read_bytes().splitlines()) + b"\r\n")
    (place / "out").mkdir()
    program, script = copies["search_demo.src"], copies["search_demo.io"]
    return [
        word.format(root=root, program=program, script=script).replace(os.sep, "/")
        for word in words.split()
    ]


def done(place: Path, words: str, *, stranger: bool) -> tuple[int, bytes, list[str]]:
    """Status, output without durations, and the names of what was written."""
    place.mkdir()
    given = laid_out(place, words)
    begun = [*STRICT.split(), "-c", STRANGER] if stranger else ["-m", "krl"]
    other = {"PATH": "", "PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0", "LC_ALL": "C"}
    shared = {"XDG_CACHE_HOME": str(place / "cache"), "PYTHONPATH": str(REPOSITORY)}
    ended = subprocess.run(
        [sys.executable, *begun, *given],
        cwd=place,
        env=os.environ | shared | (other if stranger else {}),
        capture_output=True,
        check=False,
    )
    assert ended.returncode in (0, 1), ended.stderr.decode()
    written = (path for path in place.rglob("*") if "cache" not in path.parts)
    said = re.sub(rb"[\d.]+ s\b", b"N s", ended.stdout.replace(b"\r\n", b"\n"))
    return ended.returncode, said, sorted(str(path.relative_to(place)) for path in written)


@pytest.mark.parametrize("words", DRAWN)
def test_a_command_says_what_it_says_here(tmp_path: Path, words: str) -> None:
    """Status, output and files of a command do not depend on the system."""
    here = done(tmp_path / "here", words, stranger=False)
    assert here == done(tmp_path / "there", words, stranger=True)


def test_the_demonstration_runs_there(tmp_path: Path) -> None:
    """`krl demo` comes to its end and writes its page."""
    pytest.importorskip("mujoco")
    status, _, files = done(tmp_path / "there", "demo --no-open --html d.html", stranger=True)
    assert (0, True) == (status, "d.html" in files)
