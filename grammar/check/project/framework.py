"""Runs all checks over a file, a project or a workspace.

The findings in a file depend on its text and on the symbol tables of other files, never on the
statements of other files. The `Findings` of a file can be pickled and cached; those of its project
are made from them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import field, replace

from grammar.check.analysis.context import Context
from grammar.check.flow import (
    control_flow,
    entry_points,
    missing_values,
    suspicious_statements,
    unused_variables,
    write_protection,
)
from grammar.check.flow.effects import Effects, effects
from grammar.check.flow.effects import of_project as of_effects
from grammar.check.limits import name_limits, value_limits
from grammar.check.names import duplicate_names, undeclared_names
from grammar.check.names.misspelt_declarations import slips_in_project, unlike_others, used_names
from grammar.check.names.open_constants import OpenConstant, misspelt_constants, open_constants
from grammar.check.names.open_names import open_names
from grammar.check.names.project_names import of_project as of_names
from grammar.check.names.unresolved_name import Files, UnresolvedName
from grammar.check.structure import misplaced_statements, splines, unbalanced_folds
from grammar.check.types import declarations, initial_values, statements, undeclared_kinds
from grammar.check.types.missing_arguments import OpenCall, missing_arguments, open_calls
from grammar.diagnostics.diagnostic import Diagnostic, in_order
from grammar.semantics.link import Project
from grammar.semantics.predefined import System
from grammar.semantics.resolve import resolve
from grammar.semantics.scopes import Module
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
    missing_values.check,
    unused_variables.check,
    suspicious_statements.check,
    write_protection.check,
    unbalanced_folds.check,
)


@dataclass(frozen=True, slots=True)
class Findings:
    """The result of checking one file.

    ``references`` are names that other files may declare, ``uses`` the names in upper case that the
    file uses and some file declares, ``effects`` what other files depend on, ``constants`` those
    whose enumeration is not known, ``calls`` those whose routine is not known.
    """

    diagnostics: tuple[Diagnostic, ...]
    references: tuple[UnresolvedName, ...]
    effects: Effects = field(default_factory=Effects)
    uses: frozenset[str] = frozenset()
    constants: tuple[OpenConstant, ...] = ()
    calls: tuple[OpenCall, ...] = ()


@dataclass(frozen=True, eq=False)
class Checked(Context):
    """A file with what is known of its syntax tree, and the findings if it was checked."""

    findings: Findings = Findings((), ())


def typed_module(project: Project, module: Module, source: Source) -> Checked:
    """Return the types and names of one readable file, without findings.

    That is all that is needed to run it, and much faster than a check.
    """
    typed = Checked(project, module, source, resolve(project, module), System.load())
    for check in _TYPING:
        for _ in check(typed):
            pass
    return typed


def check_module(project: Project, module: Module, source: Source) -> Checked:
    """Check one file that can be read; ``source`` is its text."""
    resolution = resolve(project, module)
    is_lacking = undeclared_names.lacks_data_list(project, module, resolution)
    context = Checked(project, module, source, resolution, System.load(), is_lacking=is_lacking)
    found = in_order(diagnostic for check in CHECKS for diagnostic in check(context))
    findings = Findings(
        tuple(found),
        open_names(context),
        effects(context),
        used_names(context),
        tuple(open_constants(context)),
        tuple(open_calls(context)),
    )
    context.flows.clear()  # they refer to the context: a cycle would keep the tree
    context.accesses.clear()
    return replace(context, findings=findings)


def check_project(findings: Iterable[Findings], files: Files) -> list[Diagnostic]:
    """Return all findings of a project in order, from those of its files."""
    kept = list(findings)
    references = [reference for one in kept for reference in one.references]
    constants = [constant for one in kept for constant in one.constants]
    used = frozenset[str]().union(*(one.uses for one in kept))
    slips = slips_in_project(references, used, files)
    explained = {one.finding for one in references if one.slip in slips}
    found = [one for file in kept for one in file.diagnostics if one not in explained]
    at_slips = {(one.path, one.region): one for one in slips.values()}
    found += at_slips.values()
    unlike = unlike_others(used, files)
    found += (one for one in unlike if (one.path, one.region) not in at_slips)
    rest = (one for one in references if not one.finding and one.slip not in slips)
    found += of_names(rest, files.spelling)
    found += misspelt_constants(constants, files)
    found += missing_arguments(call for one in kept for call in one.calls)
    found += of_effects(one.effects for one in kept)
    return in_order(found)
