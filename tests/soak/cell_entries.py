"""Entry points of the cell: `krl run`, the bytecode machine, the arm."""

from __future__ import annotations

import json
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import PROGRAM, REPOSITORY, Entry, Given, krl, put, runnable

SCRIPT = "t=0.5 IN[1]=TRUE\non OUT[3]=TRUE after 0.2 IN[7]=TRUE\nstop at 2\n"
POINTS = [{"id": 1, "x": 600, "y": 0, "z": 700, "a": 0, "b": 90, "c": 0, "s": 2}]
PROFILE = (REPOSITORY / "interp" / "controller" / "state" / "profiles" / "kss8.toml").read_text(
    encoding="utf-8"
)
MACHINE = (REPOSITORY / "interp" / "robot" / "models" / "kr6r900.dat").read_text(encoding="utf-8")


def run(folder: Path, foundry: Foundry) -> Given:
    """A program that is run, with everything that is written about it."""
    more = foundry.chance.choice(
        [(), ("--html", folder / "out.html"), ("--trace", folder / "t.jsonl"), ("--strict",)]
    )
    executor = foundry.chance.choice(["tree", "vm", "native"])
    limits = ("--executor", executor, "--max-time", "5")
    return krl("run", *limits, *more, "--", runnable(folder, foundry))


def _ran(folder: Path, *options: str | Path) -> Given:
    return krl("run", "--executor", "vm", *options, put(folder, "p.src", PROGRAM))


def _located(folder: Path, points: bytes, machine: bytes) -> Given:
    """Status and Turn of points, for an arm with this machine data."""
    data = put(folder, "$machine.dat", machine)
    return krl("robot", "status-turn", put(folder, "p.json", points), "--machine", data)


ENTRIES = {
    "run": Entry(80, "a program that is run, on each executor, with page and trace", run),
    "run archive": Entry(
        12,
        "a program in an archive",
        lambda d, f: krl("run", put(d, "a.zip", f.archive(f.runnable())) / "KRC/R1/x.src"),
    ),
    "run io": Entry(
        50, "a script of inputs", lambda d, f: _ran(d, "--io", put(d, "s.txt", f.text(SCRIPT)))
    ),
    "run profile": Entry(
        45,
        "a profile of a controller",
        lambda d, f: _ran(d, "--profile", put(d, "p.toml", f.text(PROFILE))),
    ),
    "compile": Entry(
        80, "a program", lambda d, f: krl("compile", "-o", d / "out.krlb", "--", runnable(d, f))
    ),
    "asm": Entry(
        45,
        "text of the bytecode machine",
        lambda d, f: krl("asm", put(d, "a.krla", f.text(f.chance.choice(f.compiled)[1]))),
    ),
    "disasm": Entry(
        100,
        "an image of the bytecode machine",
        lambda d, f: krl("disasm", put(d, "a.krlb", f.image())),
    ),
    "points": Entry(
        40, "points for an arm", lambda d, f: _located(d, f.record(POINTS), MACHINE.encode())
    ),
    "machine data": Entry(
        40,
        "machine data of an arm",
        lambda d, f: _located(d, json.dumps(POINTS).encode(), f.text(MACHINE)),
    ),
}
