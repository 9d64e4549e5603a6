"""All checks, and how they run over a file, a project, a workspace.

What is found in a file depends on its text and on the tables of other files, never on their
statements. `Findings` of a file can be pickled and kept; those of its project are made of them.
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
from grammar.check.types import declarations, initial_values, statements
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
    """What the check of one file found.

    ``references`` are names that other files may declare, ``uses`` those in upper case that the
    file uses and some file declares, ``effects`` what other files rely on, ``constants`` those
    whose enumeration is not known.
    """

    diagnostics: tuple[Diagnostic, ...]
    references: tuple[UnresolvedName, ...]
    effects: Effects = NO_EFFECTS
    uses: frozenset[str] = frozenset()
    constants: tuple[LooseConstant, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Checked:
    """A file that was checked: its findings, and what is known of its tree.

    The tables are keyed by nodes, by identity: ``types`` has every expression, `UNKNOWN` where
    nothing is known; ``enumerations`` those of constants; ``values`` what is known before the
    program runs, where that was asked for.
    """

    module: Module
    findings: Findings
    resolution: Resolution
    types: Mapping[Node, Type]
    enumerations: Mapping[ast.EnumConstant, Enumeration]
    values: Mapping[Node, Value]


def typed_module(project: Project, module: Module, source: Source) -> Checked:
    """What is known of the tree of one file that can be read, without any findings.

    That is all that running it needs, and a fraction of the work.
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
    """All findings of a project, from those of all its files, in order.

    ``file_of`` has the table and the text of a file, for what others find in its declarations;
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
    found += of_effects(one.effects for one in kept)
    return in_order(found)


def _constants_of(file_of: FileOf, paths: Iterable[str]) -> Iterator[str]:
    """The constants of the enumerations that some files declare at their first level."""
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
