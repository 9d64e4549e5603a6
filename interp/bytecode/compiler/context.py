"""One code object in the making, and what it shares with the others of its program."""

from __future__ import annotations

from dataclasses import field
from typing import Protocol

from grammar.semantics.scopes import Scope
from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Type
from grammar.syntax import ast
from interp.bytecode.compiler.array_bounds import Sizes
from interp.bytecode.compiler.code_writer import Writer
from interp.bytecode.compiler.locations import Location
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.program import CodeKind
from interp.program.load import CheckedProgram, Routine, Unit
from support.lazy_dataclass import dataclass

#: What stands for a system variable in a routine: its path, ``None`` for each index.
Binding = tuple[tuple[str | int | None, ...], Type] | None
#: What is executed or evaluated later than where it stands: an action or a condition.
Deferred = ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake


@dataclass(frozen=True, slots=True)
class Refusal:
    """Something that ends the program with a `LinkError` when it is reached.

    It ``is_missing``: named and nowhere to be found; or it is not compiled, though it may be right.
    """

    path: str
    line: int
    reason: str
    is_missing: bool


class CodeObjects(Protocol):
    """Gives other code objects their numbers; they are compiled in their turn."""

    def code_of(self, routine: Routine, bindings: tuple[Binding, ...]) -> int:
        """The number of a routine, called with these system variables."""

    def deferred(self, owner: Context, node: Deferred, kind: CodeKind) -> int:
        """The number of an action or a condition, which uses variables of its owner."""


@dataclass(frozen=True, slots=True)
class Shared:
    """What all code objects of a program share."""

    program: CheckedProgram
    codes: CodeObjects
    tables: Tables = field(default_factory=Tables)
    sizes: Sizes = field(default_factory=Sizes)
    refusals: dict[Refusal, None] = field(default_factory=dict)


@dataclass(slots=True, eq=False)
class Context:
    """One code object in the making.

    ``variables`` are the places of parameters and local data. ``result`` is the type of what the
    routine gives; a large one goes where the parameter at ``target`` leads. ``number`` is that of
    the code object. It ``is_data_list`` where it fills one, and so has the variables itself that
    the world has later.
    """

    shared: Shared
    unit: Unit
    scope: Scope
    writer: Writer
    variables: dict[Symbol, Location] = field(default_factory=dict)
    result: Type | None = None
    target: int | None = None
    line: int = 0
    number: int = -1
    is_data_list: bool = False

    @property
    def program(self) -> CheckedProgram:
        """The program that is compiled."""
        return self.shared.program

    @property
    def tables(self) -> Tables:
        """The tables of the program."""
        return self.shared.tables

    def note(self, reason: str, *, is_missing: bool) -> None:
        """Something at the line at hand ends the program."""
        refusal = Refusal(self.unit.module.path, self.line, reason, is_missing)
        self.shared.refusals[refusal] = None
