"""Modules of a cell: a program and its data list, each with a head as controllers write it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from grammar.generation.cells.chance import Chance
from grammar.generation.cells.data import Data
from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import Taught
from grammar.generation.cells.routines import Program
from grammar.generation.cells.scope import Routine, Scope

__all__ = [
    "Cell",
    "Module",
    "as_data_list",
    "as_program",
    "library",
    "process",
    "public_data",
    "sequence",
]


@dataclass(slots=True)
class Cell:
    """What the modules of a cell have in common: how they are written, and what is global.

    ``shared`` are modules and integers of theirs that others can import.
    """

    chance: Chance
    dialect: Dialect
    names: Names
    scope: Scope
    shared: list[tuple[str, str]] = field(default_factory=list)

    def module_name(self) -> str:
        """A new name for a module."""
        return self.names.routine(self.chance.pick(self.names.vocabulary.stations))


@dataclass(frozen=True, slots=True)
class Module:
    """A program, its data list, or both, as lines."""

    name: str
    program: list[str] | None = None
    data: list[str] | None = None


def _head(cell: Cell, access: str = "RVP") -> Iterator[str]:
    chance = cell.chance
    if chance.real() < 0.03:  # typed on a PC, never stored by a controller
        return
    yield f"&ACCESS {access}"
    if chance.real() < 0.7:
        yield f"&REL {chance.between(1, 250)}"
    if chance.real() < 0.3:
        yield f"&COMMENT {cell.names.remark()}"
    if chance.real() < 0.6:
        yield "&PARAM EDITMASK = *"
        yield r"&PARAM TEMPLATE = C:\KRC\Roboter\Template\vorgabe"
    if chance.real() < 0.15:
        yield r"&PARAM DISKPATH = KRC:\R1\Program"


def as_program(cell: Cell, lines: Iterable[str], access: str = "RVP") -> list[str]:
    """Routines with the head of a file."""
    return [*_head(cell, access), *lines]


def as_data_list(
    cell: Cell, name: str, lines: Iterable[str], *, is_public: bool = False
) -> list[str]:
    """Declarations with the head of a file and of a data list."""
    public = " PUBLIC" if is_public else ""
    gap = " " if cell.chance.real() < 0.4 else ""
    return [*_head(cell), f"DEFDAT {gap}{name}{public}", *lines, "ENDDAT"]


_EXTERNAL = (
    ";FOLD EXTERNAL DECLARATIONS;%{PE}%MKUKATPBASIS,%CEXT,%VCOMMON,%P",
    ";FOLD BASISTECH EXT;%{PE}%MKUKATPBASIS,%CEXT,%VEXT,%P",
    "EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )",
    "DECL INT SUCCESS",
    ";ENDFOLD (BASISTECH EXT)",
    ";FOLD USER EXT;%{E}%MKUKATPUSER,%CEXT,%VEXT,%P",
    ";Make your modifications here",
    ";ENDFOLD (USER EXT)",
    ";ENDFOLD (EXTERNAL DECLARATIONS)",
)


def _data_list(cell: Cell, name: str, data: Data, taught: Taught) -> list[str]:
    if cell.dialect.inline_forms:
        callable_ = [one for one in cell.scope.routines[-9:] if not one.parameters]
        external = [f"EXT  {one.name} ( )" for one in cell.chance.few(callable_, 2)]
        if cell.dialect.generation.is_krc4:
            external = []
        lines = [*_EXTERNAL[:-2], *external, *_EXTERNAL[-2:]]
        lines += [*data.lines, *taught.lines, taught.suggestion()]
    else:
        lines = [*data.lines, *taught.lines]
    return as_data_list(cell, name, lines, is_public=cell.chance.real() < 0.2)


def _program(
    cell: Cell, name: str, declarations: int, names: Names | None = None
) -> tuple[Program, Data]:
    names, scope = names or cell.names.inner(), cell.scope.some(cell.chance)
    data = Data(cell.chance, cell.dialect, names, scope, is_global=False)
    data.some(declarations)
    taught = Taught(cell.chance, cell.dialect)
    return Program(name, cell.chance, cell.dialect, names, scope, taught), data


def process(cell: Cell) -> Module:
    """A program that moves: most of its lines are motions and what happens between them."""
    chance = cell.chance
    name = cell.module_name()
    program, data = _program(cell, name, chance.below(10))
    for _ in range(chance.below(3)):
        program.add_quick()
    if chance.real() < 0.1:
        program.add_brake()
    if chance.real() < 0.3:
        program.add_function()
    for _ in range(chance.below(3)):
        program.add_procedure(chance.between(10, 70), moving=chance.pick((0.0, 0.1, 0.3)))
    program.add_main(chance.between(20, 260), moving=chance.pick((0.1, 0.15, 0.25, 0.5)))
    cell.scope.add_routine(Routine(name))
    return Module(
        name, as_program(cell, program.lines), _data_list(cell, name, data, program.taught)
    )


def sequence(cell: Cell) -> Module:
    """A program that decides, counts and calls."""
    chance = cell.chance
    name = cell.module_name()
    program, data = _program(cell, name, chance.between(4, 24))
    if chance.real() < 0.3:
        program.add_quick()
    for _ in range(chance.below(3)):
        program.add_function()
    for _ in range(chance.below(5)):
        program.add_procedure(chance.between(10, 70), moving=0.0)
    program.add_main(chance.between(30, 260), moving=chance.pick((0.0, 0.0, 0.05)))
    cell.scope.add_routine(Routine(name))
    return Module(
        name, as_program(cell, program.lines), _data_list(cell, name, data, program.taught)
    )


def library(cell: Cell) -> Module:
    """Functions and procedures for all programs; the first routine does nothing."""
    chance = cell.chance
    name = cell.module_name()
    # its routines are global, so their names are those of the cell
    program, data = _program(cell, name, chance.between(2, 12), cell.names)
    added = [program.add_function(is_global=True) for _ in range(chance.between(2, 6))]
    added += [
        program.add_procedure(chance.between(6, 40), moving=0.0, is_global=True)
        for _ in range(chance.below(5))
    ]
    if program.scope.arrays["REAL"]:
        program.add_array_function()
    program.add_empty_main()
    for routine in added:
        cell.scope.add_routine(routine)
    return Module(name, as_program(cell, program.lines), as_data_list(cell, name, data.lines))


def public_data(cell: Cell) -> Module:
    """A data list alone, whose types and variables all programs see [SCO-04]."""
    name = cell.module_name()
    data = Data(cell.chance, cell.dialect, cell.names, cell.scope, is_global=True)
    seen = len(cell.scope.lasting["INT"])
    data.some(cell.chance.between(8, 60))
    cell.shared += [(name, variable) for variable in cell.scope.lasting["INT"][seen:]]
    return Module(name, data=as_data_list(cell, name, data.lines, is_public=True))
