"""Where a command wants a file and there is something else: one line, status 2, no waiting."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from krl.cli import main

COMMANDS = [
    "check ?.src",
    "format --check ?.src",
    "run ?.src",
    "run --io ?.txt ok.src",
    "run --profile ?.toml ok.src",
    "compile ?.src",
    "asm ?.krla",
    "disasm ?.krlb",
    "conform import ?.json",
    "construct oracle --record ?.toml",
    "construct propose c-1 --survey ?.json",
    "recover --grammar ?.g4 ok.src",
]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "ok.src").write_text("DEF ok ( )\nEND\n", encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    "make",
    [
        Path.mkdir,
        pytest.param(
            getattr(os, "mkfifo", None),
            marks=pytest.mark.skipif(sys.platform == "win32", reason="there are no such pipes"),
        ),
    ],
)
def test_no_folder_and_no_pipe_is_a_file(
    here: Path, command: str, make: Callable[[Path], None], capfd: pytest.CaptureFixture[str]
) -> None:
    """One line says so: opening a pipe that nobody writes to would wait for ever."""
    words = [word.replace("?", "odd") for word in command.split()]
    make(here / next(word for word in words if word.startswith("odd")))
    assert 2 == main(words)
    out, err = capfd.readouterr()
    assert ("", 1) == (out, len(err.splitlines()))


@pytest.mark.parametrize("size", [(64 << 20) + 1, 1 << 40])
def test_an_enormous_image_is_refused(
    here: Path, size: int, capfd: pytest.CaptureFixture[str]
) -> None:
    """No more of a file is read than any image has."""
    with (here / "a.krlb").open("wb") as stream:
        stream.truncate(size)
    assert 2 == main(["disasm", "a.krlb"])
    assert "krl: a.krlb: larger than 64 MB\n" == capfd.readouterr().err
