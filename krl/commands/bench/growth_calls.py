"""Calls of one command with inputs of one shape, whose growth `krl bench growth` measures."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from krl.commands.app import app
from krl.commands.bench.growth_entries import ENTRIES, PROGRAM, GrowthEntry
from krl.errors import BAD_INPUT, run
from support.measure.cost_by_size import Growth, measure_growth

_SMALLEST = 8_000  # characters


class _NotMade(Exception):
    """The input of a command cannot be made from a shape."""


def measured_calls(entry: str, shape: str, largest: int) -> Growth | None:
    """Return the growth of a command's cost up to ``largest`` characters, measured in this process.

    ``None`` if its input cannot be made from the shape. Output and standard input of this process
    are lost.
    """
    with tempfile.TemporaryDirectory() as place, Path(os.devnull).open("w") as nowhere:
        for stream in (1, 2):  # also output that bypasses Python
            os.dup2(nowhere.fileno(), stream)
        calls = _Calls(ENTRIES[entry], shape, Path(place))
        try:
            return measure_growth(calls.prepare, _krl, _SMALLEST, largest)
        except _NotMade:
            return None


@dataclass(frozen=True, slots=True)
class _Calls:
    """Calls of ``entry`` with inputs of ``shape``, each in a folder of its own below ``root``.

    Results cached by path would distort the measurement, and a program is read with all files
    beside and below it.
    """

    entry: GrowthEntry
    shape: str
    root: Path

    def prepare(self, size: int) -> list[str]:
        """Make an input of ``size`` characters; return the words of the call."""
        folder = Path(tempfile.mkdtemp(dir=self.root))
        places = self._written(folder, size)
        for words in self.entry.before:
            with _output_to(places["printed"]):
                status = _krl(_filled(words, places))
            if status == BAD_INPUT:
                raise _NotMade
        said = folder / "said"
        said.write_bytes(self.entry.said(places["file"]))
        _read_input_from(said)
        return _filled(self.entry.words, places)

    def _written(self, folder: Path, size: int) -> dict[str, Path]:
        """Write the files of a call; return the paths that its placeholders stand for."""
        given, less, small = folder / "given", folder / "less", folder / "small"
        for one in (given, less, small):
            one.mkdir()
        file = self.entry.inputs[self.shape](given, size)
        places = {
            "file": file,
            "other": less / file.name,
            "small": small / "small.src",
            "out": folder / "out",
            "printed": folder / "printed",
        }
        places["small"].write_text(PROGRAM, encoding="ascii")
        if "{other}" in self.entry.words:
            lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
            kept = (line for number, line in enumerate(lines) if number % 7 != 3)
            places["other"].write_text("".join(kept), encoding="utf-8")
        return places


def _filled(words: str, places: dict[str, Path]) -> list[str]:
    return [word.format(**places) for word in words.split()]


def _krl(words: list[str]) -> int:
    return run(app(*words), words)


@contextmanager
def _output_to(path: Path) -> Iterator[None]:
    """Write standard output to a file for a while."""
    before = os.dup(1)
    with path.open("w") as file:
        os.dup2(file.fileno(), 1)
        try:
            yield
        finally:
            sys.stdout.flush()
            os.dup2(before, 1)
            os.close(before)


def _read_input_from(path: Path) -> None:
    with path.open("rb") as file:
        os.dup2(file.fileno(), 0)
    sys.stdin = os.fdopen(0, encoding="utf-8", closefd=False)
