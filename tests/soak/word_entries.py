"""Entry points of any command: its words, and what lies where a file is wanted."""

from __future__ import annotations

import os
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import PROGRAM, Entry, Given, krl, put

WORDS = (
    "recover check run growth conform fuzz construct corpus robot bench --json --out --jobs 0 -1 "
    "99999999999999 nothing/here.src /dev/null --seed x compile asm -- - é --help --io --profile"
).split()
WORDS += ["", "\x1b[31m", "\ud800", "a\x00b"]


def words(folder: Path, foundry: Foundry) -> Given:
    """A command line of words by chance; what would work for minutes gets little to do."""
    foundry.note("strange words on the command line")
    os.chdir(folder)  # a word may be the name of a record
    chosen = foundry.chance.choices(WORDS, k=foundry.chance.randrange(1, 5))
    little = {"fuzz": ["--programs", "2"], "conform": ["nothing"] * 2, "bench": ["nothing"] * 2}
    return krl(*chosen, *little.get(next(iter(little.keys() & set(chosen)), ""), ()))


#: Commands by the place of the file that they read, and how its name ends.
FILES_WANTED = [
    ("check --no-cache ?", ".src"),
    ("check --no-cache ?", ".zip"),
    ("format --check ?", ".src"),
    ("recover --no-start --out = ?", ".src"),
    ("recover --no-start --out = --grammar ? !", ".g4"),
    ("run ?", ".src"),
    ("run --io ? !", ".txt"),
    ("run --profile ? !", ".toml"),
    ("compile ? -o =", ".src"),
    ("asm ? -o =", ".krla"),
    ("disasm ?", ".krlb"),
    ("robot status-turn ? --machine !", ".json"),
    ("robot status-turn ! --machine ?", ".dat"),
    ("conform import ?", ".json"),
    ("conform ?", ".src"),
    ("construct try ?", ".toml"),
    ("construct accept ?", ".toml"),
    ("construct oracle --record ?", ".toml"),
    ("construct propose c-1 --survey ?", ".json"),
    ("nightly --only nothing --history ? --out =", ".jsonl"),
    ("bench programs ?", ".src"),
    ("bench real-code ?", ".zip"),
    ("bench mutation --singles 1 --multiple 0 --jobs 1 --grammar ? !", ".g4"),
    ("bench mutation --singles 1 --multiple 0 --jobs 1 --negatives ? !", ".src"),
    ("bench check --planted=0 ?", ".src"),
]


def odd_file(folder: Path, foundry: Foundry) -> Given:
    """Something else than a file where a file is wanted."""
    foundry.note(
        "pipes, devices, folders, loops of links and enormous files in the place of a file"
    )
    command, suffix = foundry.chance.choice(FILES_WANTED)
    odd = folder / f"odd{suffix}"
    match foundry.chance.randrange(6):
        case 0:
            os.mkfifo(odd)
        case 1:
            odd.symlink_to(odd.name)
        case 2:
            odd = Path("/dev/zero")
        case 3:
            odd.mkdir()
        case 4:
            with odd.open("wb") as stream:  # sparse: it needs no room
                stream.truncate(foundry.chance.choice([65 << 20, 1 << 40]))
        case _:
            put(folder, odd.name, b"").chmod(0)
    places = {"?": str(odd), "=": str(folder / "out"), "!": str(put(folder, "ok.src", PROGRAM))}
    return krl(*(places.get(word, word) for word in command.split()))


ENTRIES = {
    "arguments": Entry(60, "words on the command line", words),
    "odd files": Entry(60, "no file at all where a command wants one", odd_file),
}
