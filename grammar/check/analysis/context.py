"""The context of a check: a file, the meaning of its names, the types of its expressions."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

from grammar.check.analysis.control_flow_graph import FlowGraph, FlowNode, flow_graph
from grammar.check.analysis.spelling import Spelling, spelling_of
from grammar.diagnostics.codes import Severity, code, of_message
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose
from grammar.diagnostics.did_you_mean import NameSuggestions
from grammar.semantics.link import Project
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution, Use
from grammar.semantics.rules import is_confirmed
from grammar.semantics.scopes import Found, Module, Scope
from grammar.semantics.symbols import Kind, ModuleTable, RoutineTable, Table
from grammar.semantics.types import Enumeration, Structure, Type, Verdict
from grammar.syntax import ast
from grammar.syntax.ast import Node, Span
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from grammar.syntax.walk import BODIES, bodies, without_parentheses
from support.lazy_dataclass import dataclass, node


@node
class PlacedStatement:
    """A statement and the one that contains it: a block, SWITCH or spline block."""

    statement: ast.Statement | ast.ConstantVelocity | ast.TimeBlock | ast.StopWhen
    inside: PlacedStatement | None

    @property
    def around(self) -> Iterator[PlacedStatement]:
        """The statements that contain it, innermost first."""
        around = self.inside
        while around is not None:
            yield around
            around = around.inside

    @property
    def is_in_spline(self) -> bool:
        """Whether it stands in a spline block."""
        return self.inside is not None and isinstance(self.inside.statement, ast.SplineBlock)


@dataclass(frozen=True, slots=True)
class Bound:
    """The use of a parameter in words, and the minimum and maximum value for that use."""

    slug: str
    use: str
    low: float = -math.inf
    high: float = math.inf

    def accepts(self, value: float) -> bool:
        """Return whether a number is valid for that use; a divisor is any number except zero."""
        return value != 0 if self.slug == "division-by-zero" else self.low <= value <= self.high


@dataclass(frozen=True, eq=False)
class RoutineBody:
    """A routine with its table and scope.

    ``statements`` are all statements in the order of the text, including those in blocks. The
    action of an interrupt or a trigger is part of its statement.
    """

    node: ast.Routine
    table: RoutineTable
    scope: Scope
    statements: tuple[PlacedStatement, ...]

    @cached_property
    def ways(self) -> FlowGraph:
        """The ways through it; conditions count as open."""
        return flow_graph(self.node)

    @cached_property
    def reached(self) -> frozenset[FlowNode]:
        """Return the nodes that can be reached from the start."""
        return self.ways.reached()


@dataclass(frozen=True, eq=False)
class Context:
    """A file to check.

    ``resolution`` has the meaning of its names. The first check, `grammar.check.types.statements`,
    fills the other tables: ``types`` has the type of each expression except literals,
    ``enumerations`` the enumeration of each constant, ``values`` the values of expressions that
    must be constant, ``constants`` the constants that undeclared names would be with a #,
    ``lacking`` the constants and components that a type lacks, ``bounds`` the valid values of
    parameters where they are used. `analysis.accesses` fills ``accesses``, `flow.data_flow` fills
    ``flows``. ``is_lacking`` if the data list of the program is missing; it may declare what other
    files declare, too.
    """

    project: Project
    module: Module
    source: Source
    resolution: Resolution
    system: System
    types: dict[Node, Type] = field(default_factory=dict)
    enumerations: dict[ast.EnumConstant, Enumeration] = field(default_factory=dict)
    values: dict[Node, Any] = field(default_factory=dict)
    constants: dict[ast.Name, str] = field(default_factory=dict)
    lacking: list[tuple[Enumeration | Structure, str, Diagnostic]] = field(default_factory=list)
    bounds: dict[ast.Name, Bound] = field(default_factory=dict)
    accesses: dict[Node, Any] = field(default_factory=dict)
    flows: dict[ast.Routine, Any] = field(default_factory=dict)
    is_lacking: bool = False
    suggestions: NameSuggestions = field(default_factory=NameSuggestions)

    # ----------------------------------------------------------------------- the file

    @property
    def syntax(self) -> ast.Module:
        """The syntax tree."""
        assert self.module.syntax is not None, "only what can be read is checked"
        return self.module.syntax

    @property
    def table(self) -> ModuleTable:
        """The declarations of the file."""
        assert self.module.table is not None, "only what can be read is checked"
        return self.module.table

    @property
    def tables(self) -> tuple[Table, ...]:
        """The declarations of the file, then those of each routine."""
        return self.table.table, *(routine.table.table for routine in self.routines)

    @property
    def data(self) -> ast.DataList | None:
        """The data list, if the file is one."""
        content = self.syntax.content
        return content if isinstance(content, ast.DataList) else None

    @property
    def own_data(self) -> Table | None:
        """The declarations of the data list that belongs to the program, if it can be read."""
        data = self.project.data_of(self.module)
        return data.table.table if data is not None and data.table is not None else None

    @property
    def scope(self) -> Scope:
        """The top-level scope of the file."""
        return self.project.scope(self.module)

    @cached_property
    def open_uses(self) -> Mapping[tuple[Space | None, str], Sequence[Use]]:
        """The uses without a declaration, by space and name in upper case.

        A data list cannot assign to whole variables, declared or not.
        """
        misplaced = {
            item.target.name
            for item in (self.data.items if self.data else ())
            if isinstance(item, ast.Assignment) and isinstance(item.target, ast.Variable)
        }
        found: dict[tuple[Space | None, str], list[Use]] = {}
        for use in self.resolution.open_uses:
            if use.name not in misplaced:
                found.setdefault((use.space, use.name.key), []).append(use)
        return found

    @cached_property
    def typed_nodes(self) -> Mapping[type[Node], Sequence[Any]]:
        """The nodes that have a type, by their class, in the order in which they got it."""
        found: defaultdict[type[Node], list[Node]] = defaultdict(list)
        for typed in self.types:
            found[type(typed)].append(typed)
        return found

    @cached_property
    def used(self) -> frozenset[Found]:
        """The symbols that the file uses, except where a name declares or announces one."""
        announced = {symbol.span for symbol in self.table.externals.values()}
        return frozenset(
            answer
            for name, answer in self.resolution.answers.items()
            if type(answer) is Found
            and name.span != answer.symbol.span
            and name.span not in announced
        )

    @cached_property
    def spelling(self) -> Spelling:
        """The spelling of the names of the file."""
        return spelling_of([self.source])

    @cached_property
    def routines(self) -> tuple[RoutineBody, ...]:
        """The routines in the order of the file; none in a data list."""
        content = self.syntax.content
        if isinstance(content, ast.DataList):
            return ()
        return tuple(
            RoutineBody(node, table, self.project.scope(self.module, table), placed(node.body))
            for node, table in zip(content.routines, self.table.routines, strict=True)
        )

    def is_cut(self, routine: RoutineBody) -> bool:
        """Return whether a routine has no end because the file is cut off."""
        return self.module.is_cut and routine is self.routines[-1]

    def found(self, name: ast.Name) -> Found | None:
        """Return the declaration of a name, or ``None`` if it is unknown."""
        return self.resolution.found(name)

    def declares(self, found: Found) -> bool:
        """Return whether this file has the declaration; the module of its scope has no tree."""
        return found.module is not None and found.module.table is self.module.table

    def note_bound(
        self,
        node: ast.Expression,
        slug: str,
        use: str,
        low: float = -math.inf,
        high: float = math.inf,
    ) -> None:
        """Note the values that a parameter may have, if the expression is one; see `Bound`."""
        node = without_parentheses(node)
        if type(node) is ast.Variable:
            found = self.found(node.name)
            if found is not None and found.symbol.kind is Kind.PARAMETER:
                self.bounds[node.name] = Bound(slug, use, low, high)

    # ----------------------------------------------------------------------- findings

    def line(self, node: Node) -> int:
        """Return the line on which a node begins, counted from 1."""
        return self.source.place(node.span[0])[0]

    def head(self, node: Node) -> Span:
        """Return the part of a node in its first line, without a comment: where to report it."""
        start, end = node.span
        line, column = self.source.place(start)
        shown = self.source.line(line)
        comment = self.source.comment(line)
        if comment is not None:
            shown = shown[: comment.column - 1]
        return start, max(start + 1, min(end, start - column + 1 + len(shown.rstrip())))

    def finding(
        self,
        slug: str,
        where: Node | Span,
        message: str,
        *,
        reason: str = "",
        rules: tuple[str, ...] | None = None,
        severity: Severity | None = None,
        is_unconfirmed: bool = False,
        fix: Fix | None = None,
    ) -> Diagnostic:
        """Return a finding at a node or a span; see `grammar.diagnostics.diagnostic.diagnose`.

        A finding that is based on unconfirmed rules only is not an error.
        """
        region = Region.of(self.source, where.span if isinstance(where, Node) else where)
        rules = code(slug).rules if rules is None else rules
        return diagnose(
            slug,
            self.source.path,
            region,
            message,
            reason=reason,
            rules=rules,
            severity=severity,
            is_unconfirmed=is_unconfirmed or not is_confirmed(rules),
            fix=fix,
        )

    def refusal(
        self,
        slug: str,
        where: Node | Span,
        verdict: Verdict,
        *,
        fix: Fix | None = None,
        is_unconfirmed: bool = False,
    ) -> Diagnostic:
        """Return a finding for a negative verdict; the controller's message replaces ``slug``."""
        entry = None if verdict.message is None else of_message(verdict.message)
        return self.finding(
            entry.slug if entry else slug,
            where,
            verdict.reason,
            rules=verdict.rules,
            is_unconfirmed=is_unconfirmed,
            fix=fix,
        )


def placed(body: tuple[ast.Statement, ...]) -> tuple[PlacedStatement, ...]:
    """Return all statements of a body with the statements that contain them, in order."""
    found: list[PlacedStatement] = []
    todo: list[tuple[Iterator[Any], PlacedStatement | None]] = [(iter(body), None)]
    while todo:
        statements, inside = todo[-1]
        for statement in statements:
            here = PlacedStatement(statement, inside)
            found.append(here)
            if type(statement) in BODIES:
                inner = tuple(bodies(statement))
                todo.extend((iter(body), here) for body in reversed(inner))
                break
        else:
            todo.pop()
    return tuple(found)
