"""Whole cells: folders as controllers have them, with modules in the order of what they use."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from grammar.generation.cells.chance import Chance, Weighted
from grammar.generation.cells.dialect import Generation, Letters, a_dialect, a_way_to_store
from grammar.generation.cells.modules import Cell, Module, library, process, public_data, sequence
from grammar.generation.cells.names import WORDS, Names, Writing
from grammar.generation.cells.scope import Scope
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

__all__ = ["File", "files"]


@dataclass(frozen=True, slots=True)
class File:
    """A file of a cell; ``path`` begins with the folder of the cell and has ``/`` in it."""

    path: str
    data: bytes


_MODULES: Weighted[Callable[[Cell], Module]] = Weighted(
    [
        (44.0, process),
        (22.0, sequence),
        (9.0, library),
        (10.0, public_data),
        (0.8, path),
        (3.0, table_filler),
        (2.0, search),
        (1.0, splines),
        (1.0, painting),
        (1.5, serial),
        (2.0, old_machine),
    ]
)
_WRITINGS = Weighted([(0.5, Writing.UPPER), (0.3, Writing.TYPED), (0.2, Writing.PLAIN)])


def files(seed: int, number: int) -> Iterator[File]:
    """The files of a cell; what one uses was in an earlier one.

    ``seed`` and ``number`` alone decide what comes. A reader that stops early has programs whose
    every name is declared in what it got.
    """
    chance = Chance(f"krl {seed} {number}")
    dialect = a_dialect(chance)
    writing = Writing.UPPER if dialect.generation is Generation.KRC1 else chance.draw(_WRITINGS)
    names = Names(chance, WORDS[dialect.language], writing)
    cell = Cell(chance, dialect, names, Scope())
    root = f"{number:04}_{chance.pick(names.vocabulary.trades).lower()}/KRC"
    for folder, module in _modules(cell):
        yield from _stored(cell, f"{root}/{folder}", module)


def _modules(cell: Cell) -> Iterator[tuple[str, Module]]:
    chance = cell.chance
    yield from controller(cell)
    yield "R1/System", globals_of_cell(cell)
    for module in system_routines(cell):
        yield "R1/System", module
    yield "R1/System", submit(cell)
    words = cell.names.vocabulary
    folders = [
        "R1/Program",
        *(f"R1/Program/{one.capitalize()}" for one in chance.few(words.things, 3)),
    ]
    technology = f"R1/TP/{chance.pick(words.stations).capitalize()}Tech"
    for _ in range(2):
        yield technology, public_data(cell)
    yield technology, library(cell)
    for _ in range(chance.between(8, 60)):
        make = chance.draw(_MODULES)
        if make is splines and not cell.dialect.generation.is_krc4:
            make = search
        if make is old_machine and cell.dialect.generation.is_krc4:
            make = process
        folder = technology if make in (library, public_data) else chance.pick(folders)
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
            text = "\n".join(lines) + ("\n" if cell.chance.real() < 0.93 else "")
            dialect = a_way_to_store(cell.dialect, cell.chance)
            yield File(f"{folder}/{name}", dialect.stored(text))
