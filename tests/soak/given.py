"""What is given to an entry point, and what most of them are given."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.soak.foundry import Foundry

REPOSITORY = Path(__file__).parents[2]


@dataclass(frozen=True, slots=True)
class Given:
    """What an entry point is given; with ``stdin`` it is a process of its own."""

    arguments: list[str]
    stdin: bytes | None = None


#: Makes a command line, and the hostile files that it names, in a folder of its own.
Maker = Callable[[Path, Foundry], Given]


@dataclass(frozen=True, slots=True)
class Entry:
    """An entry point: its share of all inputs, what it is given in words, and who makes that."""

    share: int
    words: str
    make: Maker


def krl(*arguments: str | Path) -> Given:
    """A command line."""
    return Given([str(one) for one in arguments])


def put(folder: Path, name: str, data: bytes) -> Path:
    """A file."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


OK = b"DEF A()\nEND\n"
PROGRAM = (
    b"DEF A()\n  $TOOL=$NULLFRAME\n  $BASE=$NULLFRAME\n"
    b"  PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND\n"
)
STRANGE = ["\x1b[31m.src", "a\nb.src", "<b>\u202ecrs.src", "\udcff.src", "-o.src", "é 𝄞.src"]


def named(foundry: Foundry, plain: Sequence[str]) -> str:
    """The name of a file: one of the plain ones, or a strange one."""
    name: str = foundry.chance.choice([*plain, *STRANGE])
    if name in STRANGE:
        foundry.note("strange names of files and folders")
    return name


def program(folder: Path, foundry: Foundry) -> Path:
    """A file with a program; its name may be strange too."""
    plain = ["a.src"] * 6 + ["a.dat", "a.sub", "$config.dat", "R1/System/a.src"]
    return put(folder, named(foundry, plain), foundry.program())


def runnable(folder: Path, foundry: Foundry) -> Path:
    """A file with a program that can be run as often as not."""
    if foundry.chance.random() < 0.3:
        return program(folder, foundry)
    return put(folder, named(foundry, ["a.src"] * 9), foundry.runnable())


def archive(folder: Path, foundry: Foundry) -> Path:
    """A hostile archive."""
    return put(folder, "a.zip", foundry.archive())
