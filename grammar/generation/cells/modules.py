"""Modules of a cell: a program and its data list, with the head lines that controllers write."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from grammar.generation.cells.data import Data
from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.inline_forms import Forms
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import Taught
from grammar.generation.cells.program import Program
from grammar.generation.cells.style import style_of
from grammar.generation.choices import Choices
from grammar.generation.scope import Routine, Scope
from grammar.semantics.types import INT, REAL

#: How many of the cell's names of each kind a program sees.
_MOST_NAMES: Final = 6


class Cell:
    """What the modules of a cell share: dialect, style and global names.

    ``shared`` are pairs of a module and an integer of it that others can import.
    """

    def __init__(self, choices: Choices, dialect: Dialect, names: Names) -> None:
        self.choices = choices
        self.dialect = dialect
        self.names = names
        self.scope = Scope()
        self.style = style_of(dialect, names, Forms(dialect, Taught(choices, dialect)))
        self.shared: list[tuple[str, str]] = []

    def module_name(self) -> str:
        """Return a new name for a module."""
        return self.names.routine(self.choices.pick(self.names.vocabulary.stations))

    def program(self, name: str, *, is_shared: bool = False) -> Program:
        """Return an empty program file that sees a few of the cell's names.

        If it ``is_shared``, its routines get names that are unique in the whole cell.
        """
        names = self.names if is_shared else self.names.inner()
        scope = self.scope.some(self.choices, _MOST_NAMES)
        return Program(name, self.choices, self.dialect, self.style, names, scope)

    def callable(self) -> list[str]:
        """Return the names of the procedures without parameters, in the order of their creation."""
        found = self.scope.callable(None, 0)
        return [one.name for one in found if not one.parameters]

    def data(self, names: Names, scope: Scope, *, is_global: bool = False) -> Data:
        """Return an empty data list."""
        return Data(self.choices, self.style, names, scope, is_global=is_global)


@dataclass(frozen=True, slots=True)
class Module:
    """A program, its data list, or both, as lines."""

    name: str
    program: list[str] | None = None
    data: list[str] | None = None


def _head(cell: Cell) -> Iterator[str]:
    choices = cell.choices
    if choices.chance(3):  # typed on a PC, never stored by a controller
        return
    yield "&ACCESS RVP"
    if choices.chance(70):
        yield f"&REL {choices.between(1, 250)}"
    if choices.chance(30):
        yield f"&COMMENT {cell.names.remark()}"
    if choices.chance(60):
        yield "&PARAM EDITMASK = *"
        yield r"&PARAM TEMPLATE = C:\KRC\Roboter\Template\vorgabe"
    if choices.chance(15):
        yield r"&PARAM DISKPATH = KRC:\R1\Program"


def as_program(cell: Cell, lines: Iterable[str]) -> list[str]:
    """Return the lines of a program file: head and routines."""
    return [*_head(cell), *lines]


def as_data_list(
    cell: Cell, name: str, lines: Iterable[str], *, is_public: bool = False
) -> list[str]:
    """Return the lines of a data list file: head, DEFDAT, declarations, ENDDAT."""
    public = " PUBLIC" if is_public else ""
    gap = " " if cell.choices.chance(40) else ""
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
        external = [f"EXT  {one} ( )" for one in cell.choices.few(cell.callable()[-9:], 2)]
        if cell.dialect.generation.is_krc4:
            external = []
        lines = [*_EXTERNAL[:-2], *external, *_EXTERNAL[-2:]]
        lines += [*data.lines, *taught.lines, taught.suggestion()]
    else:
        lines = [*data.lines, *taught.lines]
    return as_data_list(cell, name, lines, is_public=cell.choices.chance(20))


def _finished(cell: Cell, program: Program, data: Data) -> Module:
    """Return the module of a program, which other programs can call from now on."""
    cell.scope.add_routine(Routine(program.name))
    listed = _data_list(cell, program.name, data, program.taught)
    return Module(program.name, as_program(cell, program.lines), listed)


def _begun(cell: Cell, declarations: int) -> tuple[Program, Data]:
    program = cell.program(cell.module_name())
    data = cell.data(program.names, program.scope)
    data.some(declarations)
    return program, data


def process(cell: Cell) -> Module:
    """Return a program that mostly moves."""
    choices = cell.choices
    program, data = _begun(cell, choices.below(10))
    for _ in range(choices.below(3)):
        program.add_quick()
    if choices.chance(10):
        program.add_brake()
    if choices.chance(30):
        program.add_function()
    for _ in range(choices.below(3)):
        program.add_procedure(choices.between(10, 70), moving=choices.pick((0, 10, 30)))
    program.add_main(choices.between(20, 260), moving=choices.pick((10, 15, 25, 50)))
    return _finished(cell, program, data)


def sequence(cell: Cell) -> Module:
    """Return a program that mostly decides, counts and calls."""
    choices = cell.choices
    program, data = _begun(cell, choices.between(4, 24))
    if choices.chance(30):
        program.add_quick()
    for _ in range(choices.below(3)):
        program.add_function()
    for _ in range(choices.below(5)):
        program.add_procedure(choices.between(10, 70), moving=0)
    program.add_main(choices.between(30, 260), moving=choices.pick((0, 0, 5)))
    return _finished(cell, program, data)


def library(cell: Cell) -> Module:
    """Return functions and procedures for all programs; the main routine is empty."""
    choices = cell.choices
    program = cell.program(cell.module_name(), is_shared=True)
    data = cell.data(cell.names, program.scope)
    data.some(choices.between(2, 12))
    added = [program.add_function(is_global=True) for _ in range(choices.between(2, 6))]
    added += [
        program.add_procedure(choices.between(6, 40), moving=0, is_global=True)
        for _ in range(choices.below(5))
    ]
    if program.scope.arrays(REAL, 1):
        program.add_array_function()
    program.add_empty_main()
    for routine in added:
        cell.scope.add_routine(routine)
    listed = as_data_list(cell, program.name, data.lines)
    return Module(program.name, as_program(cell, program.lines), listed)


def public_data(cell: Cell) -> Module:
    """Return a data list without a program, whose declarations are global [SCO-04]."""
    name = cell.module_name()
    before = {one.name for one in cell.scope.variables()}
    data = cell.data(cell.names, cell.scope, is_global=True)
    data.some(cell.choices.between(8, 60))
    cell.shared += [
        (name, one.name)
        for one in cell.scope.variables()
        if one.type == INT and one.is_writable and one.name not in before
    ]
    return Module(name, data=as_data_list(cell, name, data.lines, is_public=True))
