"""Limits of names and numbers of a module: 24 characters, 255 local routines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.syntax import ast

LONGEST_NAME = 24
MOST_LOCAL_ROUTINES = 255


def check(context: Context) -> Iterator[Diagnostic]:
    """Names that a file declares and that are too long, its own included; too many routines."""
    declared = list(_declared(context))
    own = context.module.name
    if len(own) > LONGEST_NAME:
        content = context.syntax.content
        node = content.name if isinstance(content, ast.DataList) else content.routines[0].name
        message = f"the module name {own} has {len(own)} characters; {LONGEST_NAME} are allowed"
        yield context.finding("module-name-too-long", node, message)
        # the routine or data list that carries the name of the file is not distinguished from it
        declared = [name for name in declared if name.key != own]
    for name in declared:
        if len(name.text) > LONGEST_NAME:
            message = f"{name.text} has {len(name.text)} characters; {LONGEST_NAME} are allowed"
            yield context.finding("name-too-long", name, message)
    content = context.syntax.content
    if isinstance(content, ast.Program) and len(content.routines) > MOST_LOCAL_ROUTINES + 1:
        first = content.routines[MOST_LOCAL_ROUTINES + 1]
        count = len(content.routines) - 1
        message = f"{count} local routines; {MOST_LOCAL_ROUTINES} are allowed"
        yield context.finding("too-many-routines", first.name, message)


def _declared(context: Context) -> Iterator[ast.Name]:
    """Yield the names that a file declares, in the order of the text; a parameter once."""
    content = context.syntax.content
    if isinstance(content, ast.DataList):
        yield content.name
        yield from _in(content.items)
        return
    for routine in context.routines:
        node = routine.node
        yield node.name
        parameters = {parameter.name.key for parameter in node.parameters}
        yield from (parameter.name for parameter in node.parameters)
        for name in _in(placed.statement for placed in routine.statements):
            if name.key not in parameters:
                yield name


def _in(statements: Iterable[ast.Node]) -> Iterator[ast.Name]:
    for statement in statements:
        match statement:
            case ast.VariableDeclaration(declarators=declarators):
                yield from (declarator.name for declarator in declarators)
            case ast.Enumeration(name=name, constants=constants):
                yield name
                yield from constants
            case ast.Structure(name=name, groups=groups):
                yield name
                for group in groups:
                    yield from (declarator.name for declarator in group.declarators)
            case ast.Signal(name=name) | ast.ChannelDefinition(name=name) | ast.Label(name=name):
                yield name
            case ast.Importation(declarator=declarator):
                yield declarator.name
