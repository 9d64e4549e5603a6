"""Synthetic corpora: random programs in the folders of controllers, until there is enough."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Final

from grammar.generation.choices import SeededChoices
from grammar.generation.programs import generate
from grammar.generation.routine_writer import Size
from support.files.atomic_write import naming
from support.parallel.progress import Progress, no_progress

#: Files of some kB each, as people write them; none provokes a fault.
_SIZE: Final = Size(budget=5_000, others=300, statements=12, routines=12, data=12, risky=0)


@dataclass(frozen=True, slots=True)
class Written:
    """What was written: numbers of cells, files and bytes."""

    cells: int
    files: int
    bytes: int


def cell(seed: int, number: int) -> Iterator[tuple[str, bytes]]:
    """Yield path and content of the files of a cell, which depend on seed and number alone.

    A file refers only to earlier ones. Names of variables end in the number of the cell, so nearly
    all names of a corpus differ.
    """
    sample = generate(SeededChoices(f"cell {seed} {number}"), _SIZE, f"_{number}")
    program, data, config, *library = sample.files
    for name, text in (config, *reversed(library), data, program):
        folder = "System" if name.startswith("$") else "Program"
        yield f"{number:04}/KRC/R1/{folder}/{name.lower()}", text.encode()


def write_cells(
    folder: Path, size: int, seed: int = 1, on_bytes: Progress = no_progress
) -> Written:
    """Write cells below ``folder`` until they have ``size`` bytes, the last file included.

    The same size and seed give the same files on every machine; a larger size gives the same files
    and more. ``on_bytes`` is called with the size of each file after it is written. Memory use does
    not depend on ``size``. Raises `OSError` if a file cannot be written.
    """
    written = number_of_files = 0
    for number in count(1):
        for path, data in cell(seed, number):
            place = folder / path
            place.parent.mkdir(parents=True, exist_ok=True)
            with naming(place):
                place.write_bytes(data)
            number_of_files += 1
            written += len(data)
            on_bytes(len(data))
            if written >= size:
                return Written(number, number_of_files, written)
    raise AssertionError("cells never end")
