"""The fields of nodes that are references to names, and a walk over references.

The fields are determined once for each kind of node, so that walks over whole archives visit no
field in vain. Nothing here recurses.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from enum import Enum
from typing import Any

from grammar.syntax import ast


class Space(Enum):
    """Name spaces: a type and a variable may have the same name."""

    VALUE = "variable"
    ROUTINE = "routine"
    TYPE = "type"
    CHANNEL = "channel"
    LABEL = "label"

    __hash__ = object.__hash__  # `Enum.__hash__` is written in Python and slow


_NAMES: dict[type[ast.Node], tuple[str, Space]] = {
    ast.Call: ("name", Space.ROUTINE),
    ast.ChannelDefinition: ("name", Space.CHANNEL),
    ast.ChannelName: ("name", Space.CHANNEL),
    ast.Enumeration: ("name", Space.TYPE),
    ast.External: ("name", Space.ROUTINE),
    ast.ExternalParameter: ("type", Space.TYPE),
    ast.For: ("counter", Space.VALUE),
    ast.Goto: ("label", Space.LABEL),
    ast.Importation: ("type", Space.TYPE),
    ast.Label: ("name", Space.LABEL),
    ast.MemberGroup: ("type", Space.TYPE),
    ast.Parameter: ("name", Space.VALUE),
    ast.Signal: ("name", Space.VALUE),
    ast.Structure: ("name", Space.TYPE),
    ast.TypeName: ("name", Space.TYPE),
    ast.Variable: ("name", Space.VALUE),
    ast.VariableDeclaration: ("type", Space.TYPE),
}
#: Fields that are not visited: names that are resolved elsewhere or are no references.
_LEFT_OUT: dict[type[ast.Node], set[str]] = {
    ast.ChannelDefinition: {"interface"},
    ast.Declarator: {"name"},
    ast.Enumeration: {"constants"},
    ast.EnumConstant: {"name"},
    ast.ExternalParameter: {"name"},
    ast.Importation: {"path", "source"},
}
_TEXTS = {"str", "str | None", "tuple[str, ...]", "int", "bool", "frozenset[str]"}


def _below(kind: type[ast.Node]) -> tuple[str, ...]:
    """Return the fields of a kind of node in which the walk continues."""
    left_out = _LEFT_OUT.get(kind, set()) | {"span", _NAMES.get(kind, ("",))[0]}
    return tuple(
        field.name
        for field in fields(kind)
        if field.name not in left_out and field.type not in _TEXTS
    )


#: For each kind of node that is no leaf: the field of its name with the space to look it up in, and
#: the fields to continue with, each a node, ``None``, or a tuple of these.
PLANS: dict[type[Any], tuple[tuple[str, Space] | None, tuple[str, ...]]] = {
    kind: (_NAMES.get(kind), below)
    for kind in ast.Node.__subclasses__()
    if (below := _below(kind)) or kind in _NAMES
}


def calls_in(nodes: Iterable[ast.Node]) -> frozenset[str]:
    """Return the names of all routines that are called below some nodes, in upper case."""
    called = set()
    todo: list[ast.Node | None] = list(nodes)
    while todo:
        node = todo.pop()
        plan = PLANS.get(type(node))
        if plan is None:
            continue
        if isinstance(node, ast.Call):
            called.add(node.name.text.upper())
        for field in plan[1]:
            value = getattr(node, field)
            if type(value) is tuple:
                todo.extend(value)
            else:
                todo.append(value)
    return frozenset(called)
