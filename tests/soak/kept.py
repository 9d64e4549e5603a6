"""What earlier runs left behind: a survey, and the results that commands keep."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from krl.cli import main
from tests.soak.foundry import Foundry
from tests.soak.given import OK, REPOSITORY, put

#: The files of the ledger, in its order.
CONSTRUCTS = sorted((REPOSITORY / "grammar" / "constructs").glob("*.toml"))

_PROGRAMS = [OK, b"DEF A()\nWEAVE 1\nEND\n"]
_CACHES: dict[str, dict[str, bytes]] = {}
_SURVEY: dict[str, Any] = {}


def short_ledger(folder: Path) -> Path:
    """A ledger with the first constructs of ours."""
    for file in CONSTRUCTS[:3]:
        put(folder, f"ledger/{file.name}", file.read_bytes())
    return folder / "ledger"


def damaged(folder: Path, foundry: Foundry, command: str) -> None:
    """Two programs in ``in``, and what a command kept of them in ``out/cache``, damaged."""
    surveyed(folder)
    for name, content in _CACHES[command].items():
        put(folder / "out" / "cache", name, foundry.bytes_of(content))
    if foundry.chance.random() < 0.1:
        (folder / "out" / "cache" / "results.sqlite").unlink()
        (folder / "out" / "cache" / "results.sqlite").mkdir()


def surveyed(folder: Path) -> dict[str, Any]:
    """Two programs in ``in``, and the record of their survey, which is made once."""
    for number, content in enumerate(_PROGRAMS):
        put(folder / "in", f"{number}.src", content)
    if not _CACHES:
        _survey(folder)
    return _SURVEY


def _survey(folder: Path) -> None:
    """Let each command that keeps results look at the programs; take what it keeps."""
    given, out = str(folder / "in"), folder.parent / "reports" / "kept"
    short = str(short_ledger(folder))
    main(["recover", given, "--no-start", "--out", str(out), "--jobs", "1"])
    _SURVEY.update(json.loads((out / "survey.json").read_text(encoding="utf-8")))
    for command, more in (
        ("recover", None),
        ("growth", ["--constructs", short, "--out", str(out)]),
        ("check", ["--cache", str(out / "cache")]),
    ):
        if more:
            main([command, given, *more])
        cache = out / "cache"
        _CACHES[command] = {file.name: file.read_bytes() for file in cache.iterdir()}
        shutil.rmtree(cache)
    shutil.rmtree(out)
