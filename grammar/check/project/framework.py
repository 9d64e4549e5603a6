"""Runs all checks over a file, a project or a workspace.

The findings in a file depend on its text and on the symbol tables of other files, never on the
statements of other files. The `Findings` of a file can be pickled and cached; those of its project
are made from them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

from grammar.check.analysis.constant_folding import Value
from grammar.check.analysis.context import Context
from grammar.check.analysis.spelling import Spelling, spelling_of
from grammar.check.flow import control_flow, data_flow, entry_points
from grammar.check.flow.effects import NO_EFFECTS, Effects, effects
from grammar.check.flow.effects import of_project as of_effects
from grammar.check.limits import name_limits, value_limits
from grammar.check.names import duplicate_names, undeclared_names
from grammar.check.names.unresolved_names import (
    FileOf,
    LooseConstant,
    UnresolvedName,
    misspelt_declarations,
    of_constants,
    slipped_declarations,
)
from grammar.check.names.unresolved_names import of_project as of_names
from grammar.check.structure import folds, misplaced_statements, splines
from grammar.check.types import declarations, initial_values, statements, undeclared_kinds
from grammar.diagnostics.diagnostic import Diagnostic, in_order
from grammar.semantics.link import Project, Workspace
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution, resolve
from grammar.semantics.scopes import Module
from grammar.semantics.symbols import Kind, TypeSymbol
from grammar.semantics.types import Enumeration, Type
from grammar.syntax import ast
from grammar.syntax.ast import Node
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

Check = Callable[[Context], Iterator[Diagnostic]]

#: These type the expressions, for all that follow.
_TYPING: tuple[Check, ...] = (statements.check, initial_values.check)
#: In this order.
CHECKS: tuple[Check, ...] = (
    *_TYPING,
    declarations.check,
    undeclared_kinds.check,
    duplicate_names.check,
    undeclared_names.check,
    name_limits.check,
    control_flow.check,
    misplaced_statements.check,
    splines.check,
    value_limits.check,
    entry_points.check,
    data_flow.check,
    folds.check,
)


@dataclass(frozen=True, slots=True)
class Findings:
    """The result of checking one file.

    ``references`` are names that other files may declare, ``uses`` the names in upper case that the
    file uses and some file declares, ``effects`` what other files depend on, ``constants`` those
    whose enumeration is not known.
    """

    diagnostics: tuple[Diagnostic, ...]
    references: tuple[UnresolvedName, ...]
    effects: Effects = NO_EFFECTS
    uses: frozenset[str] = frozenset()
    constants: tuple[LooseConstant, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Checked:
    """A checked file: its findings, and the facts about its syntax tree.

    The tables are keyed by node identity: ``types`` has every expression, `UNKNOWN` if its type is
    not known; ``enumerations`` those of constants; ``values`` the constant values that were needed.
    """

    module: Module
    findings: Findings
    resolution: Resolution
    types: Mapping[Node, Type]
    enumerations: Mapping[ast.EnumConstant, Enumeration]
    values: Mapping[Node, Value]


def typed_module(project: Project, module: Module, source: Source) -> Checked:
    """Return the types and names of one readable file, without findings.

    That is all that is needed to run it, and much faster than a check.
    """
    context = Context(project, module, source, resolve(project, module), System.load())
    for check in _TYPING:
        for _ in check(context):
            pass
    return Checked(
        module,
        Findings((), ()),
        context.resolution,
        context.types,
        context.enumerations,
        context.values,
    )


def check_module(project: Project, module: Module, source: Source) -> Checked:
    """Check one file that can be read; ``source`` is its text."""
    resolution = resolve(project, module)
    is_lacking = undeclared_names.lacks_data_list(project, module, resolution)
    context = Context(project, module, source, resolution, System.load(), is_lacking=is_lacking)
    found = in_order(diagnostic for check in CHECKS for diagnostic in check(context))
    findings = Findings(
        tuple(found),
        undeclared_names.references(context),
        effects(context),
        undeclared_names.uses(context),
        tuple(undeclared_names.loose_constants(context)),
    )
    context.flows.clear()  # they refer to the context: a cycle would keep the tree
    return Checked(
        module,
        findings,
        context.resolution,
        context.types,
        context.enumerations,
        context.values,
    )


def check_project(
    findings: Iterable[Findings], file_of: FileOf, spelling: Spelling
) -> list[Diagnostic]:
    """Return all findings of a project in order, from those of its files.

    ``file_of`` returns the table and the text of a file, for findings at its declarations;
    ``spelling`` knows the names of all files.
    """
    kept = list(findings)
    references = [reference for one in kept for reference in one.references]
    used = frozenset[str]().union(*(one.uses for one in kept))
    slips = slipped_declarations(references, used, file_of, spelling)
    explained = {one.finding for one in references if one.slip in slips}
    found = [one for file in kept for one in file.diagnostics if one not in explained]
    at_slips = {(one.path, one.region): one for one in slips.values()}
    found += at_slips.values()
    unused = misspelt_declarations(spelling, used, file_of)
    found += (one for one in unused if (one.path, one.region) not in at_slips)
    rest = (one for one in references if not one.finding and one.slip not in slips)
    found += of_names(rest, spelling)
    found += of_constants(
        (constant for one in kept for constant in one.constants),
        partial(_constants_of, file_of, spelling.files),
    )
    found += of_effects((one.effects for one in kept), lambda: spelling.files)
    return in_order(found)


def _constants_of(file_of: FileOf, paths: Iterable[str]) -> Iterator[str]:
    """Return the constants of the enumerations that some files declare at top level."""
    for path in paths:
        table = (file_of(path) or (None, None))[0]
        for symbol in table.table.spaces[Space.TYPE].values() if table else ():
            if isinstance(symbol, TypeSymbol) and symbol.kind is Kind.ENUMERATION:
                yield from (member.name for member in symbol.members.values())


def check(workspace: Workspace, source_of: Callable[[Module], Source]) -> list[Diagnostic]:
    """Check all files of a workspace that can be read; the findings are in order."""
    found: list[Diagnostic] = []
    for project in workspace.projects:
        read = [module for module in project.modules if module.syntax is not None]
        sources = {module.path: source_of(module) for module in read}
        files = {one.path: (one.table, partial(sources.__getitem__, one.path)) for one in read}
        findings = (check_module(project, one, sources[one.path]).findings for one in read)
        found += check_project(findings, files.get, spelling_of(sources.values()))
    return in_order(found)
