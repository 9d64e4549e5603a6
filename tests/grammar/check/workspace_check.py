"""The check of a whole workspace, as a batch, a run and an editor make it of their files."""

from collections.abc import Callable

from grammar.check.names.unresolved_name import Files
from grammar.check.project.framework import check_module, check_project
from grammar.diagnostics.diagnostic import Diagnostic, in_order
from grammar.semantics.link import Workspace
from grammar.semantics.scopes import Module
from grammar.syntax.source import Source


def check(workspace: Workspace, source_of: Callable[[Module], Source]) -> list[Diagnostic]:
    """What is found in all files of a workspace that can be read, in order."""
    found: list[Diagnostic] = []
    for project in workspace.projects:
        read = [(source_of(one), one) for one in project.modules if one.syntax is not None]
        files = Files.of((source, one.table) for source, one in read)
        findings = (check_module(project, one, source).findings for source, one in read)
        found += check_project(findings, files)
    return in_order(found)
