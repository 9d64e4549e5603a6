"""What the makers of one code object work with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from grammar.semantics.scopes import Scope
from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Type
from interp.bytecode.compiler.code_writer import Writer
from interp.bytecode.compiler.places import Place
from interp.bytecode.compiler.tables import Tables
from interp.program.load import CheckedProgram, Unit

if TYPE_CHECKING:
    from interp.bytecode.compiler.project import Project

__all__ = ["Context", "Ended", "Refusal"]


@dataclass(frozen=True, slots=True)
class Refusal:
    """Something that ends the program with a `LinkError` when it is reached.

    It ``is_missing``: named and nowhere to be found; or it is not compiled, though it may be right.
    """

    path: str
    line: int
    reason: str
    is_missing: bool


class Ended(Exception):
    """What comes next on this way is never reached, so nothing more of it is made."""


@dataclass(slots=True, eq=False)
class Context:
    """One code object in the making.

    ``variables`` are the places of parameters and local data. ``result`` is the type of what the
    routine gives; a large one goes where the parameter at ``target`` leads. ``number`` is that of
    the code object.
    """

    project: Project
    unit: Unit
    scope: Scope
    writer: Writer
    variables: dict[Symbol, Place] = field(default_factory=dict)
    result: Type | None = None
    target: int | None = None
    line: int = 0
    number: int = -1

    @property
    def program(self) -> CheckedProgram:
        """The program that is compiled."""
        return self.project.program

    @property
    def tables(self) -> Tables:
        """What all code objects share."""
        return self.project.tables

    @property
    def places(self) -> Mapping[Symbol, tuple[int, Type]]:
        """The variables of the data lists."""
        return self.project.tables.places

    def note(self, reason: str, *, is_missing: bool) -> None:
        """Something at the line at hand ends the program."""
        refusal = Refusal(self.unit.module.path, self.line, reason, is_missing)
        self.project.refusals[refusal] = None
