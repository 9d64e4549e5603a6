"""Writing synthetic cells into a folder until it has a given size."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from pathlib import Path

from grammar.generation.cells.cells import files
from support.files.atomic_write import naming
from support.parallel.progress import Progress, no_progress


@dataclass(frozen=True, slots=True)
class Written:
    """What was written: numbers of cells, files and bytes."""

    cells: int
    files: int
    bytes: int


def write_cells(
    folder: Path, size: int, seed: int = 1, on_bytes: Progress = no_progress
) -> Written:
    """Write cells below ``folder`` until they have ``size`` bytes, the last file included.

    The same size and seed give the same files on every machine; a larger size gives the same files
    and more. ``on_bytes`` is called with the size of each file after it is written. Memory use does
    not depend on ``size``. Raises `OSError` if a file cannot be written.
    """
    written = number_of_files = 0
    for cell in count(1):
        for file in files(seed, cell):
            place = folder / file.path
            place.parent.mkdir(parents=True, exist_ok=True)
            with naming(place):
                place.write_bytes(file.data)
            number_of_files += 1
            written += len(file.data)
            on_bytes(len(file.data))
            if written >= size:
                return Written(cell, number_of_files, written)
    raise AssertionError("cells never end")
