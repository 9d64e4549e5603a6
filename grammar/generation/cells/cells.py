"""Whole cells: the folders of a controller, with modules in the order of their dependencies."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from grammar.generation.cells.dialect import Generation, Letters, a_dialect, a_way_to_store
from grammar.generation.cells.modules import Cell, Module, library, process, public_data, sequence
from grammar.generation.cells.names import Names, Writing, vocabulary
from grammar.generation.cells.special import (
    old_machine,
    painting,
    path,
    search,
    serial,
    splines,
    table_filler,
)
from grammar.generation.cells.system import (
    cell_program,
    controller,
    globals_of_cell,
    submit,
    system_routines,
)
from grammar.generation.choices import SeededChoices, Weighted


@dataclass(frozen=True, slots=True)
class File:
    """A file of a cell; ``path`` begins with the folder of the cell and uses ``/``."""

    path: str
    data: bytes


_MODULES = Weighted[Callable[[Cell], Module]](
    (440, process),
    (220, sequence),
    (90, library),
    (100, public_data),
    (8, path),
    (30, table_filler),
    (20, search),
    (10, splines),
    (10, painting),
    (15, serial),
    (20, old_machine),
)
_WRITINGS = Weighted((5, Writing.UPPER), (3, Writing.TYPED), (2, Writing.PLAIN))


def files(seed: int, number: int) -> Iterator[File]:
    """Yield the files of a cell; a file refers only to earlier ones.

    The result depends on ``seed`` and ``number`` alone. A reader that stops early has programs
    whose names are all declared in the files it got.
    """
    choices = SeededChoices(f"krl {seed} {number}")
    dialect = a_dialect(choices)
    writing = (
        Writing.UPPER if dialect.generation is Generation.KRC1 else choices.weighted(_WRITINGS)
    )
    names = Names(choices, vocabulary(dialect.language), writing)
    cell = Cell(choices, dialect, names)
    root = f"{number:04}_{choices.pick(names.vocabulary.trades).lower()}/KRC"
    for folder, module in _modules(cell):
        yield from _stored(cell, f"{root}/{folder}", module)


def _modules(cell: Cell) -> Iterator[tuple[str, Module]]:
    choices = cell.choices
    yield from controller(cell)
    yield "R1/System", globals_of_cell(cell)
    for module in system_routines(cell):
        yield "R1/System", module
    yield "R1/System", submit(cell)
    words = cell.names.vocabulary
    folders = [
        "R1/Program",
        *(f"R1/Program/{one.capitalize()}" for one in choices.few(words.things, 3)),
    ]
    technology = f"R1/TP/{choices.pick(words.stations).capitalize()}Tech"
    for _ in range(2):
        yield technology, public_data(cell)
    yield technology, library(cell)
    for _ in range(choices.between(8, 60)):
        make = choices.weighted(_MODULES)
        if make is splines and not cell.dialect.generation.is_krc4:
            make = search
        if make is old_machine and cell.dialect.generation.is_krc4:
            make = process
        folder = technology if make in (library, public_data) else choices.pick(folders)
        yield folder, make(cell)
    yield "R1", cell_program(cell)


def _stored(cell: Cell, folder: str, module: Module) -> Iterator[File]:
    ending = ".sub" if module.name == "sps" else ".src"
    for lines, suffix in ((module.data, ".dat"), (module.program, ending)):
        if lines is not None:
            name = module.name + suffix
            if cell.dialect.generation is Generation.KRC1:
                name = name.upper()
            elif cell.dialect.letters is Letters.LOWER:
                name = name.lower()
            text = "\n".join(lines) + ("\n" if cell.choices.chance(93) else "")
            dialect = a_way_to_store(cell.dialect, cell.choices)
            yield File(f"{folder}/{name}", dialect.stored(text))
