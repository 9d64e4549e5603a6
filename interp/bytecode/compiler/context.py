"""The context of a code object under construction, and what all code objects of a program share."""

from __future__ import annotations

from dataclasses import field
from typing import Protocol

from grammar.semantics.scopes import Scope
from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Type
from grammar.syntax import ast
from interp.bytecode.compiler.buffer_sizes import Sizes
from interp.bytecode.compiler.code_writer import Writer
from interp.bytecode.compiler.locations import Location
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.program import CodeKind
from interp.program.load import CheckedProgram, Routine, Unit
from support.lazy_dataclass import dataclass

#: The system variable that a parameter stands for: its path, ``None`` for each index.
Binding = tuple[tuple[str | int | None, ...], Type] | None
#: Code that runs later than the statement that contains it: an action or a condition.
Deferred = ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake


@dataclass(frozen=True, slots=True)
class Refusal:
    """A place where the program ends with a `LinkError` if it is executed.

    ``is_missing`` if something is used that is declared nowhere; otherwise the code may be correct,
    but cannot be compiled.
    """

    path: str
    line: int
    reason: str
    is_missing: bool


class CodeObjects(Protocol):
    """Assigns numbers to code objects, which are compiled later."""

    def code_of(self, routine: Routine, bindings: tuple[Binding, ...]) -> int:
        """Return the number of a routine that is called with these system variables."""

    def deferred(self, owner: Context, node: Deferred, kind: CodeKind) -> int:
        """Return the number of an action or a condition, which uses variables of its owner."""


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
    """One code object under construction.

    ``variables`` are the locations of parameters and local variables. ``result`` is the type of the
    result; a large one is stored through the parameter at offset ``target``. ``number`` is the
    number of the code object.
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

    @property
    def program(self) -> CheckedProgram:
        """The program that is compiled."""
        return self.shared.program

    @property
    def tables(self) -> Tables:
        """The tables of the program."""
        return self.shared.tables

    def note(self, reason: str, *, is_missing: bool) -> None:
        """Record that the program ends at the current line."""
        refusal = Refusal(self.unit.module.path, self.line, reason, is_missing)
        self.shared.refusals[refusal] = None
